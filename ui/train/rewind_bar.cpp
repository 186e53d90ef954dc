#include "ui/train/rewind_bar.h"

#include <QHBoxLayout>
#include <QKeyEvent>
#include <QPainter>
#include <QProxyStyle>
#include <QSignalBlocker>
#include <QStyleOptionSlider>
#include <QWheelEvent>
#include <algorithm>
#include <initializer_list>

#include "ui/common/colours.h"
#include "ui/common/icons.h"
#include "ui/common/making.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kKeyPause_ms = 600;

// A click is meant for the second under it.
class ClickedPlace : public QProxyStyle {
 public:
  ClickedPlace() : QProxyStyle("Fusion") {}
  int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                QStyleHintReturn* data) const override {
    if (hint == SH_Slider_AbsoluteSetButtons) return Qt::LeftButton;
    return QProxyStyle::styleHint(hint, option, widget, data);
  }
};

constexpr int kMarkHeight = 7, kFaint = 90;

}  // namespace

class TimeSlider : public QSlider {
 public:
  struct Mark {
    double second;
    QColor colour;
  };

  explicit TimeSlider(QWidget* parent) : QSlider(Qt::Horizontal, parent) {
    auto* style = new ClickedPlace;
    style->setParent(this);
    setStyle(style);
  }

  void setMarks(std::vector<Mark> marks, std::optional<std::uint32_t> gone_back_to) {
    marks_ = std::move(marks);
    gone_back_to_ = gone_back_to;
    update();
  }

 protected:
  void paintEvent(QPaintEvent* event) override {
    QSlider::paintEvent(event);
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    for (const Mark& mark : marks_) {
      painter.fillRect(QRectF(xOf(mark.second) - 1.0, height() - kMarkHeight, 2.0, kMarkHeight),
                       mark.colour);
    }
    if (!gone_back_to_) return;
    const double x = xOf(*gone_back_to_);
    painter.setPen(Qt::NoPen);
    painter.setBrush(colours::kCaution);
    painter.drawPolygon(QPolygonF({{x - 5.0, 0.0}, {x + 5.0, 0.0}, {x, 8.0}}));
  }
  // The wheel moves a hand in the view beside it, and must not go back by a slip.
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }
  // Home belongs to the view but where the slider has the focus.
  bool event(QEvent* event) override {
    if (event->type() == QEvent::ShortcutOverride) {
      const int key = static_cast<QKeyEvent*>(event)->key();
      if (key == Qt::Key_Home || key == Qt::Key_End) event->accept();
    }
    return QSlider::event(event);
  }

 private:
  double xOf(double second) const {
    QStyleOptionSlider option;
    initStyleOption(&option);
    const int handle = style()->pixelMetric(QStyle::PM_SliderLength, &option, this);
    const double share = maximum() > 0 ? std::min(1.0, second / maximum()) : 0.0;
    return 0.5 * handle + share * (width() - handle);
  }

  std::vector<Mark> marks_;
  std::optional<std::uint32_t> gone_back_to_;
};

std::uint32_t RewindHistory::before(std::uint32_t now, std::uint32_t by) const {
  std::uint32_t second = now;
  for (auto jump = jumps_.rbegin(); jump != jumps_.rend(); ++jump) {
    // Made later than where the way has come; a second that one left was before its jump.
    if (second != now && jump->from >= second) continue;
    const std::uint32_t since = second - jump->from;
    if (by < since) break;
    by -= since;
    second = jump->to;
  }
  return second - std::min(by, second);
}

bool RewindHistory::stands(double second, std::uint32_t now) const {
  std::uint32_t end = now;
  for (auto jump = jumps_.rbegin(); jump != jumps_.rend(); ++jump) {
    if (end != now && jump->from >= end) continue;  // made later than where the way has come
    if (second > jump->from) return true;
    end = jump->to;
  }
  return end == now || second <= end;  // the running second counts
}

std::optional<std::uint32_t> RewindHistory::last() const {
  if (jumps_.empty()) return {};
  return jumps_.back().to;
}

RewindBar::RewindBar(QWidget* parent) : QWidget(parent) {
  back_ = named(new QAction(symbolIcon(Symbol::back), tr("Back %1 s").arg(kBack_s), this), "back");
  back_->setShortcut(QKeySequence(Qt::CTRL | Qt::Key_Backspace));
  back_->setToolTip(tr("Tissue, counts and forces as they were %1 s ago (%2)")
                        .arg(kBack_s)
                        .arg(back_->shortcut().toString(QKeySequence::NativeText)));
  back_button_ = named(new QToolButton(this), "backButton");
  back_button_->setDefaultAction(back_);
  back_button_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  back_button_->setAutoRaise(true);
  slider_ = named(new TimeSlider(this), "rewindSlider");
  slider_->setAccessibleName(tr("Second of the exercise to go back to"));
  slider_->setToolTip(
      tr("Go back to any second: tissue, counts and forces as they were then.\n"
         "Left, Right: 1 s. Page Up, Page Down: 10 s. Home: the beginning. Esc: stay."));
  slider_->setSingleStep(1);
  slider_->setPageStep(kBack_s);
  time_ = named(new QLabel(this), "rewindTime");
  time_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  const QFontMetrics metrics = time_->fontMetrics();
  time_->setMinimumWidth(
      std::max(metrics.horizontalAdvance(tr("Going back\u2026")),
               metrics.horizontalAdvance(tr("%1, tissue of %2").arg("00:00", "00:00"))));
  // By the Tab key only: a click must leave the keys to the hands in the view.
  for (QWidget* widget : std::initializer_list<QWidget*>{back_button_, slider_}) {
    widget->setFocusPolicy(Qt::TabFocus);
  }
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(8, 2, 8, 2);
  layout->addWidget(back_button_);
  layout->addWidget(slider_, 1);
  layout->addWidget(time_);

  keys_.setSingleShot(true);
  keys_.setInterval(kKeyPause_ms);
  connect(&keys_, &QTimer::timeout, this, &RewindBar::askChosen);
  connect(slider_, &QSlider::sliderPressed, &keys_, &QTimer::stop);
  connect(slider_, &QSlider::sliderReleased, this, &RewindBar::askChosen);
  connect(slider_, &QSlider::valueChanged, this, [this] {
    if (!slider_->isSliderDown()) keys_.start();
    showChosen();
  });
  connect(back_, &QAction::triggered, this, &RewindBar::goBack);
  showIdle();
}

bool RewindBar::choosing() const {
  return slider_->isSliderDown() || keys_.isActive();
}

void RewindBar::showTime(std::uint32_t now, bool going_back) {
  now_ = now;
  setUsable(!going_back);
  if (going_back) {
    time_->setText(tr("Going back\u2026"));
  } else if (choosing()) {
    showChosen();
  } else {
    follow();
  }
}

void RewindBar::showStrokes(const std::vector<Stroke>& strokes) {
  if (strokes.size() == strokes_.size()) return;
  strokes_ = strokes;
  showMarks();
}

void RewindBar::noteReset() {
  tissue_history_.went(now_, 0);
  strokes_at_jump_ = strokes_.size();
  showMarks();
}

// Until something is cut again.
std::optional<std::uint32_t> RewindBar::goneBackTo() const {
  if (strokes_.size() > strokes_at_jump_) return {};
  return tissue_history_.last();
}

void RewindBar::showMarks() {
  std::vector<TimeSlider::Mark> marks;
  for (const Stroke& stroke : strokes_) {
    QColor colour = stroke.colour;
    if (!tissue_history_.stands(stroke.second, now_)) colour.setAlpha(kFaint);
    marks.push_back({stroke.second, colour});
  }
  slider_->setMarks(std::move(marks), goneBackTo());
}

void RewindBar::showIdle() {
  now_ = 0;
  rewind_history_.forget();
  tissue_history_.forget();
  strokes_.clear();
  strokes_at_jump_ = 0;
  showMarks();
  setUsable(false);
  had_focus_ = nullptr;
  follow();
  time_->setText(QStringLiteral("\u2013"));
}

// Disabled, a widget loses the focus to the next one.
void RewindBar::setUsable(bool usable) {
  if (slider_->isEnabled() == usable) return;
  if (!usable) {
    keys_.stop();
    {
      const QSignalBlocker quiet(slider_);  // letting go here is no choice
      slider_->setSliderDown(false);
    }
    for (QWidget* widget : std::initializer_list<QWidget*>{back_button_, slider_}) {
      if (widget->hasFocus()) had_focus_ = widget;
    }
  }
  slider_->setEnabled(usable);
  back_->setEnabled(usable);
  if (!usable) {
    lent_to_ = window()->focusWidget();
  } else if (had_focus_) {
    if (window()->focusWidget() == lent_to_) had_focus_->setFocus();
    had_focus_ = nullptr;
  }
}

void RewindBar::follow() {
  {
    const QSignalBlocker quiet(slider_);
    slider_->setRange(0, int(now_));
    slider_->setValue(int(now_));
  }
  showChosen();
}

void RewindBar::showChosen() {
  const auto chosen = std::uint32_t(slider_->value());
  const bool newest = slider_->value() == slider_->maximum();
  const std::optional<std::uint32_t> tissue = goneBackTo();
  time_->setText(!newest   ? tr("%1 of %2").arg(timeWords(chosen), timeWords(now_))
                 : !tissue ? timeWords(now_)
                           : tr("%1, tissue of %2").arg(timeWords(now_), timeWords(*tissue)));
}

void RewindBar::askChosen() {
  keys_.stop();
  if (slider_->value() < slider_->maximum()) {
    ask(std::uint32_t(slider_->value()));
  } else {
    follow();
  }
}

void RewindBar::ask(std::uint32_t second) {
  keys_.stop();
  rewind_history_.went(now_, second);
  tissue_history_.went(now_, second);
  strokes_at_jump_ = strokes_.size();
  showMarks();
  emit rewindAsked(second);
}

void RewindBar::keyPressEvent(QKeyEvent* event) {
  if (event->key() != Qt::Key_Escape || !keys_.isActive()) return QWidget::keyPressEvent(event);
  keys_.stop();
  follow();
}

}  // namespace trephine
