#include "ui/views/slice_view.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ui/common/words.h"
#include "ui/views/steps.h"

namespace trephine {

namespace {
constexpr double kShortestDrag_pixels = 3.0;    // less is a click
constexpr double kWidthPerPixel = 0.006;        // natural logarithm
constexpr double kLevelPerPixel = 1.0 / 300.0;  // of the width
constexpr double kWidest_HU = 8000.0;
constexpr double kHighest_HU = 4000.0;
constexpr int kLine_pixels = 2;       // what a line may cover beside its pixel
constexpr double kGrab_pixels = 4.0;  // so near to a line a press takes hold of it
}  // namespace

SliceView::SliceView(SliceAxis axis, std::shared_ptr<VolumeMirror> mirror,
                     const SliceColours& colours, QWidget* parent)
    : SlicePane(parent), axis_(axis), mirror_(mirror), news_(mirror), colours_(colours) {
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setMinimumSize(60, 60);
  setMessage(tr("No case is open."));
}

void SliceView::takeChanges() {
  const VolumeMirror::News news = news_.take();
  const GridGeometry& grid = mirror_->volume().geometry;
  if (news.all) {
    const GridGeometry before = stack_;
    stack_ = mirror_->empty() ? GridGeometry{} : sliceStack(grid, axis_);
    if (!(stack_ == before)) {
      measures_.clear();
      drawing_.reset();
      fit();
    }
    setShape({stack_.size[0], stack_.size[1]}, {stack_.spacing_mm.x, stack_.spacing_mm.y});
    setEdges({{stack_.direction[0], stack_.direction[1]}});
    slice_ = std::clamp(slice_, 0, std::max(0, slices() - 1));
    stale_ = true;
  }
  for (const VoxelBox& box : news.boxes) stale_ = stale_ || touches(stack_, slice_, grid, box);
  if (stale_) update();
}

void SliceView::coloursChanged() {
  stale_ = true;
  update();
}

void SliceView::labelsChanged(const VoxelBox& box) {
  if (!hasSlice() || !touches(stack_, slice_, mirror_->volume().geometry, box)) return;
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

void SliceView::setTool(SliceTool tool) {
  tool_ = tool;
  drawing_.reset();
  showCursor(pointer_.value_or(QPointF(-1.0, -1.0)));
  update();
}

void SliceView::setTools(const std::vector<ToolView>& tools) {
  const QRect before = toolsRect();
  tools_ = tools;
  update(before | toolsRect());
}

void SliceView::setBrushRadius(double mm) {
  brush_mm_ = mm;
  if (isBrush(tool_)) update();
}

void SliceView::setBox(const std::optional<VoxelBox>& box) {
  box_ = box;
  update();
}

void SliceView::setEntry(const std::optional<Entry>& entry) {
  if (std::exchange(entry_, entry) != entry) update();
}

// Slices of a stack lie along axes of the grid.
int SliceView::gridAxis() const {
  const Mat3& grid = mirror_->volume().geometry.direction;
  int most = 0;
  for (int axis = 1; axis < 3; ++axis) {
    const auto along = [&](int a) { return std::abs(glm::dot(grid[a], stack_.direction[2])); };
    if (along(axis) > along(most)) most = axis;
  }
  return most;
}

QRect SliceView::brushRect() const {
  if (!pointer_ || !isBrush(tool_)) return {};
  const double more = brush_mm_ * pixelsPerMm() + 4.0;
  return QRectF(*pointer_, *pointer_).adjusted(-more, -more, more, more).toAlignedRect();
}

Vec3 SliceView::toPatient_mm(const QPointF& in_widget) const {
  const QPointF at = toSlice(in_widget);
  return stack_.toPatient_mm(Vec3(at.x() - 0.5, at.y() - 0.5, slice_));
}

QPointF SliceView::fromPatient(const Vec3& patient_mm) const {
  const Vec3 at = toVoxel(stack_, patient_mm);
  return toWidget({at.x + 0.5, at.y + 0.5});
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
  if (const int tissue = colours_.classOf(hu, label); tissue >= 0) {
    words += " \u00b7 " + toQt(colours_.tissues().tissues[std::size_t(tissue)].name);
  }
  if (label != 0) {
    const Structure* of = mirror_->labels()->find(label);
    words += " \u00b7 " + (of ? toQt(of->name) : tr("label %1").arg(label));
  }
  return words;
}

bool SliceView::isShown(const Measure& measure) const {
  return std::ranges::all_of(measure.points_mm, [&](const Vec3& point) {
    return std::lround(toVoxel(stack_, point).z) == slice_;
  });
}

// --- Mouse and keys ---

void SliceView::placePoint(const QPointF& in_widget) {
  const QPointF at = toSlice(in_widget);
  const Vec3 kept(std::clamp(at.x() - 0.5, 0.0, stack_.size[0] - 1.0),
                  std::clamp(at.y() - 0.5, 0.0, stack_.size[1] - 1.0), slice_);
  emit pointChosen(stack_.toPatient_mm(kept));
}

SliceView::Lines SliceView::linesAt(const QPointF& in_widget) const {
  if (!hasSlice() || tool_ != SliceTool::window || !target().contains(in_widget)) return {};
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

// The chosen one, near its middle or an edge.
const WorkspaceBox* SliceView::workspaceAt(const QPointF& in_widget) const {
  constexpr double kReach_pixels = 11.0, kEdge_pixels = 5.0;
  for (const WorkspaceBox& box : workspaces_) {
    if (!box.chosen) continue;
    const QPointF away = fromPatient(box.centre_mm) - in_widget;
    if (std::hypot(away.x(), away.y()) <= kReach_pixels) return &box;
    const std::array<Vec3, 8> corners = box.corners();
    for (const auto& [a, b] : WorkspaceBox::kEdges) {
      const QPointF from = fromPatient(corners[std::size_t(a)]);
      const QPointF along = fromPatient(corners[std::size_t(b)]) - from;
      const double squared = QPointF::dotProduct(along, along);
      if (squared < 1.0) continue;
      const double share =
          std::clamp(QPointF::dotProduct(in_widget - from, along) / squared, 0.0, 1.0);
      const QPointF off = in_widget - from - share * along;
      if (std::hypot(off.x(), off.y()) <= kEdge_pixels) return &box;
    }
  }
  return nullptr;
}

// Along the slice, as far as the pointer went.
Vec3 SliceView::draggedWorkspace(const QPointF& to) const {
  return workspace_before_mm_ + toPatient_mm(to) - toPatient_mm(pressed_);
}

void SliceView::showCursor(const QPointF& in_widget) {
  if (drag_ == Drag::workspace || (drag_ == Drag::none && workspaceAt(in_widget))) {
    return setCursor(Qt::SizeAllCursor);
  }
  const Lines lines = drag_ == Drag::lines ? held_ : linesAt(in_widget);
  if (!lines) {
    setCursor(tool_ == SliceTool::window ? Qt::ArrowCursor : Qt::CrossCursor);
  } else {
    setCursor(!lines.down     ? Qt::SplitVCursor
              : !lines.across ? Qt::SplitHCursor
                              : Qt::SizeAllCursor);
  }
}

void SliceView::addMeasurePoint(const QPointF& in_widget) {
  const Vec3 point = toPatient_mm(in_widget);
  if (!drawing_) {
    drawing_ =
        Measure{tool_ == SliceTool::ruler ? Measure::Kind::ruler : Measure::Kind::angle, {point}};
  }
  drawing_->points_mm.back() = point;
  if (drawing_->complete()) {
    measures_.push_back(*std::exchange(drawing_, {}));
  } else {
    drawing_->points_mm.push_back(point);
  }
  update();
}

void SliceView::mousePressEvent(QMouseEvent* event) {
  SlicePane::mousePressEvent(event);
  event->accept();
  pointer_ = pressed_ = event->position();
  if (!hasSlice() || event->button() != Qt::LeftButton) return;
  if ((event->modifiers() & Qt::ShiftModifier) || tool_ == SliceTool::point) {
    drag_ = Drag::point;
    placePoint(event->position());
  } else if (const WorkspaceBox* box = workspaceAt(event->position())) {
    drag_ = Drag::workspace;
    workspace_before_mm_ = box->centre_mm;
  } else if (const Lines lines = linesAt(event->position())) {
    drag_ = Drag::lines;
    held_ = lines;
    point_before_mm_ = point_mm_;
  } else if (tool_ == SliceTool::window) {
    drag_ = Drag::window;
    window_before_ = colours_.window();
  } else if (isBrush(tool_)) {
    drag_ = Drag::stroke;
    emit strokeBegan(toPatient_mm(event->position()), gridAxis());
  } else if (tool_ == SliceTool::grow || tool_ == SliceTool::entry) {
    if (target().contains(event->position())) {
      drag_ = tool_ == SliceTool::grow ? Drag::box : Drag::entry;
    }
  } else if (isForStructures(tool_) || tool_ == SliceTool::outline) {
    if (target().contains(event->position())) {
      emit structureClicked(tool_, toPatient_mm(event->position()));
    }
  } else {
    if (tool_ == SliceTool::ruler) drag_ = Drag::ruler;
    addMeasurePoint(event->position());
  }
}

void SliceView::mouseMoveEvent(QMouseEvent* event) {
  const QRect ring = brushRect();
  pointer_ = event->position();
  if (isBrush(tool_)) update(ring | brushRect());
  const QPointF moved = event->position() - pressed_;
  if (!(event->buttons() & Qt::LeftButton)) {
    if (drag_ == Drag::stroke) emit strokeEnded();
    drag_ = Drag::none;
  }
  if (drag_ == Drag::box || drag_ == Drag::entry) update();
  if (drawing_) drawing_->points_mm.back() = toPatient_mm(event->position());
  if (drag_ == Drag::point) {
    placePoint(event->position());
  } else if (drag_ == Drag::workspace) {
    emit workspaceMoved(draggedWorkspace(event->position()), false);
  } else if (drag_ == Drag::lines) {
    if (!moved.isNull()) dragLines(moved);
  } else if (drag_ == Drag::stroke) {
    emit strokeMoved(toPatient_mm(event->position()));
  } else if (drag_ == Drag::window && !moved.isNull()) {
    const double width = window_before_.width_hu * std::exp(kWidthPerPixel * moved.x());
    const double centre =
        window_before_.centre_hu + kLevelPerPixel * moved.y() * window_before_.width_hu;
    emit windowChosen({std::round(std::clamp(centre, -kHighest_HU, kHighest_HU)),
                       std::round(std::clamp(width, 1.0, kWidest_HU))});
  } else {
    SlicePane::mouseMoveEvent(event);
  }
  event->accept();
  if (!event->buttons() || drag_ == Drag::lines) showCursor(event->position());
  const int words = 3 * fontMetrics().height() + 14;  // where HU and tissue are written
  drawing_ ? update() : update(0, height() - words, width(), words);
}

void SliceView::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return;
  if (drag_ == Drag::stroke) emit strokeEnded();
  const Vec3 from = toPatient_mm(pressed_);
  const bool click = isClick(event->position());
  const Vec3 to = click ? from : toPatient_mm(event->position());
  if (drag_ == Drag::box) {
    click ? emit structureClicked(tool_, from) : emit boxDrawn(from, to, gridAxis());
  }
  if (drag_ == Drag::entry) emit entryChosen(from, to);
  if (drag_ == Drag::workspace) emit workspaceMoved(draggedWorkspace(event->position()), true);
  if (drag_ == Drag::ruler && drawing_) {
    if (!isClick(event->position())) {
      addMeasurePoint(event->position());
    } else {
      drawing_.reset();
      update();
    }
  }
  drag_ = Drag::none;
  if (tool_ == SliceTool::grow || tool_ == SliceTool::entry) update();
}

bool SliceView::isClick(const QPointF& released) const {
  const QPointF moved = released - pressed_;
  return std::hypot(moved.x(), moved.y()) < kShortestDrag_pixels;
}

void SliceView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (tool_ == SliceTool::angle || tool_ == SliceTool::entry || isForStructures(tool_) ||
      event->button() != Qt::LeftButton) {
    return mousePressEvent(event);
  }
  drag_ = Drag::none;
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
  switch (key) {
    case Qt::Key_Up:
    case Qt::Key_Right:
      setSlice(slice_ + 1);
      break;
    case Qt::Key_Down:
    case Qt::Key_Left:
      setSlice(slice_ - 1);
      break;
    case Qt::Key_PageUp:
      setSlice(slice_ + kPageOfSlices);
      break;
    case Qt::Key_PageDown:
      setSlice(slice_ - kPageOfSlices);
      break;
    case Qt::Key_Home:
      setSlice(0);
      break;
    case Qt::Key_End:
      setSlice(slices() - 1);
      break;
    case Qt::Key_W:
      emit toolChosen(SliceTool::window);
      break;
    case Qt::Key_X:
      emit toolChosen(SliceTool::point);
      break;
    case Qt::Key_M:
      emit toolChosen(SliceTool::ruler);
      break;
    case Qt::Key_N:
      emit toolChosen(SliceTool::angle);
      break;
    case Qt::Key_O:
      emit overlayWanted();
      break;
    case Qt::Key_I:
      emit toolChosen(SliceTool::entry);
      break;
    case Qt::Key_L:
      emit toolChosen(SliceTool::wall);
      break;
    case Qt::Key_G:
      emit toolChosen(SliceTool::grow);
      break;
    case Qt::Key_B:
      emit toolChosen(SliceTool::brush);
      break;
    case Qt::Key_E:
      emit toolChosen(SliceTool::eraser);
      break;
    case Qt::Key_P:
      emit toolChosen(SliceTool::piece);
      break;
    case Qt::Key_K:
    case Qt::Key_S:
    case Qt::Key_V:
    case Qt::Key_Return:
    case Qt::Key_Enter:
      // Without a mouse: at the common point.
      if (tool_ == SliceTool::outline) {
        emit structureClicked(tool_, point_mm_);
        break;
      }
      if (tool_ == SliceTool::entry) {
        emit entryChosen(point_mm_, point_mm_);
        break;
      }
      [[fallthrough]];
    case Qt::Key_BracketLeft:
    case Qt::Key_BracketRight:
      emit structureKey(key);
      break;
    case Qt::Key_Delete:
    case Qt::Key_Backspace: {
      const auto last = std::find_if(measures_.rbegin(), measures_.rend(),
                                     [&](const Measure& m) { return isShown(m); });
      if (tool_ == SliceTool::entry) {
        emit entryLeft();
      } else if (drawing_) {
        drawing_.reset();
      } else if (last != measures_.rend()) {
        measures_.erase(std::next(last).base());
      }
      update();
      break;
    }
    case Qt::Key_Escape:
      if (drawing_ || drag_ == Drag::box || drag_ == Drag::entry) {
        drawing_.reset();
        drag_ = Drag::none;
        update();
      } else if (isForStructures(tool_)) {
        emit structureKey(key);  // what was grown goes first
      } else if (tool_ != SliceTool::window) {
        emit toolChosen(SliceTool::window);
      } else {
        return false;  // the window's: back to the hands
      }
      break;
    default:
      if (key >= Qt::Key_1 && key < Qt::Key_1 + int(kWindowPresets.size())) {
        emit windowChosen(kWindowPresets[std::size_t(key - Qt::Key_1)].window);
      } else {
        return zoomKey(key);
      }
  }
  return true;
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
  const bool plain = !(event->modifiers() & (Qt::ControlModifier | Qt::AltModifier));
  if (!hasSlice() || !plain || !handleKey(event->key())) SlicePane::keyPressEvent(event);
}

void SliceView::leaveEvent(QEvent*) {
  if (drag_ != Drag::stroke) pointer_.reset();
  update();
}

void SliceView::focusInEvent(QFocusEvent*) {
  update();
  emit focused();
}

void SliceView::focusOutEvent(QFocusEvent* event) {
  // What was begun here is not what is wanted next; another program's window is no next.
  const Qt::FocusReason why = event->reason();
  if (why != Qt::ActiveWindowFocusReason && why != Qt::PopupFocusReason) drawing_.reset();
  update();
}

}  // namespace trephine
