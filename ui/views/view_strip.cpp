#include "ui/views/view_strip.h"

#include <QGridLayout>
#include <QSignalBlocker>
#include <QToolButton>

#include "ui/common/making.h"
#include "ui/views/device_pixels.h"

namespace trephine {

namespace {
constexpr int kMargin = 8;
constexpr double kPlaneStep_mm = 1.0;
const Vec3 kLightColour(1.0, 0.95, 0.5);
constexpr double kReach_pixels = 11.0;  // of a handle
}  // namespace

ViewStrip::ViewStrip(SceneRenderer& renderer, QWidget* view)
    : QFrame(view), renderer_(renderer), grid_(new QGridLayout(this)) {
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
    QAction* action = make(side.name, side.text, side.letter, Qt::SHIFT | side.key,
                           tr("%1: all of the patient").arg(side.text));
    connect(action, &QAction::triggered, this, [this, at = side.side] {
      const ViewCamera::Direction from = ViewCamera::from(at);
      renderer_.showAll(from.forward, from.up, covered());
      emit changed();
    });
  }
  exercise_ = make("viewExercise", tr("As the exercise looks"), tr("Entry"), Qt::SHIFT | Qt::Key_E,
                   tr("Where the exercise looks: at its entry"));
  connect(exercise_, &QAction::triggered, this, &ViewStrip::exerciseViewWanted);
  setExerciseView(false);
  all_.append(nullptr);
  parallel_ = makeSwitch("viewParallel", tr("Orthographic"), tr("Ortho"), Qt::SHIFT | Qt::Key_O,
                         tr("Without perspective: the scale bar holds everywhere"));
  connect(parallel_, &QAction::toggled, this, [this](bool on) {
    renderer_.setParallel(on);
    emit changed();
  });
  all_.append(nullptr);
  box_ = makeSwitch("cropBox", tr("Crop box"), tr("Box"), Qt::SHIFT | Qt::Key_B,
                    tr("Cut the picture to a box: drag its squares"));
  connect(box_, &QAction::toggled, this, [this](bool on) {
    clip_.showBox(on);
    showClip();
  });
  plane_ = makeSwitch("clipPlane", tr("Clip plane"), tr("Plane"), Qt::SHIFT | Qt::Key_C,
                      tr("Cut the picture with a plane: drag its squares, or comma and period"));
  connect(plane_, &QAction::toggled, this, [this](bool on) {
    clip_.showPlane(on, renderer_.camera());
    showClip();
  });
  through_ =
      make("clipThroughTool", tr("Clip through the tool"), tr("At tool"), Qt::SHIFT | Qt::Key_T,
           tr("The plane through the tool's tip, facing you; again: along the tool"));
  connect(through_, &QAction::triggered, this, &ViewStrip::throughTool);
  light_ = makeSwitch("moveLight", tr("Move the light"), tr("Light"), Qt::SHIFT | Qt::Key_M,
                      tr("Drag to move the light"));
  connect(light_, &QAction::toggled, this, &ViewStrip::lightToggled);
  connect(make("resetClip", tr("Reset box, plane and light"), tr("Unclip"), Qt::SHIFT | Qt::Key_X,
               tr("Show everything again, with the light back in its place")),
          &QAction::triggered, this, &ViewStrip::reset);
  for (const double way : {1.0, -1.0}) {
    auto* step =
        named(new QAction(way > 0 ? tr("Clip plane nearer") : tr("Clip plane farther"), this),
              way > 0 ? "planeNearer" : "planeFarther");
    step->setToolTip(tr("By %1 mm").arg(kPlaneStep_mm));
    step->setShortcut(way > 0 ? Qt::Key_Comma : Qt::Key_Period);
    step->setShortcutContext(Qt::WidgetShortcut);
    view->addAction(step);
    connect(step, &QAction::triggered, this, [this, way] {
      if (!clip_.planeShown()) return;
      clip_.movePlane(way * kPlaneStep_mm);
      showClip();
    });
  }
  setTools({});
  adjustSize();
  hide();
}

void ViewStrip::setExerciseView(bool has) {
  exercise_->setEnabled(has);
}

QAction* ViewStrip::make(const char* name, const QString& text, const QString& word,
                         const QKeySequence& key, const QString& tip) {
  auto* action = named(new QAction(text, this), name);
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

void ViewStrip::place() {
  adjustSize();
  const QWidget* view = parentWidget();
  move(view->width() - width() - kMargin, kMargin);
  setVisible(isEnabled() && view->height() >= height() + 2 * kMargin);
}

int ViewStrip::covered() const {
  return isVisible() ? int((width() + 2 * kMargin) * devicePixelRatioF()) : 0;
}

void ViewStrip::showClip() {
  renderer_.setClip(clip_.planes());
  emit changed();
}

void ViewStrip::setVolume(const GridGeometry& geometry) {
  clip_.setVolume(geometry);
  if (!clip_.cutsAnything()) reset();
}

void ViewStrip::setTools(const std::vector<ToolView>& tools) {
  tool_mm_.reset();
  if (!tools.empty()) tool_mm_ = tools.back().pose_mm;
  through_->setEnabled(!tools.empty());
}

void ViewStrip::throughTool() {
  if (!tool_mm_) return;
  const Vec3 axis = along_tool_ ? tool_mm_->orientation * Vec3(0, 0, 1) : Vec3(0.0);
  clip_.planeThrough(tool_mm_->position, axis, renderer_.camera());
  along_tool_ = !along_tool_;
  const QSignalBlocker quiet(plane_);
  plane_->setChecked(true);
  showClip();
}

void ViewStrip::reset() {
  clip_.reset();
  along_tool_ = false;
  light_from_ = SceneRenderer::kLight;
  for (QAction* action : {box_, plane_, light_}) action->setChecked(false);
  renderer_.setLight(light_from_);
  showClip();
}

bool ViewStrip::take(const QPointF& place) {
  const QSize all = pixelsOf(*parentWidget());
  dragged_ = clip_.handleAt(pixelAt(*parentWidget(), place), renderer_.camera(), all.width(),
                            all.height(), kReach_pixels * devicePixelRatioF());
  return dragged_.has_value();
}

void ViewStrip::drag(const QPointF& moved) {
  const QSize all = pixelsOf(*parentWidget());
  const glm::dvec2 pixels = glm::dvec2(moved.x(), -moved.y()) * devicePixelRatioF();
  if (!dragged_) {
    light_from_ = draggedLight(light_from_, pixels, all.height());
    renderer_.setLight(light_from_);
    emit changed();
    return;
  }
  clip_.drag(*dragged_, pixels, renderer_.camera(), all.width(), all.height());
  for (const ClipTools::Handle& handle : clip_.handles()) {
    if (handle.grip == dragged_->grip && handle.face == dragged_->face) dragged_ = handle;
  }
  showClip();
}

void ViewStrip::addLines(ScreenLines& to) const {
  const QSize all = pixelsOf(*parentWidget());
  clip_.addLines(renderer_.camera(), all.width(), all.height(), to);
  if (!movesLight()) return;
  // On a half sphere that is seen from the eye.
  const glm::dvec2 middle(0.5 * all.width(), 0.5 * all.height());
  const glm::dvec2 at = middle + glm::dvec2(light_from_) * (0.25 * all.height());
  to.push_back({middle, at, kLightColour, 2.0});
  addSquare(at, 7.0, kLightColour, 3.0, to);
}

}  // namespace trephine
