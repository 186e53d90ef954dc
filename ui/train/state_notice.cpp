#include "ui/train/state_notice.h"

#include <QEvent>
#include <QStringList>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/common/making.h"
#include "ui/common/words.h"
#include "ui/train/arms_panel.h"
#include "ui/train/exercise_panel.h"

namespace trephine {

namespace {

constexpr int kNoticeWidest = 460;
constexpr int kMargin = 16;

// "Left arm", "Both arms": what a line is about.
QString whoWords(const std::vector<std::size_t>& arms, const Exercise& exercise) {
  if (arms.size() > 1 && arms.size() == exercise.arms.size()) {
    return arms.size() == 2 ? StateNotice::tr("Both arms") : StateNotice::tr("All arms");
  }
  QStringList names;
  for (std::size_t arm : arms) names << armName(exercise.arms[arm]);
  return names.join(", ");
}

}  // namespace

ForceNotice forceNotice(const LoopState& state, const Exercise& exercise, double still_s) {
  if (still_s > 0.0) {
    return {
        StateNotice::tr("NO FORCE"),
        StateNotice::tr("An arm or the computer does not answer: touch has stood still for %1 s. "
                        "Wait, or stop the exercise (Ctrl+.).")
            .arg(std::ceil(still_s)),
        {}};
  }
  ForceNotice out;
  QStringList reasons;                            // each once, in the order of the arms
  std::vector<std::vector<std::size_t>> with_it;  // the arms that have it
  std::vector<std::size_t> all;
  std::uint32_t faults = 0;
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    const ArmRecord& arm = state.record.arms[i];
    QStringList of_arm;
    if (arm.faults != 0) of_arm << faultWords(arm.faults);
    if (arm.faults == 0 && (arm.tool_state & kToolNoHand)) {
      of_arm << StateNotice::tr(
          "Take the arm in hand: its force comes once it was moved, or its button is pressed.");
    }
    if (!state.paused && (arm.tool_state & kToolWaits)) {
      of_arm << StateNotice::tr(
          "The tool is in tissue that it did not come into. Draw it out to feel and to cut; the "
          "mouse and the keys do so by themselves. Where it does not come out: stop, and put the "
          "exercise's entry at the surface.");
    }
    if (!state.paused && (arm.tool_state & kToolClutched)) {
      of_arm << StateNotice::tr(
          "Clutched: the arm moves freely and its tool stays, until Ctrl+K is pressed again.");
    }
    if (arm.tool_state & kToolLetGo) {
      of_arm << StateNotice::tr("The tool was hooked behind bone: it is let go.");
    }
    const QString reason = of_arm.join('\n');
    if (reason.isEmpty()) continue;
    faults |= arm.faults;
    all.push_back(i);
    const auto known = reasons.indexOf(reason);
    if (known < 0) {
      reasons << reason;
      with_it.push_back({i});
    } else {
      with_it[std::size_t(known)].push_back(i);
    }
  }
  const bool pedal_lost = state.record.arms[0].buttons & kPedalLost;
  if (all.empty() && pedal_lost) out.title = StateNotice::tr("THE PEDAL DOES NOT ANSWER");
  if (!all.empty()) out.title = StateNotice::tr("NO FORCE: %1").arg(whoWords(all, exercise));
  for (qsizetype r = 0; r < reasons.size(); ++r) {
    if (r > 0) out.why += '\n';
    if (reasons.size() > 1) out.why += whoWords(with_it[std::size_t(r)], exercise) + ": ";
    out.why += reasons[r];
  }
  if ((faults & kFaultDeviceLost) && all.size() < exercise.arms.size()) {
    out.why += '\n' + StateNotice::tr("The other hand goes on, and so does the recording.");
  }
  if (pedal_lost) {
    if (!out.why.isEmpty()) out.why += '\n';
    out.why += StateNotice::tr(
        "The pedal was unplugged: motors are off. Go on without it, and they run by themselves; or "
        "stop, plug it in, and start again.");
  }
  if (faults & kFaultDeviceLost) {
    out.mend = StateNotice::tr("Try again");
  } else if (faults & ~kPassingFaults) {
    out.mend = StateNotice::tr("Force on");
  } else if (pedal_lost) {
    out.mend = StateNotice::tr("Go on without it");
  }
  return out;
}

QString backWords(std::uint32_t second, const LoopState& state, const Exercise& exercise) {
  const QString back =
      StateNotice::tr("Back at %1: tissue, counts and forces as they were. The clock runs on.")
          .arg(timeWords(second));
  std::vector<std::size_t> waiting;
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    if (state.record.arms[i].tool_state & kToolWaits) waiting.push_back(i);
  }
  if (waiting.empty()) return back;
  return StateNotice::tr("%1 %2: draw the tool out of the tissue to feel again.")
      .arg(back, whoWords(waiting, exercise));
}

// By arm: what tissue it was is said by the panel's tally.
QString undoneWords(const LoopState& before, const LoopState& after, const Exercise& exercise,
                    double voxel_mm3) {
  QStringList undone, redone;
  for (std::size_t arm = 0; arm < exercise.arms.size(); ++arm) {
    double voxels = 0.0;
    for (std::size_t t = 0; t < exercise.tissues.tissues.size(); ++t) {
      voxels += double(before.removed[arm][t]) - double(after.removed[arm][t]);
    }
    if (voxels == 0.0) continue;
    (voxels > 0.0 ? undone : redone) << StateNotice::tr("%1, %2").arg(
        armName(exercise.arms[arm]), volumeWords(std::abs(voxels) * voxel_mm3));
  }
  QStringList all;
  if (!undone.isEmpty()) all << StateNotice::tr("Brought back: %1.").arg(undone.join("; "));
  if (!redone.isEmpty()) all << StateNotice::tr("Cut again: %1.").arg(redone.join("; "));
  return all.join(' ');
}

StateNotice::StateNotice(QWidget* view, const QWidget* bar) : QWidget(view), bar_(bar) {
  setObjectName("stateNotice");
  force_on_ = named(new QAction(tr("Force on"), this), "forceBack");
  force_on_->setShortcut(QKeySequence(Qt::CTRL | Qt::Key_F));
  force_on_->setAutoRepeat(false);
  tight(new QVBoxLayout(this), 8);
  pause_ = makeCard("pauseNotice", "goOn");
  pause_.title->setText(tr("PAUSED"));
  pause_.why->setText(tr("No force, no cutting, and the clock stands still."));
  pause_.button->setText(tr("Go on (Space)"));
  force_ = makeCard("forceNotice", "forceOn");
  ready_ = makeCard("readyNotice", "readyButton");
  ready_.title->setText(tr("READY"));
  ready_.why->setText(tr("Take an arm, or move the mouse over the tissue: the wheel presses."));
  ready_.button->hide();
  connect(pause_.button, &QPushButton::clicked, this, &StateNotice::goOnWanted);
  connect(force_.button, &QPushButton::clicked, force_on_, &QAction::trigger);
  connect(force_on_, &QAction::triggered, this, &StateNotice::forceWanted);
  view->installEventFilter(this);
  showIdle();
}

StateNotice::Card StateNotice::makeCard(const char* name, const char* button_name) {
  auto* frame = named(new QFrame(this), name, {"notice"});
  auto* title = named(new QLabel(frame), QString(name) + "Title", {"noticeTitle"});
  auto* why = named(new QLabel(frame), QString(name) + "Why");
  auto* button = named(new QPushButton(frame), button_name);
  button->setFocusPolicy(Qt::TabFocus);  // a click leaves the keys with the hands
  auto* layout = new QVBoxLayout(frame);
  layout->setContentsMargins(16, 10, 16, 12);
  layout->setSpacing(6);
  for (QLabel* label : {title, why}) {
    label->setAlignment(Qt::AlignCenter);
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    layout->addWidget(label);
  }
  layout->addWidget(button, 0, Qt::AlignCenter);
  this->layout()->addWidget(frame);
  return {frame, title, why, button};
}

void StateNotice::showState(const LoopState& state, const Exercise& exercise, double still_s,
                            bool ready) {
  show(state.paused, forceNotice(state, exercise, still_s), ready);
}

void StateNotice::show(bool paused, const ForceNotice& force, bool ready) {
  const QString mend =
      force.mend.isEmpty()
          ? QString()
          : tr("%1 (%2)").arg(force.mend, force_on_->shortcut().toString(QKeySequence::NativeText));
  const bool without_force = !force.title.isEmpty();
  ready = ready && !paused && !without_force;
  const bool same = isHidden() == !(paused || without_force || ready) &&
                    pause_.frame->isHidden() != paused && ready_.frame->isHidden() != ready &&
                    force_.frame->isHidden() != without_force &&
                    force_.title->text() == force.title && force_.why->text() == force.why &&
                    force_.button->text() == mend;
  if (same) return;
  // A button that goes would leave the keys to whatever comes next in the window.
  const bool had_focus = isAncestorOf(window()->focusWidget());
  pause_.frame->setVisible(paused);
  force_.frame->setVisible(without_force);
  ready_.frame->setVisible(ready);
  force_.title->setText(force.title);
  force_.why->setText(force.why);
  force_.button->setText(mend);
  force_.button->setVisible(!mend.isEmpty());
  force_on_->setEnabled(!mend.isEmpty());
  setVisible(paused || without_force || ready);
  if (had_focus && !isAncestorOf(window()->focusWidget())) parentWidget()->setFocus();
  place();
}

bool StateNotice::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) place();
  return QWidget::eventFilter(watched, event);
}

void StateNotice::place() {
  const QWidget* view = parentWidget();
  const int width = std::min(kNoticeWidest, view->width() - 2 * kMargin);
  // Where words changed within a card, only the card's own layout knows it yet.
  for (QFrame* frame : {pause_.frame, force_.frame, ready_.frame}) frame->updateGeometry();
  layout()->activate();
  const int height = layout()->totalHeightForWidth(width);
  const int top =
      bar_ && bar_->isVisibleTo(view) ? bar_->geometry().bottom() + kMargin / 2 : kMargin;
  setGeometry((view->width() - width) / 2, top, width, height);
}

}  // namespace trephine
