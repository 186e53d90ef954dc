// usage: bench_nifti VOLUME [FOLDER]
// Bytes and seconds of the volume's .nii.gz: by zlib's own writer at its usual level, as it was
// written before, and by ours on one thread and on two. Files go to FOLDER, or /tmp, and away
// again.
#include <zlib.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

#include "unit/without_threads.h"
#include "volume/volume_files.h"

using namespace trephine;
namespace fs = std::filesystem;

namespace {

constexpr int kTimes = 3;

// Takes the least of a few times: others use the machine as well. Answers the bytes.
template <class Work>
double measure(const char* name, const fs::path& file, double before_bytes, const Work& work) {
  double best_s = 1e9, best_cpu_s = 1e9;
  for (int n = 0; n < kTimes; ++n) {
    const std::clock_t cpu = std::clock();
    const auto start = std::chrono::steady_clock::now();
    if (!work()) {
      std::fprintf(stderr, "%s: could not be written\n", name);
      std::exit(1);
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    best_s = std::min(best_s, took.count());
    best_cpu_s = std::min(best_cpu_s, double(std::clock() - cpu) / CLOCKS_PER_SEC);
  }
  const double bytes = double(fs::file_size(file));
  fs::remove(file);
  std::printf("%-24s %11.0f bytes", name, bytes);
  if (before_bytes > 0.0) std::printf(" (%+.2f %%)", 100.0 * (bytes / before_bytes - 1.0));
  std::printf(", best of %d: %.2f s, %.2f s of processor time\n", kTimes, best_s, best_cpu_s);
  return bytes;
}

bool asBefore(const Volume& volume, const fs::path& file) {
  const gzFile out = gzopen(file.c_str(), "wb");
  if (!out) return false;
  // Without the header: its 352 bytes make no difference.
  bool whole = true;
  slabsOf(volume).forEach([&](std::span<const std::int16_t> slab) {
    return whole = gzwrite(out, slab.data(), unsigned(slab.size_bytes())) > 0;
  });
  return gzclose(out) == Z_OK && whole;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2 || count > 3) {
    std::fprintf(stderr, "usage: bench_nifti VOLUME [FOLDER]\n");
    return 2;
  }
  const auto volume = readVolume(arguments[1]);
  if (!volume) {
    std::fprintf(stderr, "%s\n", volume.error().sentence().c_str());
    return 1;
  }
  const Index3& size = volume->geometry.size;
  std::printf("%d x %d x %d voxels\n", size[0], size[1], size[2]);
  const fs::path file = fs::path(count == 3 ? arguments[2] : "/tmp") / "bench_nifti.nii.gz";
  const double before =
      measure("zlib, level 6", file, 0.0, [&] { return asBefore(*volume, file); });
  {
    const test::WithoutThreads alone;
    measure("ours, one thread", file, before, [&] { return writeVolume(*volume, file).ok(); });
  }
  measure("ours, two threads", file, before, [&] { return writeVolume(*volume, file).ok(); });
  return 0;
}
