// Importing: the series of a folder or file, what the import found out about each, a look at its
// slices, the questions it asks, how much of it is read and how finely. What comes out is a volume.
// It shows what ImportTask knows and asks it for work; it decides nothing about images.
#pragma once

#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QStackedWidget>
#include <map>

#include "case/case.h"
#include "ui/cases/import_bar.h"
#include "ui/cases/late_questions.h"
#include "ui/cases/series_list.h"
#include "ui/cases/series_page.h"
#include "ui/views/slice_preview.h"
#include "ui/work/import_task.h"

namespace trephine {

class ImportPage : public QWidget {
  Q_OBJECT
 public:
  // opened() when the task begins to scan.
  using Step = ImportStep;
  explicit ImportPage(ImportTask& task, QWidget* parent = nullptr);

  void open();  // the folder scanned last, once more
  void say(const QString& text);
  // A series is read, or was and is asked about.
  bool importing() const { return step_ == Step::reading || step_ == Step::asking; }

 public slots:
  void reject();

 signals:
  void opened();  // it is to be shown
  void closed();  // and no longer
  void folderWanted();
  void fileWanted();
  void pathDropped(const QString& path);
  void reportWanted(const QString& uid);  // of the selected series; empty: there is none
  // `labels`: the file to take as its label map; empty for none.
  void caseRead(const trephine::Case& read, const std::filesystem::path& labels);

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void build();
  QWidget* buildFolderColumn();
  void connectParts();

  void showStep(Step step);
  void scanned();
  void showFolder();
  void stopped();
  void readDone();
  void seriesSelected();
  void showSelected();
  void showImportButton();
  void takeFound();
  void showSlice(const QString& uid, int index, const Result<SlicePicture>& picture);
  void showKept();
  void sliceWanted(int index);
  void showCouch(int k);
  void boxDrawn(const QRect& pixels);
  void import();
  void ask(const SeriesReport& after, const std::vector<Choice>& questions);
  void answered();
  void openCase();
  void back();
  const SeriesReport* selected() const;           // as the last read left it
  SeriesReport* before();                         // the same before it was read
  double neededMb(const ImportRequest& request);  // of memory, by the selected series
  void listSelected();
  Answers& answers() { return answers_[list_->selectedUid()]; }

  ImportTask& task_;
  bool active_ = false;  // opened, not closed
  Step step_ = Step::empty;
  // As scanned: what a read leaves of a series has other questions and the size that was asked for.
  std::vector<SeriesReport> before_;
  std::map<std::string, Answers> answers_;  // by uid, as long as the folder is open
  ImportRequest request_;                   // what is being read
  bool loss_told_ = false;                  // of it
  bool found_taken_ = false;                // the scan ends with the series that was selected

  SeriesList* list_;
  QLabel* folder_;
  SlicePreview* preview_;
  QStackedWidget* right_;
  QScrollArea *series_area_, *late_area_;
  SeriesPage* series_;
  LateQuestions* late_;
  ImportBar* bar_;
  QPushButton *open_folder_, *open_file_, *scan_on_;
};

}  // namespace trephine
