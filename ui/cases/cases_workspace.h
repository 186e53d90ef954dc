// Cases: what there is to practise on, and how it gets here: the library's page and the page of the
// importer, and all that is asked on the way. Between these, the library, the import task and the
// workstation. What is imported is saved once it is open, so that nobody waits for the disk.
#pragma once

#include <QStackedWidget>

#include "library/case_library.h"
#include "ui/cases/cases_page.h"
#include "ui/cases/import_page.h"
#include "ui/work/app_context.h"

namespace trephine {

class CasesWorkspace : public Workspace {
  Q_OBJECT
 public:
  explicit CasesWorkspace(AppContext& app);

  QString title() const override { return tr("Cases"); }
  Symbol symbol() const override { return Symbol::cases; }
  Parts parts() override;
  void enter() override {
    list();
    listRecordings();
  }

  // A folder or file of CT, or an exercise, which asks first where it takes what is not saved.
  void open(const std::filesystem::path& path);
  bool importing() const { return import_->importing(); }
  bool mayOpen() const { return open_->isEnabled(); }
  QList<QAction*> openActions() const { return {open_, open_file_, open_exercise_}; }
  // Of the folder that was scanned last: PDF or HTML.
  void saveReport(const QString& file, const QString& uid = {});

 signals:
  void caseSaved(const QString& name);  // what was imported, under this name
  void listed();                        // the cards are those on the disk

 private:
  void connectParts();
  void askForFolder();
  void askForFile();
  void askForExercise();
  void list();
  void listRecordings();
  std::vector<std::filesystem::path> madeOn(const CaseEntry& entry) const;  // exercises
  void openEntry(const CaseEntry& entry, Place then);
  void openPhantom(const std::string& name);
  void saveCase();
  void saved(const SavedCase& saved);
  void rename(const CaseEntry& entry, const QString& name);
  void askToDelete(const CaseEntry& entry);
  void showReport(const CaseEntry& entry);
  void caseRead(Case read, const std::filesystem::path& labels);
  void showCase();
  void showPhase();

  AppContext& app_;
  Workstation& workstation_;
  Messages& messages_;
  WorkGuards& guards_;
  QAction *open_, *open_file_, *open_exercise_;
  QStackedWidget* pages_;
  CasesPage* page_;
  ImportPage* import_;
  // What the importer knows of the volume that is being opened, until that is saved.
  std::optional<NewCase> import_to_save_;
  bool open_deleted_ = false;  // the open case was; it is not offered to be saved
  bool list_again_ = false, read_again_ = false;
  BackgroundTask listing_, reading_, changing_;  // last: joined before what they use goes
};

}  // namespace trephine
