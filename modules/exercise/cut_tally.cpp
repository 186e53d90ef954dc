#include "exercise/cut_tally.h"

namespace trephine {

namespace {

void count(CutVoxels& voxels, int tissue) {
  ++(tissue >= 0 ? voxels.of_tissue[std::size_t(tissue)] : voxels.unnamed);
}

}  // namespace

CutVoxels cutVoxels(const TrueTissues& tissues, const Volume& before, const Grid& after) {
  CutVoxels cut;
  TrueTissues::Enclosed known;
  for (std::size_t voxel = 0; voxel < before.hu.size(); ++voxel) {
    if (after.hu(voxel) != before.hu[voxel]) count(cut, tissues.at(voxel, &known));
  }
  return cut;
}

CutTally::CutTally(const TrueTissues& tissues, const Volume& before, const LabelMap* structures)
    : tissues_(tissues), before_(before), structures_(structures) {
  if (structures_ && structures_->labels.size() != before.hu.size()) structures_ = nullptr;
}

int CutTally::nameOf(std::size_t voxel, int& left) {
  const auto [block, fresh] = names_.try_emplace(voxel >> kBlockBits);
  if (fresh) block->second.fill(kNotYet);
  std::int8_t& name = block->second[voxel & ((std::size_t(1) << kBlockBits) - 1)];
  if (name == kNotYet && left > 0) {
    --left;
    name = std::int8_t(tissues_.at(voxel, &enclosed_));
  }
  return name;
}

bool CutTally::look(const Volume& now, const VoxelBox& box, const Step& step) {
  if (now.hu.size() != before_.hu.size()) return false;
  if (!next_) {
    box_ = box;
    next_ = box.low;
    so_far_ = {};
  }
  std::size_t looked = 0;
  int left = step.names;
  Index3& at = *next_;
  for (; at[2] < box_.high[2]; ++at[2], at[1] = box_.low[1]) {
    for (; at[1] < box_.high[1]; ++at[1], at[0] = box_.low[0]) {
      if (looked >= step.voxels) return false;
      const std::size_t row = before_.geometry.indexOf(0, at[1], at[2]);
      looked += std::size_t(box_.high[0] - at[0]);
      for (; at[0] < box_.high[0]; ++at[0]) {
        const std::size_t voxel = row + std::size_t(at[0]);
        if (now.hu[voxel] == before_.hu[voxel]) continue;
        const int name = nameOf(voxel, left);
        if (name == kNotYet) return false;
        count(so_far_, name);
        if (structures_) ++so_far_.of_label[structures_->labels[voxel]];
      }
    }
  }
  next_.reset();
  counts_ = so_far_;
  return true;
}

}  // namespace trephine
