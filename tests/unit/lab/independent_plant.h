// A second opinion on stability_cell: the same cell from its equations, with another integrator
// (Runge-Kutta of order 4, 20 steps a period), its own delay, quantiser, law and figures.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <vector>

#include "haptics/controllers.h"
#include "lab/stability/stability_cell.h"

namespace trephine::test {

class IndependentPlant {
 public:
  // From a sample [m] to the force that is sent [N].
  using Answer = std::function<double(double sample_m)>;

  static CellResult run(const StabilityCell& cell, const Answer& answer) {
    constexpr int kSubsteps = 20;
    const double T = cell.period_s, h = T / kSubsteps;
    const int ticks = int(std::lround(2.0 / T));
    const int quarter = ticks - ticks / 4;
    std::deque<double> on_the_way(std::size_t(cell.delay_samples), 0.0);
    const double late = kSubsteps * (cell.delay_samples - std::floor(cell.delay_samples));
    std::vector<double> track;
    CellResult result;
    double x = 0.004, v = -0.05, before_N = 0.0, taken_J = 0.0;
    double error2 = 0.0, ideal2 = 0.0, contact2 = 0.0, contact_s = 0.0;
    for (int n = 0; n < ticks; ++n) {
      double sample = x;
      if (cell.encoder_m > 0.0) sample = cell.encoder_m * std::floor(x / cell.encoder_m + 0.5);
      on_the_way.push_back(answer(sample));
      const double held = before_N;
      double force = on_the_way.front();
      const double next = force;
      on_the_way.pop_front();
      track.push_back(x);
      if (n >= quarter) result.step_N += std::abs(force - before_N) / double(ticks - quarter);
      before_N = force;
      if (x < 0.0) {  // inside or not is asked where the tip was sampled
        contact2 += force * force * T;
        contact_s += T;
      }
      for (int i = 0; i < kSubsteps; ++i) {
        const double x_old = x, v_old = v;
        force = i < late ? held : next;
        rungeKutta(cell, force, n * T + i * h, h, x, v);
        const double ideal = idealForce(cell, 0.5 * (x_old + x), 0.5 * (v_old + v));
        ideal2 += ideal * ideal;
        error2 += (force - ideal) * (force - ideal);
        taken_J += force * (x - x_old);
        result.energy_out_J = std::max(result.energy_out_J, taken_J);
      }
      if (!(std::abs(x) < 1e3)) {
        result.stable = false;
        return result;
      }
    }
    result.oscillation_m = oscillation(track, int(std::lround(0.05 / T)));
    if (ideal2 > 0.0) result.fidelity_error = std::sqrt(error2 / ideal2);
    if (contact_s > 0.0) result.contact_rms_N = std::sqrt(contact2 / contact_s);
    result.stable = result.oscillation_m <= std::max(0.02e-3, 2.0 * cell.encoder_m) &&
                    result.step_N <= 0.1 &&
                    result.energy_out_J <= std::max(0.05e-3, 1.0 * cell.encoder_m);
    return result;
  }

  // The sampled law alone.
  static Answer off(const StabilityCell& cell) {
    return [=, last = 0.004, first = true](double sample) mutable {
      const double speed = first ? 0.0 : (sample - last) / cell.period_s;
      first = false;
      last = sample;
      if (sample >= 0.0) return 0.0;
      return limited(-cell.tissue.stiffness * sample - cell.tissue.damping * speed);
    };
  }

  static Answer controlled(const StabilityCell& cell, ControllerKind kind) {
    ArmDynamics arm;
    arm.apparent_mass_kg = cell.mass_kg;
    arm.encoder_step_m = cell.encoder_m;
    arm.peak_force_N = 3.3;
    arm.delay_s = cell.delay_samples * cell.period_s;
    return [=, controller = makeController(kind, arm, cell.period_s), last = 0.004, sent = 0.0,
            first = true](double sample) mutable {
      ControllerInput in;
      in.period_s = cell.period_s;
      in.position_m = {sample, 0.0, 0.0};
      in.velocity_m_s = {first ? 0.0 : (sample - last) / cell.period_s, 0.0, 0.0};
      in.last_sent_N = {sent, 0.0, 0.0};
      first = false;
      last = sample;
      if (sample < 0.0) {
        const Impedance allowed = limitImpedance(controller, cell.tissue);
        in.touching = true;
        in.rendered = springAndDamper({-allowed.stiffness * sample, 0.0, 0.0}, allowed.stiffness,
                                      allowed.damping);
        in.demanded_N.x =
            -cell.tissue.stiffness * sample - cell.tissue.damping * in.velocity_m_s.x;
      } else {
        limitImpedance(controller, {});
      }
      sent = limited(boundForce(controller, in).x);
      return sent;
    };
  }

 private:
  static double limited(double force) { return std::min(3.3, std::max(-3.3, force)); }

  static double idealForce(const StabilityCell& cell, double x, double v) {
    return x < 0.0 ? limited(-cell.tissue.stiffness * x - cell.tissue.damping * v) : 0.0;
  }

  static double acceleration(const StabilityCell& cell, double force, double t, double x,
                             double v) {
    const double rest = t < 0.3 ? 0.004 - 0.010 * t / 0.3 : -0.006;
    const double hand = -cell.hand.stiffness * (x - rest) - cell.hand.damping * v;
    return (force + hand - cell.plant_damping * v) / cell.mass_kg;
  }

  static void rungeKutta(const StabilityCell& cell, double force, double t, double h, double& x,
                         double& v) {
    const double v1 = v, a1 = acceleration(cell, force, t, x, v1);
    const double v2 = v + h / 2 * a1, a2 = acceleration(cell, force, t + h / 2, x + h / 2 * v1, v2);
    const double v3 = v + h / 2 * a2, a3 = acceleration(cell, force, t + h / 2, x + h / 2 * v2, v3);
    const double v4 = v + h * a3, a4 = acceleration(cell, force, t + h, x + h * v3, v4);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }

  // Towards the end the window narrows, so that it stays centred.
  static double oscillation(const std::vector<double>& track, int half) {
    const int n = int(track.size());
    double low = 1e300, high = -1e300;
    for (int i = n - n / 4; i < n; ++i) {
      const int w = std::min(half, n - 1 - i);
      double sum = 0.0;
      for (int j = i - w; j <= i + w; ++j) sum += track[std::size_t(j)];
      const double off_mean = track[std::size_t(i)] - sum / (2 * w + 1);
      low = std::min(low, off_mean);
      high = std::max(high, off_mean);
    }
    return high - low;
  }
};

}  // namespace trephine::test
