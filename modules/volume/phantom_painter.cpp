// Every voxel near a boundary is parted into 3 x 3 x 3 bins. A bin has the HU of its middle; where
// a boundary runs through it, the share beyond, found by bisection along the axis that meets the
// boundary most squarely. A Gaussian over the bins, one axis after the other, makes the voxels.
#include "volume/phantom_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr std::uint64_t kNoiseSeed = 0x5452455048494e45;
constexpr int kBins = 3;   // of a voxel, on each axis
constexpr int kChunk = 4;  // slices that are worked on together
// HU: a step of less is seen at nine places a voxel and lies within the noise of where it should.
constexpr int kSoftStep = 180;
constexpr int kOne = 1 << 14;  // the sum of a kernel's weights
constexpr int kPerHu = 8;      // what has passed a kernel is in eighths of HU

// The sum of the eight bytes of a hash of a voxel's index (splitmix64's finaliser): nearly normal,
// with the mean 8 * 127.5 and the variance 8 * (256^2 - 1) / 12.
constexpr int kMostOfBytes = 8 * 255;
std::size_t sumOfBytes(std::uint64_t index) {
  std::uint64_t h = (index + 1) * 0x9e3779b97f4a7c15 + kNoiseSeed;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9;
  h = (h ^ (h >> 27)) * 0x94d049bb133111eb;
  h ^= h >> 31;
  h = (h & 0x00ff00ff00ff00ff) + (h >> 8 & 0x00ff00ff00ff00ff);  // four sums of 16 bits
  return std::size_t(h * 0x0001000100010001 >> 48);
}

// e^-x without the library's, which differs between machines: (e^(-x / 1024))^1024.
double expOfMinus(double x) {
  const double t = x / 1024.0;
  double e = 1.0 - t + t * t / 2.0 - t * t * t / 6.0;
  for (int n = 0; n < 10; ++n) e *= e;
  return e;
}

// The weights of the bins around a voxel's middle on one axis, and how many voxels they reach over.
struct Kernel {
  int reach = 0;
  std::vector<std::int16_t> weights;  // kBins * (2 reach + 1), their sum kOne

  explicit Kernel(double spacing_mm) {
    const double spread_mm = std::max(kPhantomSpread_mm, kPhantomSpread_voxels * spacing_mm);
    const double bin_mm = spacing_mm / kBins;
    // The bins are a box that spreads as well.
    const double variance = spread_mm * spread_mm - bin_mm * bin_mm / 12.0;
    reach = int(std::ceil(3.0 * spread_mm / spacing_mm - 0.5));
    const int side = kBins / 2 + kBins * reach;
    std::vector<double> shape;
    double sum = 0.0;
    for (int n = -side; n <= side; ++n) {
      shape.push_back(expOfMinus(n * bin_mm * n * bin_mm / (2.0 * variance)));
      sum += shape.back();
    }
    int total = 0;
    for (double s : shape) {
      weights.push_back(std::int16_t(std::floor(kOne * s / sum + 0.5)));
      total += weights.back();
    }
    weights[std::size_t(side)] = std::int16_t(weights[std::size_t(side)] + kOne - total);
  }
};

std::int16_t rounded(int weighted) {
  return std::int16_t((weighted + kOne / 2) >> 14);
}

// A bin of a voxel's 27 in the middle of an edge or a face, and the corners around it.
struct BinBetween {
  std::size_t bin;
  std::array<std::size_t, 4> corners;  // an edge's two twice
  bool face;
};
constexpr std::array<BinBetween, 18> betweenCorners() {
  std::array<BinBetween, 18> all{};
  std::size_t n = 0;
  for (std::size_t s = 0; s < 27; ++s) {
    std::size_t across[2] = {0, 0}, middles = 0;
    for (std::size_t stride : {1, 3, 9}) {
      if (s / stride % 3 == 1 && middles++ < 2) across[middles - 1] = stride;
    }
    if (middles != 1 && middles != 2) continue;
    const auto [u, v] = across;
    all[n++] = {s, {s - u - v, s - u + v, s + u - v, s + u + v}, middles == 2};
  }
  return all;
}
constexpr std::array<BinBetween, 18> kBetween = betweenCorners();

class Painter {
 public:
  Painter(PhantomTruth truth, const std::vector<PhantomTissue>& centres, Volume& volume)
      : truth_(truth),
        centres_(centres),
        volume_(volume),
        affine_(volume.geometry.voxelToPatient()),
        nx_(volume.geometry.size[0]),
        ny_(volume.geometry.size[1]),
        nz_(volume.geometry.size[2]),
        kernels_{Kernel(volume.geometry.spacing_mm.x), Kernel(volume.geometry.spacing_mm.y),
                 Kernel(volume.geometry.spacing_mm.z)},
        layer_(std::size_t(nx_) * std::size_t(ny_) * kBins * kBins),
        bins_(std::size_t(kChunk + 2)),
        spread_(std::size_t(kChunk + 2 * kernels_[2].reach)) {}

  void paint() {
    for (auto& slice : bins_) slice.values.resize(layer_ * kBins);
    for (auto& slice : spread_) slice.resize(std::size_t(nx_) * std::size_t(ny_) * kBins);
    const int reach = kernels_[2].reach;
    // Bins lead; their neighbours' let them be refined one slice later, and a voxel needs `reach`
    // slices beyond its own.
    for (int first = 0; first < nz_ + 1 + reach; first += kChunk) {
      over(first, [this](int k) { fillBins(k); });
      over(first - 1, [this](int k) { spreadInPlane(k); });
      over(first - 1 - reach, [this](int k) { finish(k); });
    }
  }

 private:
  struct Slice {
    std::vector<std::int16_t> values;        // HU: layer, row of bins, bin
    std::vector<std::uint8_t> nearBoundary;  // by voxel: 0, or how closely it is looked at
  };
  enum Look : std::uint8_t { uniform, softly, closely };

  template <class Work>
  void over(int first, const Work& work) {
    onTwoThreads(kChunk, [&](int n) {
      const int k = first + n;
      if (k >= 0 && k < nz_) work(k);
    });
  }

  Slice& binsOf(int k) { return bins_[std::size_t(k) % bins_.size()]; }
  std::vector<std::int16_t>& spreadOf(int k) { return spread_[std::size_t(k) % spread_.size()]; }
  std::size_t binAt(int a, int b, int layer) const {
    return (std::size_t(layer) * std::size_t(ny_) * kBins + std::size_t(b)) *
               (std::size_t(nx_) * kBins) +
           std::size_t(a);
  }

  // In voxels.
  std::int16_t huAt(double i, double j, double k) const {
    return phantomHu(truth_(Vec3(affine_[0]) * i + Vec3(affine_[1]) * j + Vec3(affine_[2]) * k +
                            Vec3(affine_[3])));
  }

  // How much the HU of a voxel and its six neighbours differ.
  Look lookAt(int i, int j, int k) const {
    const auto nx = std::size_t(nx_), nxy = nx * std::size_t(ny_);
    const std::size_t index = volume_.geometry.indexOf(i, j, k);
    const PhantomTissue own = centres_[index];
    int low = phantomHu(own), high = low;
    bool differs = false;
    const auto see = [&](PhantomTissue other) {
      if (other == own) return;
      differs = true;
      low = std::min(low, int(phantomHu(other)));
      high = std::max(high, int(phantomHu(other)));
    };
    if (i > 0) see(centres_[index - 1]);
    if (i + 1 < nx_) see(centres_[index + 1]);
    if (j > 0) see(centres_[index - nx]);
    if (j + 1 < ny_) see(centres_[index + nx]);
    if (k > 0) see(centres_[index - nxy]);
    if (k + 1 < nz_) see(centres_[index + nxy]);
    return !differs ? uniform : high - low <= kSoftStep ? softly : closely;
  }

  void fillBins(int k) {
    Slice& slice = binsOf(k);
    slice.nearBoundary.resize(std::size_t(nx_) * std::size_t(ny_));
    std::size_t index = volume_.geometry.indexOf(0, 0, k);
    for (int j = 0; j < ny_; ++j) {
      for (int i = 0; i < nx_; ++i, ++index) {
        const Look look = lookAt(i, j, k);
        slice.nearBoundary[std::size_t(j) * std::size_t(nx_) + std::size_t(i)] = look;
        std::array<std::int16_t, 27> hu;
        hu.fill(phantomHu(centres_[index]));
        if (look != uniform) look27(i, j, k, hu);
        for (int s = 0; s < 27; s += 3) {
          std::copy_n(&hu[std::size_t(s)], 3,
                      &slice.values[binAt(kBins * i, kBins * j + s / 3 % 3, s / 9)]);
        }
      }
    }
  }

  // The bins of a voxel, `hu` being that of its middle. First the corners on the sides where its
  // neighbours differ; between corners that are the same, nothing else is looked for.
  void look27(int i, int j, int k, std::array<std::int16_t, 27>& hu) const {
    const auto at = [&](int s) {
      return huAt(i + (s % 3 - 1) / 3.0, j + (s / 3 % 3 - 1) / 3.0, k + (s / 9 - 1) / 3.0);
    };
    const std::array<std::array<bool, 3>, 3> differs = sidesThatDiffer(i, j, k);
    int sum = hu[13], low = sum, high = sum;
    for (int s : {0, 2, 6, 8, 18, 20, 24, 26}) {
      const auto x = std::size_t(s % 3), y = std::size_t(s / 3 % 3), z = std::size_t(s / 9);
      if (differs[0][x] || differs[1][y] || differs[2][z]) hu[std::size_t(s)] = at(s);
      sum += hu[std::size_t(s)];
      low = std::min<int>(low, hu[std::size_t(s)]);
      high = std::max<int>(high, hu[std::size_t(s)]);
    }
    if (low == high) return;  // the boundary is its neighbour's
    const bool close = high - low > kSoftStep;
    const auto mean = std::int16_t(std::floor(sum / 9.0 + 0.5));
    for (const BinBetween& bin : kBetween) {
      const std::int16_t corner = hu[bin.corners[0]];
      const bool same = hu[bin.corners[1]] == corner && hu[bin.corners[2]] == corner &&
                        hu[bin.corners[3]] == corner && (!bin.face || hu[13] == corner);
      hu[bin.bin] = !close ? mean : same ? corner : at(int(bin.bin));
    }
  }

  // By axis, and 0 or 2 for the lower and the higher neighbour.
  std::array<std::array<bool, 3>, 3> sidesThatDiffer(int i, int j, int k) const {
    const std::size_t strides[] = {1, std::size_t(nx_), std::size_t(nx_) * std::size_t(ny_)};
    const int at[] = {i, j, k}, size[] = {nx_, ny_, nz_};
    const std::size_t index = volume_.geometry.indexOf(i, j, k);
    std::array<std::array<bool, 3>, 3> differs{};
    for (std::size_t n = 0; n < 3; ++n) {
      differs[n][0] = at[n] > 0 && centres_[index - strides[n]] != centres_[index];
      differs[n][2] = at[n] + 1 < size[n] && centres_[index + strides[n]] != centres_[index];
    }
    return differs;
  }

  // A bin and its six neighbours, HU; those beyond the volume are as the last ones within.
  struct Around {
    int own;
    std::array<std::array<int, 2>, 3> beside;

    bool differs() const {
      for (const auto& [low, high] : beside) {
        if (std::abs(low - own) > kSoftStep || std::abs(high - own) > kSoftStep) return true;
      }
      return false;
    }
  };
  Around around(int a, int b, int c) {
    const std::size_t row = std::size_t(nx_) * kBins, at = binAt(a, b, c % kBins);
    const std::int16_t* here = &binsOf(c / kBins).values[at];
    const auto beyond = [&](int layer) -> int {
      layer = std::clamp(layer, 0, kBins * nz_ - 1);
      return binsOf(layer / kBins).values[binAt(a, b, layer % kBins)];
    };
    const int last_a = kBins * nx_ - 1, last_b = kBins * ny_ - 1;
    return {*here,
            {{{a > 0 ? here[-1] : *here, a < last_a ? here[1] : *here},
              {b > 0 ? *(here - row) : *here, b < last_b ? here[row] : *here},
              {beyond(c - 1), beyond(c + 1)}}}};
  }

  // A bin's HU with the share of what lies beyond a boundary through it.
  std::int16_t refined(int a, int b, int c, const Around& bins) {
    const int own = bins.own;
    const auto& beside = bins.beside;
    int axis = 0;
    double steepest = 0.0;
    for (int n = 0; n < 3; ++n) {
      const auto& [low, high] = beside[std::size_t(n)];
      // A thin sheet has the same on both sides.
      const int across =
          std::max(std::abs(high - low), std::min(std::abs(high - own), std::abs(low - own)));
      const double steep = across / volume_.geometry.spacing_mm[n];
      if (steep > steepest) steepest = steep, axis = n;
    }
    double hu = own;
    for (int side = 0; side < 2; ++side) {
      if (std::abs(beside[std::size_t(axis)][std::size_t(side)] - own) <= kSoftStep) continue;
      Vec3 middle((a - 1) / 3.0, (b - 1) / 3.0, (c - 1) / 3.0), along(0.0);
      along[axis] = (side == 0 ? -1.0 : 1.0) / kBins;
      const auto seen = [&](double share) {
        const Vec3 v = middle + along * share;
        return huAt(v.x, v.y, v.z);
      };
      const int other = seen(0.5);
      if (other == own) continue;  // the boundary runs through the bin beside
      double low = 0.0, high = 0.5;
      for (int n = 0; n < 3; ++n) {
        const double half = 0.5 * (low + high);
        (seen(half) == own ? low : high) = half;
      }
      hu += (0.5 - 0.5 * (low + high)) * (other - own);
    }
    return std::int16_t(std::floor(hu + 0.5));
  }

  // The bins of a slice through the kernels of x and y: three layers of one value a voxel.
  void spreadInPlane(int k) {
    const Slice& slice = binsOf(k);
    std::vector<std::int16_t>& out = spreadOf(k);
    const auto nx = std::size_t(nx_), rows = std::size_t(ny_) * kBins;
    std::vector<std::int16_t> wide(nx * kBins), narrow(nx * rows);
    for (int layer = 0; layer < kBins; ++layer) {
      for (int b = 0; b < ny_ * kBins; ++b) {
        const std::uint8_t* looks = &slice.nearBoundary[std::size_t(b / kBins) * nx];
        std::copy_n(&slice.values[binAt(0, b, layer)], wide.size(), wide.begin());
        for (int i = 0; i < nx_; ++i) {
          if (looks[i] == uniform) continue;
          for (int a = kBins * i; a < kBins * (i + 1); ++a) {
            const Around bins = around(a, b, kBins * k + layer);
            if (bins.differs()) wide[std::size_t(a)] = refined(a, b, kBins * k + layer, bins);
          }
        }
        spreadRow(wide, looks, &narrow[std::size_t(b) * nx]);
      }
      spreadColumns(narrow, &out[std::size_t(layer) * nx * std::size_t(ny_)]);
    }
  }

  void spreadRow(const std::vector<std::int16_t>& bins, const std::uint8_t* looks,
                 std::int16_t* out) const {
    const Kernel& kernel = kernels_[0];
    const int taps = int(kernel.weights.size()), last = kBins * nx_ - 1;
    int unlike = 0;  // voxels within reach that are near a boundary
    for (int i = 0; i < std::min(kernel.reach, nx_); ++i) unlike += looks[i] != uniform;
    for (int i = 0; i < nx_; ++i) {
      if (i + kernel.reach < nx_) unlike += looks[i + kernel.reach] != uniform;
      if (i > kernel.reach) unlike -= looks[i - kernel.reach - 1] != uniform;
      if (unlike == 0) {
        out[i] = std::int16_t(kPerHu * bins[std::size_t(kBins * i)]);
        continue;
      }
      const int from = kBins * (i - kernel.reach);
      int sum = 0;
      if (from >= 0 && from + taps - 1 <= last) {
        const std::int16_t* bin = &bins[std::size_t(from)];
        for (int n = 0; n < taps; ++n) sum += bin[n] * kernel.weights[std::size_t(n)];
      } else {
        for (int n = 0; n < taps; ++n) {
          sum += bins[std::size_t(std::clamp(from + n, 0, last))] * kernel.weights[std::size_t(n)];
        }
      }
      // Weights of 2^14 down to eighths of HU.
      out[i] = std::int16_t((sum + (kOne / kPerHu) / 2) >> 11);
    }
  }

  // Rows of bins, one value a voxel across, to rows of voxels.
  void spreadColumns(const std::vector<std::int16_t>& rows, std::int16_t* out) const {
    const Kernel& kernel = kernels_[1];
    const auto nx = std::size_t(nx_);
    std::vector<int> sum(nx);
    for (int j = 0; j < ny_; ++j) {
      std::fill(sum.begin(), sum.end(), 0);
      addUp(
          kernel, kBins * (j - kernel.reach), kBins * ny_,
          [&](int row) { return &rows[std::size_t(row) * nx]; }, sum);
      for (std::size_t i = 0; i < nx; ++i) out[std::size_t(j) * nx + i] = rounded(sum[i]);
    }
  }

  template <class RowAt>
  static void addUp(const Kernel& kernel, int from, int count, const RowAt& rowAt,
                    std::vector<int>& sum) {
    for (std::size_t n = 0; n < kernel.weights.size(); ++n) {
      const std::int16_t* row = rowAt(std::clamp(from + int(n), 0, count - 1));
      const int weight = kernel.weights[n];
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * row[i];
    }
  }

  void finish(int k) {
    const Kernel& kernel = kernels_[2];
    const std::size_t area = std::size_t(nx_) * std::size_t(ny_);
    std::vector<int> sum(area, 0);
    addUp(
        kernel, kBins * (k - kernel.reach), kBins * nz_,
        [&](int c) { return &spreadOf(c / kBins)[std::size_t(c % kBins) * area]; }, sum);
    const std::size_t first = volume_.geometry.indexOf(0, 0, k);
    for (std::size_t n = 0; n < area; ++n) volume_.hu[first + n] = rounded(sum[n]);
  }

  PhantomTruth truth_;
  const std::vector<PhantomTissue>& centres_;
  Volume& volume_;
  Mat4 affine_;
  int nx_, ny_, nz_;
  std::array<Kernel, 3> kernels_;
  std::size_t layer_;  // bins in one layer of a slice
  // Rings of slices: those that a chunk needs, by number modulo the ring's length.
  std::vector<Slice> bins_;
  std::vector<std::vector<std::int16_t>> spread_;
};

}  // namespace

std::vector<PhantomTissue> truthAtCentres(PhantomTruth truth, const GridGeometry& geometry) {
  std::vector<PhantomTissue> centres(geometry.voxelCount());
  const Mat4 affine = geometry.voxelToPatient();
  onTwoThreads(geometry.size[2], [&](int k) {
    std::size_t index = geometry.indexOf(0, 0, k);
    for (int j = 0; j < geometry.size[1]; ++j) {
      for (int i = 0; i < geometry.size[0]; ++i) {
        centres[index++] = truth(Vec3(affine[0]) * double(i) + Vec3(affine[1]) * double(j) +
                                 Vec3(affine[2]) * double(k) + Vec3(affine[3]));
      }
    }
  });
  return centres;
}

void paintPhantom(PhantomTruth truth, const std::vector<PhantomTissue>& centres, Volume& volume) {
  Painter(truth, centres, volume).paint();
}

void addNoise(Volume& eighths, double noise_hu) {
  std::vector<double> of_sum(kMostOfBytes + 1);
  for (int sum = 0; sum <= kMostOfBytes; ++sum) {
    of_sum[std::size_t(sum)] = noise_hu * ((sum - kMostOfBytes / 2) / std::sqrt(43690.0));
  }
  onTwoThreads(eighths.geometry.size[2], [&](int k) {
    std::size_t index = eighths.geometry.indexOf(0, 0, k);
    const std::size_t end = eighths.geometry.indexOf(0, 0, k + 1);
    for (; index < end; ++index) {
      // A scanner stores 12 bits from -1024 on.
      const double hu = double(eighths.hu[index]) / kPerHu + of_sum[sumOfBytes(index)];
      eighths.hu[index] = std::int16_t(std::floor(std::clamp(hu, -1024.0, 3071.0) + 0.5));
    }
  });
}

}  // namespace trephine
