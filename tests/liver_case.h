// A CT with its liver known, for tests and figures of what is grown: the built-in abdomen, the real
// one, and either with more noise, contrast or other slices.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <vector>

#include "structures/compare.h"
#include "structures/work_grid.h"
#include "volume/label_map.h"
#include "volume/phantom_file.h"
#include "volume/volume_files.h"

namespace trephine::test {

// A voxel's middle in the patient.
inline Vec3 placeOf(const LabelMap& map, std::size_t index) {
  const Index3 at = map.geometry.indicesOf(index);
  return map.geometry.toPatient_mm(Vec3(at[0], at[1], at[2]));
}

struct LiverCase {
  Volume volume;
  LabelMap liver;                     // 1
  int from = 0, to = 0;               // slices in which it is known
  std::vector<Vec3> in_vessels_mm{};  // places in the vessels that run inside
  std::vector<Vec3> in_capsule_mm{};

  // Of a mask of the volume's grid, in those slices.
  Likeness against(LabelMap mask) const {
    const GridGeometry& g = mask.geometry;
    for (std::size_t n = 0; n < mask.labels.size(); ++n) {
      const int k = g.indicesOf(n)[2];
      if (k < from || k >= to) mask.labels[n] = 0;
    }
    return *likeness(mask, 1, liver, 1);
  }

  // Places more than `least_mm` and no more than `most_mm` inside. The known slices' ends count as
  // a border that is kept away from, and not as one to be near.
  std::vector<Vec3> clicks(int count, double least_mm = 15.0, double most_mm = 1e9,
                           unsigned seed = 1) const {
    const GridGeometry& g = liver.geometry;
    WorkGrid grid;
    grid.size = g.size;
    grid.block_mm = g.spacing_mm;
    BlockMask outside(liver.labels.size());
    for (std::size_t n = 0; n < outside.size(); ++n) outside[n] = !liver.labels[n];
    const std::vector<float> inside_mm = distance_mm(outside, grid);
    for (std::size_t n = 0; n < outside.size(); ++n) {
      const int k = g.indicesOf(n)[2];
      if (k < from || k >= to) outside[n] = 0;
    }
    const std::vector<float> from_border_mm = distance_mm(outside, grid);
    std::vector<Vec3> places;
    for (std::size_t n = 0; n < outside.size(); ++n) {
      if (inside_mm[n] > float(least_mm) && from_border_mm[n] <= float(most_mm)) {
        places.push_back(placeOf(liver, n));
      }
    }
    return some(places, count, seed);
  }
  std::vector<Vec3> vesselClicks(int count, unsigned seed = 1) const {
    return some(in_vessels_mm, count, seed);
  }
  static std::vector<Vec3> some(const std::vector<Vec3>& places, int count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Vec3> out;
    for (int n = 0; n < count; ++n) out.push_back(places[random() % places.size()]);
    return out;
  }

  void addNoise(double sigma_HU) {
    std::mt19937 random(17);
    std::normal_distribution<double> noise(0.0, sigma_HU);
    for (auto& hu : volume.hu) hu = std::int16_t(std::clamp(hu + noise(random), -1024.0, 3071.0));
  }
  // Of the liver alone, as contrast in its late phase has it.
  void addContrast(double more_HU) {
    for (std::size_t n = 0; n < liver.labels.size(); ++n) {
      if (liver.labels[n]) volume.hu[n] = std::int16_t(volume.hu[n] + more_HU);
    }
  }
  // The same from slices so far apart: means of what lies between them where they are farther.
  LiverCase withSlices(double step_mm) const {
    GridGeometry g = volume.geometry;
    const double before_mm = g.spacing_mm.z;
    g.spacing_mm.z = step_mm;
    g.size[2] = int((volume.geometry.size[2] - 1) * before_mm / step_mm) + 1;
    LiverCase out;
    out.volume.geometry = g;
    out.volume.hu.resize(g.voxelCount());
    const int parts = std::max(1, int(std::lround(step_mm / before_mm)));
    for (int k = 0; k < g.size[2]; ++k) {
      for (int j = 0; j < g.size[1]; ++j) {
        for (int i = 0; i < g.size[0]; ++i) {
          double sum = 0.0;
          int count = 0;
          for (int part = 0; part < parts; ++part) {
            const double at = (k + (part + 0.5) / parts - 0.5) * step_mm / before_mm;
            const int low = int(std::floor(at));
            if (low < 0 || low + 1 >= volume.geometry.size[2]) continue;
            sum += volume.at(i, j, low) +
                   (at - low) * (volume.at(i, j, low + 1) - volume.at(i, j, low));
            ++count;
          }
          if (count == 0) {
            sum = volume.at(i, j, k == 0 ? 0 : volume.geometry.size[2] - 1);
            count = 1;
          }
          out.volume.hu[g.indexOf(i, j, k)] = std::int16_t(std::lround(sum / count));
        }
      }
    }
    out.liver = *fitTo(liver, g);
    out.from = int(std::ceil(from * before_mm / step_mm));
    out.to = std::min(g.size[2], int(to * before_mm / step_mm));
    out.in_vessels_mm = in_vessels_mm;
    out.in_capsule_mm = in_capsule_mm;
    for (std::size_t n = 0; n < out.liver.labels.size(); ++n) {
      const int k = g.indicesOf(n)[2];
      if (k < out.from || k >= out.to) out.liver.labels[n] = 0;
    }
    return out;
  }
};

// Its liver, the capsule and the vessels that run inside.
inline LiverCase builtInLiver() {
  Phantom phantom = *openPhantom("abdomen");
  LiverCase of{std::move(phantom.volume), phantom.labels.value_or(LabelMap()), 0, 0};
  of.to = of.liver.geometry.size[2];
  WorkGrid grid;
  grid.size = of.liver.geometry.size;
  const std::vector<std::uint8_t> all = of.liver.labels;
  for (auto& label : of.liver.labels) label = label == 1 || label == 2;
  fillHoles(of.liver.labels, grid);
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (all[n] == 3 && of.liver.labels[n]) of.in_vessels_mm.push_back(placeOf(of.liver, n));
    if (all[n] == 2) of.in_capsule_mm.push_back(placeOf(of.liver, n));
  }
  return of;
}

// In slices 82 to 111, where its label map belongs; the map's own header puts it elsewhere. Its
// vessels: what of the portal vein lies in the liver with notches of 9 mm closed.
inline LiverCase realLiver(const std::filesystem::path& data) {
  constexpr std::int16_t kLiver = 5, kPortalVein = 64;
  const std::filesystem::path folder = data / "abdomen-ct-totalsegmentator";
  LiverCase of;
  const VolumeFileReading ct = *readVolumeFile(folder / "example_ct.nii.gz");
  const VolumeFileReading map = *readVolumeFile(folder / "example_seg.nii.gz");
  const GridGeometry &g = ct.volume.geometry, &small = map.volume.geometry;
  of.liver.geometry = g;
  of.liver.labels.resize(g.voxelCount());
  BlockMask vein(g.voxelCount());
  const bool reversed = ct.header.reversed_slices;
  const auto slice = [&](int in_file) { return reversed ? g.size[2] - 1 - in_file : in_file; };
  constexpr int kFirst = 82;
  of.from = reversed ? slice(kFirst + small.size[2] - 1) : kFirst;
  of.to = of.from + small.size[2];
  for (int k = 0; k < small.size[2]; ++k) {
    const int in_map = map.header.reversed_slices ? small.size[2] - 1 - k : k;
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        const std::int16_t is = map.volume.at(i, j, in_map);
        of.liver.labels[g.indexOf(i, j, slice(kFirst + k))] = is == kLiver;
        vein[g.indexOf(i, j, slice(kFirst + k))] = is == kPortalVein;
      }
    }
  }
  WorkGrid grid;
  grid.size = g.size;
  grid.block_mm = g.spacing_mm;
  const BlockMask closed = eroded(dilated(of.liver.labels, grid, 9.0), grid, 9.0);
  for (std::size_t n = 0; n < vein.size(); ++n) {
    if (vein[n] && closed[n]) of.in_vessels_mm.push_back(placeOf(of.liver, n));
  }
  of.volume = ct.volume;
  return of;
}

}  // namespace trephine::test
