// The way back through a running exercise: a slider over its seconds, and "Back 10 s". The time of
// the exercise runs on whatever one goes back to, so the slider's end is always now. Each stroke
// has a mark in its arm's colour, faint where one went back to before it; after going back a
// pointer shows of which second the tissue is, until it is cut again.
#pragma once

#include <QAction>
#include <QColor>
#include <QLabel>
#include <QSlider>
#include <QTimer>
#include <QToolButton>
#include <QWidget>
#include <cstdint>
#include <optional>
#include <vector>

namespace trephine {

// Which second lies so many back for the person at work. Who went from 0:50 to 0:40 and asks for
// ten more means 0:30, not the 0:41 that the clock would give a second later.
class RewindHistory {
 public:
  void forget() { jumps_.clear(); }
  void went(std::uint32_t from, std::uint32_t to) { jumps_.push_back({from, to}); }
  std::uint32_t before(std::uint32_t now, std::uint32_t by) const;
  // What was done in a second stands still: no later jump went back to before it.
  bool stands(double second, std::uint32_t now) const;
  // Where the last jump went to.
  std::optional<std::uint32_t> last() const;

 private:
  struct Jump {
    std::uint32_t from, to;
  };
  std::vector<Jump> jumps_;  // in the order of time
};

class TimeSlider;

class RewindBar : public QWidget {
  Q_OBJECT
 public:
  static constexpr int kBack_s = 10;
  struct Stroke {
    double second = 0.0;
    QColor colour;
  };

  explicit RewindBar(QWidget* parent = nullptr);

  // Of the exercise that runs; `going_back` while tissue is being put back. What a person is
  // choosing stays where it is.
  void showTime(std::uint32_t now, bool going_back);
  // All of this exercise so far, in the order of time.
  void showStrokes(const std::vector<Stroke>& strokes);
  // All tissue is put back: as if one had gone back to the beginning.
  void noteReset();
  void showIdle();
  // "Back 10 s" with its key, for a menu; enabled while it can be used.
  QAction* backAction() { return back_; }

 signals:
  // Never the newest second: there nothing is to be gone back to.
  void rewindAsked(quint32 second);

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  bool choosing() const;
  void setUsable(bool usable);
  void follow();
  void askChosen();
  void goBack() { ask(rewind_history_.before(now_, kBack_s)); }
  void ask(std::uint32_t second);
  void showChosen();
  void showMarks();
  std::optional<std::uint32_t> goneBackTo() const;

  QAction* back_;
  QToolButton* back_button_;
  TimeSlider* slider_;
  QLabel* time_;
  QTimer keys_;  // runs while more keys may come
  RewindHistory rewind_history_;
  RewindHistory tissue_history_;  // with what was put back otherwise
  std::vector<Stroke> strokes_;
  std::size_t strokes_at_jump_ = 0;
  QWidget* had_focus_ = nullptr;  // and gets it again after going back,
  QWidget* lent_to_ = nullptr;    // unless the person went on from here
  std::uint32_t now_ = 0;
};

}  // namespace trephine
