#include "ui/commission/fitness_line.h"

#include <QGuiApplication>
#include <QScreen>
#include <mutex>

#include "base/codes.h"
#include "base/log.h"
#include "base/system.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

CommissionFolders commissionFolders(const Policy& policy) {
  return {stateFolder().value_or(std::filesystem::path()), policy.folder};
}

FitnessLine::FitnessLine(Workstation& workstation, ViewWidget& view,
                         const std::filesystem::path& storage)
    : workstation_(workstation), view_(view), storage_(storage) {
  setObjectName("fitness");
  setContentsMargins(6, 0, 0, 0);
  setTextFormat(Qt::PlainText);
  connect(&workstation_, &Workstation::phaseChanged, this, [this] {
    if (!mayLook()) {
      again_ = again_ || looking_.busy();
      looking_.cancel();
    } else if (again_ && !looking_.busy()) {
      look();
    }
  });
}

bool FitnessLine::mayLook() const {
  using Phase = Workstation::Phase;
  const Phase phase = workstation_.phase();
  return phase == Phase::empty || phase == Phase::ready;
}

void FitnessLine::look() {
  if (looking_.busy()) {  // at what was before
    again_ = true;
    looking_.cancel();
    return;
  }
  again_ = !mayLook();
  if (again_) return;
  StartSurroundings here;
  here.storage = storage_;
  here.storage_is_set = storage_ == workstation_.policy().storage;
  here.driver = view_.openGlDescription();
  // All screens together, as a program without a window sees them.
  const QScreen* screen = QGuiApplication::primaryScreen();
  const QSizeF pixels = QSizeF(screen->virtualSize()) * screen->devicePixelRatio();
  // Qt counts whole points, which are fewer pixels where one has a fraction of them.
  here.screen = {qCeil(pixels.width()), qCeil(pixels.height())};
  looking_.run(
      [here, folders = commissionFolders(workstation_.policy()),
       arms = workstation_.opensArms()](const Progress& progress) -> Result<StartWords> {
        if (const auto away = storageWords(here)) return *away;
        const auto last = lastCommissioning(folders.own, folders.hospital);
        if (!last) return startWords({}, {});
        StartSurroundings with = here;
        std::unique_lock alone(*arms, std::defer_lock);
        with.arms = alone.try_lock_for(std::chrono::seconds(1));
        const auto now = checkAtStart(with, progress);
        if (!now) return now.error();
        return startWords(*last, *now);
      },
      [this](const Result<StartWords>& words) {
        if (again_) return look();
        if (words) {
          say(*words);
        } else if (words.error().code != code::kCancelled) {
          spdlog::warn("The check at the start: {}", words.error().what);
        }
        emit looked();
      });
}

void FitnessLine::say(const StartWords& words) {
  setText(toQt(words.words));
  setMore(toQt(words.all));
  colours::setText(*this, words.fitness == Fitness::pass   ? colours::kGood
                          : words.fitness == Fitness::warn ? colours::kCaution
                                                           : colours::kBad);
}

}  // namespace trephine
