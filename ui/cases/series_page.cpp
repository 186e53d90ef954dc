#include "ui/cases/series_page.h"

#include <QVBoxLayout>

#include "ui/cases/import_words.h"
#include "ui/common/making.h"
#include "ui/common/setting_words.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

// Parts below a title, which come and go together.
QWidget* titled(const QString& title, std::initializer_list<QWidget*> parts) {
  auto* box = new QWidget;
  auto* layout = tight(new QVBoxLayout(box));
  layout->addWidget(settingTitle(title, box));
  for (QWidget* part : parts) layout->addWidget(part);
  return box;
}

}  // namespace

SeriesPage::SeriesPage(QWidget* parent) : QWidget(parent) {
  choices_ = new ChoicePanel;
  choices_->setObjectName("choices");
  card_ = new ReportCard(choices_);
  size_ = new SizePanel;
  size_note_ = wrappedLabel("sizeNote", {"quiet"});
  size_box_ = titled(tr("How much of it, and how finely"), {size_, size_note_});
  labels_ = new QComboBox;
  labels_->setObjectName("labelFile");
  labels_->setAccessibleName(tr("Label map that is opened with the CT"));
  labels_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  labels_box_ = titled(tr("Label map beside this CT"), {labels_});
  auto* layout = tight(new QVBoxLayout(this), 10, {8, 0, 8, 0});
  layout->addWidget(card_);
  layout->addWidget(labels_box_);
  layout->addStretch(1);
  layout->addWidget(size_box_);
}

void SeriesPage::show(const SeriesReport* series, const SeriesReport* before,
                      const Answers& answers) {
  const bool may = series && seriesState(*series, answers) != SeriesState::refused;
  card_->setVisible(series);
  labels_box_->setVisible(may && series->source == "DICOM" && series->modality == "CT" &&
                          labels_->count() > 1);
  size_box_->setVisible(may);
  if (!series) return choices_->ask({}, {});
  size_->setGrid(before->verdict != Verdict::refused ? before->geometry : GridGeometry{});
  choices_->ask(before->choices, answers);
}

void SeriesPage::showLabelFiles(const std::vector<CtFolder::LabelFile>& files) {
  labels_->clear();
  labels_->addItem(tr("None"));
  for (const CtFolder::LabelFile& one : files) labels_->addItem(toQt(one.name), toQt(one.file));
}

std::filesystem::path SeriesPage::labelFile() const {
  return labels_->currentIndex() > 0 ? toPath(labels_->currentData().toString())
                                     : std::filesystem::path();
}

void SeriesPage::noteSize(const QString& words) {
  size_note_->setText(words);
  size_note_->setVisible(!words.isEmpty());
}

}  // namespace trephine
