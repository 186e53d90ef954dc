#include "ui/case_panel.h"

#include <QGridLayout>
#include <QHeaderView>
#include <QScrollArea>
#include <QVBoxLayout>

#include "ui/colours.h"
#include "ui/icons.h"
#include "ui/words.h"

namespace trephine {

namespace {

constexpr int kUid = Qt::UserRole;
constexpr int kProgressSteps = 1000;

QColor verdictColour(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return colours::kGood;
    case Verdict::repaired:
      return colours::kCaution;
    case Verdict::refused:
      return colours::kBad;
  }
  return colours::kText;
}

QLabel* quietLabel(QWidget* parent) {
  auto* label = new QLabel(parent);
  label->setProperty("quiet", true);
  label->setWordWrap(true);
  return label;
}

}  // namespace

CasePanel::CasePanel(QWidget* parent) : QWidget(parent) {
  folder_ = new QPushButton(symbolIcon(Symbol::open), tr("Open folder of CT\u2026"), this);
  folder_->setObjectName("openFolder");
  cranium_ = new QPushButton(tr("Cranium phantom"), this);
  cranium_->setObjectName("craniumPhantom");
  abdomen_ = new QPushButton(tr("Abdomen phantom"), this);
  abdomen_->setObjectName("abdomenPhantom");

  labels_ = new QPushButton(tr("Label map\u2026"), this);
  labels_->setObjectName("openLabels");
  labels_->setToolTip(tr("Open the case's label map, to which tissues can be restricted"));

  case_ = new QLabel(tr("No case is open."), this);
  case_->setObjectName("caseLabel");
  case_->setWordWrap(true);

  step_ = quietLabel(this);
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

  series_ = new QTreeWidget(this);
  series_->setObjectName("seriesList");
  series_->setHeaderLabels({tr("Series"), tr("Slices"), tr("Verdict")});
  series_->setRootIsDecorated(false);
  series_->setUniformRowHeights(true);
  series_->header()->setStretchLastSection(false);
  series_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
  series_->header()->setSectionResizeMode(1, QHeaderView::ResizeToContents);
  series_->header()->setSectionResizeMode(2, QHeaderView::ResizeToContents);
  use_series_ = new QPushButton(tr("Use this series"), this);
  use_series_->setObjectName("useSeries");
  use_series_->setEnabled(false);
  skipped_ = quietLabel(this);
  details_ = quietLabel(this);
  details_->setObjectName("seriesDetails");
  details_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  details_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  details_->setMargin(2);
  auto* details_area = new QScrollArea(this);
  details_area->setWidget(details_);
  details_area->setWidgetResizable(true);
  details_area->setFrameShape(QFrame::NoFrame);
  details_area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);

  auto* built_in_title = new QLabel(tr("Built-in cases"), this);
  built_in_title->setProperty("quiet", true);
  auto* built_in = new QHBoxLayout;
  built_in->addWidget(cranium_);
  built_in->addWidget(abdomen_);

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(8);
  layout->addWidget(folder_);
  layout->addWidget(built_in_title);
  layout->addLayout(built_in);
  layout->addSpacing(4);
  layout->addWidget(case_);
  layout->addWidget(labels_);
  layout->addWidget(progress_box_);
  layout->addWidget(series_, 1);
  layout->addWidget(use_series_);
  layout->addWidget(skipped_);
  layout->addWidget(details_area, 1);

  connect(folder_, &QPushButton::clicked, this, &CasePanel::folderWanted);
  connect(cranium_, &QPushButton::clicked, this, [this] { emit phantomWanted("cranium"); });
  connect(abdomen_, &QPushButton::clicked, this, [this] { emit phantomWanted("abdomen"); });
  connect(labels_, &QPushButton::clicked, this, &CasePanel::labelsWanted);
  connect(cancel_, &QPushButton::clicked, this, &CasePanel::cancelWanted);
  connect(series_, &QTreeWidget::itemSelectionChanged, this, &CasePanel::showDetails);
  const auto want_selected = [this] {
    if (use_series_->isEnabled())
      emit seriesWanted(series_->currentItem()->data(0, kUid).toString());
  };
  connect(series_, &QTreeWidget::itemActivated, this, want_selected);
  connect(use_series_, &QPushButton::clicked, this, want_selected);
  forgetReport();
}

void CasePanel::showReport(const ImportReport& report) {
  report_ = report;
  series_->clear();
  for (const SeriesReport& one : report_.series) {
    const QString description = one.description.empty()
                                    ? tr("%1 without description").arg(toQt(one.modality))
                                    : toQt(one.description);
    auto* item = new QTreeWidgetItem(
        series_, {description, QString::number(one.geometry.size[2]), verdictWord(one.verdict)});
    item->setData(0, kUid, toQt(one.uid));
    item->setForeground(2, verdictColour(one.verdict));
    item->setTextAlignment(1, Qt::AlignRight | Qt::AlignVCenter);
    QFont bold = font();
    bold.setBold(true);
    item->setFont(2, bold);
    const QString findings = findingWords(one);
    for (int column = 0; column < 3; ++column) {
      item->setToolTip(column, findings.isEmpty() ? tr("Nothing to remark.") : findings);
    }
  }
  QStringList skipped;
  for (const SkippedFiles& files : report_.skipped) {
    skipped << tr("%1 skipped: %2").arg(files.count).arg(toQt(files.reason));
  }
  skipped_->setText(skipped.join('\n'));
  skipped_->setVisible(!skipped.isEmpty());
  series_->setVisible(true);
  use_series_->setVisible(true);
  showChosen(chosen_);
  if (!series_->currentItem() && series_->topLevelItemCount() > 0) {
    series_->setCurrentItem(series_->topLevelItem(0));
  }
  showDetails();
}

void CasePanel::showChosen(const QString& uid) {
  chosen_ = uid;
  for (int row = 0; row < series_->topLevelItemCount(); ++row) {
    QTreeWidgetItem* item = series_->topLevelItem(row);
    if (item->data(0, kUid).toString() == uid) series_->setCurrentItem(item);
  }
  showButtons();
}

void CasePanel::forgetReport() {
  report_ = {};
  chosen_.clear();
  series_->clear();
  series_->hide();
  use_series_->hide();
  skipped_->hide();
  details_->clear();
}

void CasePanel::showCase(const QString& what) {
  case_->setText(what);
}

void CasePanel::showProgress(double fraction, const QString& step) {
  busy_ = true;
  progress_box_->show();
  step_->setText(step);
  progress_->setValue(int(fraction * kProgressSteps));
  showButtons();
}

void CasePanel::endProgress() {
  busy_ = false;
  progress_box_->hide();
  showButtons();
}

void CasePanel::setOpeningAllowed(bool allowed) {
  allowed_ = allowed;
  showButtons();
}

const SeriesReport* CasePanel::selected() const {
  const QTreeWidgetItem* item = series_->currentItem();
  if (!item) return nullptr;
  const int row = series_->indexOfTopLevelItem(const_cast<QTreeWidgetItem*>(item));
  return row >= 0 && std::size_t(row) < report_.series.size() ? &report_.series[std::size_t(row)]
                                                              : nullptr;
}

void CasePanel::showDetails() {
  showButtons();
  const SeriesReport* one = selected();
  if (!one) return details_->clear();
  QStringList lines;
  lines << toQt(one->modality) << sizeWords(one->geometry);
  if (one->hu_min && one->hu_max) lines << tr("HU %1 to %2").arg(*one->hu_min).arg(*one->hu_max);
  if (one->tilt_deg != 0.0) lines << tr("Gantry tilt %1\u00b0").arg(one->tilt_deg, 0, 'f', 1);
  if (one->lossy) lines << tr("Was compressed with loss");
  const QString findings = findingWords(*one);
  lines << (findings.isEmpty() ? tr("Nothing to remark.") : findings);
  details_->setText(lines.join('\n'));
}

void CasePanel::showButtons() {
  const bool may = allowed_ && !busy_;
  folder_->setEnabled(may);
  cranium_->setEnabled(may);
  abdomen_->setEnabled(may);
  labels_->setEnabled(may);
  const SeriesReport* one = selected();
  use_series_->setEnabled(may && one && one->verdict != Verdict::refused &&
                          toQt(one->uid) != chosen_);
}

}  // namespace trephine
