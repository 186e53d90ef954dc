#include "ui/train/hand_bar.h"

#include <QCoreApplication>
#include <algorithm>

#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/words.h"
#include "ui/train/arms_panel.h"

namespace trephine {

namespace {
constexpr int kWidest = 460, kNarrowestForceBar = 60;
}  // namespace

HandBar::HandBar(QWidget& over) : FloatingCard(over, At::bottom, kWidest) {
  setObjectName("handBar");
  setAttribute(Qt::WA_TransparentForMouseEvents);
  hand_ = named(new QLabel, "activeHand", {"large"});
  tool_ = named(new QLabel, "handTool");
  touches_ = named(new QLabel, "handTouches");
  waits_ = wrapped(named(new QLabel(toolWaitsWords()), "handToolWaits"));
  waits_->setAlignment(Qt::AlignCenter);
  colours::setText(*waits_, colours::kCaution);
  bar_ = named(new ForceBar, "pushBar");
  push_ = named(new QLabel, "pushWords", {"large"});
  bar_->setMinimumWidth(kNarrowestForceBar);
  auto* held = new QHBoxLayout;
  auto* pushed = new QHBoxLayout;
  lines_ = new QBoxLayout(QBoxLayout::LeftToRight);
  for (QBoxLayout* line : std::initializer_list<QBoxLayout*>{held, pushed, lines_}) {
    line->setSpacing(10);
  }
  held->addWidget(hand_);
  held->addWidget(tool_, 1);
  held->addWidget(touches_);
  pushed->addWidget(bar_, 1);
  pushed->addWidget(push_);
  lines_->addLayout(held);
  lines_->addLayout(pushed, 1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(12, 6, 12, 6);
  layout->addLayout(lines_);
  layout->addWidget(waits_);
}

void HandBar::setTissues(const TissueSet& tissues) {
  int widest = 0;  // or the bar beside it would jump with every tissue
  for (const Tissue& tissue : tissues.tissues) {
    const QString words = tr("touches %1").arg(toQt(tissue.name));
    widest = std::max(widest, touches_->fontMetrics().horizontalAdvance(words));
  }
  touches_->setMinimumWidth(widest);
}

void HandBar::showHand(const QString& hand, const QColor& colour, const QString& tool, bool waits,
                       double push_N, double most_N, const QString& touches, bool at_edge) {
  hand_->setText(hand);
  colours::setText(*hand_, colour);
  tool_->setText(tool);
  waits_->setVisible(waits);
  touches_->setText(touches.isEmpty() ? tr("touches nothing") : tr("touches %1").arg(touches));
  colours::setText(*touches_, touches.isEmpty() ? colours::kQuiet : colours::kText);
  bar_->setForce(push_N, 0.0, most_N);
  // The hand's, where tissue answers it: what its arm sends is beside the arm's own bar.
  push_->setText(at_edge             ? tr("the arm reaches no further")
                 : push_N > 0.0      ? tr("presses up to %1 N").arg(push_N, 0, 'f', 1)
                 : touches.isEmpty() ? tr("hovers")
                                     : tr("rests"));
  colours::setText(*push_, at_edge ? colours::kCaution : colours::kText);
  push_->setMinimumWidth(
      push_->fontMetrics().horizontalAdvance(tr("presses up to %1 N").arg("0.0")));
  show();
  place();
}

void HandBar::fit(int width, int) {
  const auto fits = [&] {  // or it knows the width that it had
    for (int i = 0; i < lines_->count(); ++i) lines_->itemAt(i)->invalidate();
    layout()->invalidate();
    return layout()->totalMinimumSize().width() <= width;
  };
  // The last to stay is how hard it presses: its arm's card has the rest.
  const std::initializer_list<QWidget*> goes{touches_, tool_, bar_};
  for (QWidget* part : goes) part->show();
  lines_->setDirection(QBoxLayout::LeftToRight);
  lines_->setSpacing(10);
  if (fits()) return;
  lines_->setDirection(QBoxLayout::TopToBottom);
  lines_->setSpacing(4);
  for (QWidget* part : goes) {
    if (fits()) return;
    part->hide();
  }
}

QString handName(const ExerciseArm& arm) {
  if (arm.name == "left") return QCoreApplication::translate("trephine", "Left hand");
  if (arm.name == "right") return QCoreApplication::translate("trephine", "Right hand");
  return toQt(arm.name);
}

}  // namespace trephine
