#include "volume/label_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>

#include "base/memory.h"
#include "base/sha256.h"
#include "base/tr.h"
#include "base/utf8.h"
#include "volume/case_memory.h"
#include "volume/codes.h"
#include "volume/segmentation.h"
#include "volume/volume_files.h"
#include "volume/voxel_slabs.h"

namespace trephine {

namespace {

// Where a centre lies between two voxels, as it does between grids of 1 and 2 mm, rounding must not
// send one to this side and its neighbour to the other. In voxels; more than a float's place is off.
constexpr double kTie = 1e-3;

char folded(char c) {
  if (c == '_') return ' ';
  return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
}

std::array<bool, 256> labelsIn(const LabelMap& map) {
  std::array<bool, 256> used{};
  for (const std::uint8_t label : map.labels) used[label] = true;
  return used;
}

// Structures that lie within another: more than half of their neighbours by faces are of it.
std::array<bool, 256> withinStructure(const LabelMap& map, int label) {
  const Index3& size = map.geometry.size;
  std::array<std::size_t, 256> of_it{}, of_others{};
  const auto count = [&](std::uint8_t a, std::uint8_t b) {
    if (a == b) return;
    ++(b == label ? of_it : of_others)[a];
    ++(a == label ? of_it : of_others)[b];
  };
  std::size_t index = 0;
  const std::size_t row = std::size_t(size[0]), slice = row * std::size_t(size[1]);
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i, ++index) {
        const std::uint8_t own = map.labels[index];
        if (i + 1 < size[0]) count(own, map.labels[index + 1]);
        if (j + 1 < size[1]) count(own, map.labels[index + row]);
        if (k + 1 < size[2]) count(own, map.labels[index + slice]);
      }
    }
  }
  std::array<bool, 256> within{};
  for (std::size_t other = 1; other < 256; ++other) within[other] = of_it[other] > of_others[other];
  within[std::size_t(label)] = true;
  return within;
}

// Steps from a voxel to those whose being outside makes it one of the shell.
std::vector<Index3> shellSteps(const Vec3& spacing_mm, double thickness_mm) {
  Index3 reach;
  for (std::size_t a = 0; a < 3; ++a) {
    reach[a] = std::max(1, int(thickness_mm / spacing_mm[int(a)] + 0.5));
  }
  std::vector<Index3> steps;
  for (int c = -reach[2]; c <= reach[2]; ++c) {
    for (int b = -reach[1]; b <= reach[1]; ++b) {
      for (int a = -reach[0]; a <= reach[0]; ++a) {
        const int most = std::max({std::abs(a), std::abs(b), std::abs(c)});
        if (most == 0) continue;
        const double apart_mm = glm::length(Vec3(a, b, c) * spacing_mm);
        // The surface lies half a voxel before the middle of the one outside.
        if (most == 1 || apart_mm * (1.0 - 0.5 / most) < thickness_mm) steps.push_back({a, b, c});
      }
    }
  }
  return steps;
}

}  // namespace

bool sameName(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return folded(x) == folded(y); });
}

std::string structureName(std::string_view text) {
  const std::string name = cutUtf8(cleanUtf8(text), kLongestName);
  // A space that does not break, and those without a width.
  std::string seen = name;
  for (const char* blank :
       {" ", "\u00a0", "\u200b", "\u200c", "\u200d", "\u2060", "\ufeff", "\u3000"}) {
    for (std::size_t at; (at = seen.find(blank)) != seen.npos;) {
      seen.erase(at, std::strlen(blank));
    }
  }
  return seen.empty() ? "" : name;
}

const Structure* LabelMap::find(const std::string& name) const {
  for (const Structure& s : structures) {
    if (sameName(s.name, name)) return &s;
  }
  return nullptr;
}

const Structure* LabelMap::find(int label) const {
  for (const Structure& s : structures) {
    if (s.label == label) return &s;
  }
  return nullptr;
}

Vec3 labelColour(int label) {
  // Hues a golden section apart, three quarters saturated.
  const double hue = std::fmod(label * 0.618033988749895, 1.0) * 6.0;
  const auto part = [&](double offset) {
    const double k = std::fmod(offset + hue, 6.0);
    return 1.0 - 0.75 * std::max(0.0, std::min({k, 4.0 - k, 1.0}));
  };
  return {part(5.0), part(3.0), part(1.0)};
}

int unusedLabel(const LabelMap& map) {
  std::array<bool, 256> used = labelsIn(map);
  for (const Structure& s : map.structures) used[std::size_t(s.label) & 255] = true;
  for (int label = 1; label < 256; ++label) {
    if (!used[std::size_t(label)]) return label;
  }
  return 0;
}

void nameTheRest(LabelMap& map) {
  const std::array<bool, 256> used = labelsIn(map);
  for (int label = 1; label < 256; ++label) {
    if (!used[std::size_t(label)] || map.find(label)) continue;
    map.structures.push_back({label, "label " + std::to_string(label), labelColour(label)});
  }
}

LabelMap withoutEmpty(LabelMap map) {
  const std::array<bool, 256> used = labelsIn(map);
  std::erase_if(map.structures, [&](const Structure& s) { return !used[std::size_t(s.label)]; });
  return map;
}

std::vector<std::uint8_t> shellOf(const LabelMap& map, int label, double thickness_mm) {
  const GridGeometry& g = map.geometry;
  const std::array<bool, 256> within = withinStructure(map, label);
  const std::vector<Index3> steps = shellSteps(g.spacing_mm, thickness_mm);
  std::vector<std::uint8_t> shell(map.labels.size(), 0);
  std::size_t index = 0;
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i, ++index) {
        if (map.labels[index] != label) continue;
        for (const Index3& s : steps) {
          const int a = i + s[0], b = j + s[1], c = k + s[2];
          if (!g.contains(a, b, c) || within[map.labels[g.indexOf(a, b, c)]]) continue;
          shell[index] = 1;
          break;
        }
      }
    }
  }
  return shell;
}

Result<LabelMap> readLabelMap(const std::filesystem::path& file) {
  const Result<Segmentation> read = readSegmentation(file);
  if (!read) return read.error();
  try {
    return merged(*read, smallerFirst(*read));
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the label map"), file.string());
  }
}

Status writeLabelMap(const LabelMap& map, const std::filesystem::path& file, bool reversed_slices,
                     const Progress& progress) {
  VoxelSlabs slabs;
  slabs.geometry = map.geometry;
  slabs.read = [&](std::size_t first, std::span<std::int16_t> into) {
    const auto from = map.labels.begin() + std::ptrdiff_t(first);
    std::copy(from, from + std::ptrdiff_t(into.size()), into.begin());
  };
  return writeVolume(slabs, file, progress, {VoxelType::uint8, reversed_slices});
}

Result<LabelMap> fitTo(const LabelMap& map, const GridGeometry& ct) {
  const GridGeometry& from = map.geometry;
  const Mat4 to_map = from.patientToVoxel() * ct.voxelToPatient();
  const Vec3 step(to_map[0]), size(from.size[0], from.size[1], from.size[2]);
  if (Status enough = enoughMemory(labelsMb(ct.voxelCount()), tr("The label map"), ""); !enough) {
    return enough.error();
  }
  LabelMap fitted{ct, std::vector<std::uint8_t>(ct.voxelCount()), map.structures};
  std::uint8_t* label = fitted.labels.data();
  bool met = false;
  for (int k = 0; k < ct.size[2]; ++k) {
    for (int j = 0; j < ct.size[1]; ++j) {
      const Vec3 row = Vec3(to_map * glm::dvec4(0, j, k, 1)) + 0.5 + kTie;
      for (int i = 0; i < ct.size[0]; ++i, ++label) {
        const Vec3 v = row + double(i) * step;
        const bool inside = v.x >= 0.0 && v.y >= 0.0 && v.z >= 0.0 && v.x < size.x &&
                            v.y < size.y && v.z < size.z;
        if (!inside) continue;
        *label = map.labels[from.indexOf(int(v.x), int(v.y), int(v.z))];
        met = true;
      }
    }
  }
  if (!met) {
    return Error{code::kLabelsElsewhere,
                 tr("The label map and the case do not overlap in the patient"),
                 tr("the label map"), tr("Choose the label map that was made from this CT")};
  }
  return fitted;
}

std::string labelsSha256(const LabelMap& map) {
  return sha256Hex(map.labels.data(), map.labels.size());
}

}  // namespace trephine
