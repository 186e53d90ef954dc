// Whether pictures for two eyes come fast enough to look around with. Below 45 new pairs a second
// for 2 s the picture is better a flat screen that stands still in the room; it comes back once
// pairs, which are tried now and then, are drawn fast enough again. Pure.
#pragma once

#include <deque>

namespace trephine {

struct PaceLimits {
  double least_hz = 45.0;  // new pairs; 0: any is fast enough
  double over_s = 2.0;
  double margin = 0.8;  // of the time that a pair may take, for it to come back
  int in_a_row = 3;     // pairs that were tried
};

class PaceRule {
 public:
  explicit PaceRule(const PaceLimits& limits = {}) : limits_(limits) {}
  // At every frame of the headset that shows something; `fresh`: a new pair.
  void frame(double now_s, bool fresh);
  // Nobody sees anything now: what follows is judged by itself.
  void pause() { begun_ = false; }
  // While the screen stands there: a pair that was tried took so long.
  void tried(double took_s);
  bool tooSlow() const { return too_slow_; }
  double pairs_hz() const { return pairs_hz_; }  // of the last 2 s; what made it too slow, then

 private:
  void begin(double now_s);

  PaceLimits limits_;
  bool too_slow_ = false, begun_ = false;
  double since_s_ = 0.0, pairs_hz_ = 0.0;
  std::deque<double> fresh_s_;
  int fast_ = 0;
};

}  // namespace trephine
