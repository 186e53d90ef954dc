// The built-in head with its truth, for tests and figures of what is found in one: as it is, with
// more noise, in other slices.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "liver_case.h"
#include "volume/phantom_file.h"
#include "volume/two_threads.h"

namespace trephine::test {

struct HeadCase {
  Volume volume;
  std::vector<std::uint8_t> truth;  // a PhantomTissue a voxel, at its centre

  PhantomTissue at(std::size_t voxel) const { return PhantomTissue(truth[voxel]); }
  static bool isSkull(PhantomTissue tissue) {
    return tissue == PhantomTissue::outerTable || tissue == PhantomTissue::diploe ||
           tissue == PhantomTissue::innerTable || tissue == PhantomTissue::facialBone;
  }
  static bool isBrain(PhantomTissue tissue) {
    return tissue == PhantomTissue::greyMatter || tissue == PhantomTissue::whiteMatter ||
           tissue == PhantomTissue::ventricle;
  }

  // Dice of a mask and the skull.
  double dice(const LabelMap& mask) const {
    std::size_t both = 0, sum = 0;
    for (std::size_t n = 0; n < truth.size(); ++n) {
      const bool in = mask.labels[n] != 0, bone = isSkull(at(n));
      both += in && bone;
      sum += std::size_t(in) + std::size_t(bone);
    }
    return 2.0 * double(both) / double(sum);
  }
  // How many voxels of a mask are of tissues that `which` says.
  template <class Which>
  std::size_t count(const LabelMap& mask, const Which& which) const {
    std::size_t found = 0;
    for (std::size_t n = 0; n < truth.size(); ++n) found += mask.labels[n] && which(at(n));
    return found;
  }

  void addNoise(double sigma_HU) {
    LiverCase of{std::move(volume), {}, 0, 0};
    of.addNoise(sigma_HU);
    volume = std::move(of.volume);
  }
  HeadCase withSlices(double step_mm) const;
};

inline std::vector<std::uint8_t> headTruth(const GridGeometry& g) {
  const PhantomTruth truth = *phantomTruth("cranium");
  std::vector<std::uint8_t> tissues(g.voxelCount());
  onTwoThreads(g.size[2], [&](int k) {
    std::size_t at = g.indexOf(0, 0, k);
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i, ++at) {
        tissues[at] = std::uint8_t(truth(g.toPatient_mm(Vec3(i, j, k))));
      }
    }
  });
  return tissues;
}

inline HeadCase builtInHead() {
  HeadCase head{openPhantom("cranium")->volume, {}};
  head.truth = headTruth(head.volume.geometry);
  return head;
}

inline HeadCase HeadCase::withSlices(double step_mm) const {
  LiverCase of{volume, {volume.geometry, std::vector<std::uint8_t>(volume.hu.size())}, 0, 0};
  HeadCase head{of.withSlices(step_mm).volume, {}};
  head.truth = headTruth(head.volume.geometry);
  return head;
}

}  // namespace trephine::test
