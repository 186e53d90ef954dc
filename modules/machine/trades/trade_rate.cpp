// The rate of touch: the whole core with `bounded` on a simulated arm.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <sstream>

#include "base/tr.h"
#include "machine/common/quantile.h"
#include "machine/common/shell_phantom.h"
#include "machine/trades/trade_arm.h"
#include "machine/trades/trade_knobs.h"
#include "machine/trades/trade_stroke.h"

namespace trephine {

namespace {

constexpr double kReference_hz = 80000.0;
constexpr double kStep_s =
    1.0 / 160000.0;  // of the simulation: a whole number of them in every period
constexpr std::size_t kKept = 8;
constexpr double kBox_mm = 51.2;

// A hand, and where it wants to be: from 4 mm above the tissue to some mm within, along, and out.
struct HeldStroke {
  Vec3 along, aside_m;
  double deep_mm, length_mm, hand_stiffness, hand_damping;

  explicit HeldStroke(int stroke) {
    StrokeDice dice(stroke);
    along = dice.heading();
    aside_m = dice.heading();
    aside_m *= dice.between(0.0, 2e-3);
    deep_mm = dice.between(1.5, 4.0);
    length_mm = dice.between(10.0, 25.0);
    hand_stiffness = dice.between(150.0, 600.0);
    hand_damping = dice.between(1.0, 4.0);
  }
  Vec3 rest_m(double part) const {
    const auto ramp = [&](double from, double to) {
      return std::clamp((part - from) / (to - from), 0.0, 1.0);
    };
    const double z = 4.0 - (4.0 + deep_mm) * (ramp(0.0, 0.2) - ramp(0.75, 0.95));
    return aside_m + 1e-3 * ((length_mm * (ramp(0.25, 0.75) - 0.5)) * along + Vec3(0.0, 0.0, z));
  }
};

struct RateRun {
  std::vector<std::vector<Vec3>> sent_N;  // by stroke, at every kKept-th step of the simulation
  double tick_ns = 0.0;
};

HapticParameters parametersAt(double rate_hz, const ArmInHand& arm) {
  HapticParameters parameters = tradeParameters(
      makeBurr(1.5e-3, 16, 0, 0.05), tradeTissue(226, false, 1.0),
      {LawKind::viscous, LawKind::coulomb, LawKind::elastic}, ForceAt::tip, 1.0 / rate_hz);
  parameters.controller = ControllerKind::bounded;
  parameters.arms[0].dynamics.apparent_mass_kg = arm.mass_kg;
  parameters.arms[0].dynamics.encoder_step_m = arm.encoder_m;
  return parameters;
}

// False where it was cancelled.
bool runOneStroke(const HeldStroke& stroke, double rate_hz, ArmInHand arm, double duration_s,
                  Grid& grid, const Progress& progress, std::vector<Vec3>& at_steps_N,
                  std::vector<double>& ticks_ns) {
  arm.position_m = stroke.rest_m(0.0);
  arm.hand_stiffness = stroke.hand_stiffness;
  arm.hand_damping = stroke.hand_damping;
  HapticCore core(parametersAt(rate_hz, arm), *grid.takeWriter());
  const auto steps = std::size_t(std::llround(duration_s / kStep_s));
  const auto per_tick = std::size_t(std::llround(1.0 / (rate_hz * kStep_s)));
  TickInput input;
  TickRecord record;
  Vec3 sent_N(0.0);
  for (std::size_t n = 0; n < steps; ++n) {
    if (n % per_tick == 0) {
      if (progress.cancelled()) return false;
      input.arms[0].position_m = arm.reading_m();
      input.journal = core.journalState();
      const auto begin = std::chrono::steady_clock::now();
      core.tick(input, nullptr, 0, record);
      const std::chrono::duration<double, std::nano> took =
          std::chrono::steady_clock::now() - begin;
      ticks_ns.push_back(took.count());
      sent_N = record.arms[0].sent_N;
      ++input.tick;
    }
    arm.step(sent_N, stroke.rest_m(double(n) / double(steps)), kStep_s);
    if (n % kKept == 0) at_steps_N.push_back(sent_N);
  }
  return true;
}

std::optional<RateRun> runAt(double rate_hz, const ArmInHand& arm, const TradesOptions& options,
                             Grid& grid, const Progress& progress) {
  RateRun run;
  std::vector<double> ns;
  for (int n = 0; n < options.strokes; ++n) {
    const HeldStroke stroke(options.first_stroke + n);
    if (!runOneStroke(stroke, rate_hz, arm, options.stroke_s, grid, progress,
                      run.sent_N.emplace_back(), ns)) {
      return {};
    }
  }
  run.tick_ns = meanOf(ns);
  return run;
}

StrokeErrors wrongBy(const RateRun& run, const RateRun& reference) {
  std::vector<double> errors;
  for (std::size_t n = 0; n < run.sent_N.size(); ++n) {
    errors.push_back(rmsError_percent(run.sent_N[n], reference.sent_N[n]));
  }
  return overStrokes(std::move(errors));
}

std::string plain(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << value;
  return text.str();
}

}  // namespace

TradeRows tradeRate(const TradesOptions& options, const Progress& progress) {
  Volume volume;
  volume.geometry = cubeGeometry(128, kBox_mm, Vec3(0.0));
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  std::fill_n(volume.hu.begin(), volume.geometry.voxelCount() / 2, std::int16_t(1000));
  Grid grid(std::move(volume));
  // An encoder's steps make a noise of their own, some 11 % of the force at any rate, that would
  // hide what the rate does: both are without, and what they add is a figure beside.
  ArmInHand perfect;
  perfect.encoder_m = 0.0;
  const std::optional<RateRun> reference = runAt(kReference_hz, perfect, options, grid, progress);
  if (!reference) return tradesCancelled();
  const ArmDynamics dynamics = parametersAt(1000.0, ArmInHand()).arms[0].dynamics;
  std::vector<TradeRow> rows;
  for (double rate_hz : options.rates_hz) {
    const std::optional<RateRun> run = runAt(rate_hz, perfect, options, grid, progress);
    const std::optional<RateRun> with_encoder =
        runAt(rate_hz, ArmInHand(), options, grid, progress);
    if (!run || !with_encoder) return tradesCancelled();
    const Renderable most = renderable(dynamics, rate_hz, 0, WorkspaceMap());
    const StrokeErrors force = wrongBy(*run, *reference);
    TradeRow row;
    row.knob = "rate_hz";
    row.setting = plain(rate_hz);
    row.error = force.stated;
    row.error_unit = "% of force";
    row.cost = 100.0 * run->tick_ns * 1e-9 * rate_hz;
    row.cost_unit = "% of a CPU, one arm";
    row.reference =
        tr("RMS sent force at 80 kHz: a simulated arm of 45 g with a perfect encoder in a hand "
           "presses into bone and slides; {}",
           strokesWords(options.strokes));
    row.extra = {
        {"with_encoder_percent", wrongBy(*with_encoder, *reference).stated},
        {"error_median", force.median},
        {"error_most", force.most},
        {"b_max_Ns_per_m", most.b_max},
        {"k_max_N_per_m", most.k_max},
        {"bone_of_k_max_percent",
         100.0 * 2.0 * tradeTissue(226, true, 0.06).classes[0].stiffness_N_per_m / most.k_max},
        {"tick_ns", run->tick_ns}};
    rows.push_back(row);
  }
  return rows;
}

}  // namespace trephine
