#include "ui/views/slice_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ui/common/colours.h"
#include "ui/common/words.h"
#include "ui/views/steps.h"

namespace trephine {

namespace {
constexpr int kLine_pixels = 2;       // what a line may cover beside its pixel
constexpr double kGrab_pixels = 4.0;  // so near to a line a press takes hold of it
constexpr double kAtMeasure_pixels = 12.0;  // so near to a measure it is the one that is meant
}  // namespace

SliceView::SliceView(SliceAxis axis, std::shared_ptr<VolumeMirror> mirror,
                     const SliceColours& colours, Toolbox& tools, QWidget* parent)
    : SlicePane(parent),
      axis_(axis),
      mirror_(mirror),
      news_(mirror),
      colours_(colours),
      toolbox_(tools) {
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setMinimumSize(60, 60);
  setMessage(tr("No case is open."));
  connect(&toolbox_, &Toolbox::taken, this, [this] {
    showCursor(pointer_.value_or(QPointF(-1.0, -1.0)));
    update();
  });
  connect(&toolbox_, &Toolbox::changed, this, qOverload<>(&SliceView::update));
}

void SliceView::takeChanges() {
  const VolumeMirror::News news = news_.take();
  if (news.all) {
    const GridGeometry before = stack_;
    stack_ = mirror_->empty() ? GridGeometry{} : sliceStack(grid(), axis_);
    if (!(stack_ == before)) {
      measures_.clear();
      (void)toolbox_.inHand().giveUp();
      fit();
    }
    setShape({stack_.size[0], stack_.size[1]}, {stack_.spacing_mm.x, stack_.spacing_mm.y});
    setEdges({{stack_.direction[0], stack_.direction[1]}});
    slice_ = std::clamp(slice_, 0, std::max(0, slices() - 1));
    stale_ = true;
  }
  for (const VoxelBox& box : news.boxes) stale_ = stale_ || touches(stack_, slice_, grid(), box);
  if (stale_) update();
}

void SliceView::coloursChanged() {
  stale_ = true;
  update();
}

// Where the slice stays only the lines of the other views move.
void SliceView::setPoint(const Vec3& patient_mm) {
  const QPointF before = fromPatient(point_mm_);
  point_mm_ = patient_mm;
  if (!hasSlice()) return;
  const int k = std::clamp(int(std::lround(toVoxel(stack_, patient_mm).z)), 0, slices() - 1);
  if (k != slice_) {
    slice_ = k;
    stale_ = true;
    update();
  }
  for (const QPointF& at : {before, fromPatient(point_mm_)}) {
    const QPoint pixel = at.toPoint();
    update(0, pixel.y() - kLine_pixels, width(), 2 * kLine_pixels + 1);
    update(pixel.x() - kLine_pixels, 0, 2 * kLine_pixels + 1, height());
  }
  emit sliceShown(slice_);
}

void SliceView::setSlice(int k) {
  if (!hasSlice()) return;
  Vec3 at = toVoxel(stack_, point_mm_);
  at.z = std::clamp(k, 0, slices() - 1);
  emit pointChosen(stack_.toPatient_mm(at));
}

void SliceView::setTools(const std::vector<ToolView>& tools) {
  const QRect before = toolsRect(shown(), tools_);
  tools_ = tools;
  update(before | toolsRect(shown(), tools_));
}

Vec3 SliceView::toPatient_mm(const QPointF& in_widget) const {
  const QPointF at = toSlice(in_widget);
  return stack_.toPatient_mm(Vec3(at.x() - 0.5, at.y() - 0.5, slice_));
}

QString SliceView::readout() const {
  if (!pointer_ || !hasSlice()) return {};
  const Volume& volume = mirror_->volume();
  const std::optional<Index3> voxel = voxelAt(volume.geometry, toPatient_mm(*pointer_));
  if (!voxel) return {};
  const std::size_t index = volume.geometry.indexOf((*voxel)[0], (*voxel)[1], (*voxel)[2]);
  const std::int16_t hu = volume.hu[index];
  const std::uint8_t label = mirror_->labels() ? mirror_->labels()->labels[index] : 0;
  QString words = tr("%1 HU").arg(hu);
  if (label != 0) {
    const Structure* of = mirror_->labels()->find(label);
    words += " \u00b7 " + (of ? toQt(of->name) : tr("label %1").arg(label));
  }
  if (const int tissue = colours_.classOf(hu, label); tissue >= 0) {
    const QString name = toQt(colours_.tissues().tissues[std::size_t(tissue)].name);
    words += " \u00b7 " + (label != 0 ? tr("felt as %1").arg(name) : name);
  }
  return words;
}

// Only what can be seen is drawn, and only when it changed.
void SliceView::paintSlice(QPainter& painter) {
  const QRectF seen(toSlice({0.0, 0.0}), toSlice({double(width()), double(height())}));
  const QRect part = seen.toAlignedRect().adjusted(-1, -1, 1, 1) & QRect(QPoint(0, 0), shape());
  if (part.isEmpty()) return;
  if (stale_ || part != part_) {
    drawSlice(mirror_->volume(), mirror_->labels().get(), stack_, slice_, part, colours_, image_);
    part_ = part;
    stale_ = false;
    ++drawn_;
  }
  const QRectF into(toWidget(part.topLeft()),
                    toWidget(QPointF(part.left() + part.width(), part.top() + part.height())));
  painter.drawImage(into, image_);
}

void SliceView::paintOver(QPainter& painter) {
  const ShownSlice on = shown();
  paintCross(painter, on, point_mm_);
  painter.setRenderHint(QPainter::Antialiasing);
  paintTools(painter, on, tools_);
  for (const Measure& measure : measures_) {
    if (on.holds(measure)) paintMeasure(painter, on, measure);
  }
  paintWorkspaces(painter, on, workspaces_);
  toolbox_.inHand().paint(painter, *this);
  paintFacts(painter, on, colours_.window(), readout());
  if (hasFocus()) {
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setBrush(Qt::NoBrush);
    painter.setPen(colours::kAccent);
    painter.drawRect(rect().adjusted(0, 0, -1, -1));
  }
}

// --- Mouse and keys ---

Vec3 SliceView::nearestInSlice_mm(const Vec3& patient_mm) const {
  const Vec3 at = toVoxel(stack_, patient_mm);
  return stack_.toPatient_mm(Vec3(std::clamp(at.x, 0.0, stack_.size[0] - 1.0),
                                  std::clamp(at.y, 0.0, stack_.size[1] - 1.0), slice_));
}

SliceView::Lines SliceView::linesAt(const QPointF& in_widget) const {
  if (!hasSlice() || !toolbox_.isEmptyHanded() || !target().contains(in_widget)) return {};
  const QPointF off = in_widget - fromPatient(point_mm_);
  return {std::abs(off.y()) <= kGrab_pixels, std::abs(off.x()) <= kGrab_pixels};
}

// By as much as the pointer moved, so that taking hold of a line moves nothing.
void SliceView::dragLines(const QPointF& moved) {
  const QPointF by = toSlice(moved) - toSlice({0.0, 0.0});
  Vec3 at = toVoxel(stack_, point_before_mm_);
  if (held_.down) at.x = std::clamp(at.x + by.x(), 0.0, stack_.size[0] - 1.0);
  if (held_.across) at.y = std::clamp(at.y + by.y(), 0.0, stack_.size[1] - 1.0);
  emit pointChosen(stack_.toPatient_mm(at));
}

void SliceView::setWorkspaces(const std::vector<WorkspaceBox>& boxes) {
  if (boxes == workspaces_) return;
  workspaces_ = boxes;
  update();
}

void SliceView::showCursor(const QPointF& in_widget) {
  if (drag_ == Drag::workspace ||
      (drag_ == Drag::none && workspaceAt(in_widget, shown(), workspaces_))) {
    return setCursor(Qt::SizeAllCursor);
  }
  const Lines lines = drag_ == Drag::lines ? held_ : linesAt(in_widget);
  if (!lines) {
    setCursor(toolbox_.inHand().cursor());
  } else {
    setCursor(!lines.down     ? Qt::SplitVCursor
              : !lines.across ? Qt::SplitHCursor
                              : Qt::SizeAllCursor);
  }
}

ToolEvent SliceView::eventAt(const QPointF& in_widget) {
  ToolEvent event;
  event.at_mm = event.inside_mm = toPatient_mm(in_widget);
  event.across = gridAxis();
  event.in_widget = in_widget;
  event.in_picture = target().contains(in_widget);
  event.slice = this;
  return event;
}

void SliceView::mousePressEvent(QMouseEvent* event) {
  SlicePane::mousePressEvent(event);
  event->accept();
  pointer_ = pressed_ = event->position();
  if (!hasSlice() || event->button() != Qt::LeftButton) return;
  ViewTool& tool = event->modifiers() & Qt::ShiftModifier ? toolbox_.point() : toolbox_.inHand();
  const bool points = &tool == &toolbox_.point();
  const WorkspaceBox* box = points ? nullptr : workspaceAt(pressed_, shown(), workspaces_);
  if (box) {
    drag_ = Drag::workspace;
    workspace_before_mm_ = box->centre_mm;
  } else if (const Lines lines = points ? Lines{} : linesAt(pressed_)) {
    drag_ = Drag::lines;
    held_ = lines;
    point_before_mm_ = point_mm_;
  } else {
    used_ = &tool;
    tool.press(eventAt(pressed_));
    update();
  }
}

void SliceView::mouseMoveEvent(QMouseEvent* event) {
  pointer_ = event->position();
  if (!(event->buttons() & Qt::LeftButton)) {
    drag_ = Drag::none;
    if (used_ && !used_->giveUp()) used_->release(eventAt(*pointer_));  // the release was not ours
    used_ = nullptr;
  }
  if (drag_ == Drag::workspace) {
    emit workspaceMoved(draggedWorkspace(*pointer_), false);
  } else if (drag_ == Drag::lines) {
    if (const QPointF moved = *pointer_ - pressed_; !moved.isNull()) dragLines(moved);
  } else if (used_) {
    used_->move(eventAt(*pointer_));
  } else {
    if (hasSlice()) toolbox_.inHand().hover(eventAt(*pointer_));
    SlicePane::mouseMoveEvent(event);
  }
  event->accept();
  if (!event->buttons() || drag_ == Drag::lines) showCursor(*pointer_);
  const int words = 3 * fontMetrics().height() + 14;  // where HU and tissue are written
  toolbox_.isEmptyHanded() ? update(0, height() - words, width(), words) : update();
}

void SliceView::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  if (std::exchange(drag_, Drag::none) == Drag::workspace) {
    emit workspaceMoved(draggedWorkspace(event->position()), true);
  }
  if (ViewTool* tool = std::exchange(used_, nullptr)) {
    tool->release(eventAt(event->position()));
    update();
  }
}

void SliceView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (toolbox_.inHand().takesDoubleClicks() || event->button() != Qt::LeftButton) {
    return mousePressEvent(event);
  }
  emit enlargeWanted();
}

void SliceView::wheelEvent(QWheelEvent* event) {
  if (event->modifiers() & Qt::ControlModifier) return SlicePane::wheelEvent(event);
  const QPoint angle = event->angleDelta();
  turned_ += angle.y() != 0 ? angle.y() : angle.x();
  const int notches = turned_ / QWheelEvent::DefaultDeltasPerStep;
  turned_ -= notches * QWheelEvent::DefaultDeltasPerStep;  // a touchpad sends parts of a notch
  if (notches != 0) setSlice(slice_ - notches);
  event->accept();
}

bool SliceView::handleKey(int key) {
  if (toolbox_.useKey(key, &point_mm_) || toolbox_.takeByKey(key)) return true;
  const auto is = [key](auto... any) { return ((key == any) || ...); };
  const int by = is(Qt::Key_Up, Qt::Key_Right)    ? 1
                 : is(Qt::Key_Down, Qt::Key_Left) ? -1
                 : is(Qt::Key_PageUp)             ? kPageOfSlices
                 : is(Qt::Key_PageDown)           ? -kPageOfSlices
                                                  : 0;
  if (by != 0 || is(Qt::Key_Home, Qt::Key_End)) {
    setSlice(is(Qt::Key_Home) ? 0 : is(Qt::Key_End) ? slices() - 1 : slice_ + by);
    return true;
  }
  if (is(Qt::Key_O)) {
    emit overlayWanted();
    return true;
  }
  if (is(Qt::Key_Delete, Qt::Key_Backspace)) {
    // The one at the pointer, else the last.
    const ShownSlice on = shown();
    auto gone = measures_.end(), last = measures_.end();
    double nearest = kAtMeasure_pixels;
    for (auto of = measures_.begin(); of != measures_.end(); ++of) {
      if (!on.holds(*of)) continue;
      last = of;
      const double away = pointer_ ? pixelsFrom(on, *of, *pointer_) : nearest;
      if (away >= nearest) continue;
      nearest = away;
      gone = of;
    }
    if (gone == measures_.end()) gone = last;
    if (gone != measures_.end()) measures_.erase(gone);
    update();
    return true;
  }
  if (key >= Qt::Key_1 && key < Qt::Key_1 + int(kWindowPresets.size())) {
    emit windowChosen(kWindowPresets[std::size_t(key - Qt::Key_1)].window);
    return true;
  }
  return zoomKey(key) || toolbox_.other_keys(key);
}

// A key that is this view's is no shortcut of the window's meanwhile: Home, for one.
bool SliceView::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    auto* key = static_cast<QKeyEvent*>(event);
    const bool plain = !(key->modifiers() & (Qt::ControlModifier | Qt::AltModifier));
    if (plain && key->key() != Qt::Key_Escape && key->key() < Qt::Key_F1) {
      event->accept();
      return true;
    }
  }
  return SlicePane::event(event);
}

void SliceView::keyPressEvent(QKeyEvent* event) {
  // Letters with Shift are the 3-D view's.
  const bool letter = event->key() >= Qt::Key_A && event->key() <= Qt::Key_Z;
  const bool plain = !(event->modifiers() & (Qt::ControlModifier | Qt::AltModifier)) &&
                     !(letter && (event->modifiers() & Qt::ShiftModifier));
  if (!hasSlice() || !plain || !handleKey(event->key())) SlicePane::keyPressEvent(event);
}

void SliceView::leaveEvent(QEvent*) {
  if (!used_) pointer_.reset();
  update();
}

void SliceView::focusInEvent(QFocusEvent*) {
  update();
  emit focused();
}

void SliceView::focusOutEvent(QFocusEvent* event) {
  // What was begun here is not what is wanted next; another program's window is no next.
  const Qt::FocusReason why = event->reason();
  if (why != Qt::ActiveWindowFocusReason && why != Qt::PopupFocusReason && !used_) {
    (void)toolbox_.inHand().giveUp();
  }
  update();
}

}  // namespace trephine
