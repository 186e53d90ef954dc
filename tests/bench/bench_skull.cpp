// The skull and the skin of a head, and the tools that mend them: how like the known skull it is,
// and what each takes.
//   bench_skull    (the real CT of a skull where TREPHINE_TEST_DATA says)
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/memory.h"
#include "head_case.h"
#include "imaging/codes.h"
#include "imaging/importer.h"
#include "structures/shape_tools.h"
#include "structures/skin.h"
#include "structures/skull.h"

namespace {

using namespace trephine;

double seconds(const std::chrono::steady_clock::time_point& since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

void print(const char* name, const test::HeadCase& of) {
  const auto start = std::chrono::steady_clock::now();
  const auto skull = skullOf(of.volume);
  const double took_s = seconds(start);
  const auto percent = [&](const auto& which) {
    return 100.0 * double(of.count(skull->mask, which)) / double(skull->voxels);
  };
  std::printf(
      "%-28s Dice %.3f, %.0f mL, of it %.2f %% brain, %.2f %% scalp, %.1f %% of the neck; "
      "%.2f s\n",
      name, of.dice(skull->mask), skull->ml, percent(test::HeadCase::isBrain),
      percent([](PhantomTissue t) { return t == PhantomTissue::scalp; }),
      percent(
          [](PhantomTissue t) { return t == PhantomTissue::bone || t == PhantomTissue::marrow; }),
      took_s);
  std::fflush(stdout);
}

// Three times, and the memory of the first.
template <class Find>
void printCost(const char* name, const Find& find) {
  // What was freed before is given back, and the peak so far forgotten (proc(5), clear_refs).
  ::malloc_trim(0);
  if (std::FILE* refs = std::fopen("/proc/self/clear_refs", "w")) {
    std::fputs("5", refs);
    std::fclose(refs);
  }
  const double before_mb = residentMb();
  for (int turn = 0; turn < 3; ++turn) {
    const auto start = std::chrono::steady_clock::now();
    const double ml = find();
    std::printf("%s: %.2f s", name, seconds(start));
    if (turn == 0) std::printf(", %.0f MB more at its peak", peakResidentMb() - before_mb);
    std::printf("; %.0f mL\n", ml);
    std::fflush(stdout);
  }
}

}  // namespace

int main() {
  {
    const test::HeadCase head = test::builtInHead();
    print("built-in", head);
    test::HeadCase noisy = head;
    noisy.addNoise(25.0);
    print("built-in, 25 HU of noise", noisy);
    print("built-in, 1.5 mm", head.withSlices(1.5));
    print("built-in, 5 mm", head.withSlices(5.0));
  }
  if (const char* data = std::getenv("TREPHINE_TEST_DATA")) {
    auto ct = CtFolder::scan(std::filesystem::path(data) / "head-ct-plastic-skull", Progress());
    ImportRequest request;
    request.answers = {{code::kCouch, "remove"}};
    const auto volume = ct->read(*ct->bestSeries(), request, Progress());
    printCost("skull of plastic, 512x512x140", [&] { return skullOf(*volume)->ml; });
  }
  GridGeometry g = *phantomGeometry("cranium");
  const Vec3 extent = Vec3(g.size[0], g.size[1], g.size[2]) * g.spacing_mm;
  const Vec3 first = g.toPatient_mm(Vec3(-0.5));
  g.size = {512, 512, 300};
  g.spacing_mm = extent / Vec3(512, 512, 300);
  g.origin_mm = first + 0.5 * (g.direction * g.spacing_mm);
  const Volume large = makePhantomOn(*phantomTruth("cranium"), g, kPhantomNoiseHu);
  std::printf("512x512x300: a byte a voxel is 75 MB\n");
  printCost("skull, 512x512x300", [&] { return skullOf(large)->ml; });
  printCost("skin, 512x512x300", [&] { return skinOf(large)->ml; });
  LabelMap map = skullOf(large)->mask;
  const auto printTool = [&](const char* name, const auto& make) {
    const auto start = std::chrono::steady_clock::now();
    const auto edit = make();
    std::printf("%s: %.1f ms, %zu voxels in %.2f MB\n", name, 1000.0 * seconds(start), edit->voxels,
                double(edit->bytes()) / (1 << 20));
    std::fflush(stdout);
  };
  LabelMap fine{g, std::vector<std::uint8_t>(g.voxelCount())};
  fine.geometry.spacing_mm = Vec3(0.5);
  const Vec3 from = fine.geometry.toPatient_mm(Vec3(150, 150, 100));
  std::vector<Vec3> straight, bent;
  for (int n = 0; n <= 100; ++n) {
    straight.push_back(from + Vec3(0.6, 0.64, 0.48) * double(n));
    bent.push_back(from + 30.0 * Vec3(std::cos(n / 30.0), std::sin(n / 30.0), 0.01 * n));
  }
  Brush brush;
  brush.radius_mm = 10.0;
  for (int turn = 0; turn < 3; ++turn) {
    printTool("ball of 10 mm over 100 mm, straight, 0.5 mm",
              [&] { return brushEdit(fine, 1, straight, brush); });
    printTool("ball of 10 mm over 100 mm, bent, 0.5 mm",
              [&] { return brushEdit(fine, 1, bent, brush); });
  }
  printTool("skull, holes", [&] { return holesEdit(map, 1); });
  printTool("skull, holes in sagittal slices", [&] { return holesEdit(map, 1, 0); });
  printTool("skull, smoothed by 2 mm", [&] { return smoothEdit(map, 1, 2.0); });
  printTool("skull, the piece clicked",
            [&] { return keepPieceEdit(map, 1, Vec3(0.0, 90.0, 10.0)); });
  printTool("skull, shell of 2 mm", [&] { return shellEdit(map, 1, 2.0, 2); });
  printTool("skull, grown by 2 mm", [&] { return growEdit(map, 1, 2.0); });
  printTool("skull, shrunk by 1 mm", [&] { return shrinkEdit(map, 1, 1.0); });
}
