#include "ui/train/hand_bar.h"

#include <QHBoxLayout>

#include "ui/common/colours.h"

namespace trephine {

namespace {
constexpr int kWidest = 420;
}  // namespace

HandBar::HandBar(QWidget& over) : FloatingCard(over, At::bottom, kWidest) {
  setObjectName("handBar");
  setAttribute(Qt::WA_TransparentForMouseEvents);
  hand_ = new QLabel;
  hand_->setObjectName("activeHand");
  hand_->setProperty("large", true);
  bar_ = new ForceBar;
  bar_->setObjectName("pushBar");
  push_ = new QLabel;
  push_->setObjectName("pushWords");
  push_->setProperty("large", true);
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(12, 6, 12, 6);
  layout->setSpacing(10);
  layout->addWidget(hand_);
  layout->addWidget(bar_, 1);
  layout->addWidget(push_);
}

void HandBar::showHand(const QString& hand, const QColor& colour, double push_N, double most_N) {
  hand_->setText(hand);
  colours::setText(*hand_, colour);
  bar_->setForce(push_N, 0.0, most_N);
  push_->setText(push_N > 0.0 ? tr("presses %1 N").arg(push_N, 0, 'f', 1) : tr("hovers"));
  push_->setMinimumWidth(push_->fontMetrics().horizontalAdvance(tr("presses %1 N").arg("0.0")));
  show();
  place();
}

}  // namespace trephine
