// Force against depth of the pokes: what was demanded and what was sent, of the one that goes on
// and the last three. Behind them, of the tissue that is chosen, what each tool would meet in a
// block of it, and the published range of that force.
#pragma once

#include <QColor>
#include <QWidget>
#include <vector>

#include "session/poke_curves.h"
#include "session/tissue_poke.h"
#include "tissue/tissue_set.h"

namespace trephine {

// A tool's poke of a tissue as computed beforehand.
struct ForeseenPoke {
  QString tool;  // as the exercise calls it
  QColor colour;
  PokeCurve curve;
  std::vector<PublishedBand> bands;
};

class PokePlot : public QWidget {
  Q_OBJECT
 public:
  explicit PokePlot(QWidget* parent = nullptr);

  // `limit_N`: of the arm that pokes.
  void showPokes(const std::vector<PokeCurve>& pokes, const TissueSet& tissues, double limit_N);
  const std::vector<PokeCurve>& pokes() const { return pokes_; }
  // Of one tissue, a tool each, and the friction [N] of the arm itself; 0: not known.
  void showForeseen(const std::vector<ForeseenPoke>& foreseen, double friction_N);
  const std::vector<ForeseenPoke>& foreseen() const { return foreseen_; }

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  // Patient mm and newtons to the widget's pixels.
  struct Axes {
    QRectF in;
    double least_mm = 0.0, deepest_mm = 1.0, most_N = 0.2;
    QPointF at(double depth_mm, double force_N) const;
  };
  QString nameOf(const PokeCurve& poke) const;
  Axes axes() const;
  void drawForeseen(QPainter& painter, const Axes& axes) const;
  void drawPokes(QPainter& painter, const Axes& axes) const;
  void drawLevel(QPainter& painter, const Axes& axes, double force_N, const QColor& colour,
                 const QString& words) const;
  void drawLegend(QPainter& painter, const Axes& axes) const;
  void drawScales(QPainter& painter, const Axes& axes) const;

  std::vector<PokeCurve> pokes_;
  std::vector<ForeseenPoke> foreseen_;
  TissueSet tissues_;
  double limit_N_ = 0.0, friction_N_ = 0.0;
};

}  // namespace trephine
