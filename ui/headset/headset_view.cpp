#include "ui/headset/headset_view.h"

#include <QTimer>
#include <algorithm>
#include <cmath>

#include "ui/common/actions.h"
#include "ui/common/settings.h"

namespace trephine {

namespace {

// The patient before the trainee, from the eyes.
constexpr double kAhead_m = 0.55, kAbove_m = -0.25;

}  // namespace

HeadsetView::HeadsetView(Bench& bench, QWidget& window)
    : QObject(&window), bench_(bench), woken_(std::make_shared<std::atomic<bool>>(false)) {
  on_ = makeAction(window, Symbol::view, "headset", tr("&Headset"), QKeySequence(Qt::Key_F9),
                   tr("The 3-D view through a head-mounted display; the exercise goes on"));
  on_->setCheckable(true);
  recentre_ = makeAction(window, Symbol::view, "headsetRecentre", tr("Put the &patient before me"),
                         QKeySequence(Qt::CTRL | Qt::Key_F9),
                         tr("Where the head looks now, at the set height and distance"));
  recentre_->setEnabled(false);
  mirror_ = makeAction(window, Symbol::view, "headsetMirror", tr("The window shows the left &eye"),
                       {}, tr("Else it keeps its own view"));
  mirror_->setCheckable(true);
  connect(on_, &QAction::toggled, this, &HeadsetView::toggle);
  connect(recentre_, &QAction::triggered, this, &HeadsetView::recentre);
  connect(mirror_, &QAction::toggled, this, [this](bool on) {
    if (!on) bench_.view().showInstead(0, 0, 0);
  });
}

HeadsetView::~HeadsetView() {
  stop();
}

void HeadsetView::toggle(bool on) {
  if (on == isOn()) return;
  on ? start() : headset_->stop();
}

void HeadsetView::start() {
  ViewWidget& view = bench_.view();
  placed_ = seen_ = flat_ = false;
  const auto wake = [this, woken = woken_] {
    if (woken->exchange(true)) return;
    QMetaObject::invokeMethod(this, &HeadsetView::serve, Qt::QueuedConnection);
  };
  Result<std::unique_ptr<Headset>> started =
      Error{"NO_OPENGL", "The 3-D view has no OpenGL yet", "", "Open a case first"};
  if (view.context()) started = Headset::start(*view.context(), HeadsetOptions{}, wake);
  if (!started) {
    on_->setChecked(false);
    return bench_.report(started.error());
  }
  headset_ = *std::move(started);
  recentre_->setEnabled(true);
  emit changed();
}

void HeadsetView::place() {
  const HeadsetState state = headset_->state();
  const ViewCamera& camera = bench_.view().camera();
  place_ = before(state.eyes_m, {camera.focus(), camera.forward(), camera.up()}, kAhead_m, kAbove_m);
  placed_ = true;
  showCards();
}

void HeadsetView::recentre() {
  if (headset_ && headset_->state().seen) place();
}

void HeadsetView::serve() {
  woken_->store(false);
  if (!headset_) return;
  if (const std::optional<HeadsetEnd> how = headset_->end()) return ended(*how);
  const HeadsetState state = headset_->state();
  sayState(state);
  if (!placed_ && state.fresh + state.repeated == 0 && state.seen) place();
  ViewWidget& view = bench_.view();
  view.withGraphics([&](SceneRenderer& renderer, unsigned int shown, int wide, int high) {
    painter_.serve(
        headset_->pictures(),
        [&](const EyeView& eye_m, unsigned int framebuffer, int width, int height) {
          renderer.paintEye(place_.toPatient_mm(eye_m), framebuffer, width, height);
        },
        {shown, wide, high});
  });
}

void HeadsetView::sayState(const HeadsetState& state) {
  if (state.seen == seen_ && state.flat == flat_) return;
  if (seen_ && !state.seen) bench_.say(tr("The headset was taken off: the exercise goes on here."));
  if (!flat_ && state.flat) {
    bench_.say(tr("The headset shows a flat screen: this computer draws %1 pairs of pictures a "
                  "second, and 45 are needed to look around.")
                   .arg(state.pairs_hz, 0, 'f', 0));
  }
  seen_ = state.seen;
  flat_ = state.flat;
  emit changed();
}

void HeadsetView::ended(const HeadsetEnd& how) {
  bench_.view().withGraphics([&](SceneRenderer&, unsigned int, int, int) {
    painter_.release(headset_->pictures());
  });
  bench_.view().showInstead(0, 0, 0);
  headset_.reset();
  recentre_->setEnabled(false);
  {
    const QSignalBlocker quiet(on_);
    on_->setChecked(false);
  }
  if (!how.why.ok()) {
    // What went away in an exercise is said beside it, and no dialog holds up the hands.
    how.again ? bench_.say(QString::fromStdString(how.why.error().sentence()))
              : bench_.report(how.why.error());
  }
  emit changed();
}

void HeadsetView::stop() {
  if (!headset_) return;
  headset_->stop();
  headset_.reset();
}

void HeadsetView::setCards(std::vector<EyeCard> cards) {
  cards_ = std::move(cards);
  if (headset_ && placed_) showCards();
}

// Beside what is looked at, facing the head as it was when the patient was placed.
void HeadsetView::showCards() {
  const ViewCamera& camera = bench_.view().camera();
  const Vec3 at_m = place_.toRoom_m(camera.focus());
  const Quat facing = place_.turn * glm::quat_cast(Mat3(camera.right(), camera.up(), -camera.forward()));
  std::vector<Card> shown;
  for (const EyeCard& each : cards_) {
    const Vec3 room_m =
        at_m + facing * Vec3(each.right_m, each.up_m, 0.0);
    Card card;
    card.name = each.name;
    card.pose_mm.position = place_.toPatient_mm(room_m);
    card.pose_mm.orientation = glm::normalize(glm::conjugate(place_.turn) * facing);
    card.width_mm = 1e3 * each.width_m / place_.scale;
    card.width = each.image.width();
    card.height = each.image.height();
    for (int row = 0; row < card.height; ++row) {
      const uchar* line = each.image.constScanLine(row);
      card.rgba.insert(card.rgba.end(), line, line + 4 * card.width);
    }
    shown.push_back(std::move(card));
  }
  bench_.view().setCards(std::move(shown));
}

QString HeadsetView::words() const {
  if (!headset_) return {};
  if (headset_->stuck_s() > 0.5) return tr("Headset: its software does not answer");
  const HeadsetState state = headset_->state();
  if (!state.seen) return tr("Headset: not worn");
  if (state.flat) return tr("Headset: flat screen");
  return tr("Headset: %1 pairs of pictures a second").arg(state.pairs_hz, 0, 'f', 0);
}

}  // namespace trephine
