#include "ui/cases/cases_page.h"

#include <QGridLayout>
#include <QVBoxLayout>

#include "ui/common/icons.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kProgressSteps = 1000;

QLabel* quietLabel(const QString& text, QWidget* parent) {
  auto* label = new QLabel(text, parent);
  label->setProperty("quiet", true);
  label->setWordWrap(true);
  return label;
}

}  // namespace

CasesPage::CasesPage(QWidget* parent) : QWidget(parent) {
  folder_ = new QPushButton(symbolIcon(Symbol::open), tr("Open folder of CT\u2026"), this);
  folder_->setObjectName("openFolder");
  series_ = new QPushButton(tr("Use another series\u2026"), this);
  series_->setObjectName("anotherSeries");
  cranium_ = new QPushButton(tr("Cranium phantom"), this);
  cranium_->setObjectName("craniumPhantom");
  abdomen_ = new QPushButton(tr("Abdomen phantom"), this);
  abdomen_->setObjectName("abdomenPhantom");

  auto* card = new QFrame(this);
  card->setProperty("card", true);
  case_ =
      new QLabel(tr("No case is open.\nOpen a folder of CT, or drop one on this window."), card);
  case_->setObjectName("caseLabel");
  case_->setTextFormat(Qt::PlainText);
  case_->setWordWrap(true);
  auto* card_layout = new QVBoxLayout(card);
  card_layout->addWidget(case_);

  step_ = quietLabel({}, this);
  progress_ = new QProgressBar(this);
  progress_->setObjectName("openProgress");
  progress_->setRange(0, kProgressSteps);
  progress_->setTextVisible(false);
  progress_->setMaximumHeight(14);
  cancel_ = new QPushButton(tr("Cancel"), this);
  cancel_->setObjectName("cancelOpening");
  progress_box_ = new QWidget(this);
  auto* progress_row = new QGridLayout(progress_box_);
  progress_row->setContentsMargins(0, 0, 0, 0);
  progress_row->addWidget(step_, 0, 0, 1, 2);
  progress_row->addWidget(progress_, 1, 0);
  progress_row->addWidget(cancel_, 1, 1);
  progress_box_->hide();

  auto* built_in = new QHBoxLayout;
  built_in->addWidget(cranium_);
  built_in->addWidget(abdomen_);

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(8);
  layout->addWidget(card);
  layout->addWidget(progress_box_);
  layout->addWidget(folder_);
  layout->addWidget(series_);
  layout->addSpacing(4);
  layout->addWidget(quietLabel(tr("Built-in cases"), this));
  layout->addLayout(built_in);
  layout->addStretch(1);

  connect(folder_, &QPushButton::clicked, this, &CasesPage::folderWanted);
  connect(series_, &QPushButton::clicked, this, &CasesPage::seriesWanted);
  connect(cranium_, &QPushButton::clicked, this, [this] { emit phantomWanted("cranium"); });
  connect(abdomen_, &QPushButton::clicked, this, [this] { emit phantomWanted("abdomen"); });
  connect(cancel_, &QPushButton::clicked, this, &CasesPage::cancelWanted);
  showButtons();
}

void CasesPage::showCase(const QString& what) {
  case_->setText(what);
}

void CasesPage::setSeriesAtHand(bool at_hand) {
  at_hand_ = at_hand;
  showButtons();
}

void CasesPage::showProgress(double fraction, const QString& step) {
  busy_ = true;
  progress_box_->show();
  step_->setText(step);
  progress_->setValue(int(fraction * kProgressSteps));
  showButtons();
}

void CasesPage::endProgress() {
  busy_ = false;
  progress_box_->hide();
  showButtons();
}

void CasesPage::setOpeningAllowed(bool allowed) {
  allowed_ = allowed;
  showButtons();
}

void CasesPage::showButtons() {
  const bool may = allowed_ && !busy_;
  for (QPushButton* button : {folder_, cranium_, abdomen_}) button->setEnabled(may);
  series_->setVisible(at_hand_);
  series_->setEnabled(may);
}

QString caseWords(const Case& of) {
  QString about = sizeWords(of.volume->geometry);
  if (!of.name.empty()) about = toQt(of.name) + '\n' + about;
  if (of.anatomy) {
    switch (of.anatomy->region) {
      case BodyRegion::head:
        about += of.anatomy->vault ? CasesPage::tr("\nA head") : CasesPage::tr("\nA head whose vault is not whole");
        break;
      case BodyRegion::abdomen:
        about += CasesPage::tr("\nAn abdomen");
        break;
      case BodyRegion::not_sure:
        about += CasesPage::tr("\nWhat it shows is not known");
    }
  }
  if (of.structures && !of.structures->structures.empty()) {
    QStringList names;
    for (const Structure& s : of.structures->structures) names << toQt(s.name);
    constexpr int kMost = 6;
    const int more = int(names.size()) - kMost;
    about += CasesPage::tr("\nwith %1").arg(QStringList(names.mid(0, kMost)).join(", "));
    if (more > 0) about += CasesPage::tr(" and %1 more").arg(more);
  }
  return about;
}

}  // namespace trephine
