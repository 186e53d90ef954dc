// What the import found out about one series: the verdict in a sentence, every finding with what
// was done and what it means, and the memory that reading it needs.
#pragma once

#include <QLabel>

#include "imaging/importer.h"

namespace trephine {

class ReportCard : public QWidget {
  Q_OBJECT
 public:
  // `questions` stand between the verdict and its reasons.
  explicit ReportCard(QWidget* questions = nullptr, QWidget* parent = nullptr);

  void showSeries(const SeriesReport& series, const Answers& answers, double needed_mb,
                  double free_mb);

 private:
  QLabel *mark_, *word_, *sentence_, *report_, *memory_;
};

}  // namespace trephine
