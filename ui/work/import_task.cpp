#include "ui/work/import_task.h"

#include <algorithm>

#include "base/codes.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "ui/common/words.h"
#include "ui/views/slice_image.h"

namespace trephine {

namespace {

constexpr int kThumbnailPixels = 160;  // sharp at twice the size it is shown at

struct ReadSeries {
  std::shared_ptr<const Volume> volume;
  CouchFinding couch;
  SourceIdentity identity;
};

bool asks(const ImportReport& report, const std::string& uid, Code code) {
  const auto series = std::ranges::find(report.series, uid, &SeriesReport::uid);
  return series != report.series.end() &&
         std::ranges::find(series->choices, code, &Choice::code) != series->choices.end();
}

}  // namespace

ImportTask::ImportTask(std::function<double()> given_back_mb, QObject* parent)
    : QObject(parent), given_back_mb_(std::move(given_back_mb)) {
  connect(&task_, &BackgroundTask::progressed, this, &ImportTask::progressed);
}

ImportTask::~ImportTask() = default;

void ImportTask::begin(std::function<void()> work) {
  if (task_.busy()) task_.cancel();
  working_ = true;
  cancelled_ = false;
  next_ = std::move(work);
  step();
}

void ImportTask::end(void (ImportTask::*done)()) {
  if (!next_) {  // else something else is wanted by now
    working_ = false;
    emit(this->*done)();
  }
  step();
}

template <class Outcome>
void ImportTask::endWithout(const Outcome& outcome) {
  if (!next_) {
    working_ = false;
    emit stopped();
    if (!outcome && outcome.error().code != code::kCancelled) emit failed(outcome.error());
  }
  step();
}

void ImportTask::scan(const std::filesystem::path& path) {
  wantNothing();
  emit scanBegan();
  const int number = ++scans_;
  guide_ = std::make_shared<ScanGuide>([this, number](const std::vector<FoundSeries>& series) {
    QMetaObject::invokeMethod(
        this,
        [this, number, series] {
          if (guide_ && number == scans_) emit found(series);
        },
        Qt::QueuedConnection);
  });
  begin([this, path, guide = guide_] {
    task_.run([path, guide](
                  const Progress& progress) { return CtFolder::scan(path, progress, guide.get()); },
              [this, path, guide](Result<CtFolder> scanned) {
                if (guide == guide_) guide_.reset();
                if (!scanned || cancelled_) return endWithout(scanned);
                folder_ = std::make_shared<CtFolder>(*std::move(scanned));
                source_ = path;
                report_ = folder_->report();
                label_files_ = folder_->labelFiles();
                names_.clear();
                const std::vector<ScreenNames> names = folder_->screenNames();
                for (std::size_t n = 0; n < names.size(); ++n)
                  names_[report_.series[n].uid] = names[n];
                best_ = guide->chosen();
                if (!best_ || !names_.contains(*best_)) best_ = folder_->bestSeries();
                volume_.reset();
                end(&ImportTask::scanned);
              });
  });
}

void ImportTask::takeFound(const std::string& uid) {
  if (guide_) guide_->choose(uid);
}

void ImportTask::read(const std::string& uid, const ImportRequest& request, double needed_mb) {
  if (!folder_) return;
  wanted_.reset();
  volume_.reset();  // there is room for one
  couch_ = {};
  begin([this, uid, request, needed_mb] {
    task_.run(
        [folder = folder_, source = source_, uid, request, needed_mb,
         room_mb = roomMb()](const Progress& progress) -> Result<ReadSeries> {
          if (Status enough = enoughMemory(
                  needed_mb, trephine::tr("Opening the case and practising on it"), "", room_mb);
              !enough) {
            return enough.error();
          }
          Result<Volume> volume = folder->read(uid, request, progress);
          if (!volume) return volume.error();
          ReadSeries read{
              std::make_shared<const Volume>(*std::move(volume)), {}, folder->sourceIdentity(uid)};
          read.identity.add(IdentityKind::folder, source.filename().string());
          if (asks(folder->report(), uid, code::kCouch) &&
              !request.answers.contains(code::kCouch)) {
            read.couch = findCouch(*read.volume);
          }
          return read;
        },
        [this](Result<ReadSeries> read) {
          report_ = folder_->report();  // a refusal is told there too
          label_files_ = folder_->labelFiles();
          if (!read || cancelled_) return endWithout(read);
          volume_ = std::move(read->volume);
          couch_ = std::move(read->couch);
          identity_ = std::move(read->identity);
          end(&ImportTask::readDone);
        });
  });
}

void ImportTask::cancel() {
  if (!working_) return;
  cancelled_ = true;
  if (!next_) return task_.cancel();
  next_ = {};
  working_ = false;
  emit stopped();
}

void ImportTask::wantSlice(const std::string& uid, int index) {
  wanted_ = {uid, index};
  step();
}

void ImportTask::wantThumbnails(const std::vector<std::string>& uids) {
  std::erase_if(pictures_, [](const Wanted& wanted) { return wanted.index < 0; });
  for (const std::string& uid : uids) pictures_.push_back({uid, -1});
  step();
}

void ImportTask::wantPictures(const std::string& uid, const std::vector<int>& slices) {
  std::erase_if(pictures_, [](const Wanted& wanted) { return wanted.index >= 0; });
  for (const int slice : slices) pictures_.push_front({uid, slice});
  step();
}

void ImportTask::wantNothing() {
  wanted_.reset();
  pictures_.clear();
}

void ImportTask::step() {
  if (task_.busy()) return;
  if (next_) {
    std::exchange(next_, {})();
  } else if (folder_ && wanted_) {
    readSlice(*std::exchange(wanted_, {}));
  } else if (folder_ && !pictures_.empty()) {
    const Wanted wanted = std::move(pictures_.front());
    pictures_.pop_front();
    makePicture(wanted);
  }
}

void ImportTask::readSlice(const Wanted& wanted) {
  task_.run(
      [folder = folder_, wanted](const Progress& progress) {
        return folder->slice(wanted.uid, wanted.index, progress);
      },
      [this, wanted](const Result<SlicePicture>& picture) {
        emit sliceReady(toQt(wanted.uid), wanted.index, picture);
        step();
      });
}

void ImportTask::makePicture(const Wanted& wanted) {
  const auto series = std::ranges::find(report_.series, wanted.uid, &SeriesReport::uid);
  if (series == report_.series.end()) return step();
  task_.run(
      [folder = folder_, uid = wanted.uid,
       index = wanted.index < 0 ? series->slices / 2 : wanted.index,
       is_ct = series->modality == "CT", turned = mirroringOf(series->geometry.direction)](
          const Progress& progress) -> Result<QImage> {
        const Result<SlicePicture> slice = folder->slice(uid, index, progress);
        if (!slice) return slice.error();
        const HuWindow window = is_ct ? kWideWindow : wholeRange(*slice);
        const double tall = double(slice->rows) * slice->spacing_mm.y;
        const double wide = double(slice->columns) * slice->spacing_mm.x;
        const double scale = kThumbnailPixels / std::max(tall, wide);
        return windowed(*slice, window)
            .mirrored(turned.across, turned.down)
            .scaled(std::max(1, int(wide * scale)), std::max(1, int(tall * scale)),
                    Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
      },
      [this, wanted](const Result<QImage>& made) {
        const QImage picture = made ? *made : QImage();
        if (wanted.index < 0) {
          emit thumbnailReady(toQt(wanted.uid), picture);
        } else {
          emit pictureReady(toQt(wanted.uid), wanted.index, picture);
        }
        step();
      });
}

}  // namespace trephine
