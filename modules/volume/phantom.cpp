#include "volume/phantom.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string_view>
#include <system_error>
#include <thread>

#include "base/memory.h"
#include "volume/case_memory.h"
#include "volume/phantom_shapes.h"

namespace trephine {

namespace {

struct TissueRow {
  PhantomTissue tissue;
  std::int16_t hu;
  const char* name;
};

// In the order of the enum. Where each number comes from: README.md.
constexpr std::array<TissueRow, 22> kTissues{{
    {PhantomTissue::air, -1000, "air"},
    {PhantomTissue::scalp, -20, "scalp"},
    {PhantomTissue::outerTable, 1400, "outer table"},
    {PhantomTissue::diploe, 600, "diploe"},
    {PhantomTissue::innerTable, 1400, "inner table"},
    {PhantomTissue::dura, 70, "dura"},
    {PhantomTissue::csf, 8, "csf"},
    {PhantomTissue::greyMatter, 38, "grey matter"},
    {PhantomTissue::whiteMatter, 28, "white matter"},
    {PhantomTissue::ventricle, 6, "ventricle"},
    {PhantomTissue::eye, 15, "eye"},
    {PhantomTissue::facialBone, 900, "facial bone"},
    {PhantomTissue::skin, -20, "skin"},
    {PhantomTissue::fat, -100, "fat"},
    {PhantomTissue::muscle, 72, "muscle"},
    {PhantomTissue::bone, 900, "bone"},
    {PhantomTissue::marrow, 250, "marrow"},
    {PhantomTissue::capsule, 95, "capsule"},
    {PhantomTissue::liver, 50, "liver"},
    {PhantomTissue::vessel, 150, "vessel"},
    {PhantomTissue::kidney, 120, "kidney"},
    {PhantomTissue::spleen, 120, "spleen"},
}};

constexpr bool inEnumOrder() {
  for (std::size_t i = 0; i < kTissues.size(); ++i) {
    if (kTissues[i].tissue != PhantomTissue(i)) return false;
  }
  return true;
}
static_assert(inEnumOrder());

struct Phantom {
  const char* name;
  PhantomTruth truth;
  Index3 size;
  Vec3 spacing_mm;
};

constexpr std::string_view kPrefix = "phantom:";
constexpr std::uint64_t kNoiseSeed = 0x5452455048494e45;
const std::array<Phantom, 2> kPhantoms{{
    {"cranium", craniumTissue, {256, 256, 180}, {0.8, 0.8, 1.0}},
    {"abdomen", abdomenTissue, {256, 256, 160}, {1.4, 1.4, 1.5}},
}};

Result<const Phantom*> findPhantom(const std::string& name) {
  for (const Phantom& phantom : kPhantoms) {
    if (name == phantom.name) return &phantom;
  }
  return Error{"UNKNOWN_PHANTOM", "There is no built-in case named '" + name + "'", "phantom",
               "Use cranium or abdomen"};
}

GridGeometry geometryOf(const Phantom& phantom) {
  GridGeometry geometry;
  geometry.size = phantom.size;
  geometry.spacing_mm = phantom.spacing_mm;
  for (int axis = 0; axis < 3; ++axis) {
    geometry.origin_mm[axis] = -0.5 * (phantom.size[axis] - 1) * phantom.spacing_mm[axis];
  }
  return geometry;
}

// A standard normal number for each voxel: the sum of the eight bytes of a hash of its index
// (splitmix64's finaliser), mean 8 * 127.5, variance 8 * (256^2 - 1) / 12.
double standardNormal(std::uint64_t index) {
  std::uint64_t h = (index + 1) * 0x9e3779b97f4a7c15 + kNoiseSeed;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9;
  h = (h ^ (h >> 27)) * 0x94d049bb133111eb;
  h ^= h >> 31;
  int sum = 0;
  for (int byte = 0; byte < 8; ++byte) sum += int(h >> (8 * byte) & 0xff);
  return (sum - 1020) / std::sqrt(43690.0);
}

class Painter {
 public:
  Painter(PhantomTruth truth, double noise_hu, const Progress& progress, Volume& volume)
      : truth_(truth),
        noise_hu_(noise_hu),
        progress_(progress),
        volume_(volume),
        affine_(volume.geometry.voxelToPatient()),
        centres_(volume.hu.size()) {}

  // False when cancelled.
  bool paint() {
    return overSlices([this](int k) { classifyCentres(k); }, 0.0, 0.3) &&
           overSlices([this](int k) { averageSlice(k); }, 0.3, 1.0);
  }

 private:
  // Calls work(k) for every slice on this thread and one more; what a slice gets does not depend
  // on who does it.
  template <class Work>
  bool overSlices(const Work& work, double from, double to) {
    const int slices = volume_.geometry.size[2];
    std::atomic<int> next{0};
    const auto take = [&](bool reports) {
      for (int k = next++; k < slices && !progress_.cancelled(); k = next++) {
        if (reports) progress_.at(from + (to - from) * k / slices, "Making the built-in case");
        work(k);
      }
    };
    std::thread helper;
    try {
      helper = std::thread(take, false);
    } catch (const std::system_error&) {
      // No thread to be had: this one does all of it.
    }
    take(true);
    if (helper.joinable()) helper.join();
    return !progress_.cancelled();
  }

  Vec3 position(double i, double j, double k) const {
    return Vec3(affine_[0]) * i + Vec3(affine_[1]) * j + Vec3(affine_[2]) * k + Vec3(affine_[3]);
  }

  void classifyCentres(int k) {
    const Index3& size = volume_.geometry.size;
    std::size_t index = volume_.geometry.indexOf(0, 0, k);
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) centres_[index++] = truth_(position(i, j, k));
    }
  }

  // A voxel whose six neighbours agree with it needs no averaging.
  bool nearBoundary(int i, int j, int k, std::size_t index) const {
    const Index3& size = volume_.geometry.size;
    const auto nx = std::size_t(size[0]), nxy = nx * std::size_t(size[1]);
    const PhantomTissue own = centres_[index];
    return (i > 0 && centres_[index - 1] != own) ||
           (i + 1 < size[0] && centres_[index + 1] != own) ||
           (j > 0 && centres_[index - nx] != own) ||
           (j + 1 < size[1] && centres_[index + nx] != own) ||
           (k > 0 && centres_[index - nxy] != own) ||
           (k + 1 < size[2] && centres_[index + nxy] != own);
  }

  // The mean of the centre and eight samples around it; where those differ by more than noise would
  // hide, of 27.
  double averageVoxel(int i, int j, int k, PhantomTissue centre) const {
    const auto huAt = [&](int s) {
      const Vec3 at =
          position(i + (s % 3 - 1) / 3.0, j + (s / 3 % 3 - 1) / 3.0, k + (s / 9 - 1) / 3.0);
      return int(phantomHu(truth_(at)));
    };
    constexpr int kHiddenByNoise = 60;
    int sum = phantomHu(centre), low = sum, high = sum;
    for (int s : {0, 2, 6, 8, 18, 20, 24, 26}) {
      const int hu = huAt(s);
      sum += hu;
      low = std::min(low, hu);
      high = std::max(high, hu);
    }
    if (high - low <= kHiddenByNoise) return sum / 9.0;
    for (int s : {1, 3, 4, 5, 7, 9, 10, 11, 12, 14, 15, 16, 17, 19, 21, 22, 23, 25}) sum += huAt(s);
    return sum / 27.0;
  }

  void averageSlice(int k) {
    const Index3& size = volume_.geometry.size;
    std::size_t index = volume_.geometry.indexOf(0, 0, k);
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++index) {
        const double mean = nearBoundary(i, j, k, index) ? averageVoxel(i, j, k, centres_[index])
                                                         : phantomHu(centres_[index]);
        // A scanner stores 12 bits from -1024 on.
        const double hu = mean + noise_hu_ * standardNormal(index);
        volume_.hu[index] = std::int16_t(std::floor(std::clamp(hu, -1024.0, 3071.0) + 0.5));
      }
    }
  }

  PhantomTruth truth_;
  double noise_hu_;
  const Progress& progress_;
  Volume& volume_;
  Mat4 affine_;
  std::vector<PhantomTissue> centres_;
};

}  // namespace

std::int16_t phantomHu(PhantomTissue tissue) {
  return kTissues[std::size_t(tissue)].hu;
}
const char* phantomTissueName(PhantomTissue tissue) {
  return kTissues[std::size_t(tissue)].name;
}

Result<PhantomTruth> phantomTruth(const std::string& name) {
  const auto phantom = findPhantom(name);
  if (!phantom) return phantom.error();
  return phantom.value()->truth;
}

std::optional<std::string> phantomNamed(const std::string& case_source) {
  if (!case_source.starts_with(kPrefix)) return std::nullopt;
  return case_source.substr(kPrefix.size());
}

std::string phantomSource(const std::string& name) {
  return std::string(kPrefix) + name;
}

Result<GridGeometry> phantomGeometry(const std::string& name) {
  const auto phantom = findPhantom(name);
  if (!phantom) return phantom.error();
  return geometryOf(*phantom.value());
}

Result<Volume> makePhantom(const std::string& name, const Progress& progress) {
  const auto phantom = findPhantom(name);
  if (!phantom) return phantom.error();
  Volume volume{geometryOf(*phantom.value()), {}};
  const std::size_t count = volume.geometry.voxelCount();
  if (Status enough = enoughMemory(voxelsMb(count), "Making the built-in case", name); !enough) {
    return enough.error();
  }
  volume.hu.resize(count);
  if (!Painter(phantom.value()->truth, kPhantomNoiseHu, progress, volume).paint()) {
    return Error{"CANCELLED", "Making the built-in case was cancelled", name, ""};
  }
  progress.at(1.0, "Making the built-in case");
  return volume;
}

Volume makePhantomOn(PhantomTruth truth, const GridGeometry& geometry, double noise_hu) {
  Volume volume{geometry, Voxels(geometry.voxelCount())};
  const Progress progress;
  Painter(truth, noise_hu, progress, volume).paint();
  return volume;
}

}  // namespace trephine
