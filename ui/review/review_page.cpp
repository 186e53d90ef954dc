#include "ui/review/review_page.h"

#include <QDateTime>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QScrollBar>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>
#include <chrono>
#include <iterator>

#include "ui/common/making.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kProgressSteps = 1000;
constexpr int kTimeColumn = 0, kExerciseColumn = 1, kCaseColumn = 2, kLengthColumn = 3,
              kStateColumn = 4;

QDateTime timeOf(const ListedRecording& row) {
  const auto time = std::chrono::file_clock::to_sys(row.written);
  return QDateTime::fromSecsSinceEpoch(
      std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count());
}

}  // namespace

ReviewPage::ReviewPage(QWidget* parent) : QWidget(parent) {
  auto* title = looking(new QLabel(tr("Recorded exercises")), {"heading"});
  list_ = named(new QTreeWidget, "recordings");
  list_->setRootIsDecorated(false);
  list_->setAllColumnsShowFocus(true);
  list_->setHeaderLabels({tr("Ended"), tr("Exercise"), tr("Case"), tr("Length"), tr("State")});
  list_->header()->setSectionResizeMode(kExerciseColumn, QHeaderView::Stretch);
  list_->header()->setStretchLastSection(false);
  for (int column : {kTimeColumn, kCaseColumn, kLengthColumn, kStateColumn}) {
    list_->header()->setSectionResizeMode(column, QHeaderView::ResizeToContents);
  }
  empty_ = wrappedLabel("noRecordings", {"quiet"});
  empty_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  reading_ = namedLabel("readingRecordings", {"quiet"});
  outcome_ = wrappedLabel("replayOutcome");
  replay_ = namedButton("replay", tr("&Check by replay"));
  replay_->setToolTip(
      tr("Computes the exercise again from what the arms did, and compares every bit"));
  step_ = new QLabel;
  progress_ = thinProgress("replayProgress", kProgressSteps);
  cancel_ = namedButton("cancelReplay", tr("Cancel"));
  progress_box_ = new QWidget;
  auto* progress_row = tight(new QHBoxLayout(progress_box_));
  progress_row->addWidget(step_);
  progress_row->addWidget(progress_, 1);
  progress_row->addWidget(cancel_);
  progress_box_->hide();

  only_box_ = new QWidget;
  only_words_ = namedLabel("onlyOf");
  auto* all = namedButton("showAllRecordings", tr("Show &all"));
  auto* only_row = tight(new QHBoxLayout(only_box_));
  only_row->addWidget(only_words_);
  only_row->addWidget(all);
  only_row->addStretch(1);
  connect(all, &QPushButton::clicked, this, [this] { showOnly({}); });

  auto* buttons = new QHBoxLayout;
  buttons->addWidget(replay_);
  buttons->addWidget(progress_box_, 1);
  buttons->addStretch(0);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(16, 12, 16, 12);
  layout->setSpacing(10);
  layout->addWidget(title);
  layout->addWidget(only_box_);
  layout->addWidget(reading_);
  layout->addWidget(empty_, 1);
  layout->addWidget(list_, 1);
  layout->addLayout(buttons);
  layout->addWidget(outcome_);
  connect(list_, &QTreeWidget::currentItemChanged, this, &ReviewPage::showChosen);
  connect(replay_, &QPushButton::clicked, this, [this] {
    if (const ListedRecording* of = chosen()) emit replayWanted(*of);
  });
  connect(cancel_, &QPushButton::clicked, this, &ReviewPage::cancelWanted);
  showRecordings({}, false, {}, {});
  showReading(0.0);
}

const ListedRecording* ReviewPage::chosen() const {
  const int row = list_->indexOfTopLevelItem(list_->currentItem());
  return row >= 0 && std::size_t(row) < rows_.size() ? &rows_[std::size_t(row)] : nullptr;
}

void ReviewPage::showNoRecordings(const QString& why) {
  reading_->setText(why);
  reading_->show();
}

void ReviewPage::showRecordings(const std::vector<ListedRecording>& rows, bool all,
                                const std::string& in_use,
                                const std::map<std::string, QString>& cases) {
  reading_->setVisible(!all);
  all_read_ = all;
  cases_ = cases;
  in_use_ = in_use;
  all_rows_ = rows;
  fill();
}

void ReviewPage::showOnly(const std::string& case_key) {
  only_ = case_key;
  fill();
}

void ReviewPage::fill() {
  const auto of_only = cases_.find(only_);
  only_box_->setVisible(!only_.empty());
  only_words_->setText(of_only == cases_.end() ? tr("Those of one case")
                                               : tr("Those of \"%1\"").arg(of_only->second));
  empty_->setText(!all_read_      ? QString()
                  : only_.empty() ? tr("No exercise has been recorded yet. Each one that is done "
                                       "in Train is.")
                                  : tr("No exercise has been recorded on this case yet."));
  const ListedRecording* before = chosen();
  const std::filesystem::path file = before ? before->file : std::filesystem::path();
  const QString outcome = outcome_->text();
  const int scrolled = list_->verticalScrollBar()->value();
  const QSignalBlocker unmoved(list_);
  list_->clear();
  rows_.clear();
  std::ranges::copy_if(all_rows_, std::back_inserter(rows_), [&](const ListedRecording& row) {
    return only_.empty() || row.caseKey() == only_;
  });
  for (const ListedRecording& row : rows_) {
    auto* item = new QTreeWidgetItem(list_);
    item->setText(kTimeColumn, QLocale().toString(timeOf(row), QLocale::ShortFormat));
    item->setText(kExerciseColumn, toQt(row.exercise));
    const auto name = cases_.find(row.caseKey());
    if (!row.caseKey().empty()) {
      item->setText(kCaseColumn, name != cases_.end() ? name->second : tr("not here"));
    }
    item->setText(kLengthColumn, timeWords(std::uint32_t(row.seconds)));
    item->setTextAlignment(kLengthColumn, Qt::AlignRight | Qt::AlignVCenter);
    item->setText(kStateColumn, row.problem     ? toQt(row.problem->what)
                                : row.cut_short ? tr("ended early")
                                                : tr("whole"));
    if (row.file == file) list_->setCurrentItem(item);
  }
  if (!list_->currentItem() && !rows_.empty()) list_->setCurrentItem(list_->topLevelItem(0));
  empty_->setVisible(rows_.empty());
  list_->setVisible(!rows_.empty());
  list_->verticalScrollBar()->setValue(scrolled);
  showChosen();
  // What a replay came to stays, while the list grows around the one that is chosen.
  const ListedRecording* now = chosen();
  if (now && now->file == file && !now->problem && !outcome.isEmpty()) outcome_->setText(outcome);
}

bool ReviewPage::select(const std::filesystem::path& file) {
  const auto row = std::ranges::find(rows_, file, &ListedRecording::file);
  if (row == rows_.end()) return false;
  list_->setCurrentItem(list_->topLevelItem(int(row - rows_.begin())));
  return true;
}

void ReviewPage::showChosen() {
  const ListedRecording* of = chosen();
  const bool at_hand = of && (cases_.contains(of->caseKey()) || of->volume_sha256 == in_use_);
  replay_->setVisible(!rows_.empty());
  replay_->setEnabled(of && !of->problem && at_hand && !busy_);
  outcome_->setText(of && of->problem ? toQt(of->problem->sentence())
                    : of && !at_hand  ? tr("The case that it was done on is not kept here. Open "
                                            "that case, to replay it.")
                                      : QString());
}

void ReviewPage::showProgress(double fraction, const QString& step) {
  busy_ = true;
  progress_box_->show();
  step_->setText(step);
  progress_->setValue(int(fraction * kProgressSteps));
  replay_->setEnabled(false);
}

void ReviewPage::endProgress() {
  busy_ = false;
  progress_box_->hide();
  showChosen();
}

}  // namespace trephine
