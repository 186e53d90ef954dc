#include "ui/train/pointer_hands.h"

#include <algorithm>
#include <cmath>

#include "ui/common/preferences.h"

namespace trephine {

namespace {

// Steps up and as many down do not come back to 0 exactly, and the tool would stay where it is.
constexpr double kLeastPush_N = 0.01;
constexpr double kTilt_rad = 0.087;  // 5 degrees a key
constexpr double kElsewhere_mm = 3.0;

}  // namespace

PointerHands::PointerHands(ViewWidget& view) : QObject(&view), view_(view) {
  connect(&view_, &ViewWidget::pointed, this, &PointerHands::point);
  connect(&view_, &ViewWidget::pointerStepped, this, &PointerHands::step);
  connect(&view_, &ViewWidget::toolTilted, this, &PointerHands::tilt);
  connect(&view_, &ViewWidget::toolStraightened, this, [this] {
    if (hasHand()) session_->straightenHand(active_);
  });
  connect(&view_, &ViewWidget::pushStepped, this, [this](double notches) {
    if (session_ && holds() && notches > 0.0) return;
    setPush(push_N() + notches * preferences().push_step_N);
  });
  connect(&view_, &ViewWidget::otherHandWanted, this, &PointerHands::takeOther);
  connect(&view_, &ViewWidget::resized, this, &PointerHands::letGo);
}

// In a pause, and clutched: what is not felt while it is set would come as a stab, and the tool, in
// tissue, would cut its way to where the pointer has been led meanwhile.
bool PointerHands::holds() {
  const LoopState state = session_->state();
  return state.paused || (state.record.arms[active_].tool_state & kToolClutched);
}

// Another place of the tissue is under the pointer, though no hand has moved: until it does, the
// tool is drawn out where it is.
void PointerHands::letGo() {
  if (!session_ || !place()) return;
  stays_ = true;
  setPush(0.0);
}

void PointerHands::begin(Session* session) {
  session_ = session;
  places_.assign(session_ ? session_->exercise().arms.size() : 1, std::nullopt);
  last_.reset();
  stays_ = false;
  active_ = 0;
  if (session_) {
    const std::string main = preferences().main_hand == MainHand::right ? "right" : "left";
    const std::vector<ExerciseArm>& arms = session_->exercise().arms;
    const auto found = std::ranges::find(arms, main, &ExerciseArm::name);
    active_ = found == arms.end() ? arms.size() - 1 : std::size_t(found - arms.begin());
    if (!hasHand()) active_ = nextSimulated();
  }
  emit changed();
}

// After the active one, which it is itself where there is no other.
std::size_t PointerHands::nextSimulated() const {
  const std::size_t count = session_->exercise().arms.size();
  for (std::size_t i = 1; i < count; ++i) {
    if (session_->isSimulated((active_ + i) % count)) return (active_ + i) % count;
  }
  return active_;
}

double PointerHands::push_N() const {
  return session_ ? session_->handPush_N(active_) : 0.0;
}

double PointerHands::mostPush_N() const {
  return session_ ? session_->mostPush_N(active_) : 0.0;
}

void PointerHands::setPush(double push_N) {
  if (!hasHand()) return;
  if (!place()) step(0, 0);  // keys alone: from the middle of the view
  const double wanted_N = push_N < kLeastPush_N ? 0.0 : std::min(push_N, mostPush_N());
  (void)session_->setPush(active_, wanted_N);
  emit changed();
}

void PointerHands::takeOther() {
  if (!hasHand() || nextSimulated() == active_) return;
  (void)session_->releaseHand(active_);
  active_ = nextSimulated();
  stays_ = true;
  emit changed();
}

void PointerHands::goneBack() {
  if (!session_) return;
  places_.assign(places_.size(), std::nullopt);
  if (last_) last_ = QRectF(view_.rect()).center();  // from where the keys go on
  stays_ = true;
  emit changed();
}

void PointerHands::point(const QPointF& to) {
  if (!hasHand()) return;
  if (place() && holds()) {
    stays_ = true;
    return;
  }
  const bool first = !taken();
  if (stays_ && place() && push_N() > 0.0) {
    const QPointF by = to - *place();
    const double apart_mm = std::hypot(by.x(), by.y()) * view_.mmPerUnitAt(to);
    if (apart_mm > kElsewhere_mm) setPush(0.0);  // or it would cut its way there
  }
  place() = last_ = to;
  stays_ = false;
  send();
  if (first) emit changed();
}

// From where the pointer was last, or from the middle: by so many steps of the keys.
void PointerHands::step(int right, int up) {
  if (!session_) return;
  const QRectF all = view_.rect();
  const QPointF from = place().value_or(last_.value_or(all.center()));
  const double pixels = preferences().key_step_mm / view_.mmPerUnitAt(from);
  const QPointF to = from + QPointF(right * pixels, -up * pixels);
  point({std::clamp(to.x(), all.left(), all.right()), std::clamp(to.y(), all.top(), all.bottom())});
}

void PointerHands::tilt(int right, int up) {
  if (!hasHand()) return;
  const ViewCamera& camera = view_.camera();
  if (right != 0) session_->turnHand(active_, camera.up(), kTilt_rad * right);
  if (up != 0) session_->turnHand(active_, camera.right(), -kTilt_rad * up);
}

void PointerHands::send() {
  if (!session_ || !place()) return;
  const std::optional<ViewCamera::Ray> ray = view_.rayAt(*place());
  if (!ray) return;
  PointerSample sample{session_->now_ns(), ray->from_mm, ray->direction, {}};
  if (const std::optional<Picked> picked = view_.pickAt(*place())) {
    sample.depth_mm = glm::dot(picked->at_mm - ray->from_mm, glm::normalize(ray->direction));
  }
  (void)session_->point(active_, sample);
}

}  // namespace trephine
