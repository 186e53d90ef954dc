// The row above the slices: which tool the mouse holds, the HU window, and what is coloured.
#pragma once

#include <QButtonGroup>
#include <QComboBox>
#include <QHBoxLayout>
#include <QSlider>
#include <QWidget>

#include "ui/views/slice_image.h"
#include "ui/views/toolbox.h"

namespace trephine {

class SliceBar : public QWidget {
  Q_OBJECT
 public:
  // The tools outlive it.
  explicit SliceBar(Toolbox& toolbox, QWidget* parent = nullptr);

  void showWindow(const HuWindow& window);
  void showOverlay(Overlay overlay, double opacity);
  void setLabelsAtHand(bool at_hand);

 signals:
  void windowChosen(const trephine::HuWindow& window);
  void overlayChosen(trephine::Overlay overlay, double opacity);

 private:
  void addTool(ViewTool* tool);
  void showTool();

  Toolbox& toolbox_;
  QHBoxLayout* row_;
  QButtonGroup* tools_;
  QComboBox *windows_, *overlays_;
  QSlider* opacity_;
};

}  // namespace trephine
