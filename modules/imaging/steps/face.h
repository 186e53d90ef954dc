// Whether a CT shows a face from which a person could be recognised, and its removal.
//
// What is recognised in a CT is the skin seen from outside: nose, lips, chin, eyes, brow. So a face
// is skin with air in front of it, on the front of a head, below the brow. A bare skull (a phantom,
// a dry bone) has none: nothing on it is the look of a living person, and no warning is due.
// Front and up are the patient's, from the direction matrix: supine, prone or feet first alike.
//
// Pure functions; two threads inside.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "imaging/steps/coarse_grid.h"
#include "volume/volume.h"

namespace trephine {

// Of a cell of the coarse grid.
constexpr int kBoneMeanHu = 150;  // noise in brain does not reach it, nor 600 HU in a voxel
constexpr int kSkinHu = -500;     // half way from air to skin

struct FaceFinding {
  bool found = false;
  // With a braincase in view the cut is fitted to it. Without one (a scan of sinuses or jaws) a
  // face is assumed from the scan's own words for the body part or from facial bone around air:
  // in doubt, so a warning is due, and the cut takes the front 70 mm.
  bool braincase = false;
  double skin_cm2 = 0.0;  // facial skin in view, seen from in front

  // What deface() clears, LPS mm: dot(normal, p) > offset_mm, p.y < back_mm and p.z > bottom_mm.
  Vec3 normal{0.0, -1.0, 0.0};  // unit; out of the braincase towards the face
  double offset_mm = 0.0;
  double back_mm = 0.0;    // middle of the braincase: about the ears
  double bottom_mm = 0.0;  // below the chin: a chest in the same scan stays
  Vec3 middle_mm{0.0};     // of the face: the air of nose, sinuses and mouth

  bool clears(const Vec3& p) const {
    return p.y < back_mm && p.z > bottom_mm && glm::dot(normal, p) > offset_mm;
  }
};

// `body_part_examined`: DICOM (0018,0015) or any such words, or empty. Holds at most about 5 MB.
FaceFinding findFace(const Volume& volume, std::string_view body_part_examined = {});
FaceFinding findFace(const CoarseGrid& grid, std::string_view body_part_examined = {});

// What the cut takes of `kept` that is none of the face: over 90 mm from its middle.
struct BeyondFace {
  double throat_mL = 0.0;  // below the face
  double beside_mL = 0.0;  // beside and above it: arms, hands, shoulders
  double bone_mL = 0.0;    // of both
};
BeyondFace beyondFace(const CoarseGrid& grid, const FaceFinding& finding, const VoxelBox& kept);

// Sets all beyond a flat cut to kAirHu; returns how many voxels that were not air (over -900 HU)
// went. The cut touches the braincase 8 mm outside it on the side of the face, after Quickshear
// (Schimke and Hale, "Quickshear defacing for neuroimages", 2011): brain, vault and ears stay,
// orbits, nose and jaws go, bone included. Being flat, the cut says nothing of what was in front of
// it. A scan of the facial bones has no use after this. Whether the face is gone: face_check.h.
// `taken`: each voxel that went and its HU, to put it back.
using TakenVoxels = std::vector<std::vector<std::pair<std::size_t, std::int16_t>>>;
std::uint64_t deface(Volume& volume, const FaceFinding& finding, TakenVoxels* taken = nullptr);

}  // namespace trephine
