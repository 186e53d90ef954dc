#include "ui/cases/import_page.h"

#include <QDragEnterEvent>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QMimeData>
#include <QSplitter>
#include <QVBoxLayout>
#include <algorithm>

#include "imaging/codes.h"
#include "ui/cases/import_words.h"
#include "ui/common/icons.h"
#include "ui/common/making.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"
#include "volume/case_memory.h"

namespace trephine {

namespace {

auto findSeries(auto& series, const std::string& uid) {
  const auto found = std::ranges::find(series, uid, &SeriesReport::uid);
  return found == series.end() ? nullptr : &*found;
}

// Whether columns and rows of the stored slices are those of the volume.
bool isAsStored(const SeriesReport& series, const QImage& slice) {
  return series.tilt_deg == 0.0 && slice.width() == series.geometry.size[0] &&
         slice.height() == series.geometry.size[1];
}

constexpr int kListWidth = 300, kReportWidth = 360;

}  // namespace

ImportPage::ImportPage(ImportTask& task, QWidget* parent) : QWidget(parent), task_(task) {
  build();
  connectParts();
  showStep(Step::empty);
}

// --- How it is put together ---

void ImportPage::build() {
  setObjectName("importPage");
  setAcceptDrops(true);
  preview_ = new SlicePreview;
  preview_->setObjectName("slicePreview");
  right_ = new QStackedWidget;
  series_ = new SeriesPage;
  series_area_ = scrolled(series_, "seriesPage");
  late_ = new LateQuestions;
  late_area_ = scrolled(late_, "askingPage");
  right_->addWidget(series_area_);
  right_->addWidget(late_area_);

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
  bar_ = new ImportBar(this);
  layout->addWidget(bar_);
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
  folder_ = wrappedLabel("folderWords", {"quiet"});
  auto* column = new QWidget;
  auto* layout = tight(new QVBoxLayout(column));
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

void ImportPage::connectParts() {
  connect(open_folder_, &QPushButton::clicked, this, &ImportPage::folderWanted);
  connect(open_file_, &QPushButton::clicked, this, &ImportPage::fileWanted);
  connect(list_, &SeriesList::seriesSelected, this, &ImportPage::seriesSelected);
  connect(list_, &SeriesList::seriesActivated, this,
          [this] { step_ == Step::scanning ? takeFound() : import(); });
  connect(scan_on_, &QPushButton::clicked, this, [this] { task_.scan(task_.source()); });
  connect(&task_, &ImportTask::found, this, [this](const std::vector<FoundSeries>& series) {
    if (step_ != Step::scanning) return;
    list_->showFound(series);
    showImportButton();
  });
  connect(preview_, &SlicePreview::sliceWanted, this, &ImportPage::sliceWanted);
  connect(&preview_->canvas(), &SliceCanvas::boxDrawn, this, &ImportPage::boxDrawn);
  connect(&series_->size(), &SizePanel::changed, this, &ImportPage::showKept);
  connect(&series_->size(), &SizePanel::changed, this, &ImportPage::showSelected);
  connect(&series_->choices(), &ChoicePanel::answered, this, [this] {
    for (const auto& [code, option] : series_->choices().answers()) answers()[code] = option;
    showSelected();
  });
  connect(late_, &LateQuestions::answered, this,
          [this] { bar_->setAnswered(late_->allAnswered()); });
  connect(bar_, &ImportBar::foundTaken, this, &ImportPage::takeFound);
  connect(bar_, &ImportBar::importWanted, this, &ImportPage::import);
  connect(bar_, &ImportBar::openCaseWanted, this, &ImportPage::answered);
  connect(bar_, &ImportBar::reportWanted, this,
          [this] { emit reportWanted(toQt(list_->selectedUid())); });
  connect(bar_, &ImportBar::backWanted, this, &ImportPage::back);
  connect(bar_, &ImportBar::closeWanted, this, &ImportPage::reject);
  connect(bar_, &ImportBar::cancelWanted, &task_, &ImportTask::cancel);

  connect(&task_, &ImportTask::scanBegan, this, [this] {
    showStep(Step::scanning);
    active_ = true;
    emit opened();
  });
  connect(&task_, &ImportTask::progressed, bar_, &ImportBar::showProgress);
  connect(&task_, &ImportTask::scanned, this, &ImportPage::scanned);
  connect(&task_, &ImportTask::readDone, this, &ImportPage::readDone);
  connect(&task_, &ImportTask::stopped, this, &ImportPage::stopped);
  connect(&task_, &ImportTask::sliceReady, this, &ImportPage::showSlice);
  connect(&task_, &ImportTask::thumbnailReady, list_, &SeriesList::setThumbnail);
  connect(&task_, &ImportTask::pictureReady, this,
          [this](const QString& uid, int slice, const QImage& picture) {
            if (uid == toQt(list_->selectedUid())) series_->choices().setPicture(slice, picture);
          });
}

const SeriesReport* ImportPage::selected() const {
  if (step_ == Step::scanning) return nullptr;  // the report is of the folder before
  return findSeries(task_.report().series, list_->selectedUid());
}

SeriesReport* ImportPage::before() {
  if (step_ == Step::scanning) return nullptr;
  return findSeries(before_, list_->selectedUid());
}

// Of the window's own nothing is asked for again. 0: not known before it is read.
double ImportPage::neededMb(const ImportRequest& request) {
  const SeriesReport& series = *before();
  return series.memory_mb > 0.0 ? memoryMb(series, request) - kWindow_mb : 0.0;
}

// The list says what the series is, not how much of it was read last.
void ImportPage::listSelected() {
  SeriesReport listed = *selected();
  listed.geometry = before()->geometry;
  list_->updateSeries(listed, answers());
}

// --- The folder ---

void ImportPage::open() {
  if (task_.hasFolder() && step_ != Step::scanning) {
    showStep(Step::choosing);
    task_.wantThumbnails(list_->withoutThumbnail());
    seriesSelected();
  }
  active_ = true;
  emit opened();
  list_->setFocus();
}

// Enough was found: what is selected is wanted, and the scan comes to its end.
void ImportPage::takeFound() {
  const std::string uid = list_->selectedUid();
  if (uid.empty() || found_taken_) return;
  found_taken_ = true;
  task_.takeFound(uid);
  list_->setEnabled(false);
  showImportButton();
}

void ImportPage::reject() {
  task_.wantNothing();
  if (task_.isWorking()) task_.cancel();
  (void)task_.takeVolume();
  active_ = false;
  emit closed();
}

void ImportPage::scanned() {
  before_ = task_.report().series;
  answers_.clear();
  showFolder();
}

void ImportPage::showFolder() {
  folder_->setText(folderWords(task_.report()));
  showStep(Step::choosing);
  series_->showLabelFiles(task_.labelFiles());
  list_->showSeries(task_.report().series, answers_, task_.names());
  if (const std::optional<std::string>& best = task_.bestSeries()) {
    list_->select(*best);
  } else {
    list_->setCurrentRow(0);
  }
  task_.wantThumbnails(list_->withoutThumbnail());
  list_->setFocus();
}

void ImportPage::stopped() {
  const bool was_scanning = step_ == Step::scanning;
  if (was_scanning && !task_.hasFolder()) {
    showStep(Step::empty);
    return reject();
  }
  showStep(Step::choosing);
  if (!active_) return;
  if (was_scanning) return showFolder();  // the one before
  // What could not be read may ask more now; what was chosen of it stays.
  if (const SeriesReport* now = selected()) {
    const GridGeometry grid = before()->geometry;
    const VoxelBox box = series_->size().box();
    const int reduction = series_->size().reduction();
    *before() = *now;
    if (now->verdict != Verdict::refused) before()->geometry = grid;
    seriesSelected();
    if (before()->geometry == grid) series_->size().restore(box, reduction);
  } else {
    seriesSelected();
  }
}

void ImportPage::dragEnterEvent(QDragEnterEvent* event) {
  const QList<QUrl> urls = event->mimeData()->urls();
  if (urls.size() == 1 && urls.front().isLocalFile()) event->acceptProposedAction();
}

void ImportPage::dropEvent(QDropEvent* event) {
  event->acceptProposedAction();
  emit pathDropped(event->mimeData()->urls().front().toLocalFile());
}

// Return goes on, Esc goes back, as the buttons do.
void ImportPage::keyPressEvent(QKeyEvent* event) {
  const int key = event->key();
  if (key == Qt::Key_Escape) return step_ == Step::asking ? back() : reject();
  if (key == Qt::Key_Return || key == Qt::Key_Enter) return bar_->goOn();
  QWidget::keyPressEvent(event);
}

void ImportPage::say(const QString& text) {
  if (!task_.isWorking()) bar_->say(text);
}

void ImportPage::showStep(Step step) {
  step_ = step;
  const bool choosing = step == Step::choosing;
  list_->setEnabled(choosing || step == Step::scanning);
  scan_on_->setVisible(choosing && std::ranges::any_of(task_.report().series, [](const auto& one) {
                         return std::ranges::find(one.findings, code::kScanStopped,
                                                  &Finding::code) != one.findings.end();
                       }));
  open_folder_->setEnabled(choosing);
  open_file_->setEnabled(choosing);
  series_area_->setEnabled(choosing);
  preview_->setEnabled(!isWorking(step));
  right_->setCurrentWidget(step == Step::asking ? late_area_ : series_area_);
  bar_->show(step, task_.hasFolder());
  if (step == Step::scanning) {
    folder_->clear();
    list_->showSeries({}, {});
    found_taken_ = false;
  }
  showImportButton();
}

// --- The series ---

void ImportPage::seriesSelected() {
  const SeriesReport* series = selected();
  series_->show(series, before(), series ? answers() : Answers());
  if (!series) {
    const std::optional<Error>& error = task_.report().error;
    preview_->showNothing(step_ == Step::choosing && error
                              ? toQt(error->what + ". " + error->next + '.')
                              : QString());
    return showImportButton();
  }
  task_.wantPictures(list_->selectedUid(), series_->choices().slicesShown());
  showSelected();
  const GridGeometry& grid = before()->geometry;
  preview_->setBodyPart(series->body_part);
  preview_->showStack(series->slices,
                      grid.spacing_mm.z > 0.0 ? std::optional(grid.direction) : std::nullopt);
}

// What answers change of what is shown.
void ImportPage::showSelected() {
  const SeriesReport* series = selected();
  if (!series) return;
  const SizePanel& size = series_->size();
  series_->card().showSeries(*series, answers(), neededMb({{}, size.crop(), size.reduction(), {}}),
                             task_.roomMb());
  listSelected();
  showImportButton();
}

void ImportPage::showImportButton() {
  bar_->setFoundEnough(step_ == Step::scanning && !found_taken_ && list_->currentItem());
  const SeriesReport* series = selected();
  const bool usable = series && mayBeRead(seriesState(*series, answers()));
  const bool refused = series_->size().isRefused();
  bar_->setImportable(step_ == Step::choosing && usable && !refused,
                      !series   ? QString()
                      : !usable ? verdictSentence(*series, answers())
                      : refused ? tr("Mend the number of the box that is refused")
                                : QString());
}

void ImportPage::sliceWanted(int index) {
  if (step_ == Step::asking) {
    if (!task_.volume()) return;
    preview_->showSlice(index, sliceOf(*task_.volume(), index));
    showCouch(index);
  } else {
    task_.wantSlice(list_->selectedUid(), index);
  }
}

// What would be taken out of slice `k` of the volume that was read.
void ImportPage::showCouch(int k) {
  preview_->canvas().setMarked(couchMask(task_.couch(), *task_.volume(), k));
}

void ImportPage::showSlice(const QString& uid, int index, const Result<SlicePicture>& picture) {
  if (step_ == Step::asking || uid != toQt(list_->selectedUid())) return;
  preview_->showSlice(index, picture);
  showKept();
}

void ImportPage::showKept() {
  SliceCanvas& canvas = preview_->canvas();
  const SeriesReport* series = before();
  const bool grid_known = series && series->verdict != Verdict::refused;
  const bool as_stored = grid_known && isAsStored(*series, canvas.image());
  const bool choosing = step_ == Step::choosing;
  preview_->setCroppable(choosing && as_stored);
  const std::optional<VoxelBox> crop = series_->size().crop();
  QString note;
  if (series && !grid_known) {
    note = tr("What your answers make of it can be cropped once it has been read.");
  } else if (crop && series && !as_stored && !canvas.image().isNull()) {
    note =
        tr("The volume is straightened when it is read, so its box cannot be drawn on the "
           "slices as they are stored.");
  }
  series_->noteSize(note);
  if (!choosing || !as_stored || !crop) return canvas.setKept({});
  const VoxelBox box = series_->size().box();
  const bool slices_too = series->slices == series->geometry.size[2];
  const bool inside = preview_->index() >= box.low[2] && preview_->index() < box.high[2];
  canvas.setKept(slices_too && !inside ? QRect()
                                       : QRect(box.low[0], box.low[1], box.high[0] - box.low[0],
                                               box.high[1] - box.low[1]));
}

void ImportPage::boxDrawn(const QRect& pixels) {
  VoxelBox box = series_->size().box();
  box.low[0] = pixels.left();
  box.low[1] = pixels.top();
  box.high[0] = pixels.left() + pixels.width();
  box.high[1] = pixels.top() + pixels.height();
  series_->size().setBox(box);
}

// --- Reading ---

void ImportPage::import() {
  if (!bar_->isImportable()) return;
  request_ = {answers(), series_->size().crop(), series_->size().reduction(), {}};
  loss_told_ = false;
  showStep(Step::reading);
  task_.read(list_->selectedUid(), request_, neededMb(request_));
}

void ImportPage::readDone() {
  const SeriesReport* after = selected();
  if (!after) return;
  listSelected();
  if (!request_.crop && request_.reduction == 1) {  // now the whole grid is known
    before()->geometry = after->geometry;
    before()->verdict = after->verdict;
  }
  const std::vector<Choice> questions = newChoices(*before(), *after, answers());
  const std::optional<Provenance>& provenance = task_.report().provenance;
  const bool tell_loss = provenance && provenance->loss && !loss_told_;
  if (questions.empty() && !tell_loss) return openCase();
  ask(*after, questions);
}

void ImportPage::ask(const SeriesReport& after, const std::vector<Choice>& questions) {
  const std::optional<Provenance>& provenance = task_.report().provenance;
  late_->ask(provenance ? provenance->loss : std::nullopt, task_.couch().found, questions);
  loss_told_ = true;
  showStep(Step::asking);
  bar_->setAnswered(late_->allAnswered());
  preview_->canvas().setKept({});
  preview_->setCroppable(false);
  preview_->showStack(after.geometry.size[2], after.geometry.direction);
  if (!late_->focusFirst()) bar_->focusOpenCase();
}

// All that was asked after reading has an answer: what is not as it was read is read again.
void ImportPage::answered() {
  if (!late_->allAnswered()) return;
  bool as_read = true;
  const SeriesReport* after = selected();
  for (const auto& [code, option] : late_->answers()) {
    answers()[code] = option;
    const auto choice = std::ranges::find(after->choices, code, &Choice::code);
    as_read &= choice != after->choices.end() && option == choice->options.front();
  }
  if (as_read) return openCase();
  request_.answers = answers();
  showStep(Step::reading);
  task_.read(list_->selectedUid(), request_, neededMb(request_));
}

void ImportPage::openCase() {
  const SeriesReport* series = selected();
  Case read = caseOf(task_.takeVolume(), series->volume_sha256.value_or(""));
  read.provenance = task_.report().provenance;
  read.name = seriesName(*series).toStdString();
  task_.wantNothing();
  showStep(Step::choosing);
  active_ = false;
  emit closed();
  emit caseRead(read, series->source == "DICOM" ? series_->labelFile() : std::filesystem::path());
}

void ImportPage::back() {
  (void)task_.takeVolume();
  showStep(Step::choosing);
  seriesSelected();
}

}  // namespace trephine
