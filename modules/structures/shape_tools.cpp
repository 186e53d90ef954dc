#include "structures/shape_tools.h"

#include <vtkCallbackCommand.h>
#include <vtkImageData.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/codes.h"
#include "base/tr.h"
#include "structures/codes.h"
#include "structures/label_edits.h"
#include "volume/codes.h"

namespace trephine {

namespace {

constexpr int kSlabSlices = 24;  // that are grown at a time, beside those that they look at

Error cancelled() {
  return {code::kCancelled, tr("The tool was cancelled"), "", ""};
}

Error noStructure(int label) {
  return {code::kNoStructure, tr("No voxel has the label {}", label), "label",
          tr("Choose a structure that has voxels")};
}

Index3 sizeOf(const VoxelBox& box) {
  return {box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]};
}

// The least box of the label's voxels; nothing where there are none. Two threads.
std::optional<VoxelBox> boxOf(const LabelMap& map, int label) {
  const Index3& size = map.geometry.size;
  std::vector<VoxelBox> layers(std::size_t(size[2]), VoxelBox{size, {0, 0, 0}});
  onTwoThreads(size[2], [&](int k) {
    VoxelBox& box = layers[std::size_t(k)];
    for (int j = 0; j < size[1]; ++j) {
      const std::uint8_t* row = &map.labels[map.geometry.indexOf(0, j, k)];
      const std::uint8_t* end = row + size[0];
      const std::uint8_t* first = std::find(row, end, std::uint8_t(label));
      if (first == end) continue;
      const std::uint8_t* last = end - 1;
      while (*last != label) --last;
      box.low = {std::min(box.low[0], int(first - row)), std::min(box.low[1], j), k};
      box.high = {std::max(box.high[0], int(last - row) + 1), j + 1, k + 1};
    }
  });
  VoxelBox all{size, {0, 0, 0}};
  for (const VoxelBox& box : layers) {
    if (box.high[2] == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all.low[axis] = std::min(all.low[axis], box.low[axis]);
      all.high[axis] = std::max(all.high[axis], box.high[axis]);
    }
  }
  if (all.high[2] == 0) return std::nullopt;
  return all;
}

VoxelBox widened(VoxelBox box, const Index3& by, const Index3& size) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::max(0, box.low[axis] - by[axis]);
    box.high[axis] = std::min(size[axis], box.high[axis] + by[axis]);
  }
  return box;
}

Index3 voxelsIn(double mm, const GridGeometry& g) {
  Index3 voxels;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    voxels[axis] = int(std::ceil(mm / g.spacing_mm[int(axis)]));
  }
  return voxels;
}

// A byte a voxel of a box, and where they lie.
struct Crop {
  explicit Crop(const VoxelBox& of) : box(of), size(sizeOf(of)) {
    values.resize(std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]));
  }
  std::size_t indexOf(int i, int j, int k) const {
    return (std::size_t(k - box.low[2]) * std::size_t(size[1]) + std::size_t(j - box.low[1])) *
               std::size_t(size[0]) +
           std::size_t(i - box.low[0]);
  }
  VoxelBox box;
  Index3 size;
  std::vector<std::uint8_t> values;
};

Crop cropOf(const LabelMap& map, int label, const VoxelBox& box, std::uint8_t in) {
  Crop crop(box);
  onTwoThreads(crop.size[2], [&](int layer) {
    const int k = box.low[2] + layer;
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      const std::uint8_t* from = &map.labels[map.geometry.indexOf(box.low[0], j, k)];
      std::uint8_t* to = &crop.values[crop.indexOf(box.low[0], j, k)];
      for (int i = 0; i < crop.size[0]; ++i) to[i] = from[i] == label ? in : 0;
    }
  });
  return crop;
}

// VTK asks the progress between its pieces of work.
struct Asked {
  const Progress& progress;
  static void now(vtkObject* caller, unsigned long, void* data, void*) {
    auto* filter = static_cast<vtkImageGaussianSmooth*>(caller);
    const Progress& of = static_cast<const Asked*>(data)->progress;
    of.at(0.1 + 0.8 * filter->GetProgress(), "smoothing");
    if (of.cancelled()) filter->SetAbortExecute(1);
  }
};

// Smooths the crop in place, by VTK. Each pass cuts off what is less than 1 of 255.
void smooth(Crop& crop, const GridGeometry& g, double sigma_mm, const Progress& progress) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(crop.size[0], crop.size[1], crop.size[2]);
  vtkNew<vtkUnsignedCharArray> array;
  array->SetArray(crop.values.data(), vtkIdType(crop.values.size()), 1);
  image->GetPointData()->SetScalars(array);
  vtkNew<vtkImageGaussianSmooth> filter;
  filter->SetInputData(image);
  const Vec3 sigma = sigma_mm / g.spacing_mm;
  filter->SetStandardDeviations(sigma.x, sigma.y, sigma.z);
  filter->SetRadiusFactor(3.0);
  Asked asked{progress};
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(&Asked::now);
  command->SetClientData(&asked);
  filter->AddObserver(vtkCommand::ProgressEvent, command);
  filter->Update();
  if (progress.cancelled()) return;
  auto* out = vtkUnsignedCharArray::SafeDownCast(filter->GetOutput()->GetPointData()->GetScalars());
  std::copy_n(out->GetPointer(0), crop.values.size(), crop.values.begin());
}

// The voxel of the label at a point, or the nearest within kNearPiece_mm.
std::optional<Index3> voxelAt(const LabelMap& map, int label, const Vec3& at_mm) {
  const GridGeometry& g = map.geometry;
  const Vec3 place = Vec3(g.patientToVoxel() * glm::dvec4(at_mm, 1.0));
  const Index3 reach = voxelsIn(kNearPiece_mm, g);
  Index3 low, high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = place[int(axis)];
    if (!(at > -double(reach[axis]) - 1.0 && at < double(g.size[axis]) + reach[axis])) return {};
    low[axis] = std::max(0, int(std::lround(at)) - reach[axis]);
    high[axis] = std::min(g.size[axis] - 1, int(std::lround(at)) + reach[axis]);
  }
  std::optional<Index3> found;
  // The click's own voxel before all others; its corners lie half a diagonal away.
  double nearest = std::max(kNearPiece_mm, 0.5 * glm::length(g.spacing_mm));
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        if (map.labels[g.indexOf(i, j, k)] != label) continue;
        const double mm = glm::length((Vec3(i, j, k) - place) * g.spacing_mm);
        if (mm > nearest) continue;
        nearest = mm;
        found = {i, j, k};
      }
    }
  }
  return found;
}

Result<LabelEdit> pieceEdit(const LabelMap& map, int label, const Vec3& at_mm, Touching touching,
                            bool keeps) {
  if (Status good = checkMap(map, label); !good) return good.error();
  if (!isFinite(at_mm)) return Error{code::kBadArgument, tr("The click is no place"), "at", ""};
  const std::uint8_t own = std::uint8_t(label);
  try {
    const GridGeometry& g = map.geometry;
    const std::optional<VoxelBox> box = boxOf(map, label);
    if (!box) return noStructure(label);
    const std::optional<Index3> voxel = voxelAt(map, label, at_mm);
    if (!voxel) {
      return Error{code::kNothingThere, tr("The structure has no voxel within 5 mm of the click"),
                   "at", tr("Click on the structure")};
    }
    const Index3& low = box->low;
    VoxelRuns runs(sizeOf(*box), [&](int i, int j, int k) {
      return map.labels[g.indexOf(low[0] + i, low[1] + j, low[2] + k)] == own;
    });
    runs.join(touching);
    const std::uint32_t clicked =
        runs.at({(*voxel)[0] - low[0], (*voxel)[1] - low[1], (*voxel)[2] - low[2]})->piece;
    EditMaker edit(map);
    for (int k = 0; k < runs.size()[2]; ++k) {
      for (int j = 0; j < runs.size()[1]; ++j) {
        const std::size_t row = g.indexOf(low[0], low[1] + j, low[2] + k);
        for (const VoxelRuns::Run& run : runs.row(j, k)) {
          if ((run.piece == clicked) == keeps) continue;
          for (int i = run.begin; i < run.end; ++i) edit.put(row + std::size_t(i), 0);
        }
      }
    }
    return edit.take();
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the pieces"), "");
  }
}

// The structure and those that lie within it, as shellOf() has it: more than half of their
// neighbours by faces are of it. All such neighbours lie in its box or beside it.
std::array<bool, 256> liesWithin(const LabelMap& map, int label, const VoxelBox& box) {
  std::array<std::size_t, 256> of_it{}, of_others{};
  const GridGeometry& g = map.geometry;
  const std::size_t strides[3] = {1, std::size_t(g.size[0]),
                                  std::size_t(g.size[0]) * std::size_t(g.size[1])};
  std::array<bool, 256> meets{};
  // Whether any structure touches this one is asked first: else there is nothing to count.
  const VoxelBox near = widened(box, {1, 1, 1}, g.size);
  const auto forPairs = [&](const VoxelBox& in, const auto& take) {
    for (int k = in.low[2]; k < in.high[2]; ++k) {
      for (int j = in.low[1]; j < in.high[1]; ++j) {
        std::size_t at = g.indexOf(in.low[0], j, k);
        for (int i = in.low[0]; i < in.high[0]; ++i, ++at) {
          const Index3 voxel{i, j, k};
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (voxel[axis] + 1 >= in.high[axis]) continue;
            const std::uint8_t a = map.labels[at], b = map.labels[at + strides[axis]];
            if (a != b) take(a, b);
          }
        }
      }
    }
  };
  bool any = false;
  forPairs(near, [&](std::uint8_t a, std::uint8_t b) {
    if (a != label && b != label) return;
    const std::uint8_t other = a == label ? b : a;
    ++of_it[other];
    meets[other] = true;
    any = any || other != 0;
  });
  if (any) {
    forPairs({{0, 0, 0}, g.size}, [&](std::uint8_t a, std::uint8_t b) {
      if (b != label) ++of_others[a];
      if (a != label) ++of_others[b];
    });
  }
  std::array<bool, 256> within{};
  for (std::size_t other = 1; other < 256; ++other) {
    within[other] = meets[other] && of_it[other] > of_others[other];
  }
  within[std::size_t(label)] = true;
  return within;
}

LabelEdit shellOfSlab(const LabelMap& map, int label, double thickness_mm, int into,
                      const std::array<bool, 256>& within, const VoxelBox& slab,
                      const Index3& reach) {
  const GridGeometry& g = map.geometry;
  const VoxelBox near = widened(slab, {reach[0] + 1, reach[1] + 1, reach[2] + 1}, g.size);
  LabelMap part{g, {}};
  part.geometry.size = sizeOf(near);
  part.labels.reserve(part.geometry.voxelCount());
  for (int k = near.low[2]; k < near.high[2]; ++k) {
    for (int j = near.low[1]; j < near.high[1]; ++j) {
      const std::uint8_t* row = &map.labels[g.indexOf(near.low[0], j, k)];
      for (int i = 0; i < part.geometry.size[0]; ++i) part.labels.push_back(within[row[i]]);
    }
  }
  const std::vector<std::uint8_t> layer = shellOf(part, 1, thickness_mm);
  EditMaker edit(map);
  for (int k = slab.low[2]; k < slab.high[2]; ++k) {
    for (int j = slab.low[1]; j < slab.high[1]; ++j) {
      const std::size_t from = part.geometry.indexOf(0, j - near.low[1], k - near.low[2]);
      for (int i = slab.low[0]; i < slab.high[0]; ++i) {
        const std::size_t at = g.indexOf(i, j, k);
        if (map.labels[at] == label && layer[from + std::size_t(i - near.low[0])]) {
          edit.put(at, std::uint8_t(into));
        }
      }
    }
  }
  return edit.take();
}

// Grown or shrunk slab by slab: a slab and what lies within `mm` of it tell what it becomes.
Result<LabelEdit> movedBy(const LabelMap& map, int label, double mm, const Labels& over, bool grows,
                          const Progress& progress) {
  if (Status good = checkMap(map, label); !good) return good.error();
  if (Status good = checkMm(mm, 0.05, 20.0, tr("The distance")); !good) return good.error();
  const GridGeometry& g = map.geometry;
  try {
    const std::optional<VoxelBox> tight = boxOf(map, label);
    if (!tight) return noStructure(label);
    const Index3 reach = voxelsIn(mm, g);
    const VoxelBox box = widened(*tight, grows ? reach : Index3{1, 1, 1}, g.size);
    std::vector<LabelEdit> slabs;
    for (int k = box.low[2]; k < box.high[2]; k += kSlabSlices) {
      progress.at(double(k - box.low[2]) / (box.high[2] - box.low[2]),
                  grows ? "growing" : "shrinking");
      if (progress.cancelled()) return cancelled();
      VoxelBox slab = box;
      slab.low[2] = k;
      slab.high[2] = std::min(k + kSlabSlices, box.high[2]);
      VoxelBox near = slab;
      near.low[2] = std::max(box.low[2], slab.low[2] - reach[2]);
      near.high[2] = std::min(box.high[2], slab.high[2] + reach[2]);
      Crop crop = cropOf(map, label, near, 1);
      if (!grows) {
        for (std::uint8_t& value : crop.values) value = !value;
      }
      WorkGrid grid;
      grid.size = crop.size;
      grid.block_mm = g.spacing_mm;
      const std::vector<float> away = distance_mm(crop.values, grid);
      // A hair more, for voxels that lie at that very distance.
      const float within = float(mm * (1.0 + 1e-6));
      slabs.push_back(editTo(map, label, slab, over, [&](int i, int j, int k_in) {
        return (away[crop.indexOf(i, j, k_in)] <= within) == grows;
      }));
    }
    return joined(std::move(slabs));
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the distances"), "");
  }
}

}  // namespace

Status checkMap(const LabelMap& map, int label) {
  if (label < 1 || label > 255) {
    return Error{code::kBadArgument, tr("A label is a number from 1 to 255"), "label", ""};
  }
  if (map.labels.empty() || map.labels.size() != map.geometry.voxelCount()) {
    return Error{code::kBadArgument, tr("The label map does not have the voxels of its grid"),
                 "map", ""};
  }
  return {};
}

Status checkMm(double mm, double least, double most, const std::string& what) {
  if (mm >= least && mm <= most) return {};
  char range[60];
  std::snprintf(range, sizeof range, " is from %g to %g mm", least, most);
  return Error{code::kBadArgument, std::string(what) + range, "mm", ""};
}

LabelEdit EditMaker::take() {
  const GridGeometry& g = map_.geometry;
  edit_.box = edit_.runs.empty() ? VoxelBox{} : VoxelBox{g.size, {0, 0, 0}};
  for (const LabelEdit::Run& run : edit_.runs) {
    edit_.voxels += run.count;
    const Index3 at = g.indicesOf(run.first);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      edit_.box.low[axis] = std::min(edit_.box.low[axis], at[axis]);
      const int end = at[axis] + (axis == 0 ? int(run.count) : 1);
      edit_.box.high[axis] = std::max(edit_.box.high[axis], end);
    }
  }
  return std::move(edit_);
}

LabelEdit joined(std::vector<LabelEdit> edits) {
  LabelEdit all;
  std::size_t runs = 0;
  for (const LabelEdit& edit : edits) runs += edit.runs.size();
  all.runs.reserve(runs);
  for (LabelEdit& edit : edits) {
    if (edit.empty()) continue;
    if (all.empty()) all.box = edit.box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all.box.low[axis] = std::min(all.box.low[axis], edit.box.low[axis]);
      all.box.high[axis] = std::max(all.box.high[axis], edit.box.high[axis]);
    }
    all.voxels += edit.voxels;
    all.runs.insert(all.runs.end(), edit.runs.begin(), edit.runs.end());
    edit = LabelEdit();
  }
  return all;
}

void apply(LabelMap& map, const LabelEdit& edit) {
  for (const LabelEdit::Run& run : edit.runs) {
    std::fill_n(map.labels.begin() + std::ptrdiff_t(run.first), run.count, run.after);
  }
}

void undo(LabelMap& map, const LabelEdit& edit) {
  for (const LabelEdit::Run& run : edit.runs) {
    std::fill_n(map.labels.begin() + std::ptrdiff_t(run.first), run.count, run.before);
  }
}

Result<LabelEdit> maskEdit(const LabelMap& map, std::span<const std::uint8_t> mask, int label,
                           const Labels& over) {
  if (Status good = checkMap(map, label); !good) return good.error();
  if (mask.size() != map.labels.size()) {
    return Error{code::kOtherGrid, tr("The mask is not of the label map's grid"), "mask", ""};
  }
  const GridGeometry& g = map.geometry;
  try {
    return editTo(map, label, VoxelBox{{0, 0, 0}, g.size}, over,
                  [&](int i, int j, int k) { return mask[g.indexOf(i, j, k)] != 0; });
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("to change a structure"), "");
  }
}

Result<LabelEdit> holesEdit(const LabelMap& map, int label, std::optional<int> across,
                            const Labels& over, const Progress& progress) {
  if (Status good = checkMap(map, label); !good) return good.error();
  if (across && (*across < 0 || *across > 2)) {
    return Error{code::kBadArgument, tr("Slices lie across axis 0, 1 or 2"), "across", ""};
  }
  const GridGeometry& g = map.geometry;
  const std::uint8_t own = std::uint8_t(label);
  try {
    const std::optional<VoxelBox> box = boxOf(map, label);
    if (!box) return noStructure(label);
    progress.at(0.1, "holes");
    if (progress.cancelled()) return cancelled();
    // Layers are the slices.
    const std::array<std::array<std::size_t, 3>, 3> orders{{{1, 2, 0}, {0, 2, 1}, {0, 1, 2}}};
    const std::array<std::size_t, 3>& axes = orders[std::size_t(across.value_or(2))];
    const std::size_t strides[3] = {1, std::size_t(g.size[0]),
                                    std::size_t(g.size[0]) * std::size_t(g.size[1])};
    const auto indexOf = [&](int a, int b, int c) {
      return std::size_t(a + box->low[axes[0]]) * strides[axes[0]] +
             std::size_t(b + box->low[axes[1]]) * strides[axes[1]] +
             std::size_t(c + box->low[axes[2]]) * strides[axes[2]];
    };
    const Index3 whole = sizeOf(*box), size{whole[axes[0]], whole[axes[1]], whole[axes[2]]};
    VoxelRuns about(size, [&](int a, int b, int c) { return map.labels[indexOf(a, b, c)] != own; });
    progress.at(0.5, "holes");
    if (progress.cancelled()) return cancelled();
    about.join(across ? Touching::faces_in_layer : Touching::faces);
    std::vector<std::size_t> filled;
    for (int c = 0; c < size[2]; ++c) {
      for (int b = 0; b < size[1]; ++b) {
        for (const VoxelRuns::Run& run : about.row(b, c)) {
          if (about.pieces()[run.piece].at_border) continue;
          for (int a = run.begin; a < run.end; ++a) {
            const std::size_t at = indexOf(a, b, c);
            if (isFree(map.labels[at], own, over)) filled.push_back(at);
          }
        }
      }
    }
    if (axes[2] != 2) std::sort(filled.begin(), filled.end());
    EditMaker edit(map);
    for (const std::size_t at : filled) edit.put(at, own);
    return edit.take();
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the holes"), "");
  }
}

Result<LabelEdit> smoothEdit(const LabelMap& map, int label, double radius_mm, const Labels& over,
                             const Progress& progress) {
  if (Status good = checkMap(map, label); !good) return good.error();
  if (Status good = checkMm(radius_mm, 0.1, 20.0, tr("The radius")); !good) return good.error();
  try {
    const std::optional<VoxelBox> tight = boxOf(map, label);
    if (!tight) return noStructure(label);
    const double sigma_mm = 0.5 * radius_mm;
    const VoxelBox box = widened(*tight, voxelsIn(3.0 * sigma_mm, map.geometry), map.geometry.size);
    const Index3 size = sizeOf(box);
    const double bytes = double(size[0]) * size[1] * size[2];
    if (Status enough = enoughMemory(4.0 * bytes / (1 << 20), tr("Smoothing"), ""); !enough) {
      return enough.error();
    }
    progress.at(0.0, "smoothing");
    if (progress.cancelled()) return cancelled();
    Crop crop = cropOf(map, label, box, 255);
    const std::size_t before =
        std::size_t(std::count(crop.values.begin(), crop.values.end(), std::uint8_t(255)));
    smooth(crop, map.geometry, sigma_mm, progress);
    if (progress.cancelled()) return cancelled();
    // The cut that keeps the volume.
    std::array<std::size_t, 256> with{};
    for (const std::uint8_t value : crop.values) ++with[value];
    int cut = 255;
    std::size_t in = with[255];
    while (cut > 1) {
      const std::size_t more = in + with[std::size_t(cut) - 1];
      const auto off = [&](std::size_t n) { return n > before ? n - before : before - n; };
      if (in >= before || off(more) > off(in)) break;
      in = more;
      --cut;
    }
    return editTo(map, label, box, over,
                  [&](int i, int j, int k) { return crop.values[crop.indexOf(i, j, k)] >= cut; });
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for smoothing"), "");
  }
}

Result<LabelEdit> keepPieceEdit(const LabelMap& map, int label, const Vec3& at_mm,
                                Touching touching) {
  return pieceEdit(map, label, at_mm, touching, true);
}

Result<LabelEdit> removePieceEdit(const LabelMap& map, int label, const Vec3& at_mm,
                                  Touching touching) {
  return pieceEdit(map, label, at_mm, touching, false);
}

Result<LabelEdit> shellEdit(const LabelMap& map, int label, double thickness_mm, int into,
                            const Progress& progress) {
  if (Status good = checkMap(map, label); !good) return good.error();
  if (Status good = checkMap(map, into); !good) return good.error();
  if (into == label) {
    return Error{code::kBadArgument, tr("The shell needs a label of its own"), "into", ""};
  }
  if (Status good = checkMm(thickness_mm, 0.1, 50.0, tr("The thickness")); !good)
    return good.error();
  try {
    const std::optional<VoxelBox> box = boxOf(map, label);
    if (!box) return noStructure(label);
    progress.at(0.0, "shell");
    if (progress.cancelled()) return cancelled();
    // For shellOf(), slab by slab: what lies within the structure counts as it, all else as
    // outside.
    const std::array<bool, 256> within = liesWithin(map, label, *box);
    const Index3 reach = voxelsIn(thickness_mm, map.geometry);
    const int slabs = (box->high[2] - box->low[2] + kSlabSlices - 1) / kSlabSlices;
    std::vector<LabelEdit> edits;
    edits.resize(std::size_t(slabs));
    for (int slab = 0; slab < slabs; slab += 2) {
      progress.at(double(slab) / slabs, "shell");
      if (progress.cancelled()) return cancelled();
      onTwoThreadsOrThrow(std::min(2, slabs - slab), [&](int n) {
        VoxelBox of = *box;
        of.low[2] = box->low[2] + (slab + n) * kSlabSlices;
        of.high[2] = std::min(of.low[2] + kSlabSlices, box->high[2]);
        edits[std::size_t(slab + n)] =
            shellOfSlab(map, label, thickness_mm, into, within, of, reach);
      });
    }
    return joined(std::move(edits));
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the shell"), "");
  }
}

Result<LabelEdit> growEdit(const LabelMap& map, int label, double mm, const Labels& over,
                           const Progress& progress) {
  return movedBy(map, label, mm, over, true, progress);
}

Result<LabelEdit> shrinkEdit(const LabelMap& map, int label, double mm, const Progress& progress) {
  return movedBy(map, label, mm, {}, false, progress);
}

}  // namespace trephine
