#include "lab/common/held_arm.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

using Matrix = std::array<std::array<double, 5>, 5>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 5; ++j) {
      for (std::size_t l = 0; l < 5; ++l) out[i][j] += a[i][l] * b[l][j];
    }
  }
  return out;
}

}  // namespace

HeldArm::HeldArm(double mass_kg, double damping_Ns_per_m, const Impedance& hand, double step_s) {
  Matrix M{};
  M[0][1] = 1.0;
  M[1][0] = -hand.stiffness / mass_kg;
  M[1][1] = -(damping_Ns_per_m + hand.damping) / mass_kg;
  M[1][2] = 1.0 / mass_kg;
  M[1][3] = hand.stiffness / mass_kg;
  M[3][4] = 1.0;
  // exp by scaling and squaring: 15 terms of the series of M h / 2^n.
  double norm = 0.0;
  for (const auto& row : M) {
    double sum = 0.0;
    for (double value : row) sum += std::abs(value * step_s);
    norm = std::max(norm, sum);
  }
  int squarings = 0;
  for (; norm > 0.25; norm /= 2.0) ++squarings;
  const double part_s = std::ldexp(step_s, -squarings);
  Matrix term{}, result{};
  for (std::size_t i = 0; i < 5; ++i) term[i][i] = result[i][i] = 1.0;
  for (int order = 1; order <= 15; ++order) {
    term = product(term, M);
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = 0; j < 5; ++j) {
        term[i][j] *= part_s / order;
        result[i][j] += term[i][j];
      }
    }
  }
  for (; squarings > 0; --squarings) result = product(result, result);
  position_ = result[0];
  velocity_ = result[1];
}

std::vector<double> lessItsMean(const std::vector<double>& x, std::size_t half) {
  const std::size_t n = x.size();
  std::vector<double> sum(n + 1, 0.0), left(n);
  for (std::size_t i = 0; i < n; ++i) sum[i + 1] = sum[i] + x[i];
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t h = std::min({half, i, n - 1 - i});
    left[i] = x[i] - (sum[i + h + 1] - sum[i - h]) / double(2 * h + 1);
  }
  return left;
}

}  // namespace trephine
