// Force against depth of the pokes: what was demanded and what was sent, of the one that goes on and
// the last three.
#pragma once

#include <QWidget>
#include <vector>

#include "session/poke_curves.h"
#include "tissue/tissue_set.h"

namespace trephine {

class PokePlot : public QWidget {
  Q_OBJECT
 public:
  explicit PokePlot(QWidget* parent = nullptr);

  // `limit_N`: of the arm that pokes.
  void showPokes(const std::vector<PokeCurve>& pokes, const TissueSet& tissues, double limit_N);
  const std::vector<PokeCurve>& pokes() const { return pokes_; }

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString nameOf(const PokeCurve& poke) const;

  std::vector<PokeCurve> pokes_;
  TissueSet tissues_;
  double limit_N_ = 0.0;
};

}  // namespace trephine
