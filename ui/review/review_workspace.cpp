#include "ui/review/review_workspace.h"

#include <algorithm>

#include "base/codes.h"
#include "base/tr.h"
#include "library/stored_case.h"
#include "training/replay.h"
#include "ui/codes.h"
#include "ui/common/words.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

// The case that it was done on: one that comes with the program, or one that is kept.
Result<Case> recordedCase(const ListedRecording& recording, CaseLibrary& library,
                          const Progress& progress) {
  // A recording may be a stranger's: it opens no file.
  if (phantomNamed(recording.case_source)) return readCase(recording.case_source, progress);
  for (const ListedCase& one : library.list()) {
    if (one.problem || one.record.volume_sha256 != recording.volume_sha256) continue;
    Result<StoredCase> stored = storedCase(library, one.id, progress);
    if (!stored) return stored.error();
    return std::move(stored->of);
  }
  return Error{code::kMissingCase, trephine::tr("The case that it was done on is not kept here"),
               "", trephine::tr("Open that case, to replay it")};
}

}  // namespace

ReviewWorkspace::ReviewWorkspace(AppContext& app)
    : Workspace(&app), app_(app), page_(new ReviewPage) {
  connect(page_, &ReviewPage::replayWanted, this, &ReviewWorkspace::replay);
  connect(page_, &ReviewPage::cancelWanted, &replaying_, &BackgroundTask::cancel);
  connect(&listing_, &BackgroundTask::progressed, page_, &ReviewPage::showReading);
  connect(&listing_, &BackgroundTask::ended, this, [this] {
    if (std::exchange(list_again_, false))
      QMetaObject::invokeMethod(this, &ReviewWorkspace::list, Qt::QueuedConnection);
  });
  connect(&replaying_, &BackgroundTask::progressed, page_, &ReviewPage::showProgress);
  connect(&replaying_, &BackgroundTask::ended, page_, &ReviewPage::endProgress);
}

Workspace::Parts ReviewWorkspace::parts() {
  Parts parts;
  parts.page = page_;
  return parts;
}

bool ReviewWorkspace::isRecording(const std::filesystem::path& path) {
  std::error_code ec;
  return path.extension() == ".h5" && !std::filesystem::is_directory(path, ec);
}

void ReviewWorkspace::choose(const std::filesystem::path& file) {
  std::error_code ec;
  opened_ = std::filesystem::absolute(file, ec).lexically_normal();
  choose_opened_ = true;
}

void ReviewWorkspace::list() {
  struct Listed {
    std::vector<ListedRecording> rows;
    std::map<std::string, QString> cases;  // names
    std::filesystem::path opened;
  };
  const bool begun = listing_.run(
      [this, folder = app_.recordings(), opened = opened_,
       library = app_.library()](const Progress& progress) -> Result<Listed> {
        Listed listed{{}, {}, opened};
        for (const std::string& name : phantomNames()) {
          listed.cases[phantomSource(name)] = builtInName(name);
        }
        for (const ListedCase& one : library->list()) {
          if (!one.problem) listed.cases[one.record.volume_sha256] = toQt(one.record.name);
        }
        ReadApart how;
        how.read = [this, cases = listed.cases](const std::vector<ListedRecording>& so_far) {
          QMetaObject::invokeMethod(
              this,
              [this, so_far, cases] {
                // While they are read anew, those of before stay.
                if (so_far.size() >= page_->count()) show(so_far, false, cases);
              },
              Qt::QueuedConnection);
        };
        Result<std::vector<ListedRecording>> rows = listRecordings(folder, progress, how);
        if (!rows) return rows.error();
        listed.rows = *std::move(rows);
        const bool is_there = std::ranges::any_of(
            listed.rows, [&](const ListedRecording& row) { return row.file == opened; });
        if (!opened.empty() && !is_there) {
          Result<std::vector<ListedRecording>> one = listFiles({opened}, progress);
          if (!one) return one.error();
          listed.rows.insert(listed.rows.begin(), one->front());
        }
        return listed;
      },
      [this](Result<Listed> listed) {
        if (!listed) return page_->showNoRecordings(toQt(listed.error().sentence()));
        if (listed->opened != opened_) return list();  // chosen while this was made
        show(listed->rows, true, listed->cases);
        choose_opened_ = false;
        if (std::exchange(replay_newest_, false) && !listed->rows.empty()) {
          page_->selectNewest();
          replay(listed->rows.front());
        }
      });
  list_again_ = !begun;
}

void ReviewWorkspace::show(const std::vector<ListedRecording>& rows, bool all,
                           const std::map<std::string, QString>& cases) {
  const Case* of = app_.workstation().currentCase();
  page_->showRecordings(rows, all, of ? of->sha256 : "", cases);
  // Once, as soon as it is there: then a person chooses.
  if (choose_opened_ && page_->select(opened_)) choose_opened_ = false;
}

void ReviewWorkspace::replay(const ListedRecording& of) {
  const Case* open = app_.workstation().currentCase();
  std::optional<Case> at_hand;
  if (open && open->sha256 == of.volume_sha256) at_hand = *open;
  const bool begun = replaying_.run(
      [of, at_hand, library = app_.library()](const Progress& progress) -> Result<ReplayResult> {
        Result<std::unique_ptr<SessionReader>> recording = SessionReader::open(of.file);
        if (!recording) return recording.error();
        std::optional<Case> on = at_hand;
        if (!on) {
          Result<Case> read = recordedCase(of, *library, Progress(progress, 0.0, 0.2));
          if (!read) return read.error();
          on = *std::move(read);
        }
        return trephine::replay(**recording, *on->volume, on->structures.get(),
                                Progress(progress, 0.2, 1.0), on->sha256);
      },
      [this](Result<ReplayResult> result) {
        if (!result) {
          if (result.error().code != code::kCancelled) app_.messages().report(result.error());
          return page_->showOutcome(result.error().code == code::kCancelled ? tr("Cancelled.")
                                                                            : QString());
        }
        QStringList words;
        words << (result->identical
                      ? tr("It replays bit for bit: all forces and all that was cut are the same.")
                      : tr("It replays differently from step %1 on.")
                            .arg(result->first_difference ? result->first_difference->tick : 0));
        for (const std::string& line : linesOf(result->structures_cut)) words << toQt(line);
        page_->showOutcome(words.join('\n'));
      });
  if (!begun) return;
  page_->showOutcome({});  // of the one before
  page_->showProgress(0.0, tr("Replaying"));
}

}  // namespace trephine
