#include "ui/work/opening_card.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

#include "ui/common/making.h"

namespace trephine {

namespace {
constexpr int kCardWidest = 420, kOpeningSteps = 1000;
}

OpeningCard::OpeningCard(QWidget& over, Workstation& workstation)
    : FloatingCard(over, At::middle, kCardWidest), workstation_(workstation) {
  setObjectName("openingCard");
  title_ = named(new QLabel(tr("Opening\u2026")), "openingTitle", {"heading"});
  step_ = wrapped(named(new QLabel, "openingStep", {"quiet"}));
  progress_ = thinProgress("openingProgress", kOpeningSteps);
  auto* cancel = namedButton("openingCancel", tr("&Cancel"));
  auto* row = new QHBoxLayout;
  row->addWidget(progress_, 1);
  row->addWidget(cancel);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(20, 16, 20, 16);
  layout->setSpacing(10);
  addAll(*layout, {title_, step_});
  layout->addLayout(row);
  connect(cancel, &QPushButton::clicked, this, [this] { workstation_.cancelOpening(); });
  connect(&workstation_, &Workstation::exerciseOpening, this, [this](const Exercise& exercise) {
    title_->setText(tr("Opening \"%1\"\u2026").arg(toQt(exercise.name)));
  });
  connect(&workstation_, &Workstation::phaseChanged, this, [this] {
    if (workstation_.opensAnotherCase() && isHidden()) show(0.0, {});
  });
  connect(&workstation_, &Workstation::openingProgressed, this,
          [this](double fraction, const QString& step) {
            if (workstation_.opensAnotherCase()) show(fraction, step);
          });
  connect(&workstation_, &Workstation::openingEnded, this, [this] {
    hide();
    title_->setText(tr("Opening\u2026"));
  });
}

void OpeningCard::show(double fraction, const QString& step) {
  step_->setText(step);
  progress_->setValue(int(fraction * kOpeningSteps));
  if (!isHidden()) return;
  setVisible(true);
  place();
}

}  // namespace trephine
