// Saving, in the background: the tissues, the voxels, and what others write.
#include <QTimer>

#include "base/file.h"
#include "base/purpose.h"
#include "tissue/tissue_edits.h"
#include "ui/work/workstation.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

// While a save waits for the haptic thread to stand still.
constexpr int kLookAgain_ms = 10;

Error busySaving() {
  return {"BUSY", "Another file is being saved", "", "Try again in a moment"};
}

}  // namespace

void Workstation::saveTissues(const std::filesystem::path& file, std::function<void()> then) {
  Json json = toJson(tissues());
  json["purpose"] = kPurpose;
  save(
      tr("The tissues are saved. A scene uses them where it names that file under 'tissues'."),
      [text = json.dump(1) + '\n', file](const Progress&) { return writeTextFile(file, text); },
      [this, saved = tissues(), then = std::move(then)] {
        tissuesSaved(saved);
        then();
      });
}

void Workstation::saveVolume(const std::filesystem::path& file, std::function<void()> then) {
  if (isSaving()) return fail(busySaving());
  if (phase_ == Phase::starting) {  // the view still shows the cuts before, which are gone
    return fail({"BUSY", "An exercise is being started", "", "Save once it runs, or has ended"});
  }
  if (session_) return saveOnceStill(file, std::move(then));
  save(
      tr("The volume is saved."),
      [carved = carved_, whole = placed_->patient.volume, file](const Progress& progress) {
        return writeVolume(carved ? slabsOf(*carved) : slabsOf(*whole), file, progress);
      },
      std::move(then));
}

// The grid is read where its writer stands still: in a pause, or once the exercise has ended.
void Workstation::saveOnceStill(const std::filesystem::path& file, std::function<void()> then) {
  save_waits_ = false;
  if (!session_) return saveVolume(file, std::move(then));
  if (phase_ == Phase::ending || !session_->freeze()) {
    save_waits_ = true;
    QTimer::singleShot(kLookAgain_ms, this,
                       [this, file, then = std::move(then)] { saveOnceStill(file, then); });
    return;
  }
  save(
      tr("The volume is saved."),
      [grid = session_->carved(), file](const Progress& progress) {
        return writeVolume(slabsOf(*grid), file, progress);
      },
      std::move(then),
      [this] {
        if (session()) session_->thaw();
      });
}

void Workstation::save(const QString& what, std::function<Status(const Progress&)> write,
                       std::function<void()> then, std::function<void()> afterwards) {
  const bool begun = !save_waits_ && saving_.run(std::move(write), [=, this](Status status) {
    if (afterwards) afterwards();
    if (!status) return fail(status.error());
    emit saved(what);
    if (then) then();
  });
  if (!begun) fail(busySaving());
}

}  // namespace trephine
