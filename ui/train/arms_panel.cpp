#include "ui/train/arms_panel.h"

#include <QAbstractItemView>
#include <QFormLayout>
#include <QFrame>
#include <QScrollArea>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/plain_text.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr double kMilli = 1000.0;

QLabel* value(QWidget* parent, const QString& name) {
  auto* label = named(new QLabel(parent), name);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

QLabel* quiet(const QString& text, QWidget* parent) {
  return looking(new QLabel(text, parent), {"quiet"});
}

QString newtons(double force_N) {
  return ArmsPanel::tr("%1 N").arg(force_N, 0, 'f', 2);
}

}  // namespace

QString armName(const ExerciseArm& arm) {
  if (arm.name == "left") return ArmsPanel::tr("Left arm");
  if (arm.name == "right") return ArmsPanel::tr("Right arm");
  return toQt(arm.name);
}

QString toolWaitsWords() {
  return ArmsPanel::tr("Take the tool out of the tissue: then it is changed.");
}

QString forceScaleWords(const ExerciseArm& arm) {
  const double force = arm.map.fixed ? arm.map.fixed->force_scale : arm.map.force_scale;
  // In general: what is changed just now stands at "Force is".
  if (force == 1.0) return ArmsPanel::tr("Felt = modelled, up to what the arm can show");
  return ArmsPanel::tr("Felt = %1 x modelled, up to what the arm can show").arg(force, 0, 'g', 3);
}

ArmsPanel::ArmsPanel(QWidget* parent) : QWidget(parent) {
  auto* inside = new QWidget(this);
  cards_layout_ = new QVBoxLayout(inside);
  cards_layout_->setContentsMargins(6, 8, 6, 8);
  cards_layout_->setSpacing(10);
  auto* area = new QScrollArea(this);
  area->setFocusPolicy(Qt::TabFocus);
  area->setWidget(inside);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);

  controller_ = named(new QComboBox(inside), "controller");
  controller_->setFocusPolicy(Qt::TabFocus);  // a click leaves the keys with the hands
  controller_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  for (const auto& [name, kind] : kControllerNames) {
    controller_->addItem(controllerWord(kind), int(kind));
    controller_->setItemData(controller_->count() - 1, controllerMeaning(kind), Qt::ToolTipRole);
  }
  controller_->setCurrentIndex(-1);  // until an exercise says which
  missed_ = value(inside, "missedDeadlines");
  dropped_ = value(inside, "dropped");
  for (QLabel* label : {missed_, dropped_}) label->setWordWrap(true);
  journal_ = wrapped(
      new QLabel(tr("The way back can no longer be kept on the disk: nothing more is removed. Undo "
                    "and rewind still work. Free some space, then start the exercise anew."),
                 inside));
  colours::setText(*journal_, colours::kBad);
  journal_->hide();

  auto* common = new QFormLayout;
  common->setVerticalSpacing(6);
  common->addRow(quiet(tr("Kept steady by"), inside), controller_);
  common->addRow(quiet(tr("Force in time"), inside), missed_);
  common->addRow(quiet(tr("Recording"), inside), dropped_);
  cards_layout_->addLayout(common);
  cards_layout_->addWidget(journal_);
  cards_layout_->addStretch(1);

  auto* layout = tight(new QVBoxLayout(this));
  layout->addWidget(area);

  // Of the widest row, with its frames and the scroll bar: what does not fit would be cut off.
  constexpr int kLeast = 262, kAround = 52;
  ensurePolished();
  const QString row =
      tr("%1 of %2").arg(newtons(0.0), newtons(0.0)) + tr("demanded %1").arg(newtons(10.0));
  setMinimumWidth(std::max(kLeast, kAround + fontMetrics().horizontalAdvance(row)));
  connect(controller_, &QComboBox::activated, this,
          [this] { emit controllerWanted(ControllerKind(controller_->currentData().toInt())); });
  showIdle();
}

void ArmsPanel::setExercise(const Exercise& exercise) {
  for (QWidget* card : card_widgets_) delete card;
  card_widgets_.clear();
  cards_.clear();
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) cards_.push_back(addCard(exercise, i));
  period_s_ = 1.0 / exercise.rate_hz;
  controller_->setCurrentIndex(controller_->findData(int(exercise.controller)));
  showIdle();
}

ArmsPanel::Card ArmsPanel::addCard(const Exercise& exercise, std::size_t index) {
  const ExerciseArm& arm = exercise.arms[index];
  auto* frame = looking(new QFrame(this), {"card"});
  const QString prefix = toQt(arm.name);
  auto* title = looking(new QLabel(armName(arm), frame), {"title"});
  colours::setText(*title, colours::ofArm(arm, index));

  Card card{value(frame, prefix + "Contact"),
            value(frame, prefix + "Position"),
            value(frame, prefix + "Force"),
            value(frame, prefix + "Demanded"),
            value(frame, prefix + "Energy"),
            value(frame, prefix + "Parts"),
            value(frame, prefix + "Faults"),
            new QComboBox(frame),
            value(frame, prefix + "ToolWaits"),
            new ForceBar(frame),
            new TraceView(tr("Force"), tr("N"), 0.0, arm.max_force_N, frame),
            new TraceView(tr("Energy given out"), tr("mJ"), -10.0, 2.0, frame),
            arm.map.force_scale / arm.map.motion_scale,
            {}};
  card.bar->setObjectName(prefix + "ForceBar");
  card.bar->setToolTip(
      tr("Bar: the force sent, against the arm's limit. Mark: the force demanded."));
  card.energy->setToolTip(inLines(tr(
      "Net work that the sent force did on the hand since the start; below zero where the "
      "hand worked on the tissue. A little above zero is no fault: the encoder hides about 0.1 mJ "
      "of each contact, and a force that comes back after a pause or a change gives out what the "
      "tissue holds.\n\nRed: just now the arm gives out more than 1 mJ a second beyond what "
      "was pressed into the tissue. It shakes or pushes by itself.")));
  card.position->setToolTip(tr("Tip of the tool in the patient, mm: left, posterior, superior."));
  card.parts->setWordWrap(true);
  card.parts->setMinimumHeight(2 * card.parts->fontMetrics().lineSpacing());  // or all below moves
  card.parts->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  card.parts->setToolTip(inLines(forceChangeMeanings()));
  card.faults->setWordWrap(true);
  colours::setText(*card.faults, colours::kBad);

  card.tool->setObjectName(prefix + "Tool");
  card.tool->setFocusPolicy(Qt::TabFocus);
  card.tool->setAccessibleName(tr("Tool"));
  card.tool->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  for (std::size_t n = 0; n <= arm.other_tools.size(); ++n) {
    if (const ExerciseTool* tool = exercise.toolOf(index, n)) card.tool->addItem(toolWord(*tool));
  }
  card.tool->setToolTip(arm.other_tools.empty()
                            ? tr("The exercise has one tool for this arm")
                            : tr("Which tool the hand has, while the exercise runs"));
  card.tool_waits->setWordWrap(true);
  card.tool_waits->setText(toolWaitsWords());
  colours::setText(*card.tool_waits, colours::kCaution);
  connect(card.tool, &QComboBox::activated, this,
          [this, index](int number) { emit toolWanted(index, std::size_t(number)); });

  for (TraceView* trace : {card.force_trace, card.energy_trace}) {
    trace->setColour(colours::ofArm(arm, index));
  }
  card.force_trace->setObjectName(prefix + "ForceTrace");
  card.energy_trace->setObjectName(prefix + "EnergyTrace");
  card.force_trace->setToolTip(tr("Line: the force sent. Grey: the force demanded."));
  card.energy_trace->setToolTip(card.energy->toolTip());
  auto* scale = quiet(forceScaleWords(arm), frame);
  scale->setObjectName(prefix + "Scale");
  scale->setWordWrap(true);

  auto* force_row = new QHBoxLayout;
  force_row->addWidget(card.force, 1);
  force_row->addWidget(card.demanded);
  auto* form = new QFormLayout;
  form->setVerticalSpacing(4);
  form->addRow(quiet(tr("Touches"), frame), card.contact);
  form->addRow(quiet(tr("Tip"), frame), card.position);
  form->addRow(quiet(tr("Energy"), frame), card.energy);
  QLabel* changed = quiet(tr("Force is"), frame);
  changed->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  form->addRow(changed, card.parts);
  auto* layout = new QVBoxLayout(frame);
  layout->setContentsMargins(8, 8, 8, 8);
  layout->setSpacing(6);
  auto* head = new QHBoxLayout;
  head->addWidget(title);
  head->addWidget(card.tool, 1);
  layout->addLayout(head);
  layout->addWidget(card.bar);
  layout->addLayout(force_row);
  layout->addWidget(card.force_trace);
  layout->addWidget(scale);
  layout->addLayout(form);
  layout->addWidget(card.energy_trace);
  layout->addWidget(card.tool_waits);
  layout->addWidget(card.faults);
  cards_layout_->insertWidget(int(index), frame);
  card_widgets_.push_back(frame);
  return card;
}

void ArmsPanel::showState(const LoopState& state, const TissueSet& tissues,
                          const std::vector<double>& limits_N) {
  const double now_s = double(state.ticks) * period_s_;
  for (std::size_t i = 0; i < cards_.size() && i < limits_N.size(); ++i) {
    const ArmRecord& arm = state.record.arms[i];
    Card& card = cards_[i];
    const double sent_N = glm::length(arm.sent_N), demanded_N = glm::length(arm.demanded_N);
    card.bar->setForce(sent_N, demanded_N, limits_N[i]);
    card.force_trace->update();
    card.energy_trace->update();
    card.force->setText(tr("%1 of %2").arg(newtons(sent_N), newtons(limits_N[i])));
    card.demanded->setText(tr("demanded %1").arg(newtons(demanded_N)));
    const Vec3& p = arm.proxy_position_mm;
    card.position->setText(
        tr("%1, %2, %3 mm").arg(p.x, 0, 'f', 1).arg(p.y, 0, 'f', 1).arg(p.z, 0, 'f', 1));
    const double energy_J = arm.energy_out_J.x + arm.energy_out_J.y + arm.energy_out_J.z;
    const bool gives_out = card.watch.look(arm, card.device_per_model, state.paused, now_s);
    const double tenths = std::round(10.0 * kMilli * energy_J) + 0.0;  // no "-0.0"
    card.energy->setText(tr("%1 mJ").arg(0.1 * tenths, 0, 'f', 1));
    colours::setText(*card.energy, gives_out ? colours::kBad : colours::kText);
    card.parts->setText(forceChangeWords(arm, state.paused));
    // As high as it ever was, or all below would jump.
    const int high = card.parts->heightForWidth(card.parts->width());
    if (high > card.parts->minimumHeight()) card.parts->setMinimumHeight(high);
    showTool(card, state.tools[i], state.wanted_tools[i]);
    card.tool->setEnabled(card.tool->count() > 1);
    const QString touched = touchedName(arm, tissues);
    card.contact->setText(touched.isEmpty() ? tr("nothing") : touched);
    colours::setText(*card.contact, touched.isEmpty() ? colours::kQuiet : colours::kText);
    QStringList wrong;
    if (arm.faults != 0) wrong << faultWords(arm.faults);
    if (gives_out) {
      wrong << (state.controller == ControllerKind::bounded
                    ? tr("The arm gives out energy: it shakes or pushes by itself.")
                    : tr("The arm gives out energy: it shakes or pushes by itself. Let it be "
                         "kept steady by '%1'.")
                          .arg(controllerWord(ControllerKind::bounded)));
    }
    if (card.soft.look(arm, now_s)) {
      wrong << tr(
          "Tissue is felt much softer here: the arm shook. Hold it firmer, or lift it out "
          "and come back.");
    }
    if (arm.controller_parts & kPartArmNotAsStated) {
      wrong << tr("The arm's mass or delay is not what its device file states.");
    }
    card.faults->setText(wrong.join('\n'));
    card.faults->setVisible(!wrong.isEmpty());
  }
  const double late_share = double(state.missed) / double(std::max<std::uint64_t>(1, state.ticks));
  missed_->setText(
      state.missed == 0
          ? tr("always")
          : tr("%1 times late (%2 %)").arg(state.missed).arg(100.0 * late_share, 0, 'f', 2));
  colours::setText(*missed_, state.missed > 0 ? colours::kCaution : colours::kText);
  dropped_->setText(state.dropped == 0 ? tr("whole") : tr("not whole: it cannot be replayed"));
  colours::setText(*dropped_, state.dropped > 0 ? colours::kBad : colours::kText);
  journal_->setVisible(state.journal_full);
  if (state.ticks > 0) showController(state.controller);  // before, it is not known
}

void ArmsPanel::showUnrecorded() {
  dropped_->setText(tr("stopped: what follows is not recorded"));
  colours::setText(*dropped_, colours::kBad);
}

void ArmsPanel::follow(const LoopState& state) {
  if (state.ticks == 0 || state.ticks == traced_tick_) return;
  traced_tick_ = state.ticks;
  const double now_s = double(state.ticks) * period_s_;
  for (std::size_t i = 0; i < cards_.size(); ++i) {
    const ArmRecord& arm = state.record.arms[i];
    cards_[i].force_trace->add(now_s, glm::length(arm.sent_N), glm::length(arm.demanded_N));
    const double energy_J = arm.energy_out_J.x + arm.energy_out_J.y + arm.energy_out_J.z;
    cards_[i].energy_trace->add(now_s, kMilli * energy_J);
  }
}

void ArmsPanel::showTool(Card& card, std::int32_t in_hand, std::int32_t wanted) {
  // A person may be choosing.
  if (!card.tool->view()->isVisible()) card.tool->setCurrentIndex(in_hand);
  card.tool_waits->setVisible(wanted != in_hand);
}

void ArmsPanel::setLocked(const QString& why) {
  controller_->setEnabled(why.isEmpty());
  controller_->setToolTip(why);
}

void ArmsPanel::showController(std::optional<ControllerKind> kind) {
  if (!controller_->view()->isVisible()) {  // a person may be choosing
    controller_->setCurrentIndex(kind ? controller_->findData(int(*kind)) : -1);
  }
}

void ArmsPanel::showIdle() {
  for (Card& card : cards_) {
    card.watch = EnergyWatch();
    card.bar->setForce(0.0, 0.0, 1.0);
    for (QLabel* label : {card.contact, card.position, card.energy, card.parts, card.force}) {
      label->setText(QStringLiteral("\u2013"));
    }
    colours::setText(*card.energy, colours::kText);
    card.demanded->clear();
    card.faults->hide();
    showTool(card, 0, 0);
    card.tool->setEnabled(false);
  }
  missed_->setText(QStringLiteral("\u2013"));
  dropped_->setText(QStringLiteral("\u2013"));
  journal_->hide();
}

}  // namespace trephine
