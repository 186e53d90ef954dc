#include "lab/stability/stability_cell.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "haptics/unseen_energy.h"
#include "lab/common/held_arm.h"

namespace trephine {

namespace {

constexpr int kParts = 8;  // of a period, for the ideal law and the energy

// Where the hand's rest point is, and how fast it moves.
struct RestPoint {
  bool swings = false;

  double at(double t) const {
    const double ramp =
        kCellStart_m + (kCellRest_m - kCellStart_m) * std::min(1.0, t / kCellRamp_s);
    return swings && t > kCellRamp_s ? ramp + kCellSwing_m * std::sin(phase(t)) : ramp;
  }
  double speedAt(double t) const {
    if (t < kCellRamp_s - 1e-9) return (kCellRest_m - kCellStart_m) / kCellRamp_s;
    return swings ? kCellSwing_m * kTurn * std::cos(phase(t)) : 0.0;
  }

 private:
  static constexpr double kTurn = 2.0 * std::numbers::pi * kCellSwing_Hz;
  static double phase(double t) { return kTurn * (t - kCellRamp_s); }
};

double idealForce(const Impedance& tissue, double x, double v) {
  if (x >= 0.0) return 0.0;
  return std::clamp(-tissue.stiffness * x - tissue.damping * v, -kCellForce_N, kCellForce_N);
}

// The chain of the loop in one dimension: law, controller, clamp.
class Chain {
 public:
  Chain(const StabilityCell& cell, CellDriver driver, double scale, const CellConditions& told)
      : zero_(driver == CellDriver::zero_force),
        tissue_{scale * cell.tissue.damping, scale * cell.tissue.stiffness},
        period_s_(cell.period_s),
        controller_(makeController(
            kindOf(driver),
            ArmDynamics{told.mass_claimed * cell.mass_kg,
                        told.encoder_claimed_exact ? 0.0 : cell.encoder_m, kCellForce_N,
                        cell.period_s * (cell.delay_samples + told.delay_claimed_more)},
            cell.period_s)) {}

  double tick(double sample_m) {
    const double moved_m = started_ ? sample_m - last_m_ : 0.0;
    started_ = true;
    last_m_ = sample_m;
    const bool inside = sample_m < 0.0;
    ControllerInput in;
    in.touching = inside;
    in.position_m.x = sample_m;
    in.velocity_m_s.x = moved_m / period_s_;
    in.last_sent_N.x = sent_N_;
    in.period_s = period_s_;
    const Impedance limited = limitImpedance(controller_, inside ? tissue_ : Impedance{});
    if (inside) {
      in.demanded_N.x = -tissue_.stiffness * sample_m - tissue_.damping * in.velocity_m_s.x;
      in.rendered = springAndDamper(Vec3(-limited.stiffness * sample_m, 0.0, 0.0),
                                    limited.stiffness, limited.damping);
    }
    sent_N_ = std::clamp(boundForce(controller_, in).x, -kCellForce_N, kCellForce_N);
    if (zero_) sent_N_ = 0.0;
    return sent_N_;
  }

  bool saysNotAsStated() const {
    return std::visit([](const auto& c) { return c.report().parts; }, controller_) &
           kPartArmNotAsStated;
  }

 private:
  static ControllerKind kindOf(CellDriver driver) {
    if (driver == CellDriver::seed) return ControllerKind::seed;
    if (driver == CellDriver::bounded) return ControllerKind::bounded;
    return ControllerKind::off;
  }

  bool zero_;
  Impedance tissue_;
  double period_s_;
  Controller controller_;
  bool started_ = false;
  double last_m_ = 0.0;
  double sent_N_ = 0.0;
};

// Peak to peak and frequency over the last quarter; under a hand that swings without its last
// 0.1 s, where the narrower mean would leave a part of the swing.
void judgeMotion(const std::vector<double>& x, double period_s, bool swings, CellResult& result) {
  const auto half = std::size_t(std::max(3.0, 0.05 / period_s));  // of 0.1 s
  std::vector<double> left = lessItsMean(x, half);
  if (swings) left = lessItsMean(left, half);
  const std::size_t first = x.size() - x.size() / 4;
  const std::size_t cut = swings ? std::size_t(0.1 / period_s) : 0;
  const std::size_t n = std::max(first, x.size() - std::min(x.size(), cut));
  const auto [low, high] =
      std::minmax_element(left.begin() + std::ptrdiff_t(first), left.begin() + std::ptrdiff_t(n));
  result.oscillation_m = first == n ? 0.0 : *high - *low;
  std::size_t upwards = 0;
  for (std::size_t i = first + 1; i < n; ++i) upwards += left[i - 1] < 0.0 && left[i] >= 0.0;
  result.cycle_Hz = n > first ? double(upwards) / (double(n - first) * period_s) : 0.0;
}

// The ideal law has no samples: its force follows the state in steps of 2 us, semi-implicitly. It
// is judged at the samples of the cell.
CellResult runIdeal(const StabilityCell& cell, const CellConditions& conditions) {
  constexpr double h = 2e-6;
  const RestPoint rest{conditions.moving};
  const double m = cell.mass_kg, b = cell.tissue.damping, k = cell.tissue.stiffness;
  const double c = cell.plant_damping + cell.hand.damping;
  const auto ticks = std::size_t(std::llround(conditions.seconds / cell.period_s));
  double x = kCellStart_m, v = kCellSpeed_m_s, squares = 0.0, given_J = 0.0, last_N = 0.0;
  std::size_t inside = 0;
  std::vector<double> positions;
  positions.reserve(ticks);
  CellResult result;
  for (std::size_t i = 0; double(i) * h < conditions.seconds; ++i) {
    const double t = double(i) * h;
    double force = 0.0;
    if (x < 0.0) {
      force = std::clamp(-(k * (x + v * h) + b * v) / (1.0 + (b + k * h) * h / m), -kCellForce_N,
                         kCellForce_N);
      squares += force * force;
      ++inside;
    }
    if (positions.size() < ticks && double(positions.size()) * cell.period_s <= t) {
      positions.push_back(x);
      if (positions.size() > ticks - ticks / 4) result.step_N += std::abs(force - last_N);
      last_N = force;
    }
    const double pull = -cell.hand.stiffness * (x - rest.at(t));
    const double before = v;
    v = (v + (force + pull) / m * h) / (1.0 + c * h / m);
    x += v * h;
    given_J += force * 0.5 * (before + v) * h;
    result.energy_out_J = std::max(result.energy_out_J, given_J);
  }
  result.contact_rms_N = inside > 0 ? std::sqrt(squares / double(inside)) : 0.0;
  if (ticks >= 4) result.step_N /= double(ticks / 4);
  judgeMotion(positions, cell.period_s, conditions.moving, result);
  result.stable = isStable(cell, result);
  return result;
}

}  // namespace

double unseenEnergy_J(const StabilityCell& cell) {
  return unseenEnergy_J(cell.encoder_m);
}

CellFaults faultsOf(const StabilityCell& cell, const CellResult& r) {
  // Not a number is a fault.
  return {!(r.oscillation_m <= std::max(2e-5, 2.0 * cell.encoder_m)), !(r.step_N <= 0.1),
          !(r.energy_out_J <= unseenEnergy_J(cell))};
}

bool isStable(const StabilityCell& cell, const CellResult& r) {
  return !faultsOf(cell, r).any();
}

CellResult runCell(const StabilityCell& cell, CellDriver driver, double tissue_scale,
                   const CellConditions& conditions) {
  if (driver == CellDriver::ideal) return runIdeal(cell, conditions);
  const double T = cell.period_s;
  const auto ticks = std::size_t(std::llround(conditions.seconds / T));
  const std::size_t last_quarter = ticks - ticks / 4;
  const HeldArm plant(cell.mass_kg, cell.plant_damping, cell.hand, T / kParts);
  const RestPoint rest{conditions.moving};
  Chain chain(cell, driver, tissue_scale, conditions);
  // A force begins to act with the part of a period in which its delay ends.
  const auto whole = std::size_t(cell.delay_samples);
  const int late_parts = int(std::lround(kParts * (cell.delay_samples - double(whole))));
  std::vector<double> pending(whole, 0.0);  // a ring
  std::size_t oldest = 0;
  std::vector<double> positions;
  positions.reserve(ticks);

  double x = kCellStart_m, v = kCellSpeed_m_s, last_N = 0.0;
  double put_in_J = 0.0, error2 = 0.0, ideal2 = 0.0, contact2 = 0.0;
  std::size_t inside = 0;
  CellResult result;
  for (std::size_t n = 0; n < ticks; ++n) {
    const double sample =
        cell.encoder_m > 0.0 ? std::round(x / cell.encoder_m) * cell.encoder_m : x;
    double next_N = chain.tick(sample);
    if (!pending.empty()) {
      std::swap(next_N, pending[oldest]);
      oldest = (oldest + 1) % pending.size();
    }
    double held_N = last_N;
    if (x < 0.0) {
      contact2 += next_N * next_N;
      ++inside;
    }
    if (n >= last_quarter) result.step_N += std::abs(next_N - last_N);
    last_N = next_N;
    positions.push_back(x);
    for (int part = 0; part < kParts; ++part) {
      const double t = (double(n) + double(part) / kParts) * T;
      const double x0 = x, v0 = v;
      if (part == late_parts) held_N = next_N;
      plant.step(x, v, held_N, rest.at(t), rest.speedAt(t));
      put_in_J -= held_N * (x - x0);
      result.energy_out_J = std::max(result.energy_out_J, -put_in_J);
      const double ideal = idealForce(cell.tissue, 0.5 * (x0 + x), 0.5 * (v0 + v));
      ideal2 += ideal * ideal;
      error2 += (held_N - ideal) * (held_N - ideal);
    }
    if (!(std::abs(x) < 1e3)) {  // gone
      result.oscillation_m = result.fidelity_error = 1e3;
      result.stable = false;
      return result;
    }
  }
  result.step_N /= double(ticks - last_quarter);
  judgeMotion(positions, T, conditions.moving, result);
  result.fidelity_error = ideal2 > 0.0 ? std::sqrt(error2 / ideal2) : 0.0;
  result.contact_rms_N = inside > 0 ? std::sqrt(contact2 / double(inside)) : 0.0;
  result.stable = isStable(cell, result);
  result.not_as_stated = chain.saysNotAsStated();
  return result;
}

CellReference referenceOf(const StabilityCell& cell, double seconds) {
  CellConditions conditions;
  conditions.seconds = seconds;
  const auto off = [&](double scale) { return runCell(cell, CellDriver::off, scale, conditions); };
  CellReference reference;
  reference.off = off(1.0);
  if (reference.off.stable) {
    reference.margin = off(2.0).stable;
    if (reference.margin) return reference;
    reference.scale = 1.0;
    reference.contact_rms_N = reference.off.contact_rms_N;
  } else {
    double low = std::log(0.01), high = 0.0;
    CellResult best = off(0.01);
    if (!best.stable) return reference;
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (low + high);
      const CellResult tried = off(std::exp(middle));
      if (tried.stable) {
        low = middle;
        best = tried;
      } else {
        high = middle;
      }
    }
    reference.scale = std::exp(low);
    reference.contact_rms_N = best.contact_rms_N;
  }
  if (*reference.contact_rms_N <= 1e-3) reference.contact_rms_N.reset();
  return reference;
}

std::vector<StabilityCell> fullGrid() {
  std::vector<Impedance> tissues;
  for (double b : {1.0, 5.0, 20.0, 50.0, 100.0, 1e3, 1e4}) tissues.push_back({b, 0.0});
  for (double k : {300.0, 1e3, 1e4, 1e6}) {
    for (double b : {0.0, 10.0}) tissues.push_back({b, k});
  }
  std::vector<StabilityCell> cells;
  for (double mass : {0.020, 0.045, 0.200}) {
    for (double period : {0.25e-3, 1e-3, 2e-3}) {
      for (double delay : {0.0, 1.0, 3.0}) {
        for (double encoder : {0.0, 0.055e-3, 0.2e-3}) {
          for (const Impedance& hand :
               {Impedance{}, Impedance{2.0, 300.0}, Impedance{10.0, 1000.0}}) {
            for (const Impedance& tissue : tissues) {
              cells.push_back({mass, period, delay, encoder, 0.05, hand, tissue});
            }
          }
        }
      }
    }
  }
  return cells;
}

}  // namespace trephine
