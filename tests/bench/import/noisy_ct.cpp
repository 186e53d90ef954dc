#include "bench/import/noisy_ct.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "imaging/common/workers.h"
#include "lab/import/import_series.h"
#include "volume/phantom.h"

namespace trephine::bench {

namespace {

constexpr double kNoiseHu = 15.0;
constexpr int kLowestHu = -1024, kHighestHu = 3071;

// The sum of a hash's eight bytes about its mean: variance 8 * (256^2 - 1) / 12 = 43690.
int whiteNoise(std::uint64_t n) {
  const std::uint64_t h = hashedNumber(n);
  int sum = -1020;
  for (int byte = 0; byte < 8; ++byte) sum += int(h >> (8 * byte) & 0xff);
  return sum;
}

// Every voxel of `coarse` becomes eight, interpolated linearly: weights 3/4 and 1/4 on each axis.
// Noise, correlated by 1-4-1 along rows and columns, is added.
class Refinement {
 public:
  Refinement(const Volume& coarse, Volume& fine) : coarse_(coarse), fine_(fine) {}

  void slice(int k) const {
    const Index3& size = fine_.geometry.size;
    const std::size_t nx = std::size_t(size[0]), ny = std::size_t(size[1]);
    // One more pixel on every side, which the smoothing takes away again.
    std::vector<int> noise((nx + 2) * (ny + 2)), rows(nx * (ny + 2));
    for (std::size_t n = 0; n < noise.size(); ++n) {
      noise[n] = whiteNoise(std::uint64_t(k) * noise.size() + n);
    }
    for (std::size_t j = 0; j < ny + 2; ++j) {
      for (std::size_t i = 0; i < nx; ++i) {
        const int* at = &noise[j * (nx + 2) + i];
        rows[j * nx + i] = at[0] + 4 * at[1] + at[2];
      }
    }
    static const double scale = kNoiseHu / (18.0 * std::sqrt(43690.0));  // 18 = 1 + 16 + 1
    std::int16_t* out = &fine_.hu[fine_.geometry.indexOf(0, 0, k)];
    for (std::size_t j = 0; j < ny; ++j) {
      for (std::size_t i = 0; i < nx; ++i) {
        const int* at = &rows[j * nx + i];
        const int smooth = at[0] + 4 * at[nx] + at[2 * nx];
        const double hu = interpolated(int(i), int(j), k) / 64.0 + smooth * scale;
        *out++ =
            std::int16_t(std::floor(std::clamp(hu, double(kLowestHu), double(kHighestHu)) + 0.5));
      }
    }
  }

 private:
  int interpolated(int i, int j, int k) const {
    const Index3& n = coarse_.geometry.size;
    const auto far = [](int at, int edge) {
      return std::clamp(at / 2 + (at % 2 == 0 ? -1 : 1), 0, edge - 1);
    };
    const int is[2] = {i / 2, far(i, n[0])}, js[2] = {j / 2, far(j, n[1])},
              ks[2] = {k / 2, far(k, n[2])};
    int sum = 0;
    for (int c = 0; c < 8; ++c) {
      const int weight = (c & 1 ? 1 : 3) * (c & 2 ? 1 : 3) * (c & 4 ? 1 : 3);
      sum += weight * coarse_.at(is[c & 1], js[c >> 1 & 1], ks[c >> 2]);
    }
    return sum;
  }

  const Volume& coarse_;
  Volume& fine_;
};

}  // namespace

// splitmix64's finaliser.
std::uint64_t hashedNumber(std::uint64_t n) {
  std::uint64_t h = (n + 1) * 0x9e3779b97f4a7c15;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9;
  h = (h ^ (h >> 27)) * 0x94d049bb133111eb;
  return h ^ (h >> 31);
}

Result<Volume> makeNoisyCt(const Index3& size, const Progress& progress) {
  if (Status can = checkSeriesSize(size); !can) return can.error();
  progress.at(0.0, "Making the phantom");
  const Result<PhantomTruth> truth = phantomTruth("cranium");
  if (!truth) return truth.error();
  const Volume coarse = makePhantomOn(
      *truth, headGeometry({(size[0] + 1) / 2, (size[1] + 1) / 2, (size[2] + 1) / 2}), 0.0);
  Volume fine{headGeometry(size), {}};
  fine.hu.resize(fine.geometry.voxelCount());
  const Refinement refinement(coarse, fine);
  const Status done = forEachFile(std::size_t(size[2]), progress, {0.5, 1.0, "Making the phantom"},
                                  [&](std::size_t k) { refinement.slice(int(k)); });
  if (!done) return done.error();
  return fine;
}

}  // namespace trephine::bench
