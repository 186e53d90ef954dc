#include "headset/pace_rule.h"

namespace trephine {

void PaceRule::begin(double now_s) {
  begun_ = true;
  since_s_ = now_s;
  fresh_s_.clear();
}

void PaceRule::frame(double now_s, bool fresh) {
  if (too_slow_) return;
  if (!begun_) begin(now_s);
  if (fresh) fresh_s_.push_back(now_s);
  while (!fresh_s_.empty() && fresh_s_.front() <= now_s - limits_.over_s) fresh_s_.pop_front();
  if (now_s - since_s_ < limits_.over_s) return;
  pairs_hz_ = double(fresh_s_.size()) / limits_.over_s;
  too_slow_ = pairs_hz_ < limits_.least_hz;
  fast_ = 0;
}

void PaceRule::tried(double took_s) {
  if (!too_slow_) return;
  fast_ = took_s * limits_.least_hz <= limits_.margin ? fast_ + 1 : 0;
  if (fast_ < limits_.in_a_row) return;
  too_slow_ = begun_ = false;
}

}  // namespace trephine
