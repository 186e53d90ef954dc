#include "ui/views/view_strip.h"

#include <QGridLayout>
#include <QToolButton>

namespace trephine {

namespace {
constexpr int kMargin = 8;
constexpr double kPlaneStep_mm = 1.0;
}  // namespace

ViewStrip::ViewStrip(QWidget* view) : QFrame(view), grid_(new QGridLayout(this)) {
  setObjectName("viewTools");
  setAutoFillBackground(true);
  grid_->setContentsMargins(3, 3, 3, 3);
  grid_->setSpacing(2);
  const struct {
    StandardView side;
    const char* name;
    Qt::Key key;
    QString letter, text;
  } sides[] = {
      {StandardView::anterior, "viewAnterior", Qt::Key_A, tr("A"), tr("From the front")},
      {StandardView::posterior, "viewPosterior", Qt::Key_P, tr("P"), tr("From behind")},
      {StandardView::left, "viewLeft", Qt::Key_L, tr("L"), tr("From the patient's left")},
      {StandardView::right, "viewRight", Qt::Key_R, tr("R"), tr("From the patient's right")},
      {StandardView::superior, "viewSuperior", Qt::Key_S, tr("S"), tr("From above")},
      {StandardView::inferior, "viewInferior", Qt::Key_I, tr("I"), tr("From below")}};
  for (const auto& side : sides) {
    QAction* action = make(side.name, side.text, side.letter, side.key,
                           tr("%1; again: all of it").arg(side.text));
    connect(action, &QAction::triggered, this, [this, at = side.side] { emit viewWanted(at); });
  }
  all_.append(nullptr);
  parallel_ = makeSwitch("viewParallel", tr("Orthographic"), tr("Ortho"), Qt::Key_O,
                         tr("Without perspective: the scale bar holds everywhere"));
  connect(parallel_, &QAction::toggled, this, &ViewStrip::parallelWanted);
  all_.append(nullptr);
  box_ = makeSwitch("cropBox", tr("Crop box"), tr("Box"), Qt::Key_B,
                    tr("Cut the picture to a box: drag its squares"));
  connect(box_, &QAction::toggled, this, &ViewStrip::boxWanted);
  plane_ = makeSwitch("clipPlane", tr("Clip plane"), tr("Plane"), Qt::Key_C,
                      tr("Cut the picture with a plane: drag its squares, or comma and period"));
  connect(plane_, &QAction::toggled, this, &ViewStrip::planeWanted);
  through_ = make("clipThroughTool", tr("Clip through the tool"), tr("At tool"), Qt::Key_T,
                  tr("The plane through the tool's tip, facing you; again: along the tool"));
  connect(through_, &QAction::triggered, this, &ViewStrip::throughToolWanted);
  light_ = makeSwitch("moveLight", tr("Move the light"), tr("Light"), Qt::SHIFT | Qt::Key_L,
                      tr("Drag to move the light"));
  connect(light_, &QAction::toggled, this, &ViewStrip::lightWanted);
  reset_ = make("resetClip", tr("Reset box, plane and light"), tr("Reset"), Qt::Key_X,
                tr("Show everything again, with the light back in its place"));
  connect(reset_, &QAction::triggered, this, &ViewStrip::resetWanted);
  for (const double way : {1.0, -1.0}) {
    auto* step = new QAction(way > 0 ? tr("Clip plane nearer") : tr("Clip plane farther"), this);
    step->setToolTip(tr("By %1 mm").arg(kPlaneStep_mm));
    step->setObjectName(way > 0 ? "planeNearer" : "planeFarther");
    step->setShortcut(way > 0 ? Qt::Key_Comma : Qt::Key_Period);
    step->setShortcutContext(Qt::WidgetShortcut);
    view->addAction(step);
    connect(step, &QAction::triggered, this, [this, way] { emit planeMoved(way * kPlaneStep_mm); });
  }
  setToolAtHand(false);
  adjustSize();
}

QAction* ViewStrip::make(const char* name, const QString& text, const QString& word,
                         const QKeySequence& key, const QString& tip) {
  auto* action = new QAction(text, this);
  action->setObjectName(name);
  action->setShortcut(key);
  action->setShortcutContext(Qt::WidgetShortcut);  // the letters belong to fields elsewhere
  action->setIconText(word);
  action->setToolTip(tr("%1 (%2)").arg(tip, key.toString(QKeySequence::NativeText)));
  parentWidget()->addAction(action);
  all_.append(action);
  auto* button = new QToolButton;
  button->setDefaultAction(action);
  button->setAutoRaise(true);
  button->setFocusPolicy(Qt::NoFocus);  // the keys stay with the view
  button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  const bool letter = word.size() == 1;
  grid_->addWidget(button, cell_ / 2, cell_ % 2, 1, letter ? 1 : 2);
  cell_ += letter ? 1 : 2;
  return action;
}

QAction* ViewStrip::makeSwitch(const char* name, const QString& text, const QString& word,
                               const QKeySequence& key, const QString& tip) {
  QAction* action = make(name, text, word, key, tip);
  action->setCheckable(true);
  return action;
}

void ViewStrip::setUsable(bool usable) {
  for (QAction* action : all_) {
    if (action && action != through_) action->setEnabled(usable);
  }
  if (!usable) through_->setEnabled(false);
}

void ViewStrip::place() {
  adjustSize();
  const QWidget* view = parentWidget();
  move(view->width() - width() - kMargin, kMargin);
  setVisible(isEnabled() && view->height() >= height() + 2 * kMargin);
}

}  // namespace trephine
