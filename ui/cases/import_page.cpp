#include "ui/cases/import_page.h"

#include <QDragEnterEvent>
#include <QKeyEvent>
#include <QMimeData>
#include <algorithm>

#include "imaging/codes.h"
#include "ui/cases/import_words.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"
#include "volume/case_memory.h"

namespace trephine {

namespace {

const SeriesReport* findSeries(const std::vector<SeriesReport>& series, const std::string& uid) {
  const auto found = std::ranges::find(series, uid, &SeriesReport::uid);
  return found == series.end() ? nullptr : &*found;
}

// Whether columns and rows of the stored slices are those of the volume.
bool isAsStored(const SeriesReport& series, const QImage& slice) {
  return series.tilt_deg == 0.0 && slice.width() == series.geometry.size[0] &&
         slice.height() == series.geometry.size[1];
}

}  // namespace

ImportPage::ImportPage(ImportTask& task, QWidget* parent) : QWidget(parent), task_(task) {
  build();
  connectParts();
  showStep(Step::empty);
}

const SeriesReport* ImportPage::selected() const {
  if (step_ == Step::scanning) return nullptr;  // the report is of the folder before
  return findSeries(task_.report().series, list_->selectedUid());
}

SeriesReport* ImportPage::before() {
  if (step_ == Step::scanning) return nullptr;
  const auto found = std::ranges::find(before_, list_->selectedUid(), &SeriesReport::uid);
  return found == before_.end() ? nullptr : &*found;
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

// The label maps that lie beside the CT of the folder; none is taken until it is chosen.
void ImportPage::showLabelFiles() {
  labels_->clear();
  labels_->addItem(tr("None"));
  for (const CtFolder::LabelFile& one : task_.labelFiles()) {
    labels_->addItem(toQt(one.name), toQt(one.file));
  }
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
  showLabelFiles();
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
    const VoxelBox box = size_->box();
    const int reduction = size_->reduction();
    *before() = *now;
    if (now->verdict != Verdict::refused) before()->geometry = grid;
    seriesSelected();
    if (before()->geometry == grid) size_->restore(box, reduction);
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
  const bool asking = step_ == Step::asking;
  if (key == Qt::Key_Escape) return asking ? back() : reject();
  if (key == Qt::Key_Return || key == Qt::Key_Enter) {
    return asking ? open_case_->click() : import_->click();
  }
  QWidget::keyPressEvent(event);
}

void ImportPage::say(const QString& text) {
  if (task_.isWorking()) return;
  status_->setText(text);
  status_->show();
}

void ImportPage::showStep(Step step) {
  step_ = step;
  const bool working = step == Step::scanning || step == Step::reading;
  const bool choosing = step == Step::choosing;
  list_->setEnabled(choosing || step == Step::scanning);
  take_found_->setVisible(step == Step::scanning);
  scan_on_->setVisible(choosing && std::ranges::any_of(task_.report().series, [](const auto& one) {
                         return std::ranges::find(one.findings, code::kScanStopped,
                                                  &Finding::code) != one.findings.end();
                       }));
  for (QWidget* part : {static_cast<QWidget*>(open_folder_), static_cast<QWidget*>(open_file_),
                        static_cast<QWidget*>(series_page_)}) {
    part->setEnabled(choosing);
  }
  preview_->setEnabled(!working);
  right_->setCurrentWidget(step == Step::asking ? asking_page_ : series_page_);
  for (QWidget* part : {static_cast<QWidget*>(status_), static_cast<QWidget*>(progress_),
                        static_cast<QWidget*>(cancel_)}) {
    part->setVisible(working);
  }
  close_->setVisible(!working && step != Step::asking);
  // Also while it cannot be used: what follows Cancel at its place is Close, never Import.
  import_->setVisible(step != Step::asking);
  report_->setVisible(choosing && task_.hasFolder());
  back_->setVisible(step == Step::asking);
  open_case_->setVisible(step == Step::asking);
  if (step == Step::scanning) {
    status_->setText(tr("Looking through the files"));
    progress_->setValue(0);
    folder_->clear();
    list_->showSeries({}, {});
    found_taken_ = false;
  }
  showImportButton();
}

// --- The series ---

void ImportPage::seriesSelected() {
  const SeriesReport* series = selected();
  card_->setVisible(series);
  labels_box_->setVisible(series && series->source == "DICOM" && series->modality == "CT" &&
                          labels_->count() > 1 &&
                          seriesState(*series, answers()) != SeriesState::refused);
  size_box_->setVisible(series && seriesState(*series, answers()) != SeriesState::refused);
  if (!series) {
    const std::optional<Error>& error = task_.report().error;
    choices_->ask({}, {});
    preview_->showNothing(step_ == Step::choosing && error
                              ? toQt(error->what + ". " + error->next + '.')
                              : QString());
    return showImportButton();
  }
  const bool grid_known = before()->verdict != Verdict::refused;
  size_->setGrid(grid_known ? before()->geometry : GridGeometry{});
  choices_->ask(before()->choices, answers());
  task_.wantPictures(list_->selectedUid(), choices_->slicesShown());
  showSelected();
  const GridGeometry& grid = before()->geometry;
  preview_->showStack(series->slices,
                      grid.spacing_mm.z > 0.0 ? std::optional(grid.direction) : std::nullopt);
}

// What answers change of what is shown.
void ImportPage::showSelected() {
  const SeriesReport* series = selected();
  if (!series) return;
  card_->showSeries(*series, answers(), neededMb({{}, size_->crop(), size_->reduction(), {}}),
                    task_.roomMb());
  listSelected();
  showImportButton();
}

void ImportPage::showImportButton() {
  take_found_->setEnabled(step_ == Step::scanning && !found_taken_ && list_->currentItem());
  const SeriesReport* series = selected();
  const bool usable = series && mayBeRead(seriesState(*series, answers()));
  const bool refused = size_->isRefused();
  import_->setEnabled(step_ == Step::choosing && usable && !refused);
  import_->setToolTip(!series   ? QString()
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
  canvas.setDrawable(choosing && as_stored);
  size_note_->setText(
      grid_known ? tr("The volume is straightened when it is read, so its box cannot be drawn on "
                      "the slices as they are stored.")
                 : tr("What your answers make of it can be cropped once it has been read."));
  size_note_->setVisible(
      series && (!grid_known || (size_->crop() && !as_stored && !canvas.image().isNull())));
  if (!choosing || !as_stored || !size_->crop()) return canvas.setKept({});
  const VoxelBox box = size_->box();
  const bool slices_too = series->slices == series->geometry.size[2];
  const bool inside = preview_->index() >= box.low[2] && preview_->index() < box.high[2];
  canvas.setKept(slices_too && !inside ? QRect()
                                       : QRect(box.low[0], box.low[1], box.high[0] - box.low[0],
                                               box.high[1] - box.low[1]));
}

void ImportPage::boxDrawn(const QRect& pixels) {
  VoxelBox box = size_->box();
  box.low[0] = pixels.left();
  box.low[1] = pixels.top();
  box.high[0] = pixels.left() + pixels.width();
  box.high[1] = pixels.top() + pixels.height();
  size_->setBox(box);
}

// --- Reading ---

void ImportPage::import() {
  if (!import_->isEnabled()) return;
  request_ = {answers(), size_->crop(), size_->reduction(), {}};
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
  loss_->setText(provenance && provenance->loss ? lossWords(*provenance->loss) : QString());
  loss_->setVisible(!loss_->text().isEmpty());
  loss_told_ = true;
  couch_->setVisible(task_.couch().found);
  face_->setVisible(std::ranges::find(questions, code::kFace, &Choice::code) != questions.end());
  late_choices_->ask(questions, {});
  showStep(Step::asking);
  open_case_->setEnabled(late_choices_->allAnswered());
  preview_->canvas().setKept({});
  preview_->canvas().setDrawable(false);
  preview_->showStack(after.geometry.size[2], after.geometry.direction);
  if (auto* first = late_choices_->findChild<QAbstractButton*>()) {
    first->setFocus();
  } else {
    open_case_->setFocus();
  }
}

// All that was asked after reading has an answer: what is not as it was read is read again.
void ImportPage::answered() {
  if (!late_choices_->allAnswered()) return;
  bool as_read = true;
  const SeriesReport* after = selected();
  for (const auto& [code, option] : late_choices_->answers()) {
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
  const bool with_labels = series->source == "DICOM" && labels_->currentIndex() > 0;
  emit caseRead(read,
                with_labels ? toPath(labels_->currentData().toString()) : std::filesystem::path());
}

void ImportPage::back() {
  (void)task_.takeVolume();
  showStep(Step::choosing);
  seriesSelected();
}

}  // namespace trephine
