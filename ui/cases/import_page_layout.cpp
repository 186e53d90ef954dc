#include <QHBoxLayout>
#include <QSplitter>
#include <QVBoxLayout>

#include "ui/cases/import_page.h"
#include "ui/common/named_parts.h"
#include "ui/common/icons.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kProgressSteps = 1000;
constexpr int kListWidth = 300, kReportWidth = 360;

QLabel* wrapped(const char* name, bool quiet) {
  auto* label = new QLabel;
  label->setObjectName(name);
  label->setWordWrap(true);
  label->setTextFormat(Qt::PlainText);
  label->setProperty("quiet", quiet);
  return label;
}

QLabel* heading(const QString& text) {
  auto* label = new QLabel(text);
  label->setProperty("title", true);
  return label;
}

}  // namespace

void ImportPage::build() {
  setObjectName("importPage");
  setAcceptDrops(true);
  preview_ = new SlicePreview;
  preview_->setObjectName("slicePreview");
  right_ = new QStackedWidget;
  series_page_ = scrolled(buildSeriesPage(), "seriesPage");
  asking_page_ = scrolled(buildAskingPage(), "askingPage");
  right_->addWidget(series_page_);
  right_->addWidget(asking_page_);

  auto* columns = new QSplitter(Qt::Horizontal);
  columns->addWidget(buildFolderColumn());
  columns->addWidget(preview_);
  columns->addWidget(right_);
  columns->setChildrenCollapsible(false);
  columns->setStretchFactor(0, 0);
  columns->setStretchFactor(1, 1);
  columns->setStretchFactor(2, 0);
  columns->setSizes({kListWidth, 520, kReportWidth});

  auto* layout = new QVBoxLayout(this);
  layout->addWidget(columns, 1);
  layout->addLayout(buildBottomRow());
}

QWidget* ImportPage::buildFolderColumn() {
  open_folder_ = namedButton("importFolder", tr("Open &folder\u2026"));
  open_file_ = namedButton("importFile", tr("Open fi&le\u2026"));
  open_folder_->setIcon(symbolIcon(Symbol::open));
  auto* open_row = new QHBoxLayout;
  open_row->addWidget(open_folder_);
  open_row->addWidget(open_file_);
  list_ = new SeriesList;
  list_->setObjectName("seriesList");
  folder_ = wrapped("folderWords", true);
  auto* column = new QWidget;
  auto* layout = new QVBoxLayout(column);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addLayout(open_row);
  scan_on_ = namedButton("scanOn", tr("Look at &all files"));
  scan_on_->setToolTip(tr("The search was ended early: look through the files that were left out"));
  layout->addWidget(list_, 1);
  layout->addWidget(scan_on_);
  folder_->setAlignment(Qt::AlignTop);
  auto* folder_area = scrolled(folder_, "folderArea");
  folder_area->setMaximumHeight(6 * fontMetrics().lineSpacing());
  layout->addWidget(folder_area);
  return column;
}

QWidget* ImportPage::buildSeriesPage() {
  choices_ = new ChoicePanel;
  choices_->setObjectName("choices");
  card_ = new ReportCard(choices_);
  size_ = new SizePanel;
  size_note_ = wrapped("sizeNote", true);
  size_box_ = new QWidget;
  auto* size_layout = new QVBoxLayout(size_box_);
  size_layout->setContentsMargins(0, 0, 0, 0);
  size_layout->addWidget(heading(tr("How much of it, and how finely")));
  size_layout->addWidget(size_);
  size_layout->addWidget(size_note_);
  labels_ = new QComboBox;
  labels_->setObjectName("labelFile");
  labels_->setAccessibleName(tr("Label map that is opened with the CT"));
  labels_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  labels_box_ = new QWidget;
  auto* labels_layout = new QVBoxLayout(labels_box_);
  labels_layout->setContentsMargins(0, 0, 0, 0);
  labels_layout->addWidget(heading(tr("Label map beside this CT")));
  labels_layout->addWidget(labels_);
  auto* page = new QWidget;
  auto* layout = new QVBoxLayout(page);
  layout->setContentsMargins(8, 0, 8, 0);
  layout->setSpacing(10);
  layout->addWidget(card_);
  layout->addWidget(labels_box_);
  layout->addStretch(1);
  layout->addWidget(size_box_);
  return page;
}

QWidget* ImportPage::buildAskingPage() {
  loss_ = wrapped("lossWords", false);
  couch_ = wrapped("couchNote", true);
  couch_->setText(tr("In the slices, what would be taken out is tinted."));
  face_ = wrapped("faceWarning", false);
  face_->setText(
      tr("From this CT the face can be made visible, and the patient recognised. Keep it "
         "only where the exercise needs it and everyone who sees the case may know who "
         "it is."));
  late_choices_ = new ChoicePanel;
  late_choices_->setObjectName("lateChoices");
  auto* page = new QWidget;
  auto* layout = new QVBoxLayout(page);
  layout->setContentsMargins(8, 0, 8, 0);
  layout->setSpacing(10);
  layout->addWidget(heading(tr("Before the case opens")));
  layout->addWidget(loss_);
  layout->addWidget(face_);
  layout->addWidget(couch_);
  layout->addWidget(late_choices_);
  layout->addStretch(1);
  return page;
}

QLayout* ImportPage::buildBottomRow() {
  status_ = new ElidedLabel;
  status_->setObjectName("importStatus");
  status_->setProperty("quiet", true);
  progress_ = new QProgressBar;
  progress_->setObjectName("importProgress");
  progress_->setRange(0, kProgressSteps);
  progress_->setTextVisible(false);
  progress_->setMaximumHeight(14);
  report_ = namedButton("saveReport", tr("Save &report\u2026"));
  cancel_ = namedButton("cancelImport", tr("&Cancel"));
  close_ = namedButton("closeImport", tr("&Close"));
  back_ = namedButton("importBack", tr("&Back"));
  import_ = namedButton("import", tr("&Import"));
  import_->setProperty("primary", true);
  take_found_ = namedButton("takeFound", tr("Use this &series"));
  take_found_->setToolTip(
      tr("Look only at the files beside those of this series, and at no others"));
  open_case_ = namedButton("openCase", tr("&Open the case"));
  open_case_->setProperty("primary", true);
  auto* row = new QHBoxLayout;
  row->addWidget(status_);
  row->addWidget(progress_, 1);
  row->addStretch(1);
  for (QPushButton* each : {report_, back_, take_found_, cancel_, close_, import_, open_case_}) {
    each->setMinimumWidth(110);
    row->addWidget(each);
  }
  return row;
}

void ImportPage::connectParts() {
  connect(open_folder_, &QPushButton::clicked, this, &ImportPage::folderWanted);
  connect(open_file_, &QPushButton::clicked, this, &ImportPage::fileWanted);
  connect(list_, &SeriesList::seriesSelected, this, &ImportPage::seriesSelected);
  connect(list_, &SeriesList::seriesActivated, this,
          [this] { step_ == Step::scanning ? takeFound() : import(); });
  connect(take_found_, &QPushButton::clicked, this, &ImportPage::takeFound);
  connect(scan_on_, &QPushButton::clicked, this, [this] { task_.scan(task_.source()); });
  connect(&task_, &ImportTask::found, this, [this](const std::vector<FoundSeries>& series) {
    if (step_ != Step::scanning) return;
    list_->showFound(series);
    showImportButton();
  });
  connect(preview_, &SlicePreview::sliceWanted, this, &ImportPage::sliceWanted);
  connect(&preview_->canvas(), &SliceCanvas::boxDrawn, this, &ImportPage::boxDrawn);
  connect(size_, &SizePanel::changed, this, &ImportPage::showKept);
  connect(size_, &SizePanel::changed, this, &ImportPage::showSelected);
  connect(choices_, &ChoicePanel::answered, this, [this] {
    for (const auto& [code, option] : choices_->answers()) answers()[code] = option;
    showSelected();
  });
  connect(late_choices_, &ChoicePanel::answered, this,
          [this] { open_case_->setEnabled(late_choices_->allAnswered()); });
  connect(import_, &QPushButton::clicked, this, &ImportPage::import);
  connect(open_case_, &QPushButton::clicked, this, &ImportPage::answered);
  connect(report_, &QPushButton::clicked, this, &ImportPage::reportWanted);
  connect(back_, &QPushButton::clicked, this, &ImportPage::back);
  connect(close_, &QPushButton::clicked, this, &ImportPage::reject);
  connect(cancel_, &QPushButton::clicked, &task_, &ImportTask::cancel);

  connect(&task_, &ImportTask::scanBegan, this, [this] {
    showStep(Step::scanning);
    active_ = true;
    emit opened();
  });
  connect(&task_, &ImportTask::progressed, this, [this](double fraction, const QString& step) {
    status_->setText(step);
    progress_->setValue(int(fraction * kProgressSteps));
  });
  connect(&task_, &ImportTask::scanned, this, &ImportPage::scanned);
  connect(&task_, &ImportTask::readDone, this, &ImportPage::readDone);
  connect(&task_, &ImportTask::stopped, this, &ImportPage::stopped);
  connect(&task_, &ImportTask::sliceReady, this, &ImportPage::showSlice);
  connect(&task_, &ImportTask::thumbnailReady, list_, &SeriesList::setThumbnail);
  connect(&task_, &ImportTask::pictureReady, this,
          [this](const QString& uid, int slice, const QImage& picture) {
            if (uid == toQt(list_->selectedUid())) choices_->setPicture(slice, picture);
          });
}

}  // namespace trephine
