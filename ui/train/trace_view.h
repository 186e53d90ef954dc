// The last ten seconds of a value as a line that runs to the left: what was sent, and behind it
// what was demanded, where there is that.
#pragma once

#include <QColor>
#include <QString>
#include <QWidget>
#include <vector>

namespace trephine {

class TraceView : public QWidget {
  Q_OBJECT
 public:
  static constexpr double kShown_s = 10.0;

  // `unit` of the values; the scale reaches from `low` to `high` at least, and further where values
  // do.
  TraceView(const QString& title, const QString& unit, double low, double high,
            QWidget* parent = nullptr);

  void setColour(const QColor& colour) { colour_ = colour; }  // from the next update() on
  // `time_s` of the session; finite numbers. An earlier time than the last begins the trace anew.
  // What is older than ten seconds goes, in blocks of 256 values. The second line is drawn once a
  // `demanded` was not the value. Shown with the next update(): values come more often than a line
  // of hundreds of them can be drawn.
  void add(double time_s, double value) { add(time_s, value, value); }
  void add(double time_s, double value, double demanded);
  void clear();
  QSize sizeHint() const override { return {200, 3 * fontMetrics().height() + 20}; }
  QSize minimumSizeHint() const override;

  struct Sample {
    double time_s, value, demanded;
  };
  const std::vector<Sample>& samples() const { return samples_; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString title_, unit_;
  double low_, high_;
  QColor colour_;
  bool two_ = false;
  std::vector<Sample> samples_;
};

}  // namespace trephine
