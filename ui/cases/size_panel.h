// How much of a series is read, and how finely: a box of its voxels, and full, half or a quarter of
// the resolution; and what comes out of it.
#pragma once

#include <QButtonGroup>
#include <QLabel>
#include <QPushButton>
#include <array>

#include "imaging/importer.h"
#include "ui/common/number_field.h"

namespace trephine {

class SizePanel : public QWidget {
  Q_OBJECT
 public:
  explicit SizePanel(QWidget* parent = nullptr);

  // Another grid, whole and at full resolution. Where it is not known yet (empty), only the
  // resolution can be set.
  void setGrid(const GridGeometry& grid);
  // Sets the first two axes, [low, high) in voxels; cut to the grid.
  void setBox(const VoxelBox& box);
  // As they were chosen before, of the same grid.
  void restore(const VoxelBox& box, int reduction);
  VoxelBox box() const;
  std::optional<VoxelBox> crop() const;  // nothing where the whole grid is taken
  int reduction() const;
  // A number was typed that cannot be had; the box is as it was.
  bool isRefused() const;

 signals:
  void changed();

 private:
  void edited();
  void reset();
  void showOutcome();

  GridGeometry grid_;
  std::array<WholeNumberField*, 3> from_, to_;  // counted from 1, both ends included
  QButtonGroup* reductions_;
  QWidget* box_rows_;
  QPushButton* reset_;
  QLabel* outcome_;
};

// Size and spacing of what is read of `grid`; origin and direction stay those of `grid`.
GridGeometry outcomeOf(const GridGeometry& grid, const VoxelBox& box, int reduction);

}  // namespace trephine
