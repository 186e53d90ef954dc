// The rail at the window's left: the workspaces, one of which is shown.
#pragma once

#include <QActionGroup>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidget>

#include "ui/work/workspace.h"

namespace trephine {

class Rail : public QWidget {
  Q_OBJECT
 public:
  explicit Rail(QWidget& window);

  // Below the ones before; its action has the key Ctrl and its number from 1.
  void add(Place place, const Workspace& workspace);
  QList<QAction*> actions() const { return group_->actions(); }
  void show(Place place);

 signals:
  void chosen(trephine::Place place);

 private:
  QWidget& window_;
  QActionGroup* group_;
  QVBoxLayout* layout_;
};

}  // namespace trephine
