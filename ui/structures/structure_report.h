// What a file of structures brought: what is to be said of it, and each structure with a picture,
// its mL, its HU and what was noticed of it. A dialog of its own beside the window.
#pragma once

#include <QDialog>
#include <memory>

#include "case/case.h"
#include "structures/structure_picture.h"
#include "ui/common/background_task.h"

class QLabel;
class QTreeWidget;

namespace trephine {

class StructureReport : public QDialog {
  Q_OBJECT
 public:
  // Of the structures that the case has from a file. Pictures follow once they are made, in the
  // background. Goes away when it is closed.
  explicit StructureReport(const Case& of, QWidget* parent = nullptr);

 private:
  using Pictures = std::vector<ColourPicture>;  // in the list's order
  void build();
  void drawPictures(const Case& of);
  void showPictures(const Pictures& pictures);

  QLabel* said_;
  QTreeWidget* list_;
  BackgroundTask drawing_;
};

}  // namespace trephine
