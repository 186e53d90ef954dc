// The tissues of a set over the histogram of the case: the HU of each, how much of the case it has,
// gaps between them, and thresholds that are dragged or moved by key. Of the place in which the
// chosen tissue is known: all voxels, or those of its structure or label.
//
// It changes no set: where a threshold is to go is told by a signal.
#pragma once

#include <QWidget>
#include <memory>
#include <optional>

#include "exercise/tissue_shares.h"
#include "tissue/tissue_edits.h"
#include "volume/hu_histogram.h"

namespace trephine {

class HistogramView : public QWidget {
  Q_OBJECT
 public:
  explicit HistogramView(QWidget* parent = nullptr);

  // Null: it is being counted; before the first time there is no case.
  void setHistogram(std::shared_ptr<const HuHistogram> histogram);
  // Placed in the case; `chosen` is a tissue of the set.
  void setTissues(const TissueSet& tissues, std::size_t chosen);
  // Of a range that was typed for the chosen tissue and is not possible; empty: none.
  void showOverlaps(const std::vector<HuOverlap>& overlaps);
  void setLocked(bool locked);
  // What is being dragged or stepped ends where it is.
  void letGo();

  const TissueShares& shares() const { return shares_; }

  // Where a threshold is drawn, and the HU at a place of the widget.
  double xOf(double hu) const;
  double huAt(double x) const;
  QRectF plot() const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 signals:
  // `alone`: its neighbour stays (Ctrl is held). From dragBegan() to dragEnded() it is one edit,
  // and each is meant of the set as it was at dragBegan().
  void thresholdMoved(std::size_t tissue, trephine::RangeEnd end, int hu, bool alone);
  void dragBegan();
  void dragEnded();
  void tissueChosen(std::size_t tissue);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void leaveEvent(QEvent* event) override;
  bool event(QEvent* event) override;

 private:
  struct Threshold {
    std::size_t tissue = 0;
    RangeEnd end = RangeEnd::low;
    friend bool operator==(const Threshold&, const Threshold&) = default;
  };
  std::vector<std::size_t> shown() const;  // tissues of the place, in rising order of their HU
  int huOf(const Threshold& threshold) const;
  double edgeOf(const Threshold& threshold) const;  // between two HU
  std::optional<Threshold> thresholdAt(const QPointF& place) const;
  std::optional<std::size_t> tissueAt(const QPointF& place) const;
  void move(int hu, bool alone);
  void step(int hus, bool alone);
  void stopStepping();
  void chooseNext(int by);
  void zoom(double factor, double about_hu);
  void showAll();
  void count();
  void paintCounts(QPainter& painter, const QRectF& plot) const;
  void paintBands(QPainter& painter) const;
  void paintThresholds(QPainter& painter) const;
  void paintAxis(QPainter& painter, const QRectF& plot) const;
  void paintLegend(QPainter& painter, const QRectF& plot) const;
  QRectF bands() const;

  std::shared_ptr<const HuHistogram> histogram_;
  std::vector<std::uint64_t> counts_;  // of the place
  TissueSet tissues_;
  TissueTable table_;
  TissueShares shares_;
  std::size_t chosen_ = 0;
  std::vector<HuOverlap> overlaps_;
  bool locked_ = false;
  double from_hu_ = -1024.0, to_hu_ = 3071.0;  // what is seen
  bool fitted_ = false;
  bool any_case_ = false;
  Threshold active_;
  std::optional<Threshold> dragged_, over_;
  double grip_hu_ = 0.0;      // between the pointer and the threshold that it holds
  bool stepping_ = false;  // by key
};

}  // namespace trephine
