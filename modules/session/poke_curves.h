// Force against depth while a tool is pushed into tissue that nothing cuts: the way in and out of
// each arm's last pokes. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "haptics/haptic_types.h"
#include "training/record_sink.h"

namespace trephine {

struct PokePoint {
  double depth_mm = 0.0;    // of the arm along the tool as it was where it met the tissue, patient mm
  double demanded_N = 0.0;  // lengths of the forces at the arm
  double sent_N = 0.0;
};

struct PokeCurve {
  std::size_t arm = 0;
  std::int32_t tissue = -1;  // where it pushed back most, of the exercise's
  double most_N = 0.0;       // sent
  bool ended = false;        // out of tissue again
  std::vector<PokePoint> points;
};

class PokeCurves : public RecordSink {
 public:
  static constexpr std::size_t kKept = 3;  // of those that have ended, of all arms together
  // A step that is worth a point; longer pokes keep every other one.
  static constexpr double kStep_mm = 0.02, kStep_N = 0.02;
  static constexpr std::size_t kMostPoints = 4000;
  // Out of tissue for so long it has ended; what was less deep or pressed less was no poke.
  static constexpr double kEnd_s = 0.1, kLeast_mm = 0.2, kLeast_N = 0.05;

  PokeCurves(std::size_t arms, double rate_hz);

  void tick(const TickRecord& record) override;
  // The oldest first; those that go on last, however small they are yet. Until the next tick().
  const std::vector<PokeCurve>& curves() const { return curves_; }

 private:
  struct Poke {
    Vec3 from_mm{0.0}, into{0.0};  // where it began and which way the tool pointed
    std::size_t out_ticks = 0;
    bool open = false;
  };
  PokeCurve* openOf(std::size_t arm);
  void begin(std::size_t arm, const ArmRecord& now);
  void end(std::size_t arm);
  static void addPoint(PokeCurve& curve, const PokePoint& point);

  std::size_t arms_, end_ticks_;
  std::array<Poke, kMaxArms> pokes_{};
  std::array<std::optional<Vec3>, kMaxArms> last_mm_{};  // where the arm was a tick before
  std::vector<PokeCurve> curves_;
};

}  // namespace trephine
