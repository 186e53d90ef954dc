// The recordings: when, which exercise, on which case, how long; and whether one replays bit for
// bit.
#pragma once

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QTreeWidget>
#include <QWidget>
#include <map>
#include <string>
#include <vector>

#include "training/recording_list.h"

namespace trephine {

class ReviewPage : public QWidget {
  Q_OBJECT
 public:
  explicit ReviewPage(QWidget* parent = nullptr);

  // `in_use` is the sha256 of the open case's voxels, or empty; `cases`: those at hand, names by
  // ListedRecording::caseKey().
  // Not `all` of them while the folder is still being read.
  void showRecordings(const std::vector<ListedRecording>& rows, bool all, const std::string& in_use,
                      const std::map<std::string, QString>& cases);
  void showReading(double fraction) {
    reading_->setText(tr("Reading the recordings\u2026 %1 %").arg(int(fraction * 100.0)));
  }
  void showNoRecordings(const QString& why);
  std::size_t count() const { return rows_.size(); }
  void selectNewest() { list_->setCurrentItem(list_->topLevelItem(0)); }
  // False where it is not there.
  bool select(const std::filesystem::path& file);
  // The newest of a case.
  bool selectNewestOf(const std::string& case_key);
  void showProgress(double fraction, const QString& step);
  void endProgress();
  void showOutcome(const QString& words) { outcome_->setText(words); }

 signals:
  void replayWanted(const trephine::ListedRecording& of);
  void cancelWanted();

 private:
  const ListedRecording* chosen() const;
  void showChosen();

  std::vector<ListedRecording> rows_;
  std::string in_use_;
  std::map<std::string, QString> cases_;
  bool busy_ = false;
  QTreeWidget* list_;
  QLabel *empty_, *reading_, *outcome_, *step_;
  QPushButton *replay_, *cancel_;
  QWidget* progress_box_;
  QProgressBar* progress_;
};

}  // namespace trephine
