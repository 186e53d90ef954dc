// The row above the slices: which tool the mouse holds, the HU window, and what is coloured.
#pragma once

#include <QButtonGroup>
#include <QComboBox>
#include <QSlider>
#include <QWidget>

#include "ui/views/slice_view.h"

namespace trephine {

class SliceBar : public QWidget {
  Q_OBJECT
 public:
  explicit SliceBar(QWidget* parent = nullptr);

  void showTool(SliceTool tool);
  void showWindow(const HuWindow& window);
  void showOverlay(Overlay overlay, double opacity);
  void setLabelsAtHand(bool at_hand);

 signals:
  void toolChosen(trephine::SliceTool tool);
  void windowChosen(const trephine::HuWindow& window);
  void overlayChosen(trephine::Overlay overlay, double opacity);

 private:
  QButtonGroup* tools_;
  QComboBox *windows_, *overlays_;
  QSlider* opacity_;
};

}  // namespace trephine
