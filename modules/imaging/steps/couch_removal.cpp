// Removal at full resolution: what findCouch says of cells becomes a decision for each voxel.
#include <algorithm>
#include <cmath>

#include "imaging/steps/couch.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr int kDenseHu = -300;   // tissue: denser than skin's edge, foam and cloth
constexpr int kNotAirHu = -900;  // what counts as gone
constexpr double kGuard_mm = 2.0;

// A volume seen along the axes of a finding's cells.
class View {
 public:
  View(const Volume& volume, const CouchFinding& finding) : finding_(finding) {
    const Index3& size = volume.geometry.size;
    const std::size_t strides[3] = {1, std::size_t(size[0]),
                                    std::size_t(size[0]) * std::size_t(size[1])};
    for (std::size_t n = 0; n < 3; ++n) {
      voxels[n] = size[std::size_t(finding.axis[n])];
      stride[n] = strides[finding.axis[n]];
      spacing_mm[n] = volume.geometry.spacing_mm[finding.axis[n]];
    }
  }
  std::size_t indexOf(int a, int b, int s) const {
    return std::size_t(a) * stride[0] + std::size_t(b) * stride[1] + std::size_t(s) * stride[2];
  }
  // The row of cells that row (b, s) of voxels lies in.
  const std::uint8_t* cellRow(int b, int s) const {
    return finding_.cells.data() +
           (std::size_t(s / finding_.step[2]) * std::size_t(finding_.size[1]) +
            std::size_t(b / finding_.step[1])) *
               std::size_t(finding_.size[0]);
  }

  std::array<int, 3> voxels;
  std::array<std::size_t, 3> stride;
  std::array<double, 3> spacing_mm;

 private:
  const CouchFinding& finding_;
};

// What a straight couch shows where the body is not on it: for each voxel across, the mean over all
// slices in which its cell is the couch's alone.
class CrossSection {
 public:
  CrossSection(const Volume& volume, const View& view, const CouchFinding& finding)
      : width_(std::size_t(view.voxels[0])), voxels_(width_ * std::size_t(view.voxels[1])) {
    onTwoThreads(view.voxels[1], [&](int b) {
      for (int s = 0; s < view.voxels[2]; ++s) {
        const std::uint8_t* cells = view.cellRow(b, s);
        for (int a = 0; a < view.voxels[0]; ++a) {
          if (cells[a / finding.step[0]] != CouchFinding::remove) continue;
          Sums& sums = at(a, b);
          const float hu = volume.hu[view.indexOf(a, b, s)];
          sums.count += 1.0f;
          sums.hu += hu;
          sums.square += double(hu) * hu;
        }
      }
    });
    least_ = float(std::max(5, view.voxels[2] / 20));
  }

  // Whether the couch fills this voxel at all other places along the scan, and now looks the same.
  bool has(int a, int b, int hu) const {
    constexpr double kFilledHu = -600.0, kSteadyHu = 80.0;
    const Sums& sums = voxels_[std::size_t(b) * width_ + std::size_t(a)];
    if (sums.count < least_) return false;
    const double mean = sums.hu / sums.count, variance = sums.square / sums.count - mean * mean;
    return mean > kFilledHu && variance < kSteadyHu * kSteadyHu &&
           std::abs(hu - mean) < 2 * kSteadyHu;
  }

 private:
  struct Sums {
    float count = 0.0f;
    double hu = 0.0, square = 0.0;
  };
  Sums& at(int a, int b) { return voxels_[std::size_t(b) * width_ + std::size_t(a)]; }

  std::size_t width_;
  std::vector<Sums> voxels_;
  float least_ = 0.0f;
};

// One bit a voxel, rows apart, so that two threads never write one word.
class Bits {
 public:
  Bits(int a, int b, int s)
      : words_((std::size_t(a) + 63) / 64),
        rows_(std::size_t(b)),
        bits_(words_ * rows_ * std::size_t(s)) {}
  void set(int a, int b, int s) { word(a, b, s) |= std::uint64_t(1) << (a & 63); }
  bool get(int a, int b, int s) { return word(a, b, s) >> (a & 63) & 1; }

 private:
  std::uint64_t& word(int a, int b, int s) {
    return bits_[(std::size_t(s) * rows_ + std::size_t(b)) * words_ + std::size_t(a >> 6)];
  }
  std::size_t words_, rows_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace

std::uint64_t removeCouch(Volume& volume, const CouchFinding& finding) {
  if (!finding.found) return 0;
  const View view(volume, finding);
  const CrossSection couch(volume, view, finding);
  const auto actionAt = [&](int a, int b, int s) {
    return view.cellRow(b, s)[a / finding.step[0]];
  };
  // Tissue is what is dense and not the couch.
  const auto isTissue = [&](int a, int b, int s) {
    const int hu = volume.hu[view.indexOf(a, b, s)];
    return hu > kDenseHu && actionAt(a, b, s) != CouchFinding::remove && !couch.has(a, b, hu);
  };
  std::array<int, 3> guard;
  for (std::size_t n = 0; n < 3; ++n) {
    guard[n] = std::max(1, int(kGuard_mm / view.spacing_mm[n] + 0.5));
  }
  const auto tissueNear = [&](int a, int b, int s) {
    for (int z = std::max(0, s - guard[2]); z <= std::min(view.voxels[2] - 1, s + guard[2]); ++z) {
      for (int y = std::max(0, b - guard[1]); y <= std::min(view.voxels[1] - 1, b + guard[1]);
           ++y) {
        for (int x = std::max(0, a - guard[0]); x <= std::min(view.voxels[0] - 1, a + guard[0]);
             ++x) {
          if (isTissue(x, y, z)) return true;
        }
      }
    }
    return false;
  };

  // First decided, then done: a decision looks at neighbours as they were.
  Bits going(view.voxels[0], view.voxels[1], view.voxels[2]);
  onTwoThreads(view.voxels[2], [&](int s) {
    for (int b = 0; b < view.voxels[1]; ++b) {
      const std::uint8_t* cells = view.cellRow(b, s);
      for (int a = 0; a < view.voxels[0]; ++a) {
        const std::uint8_t action = cells[a / finding.step[0]];
        if (action == CouchFinding::keep) continue;
        const int hu = volume.hu[view.indexOf(a, b, s)];
        const bool goes = action == CouchFinding::remove || couch.has(a, b, hu) ||
                          (hu <= kDenseHu && hu > kAirHu && !tissueNear(a, b, s));
        if (goes) going.set(a, b, s);
      }
    }
  });
  std::atomic<std::uint64_t> gone{0};
  onTwoThreads(view.voxels[2], [&](int s) {
    std::uint64_t in_slice = 0;
    for (int b = 0; b < view.voxels[1]; ++b) {
      for (int a = 0; a < view.voxels[0]; ++a) {
        if (!going.get(a, b, s)) continue;
        std::int16_t& hu = volume.hu[view.indexOf(a, b, s)];
        in_slice += hu > kNotAirHu;
        hu = kAirHu;
      }
    }
    gone += in_slice;
  });
  return gone;
}

}  // namespace trephine
