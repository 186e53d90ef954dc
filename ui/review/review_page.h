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
  // Those of one case (ListedRecording::caseKey()), until a person wants all again; empty: all.
  void showOnly(const std::string& case_key);
  std::size_t count() const { return all_rows_.size(); }
  void selectNewest() { list_->setCurrentItem(list_->topLevelItem(0)); }
  // False where it is not there.
  bool select(const std::filesystem::path& file);
  void showProgress(double fraction, const QString& step);
  void endProgress();
  void showOutcome(const QString& words) { outcome_->setText(words); }

 signals:
  void replayWanted(const trephine::ListedRecording& of);
  void cancelWanted();

 private:
  const ListedRecording* chosen() const;
  void showChosen();
  void fill();

  std::vector<ListedRecording> all_rows_;
  std::vector<ListedRecording> rows_;  // that are listed
  std::string only_;                   // of this case; empty: all
  bool all_read_ = false;
  std::string in_use_;
  std::map<std::string, QString> cases_;
  bool busy_ = false;
  QTreeWidget* list_;
  QLabel *empty_, *reading_, *outcome_, *step_;
  QPushButton *replay_, *cancel_;
  QWidget *progress_box_, *only_box_;
  QLabel* only_words_;
  QProgressBar* progress_;
};

}  // namespace trephine
