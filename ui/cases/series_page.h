// The series that is selected: what the import found out about it and asks, how much of it is read
// and how finely, and which label map goes with it.
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QWidget>
#include <filesystem>
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

  // Another one, or none (null); `before` it was read it had these questions and this grid.
  void show(const SeriesReport* series, const SeriesReport* before, const Answers& answers);
  // The label maps that lie beside the CT; none is taken until it is chosen.
  void showLabelFiles(const std::vector<CtFolder::LabelFile>& files);
  std::filesystem::path labelFile() const;  // empty: none
  // Why the box cannot be drawn; empty: it can.
  void noteSize(const QString& words);

  ReportCard& card() { return *card_; }
  ChoicePanel& choices() { return *choices_; }
  SizePanel& size() { return *size_; }
  const SizePanel& size() const { return *size_; }

 private:
  ReportCard* card_;
  ChoicePanel* choices_;
  SizePanel* size_;
  QWidget *size_box_, *labels_box_;
  QComboBox* labels_;
  QLabel* size_note_;
};

}  // namespace trephine
