#include "ui/prepare/poke_forecast.h"

#include <algorithm>

#include "ui/common/colours.h"
#include "ui/common/plain_text.h"
#include "ui/common/words.h"
#include "ui/work/arms_of_place.h"

namespace trephine {

namespace {
constexpr int kSoon_ms = 250;  // after the last key of a number
}

PokeForecast::PokeForecast(Workstation& workstation, QObject* parent)
    : QObject(parent), workstation_(workstation), task_(this) {
  soon_.setSingleShot(true);
  soon_.setInterval(kSoon_ms);
  connect(&soon_, &QTimer::timeout, this, &PokeForecast::compute);
  connect(&task_, &BackgroundTask::ended, this, [this] {
    if (stale_) soon_.start();
  });
  connect(&workstation_, &Workstation::phaseChanged, this, [this] {
    if (stale_) soon_.start();
  });
}

void PokeForecast::setShown(bool shown) {
  shown_ = shown;
  if (shown_ && stale_) soon_.start();
}

void PokeForecast::renew() {
  stale_ = true;
  task_.cancel();
  soon_.start();
}

void PokeForecast::compute() {
  const std::optional<Exercise>& exercise = workstation_.exercise();
  // While an exercise runs its tick has the machine.
  const bool free = workstation_.phase() != Workstation::Phase::running && !task_.busy();
  if (!exercise || !shown_ || !stale_ || !free) return;
  stale_ = false;
  Exercise now = withForceLimit(*exercise, armSettings().most_N);
  now.tissues = workstation_.tissues();
  task_.run([now, rig = workstation_.rig()](
                const Progress& progress) { return pokesOf(now, rig, progress); },
            [this, now](Result<std::vector<ArmPokes>> pokes) {
              if (!pokes) return;
              exercise_ = now;
              pokes_ = *std::move(pokes);
              emit changed();
            });
}

// An arm before this one has the same tool and the same scales: its hand meets the same.
bool PokeForecast::isLikeAnother(std::size_t arm) const {
  const ExerciseArm& own = exercise_->arms[arm];
  for (std::size_t i = 0; i < arm; ++i) {
    const ExerciseArm& other = exercise_->arms[i];
    if (other.tool == own.tool && other.map.force_scale == own.map.force_scale &&
        other.map.motion_scale == own.map.motion_scale && other.max_force_N == own.max_force_N &&
        pokes_[i].friction_N == pokes_[arm].friction_N) {
      return true;
    }
  }
  return false;
}

std::vector<ForeseenPoke> PokeForecast::of(std::size_t tissue) const {
  std::vector<ForeseenPoke> all;
  for (const ArmPokes& pokes : pokes_) {
    if (tissue >= pokes.curves.size() || isLikeAnother(pokes.arm)) continue;
    const ExerciseArm& arm = exercise_->arms[pokes.arm];
    all.push_back({shownName(arm.tool), colours::ofArm(arm, pokes.arm), pokes.curves[tissue],
                   publishedBands(*exercise_, pokes.arm, tissue)});
  }
  return all;
}

double PokeForecast::friction_N() const {
  double most = 0.0;
  for (const ArmPokes& pokes : pokes_) most = std::max(most, pokes.friction_N);
  return most;
}

QString PokeForecast::hiddenWords(std::size_t tissue) const {
  QStringList lines;
  for (const ArmPokes& pokes : pokes_) {
    if (tissue >= pokes.curves.size() || isLikeAnother(pokes.arm)) continue;
    for (const std::string& line : trephine::hiddenWords(*exercise_, pokes, tissue)) {
      lines << toQt(line) + '.';
    }
  }
  return lines.join('\n');
}

}  // namespace trephine
