// Shown, ghosted or hidden: the choice beside a tissue's name.
#pragma once

#include <QComboBox>
#include <cmath>
#include <functional>

#include "tissue/tissue_look.h"

namespace trephine {

class LookBox : public QComboBox {
  Q_OBJECT
 public:
  explicit LookBox(QWidget* parent = nullptr);
  // Its object is called "look:" and the id.
  void show(const Tissue& tissue, TissueLook look);
  // Closed it is an eye, without the word.
  void setIconAlone();
  // A person has chosen.
  std::function<void(TissueLook)> chosen;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  bool icon_alone_ = false;
};

// A slider of opacity is finer where tissues are nearly clear: position 0 to 1 against opacity per
// mm.
inline double opacityAtSlider(double position) {
  return position * position;
}
inline double sliderAtOpacity(double opacity) {
  return std::sqrt(opacity);
}

}  // namespace trephine
