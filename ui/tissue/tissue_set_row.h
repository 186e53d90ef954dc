// The name of the exercise's set of tissues, what is done with sets, and the history of edits.
#pragma once

#include <QLineEdit>
#include <QMenu>
#include <QToolButton>
#include <QWidget>
#include <filesystem>
#include <utility>
#include <vector>

namespace trephine {

class TissueSetRow : public QWidget {
  Q_OBJECT
 public:
  explicit TissueSetRow(QWidget* parent = nullptr);

  void show(const std::string& name);
  // Whether another name or set may be given.
  void setOpen(bool open);
  // Sets of this workstation, to be taken: a name and a file.
  void setSets(const std::vector<std::pair<QString, std::filesystem::path>>& sets);
  // What the last edit was; empty: there is none.
  void showHistory(const QString& undo, const QString& redo);

 signals:
  void renamed(const std::string& name);
  void newSetWanted();
  void duplicateWanted();
  void importWanted();
  void exportWanted();
  void revertWanted();
  void setWanted(const std::filesystem::path& file);
  void setsWanted();  // the menu opens: setSets()
  void undoWanted();
  void redoWanted();

 private:
  QMenu* buildMenu();
  void nameEntered();

  std::string shown_;
  QLineEdit* name_;
  QToolButton *menu_, *undo_, *redo_;
  QMenu* sets_;
};

}  // namespace trephine
