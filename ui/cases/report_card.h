// What the import found out about one series: the verdict in a sentence, every finding with what
// was done and what it means, and the memory that opening it and practising on it needs.
#pragma once

#include <QLabel>

#include "imaging/importer.h"

namespace trephine {

class ReportCard : public QWidget {
  Q_OBJECT
 public:
  // `questions` stand between the verdict and its reasons.
  explicit ReportCard(QWidget* questions = nullptr, QWidget* parent = nullptr);

  // `needed_mb`: memoryMb() less what the window has (kWindow_mb); 0: not known, and not said. MB
  // are of 2^20 bytes. The card is empty before the first call.
  void showSeries(const SeriesReport& series, const Answers& answers, double needed_mb,
                  double free_mb);

 private:
  QLabel *mark_, *word_, *sentence_, *report_, *memory_;
};

}  // namespace trephine
