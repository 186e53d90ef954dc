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
#include "base/limits.h"
#include "base/math.h"
#include "base/range.h"
#include "base/result.h"
#include "base/tr.h"
#include "tissue/tissue_numbers.h"

namespace trephine {

// What the numbers of a tissue may be, in files, panels and scripts alike.
constexpr Range kHuRange{-32768, 32767, "HU"};
constexpr Range kLabelRange{1, 255};
constexpr Range kShareRange{0, 1};  // opacity, colour
constexpr Range kShellRange{0.1, 20, "mm"};

// What is as stiff as this stops a tool, unless the set says otherwise: no soft tissue comes near
// it, and no arm lets it be told from bone.
constexpr double kSolidFrom_N_per_m = 600.0;

// Its mechanics are the members of SetNumbers.
struct Tissue : SetNumbers {
  std::string id;    // stable: exercises, recordings and reports name it
  std::string name;  // shown
  int hu_min = 0;    // [hu_min, hu_max], both included
  int hu_max = 0;
  std::string hu_source;
  std::optional<int> label;  // 1..255: only voxels with this label of a label map; absent: any voxel
  // Only voxels of the case's structure of this name, whose `label` an exercise finds when it is
  // placed in a case (exercise/exercise_structures.h); empty: as `label` says.
  std::string structure{};
  // Where a case lacks that structure, it is the outermost layer of another.
  struct Shell {
    std::string of;
    double thickness_mm = 1.0;
    bool operator==(const Shell&) const = default;
  };
  std::optional<Shell> shell{};
  // The id of the tissue that encloses this one in a body, as a skull its brain; empty: none.
  // What was cut is named after this one only there (exercise/true_tissues.h): HU like a brain's
  // are those of a scalp's muscle, and of the edge between fat and bone. Touch and picture do not
  // ask for it.
  std::string within{};
  bool isAnywhere() const { return !label && structure.empty(); }
  Vec3 colour{1.0};          // r, g, b in [0, 1]
  double opacity = 0.0;      // [0, 1] per millimetre of depth; 0 hides the tissue
  bool cuttable = true;
  // A tool stops at a solid tissue until it is cut; absent: solid from kSolidFrom_N_per_m on.
  std::optional<bool> solid;
  bool isSolid() const { return solid.value_or(stiffness_N_per_m.value >= kSolidFrom_N_per_m); }
  bool operator==(const Tissue&) const = default;
};

// The settings of a tissue that are one member each; its mechanics are in tissue_numbers.h.
inline constexpr FieldOf<Tissue> kTissueFields[] = {
    {{"id",
      {},
      Given::always,
      trLater("not empty, unique in the set; stable: scenes, operator scripts, recordings and "
              "reports name "
              "it")},
     &Tissue::id},
    {{"name", {1, 60}, Given::always, "shown"}, &Tissue::name},
    {{"structure",
      {},
      Given::may_be,
      trLater(
          "only voxels of the case's structure of this name, whatever its number there; letters in "
          "either case, `_` for a blank"),
      "Where"},
     ReferenceIn<Tissue>{&Tissue::structure}},
    {{"colour", kShareRange, Given::always, trLater("red, green, blue")}, &Tissue::colour},
    {{"opacity", kShareRange, Given::always,
      trLater("per millimetre of depth; 0 hides the tissue, unless a view's `looks` name it "
              "(`scene.md`)")},
     &Tissue::opacity},
    {{"within",
      {},
      Given::may_be,
      trLater("the `id` of the tissue that encloses this one in a body, as a skull its brain: what "
              "was cut is named after this one only there, elsewhere 'Not told apart'"),
      trLater("Inside")},
     ReferenceIn<Tissue>{&Tissue::within}},
};
inline constexpr FieldOf<Tissue::Shell> kShellFields[] = {
    {{"of",
      {},
      Given::always,
      trLater("the structure whose outermost layer it is where the case lacks the tissue's own"),
      trLater("Else")},
     ReferenceIn<Tissue::Shell>{&Tissue::Shell::of}},
    {{"thickness_mm", kShellRange, Given::always,
      trLater("of that layer, which is closed: a capsule, which no CT shows")},
     &Tissue::Shell::thickness_mm},
};
inline constexpr FieldOf<Tissue> kCuttingFields[] = {
    {{"cuttable",
      {},
      Given::may_be,
      trLater("`false`: a tool feels the tissue but removes none of it"),
      trLater("Can be cut"),
      trLater("Whether a tool may remove it, by the work that is put in.")},
     &Tissue::cuttable},
};

// Whether the two are known in the same voxels, so that their HU must differ.
bool inSamePlace(const Tissue& a, const Tissue& b);

struct TissueSet {
  std::string name;
  std::vector<Tissue> tissues;
  // The file of the set that holds on cases whose label map is another one, or none; empty: this.
  // Of a file as it was read: a set that is written (toJson) names none.
  std::string elsewhere_file{};

  const Tissue* find(const std::string& id) const;
  // Sources included; where a set for elsewhere was read from is not a part of it.
  bool operator==(const TissueSet& other) const {
    return name == other.name && tissues == other.tissues;
  }
};

// Every rule that a set must keep, whether read from a file or typed in a panel: 1 to kMaxTissues
// tissues, unique ids, none enclosed by itself or by one that the set lacks, hu_min <= hu_max
// within int16, labels from 1 to 255, no two ranges that
// overlap in the same structure or label or both in none, finite numbers, none of the mechanics
// negative, opacity and colour in [0, 1], a source for each number. The Error names `file`, field
// and value.
Status validate(const TissueSet& set, const std::string& file);

Result<TissueSet> readTissueSet(const std::filesystem::path& file);
Result<TissueSet> parseTissueSet(const Json& json, const std::string& file);
Json toJson(const TissueSet& set);

// The table of resources/schemas/tissues.md.
std::string tissueFieldsPage();

// What the tick needs of a set: plain data, no text.
struct TissueClass : TickNumbers {
  std::int32_t hu_min = 1;
  std::int32_t hu_max = 0;
  std::int32_t cuttable = 0;
  std::int32_t label = 0;  // 0: of any voxel
  std::int32_t solid = 0;  // a tool stops at it
  std::int32_t reserved = 0;
  friend bool operator==(const TissueClass&, const TissueClass&) = default;

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    for (const TissueNumber& number : kTissueNumbers) archive(self.*number.in_tick);
    archive(self.hu_min, self.hu_max, self.cuttable, self.label, self.solid);
  }
};

struct TissueTable {
  std::int32_t count = 0;
  std::int32_t reserved = 0;
  std::array<TissueClass, kMaxTissues> classes{};
  friend bool operator==(const TissueTable&, const TissueTable&) = default;

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive.within(self.count, 0, std::int64_t(kMaxTissues) + 1);
    archive(self.classes);
  }
};

// Classes keep the order of the set's tissues, which must be valid.
TissueTable tissueTable(const TissueSet& set);

// The HU that removal leaves: free space, also where a tissue's range holds it.
constexpr std::int16_t kRemovedHu = -1000;

// The class of a HU in a voxel of this label (0: none), or -1: free space. A tissue restricted to
// the label goes before one that is of any voxel.
inline int classify(const TissueTable& table, double hu, int label = 0) {
  int of_any = -1;
  for (int i = 0; i < table.count && hu != kRemovedHu; ++i) {
    const TissueClass& t = table.classes[std::size_t(i)];
    if (!(hu >= t.hu_min && hu <= t.hu_max)) continue;
    if (t.label != 0 && t.label == label) return i;
    if (t.label == 0 && of_any < 0) of_any = i;
  }
  return of_any;
}

// The labels that a table tells apart, each with a row of its own in look-ups by HU. Row 0 is of
// voxels with any other label, or none.
struct LabelRows {
  static constexpr int kMost = kMaxTissues + 1;
  LabelRows() = default;
  explicit LabelRows(const TissueTable& table);

  int count = 1;
  std::array<std::uint8_t, kMost> label{};  // of a row
  std::array<std::uint8_t, 256> row{};      // of a label
};

}  // namespace trephine
