#include "ui/train/hand_bar.h"

#include <QHBoxLayout>

#include "ui/common/colours.h"
#include "ui/train/arms_panel.h"

namespace trephine {

namespace {
constexpr int kWidest = 460;
}  // namespace

HandBar::HandBar(QWidget& over) : FloatingCard(over, At::bottom, kWidest) {
  setObjectName("handBar");
  setAttribute(Qt::WA_TransparentForMouseEvents);
  hand_ = new QLabel;
  hand_->setObjectName("activeHand");
  hand_->setProperty("large", true);
  tool_ = new QLabel;
  tool_->setObjectName("handTool");
  waits_ = new QLabel(toolWaitsWords());
  waits_->setObjectName("handToolWaits");
  waits_->setWordWrap(true);
  waits_->setAlignment(Qt::AlignCenter);
  colours::setText(*waits_, colours::kCaution);
  bar_ = new ForceBar;
  bar_->setObjectName("pushBar");
  push_ = new QLabel;
  push_->setObjectName("pushWords");
  push_->setProperty("large", true);
  auto* line = new QHBoxLayout;
  line->setSpacing(10);
  line->addWidget(hand_);
  line->addWidget(tool_);
  line->addWidget(bar_, 1);
  line->addWidget(push_);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(12, 6, 12, 6);
  layout->addLayout(line);
  layout->addWidget(waits_);
}

void HandBar::showHand(const QString& hand, const QColor& colour, const QString& tool, bool waits,
                       double push_N, double most_N) {
  hand_->setText(hand);
  colours::setText(*hand_, colour);
  tool_->setText(tool);
  waits_->setVisible(waits);
  bar_->setForce(push_N, 0.0, most_N);
  push_->setText(push_N > 0.0 ? tr("presses %1 N").arg(push_N, 0, 'f', 1) : tr("hovers"));
  push_->setMinimumWidth(push_->fontMetrics().horizontalAdvance(tr("presses %1 N").arg("0.0")));
  show();
  place();
}

}  // namespace trephine
