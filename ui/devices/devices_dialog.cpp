#include "ui/devices/devices_dialog.h"

#include <QDialogButtonBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QVBoxLayout>

#include "base/system.h"
#include "device/codes.h"
#include "exercise/arms_file.h"
#include "ui/common/making.h"
#include "ui/common/words.h"
#include "ui/work/arms_of_place.h"

namespace trephine {

namespace {

constexpr int kShown_ms = 33;
constexpr int kSettle_ms = 700;    // until what was plugged in has its nodes
constexpr double kMoved_m = 0.02;  // the arm that a person means
constexpr double kTest_N = 1.0;
constexpr int kLeastWidth = 720, kLeastHeight = 620;  // nothing in it is cut

QString nameOf(const FoundArm& arm) {
  const auto brief = [](const std::string& text) {
    constexpr int kMost = 40;
    const QString all = toQt(text).simplified();
    return all.size() > kMost ? all.left(kMost) + QChar(0x2026) : all;
  };
  return DevicesDialog::tr("%1 at %2")
      .arg(brief(arm.model.empty() ? arm.plugin : arm.model), brief(arm.bus_path));
}

}  // namespace

DevicesDialog::DevicesDialog(std::shared_ptr<std::timed_mutex> opens_arms, QWidget* parent)
    : QDialog(parent), opens_arms_(std::move(opens_arms)) {
  setObjectName("devicesDialog");
  setWindowTitle(tr("Devices"));
  list_ = named(new QListWidget, "deviceList");
  list_->setAccessibleName(tr("Arms that are plugged in"));
  problems_ = wrappedLabel("deviceProblems", {"quiet"});
  again_ = namedButton("lookAgain", tr("L&ook again"));
  name_ = wrappedLabel("deviceName");
  able_ = wrappedLabel("deviceAble", {"quiet"});
  picture_ = new ArmPicture;
  room_ = new RoomPanel;
  now_ = wrappedLabel("deviceNow");
  test_ = wrappedLabel("forceTest");
  for (QLabel* words : {now_, test_}) {  // what is said changes, and nothing moves with it
    words->setAlignment(Qt::AlignTop);
    words->setFixedHeight(3 * words->fontMetrics().lineSpacing());
  }
  force_ = namedButton("testForce", tr("&Test the force"));
  felt_ = namedButton("forceFelt", tr("It pulled &up"));
  not_felt_ = namedButton("forceNotFelt", tr("It did &not"));
  left_ = named(new QComboBox, "leftArm");
  right_ = named(new QComboBox, "rightArm");
  pedal_ = named(new QComboBox, "pedal");
  auto* how = wrappedLabel("deviceHow", {"quiet"});
  how->setText(tr("Move an arm by hand: it is chosen here."));

  auto* found = new QVBoxLayout;
  found->addWidget(how);
  found->addWidget(list_, 1);
  found->addWidget(problems_);
  found->addWidget(again_, 0, Qt::AlignLeft);
  auto* answers = new QHBoxLayout;
  for (QPushButton* each : {force_, felt_, not_felt_}) answers->addWidget(each);
  answers->addStretch(1);
  auto* chosen = new QVBoxLayout;
  chosen->addWidget(name_);
  chosen->addWidget(able_);
  chosen->addWidget(picture_, 1);
  chosen->addWidget(now_);
  chosen->addWidget(test_);
  chosen->addLayout(answers);
  chosen->addWidget(room_);
  auto* columns = new QHBoxLayout;
  columns->addLayout(found, 2);
  columns->addLayout(chosen, 3);
  auto* sides = new QFormLayout;
  sides->addRow(tr("&Left hand"), left_);
  sides->addRow(tr("&Right hand"), right_);
  sides->addRow(tr("&Pedal"), pedal_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  // Return, in a list of hands, is not to close all of it.
  buttons->button(QDialogButtonBox::Close)->setAutoDefault(false);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(columns, 1);
  layout->addLayout(sides);
  layout->addWidget(buttons);
  setMinimumSize(kLeastWidth, kLeastHeight);
  resize(kLeastWidth, kLeastHeight);

  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(again_, &QPushButton::clicked, this, &DevicesDialog::look);
  connect(list_, &QListWidget::currentRowChanged, this, [this] {
    asked_ = false;
    if (trial_) trial_->endForce();  // of the arm before
    showArm();
  });
  connect(force_, &QPushButton::clicked, this, &DevicesDialog::askForForce);
  connect(felt_, &QPushButton::clicked, this, [this] { answer(true); });
  connect(not_felt_, &QPushButton::clicked, this, [this] { answer(false); });
  connect(left_, &QComboBox::activated, this, [this](int index) { choose("left", index); });
  connect(right_, &QComboBox::activated, this, [this](int index) { choose("right", index); });
  connect(pedal_, &QComboBox::activated, this, [this](int index) { choose(kPedal, index); });
  connect(&show_timer_, &QTimer::timeout, this, &DevicesDialog::showNow);
  show_timer_.start(kShown_ms);
  plug_timer_.setSingleShot(true);
  plug_timer_.setInterval(kSettle_ms);
  connect(&plug_timer_, &QTimer::timeout, this, &DevicesDialog::look);
  plugs_.addPath("/dev");
  connect(&plugs_, &QFileSystemWatcher::directoryChanged, this, [this] { plug_timer_.start(); });
  connect(this, &QDialog::finished, this, &DevicesDialog::close);
  showList();
  look();
}

DevicesDialog::~DevicesDialog() = default;

// What is being opened is waited for elsewhere.
void DevicesDialog::close() {
  show_timer_.stop();
  plug_timer_.stop();
  room_->stop();
  trial_.reset();
  look_again_ = false;
  const auto go = [this] {
    trial_.reset();
    emit letGo();
    deleteLater();
  };
  if (!looking_.busy()) return go();
  connect(&looking_, &BackgroundTask::ended, this, go, Qt::QueuedConnection);
}

void DevicesDialog::look() {
  if (looking_.busy()) {
    look_again_ = true;
    return;
  }
  again_->setEnabled(false);
  problems_->setText(tr("Looking for arms\u2026"));
  problems_->show();
  for (QComboBox* box : {left_, right_, pedal_}) box->setEnabled(false);
  asked_ = false;
  struct Found {
    FoundArms here;
    std::shared_ptr<ArmTrial> trial;
  };
  // A person may be in the middle of a test: its force goes as the arms are asked anew.
  looking_.run(
      [before = std::exchange(trial_, nullptr),
       opens = opens_arms_](const Progress&) mutable -> Result<Found> {
        const std::lock_guard lock(*opens);
        before.reset();
        Found out{findArms(pluginFolder()), nullptr};
        std::erase_if(out.here.arms, [](const FoundArm& arm) { return arm.plugin == kSimulated; });
        if (!out.here.arms.empty()) out.trial = ArmTrial::start(out.here.arms);
        return out;
      },
      [this](Result<Found> out) {
        again_->setEnabled(true);
        for (QComboBox* box : {left_, right_, pedal_}) box->setEnabled(true);
        if (std::exchange(look_again_, false)) {
          if (out) trial_ = out->trial;
          return look();
        }
        if (!out) {
          problems_->setText(toQt(out.error().sentence()));
          return;
        }
        trial_ = std::move(out->trial);
        found(out->here);
      });
}

void DevicesDialog::found(const FoundArms& here) {
  arms_ = here.arms;
  moved_m_.assign(arms_.size(), 0.0);
  QStringList lines;
  for (const Error& problem : here.problems) lines << toQt(problem.sentence());
  if (arms_.empty()) {
    lines << tr("No arm is plugged in. Without one the mouse and the keys move the hands.");
  }
  problems_->setText(lines.join("\n"));
  problems_->setVisible(!lines.isEmpty());
  showList();
}

QString DevicesDialog::sideOf(const FoundArm& arm) const {
  const ChosenArms chosen = armSettings().chosen;
  for (const auto& [side, of] : chosen) {
    if (!of.isSame(arm)) continue;
    return side == kPedal ? tr("pedal") : side == "left" ? tr("left hand") : tr("right hand");
  }
  return {};
}

void DevicesDialog::showList() {
  const int row = std::max(0, shown());
  const QSignalBlocker blocked(list_);
  list_->clear();
  for (const FoundArm& arm : arms_) {
    QStringList lines{nameOf(arm)};
    if (const QString side = sideOf(arm); !side.isEmpty()) lines << side;
    if (const auto tested = felt_by_place_.find(arm.bus_path); tested != felt_by_place_.end()) {
      lines << (tested->second ? tr("its force was felt") : tr("NO FORCE was felt"));
    }
    list_->addItem(lines.join('\n'));
  }
  list_->setCurrentRow(std::min(row, int(arms_.size()) - 1));
  showSides();
  showArm();
}

// What is chosen and not there stays, and says so.
void DevicesDialog::showSides() {
  const ChosenArms chosen = armSettings().chosen;
  for (const auto& [side, box] :
       {std::pair("left", left_), std::pair("right", right_), std::pair(kPedal, pedal_)}) {
    const QSignalBlocker blocked(box);
    const bool wants_pedal = box == pedal_;
    box->clear();
    box->addItem(wants_pedal ? tr("None") : tr("None: mouse and keys move it"), -1);
    const auto of = chosen.find(side);
    bool here = of == chosen.end();
    for (std::size_t i = 0; i < arms_.size(); ++i) {
      const bool tried = trial_ && i < trial_->size() && !trial_->problem(i);
      if (tried && isPedal(i) != wants_pedal) continue;  // of what cannot be opened nobody knows
      box->addItem(nameOf(arms_[i]), int(i));
      if (of == chosen.end() || !arms_[i].isSame(of->second)) continue;
      here = true;
      box->setCurrentIndex(box->count() - 1);
    }
    if (here) continue;
    box->addItem(tr("%1, not plugged in").arg(nameOf(of->second)), int(arms_.size()));
    box->setCurrentIndex(box->count() - 1);
  }
}

bool DevicesDialog::isPedal(std::size_t arm) const {
  return trial_ && arm < trial_->size() && !trial_->problem(arm) &&
         trial_->capabilities(arm).input_dof == 0;
}

// Of the arm that is shown; it stands in the list until the dialog is closed.
void DevicesDialog::answer(bool felt) {
  if (shown() < 0 || shown() >= int(arms_.size())) return;
  felt_by_place_[arms_[std::size_t(shown())].bus_path] = felt;
  showList();
  test_->setText(
      felt ? tr("The force of this arm works.")
           : tr("Then no exercise can be felt with this arm: check that it is switched on "
                "and that its emergency stop is out, and test it again."));
}

// Escape ends a force that pulls, and then the dialog.
void DevicesDialog::keyPressEvent(QKeyEvent* event) {
  using Phase = ForceTest::Phase;
  const bool any = trial_ && shown() >= 0 && shown() < int(trial_->size());
  const Phase phase = any ? trial_->state()[std::size_t(shown())].test : Phase::off;
  if (event->key() == Qt::Key_Escape && ForceTest::runs(phase)) return askForForce();
  if (event->key() == Qt::Key_Escape && room_->isTouching()) return room_->stop();
  QDialog::keyPressEvent(event);
}

// A device has one hand: the other gets what this one had.
void DevicesDialog::choose(const std::string& side, int index) {
  const QComboBox* box = side == kPedal ? pedal_ : side == "left" ? left_ : right_;
  const int arm = box->itemData(index).toInt();
  if (arm >= int(arms_.size())) return;  // the one that is not there
  if (arm < 0) {
    chooseArm(side, {});
  } else {
    const FoundArm& device = arms_[std::size_t(arm)];
    const ChosenArms before = armSettings().chosen;
    const auto had = before.find(side);
    for (const auto& [other, has] : before) {
      if (other == side || !has.isSame(device)) continue;
      const bool swaps = had != before.end() && side != kPedal && other != kPedal;
      chooseArm(other, swaps ? std::optional<FoundArm>(had->second) : std::nullopt);
    }
    chooseArm(side, device);
    list_->setCurrentRow(arm);
  }
  showList();
}

void DevicesDialog::showArm() {
  const int row = shown();
  const bool any = row >= 0 && row < int(arms_.size());
  for (QPushButton* each : {felt_, not_felt_}) each->setEnabled(false);
  test_->clear();
  const bool can_stand = any && trial_ && std::size_t(row) < trial_->size() &&
                         !trial_->problem(std::size_t(row)) && !isPedal(std::size_t(row));
  room_->showArm(can_stand ? std::optional(arms_[std::size_t(row)]) : std::nullopt);
  if (!any) {
    name_->clear();
    able_->clear();
    now_->clear();
    picture_->clear();
    force_->setEnabled(false);
    return;
  }
  const FoundArm& arm = arms_[std::size_t(row)];
  name_->setText(nameOf(arm));
  able_->clear();
  if (trial_ && std::size_t(row) < trial_->size() && !trial_->problem(std::size_t(row))) {
    const TrephineCapabilities& able = trial_->capabilities(std::size_t(row));
    QStringList lines;
    if (able.input_dof == 0) {
      lines << tr("A pedal");
    } else {
      lines << tr("reaches %1 \u00d7 %2 \u00d7 %3 mm")
                   .arg(1e3 * able.workspace_m[0], 0, 'f', 0)
                   .arg(1e3 * able.workspace_m[1], 0, 'f', 0)
                   .arg(1e3 * able.workspace_m[2], 0, 'f', 0)
            << tr("gives %1 N at most, %2 N for as long as you like")
                   .arg(able.peak_force_N, 0, 'f', 1)
                   .arg(able.continuous_force_N, 0, 'f', 1)
            << tr("%1 samples a second").arg(able.rate_hz, 0, 'f', 0);
      if (able.latency_s > 0.0) {
        lines << tr("answers within %1 ms").arg(1e3 * able.latency_s, 0, 'f', 1);
      }
      if (able.input_dof == 3) lines << tr("does not say how it is turned");
    }
    if (!arm.serial.empty()) lines << tr("serial %1").arg(toQt(arm.serial));
    able_->setText(lines.join(" \u00b7 "));
  }
  showNow();
}

// The arm that a person moves is the one that is meant.
void DevicesDialog::showNow() {
  const int row = shown();
  if (!trial_ || row < 0) {
    force_->setEnabled(false);
    return;
  }
  if (row >= int(trial_->size())) {
    now_->setText(tr("At most %1 are tried at once: unplug another.").arg(trial_->size()));
    picture_->clear();
    force_->setEnabled(false);
    return;
  }
  const TriedArms& arms = trial_->state();
  for (std::size_t i = 0; i < trial_->size() && i < moved_m_.size(); ++i) {
    const double before_m = std::exchange(moved_m_[i], arms[i].moved_m);
    if (before_m < kMoved_m && moved_m_[i] >= kMoved_m && int(i) != row && !room_->isTouching()) {
      return list_->setCurrentRow(int(i));
    }
  }
  const std::size_t i = std::size_t(row);
  if (const std::optional<Error>& problem = trial_->problem(i)) {
    const bool calibration = problem->code == code::kNotCalibrated;
    now_->setText(calibration ? tr("%1. Then look again.").arg(toQt(problem->what))
                              : toQt(problem->sentence()));
    calibration ? picture_->showHolder() : picture_->clear();
    force_->setEnabled(false);
    return;
  }
  const TriedArm& arm = arms[i];
  const TrephineCapabilities& able = trial_->capabilities(i);
  const bool lost = arm.flags & TREPHINE_ARM_LOST;
  const bool placed = arm.flags & TREPHINE_ARM_CALIBRATED;
  room_->follow(arm.pose_m.position, arm.buttons, placed && !lost);
  if (able.input_dof == 0) {
    picture_->clear();
  } else if (!placed && !lost) {
    picture_->showHolder();
  } else {
    const double* reach_m = able.workspace_m;
    picture_->showTip(arm.pose_m.position, {reach_m[0], reach_m[1], reach_m[2]}, arm.force_N);
  }
  QStringList now;
  if (lost) {
    now << tr("It does not answer: check its plug, then look again.");
  } else if (able.input_dof != 0 && !placed) {
    now << tr(
        "It does not know where it is: put the stylus into its holder and take it out again.");
  } else {
    if (able.input_dof != 0) {
      now << (arm.moved_m < kMoved_m
                  ? tr("Move it to see that this is the one.")
                  : tr("It was moved by up to %1 mm.").arg(1e3 * arm.moved_m, 0, 'f', 0));
    }
    for (int bit = 0; bit < 8; ++bit) {
      if (arm.buttons & (1u << bit)) now << tr("Button %1 is pressed.").arg(bit + 1);
    }
    if (arm.flags & TREPHINE_ARM_WARM) now << tr("Its motors are warm.");
    if (arm.flags & TREPHINE_ARM_ERROR) now << tr("It reports an error.");
  }
  now_->setText(now.join(' '));
  using Phase = ForceTest::Phase;
  const bool runs = ForceTest::runs(arm.test);
  force_->setEnabled(able.input_dof != 0 && able.peak_force_N > 0.0 && placed && !lost);
  force_->setText(runs ? tr("&Stop the force") : tr("&Test the force"));
  switch (arm.test) {
    case Phase::waiting:
      waited_ = true;
      test_->setText(tr("Hold the arm: press its button and keep it pressed, or move it a little "
                        "where it has none. Then it will pull up, slowly, to %1 N.")
                         .arg(std::min(kTest_N, able.continuous_force_N), 0, 'f', 1));
      break;
    case Phase::rising:
    case Phase::holding:
    case Phase::falling:
      test_->setText(tr("It pulls up with %1 N.").arg(arm.force_N, 0, 'f', 1));
      break;
    case Phase::lost:
      test_->setText(tr(
          "The force was taken away: the arm left the hand, or did not answer for a moment. Hold "
          "it and test it again; if it goes on, check its cable."));
      break;
    case Phase::done:
      if (asked_) test_->setText(tr("Did it pull up?"));
      break;
    case Phase::off:
      if (std::exchange(waited_, false) && std::exchange(asked_, false)) {
        test_->setText(tr("No hand took it. Test it again."));
      }
      break;
  }
  if (arm.test == Phase::done && std::exchange(asked_, false)) {
    felt_->setEnabled(true);
    not_felt_->setEnabled(true);
    list_->setFocus();  // neither answer by a careless key
  }
}

void DevicesDialog::askForForce() {
  if (!trial_ || shown() < 0) return;
  const std::size_t arm = std::size_t(shown());
  const ForceTest::Phase phase = trial_->state()[arm].test;
  for (QPushButton* each : {felt_, not_felt_}) each->setEnabled(false);
  if (ForceTest::runs(phase)) {
    trial_->endForce();
    asked_ = false;
    test_->setText(tr("The force is off."));
    return;
  }
  asked_ = true;
  waited_ = false;
  trial_->askForForce(arm, kTest_N);
}

}  // namespace trephine
