#include "imaging/common/detail/cielab.h"

#include <algorithm>
#include <cmath>

namespace trephine {

namespace {

// D50, and the primaries of sRGB as they look under it (IEC 61966-2-1, adapted by Bradford).
const Vec3 kWhite(0.96422, 1.0, 0.82521);
const Mat3 kLinearToXyz(0.4360747, 0.2225045, 0.0139322,   // red
                        0.3850649, 0.7168786, 0.0971045,   // green
                        0.1430804, 0.0606169, 0.7141733);  // blue

constexpr double kDelta = 6.0 / 29.0;  // below its cube, lightness is linear
constexpr double kWords = 65535.0;

double linearOf(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double gammaOf(double value) {
  return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
}

double rootOf(double t) {
  return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
}

double cubeOf(double t) {
  return t > kDelta ? t * t * t : 3.0 * kDelta * kDelta * (t - 4.0 / 29.0);
}

std::uint16_t wordOf(double share) {
  return std::uint16_t(std::lround(std::clamp(share, 0.0, 1.0) * kWords));
}

}  // namespace

LabWords labOf(const Vec3& srgb) {
  Vec3 linear;
  for (int n = 0; n < 3; ++n) linear[n] = linearOf(std::clamp(srgb[n], 0.0, 1.0));
  const Vec3 xyz = kLinearToXyz * linear / kWhite;
  const double x = rootOf(xyz.x), y = rootOf(xyz.y), z = rootOf(xyz.z);
  const double lightness = 116.0 * y - 16.0, a = 500.0 * (x - y), b = 200.0 * (y - z);
  return {wordOf(lightness / 100.0), wordOf((a + 128.0) / 255.0), wordOf((b + 128.0) / 255.0)};
}

Vec3 srgbOf(const LabWords& lab) {
  const double lightness = lab[0] / kWords * 100.0;
  const double a = lab[1] / kWords * 255.0 - 128.0, b = lab[2] / kWords * 255.0 - 128.0;
  const double y = (lightness + 16.0) / 116.0;
  const Vec3 xyz = Vec3(cubeOf(y + a / 500.0), cubeOf(y), cubeOf(y - b / 200.0)) * kWhite;
  const Vec3 linear = glm::inverse(kLinearToXyz) * xyz;
  Vec3 srgb;
  for (int n = 0; n < 3; ++n) srgb[n] = std::clamp(gammaOf(linear[n]), 0.0, 1.0);
  return srgb;
}

}  // namespace trephine
