#include "haptics/nearest_motion.h"

#include <cmath>
#include <limits>

namespace trephine {

namespace {

constexpr std::size_t kFree = 6;       // degrees of freedom of a body
constexpr double kOpen_mm = 2e-5;      // a gap more closed than this is closed
constexpr int kRounds = 60;            // at most
constexpr double kIndependent = 1e-5;  // of a squared length of about 1
constexpr double kPushes = 1e-12;

// All directions with turns in millimetres, so that the motion's cost is its squared length.
double dot(const SmallMotion& a, const SmallMotion& b) {
  return glm::dot(a.shift_mm, b.shift_mm) + glm::dot(a.turn, b.turn);
}

SmallMotion plus(const SmallMotion& a, double by, const SmallMotion& b) {
  return {a.shift_mm + by * b.shift_mm, a.turn + by * b.turn};
}

// The touches that hold the motion, with their loads, and their directions as Q R.
class ActiveSet {
 public:
  using Row = std::array<double, kFree>;

  std::size_t size() const { return count_; }
  double load(std::size_t i) const { return load_[i]; }
  std::size_t touch(std::size_t i) const { return touch_[i]; }

  // What of a direction the set leaves free; `parts`: what it has of each direction of Q.
  SmallMotion freePart(SmallMotion direction, std::size_t count, Row& parts) const {
    for (std::size_t i = 0; i < count; ++i) {
      parts[i] = dot(q_[i], direction);
      direction = plus(direction, -parts[i], q_[i]);
    }
    return direction;
  }
  // By how much of each of the set's directions the rest of it is made: R share = parts.
  Row shares(const Row& parts) const {
    Row share{};
    for (std::size_t i = count_; i-- > 0;) {
      double value = parts[i];
      for (std::size_t j = i + 1; j < count_; ++j) value -= r_[i][j] * share[j];
      share[i] = value / r_[i][i];
    }
    return share;
  }
  void unload(double by, const Row& share) {
    for (std::size_t i = 0; i < count_; ++i) load_[i] = std::max(0.0, load_[i] - by * share[i]);
  }
  void add(std::size_t touch, const SmallMotion& direction, double load) {
    touch_[count_] = touch;
    direction_[count_] = direction;
    load_[count_] = load;
    ++count_;
    factor(count_ - 1);
  }
  void remove(std::size_t which) {
    for (std::size_t i = which + 1; i < count_; ++i) {
      touch_[i - 1] = touch_[i];
      direction_[i - 1] = direction_[i];
      load_[i - 1] = load_[i];
    }
    --count_;
    factor(which);
  }

 private:
  void factor(std::size_t from) {
    for (std::size_t i = from; i < count_; ++i) {
      Row parts{};
      const SmallMotion rest = freePart(direction_[i], i, parts);
      const double size = std::sqrt(dot(rest, rest));
      for (std::size_t j = 0; j < i; ++j) r_[j][i] = parts[j];
      r_[i][i] = size;
      q_[i] = {rest.shift_mm / size, rest.turn / size};
    }
  }

  std::size_t count_ = 0;
  std::array<std::size_t, kFree> touch_;
  std::array<double, kFree> load_;
  std::array<SmallMotion, kFree> direction_, q_;
  std::array<Row, kFree> r_;
};

}  // namespace

SmallMotion nearestMotion(const SmallMotion& wanted, double turn_mm2,
                          std::span<NearTouch> touches) {
  constexpr double kNever = std::numeric_limits<double>::max();
  const double length_mm = std::sqrt(turn_mm2), per_length = 1.0 / length_mm;
  SmallMotion at{wanted.shift_mm, length_mm * wanted.turn};
  ActiveSet active;
  std::array<bool, kMostTouches> left_out{};
  const auto mostClosed = [&](double& open_mm) {
    std::size_t closed = touches.size();
    open_mm = -kOpen_mm;
    for (std::size_t i = 0; i < touches.size(); ++i) {
      const NearTouch& touch = touches[i];
      const double open = touch.gap_mm + glm::dot(touch.normal, at.shift_mm) +
                          per_length * glm::dot(touch.moment, at.turn);
      if (!(open < open_mm) || left_out[i]) continue;
      open_mm = open;
      closed = i;
    }
    return closed;
  };
  // Until it is open, or cannot be: goes along what the set leaves free of its direction; one of
  // the set whose load would turn into a pull on the way leaves it.
  const auto open = [&](std::size_t touch, double open_mm) {
    const SmallMotion direction{touches[touch].normal, per_length * touches[touch].moment};
    double load = 0.0;
    for (;;) {
      ActiveSet::Row parts{};
      const SmallMotion rest = active.freePart(direction, active.size(), parts);
      const double size2 = dot(rest, rest);
      const ActiveSet::Row share = active.shares(parts);
      std::size_t leaves = 0;
      double until = kNever;
      for (std::size_t i = 0; i < active.size(); ++i) {
        if (!(share[i] > kPushes) || !(active.load(i) < until * share[i])) continue;
        until = active.load(i) / share[i];
        leaves = i;
      }
      const bool gives = size2 > kIndependent && active.size() < kFree;
      const double whole = gives ? -open_mm / size2 : kNever;
      const double by = std::min(until, whole);
      if (by == kNever) return false;
      active.unload(by, share);
      load += by;
      if (gives) {
        at = plus(at, by, rest);
        open_mm += by * size2;
      }
      if (whole <= until) {
        active.add(touch, direction, load);
        return true;
      }
      active.remove(leaves);
    }
  };
  for (NearTouch& touch : touches) touch.load = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    double open_mm = 0.0;
    const std::size_t touch = mostClosed(open_mm);
    if (touch == touches.size()) break;
    left_out[touch] = !open(touch, open_mm);
  }
  for (std::size_t i = 0; i < active.size(); ++i) touches[active.touch(i)].load = active.load(i);
  return {at.shift_mm, per_length * at.turn};
}

}  // namespace trephine
