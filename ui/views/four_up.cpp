#include "ui/views/four_up.h"

#include <QAbstractButton>
#include <QApplication>
#include <QHBoxLayout>
#include <QMouseEvent>
#include <QPainter>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/settings.h"

namespace trephine {

namespace {

constexpr int kGap = 2;
constexpr double kLargeShare = 0.68;  // of the width, beside three small ones
// As they are written in the settings.
constexpr std::array kKindNames{"single", "four", "oneLarge"};
constexpr std::array kViewNames{"3d", "axial", "coronal", "sagittal"};
constexpr const char* kKindKey = "views/%1/layout";
constexpr const char* kLargeKey = "views/%1/large";

template <std::size_t N>
std::optional<int> placeOf(const std::array<const char*, N>& names, const QString& name) {
  for (std::size_t i = 0; i < N; ++i) {
    if (name == names[i]) return int(i);
  }
  return {};
}

}  // namespace

FourUp::FourUp(QWidget* parent) : QWidget(parent) {
  setObjectName("views");
  setMinimumSize(320, 240);
  three_d_ = new ViewWidget(toolbox_, this);
  three_d_->setMinimumSize(60, 60);
  three_d_->setMirror(mirror_);
  three_d_->installEventFilter(this);
  setFocusProxy(three_d_);
  for (SliceAxis axis : kSliceAxes) slices_[std::size_t(axis)] = makeSlices(axis);
  bar_ = named(new SliceBar(toolbox_, this), "sliceBar");
  bar_->setAutoFillBackground(true);
  connect(bar_, &SliceBar::windowChosen, this, &FourUp::setWindow);
  connect(bar_, &SliceBar::overlayChosen, this, &FourUp::setOverlay);
  four_ = makeAction("fourViews", tr("&Four views"), Qt::Key_F6,
                     tr("Axial, coronal, sagittal and 3-D side by side"));
  one_large_ = makeAction("oneLarge", tr("One &large, three small"), Qt::Key_F7,
                          tr("One view large and three small; again: the next one large"));
  single_ =
      makeAction("oneView", tr("&One view"), Qt::Key_F8, tr("One view alone; again: the next one"));
  connect(four_, &QAction::triggered, this, [this] { choose(ViewLayout::Kind::four); });
  connect(one_large_, &QAction::triggered, this, [this] { choose(ViewLayout::Kind::one_large); });
  connect(single_, &QAction::triggered, this, [this] { choose(ViewLayout::Kind::single); });
  // Until it has painted the 3-D view cannot say whether it can.
  connect(three_d_, &ViewWidget::framePainted, this, &FourUp::restore,
          Qt::ConnectionType(Qt::QueuedConnection | Qt::SingleShotConnection));
  setWindow(colours_.window());
  setOverlay(colours_.overlay(), colours_.opacity());
  arrange();
}

QAction* FourUp::makeAction(const char* name, const QString& text, Qt::Key key,
                            const QString& tip) {
  auto* action = named(new QAction(text, this), name);
  action->setShortcut(QKeySequence(key));
  action->setToolTip(tip);
  action->setCheckable(true);
  addAction(action);
  return action;
}

FourUp::Slices FourUp::makeSlices(SliceAxis axis) {
  const char* name = kViewNames[std::size_t(axis) + 1];
  Slices made;
  made.box = new QWidget(this);
  made.box->setAutoFillBackground(true);
  made.view = named(new SliceView(axis, mirror_, colours_, toolbox_, made.box), name);
  made.view->installEventFilter(this);
  made.view->setAccessibleName(tr("%1 slices").arg(name));
  made.slider = named(new QSlider(Qt::Vertical, made.box), QString(name) + "Slider");
  made.slider->setAccessibleName(tr("%1 slice").arg(name));
  made.slider->setInvertedAppearance(axis != SliceAxis::axial);  // the head, or the front, is up
  made.slider->setPageStep(10);
  made.slider->setFocusPolicy(Qt::TabFocus);
  made.slider->setEnabled(false);
  auto* layout = tight(new QHBoxLayout(made.box), 0);
  layout->addWidget(made.view, 1);
  layout->addWidget(made.slider);
  connect(made.view, &SliceView::pointChosen, this, &FourUp::setPoint);
  connect(made.view, &SliceView::windowChosen, this, &FourUp::setWindow);
  connect(made.view, &SliceView::overlayWanted, this, [this] {
    const int kinds = mirror_->labels() ? 3 : 2;
    setOverlay(Overlay((int(colours_.overlay()) + 1) % kinds), colours_.opacity());
  });
  connect(made.view, &SliceView::workspaceMoved, this, &FourUp::workspaceMoved);
  connect(made.view, &SliceView::enlargeWanted, this, [this, axis] { enlarge(int(axis) + 1); });
  connect(made.view, &SliceView::sliceShown, made.slider, [slider = made.slider](int k) {
    const QSignalBlocker quiet(slider);
    slider->setValue(k);
  });
  connect(made.slider, &QSlider::valueChanged, made.view, &SliceView::setSlice);
  connect(made.view, &SliceView::focused, this, [this] { emit helpChanged(sliceHelp()); });
  return made;
}

QString FourUp::sliceHelp() {
  return tr(
      "Wheel: slices. Drag: window. Shift: point. Middle: shift. Right: zoom. "
      "1\u20135: presets. M: ruler. N: angle. O: colours. G: grow. B: brush. I: entry.");
}

QList<QPair<QString, QString>> FourUp::helpOfViews() {
  return {{tr("In a slice"), sliceHelp()},
          {tr("In the 3-D view"),
           tr("Drag: turn. Middle drag: shift. Wheel: zoom. Arrow keys: turn. Home: all of the "
              "patient. Shift and a letter: from a side. V: shown, ghosted, hidden.")}};
}

QWidget* FourUp::box(int view) const {
  return view == 0 ? static_cast<QWidget*>(three_d_) : slices_[std::size_t(view - 1)].box;
}

// --- The case ---

void FourUp::showVolume(Volume copy, const std::shared_ptr<const LabelMap>& labels,
                        const std::shared_ptr<const Volume>& whole) {
  const bool same_place = copy.geometry == mirror_->volume().geometry;
  for (const Slices& of : slices_) of.view->clearMeasures();  // they were of the one before
  mirror_->show(std::move(copy), labels, whole);
  changed();
  for (const Slices& of : slices_) {
    const QSignalBlocker quiet(of.slider);
    of.slider->setRange(0, std::max(0, of.view->slices() - 1));
    of.slider->setEnabled(of.view->slices() > 1);
  }
  setPoint(same_place || mirror_->empty() ? point_mm_ : mirror_->volume().geometry.centre_mm());
}

QStringList FourUp::measureWords() const {
  QStringList words;
  for (SliceAxis axis : kSliceAxes) {
    const SliceView& view = *slices_[std::size_t(axis)].view;
    for (const Measure& measure : view.measures()) {
      const int slice = int(std::lround(toVoxel(view.stack(), measure.points_mm.front()).z)) + 1;
      const QString what = measure.kind == Measure::Kind::angle ? tr("Angle") : tr("Ruler");
      words << tr("%1 %2, %3 %4").arg(what, valueOf(measure), nameOf(axis)).arg(slice);
    }
  }
  return words;
}

void FourUp::refill(const std::shared_ptr<const Volume>& whole,
                    const std::shared_ptr<const LabelMap>& labels) {
  mirror_->refill(slabsOf(*whole), labels, whole);
  changed();
}

void FourUp::showLabels(const std::shared_ptr<const LabelMap>& labels) {
  mirror_->setLabels(labels);
  three_d_->takeChanges();
  bar_->setLabelsAtHand(labels != nullptr);
  colours_.setStructures(labels.get());
  for (const Slices& of : slices_) of.view->coloursChanged();
}

void FourUp::labelsChanged(const VoxelBox& box) {
  mirror_->labelsChanged(box);
  three_d_->takeChanges();
  for (const Slices& of : slices_) of.view->labelsChanged(box);
}

void FourUp::changed() {
  colours_.setStructures(mirror_->labels().get());
  bar_->setLabelsAtHand(mirror_->labels() != nullptr);
  three_d_->takeChanges();
  for (const Slices& of : slices_) of.view->takeChanges();
}

void FourUp::setTissues(const TissueSet& tissues, const TissueLooks& looks) {
  colours_.setTissues(tissues, looks);
  for (const Slices& of : slices_) of.view->coloursChanged();
}

void FourUp::setMark(const std::optional<SliceColours::Mark>& mark) {
  colours_.setMark(mark);
  for (const Slices& of : slices_) of.view->coloursChanged();
}

void FourUp::setPoint(const Vec3& patient_mm) {
  if (mirror_->empty() || !isFinite(patient_mm)) return;
  const GridGeometry& g = mirror_->volume().geometry;
  Vec3 voxel = toVoxel(g, patient_mm);
  for (int axis = 0; axis < 3; ++axis) {
    voxel[axis] = std::clamp(voxel[axis], 0.0, g.size[std::size_t(axis)] - 1.0);
  }
  point_mm_ = g.toPatient_mm(voxel);
  for (const Slices& of : slices_) of.view->setPoint(point_mm_);
}

void FourUp::setWindow(const HuWindow& window) {
  colours_.setWindow(window);
  bar_->showWindow(colours_.window());
  for (const Slices& of : slices_) of.view->coloursChanged();
}

void FourUp::setWorkspaces(const std::vector<WorkspaceBox>& boxes) {
  for (const Slices& of : slices_) of.view->setWorkspaces(boxes);
  three_d_->setWorkspaces(boxes);
}

void FourUp::setOverlay(Overlay overlay, double opacity) {
  colours_.setOverlay(overlay, opacity);
  bar_->showOverlay(overlay, colours_.opacity());
  for (const Slices& of : slices_) of.view->coloursChanged();
}

// --- The layout ---

void FourUp::setLayout(const ViewLayout& layout) {
  restored_ = true;
  if (layout.kind != ViewLayout::Kind::single) before_ = layout;
  layout_ = layout;
  arrange();
}

void FourUp::useLayoutOf(const char* workspace, const ViewLayout& fallback) {
  workspace_ = workspace;
  fallback_ = fallback;
  if (std::exchange(layout_used_, true)) restored_ = false;  // the first may have been set already
  if (painted_) restore();
}

void FourUp::restore() {
  painted_ = true;
  if (restored_) return;
  const QSettings settings = windowSettings();
  const auto chosen = [&](const char* key) {
    return settings.value(QString(key).arg(workspace_)).toString();
  };
  const std::optional<int> kind = placeOf(kKindNames, chosen(kKindKey));
  const std::optional<int> large = placeOf(kViewNames, chosen(kLargeKey));
  setLayout(kind ? ViewLayout{ViewLayout::Kind(*kind), large.value_or(0)} : fallback_);
}

void FourUp::choose(const ViewLayout& layout) {
  setLayout(layout);
  QSettings settings = windowSettings();
  settings.setValue(QString(kKindKey).arg(workspace_), kKindNames[std::size_t(layout.kind)]);
  settings.setValue(QString(kLargeKey).arg(workspace_), kViewNames[std::size_t(layout.large)]);
  focusLarge();
}

// By key or menu: again, the next view is the large one.
void FourUp::choose(ViewLayout::Kind kind) {
  ViewLayout next{kind, layout_.large};
  if (kind == layout_.kind && kind != ViewLayout::Kind::four) {
    next.large = (layout_.large + 1) % kViews;
  } else {
    for (int view = 1; view < kViews; ++view) {
      if (slices_[std::size_t(view - 1)].view->hasFocus()) next.large = view;
    }
    if (three_d_->hasFocus()) next.large = 0;
  }
  choose(next);
}

// By double click: alone, or back to what was before.
void FourUp::enlarge(int view) {
  choose(layout_.kind == ViewLayout::Kind::single ? before_
                                                  : ViewLayout{ViewLayout::Kind::single, view});
}

void FourUp::focusLarge() {
  if (layout_.large == 0) {
    three_d_->setFocus();
  } else {
    slices_[std::size_t(layout_.large - 1)].view->setFocus();
  }
}

void FourUp::arrange() {
  if (still_ > 0) return;
  using Kind = ViewLayout::Kind;
  four_->setChecked(layout_.kind == Kind::four);
  one_large_->setChecked(layout_.kind == Kind::one_large);
  single_->setChecked(layout_.kind == Kind::single);
  const bool slices = layout_.kind != Kind::single || layout_.large != 0;
  bar_->setVisible(slices);
  QRect room = rect();
  if (slices) {
    const int tall = bar_->sizeHint().height();
    bar_->setGeometry(room.left(), room.top(), room.width(), tall);
    room.setTop(room.top() + tall);
  }
  std::array<QRect, kViews> places;
  if (layout_.kind == Kind::single) {
    places[std::size_t(layout_.large)] = room;
  } else if (layout_.kind == Kind::four) {
    const int left = (room.width() - kGap) / 2, top = (room.height() - kGap) / 2;
    const QRect first(room.topLeft(), QSize(left, top));
    const int right = room.width() - left - kGap, low = room.height() - top - kGap;
    const QPoint x(left + kGap, 0), y(0, top + kGap);
    places[1] = first;
    places[0] = {first.topLeft() + x, QSize(right, top)};
    places[2] = {first.topLeft() + y, QSize(left, low)};
    places[3] = {first.topLeft() + x + y, QSize(right, low)};
  } else {
    const int left = int(kLargeShare * room.width());
    places[std::size_t(layout_.large)] = {room.topLeft(), QSize(left, room.height())};
    int row = 0;
    for (int view : {1, 2, 3, 0}) {
      if (view == layout_.large) continue;
      const int from = room.height() * row / 3, to = room.height() * (row + 1) / 3;
      places[std::size_t(view)] = {room.left() + left + kGap, room.top() + from,
                                   room.width() - left - kGap, to - from - (row < 2 ? kGap : 0)};
      ++row;
    }
  }
  for (int view = 0; view < kViews; ++view) {
    const QRect& place = places[std::size_t(view)];
    if (!place.isEmpty()) box(view)->setGeometry(place);
    box(view)->setVisible(!place.isEmpty());
  }
}

void FourUp::paintEvent(QPaintEvent*) {
  QPainter(this).fillRect(rect(), colours::kLine);
}

// A view has the keys once the pointer is over it, unless a hand has them or they are being typed:
// a click that gave them to a slice would paint in it.
void FourUp::takeKeys(QWidget* view) {
  QWidget* has = QApplication::focusWidget();
  const bool of_views = has && (has == three_d_ || qobject_cast<SliceView*>(has));
  if (training_ || !(of_views || !has || qobject_cast<QAbstractButton*>(has))) return;
  view->setFocus(Qt::MouseFocusReason);
}

bool FourUp::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Enter && watched->isWidgetType()) {
    takeKeys(static_cast<QWidget*>(watched));
  }
  if (watched == three_d_ && event->type() == QEvent::FocusIn) emit helpChanged({});
  if (watched == three_d_ && event->type() == QEvent::MouseButtonDblClick && !training_ &&
      !toolbox_.inHand().worksIn3D() &&
      static_cast<QMouseEvent*>(event)->button() == Qt::LeftButton) {
    enlarge(0);
    return true;
  }
  return QWidget::eventFilter(watched, event);
}

}  // namespace trephine
