#include "ui/frame/status_line.h"

#include <QHBoxLayout>
#include <QPushButton>

#include "ui/commission/fitness_line.h"
#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/words.h"
#include "ui/headset/headset_view.h"
#include "ui/headset/stereo_view.h"

namespace trephine {

namespace {

constexpr int kProgressSteps = 1000, kProgressWidth = 140;

QLabel* elided(const char* name, bool quiet = true) {
  auto* label = named(new ElidedLabel, name);
  if (quiet) label->setProperty("quiet", true);
  return label;
}

}  // namespace

StatusLine::StatusLine(AppContext& app, const HeadsetView& headset, const StereoView& stereo)
    : app_(app), headset_(headset), stereo_(stereo) {
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);  // no words make the window wider
  hint_ = elided("hint");
  hint_->setContentsMargins(6, 0, 0, 0);
  opening_ = thinProgress("openProgress", kProgressSteps);
  opening_->setFixedWidth(kProgressWidth);
  auto* cancel = namedButton("cancelOpening", tr("Cancel"));
  opening_box_ = new QWidget;
  opening_words_ = elided("openWords", false);
  auto* opening_row = tight(new QHBoxLayout(opening_box_));
  addAll(*opening_row, {opening_words_, opening_, cancel});
  opening_box_->hide();
  eyes_ = elided("eyes");
  eyes_->hide();
  rates_ = elided("rates");
  locked_ = namedLabel("locked");
  locked_->setContentsMargins(8, 0, 8, 0);
  colours::setText(*locked_, colours::kCaution);
  auto* purpose = named(new QLabel(purposeText()), "purpose");
  purpose->setContentsMargins(12, 0, 6, 0);
  Workstation& workstation = app.workstation();
  fitness_ = new FitnessLine(workstation, app.caseViews().view(), app.storage());
  addWidget(hint_, 1);
  addWidget(fitness_, 1);
  for (QWidget* part :
       std::initializer_list<QWidget*>{opening_box_, eyes_, rates_, locked_, purpose})
    addPermanentWidget(part);
  showLocks();

  connect(&app.messages(), &Messages::said, this, [this](const QString& text) {
    constexpr int kMessage_ms = 15000;
    text.isEmpty() ? clearMessage() : showMessage(text, kMessage_ms);
  });
  // What is said needs the room.
  connect(this, &QStatusBar::messageChanged, this, [this](const QString& said) {
    rates_->setVisible(said.isEmpty());
    showHint();
    showEyes();
  });
  connect(&app.messages(), &Messages::hinted, this, [this](const QString& words) {
    hint_words_ = words;
    showHint();
  });
  connect(&app.caseViews().views(), &FourUp::helpChanged, this, [this](const QString& words) {
    help_words_ = words;
    showHint();
  });
  connect(&headset, &HeadsetView::changed, this, &StatusLine::showEyes);
  connect(&stereo, &StereoView::changed, this, &StatusLine::showEyes);
  connect(&app.caseViews().view(), &ViewWidget::framePainted, this,
          [this](double ms) { panel_ms_ = ms; });
  connect(&workstation, &Workstation::locksChanged, this, &StatusLine::showLocks);
  connect(&workstation, &Workstation::openingProgressed, this,
          [this](double fraction, const QString& step) {
            if (app_.workstation().isPlacing()) return;  // a moment, of what is on the screen
            showProgress(fraction, step);
          });
  connect(&workstation, &Workstation::savingProgressed, this,
          [this](double fraction, const QString& step) {
            app_.messages().say(tr("%1\u2026 %2 %").arg(step).arg(int(100.0 * fraction)));
            showProgress(fraction, {});  // in the line beside it
          });
  for (auto ended : {&Workstation::openingEnded, &Workstation::savingEnded}) {
    connect(&workstation, ended, opening_box_, &QWidget::hide);
  }
  connect(cancel, &QPushButton::clicked, this, [this] {
    app_.workstation().cancelOpening();
    app_.workstation().cancelSaving();
  });
}

void StatusLine::showProgress(double fraction, const QString& step) {
  opening_box_->show();
  opening_words_->setText(step);
  opening_->setValue(int(fraction * kProgressSteps));
}

void StatusLine::setPlace(Place place, bool views) {
  place_ = place;
  views_ = views;
  showHint();
}

void StatusLine::showHint() {
  hint_->setText(!views_ ? QString() : !help_words_.isEmpty() ? help_words_ : hint_words_);
  // A message stands in their place.
  const bool free = currentMessage().isEmpty(), first = place_ == Place::cases;
  fitness_->setVisible(free && first);
  hint_->setVisible(free && !first);
}

// What is read by both eyes, and what the window itself takes.
void StatusLine::showEyes() {
  QStringList words{headset_.isOn() ? headset_.words() : stereo_.words()};
  if (words.front().isEmpty()) {
    eyes_->hide();
    return eyes_->clear();
  }
  // While it shows what an eye sees it draws nothing itself.
  if (panel_ms_ >= 0.05) words << tr("window %1 ms").arg(panel_ms_, 0, 'f', 1);
  eyes_->setText(words.join(QStringLiteral(" \u00b7 ")));
  eyes_->setVisible(currentMessage().isEmpty());
}

void StatusLine::showLocks() {
  const bool unlocked = app_.workstation().isUnlocked();
  locked_->setVisible(unlocked || app_.workstation().anyLocked());
  locked_->setText(unlocked ? tr("Unlocked") : tr("Locked"));
  const Policy& policy = app_.workstation().policy();
  locked_->setToolTip(unlocked ? tr("Until it is locked again (menu File), or Trephine is closed")
                      : policy.locks.empty() ? tr("This exercise keeps what it was saved with. It "
                                                  "is changed in Prepare.")
                                             : unlockWords(policy));
}

}  // namespace trephine
