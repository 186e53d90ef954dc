#include "ui/devices/room_panel.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QVBoxLayout>
#include <cmath>
#include <utility>

#include "headset/room_place.h"
#include "ui/common/making.h"
#include "ui/common/number_field.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr double kPoor_mm = 5.0;  // marks that were touched better than that are rare to miss
constexpr double kFarthest_cm = 500.0;

}  // namespace

RoomPanel::RoomPanel(QWidget* parent) : QWidget(parent) {
  words_ = wrappedLabel("roomWords");
  words_->setAlignment(Qt::AlignTop);
  words_->setFixedHeight(2 * words_->fontMetrics().lineSpacing());  // nothing moves with it
  begin_ = namedButton("touchMarks", tr("Touch three &marks"));
  here_ = namedButton("markTouched", tr("The tip is &there"));
  by_hand_ = namedButton("roomByHand", tr("&By hand\u2026"));
  forget_ = namedButton("forgetRoom", tr("&Forget"));
  auto* row = new QHBoxLayout;
  for (QPushButton* each : {begin_, here_, by_hand_, forget_}) row->addWidget(each);
  row->addStretch(1);
  auto* layout = tight(new QVBoxLayout(this));
  layout->addWidget(words_);
  layout->addLayout(row);
  connect(begin_, &QPushButton::clicked, this, [this] {
    if (!touching_) return begin();
    touched_m_.empty() ? emit marksWanted(true) : stop();
  });
  connect(here_, &QPushButton::clicked, this, &RoomPanel::touch);
  connect(by_hand_, &QPushButton::clicked, this, &RoomPanel::byHand);
  connect(forget_, &QPushButton::clicked, this, [this] {
    stop();
    if (arm_) setArmInRoom(*arm_, {});
    showWords();
  });
  showWords();
}

void RoomPanel::setHeadset(bool seen, bool keeps_room) {
  if (seen == headset_ && keeps_room == keeps_room_) return;
  headset_ = seen;
  keeps_room_ = keeps_room;
  if (!seen && touching_) stop();
  showWords();
}

void RoomPanel::setMarks(std::vector<Vec3> room_m) {
  marks_m_ = std::move(room_m);
  touched_m_.clear();
  if (marks_m_.size() < 3 && touching_) stop();
  showWords();
}

void RoomPanel::showArm(const std::optional<FoundArm>& arm) {
  if (touching_) stop();
  arm_ = arm;
  knows_ = false;
  showWords();
}

void RoomPanel::follow(const Vec3& tip_m, std::uint32_t buttons, bool knows) {
  const std::uint32_t pressed = buttons & ~std::exchange(buttons_, buttons);
  tip_m_ = tip_m;
  if (std::exchange(knows_, knows) != knows) showWords();
  if (touching_ && pressed != 0) touch();
}

void RoomPanel::begin() {
  touching_ = true;
  touched_m_.clear();
  emit marksWanted(true);
  showWords();
  if (touching_) here_->setFocus();  // Space, for who sees no window
}

void RoomPanel::stop() {
  if (!std::exchange(touching_, false)) return;
  touched_m_.clear();
  emit marksWanted(false);
  showWords();
}

void RoomPanel::touch() {
  if (!touching_ || !arm_ || !knows_ || marks_m_.size() < 3) return;
  touched_m_.push_back(tip_m_);
  if (touched_m_.size() < 3) return showWords();
  const Result<Registration> found =
      registerArm(touched_m_, std::span(marks_m_).first(touched_m_.size()));
  if (!found) {
    touched_m_.clear();
    showWords();
    words_->setText(toQt(found.error().sentence()));
    return;
  }
  setArmInRoom(*arm_, ArmInRoom{found->room_from_device_m, found->error_mm, keeps_room_});
  stop();
}

// Level, and turned about the vertical alone: what a person can measure with a tape.
void RoomPanel::byHand() {
  if (!arm_) return;
  const FoundArm arm = *arm_;
  const std::optional<ArmInRoom> before = armInRoom(arm);
  const Pose from = before ? before->room_from_device_m : Pose{{0.0, 0.0, -0.5}, Quat(1, 0, 0, 0)};
  auto* dialog = named(new QDialog(this), "roomDialog");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Where the arm stands"));
  auto* form = new QFormLayout;
  const auto add = [&](const char* name, const QString& words, const QString& unit, double most,
                       double now) {
    auto* field = new DecimalField(name, dialog);
    field->setSuffix(unit);
    field->setDecimals(1);
    field->setLimits(-most, most);
    field->show(now);
    addRow(*form, words, field);
    return field;
  };
  const Vec3 to_right = from.orientation * Vec3(1.0, 0.0, 0.0);
  const double turn_deg = glm::degrees(std::atan2(-to_right.z, to_right.x));
  auto* right = add("roomRight", tr("To the &right of the room's middle"), tr(" cm"), kFarthest_cm,
                    100.0 * from.position.x);
  auto* above = add("roomUp", tr("&Above it"), tr(" cm"), kFarthest_cm, 100.0 * from.position.y);
  auto* ahead =
      add("roomAhead", tr("&Ahead of it"), tr(" cm"), kFarthest_cm, -100.0 * from.position.z);
  auto* turn = add("roomTurn", tr("&Turned to the left by"), tr("\u00b0"), 180.0, turn_deg);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Save | QDialogButtonBox::Cancel);
  connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::reject);
  connect(buttons, &QDialogButtonBox::accepted, dialog, [=, this] {
    for (DecimalField* each : {right, above, ahead, turn}) {
      if (each->isRefused()) return;  // it says why
    }
    const Pose pose{0.01 * Vec3(right->wanted(), above->wanted(), -ahead->wanted()),
                    glm::angleAxis(glm::radians(turn->wanted()), Vec3(0.0, 1.0, 0.0))};
    setArmInRoom(arm, ArmInRoom{pose, {}, keeps_room_ || !headset_});
    dialog->accept();
    showWords();
  });
  auto* layout = new QVBoxLayout(dialog);
  layout->addLayout(form);
  layout->addWidget(buttons);
  dialog->open();
}

void RoomPanel::showWords() {
  const std::optional<ArmInRoom> where = arm_ ? armInRoom(*arm_) : std::nullopt;
  begin_->setEnabled(arm_ && headset_ && knows_);
  begin_->setText(!touching_           ? tr("Touch three &marks")
                  : touched_m_.empty() ? tr("Bring the &marks here")
                                       : tr("&Stop"));
  begin_->setToolTip(headset_ ? QString() : tr("Put the headset on first (F9)"));
  here_->setVisible(touching_);
  by_hand_->setVisible(!touching_);
  by_hand_->setEnabled(arm_.has_value());
  forget_->setVisible(!touching_);
  forget_->setEnabled(where.has_value());
  if (touching_) {
    return words_->setText(
        tr("Hold the tip at the cross of mark %1 of 3, then press the arm's button, or Space.")
            .arg(touched_m_.size() + 1));
  }
  if (!arm_) return words_->clear();
  if (!where) return words_->setText(tr("Where it stands in a headset's room is not known."));
  if (!where->error_mm) {
    return words_->setText(
        tr("Its place in a headset's room was set by hand: how well, nobody "
           "has measured."));
  }
  words_->setText(
      *where->error_mm > kPoor_mm
          ? tr("In a headset's room it is likely to be seen %1 mm from where it is: touch "
               "the marks again, each at its cross.")
                .arg(*where->error_mm, 0, 'f', 1)
          : tr("In a headset's room it is likely to be seen %1 mm from where it is.")
                .arg(*where->error_mm, 0, 'f', 1));
}

}  // namespace trephine
