#include "ui/cases/size_panel.h"

#include <QGridLayout>
#include <QRadioButton>
#include <algorithm>

#include "ui/cases/import_words.h"
#include "ui/common/making.h"
#include "volume/reduce.h"

namespace trephine {

SizePanel::SizePanel(QWidget* parent) : QWidget(parent) {
  reductions_ = new QButtonGroup(this);
  auto* resolution_row = new QHBoxLayout;
  resolution_row->addWidget(new QLabel(tr("Resolution"), this));
  const std::pair<int, QString> names[] = {{1, tr("F&ull")}, {2, tr("&Half")}, {4, tr("&Quarter")}};
  for (const auto& [reduction, name] : names) {
    auto* button = new QRadioButton(name, this);
    button->setObjectName(QString("reduction%1").arg(reduction));
    reductions_->addButton(button, reduction);
    resolution_row->addWidget(button);
  }
  reductions_->button(1)->setChecked(true);
  resolution_row->addStretch(1);

  box_rows_ = new QWidget(this);
  auto* rows = tight(new QGridLayout(box_rows_));
  rows->setColumnStretch(1, 1);
  rows->setColumnStretch(3, 1);
  const QString axes[] = {tr("Columns"), tr("Rows"), tr("Slices")};
  for (int axis = 0; axis < 3; ++axis) {
    const auto makeBox = [&](const char* name, const QString& what) {
      auto* box = new WholeNumberField(QString("%1%2").arg(name).arg(axis), this);
      box->setAccessibleName(what.arg(axes[axis]));
      box->entered = [this] { edited(); };
      connect(box, &QSpinBox::valueChanged, this, [this] {  // or refused
        showOutcome();
        emit changed();
      });
      return box;
    };
    const auto i = std::size_t(axis);
    from_[i] = makeBox("cropFrom", tr("%1 from"));
    to_[i] = makeBox("cropTo", tr("%1 to"));
    rows->addWidget(new QLabel(axes[axis], this), axis, 0);
    rows->addLayout(from_[i]->withReason(), axis, 1);
    rows->addWidget(new QLabel(tr("to"), this), axis, 2);
    rows->addLayout(to_[i]->withReason(), axis, 3);
  }
  reset_ = namedButton("cropReset", tr("&Take all of it"), false, this);
  outcome_ = wrappedLabel("sizeOutcome", {"quiet"});
  rows->addWidget(outcome_, 3, 0, 1, 3);
  rows->addWidget(reset_, 3, 3);

  auto* layout = tight(new QVBoxLayout(this));
  layout->addLayout(resolution_row);
  layout->addWidget(box_rows_);

  connect(reductions_, &QButtonGroup::idToggled, this, [this](int, bool on) {
    if (on) edited();
  });
  connect(reset_, &QPushButton::clicked, this, &SizePanel::reset);
  setGrid({});
}

void SizePanel::setGrid(const GridGeometry& grid) {
  grid_ = grid;
  {
    const QSignalBlocker quiet(reductions_);
    reductions_->button(1)->setChecked(true);
  }
  box_rows_->setVisible(grid_.voxelCount() > 0);
  reset();
}

void SizePanel::restore(const VoxelBox& box, int reduction) {
  reductions_->button(reduction)->setChecked(true);
  setBox(box);
}

void SizePanel::reset() {
  setBox({{0, 0, 0}, grid_.size});
}

void SizePanel::setBox(const VoxelBox& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int size = std::max(1, grid_.size[axis]);
    const int low = std::clamp(box.low[axis] + 1, 1, size);
    from_[axis]->show(low);
    to_[axis]->show(std::clamp(box.high[axis], low, size));
  }
  edited();
}

// Neither end can pass the other.
void SizePanel::edited() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    from_[axis]->setLimits(1, to_[axis]->wanted());
    to_[axis]->setLimits(from_[axis]->wanted(), std::max(1, grid_.size[axis]));
    for (WholeNumberField* box : {from_[axis], to_[axis]}) box->take();
  }
  showOutcome();
  emit changed();
}

bool SizePanel::isRefused() const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (from_[axis]->isRefused() || to_[axis]->isRefused()) return true;
  }
  return false;
}

VoxelBox SizePanel::box() const {
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = from_[axis]->wanted() - 1;
    box.high[axis] = to_[axis]->wanted();
  }
  return box;
}

std::optional<VoxelBox> SizePanel::crop() const {
  const VoxelBox taken = box();
  if (grid_.voxelCount() == 0 || taken == VoxelBox{{0, 0, 0}, grid_.size}) return {};
  return taken;
}

int SizePanel::reduction() const {
  return reductions_->checkedId();
}

void SizePanel::showOutcome() {
  reset_->setEnabled(crop() || isRefused());
  if (grid_.voxelCount() == 0) return outcome_->clear();
  const GridGeometry out = outcomeOf(grid_, box(), reduction());
  outcome_->setText(tr("%1: %2").arg(
      gridWords(out), megabytes(double(out.voxelCount()) * sizeof(std::int16_t) / 1048576.0)));
}

}  // namespace trephine
