#include "ui/cases/series_page.h"

#include <QVBoxLayout>
#include <algorithm>
#include <utility>

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
  connect(labels_, &QComboBox::activated, this, [this](int row) { chosen_[shown_] = row; });
  labels_box_ = titled(tr("Label map beside this CT"), {labels_});
  auto* layout = tight(new QVBoxLayout(this), 10, {8, 0, 8, 0});
  layout->addWidget(card_);
  layout->addWidget(labels_box_);
  layout->addStretch(1);
  layout->addWidget(size_box_);
}

void SeriesPage::show(const SeriesReport* series, const SeriesReport* before,
                      const Answers& answers) {
  const SeriesState state = series ? seriesState(*series, answers) : SeriesState::refused;
  const bool may = state != SeriesState::refused && state != SeriesState::structures;
  card_->setVisible(series);
  labels_box_->setVisible(may && series->source == "DICOM" && series->modality == "CT" &&
                          labels_->count() > 1);
  if (series) offerLabelsOf(series->uid);
  size_box_->setVisible(may);
  if (!series) return choices_->ask({}, {});
  size_->setGrid(before->verdict != Verdict::refused ? before->geometry : GridGeometry{});
  choices_->ask(before->choices, answers);
}

void SeriesPage::showLabelFiles(const std::vector<CtFolder::LabelFile>& files) {
  labels_->clear();
  shown_.clear();
  chosen_.clear();
  labels_->addItem(tr("None"));
  files_ = files;
  for (const CtFolder::LabelFile& one : files) labels_->addItem(toQt(one.name), toQt(one.file));
}

// That a segmentation is of this CT alone, its study and place say; else a person says it.
void SeriesPage::offerLabelsOf(const std::string& uid) {
  if (std::exchange(shown_, uid) == uid) return;
  if (const auto chosen = chosen_.find(uid); chosen != chosen_.end()) {
    return labels_->setCurrentIndex(chosen->second);
  }
  const auto of_it = [&](const CtFolder::LabelFile& one) { return one.of == uid; };
  const auto found = std::ranges::find_if(files_, of_it);
  const bool one = std::ranges::count_if(files_, of_it) == 1;
  labels_->setCurrentIndex(one ? 1 + int(found - files_.begin()) : 0);
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
