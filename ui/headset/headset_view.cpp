#include "ui/headset/headset_view.h"

#include <algorithm>
#include <cmath>

#include "base/codes.h"
#include "base/tr.h"
#include "ui/common/actions.h"
#include "ui/common/preferences.h"
#include "ui/common/words.h"
#include "ui/work/arms_in_room.h"
#include "ui/work/arms_of_place.h"

namespace trephine {

namespace {

constexpr int kWordsEvery_ms = 1000;
constexpr double kStuck_s = 0.5;
constexpr double kMarksAhead_m = 0.45, kMarksApart_m = 0.08;

// Looks back at the eyes, upright.
Quat facing(const Vec3& from_eyes) {
  const Vec3 ahead = glm::normalize(from_eyes);
  const Vec3 right = glm::normalize(glm::cross(ahead, Vec3(0.0, 1.0, 0.0)));
  return glm::normalize(glm::quat_cast(Mat3(right, glm::cross(right, ahead), -ahead)));
}

bool isOne(double scale) {
  return std::abs(scale - 1.0) < 0.005;
}

}  // namespace

HeadsetView::HeadsetView(Workstation& workstation, Messages& messages, CaseViews& case_views)
    : QObject(messages.window()),
      workstation_(workstation),
      messages_(messages),
      case_views_(case_views) {
  forgetArmsInRoom(false);  // of a program that ended with its headset on
  QWidget& window = *messages.window();
  on_ = makeAction(window, Symbol::view, "headset", tr("&Headset"), Qt::Key_F9,
                   tr("The 3-D view through a head-mounted display; the exercise goes on"));
  on_->setCheckable(true);
  recentre_ = makeAction(window, Symbol::view, "headsetRecentre", tr("Put the &patient before me"),
                         Qt::CTRL | Qt::Key_F9,
                         tr("Where the head looks now, at the set height and distance; with a "
                            "pedal, both outer switches at once"));
  recentre_->setEnabled(false);
  connect(on_, &QAction::toggled, this, &HeadsetView::toggle);
  connect(recentre_, &QAction::triggered, this, &HeadsetView::recentre);
  // Another exercise has its arms elsewhere.
  connect(&workstation_, &Workstation::sessionStarted, this, &HeadsetView::placeByArms);
  connect(&case_views_, &CaseViews::caseShown, this, [this] {
    if (headset_ && placed_) place();
  });
  words_timer_.setInterval(kWordsEvery_ms);
  connect(&words_timer_, &QTimer::timeout, this, [this] {
    const bool stuck = headset_->stuck_s() > kStuck_s;
    if (stuck && !std::exchange(stuck_, stuck)) {
      messages_.say(workstation_.session()
                        ? tr("The headset's software does not answer: the exercise goes on here.")
                        : tr("The headset's software does not answer."));
    }
    stuck_ = stuck;
    emit changed();
  });
}

HeadsetView::~HeadsetView() {
  woken_.reset();
  if (!headset_) return;
  headset_->stop();
  headset_.reset();
}

void HeadsetView::toggle(bool on) {
  again_ = false;
  if (!on) return stop();
  if (!headset_) return start();
  again_ = true;
  if (headset_->stuck_s() > kStuck_s) {
    messages_.say(
        tr("The headset's software has not come back yet: the headset follows once it has."));
  }
}

void HeadsetView::start() {
  ViewWidget& view = case_views_.view();
  placed_ = seen_ = flat_ = stuck_ = by_arms_ = false;
  room_changes_ = 0;
  const auto wake = [this, woken = std::weak_ptr(woken_)] {
    const std::shared_ptr<Woken> here = woken.lock();
    if (!here || here->is.exchange(true)) return;
    QMetaObject::invokeMethod(this, &HeadsetView::serve, Qt::QueuedConnection);
  };
  Result<std::unique_ptr<Headset>> started =
      Error{code::kNoOpengl, trephine::tr("The 3-D view has not drawn anything yet"), "",
            trephine::tr("Open a case, and wait until it is shown")};
  if (view.context() && view.canDraw().ok()) {
    started = Headset::start(*view.context(), HeadsetOptions{}, wake);
  }
  if (!started) {
    const QSignalBlocker quiet(on_);
    on_->setChecked(false);
    return messages_.report(started.error());
  }
  headset_ = *std::move(started);
  recentre_->setEnabled(true);
  words_timer_.start();
  emit changed();
}

// Before the head; where registered arms are, if the exercise has some.
void HeadsetView::place() {
  const HeadsetState state = headset_->state();
  const ViewCamera& camera = case_views_.view().camera();
  const Preferences wanted = preferences();
  head_m_ = headOf(state.eyes_m).position;
  place_ = before(state.eyes_m, {camera.focus(), camera.forward(), camera.up()},
                  wanted.headset_ahead_m, -wanted.headset_below_m, wanted.headset_scale);
  ahead_ = glm::normalize(place_.toRoom_m(camera.focus()) - head_m_);
  placed_ = true;
  by_arms_ = false;
  placeByArms();
  showCards();
}

// Of the running exercise's arms, those that are registered in the room.
std::vector<HeadsetView::Standing> HeadsetView::standing() const {
  std::vector<Standing> arms;
  Session* session = workstation_.session();
  if (!session) return arms;
  const ChosenArms here = armSettings().chosen;
  for (std::size_t i = 0; i < session->exercise().arms.size(); ++i) {
    const auto device = here.find(session->exercise().arms[i].name);
    if (device == here.end() || session->isSimulated(i)) continue;
    const std::optional<ArmInRoom> in_room = armInRoom(device->second);
    if (!in_room) continue;
    const LoopState state = session->state();  // as clutching left them, once there is a tick
    const WorkspaceMap map =
        state.ticks > 0 ? state.maps[i] : *session->exercise().arms[i].map.fixed;
    arms.push_back({in_room->room_from_device_m,
                    in_room->error_mm.value_or(0.0),
                    {map.centre_mm, map.rotation, map.motion_scale}});
  }
  return arms;
}

void HeadsetView::placeByArms() {
  if (!headset_ || !placed_) return;
  const std::vector<Standing> arms = standing();
  if (arms.empty()) {
    if (std::exchange(by_arms_, false)) place();
    return;
  }
  place_ = where(arms.front().room_from_device_m, arms.front().in_patient);
  by_arms_ = true;
  messages_.say(tr("The patient lies where the arms are: the tools are seen within %1 mm of where "
                   "they are felt.")
                    .arg(toolsApart_mm(), 0, 'f', 1));
  showCards();
}

// As the arms are mapped now: a clutch moves a tool away from its arm.
double HeadsetView::toolsApart_mm() const {
  double most_mm = 0.0;
  for (const Standing& arm : standing()) {
    most_mm =
        std::max(most_mm, arm.error_mm + apart_mm(place_, arm.room_from_device_m, arm.in_patient));
  }
  return most_mm;
}

void HeadsetView::recentre() {
  if (!headset_ || !headset_->state().seen) return;
  place();
  emit changed();
}

void HeadsetView::settingsChanged() {
  mirrors_ = preferences().headset_mirror;
  if (!headset_) return;
  if (placed_) place();
  showMirror();
}

void HeadsetView::serve() {
  woken_->is = false;
  if (!headset_) return;
  if (const std::optional<HeadsetEnd> how = headset_->end()) return ended(*how);
  const HeadsetState state = headset_->state();
  sayState(state);
  if (!placed_ && state.located) place();
  if (!placed_) return;
  bool warmed = false;
  case_views_.view().withGraphics(
      [&](SceneRenderer& renderer, unsigned int shown, int wide, int high) {
        // What is drawn for the first time takes as long as several pictures: one thing an event.
        warmed = renderer.warmUp();
        if (warmed) return;
        painter_.serve(headset_->pictures(),
                       [&](const EyeView& eye_m, unsigned int framebuffer, int width, int height) {
                         renderer.paintEye(place_.toPatient_mm(eye_m), framebuffer, width, height);
                       },
                       {shown, wide, high});
      });
  if (warmed && !woken_->is.exchange(true)) {
    QMetaObject::invokeMethod(this, &HeadsetView::serve, Qt::QueuedConnection);
  }
  if (warmed) return;
  showMirror();
}

// The flat screen in the headset shows the panel's own picture.
void HeadsetView::showMirror() {
  const PicturePainter::Left& left = painter_.left();
  const bool mirrors = mirrors_ && seen_ && !flat_ && left.texture != 0;
  case_views_.view().showInstead(mirrors ? left.texture : 0, left.width, left.height);
}

void HeadsetView::sayState(const HeadsetState& state) {
  if (!on_->isChecked()) return;  // it is about to end
  keeps_room_ = state.keeps_room;
  if (std::exchange(room_changes_, state.room_changes) != state.room_changes) {
    if (forgetArmsInRoom(true)) {
      messages_.say(tr("The headset has set its room up anew: register the arms again (Devices)."));
    }
    placed_ = false;
  }
  if (state.seen == seen_ && state.flat == flat_) return;
  if (seen_ && !state.seen) {
    messages_.say(workstation_.session()
                      ? tr("The headset was taken off: the exercise goes on here.")
                      : tr("The headset was taken off."));
  }
  if (!flat_ && state.flat) {
    messages_.say(
        tr("A flat screen in the headset: %1 pairs of pictures a second, and 45 are needed.")
            .arg(std::floor(state.pairs_hz)));
  }
  if (flat_ && !state.flat) messages_.say(tr("Pictures come fast enough: look around."));
  seen_ = state.seen;
  flat_ = state.flat;
  emit changed();
}

void HeadsetView::ended(const HeadsetEnd& how) {
  case_views_.view().showInstead(0, 0, 0);
  case_views_.view().withGraphics([&](SceneRenderer& renderer, unsigned int, int, int) {
    painter_.release(headset_->pictures());
    renderer.releaseEyes();
  });
  headset_.reset();
  words_timer_.stop();
  marks_m_.clear();
  case_views_.view().setCards({});
  forgetArmsInRoom(false);
  seen_ = flat_ = stuck_ = placed_ = by_arms_ = false;
  recentre_->setEnabled(false);
  emit changed();
  if (std::exchange(again_, false)) return start();
  const bool wanted = on_->isChecked();
  {
    const QSignalBlocker quiet(on_);
    on_->setChecked(false);
  }
  if (wanted && !how.why.ok()) {
    // What went away in an exercise is said beside it, and no dialog holds up the hands.
    const Error& why = how.why.error();
    workstation_.session() ? messages_.say(toQt(why.what + ". " + why.next + "."))
                           : messages_.report(why);
  }
  emit changed();
}

void HeadsetView::stop() {
  if (!headset_) return;
  headset_->stop();
  case_views_.view().showInstead(0, 0, 0);
  if (std::exchange(flat_, false)) messages_.say({});  // that it shows a flat screen
  seen_ = false;
  emit changed();
}

void HeadsetView::setCards(std::vector<EyeCard> cards) {
  cards_ = std::move(cards);
  if (headset_ && placed_) showCards();
}

// At arm's length from where the head was, to both sides of what it looked at, each facing it.
void HeadsetView::showCards() {
  std::vector<EyeCard> all = cards_;
  const double scale = place_.scale;
  if (!isOne(scale) && workstation_.currentCase()) {
    all.push_back(noteCard(
        scale > 1.0 ? tr("The patient is shown %1 times as large as in life.").arg(scale, 0, 'f', 2)
                    : tr("The patient is shown at %1 % of the size in life.")
                          .arg(100.0 * scale, 0, 'f', 0)));
  }
  std::vector<Card> shown;
  const auto stand = [&](const EyeCard& each, const Vec3& middle_m) {
    Card card;
    card.name = each.name;
    const Quat turn = facing(middle_m - head_m_);
    card.pose_mm = {place_.toPatient_mm(middle_m),
                    glm::normalize(glm::conjugate(place_.turn) * turn)};
    card.width_mm = 1e3 * each.width_m / scale;
    card.width = each.image.width();
    card.height = each.image.height();
    for (int row = 0; row < card.height; ++row) {
      const uchar* line = each.image.constScanLine(row);
      card.rgba.insert(card.rgba.end(), line, line + 4 * card.width);
    }
    shown.push_back(std::move(card));
  };
  const Vec3 right = glm::normalize(glm::cross(ahead_, Vec3(0.0, 1.0, 0.0)));
  const Vec3 up = glm::cross(right, ahead_);
  for (const EyeCard& each : all) {
    const Vec3 way = ahead_ + right * std::tan(glm::radians(each.right_deg)) +
                     up * std::tan(glm::radians(each.up_deg));
    stand(each, head_m_ + kCardDistance_m * glm::normalize(way));
    shown.back().before_all = each.before_all;
  }
  for (std::size_t i = 0; i < marks_m_.size(); ++i) {
    stand(markCard(int(i) + 1), marks_m_[i]);
    shown.back().before_all = true;  // they may lie in the patient
  }
  case_views_.view().setCards(std::move(shown));
}

std::vector<Vec3> HeadsetView::showMarks() {
  marks_m_.clear();
  if (!headset_ || !headset_->state().seen) return {};
  const Head head_m = headOf(headset_->state().eyes_m);
  const Vec3 middle_m = head_m.position + kMarksAhead_m * head_m.forward;
  // The corners of a triangle of equal sides that lies level.
  const Vec3 ahead = levelAhead(head_m);
  const Vec3 right = glm::cross(ahead, Vec3(0.0, 1.0, 0.0));
  const double high_m = 0.5 * std::sqrt(3.0) * kMarksApart_m;
  marks_m_ = {middle_m - right * (0.5 * kMarksApart_m) - ahead * (high_m / 3.0),
              middle_m + right * (0.5 * kMarksApart_m) - ahead * (high_m / 3.0),
              middle_m + ahead * (2.0 * high_m / 3.0)};
  showCards();
  return marks_m_;
}

void HeadsetView::hideMarks() {
  marks_m_.clear();
  if (headset_ && placed_) showCards();
}

QString HeadsetView::words() const {
  if (!headset_) return {};
  if (headset_->stuck_s() > kStuck_s) return tr("Headset: its software does not answer");
  const HeadsetState state = headset_->state();
  if (!state.seen) return tr("Headset: not worn");
  QStringList words{
      state.flat ? tr("Headset: flat screen")
      : state.pairs_hz > 0.0
          ? tr("Headset: %1 pairs of pictures a second").arg(state.pairs_hz, 0, 'f', 0)
          : tr("Headset")};
  words << tr("both eyes %1 ms").arg(painter_.pair_ms(), 0, 'f', 1);
  if (by_arms_) words << tr("tools within %1 mm of the arms").arg(toolsApart_mm(), 0, 'f', 1);
  if (!isOne(place_.scale) && !state.flat && workstation_.currentCase())
    words << tr("patient at %1 %").arg(100.0 * place_.scale, 0, 'f', 0);
  return words.join(QStringLiteral(" \u00b7 "));
}

}  // namespace trephine
