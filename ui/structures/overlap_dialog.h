// Which of the structures that share voxels has them: a list whose first one wins, moved up and
// down by buttons or Ctrl+Up and Ctrl+Down.
#pragma once

#include <QDialog>
#include <QListWidget>
#include <QPushButton>
#include <string>
#include <vector>

namespace trephine {

class OverlapDialog : public QDialog {
  Q_OBJECT
 public:
  // In the order that would be taken. Accepted or rejected, it goes away when it is closed.
  OverlapDialog(const std::vector<std::string>& names, QWidget* parent);

  std::vector<std::string> order() const;

 private:
  void move(int by);
  void showState();

  QListWidget* list_;
  QPushButton *up_, *down_;
};

}  // namespace trephine
