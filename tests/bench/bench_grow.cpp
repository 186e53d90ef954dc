// Growing a liver from a click: how like the known one it is, from where, and what it takes.
//   bench_grow [CLICKS]    (the real abdomen where TREPHINE_TEST_DATA says)
// Exit code 1 where one was below 0.75 without a warning.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "allocation_probe.h"
#include "liver_case.h"
#include "structures/grow.h"

namespace {

using namespace trephine;

int wrong = 0;  // below 0.75 without a warning

void print(const std::string& name, const test::LiverCase& of, const std::vector<Vec3>& clicks) {
  std::vector<double> dice, seconds;
  int leaked = 0, unsaid = 0, refused = 0;
  double hd95_mm = 0.0;
  for (const Vec3& click : clicks) {
    const auto start = std::chrono::steady_clock::now();
    const auto growth = grow(of.volume, click);
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (!growth) {
      ++refused;
      continue;
    }
    const Likeness like = of.against(growth->mask);
    dice.push_back(like.dice);
    hd95_mm = std::max(hd95_mm, like.hd95_mm);
    leaked += growth->leaked;
    unsaid += like.dice < 0.75 && !growth->leaked;
  }
  wrong += unsaid;
  std::sort(dice.begin(), dice.end());
  std::sort(seconds.begin(), seconds.end());
  std::printf(
      "%-36s %3zu clicks: Dice median %.3f, least %.3f, %d of %zu at least 0.85; "
      "hd95 at most %.1f mm; %d leaked, %d below 0.75 without, %d refused; %.2f s\n",
      name.c_str(), dice.size(), dice.empty() ? 0.0 : dice[dice.size() / 2],
      dice.empty() ? 0.0 : dice.front(),
      int(std::ranges::count_if(dice, [](double is) { return is >= 0.85; })), clicks.size(),
      hd95_mm, leaked, unsaid, refused, seconds[seconds.size() / 2]);
  std::fflush(stdout);
}

void printAll(const std::string& name, const test::LiverCase& of, int clicks) {
  print(name, of, of.clicks(clicks));
  print(name + ", 5 to 15 mm inside", of, of.clicks(clicks, 5.0, 15.0));
  print(name + ", in its vessels", of, of.vesselClicks(clicks));
  if (!of.in_capsule_mm.empty()) {
    print(name + ", in its capsule", of, of.some(of.in_capsule_mm, clicks, 1));
  }
  test::LiverCase other = of;
  other.addNoise(25.0);
  print(name + ", 25 HU of noise", other, of.clicks(clicks));
  print(name + ", 25 HU, 5 to 15 mm inside", other, of.clicks(clicks, 5.0, 15.0));
  other = of;
  other.addContrast(50.0);
  print(name + ", +50 HU", other, of.clicks(clicks));
  print(name + ", +50 HU, 5 to 15 mm inside", other, of.clicks(clicks, 5.0, 15.0));
  other = of.withSlices(1.5);
  print(name + ", 1.5 mm", other, other.clicks(clicks));
  other = of.withSlices(5.0);
  print(name + ", 5 mm", other, other.clicks(clicks));
  print(name + ", 5 mm, 5 to 15 mm inside", other, other.clicks(clicks, 5.0, 15.0));
}

}  // namespace

int main(int argc, char** argv) {
  const int clicks = argc > 1 ? std::max(1, std::atoi(argv[1])) : 50;
  const test::LiverCase built_in = test::builtInLiver();
  printAll("built-in", built_in, clicks);
  if (const char* data = std::getenv("TREPHINE_TEST_DATA")) {
    printAll("real", test::realLiver(data), clicks);
  }
  GridGeometry g = built_in.volume.geometry;
  const Vec3 extent = Vec3(g.size[0], g.size[1], g.size[2]) * g.spacing_mm;
  const Vec3 first = g.toPatient_mm(Vec3(-0.5));
  g.size = {512, 512, 300};
  g.spacing_mm = extent / Vec3(512, 512, 300);
  g.origin_mm = first + 0.5 * (g.direction * g.spacing_mm);
  test::LiverCase large{makePhantomOn(*phantomTruth("abdomen"), g, kPhantomNoiseHu),
                        *fitTo(built_in.liver, g), 0, 300};
  const Vec3 click = built_in.clicks(1).front();
  for (int turn = 0; turn < 3; ++turn) {
    const long long before = test::allocated_bytes;
    test::forgetMostAllocated();
    const auto start = std::chrono::steady_clock::now();
    const auto growth = grow(large.volume, click);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double more_mb = double(test::most_allocated_bytes - before) / (1 << 20);
    std::printf("512x512x300: %.2f s, %.0f MB at its peak (a byte a voxel: 75 MB); Dice %.3f\n",
                seconds, more_mb, growth ? large.against(growth->mask).dice : 0.0);
  }
  return wrong > 0 ? 1 : 0;
}
