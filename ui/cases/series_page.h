// The series that is selected: what the import found out about it and asks, how much of it is read
// and how finely, and which label map goes with it.
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QWidget>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "imaging/importer.h"
#include "ui/cases/choice_panel.h"
#include "ui/cases/report_card.h"
#include "ui/cases/size_panel.h"

namespace trephine {

class SeriesPage : public QWidget {
  Q_OBJECT
 public:
  explicit SeriesPage(QWidget* parent = nullptr);

  // Shows another series, or none (null). `before` is its report from the scan, before its voxels
  // were read, and never null with a series: its questions are asked and its grid is cropped.
  // `answers` are those given so far. Nothing is kept of the three. Call showLabelFiles() first:
  // show() decides whether that choice is seen. QWidget::show() is hidden by this.
  void show(const SeriesReport* series, const SeriesReport* before, const Answers& answers);
  // Offers the label maps beside the CT, for all series of the folder; "None" is chosen. No signal:
  // ask labelFile() when the CT is read.
  void showLabelFiles(const std::vector<CtFolder::LabelFile>& files);
  std::filesystem::path labelFile() const;  // empty: none
  // Why the crop box cannot be drawn on the slices of the preview; empty: it can.
  void noteSize(const QString& words);

  ReportCard& card() { return *card_; }
  ChoicePanel& choices() { return *choices_; }
  SizePanel& size() { return *size_; }
  const SizePanel& size() const { return *size_; }

 private:
  void offerLabelsOf(const std::string& uid);

  ReportCard* card_;
  ChoicePanel* choices_;
  SizePanel* size_;
  QWidget *size_box_, *labels_box_;
  std::vector<CtFolder::LabelFile> files_;
  std::string shown_;                  // uid of the series
  std::map<std::string, int> chosen_;  // rows, by a person, by the series's uid
  QComboBox* labels_;
  QLabel* size_note_;
};

}  // namespace trephine
