// What the tests of the bounded controller share: arms, numbers, a tissue that is touched.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "haptics/bounded_controller.h"

namespace trephine::test {

constexpr double kT = 0.001;
constexpr double kOmniStep_m = 0.055e-3;

// `delay`: in periods of kT.
inline ArmDynamics arm(double mass_kg, double encoder_m, double delay = 0.0) {
  ArmDynamics dynamics;
  dynamics.apparent_mass_kg = mass_kg;
  dynamics.encoder_step_m = encoder_m;
  dynamics.delay_s = delay * kT;
  return dynamics;
}

// Numbers that are the same with every standard library.
class Numbers {
 public:
  explicit Numbers(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * (double(random_()) / 4294967296.0);
  }
  double decadesBetween(double low, double high) {
    return low * std::pow(high / low, between(0.0, 1.0));
  }
  Vec3 vector(double size) {
    const double x = between(-size, size), y = between(-size, size);
    return {x, y, between(-size, size)};
  }

 private:
  std::mt19937 random_;
};

// A tissue that fills x < 0, touched through a controller by whatever position is given.
struct Touch {
  BoundedController controller;
  Impedance tissue;
  double period_s;
  double last_m = 0.0;
  bool started = false;
  Vec3 sent_N{0.0};
  double demanded_N = 0.0;

  Touch(const ArmDynamics& dynamics, const Impedance& of_tissue, double T = kT)
      : controller(dynamics, T), tissue(of_tissue), period_s(T) {}

  double at(double x) {
    ControllerInput in;
    in.period_s = period_s;
    in.touching = x < 0.0;
    in.position_m.x = x;
    in.velocity_m_s.x = started ? (x - last_m) / period_s : 0.0;
    in.last_sent_N = sent_N;
    started = true;
    last_m = x;
    const Impedance allowed = controller.limit(in.touching ? tissue : Impedance{});
    if (in.touching) {
      in.demanded_N.x = -tissue.stiffness * x - tissue.damping * in.velocity_m_s.x;
      in.rendered =
          springAndDamper({-allowed.stiffness * x, 0.0, 0.0}, allowed.stiffness, allowed.damping);
    }
    demanded_N = in.demanded_N.x;
    sent_N = controller.bound(in);
    return sent_N.x;
  }
};

// An arm that nobody holds but a constant push, moved exactly by the forces that reach it.
struct SimulatedArm {
  double mass_kg;
  double period_s;
  double encoder_m;
  std::deque<double> on_the_way;
  double late_share;  // of a period, beyond whole ones
  double before_N = 0.0;
  double x = 0.002;
  double v = 0.0;
  double push_N = 0.0;
  double friction_N_s_m = 0.05;
  double given_J = 0.0;  // by the environment, net
  double most_given_J = 0.0;

  SimulatedArm(const ArmDynamics& dynamics, double T)
      : mass_kg(dynamics.apparent_mass_kg),
        period_s(T),
        encoder_m(dynamics.encoder_step_m),
        on_the_way(std::size_t(delaySamples(dynamics, T)), 0.0),
        late_share(delaySamples(dynamics, T) - double(on_the_way.size())) {}

  void tick(Touch& touch) {
    on_the_way.push_back(touch.at(encoder_m > 0.0 ? std::round(x / encoder_m) * encoder_m : x));
    const double next_N = on_the_way.front();
    on_the_way.pop_front();
    constexpr int kParts = 8;
    const double h = period_s / kParts;
    for (int i = 0; i < kParts; ++i) {
      const double force_N = i < kParts * late_share ? before_N : next_N;
      const double a = (force_N + push_N - friction_N_s_m * v) / mass_kg;
      const double moved = h * v + 0.5 * h * h * a;
      x += moved;
      v += h * a;
      given_J += force_N * moved;
      most_given_J = std::max(most_given_J, given_J);
    }
    before_N = next_N;
  }
};

}  // namespace trephine::test
