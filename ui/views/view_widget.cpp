#include "ui/views/view_widget.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/tr.h"
#include "imaging/codes.h"
#include "render/display_probe.h"
#include "ui/common/colours.h"
#include "ui/common/event_loop.h"
#include "ui/views/device_pixels.h"
#include "ui/views/steps.h"

namespace trephine {

namespace {

constexpr int kStillAfter_ms = 120;
// What one frame may spend on rays: on those of a cut before it is shown, and between two frames on
// a finer picture. In an exercise the tools wait no longer than this.
constexpr double kCut_ms = 20.0;
constexpr double kRefine_ms = 30.0;
constexpr double kRefineInTraining_ms = 10.0;
constexpr int kNothingToRefine_ms = 40;  // while cuts follow each other too fast for full quality
constexpr double kTurn_deg_per_pixel = 0.4;
constexpr int kKeyTurn_pixels = 12;
// Movements of a tool that no picture shows.
constexpr double kToolMoved_mm = 0.02;

bool looksAlike(const ToolView& a, const ToolView& b) {
  return a.contact == b.contact && a.shape == b.shape && a.length_mm == b.length_mm &&
         a.colour == b.colour && a.radius_mm == b.radius_mm && a.head_mm == b.head_mm &&
         a.mesh_file == b.mesh_file && a.mesh_tip_mm == b.mesh_tip_mm &&
         a.mesh_axis == b.mesh_axis &&
         glm::distance(a.pose_mm.position, b.pose_mm.position) < kToolMoved_mm &&
         std::abs(glm::dot(a.pose_mm.orientation, b.pose_mm.orientation)) > 1.0 - 1e-7;
}

void addLines(const WorkspaceBox& box, const ViewCamera& camera, const QSize& all,
              ScreenLines& to) {
  const Vec3 colour = colours::rgbOf(box.colour) * (box.chosen ? 1.0 : 0.6);
  for (const auto& [a, b] : box.edges()) {
    const auto from = camera.pixelOf(a, all.width(), all.height());
    const auto end = camera.pixelOf(b, all.width(), all.height());
    if (from && end) to.push_back({*from, *end, colour, box.chosen ? 1.5 : 1.0});
  }
}

}  // namespace

ViewWidget::ViewWidget(Toolbox& toolbox, QWidget* parent)
    : OpenGlPane(wayToScreen(probedRenderer(), qEnvironmentVariable("TREPHINE_VIEW").toStdString()),
                 parent),
      hint_(new QLabel(this)),
      level_(new QLabel(this)),
      strip_(new ViewStrip(renderer_, this)),
      tool_(toolbox, renderer_, *strip_, *this) {
  setObjectName("view");
  setAccessibleName(tr("3-D view"));
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);  // a brush's ring goes with the pointer
  setMinimumSize(320, 240);
  setToolTip(QString());
  for (auto [label, name] : {std::pair(hint_, "viewHint"), {level_, "viewLevel"}}) {
    label->setObjectName(name);
    label->setAttribute(Qt::WA_TransparentForMouseEvents);
    label->setWordWrap(true);
    colours::setText(*label, colours::kOnPicture);
  }
  hint_->setAlignment(Qt::AlignCenter);
  level_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  connect(strip_, &ViewStrip::changed, this, &ViewWidget::redraw);
  connect(strip_, &ViewStrip::lightToggled, this, qOverload<>(&ViewWidget::update));
  connect(&tool_, &ToolIn3D::nothingThere, this, &ViewWidget::nothingThere);
  const auto once = [this](QTimer& timer, const char* name, void (ViewWidget::*then)()) {
    timer.setObjectName(name);
    timer.setSingleShot(true);
    connect(&timer, &QTimer::timeout, this, then);
  };
  once(still_, "still", &ViewWidget::rest);
  once(refine_, "refine", &ViewWidget::refine);
  once(warm_, "warm", &ViewWidget::warmUp);
  onEachTurn(this, [this] { worked_ = false; });
}

ViewWidget::~ViewWidget() {
  releaseGraphics();
  // The base class destroys the context, and says so, when our members are gone.
  if (context()) disconnect(context(), nullptr, this, nullptr);
}

void ViewWidget::releaseGraphics() {
  if (!context()) return;
  makeCurrent();
  renderer_.detach();
  doneCurrent();
}

void ViewWidget::initializeGL() {
  connect(context(), &QOpenGLContext::aboutToBeDestroyed, this, &ViewWidget::releaseGraphics,
          Qt::UniqueConnection);
  drawing_ = renderer_.attach({[this] { return QOpenGLContext::currentContext() == context(); },
                               [this] { makeCurrent(); }});
  fitRenderer();
  if (drawing_) {
    gl_description_ = renderer_.openGlDescription();
  } else {
    emit failed(drawing_.error());
  }
}

void ViewWidget::couldNotStart() {
  // Not while the window is laid out or painted: a dialog paints.
  QTimer::singleShot(0, this, [this] { emit failed(drawing_.error()); });
}

// The renderer counts device pixels, the widget does not.
void ViewWidget::fitRenderer() {
  renderer_.resize(pixelsOf(*this).width(), pixelsOf(*this).height());
}

void ViewWidget::resizeGL() {
  fitRenderer();
  fitHint();
  if (renderer_.hasVolume()) redraw();  // sizes follow each other like turns of the camera
  emit resized();
}

void ViewWidget::fitHint() {
  strip_->place();
  hint_->setGeometry(rect().adjusted(20, 20, -20, -20));
  // Always as large and never hidden: over a composed view, pixels that a child leaves stay.
  level_->setGeometry(10, 8, std::max(0, strip_->x() - 20), 6 * fontMetrics().height());
}

void ViewWidget::setWorkspaces(const std::vector<WorkspaceBox>& boxes) {
  if (boxes == workspaces_) return;
  workspaces_ = boxes;
  update();
}

void ViewWidget::withGraphics(const WithGraphics& work) {
  if (!context() || !drawing_) return;
  makeCurrent();
  work(renderer_, defaultFramebufferObject(), pixelsOf(*this).width(), pixelsOf(*this).height());
  doneCurrent();
}

void ViewWidget::showInstead(unsigned int texture, int wide, int high) {
  if (texture == 0 && instead_.texture == 0) return;  // else it may hold another picture now
  instead_ = {texture, wide, high};
  update();
}

// As large as it fits, in the middle.
void ViewWidget::paintInstead() {
  const int wide = pixelsOf(*this).width(), high = pixelsOf(*this).height();
  QOpenGLExtraFunctions& gl = *context()->extraFunctions();
  const double by = std::min(double(wide) / instead_.width, double(high) / instead_.height);
  const int shown_wide = int(instead_.width * by), shown_high = int(instead_.height * by);
  const int x = (wide - shown_wide) / 2, y = (high - shown_high) / 2;
  unsigned int from = 0;
  gl.glGenFramebuffers(1, &from);
  gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
  gl.glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                            instead_.texture, 0);
  gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, defaultFramebufferObject());
  gl.glDisable(GL_SCISSOR_TEST);
  gl.glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  gl.glClear(GL_COLOR_BUFFER_BIT);
  gl.glBlitFramebuffer(0, 0, instead_.width, instead_.height, x, y, x + shown_wide, y + shown_high,
                       GL_COLOR_BUFFER_BIT, GL_LINEAR);
  gl.glDeleteFramebuffers(1, &from);
  gl.glBindFramebuffer(GL_FRAMEBUFFER, defaultFramebufferObject());
}

void ViewWidget::paintGL() {
  worked_ = true;
  QElapsedTimer timer;
  timer.start();
  fitRenderer();  // the screen may have changed under the window
  if (instead_.texture != 0) {
    paintInstead();
    emit framePainted(double(timer.nsecsElapsed()) * 1e-6, false);
    return;
  }
  ScreenLines lines;
  strip_->addLines(lines);
  for (const WorkspaceBox& box : workspaces_)
    addLines(box, renderer_.camera(), pixelsOf(*this), lines);
  renderer_.setLines(lines);
  renderer_.paint(defaultFramebufferObject(), kCut_ms);
  if (!moving_ && !renderer_.complete()) refine_.start(0);
  const bool stale = renderer_.stale();  // its volume was sent, and no more
  if (renderer_.cold()) {
    if (!warm_.isActive()) warm_.start(0);
  } else if (stale) {
    QTimer::singleShot(0, this, qOverload<>(&ViewWidget::update));
  }
  emit framePainted(double(timer.nsecsElapsed()) * 1e-6, renderer_.hasVolume() && !stale);
  showLevel();
  if (const Status refused = renderer_.refusal(); !refused && !refusal_said_) {
    refusal_said_ = true;
    // Not while a frame is made: a dialog paints.
    QTimer::singleShot(0, this, [this, why = refused.error()] { emit failed(why); });
  }
}

void ViewWidget::refine() {
  if (!isVisible() || !context() || moving_) return;
  if (warm_.isActive()) return refine_.start(0);  // what is missing goes before what is coarse
  // Input is looked for after each picture and each step towards a finer one.
  if (std::exchange(worked_, true)) return refine_.start(0);
  QElapsedTimer timer;
  timer.start();
  makeCurrent();
  const bool another = renderer_.refine(training_ ? kRefineInTraining_ms : kRefine_ms);
  doneCurrent();
  if (another) {
    update();
  } else if (!renderer_.complete()) {
    refine_.start(timer.elapsed() > 0 ? 0 : kNothingToRefine_ms);
  }
}

// Each in a turn of the event loop without a picture, unless every turn has one.
void ViewWidget::warmUp() {
  if (!context()) return;
  if (std::exchange(worked_, true) && !std::exchange(put_off_, true)) return warm_.start(0);
  put_off_ = false;
  makeCurrent();
  const bool warmed = renderer_.warmUp();
  doneCurrent();
  warmed ? warm_.start(0) : update();
}

// How coarse the picture is, while it is, and the volume behind it.
void ViewWidget::showLevel() {
  const double share = renderer_.shareOfRays();
  QStringList words;
  if (share > 0.0 && share < 1.0) {
    words << tr("Coarse for the moment: 1/%1 of the rays")
                 .arg(1.0 / share, 0, 'f', share > 0.4 ? 1 : 0);
  }
  const auto [i, j, k] = renderer_.reduction();
  if (renderer_.hasVolume() && i * j * k > 1) {
    words << tr("Too large for the graphics card: shown with one voxel for %1 \u00d7 %2 \u00d7 %3")
                 .arg(i)
                 .arg(j)
                 .arg(k);
  }
  const QString text = words.join('\n');
  if (text != level_->text()) level_->setText(text);
}

void ViewWidget::redraw() {
  moving_ = true;
  renderer_.setMoving(true);
  still_.start(kStillAfter_ms);
  update();
}

void ViewWidget::rest() {
  moving_ = false;
  renderer_.setMoving(false);
  refine_.start(0);  // when nothing else is to be done
}

void ViewWidget::setMirror(std::shared_ptr<VolumeMirror> mirror) {
  tool_.setMirror(mirror);
  renderer_.setMirror(std::move(mirror));
  showNews();
}

void ViewWidget::takeChanges() {
  if (!renderer_.takeChanges()) return;
  if (renderer_.copy().geometry == shown_) return update();
  showNews();
}

void ViewWidget::showNews() {
  shown_ = renderer_.copy().geometry;
  if (renderer_.hasVolume()) {
    refusal_said_ = false;
    strip_->setVolume(shown_);
  }
  const bool flat = renderer_.hasVolume() && std::ranges::min(shown_.size) < 2;
  hint_->setText(flat ? tr("One slice has no depth.\nF6 shows it in the slices.")
                      : tr("Open a folder of CT, drop one here,\nor choose a built-in case."));
  hint_->setVisible(flat || !renderer_.hasVolume());
  strip_->setEnabled(renderer_.hasVolume());
  strip_->place();
  redraw();
}

void ViewWidget::setTissues(const TissueSet& tissues, const TissueLooks& looks) {
  tool_.setTissues(tissues, looks);
  renderer_.setTissues(tissues, looks);
  redraw();
}

void ViewWidget::lookAtLandmark(const LandmarkFrame& frame, double distance_mm) {
  renderer_.lookAt(frame.position_mm, frame.viewDirection(), frame.viewUp(), distance_mm);
  redraw();
}

void ViewWidget::lookAtAll(const std::optional<LandmarkFrame>& from) {
  fitRenderer();
  if (from) {
    renderer_.showAll(from->viewDirection(), from->viewUp(), strip_->covered());
  } else {
    const ViewCamera::Direction front = ViewCamera::from(StandardView::anterior);
    renderer_.showAll(front.forward, front.up, strip_->covered());
  }
  redraw();
}

void ViewWidget::setTools(const std::vector<ToolView>& tools) {
  bool alike = tools.size() == tools_.size();
  for (std::size_t i = 0; alike && i < tools.size(); ++i) alike = looksAlike(tools[i], tools_[i]);
  if (alike) return;
  tools_ = tools;
  strip_->setTools(tools);
  renderer_.setTools(tools);
  update();  // over the last picture of the volume
}

void ViewWidget::setTraining(bool training) {
  training_ = training;
  tool_.setTraining(training);
}

void ViewWidget::setOutline(const std::vector<Vec3>& points_mm, bool closed, double width_mm) {
  renderer_.setOutline(points_mm, closed, width_mm);
  update();
}

Result<Picture> ViewWidget::picture() {
  if (!context() || !renderer_.hasVolume()) {
    return Error{code::kNoPicture, trephine::tr("There is nothing to take a picture of"),
                 trephine::tr("3-D view"), trephine::tr("Open a case first")};
  }
  makeCurrent();
  renderer_.setLines({});  // handles are none of the picture
  Picture picture = renderer_.picture();
  doneCurrent();
  update();  // the picture was drawn with VTK's state, the window's frame is still the old one
  if (picture.rgb.empty()) {
    return Error{code::kNoPicture,
                 trephine::tr("The picture could not be read from the graphics card"),
                 trephine::tr("3-D view"), trephine::tr("Try again, or with a smaller window")};
  }
  return picture;
}

// About the middle of all that is seen while about all of it is in the picture; from near, about
// the place under the pointer, or in the middle of the picture.
Vec3 ViewWidget::turningPoint(const QPointF& place) const {
  constexpr double kNear = 0.6;  // of the radius of what is seen
  const SceneRenderer::Seen seen = renderer_.seen();
  if (renderer_.camera().halfHeight_mm() > kNear * seen.radius_mm) return seen.middle_mm;
  for (const QPointF& at : {place, QPointF(rect().center())}) {
    if (const std::optional<Picked> picked = pickAt(at)) return picked->at_mm;
  }
  return renderer_.camera().focus();
}

void ViewWidget::turn(double right_pixels, double down_pixels) {
  renderer_.orbit(-kTurn_deg_per_pixel * right_pixels, kTurn_deg_per_pixel * down_pixels,
                  turned_about_mm_);
  redraw();
}

void ViewWidget::mousePressEvent(QMouseEvent* event) {
  tool_.setPointer(event->position());
  strip_->letGo();
  if (!renderer_.hasVolume()) return;
  turned_about_mm_ = turningPoint(event->position());
  if (event->button() != Qt::LeftButton) return;
  pressed_at_.reset();
  if (strip_->take(event->position())) return;
  pressed_at_ = event->position();
  if (tool_.isDragged()) tool_.press();
}

void ViewWidget::mouseMoveEvent(QMouseEvent* event) {
  const QPointF moved = tool_.setPointer(event->position());
  const bool left = event->buttons() & Qt::LeftButton;
  if (!left) tool_.release();
  tool_.followRing();
  const bool points = event->buttons() == Qt::NoButton ||
                      (event->buttons() == Qt::LeftButton && !strip_->dragsAnything());
  if (training_ && points && renderer_.hasVolume()) return emit pointed(event->position());
  if (event->buttons() == Qt::NoButton || moved.isNull() || !renderer_.hasVolume()) return;
  if (left && strip_->dragsAnything()) {
    strip_->drag(moved);
  } else if (event->buttons() & Qt::MiddleButton) {
    renderer_.pan(moved.x() * devicePixelRatioF(), moved.y() * devicePixelRatioF());
    redraw();
  } else if (!left || !(tool_.move(moved) || tool_.isDragged())) {
    if (left && tool_.isInHand() && pressed_at_) {
      if (isClick(*pressed_at_, event->position())) return;  // so far
      pressed_at_.reset();
    }
    turn(moved.x(), moved.y());
  }
}

void ViewWidget::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) {
    const bool click = std::exchange(pressed_at_, {}).has_value();
    if (click && tool_.isInHand() && !tool_.isDragged()) tool_.press();
    tool_.release();
  }
  strip_->letGo();
}

void ViewWidget::wheelEvent(QWheelEvent* event) {
  if (!renderer_.hasVolume()) return;
  // With Shift some systems turn the wheel sideways.
  const QPoint angle = event->angleDelta();
  const double notches = double(angle.y() != 0 ? angle.y() : angle.x()) / kWheelNotch;
  if (training_ && !(event->modifiers() & Qt::ControlModifier)) {
    emit pushStepped(notches);
  } else {
    zoomAt(event->position(), std::pow(kZoomStep, notches));
    tool_.followRing();
    redraw();
  }
  event->accept();
}

// What the pointer is at stays there, about.
void ViewWidget::zoomAt(const QPointF& place, double factor) {
  const double before_mm = renderer_.camera().distance_mm();
  renderer_.zoom(factor);
  const double nearer = before_mm / renderer_.camera().distance_mm();
  const QPointF away = (place - QRectF(rect()).center()) * ((1.0 - nearer) * devicePixelRatioF());
  renderer_.pan(away.x(), away.y());
}

void ViewWidget::keyPressEvent(QKeyEvent* event) {
  const int key = event->key();
  const auto which = [key](int more, int less) { return int(key == more) - int(key == less); };
  const int right = which(Qt::Key_Right, Qt::Key_Left), up = which(Qt::Key_Up, Qt::Key_Down);
  const int deeper = which(Qt::Key_PageDown, Qt::Key_PageUp);
  if (right == 0 && up == 0 && deeper == 0) {
    // With Shift; alone it is the window's.
    if (key == Qt::Key_Home && training_) return emit toolStraightened();
    const bool plain =
        !(event->modifiers() & (Qt::ShiftModifier | Qt::ControlModifier | Qt::AltModifier));
    if (!plain || !tool_.key(key)) OpenGlPane::keyPressEvent(event);
    return;
  }
  if (!renderer_.hasVolume()) return;
  if (training_ && !(event->modifiers() & Qt::ControlModifier)) {
    if (deeper != 0) {
      emit pushStepped(deeper);
    } else if (event->modifiers() & Qt::ShiftModifier) {
      emit toolTilted(right, up);
    } else {
      emit pointerStepped(right, up);
    }
  } else if (deeper != 0) {
    renderer_.zoom(std::pow(kZoomStep, deeper));
    redraw();
  } else {
    turned_about_mm_ = turningPoint(rect().center());
    turn(right * kKeyTurn_pixels, -up * kKeyTurn_pixels);
  }
}

// The hand changes by Tab; Shift+Tab leaves the view as ever.
bool ViewWidget::focusNextPrevChild(bool next) {
  if (!training_ || !next) return OpenGlPane::focusNextPrevChild(next);
  emit otherHandWanted();
  return true;
}

}  // namespace trephine
