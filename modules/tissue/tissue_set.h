// Tissues: a range of HU -> a class with colour, opacity and mechanical parameters, each number
// with its source. As a file: JSON, resources/schemas/tissues.md.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/math.h"
#include "base/result.h"

namespace trephine {

constexpr int kMaxTissues = 16;

// A number that a person set, and where it comes from: a citation, or "tuned here, uncited".
struct SourcedNumber {
  double value = 0.0;
  std::string source;
};

struct Tissue {
  std::string id;    // stable: scenes, recordings and reports name it
  std::string name;  // shown
  int hu_min = 0;    // [hu_min, hu_max], both included
  int hu_max = 0;
  std::string hu_source;
  std::optional<int> label;  // only voxels with this label of a label map; absent: every voxel
  Vec3 colour{1.0};          // r, g, b in [0, 1]
  double opacity = 0.0;      // [0, 1] per millimetre of depth; 0 hides the tissue
  SourcedNumber damping_Ns_per_m;   // viscous law
  SourcedNumber stiffness_N_per_m;  // elastic, coulomb and rupture laws
  SourcedNumber friction_N;         // coulomb law: of a tool that slides in it
  std::optional<SourcedNumber> rupture_N;  // rupture law: a capsule's; absent: none
  SourcedNumber cutting_J_per_mm3;  // work that removes it: its specific cutting energy
  bool cuttable = true;
};

struct TissueSet {
  std::string name;
  std::vector<Tissue> tissues;

  const Tissue* find(const std::string& id) const;
};

// Every rule that a set must keep, whether read from a file or typed in a panel: 1 to 16 tissues,
// unique ids, hu_min <= hu_max within int16, no two ranges that overlap under the same label (or
// where one has none), finite numbers, none of the mechanics negative, opacity and colour
// in [0, 1], a source for each number. The Error names `file`, field and value.
Status validate(const TissueSet& set, const std::string& file);

Result<TissueSet> readTissueSet(const std::filesystem::path& file);
Result<TissueSet> parseTissueSet(const Json& json, const std::string& file);
Json toJson(const TissueSet& set);

// What the tick needs of a set: plain data, no text.
struct TissueClass {
  std::int32_t hu_min = 1;
  std::int32_t hu_max = 0;
  double damping_Ns_per_m = 0.0;
  double stiffness_N_per_m = 0.0;
  double friction_N = 0.0;
  double rupture_N = 0.0;
  double cutting_J_per_mm3 = 0.0;
  std::int32_t cuttable = 0;
  std::int32_t reserved = 0;
};

struct TissueTable {
  std::int32_t count = 0;
  std::int32_t reserved = 0;
  std::array<TissueClass, kMaxTissues> classes{};
};

// Classes keep the order of the set's tissues, which must be valid. The tick knows no label map, so
// a tissue with a label keeps its place and matches no voxel.
TissueTable tissueTable(const TissueSet& set);

// The class of a HU, or -1: free space.
inline int classify(const TissueTable& table, std::int16_t hu) {
  for (int i = 0; i < table.count; ++i) {
    if (hu >= table.classes[std::size_t(i)].hu_min && hu <= table.classes[std::size_t(i)].hu_max) {
      return i;
    }
  }
  return -1;
}

}  // namespace trephine
