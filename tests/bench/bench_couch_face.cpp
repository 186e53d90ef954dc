// How long findCouch, findFace and the check of a cut face take on 512 x 512 x 300, and how much
// memory they hold at once.
#include <malloc.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <new>

#include "imaging/steps/couch.h"
#include "imaging/steps/face.h"
#include "imaging/steps/face_check.h"
#include "unit/imaging/painted.h"

namespace {
std::atomic<long long> g_held{0}, g_peak{0};
}  // namespace

void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (!memory) throw std::bad_alloc();
  const long long held = g_held += static_cast<long long>(malloc_usable_size(memory));
  if (held > g_peak) g_peak = held;
  return memory;
}
void operator delete(void* memory) noexcept {
  g_held -= static_cast<long long>(malloc_usable_size(memory));
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}

using namespace trephine;
using namespace trephine::test;

template <class Work>
void measure(const char* name, const Work& work) {
  const long long before = g_held;
  g_peak = before;
  double best = 1e9, best_cpu = 1e9;
  for (int n = 0; n < 20; ++n) {
    const std::clock_t cpu = std::clock();
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
    best_cpu = std::min(best_cpu, 1e3 * double(std::clock() - cpu) / CLOCKS_PER_SEC);
  }
  std::printf("%-12s best of 20: %.1f ms, %.1f ms of processor time, %.1f MB held at most\n", name,
              best, best_cpu, double(g_peak - before) / 1e6);
}

int main() {
  const Painted half = paint(centredGrid({256, 256, 150}, {1.9, 1.5, 2.4}), [](const Vec3& p) {
    const Matter couch = couchPlates(p, 125.0, 20.0);
    return couch.owner == Owner::couch ? couch : man(p);
  });
  Volume volume{half.volume.geometry, {}};
  volume.geometry.size = {512, 512, 300};
  volume.geometry.spacing_mm *= 0.5;
  volume.hu.resize(volume.geometry.voxelCount());
  for (int k = 0; k < 300; ++k) {
    for (int j = 0; j < 512; ++j) {
      for (int i = 0; i < 512; ++i) {
        volume.hu[volume.geometry.indexOf(i, j, k)] = half.volume.at(i / 2, j / 2, k / 2);
      }
    }
  }
  const CouchFinding finding = findCouch(volume);
  std::printf("couch %s, about %llu voxels\n", finding.found ? "found" : "NOT FOUND",
              static_cast<unsigned long long>(finding.voxels));
  measure("findCouch", [&] { (void)findCouch(volume); });
  measure("findFace", [&] { (void)findFace(volume, "HEAD"); });
  // What a face that is to be cut away costs beside that: twice the grid, once the look.
  measure("faceGrid", [&] { (void)faceGrid(volume); });
  const CoarseGrid grid = faceGrid(volume);
  measure("faceMarks", [&] { (void)findFaceMarks(grid); });
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t gone = removeCouch(volume, finding);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  std::printf("removeCouch  %llu voxels in %.0f ms\n", static_cast<unsigned long long>(gone),
              took.count());
  return finding.found ? 0 : 1;
}
