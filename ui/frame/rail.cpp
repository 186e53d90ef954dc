#include "ui/frame/rail.h"

#include <algorithm>

#include "ui/common/actions.h"
#include "ui/common/making.h"

namespace trephine {

namespace {
constexpr int kIcon = 24, kWidth = 66, kMargin = 4;
}  // namespace

Rail::Rail(QWidget& window) : QWidget(&window), window_(window) {
  setObjectName("rail");
  setAttribute(Qt::WA_StyledBackground);
  setFixedWidth(kWidth);
  group_ = new QActionGroup(this);
  layout_ = new QVBoxLayout(this);
  layout_->setContentsMargins(kMargin, 6, kMargin, 6);
  layout_->setSpacing(4);
  layout_->addStretch(1);
}

void Rail::add(Place place, const Workspace& workspace) {
  const int number = int(group_->actions().size()) + 1;
  QAction* action =
      makeAction(window_, workspace.symbol(), "", workspace.title(),
                 QKeySequence(Qt::CTRL | Qt::Key(int(Qt::Key_0) + number)), workspace.title());
  action->setObjectName(QStringLiteral("go%1").arg(number));
  action->setCheckable(true);
  action->setData(int(place));
  group_->addAction(action);
  auto* button = named(new QToolButton, QStringLiteral("rail%1").arg(number), {"rail"});
  button->setDefaultAction(action);
  button->setToolButtonStyle(Qt::ToolButtonTextUnderIcon);
  button->setIconSize({kIcon, kIcon});
  button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  layout_->insertWidget(number - 1, button);
  button->ensurePolished();  // with large text it is wider
  setFixedWidth(std::max(width(), button->sizeHint().width() + 2 * kMargin));
  connect(action, &QAction::triggered, this, [this, place] { emit chosen(place); });
}

void Rail::show(Place place) {
  for (QAction* action : group_->actions()) {
    if (action->data().toInt() == int(place)) action->setChecked(true);
  }
}

}  // namespace trephine
