#include "ui/train/start_card.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

#include "ui/common/making.h"
#include "ui/common/words.h"
#include "ui/train/exercise_panel.h"

namespace trephine {

namespace {
constexpr int kStartWidest = 560;
}  // namespace

StartCard::StartCard(QWidget& over) : FloatingCard(over, At::middle, kStartWidest) {
  setObjectName("startCard");
  title_ = named(new QLabel, "startCardTitle", {"heading"});
  goal_ = named(new QLabel, "startCardGoal", {"large"});
  steps_ = named(new QLabel, "startCardSteps");
  steps_->setTextFormat(Qt::RichText);  // a numbered list, of escaped steps
  hands_ = named(new QLabel, "startCardHands");
  keys_ = looking(
      new QLabel(
          tr("Without arms the mouse is the hand: move it over the tissue, turn the wheel up "
             "to press, change hands with Tab. By keys alone: arrows, Page Down to press, Page "
             "Up to ease, Shift and arrows to tilt.")),
      {"quiet"});
  for (QLabel* label : {title_, goal_, steps_, hands_, keys_}) label->setWordWrap(true);
  start_ = named(new QPushButton(tr("&Start (F5)")), "startCardStart", {"primary", "big"});
  choose_ = named(new QPushButton(tr("&Choose a case")), "startCardChoose", {"primary", "big"});
  aside_ = named(new QPushButton(tr("Put &aside (Esc)")), "startCardAside", {"big"});
  aside_->setToolTip(tr("Shows what lies behind; the panel at the left brings it back"));
  auto* buttons = new QHBoxLayout;
  buttons->addStretch(1);
  addAll(*buttons, {start_, choose_, aside_});
  buttons->addStretch(1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(20, 16, 20, 16);
  layout->setSpacing(10);
  addAll(*layout, {title_, goal_, steps_, hands_, keys_});
  layout->addLayout(buttons);
  connect(start_, &QPushButton::clicked, this, &StartCard::startWanted);
  connect(choose_, &QPushButton::clicked, this, &StartCard::caseWanted);
  connect(aside_, &QPushButton::clicked, this, &StartCard::asideWanted);
}

void StartCard::showNoCase() {
  title_->setText(tr("No case is open"));
  goal_->setText(tr("Choose one of your own or a built-in one."));
  for (QWidget* part :
       {static_cast<QWidget*>(steps_), static_cast<QWidget*>(hands_), static_cast<QWidget*>(keys_),
        static_cast<QWidget*>(start_), static_cast<QWidget*>(aside_)}) {
    part->hide();
  }
  choose_->show();
  show();
  place();
}

void StartCard::showExercise(const Exercise& exercise, const QString& language, bool may_start) {
  const CardText* card = cardFor(exercise, language.toStdString());
  title_->setText(toQt(exercise.name));
  goal_->setText(card ? toQt(card->goal) : tr("Cut as the exercise's name says."));
  steps_->setText(card ? stepsWords(*card) : QString());
  hands_->setText(card && !card->hands.empty() ? toQt(card->hands) : toolWords(exercise));
  start_->show();
  start_->setEnabled(may_start);
  aside_->show();
  choose_->hide();
  show();
  place();
}

// What has no room stands in the panel at the left.
void StartCard::fit(int width, int most_height) {
  if (start_->isHidden()) return;
  for (QLabel* part : {steps_, hands_, keys_}) part->setVisible(!part->text().isEmpty());
  for (QLabel* part : {keys_, hands_, steps_}) {
    layout()->activate();
    if (layout()->totalHeightForWidth(width) <= most_height) break;
    part->hide();
  }
  emit fitted();
}

bool StartCard::saysAll() const {
  const auto said = [](const QLabel* part) { return part->text().isEmpty() || !part->isHidden(); };
  return !isHidden() && !start_->isHidden() && said(steps_) && said(hands_);
}

}  // namespace trephine
