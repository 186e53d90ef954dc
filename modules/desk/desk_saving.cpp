// Saving, in the background: the tissues, the voxels, and what others write.
#include "base/codes.h"
#include "base/file.h"
#include "base/purpose.h"
#include "base/tr.h"
#include "desk/desk.h"
#include "tissue/tissue_set.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

Error busySaving() {
  return {code::kBusy, tr("Another file is being saved"), "", tr("Try again in a moment")};
}

}  // namespace

void Desk::save(const std::string& said, std::function<Status(const Progress&)> write,
                std::function<void()> then, std::function<void()> afterwards) {
  const bool begun = !waiting_save_ && saving_.run(std::move(write), [=, this](Status status) {
    if (afterwards) afterwards();
    if (!status) return fail(status.error());
    events_.onSaved(said);
    if (then) then();
  });
  if (!begun) fail(busySaving());
}

void Desk::saveTissues(const std::filesystem::path& file, const std::string& said,
                       std::function<void()> then) {
  Json json = toJson(tissues());
  json["purpose"] = kPurpose;
  save(
      said,
      [text = json.dump(1) + '\n', file](const Progress&) { return writeTextFile(file, text); },
      [this, saved = tissues(), then = std::move(then)] {
        tissuesSaved(saved);
        then();
      });
}

void Desk::saveVolume(const std::filesystem::path& file, const std::string& said,
                      std::function<void()> then) {
  if (isSaving()) return fail(busySaving());
  if (phase() == Phase::starting) {  // the view still shows the cuts before, which are gone
    return fail({code::kBusy, tr("An exercise is being started"), "",
                 tr("Save once it runs, or has ended")});
  }
  if (heldSession()) return saveOnceStill({file, said, std::move(then), {}});
  save(
      said,
      [carved = carved_, whole = placed_->patient.volume, file](const Progress& progress) {
        return writeVolume(carved ? slabsOf(*carved) : slabsOf(*whole), file, progress);
      },
      std::move(then));
}

// The grid is read where its writer stands still: in a pause, or once the session has ended.
void Desk::saveOnceStill(WaitingSave save) {
  if (!heldSession()) return saveVolume(save.file, save.said, std::move(save.then));
  if (phase() == Phase::ending || !session()->freeze()) {
    constexpr std::chrono::milliseconds kLookAgain{10};
    save.again = std::chrono::steady_clock::now() + kLookAgain;
    waiting_save_ = std::move(save);
    return;
  }
  this->save(
      save.said,
      [grid = session()->carved(), file = save.file](const Progress& progress) {
        return writeVolume(slabsOf(*grid), file, progress);
      },
      std::move(save.then),
      [this] {
        if (session()) session()->thaw();
      });
}

}  // namespace trephine
