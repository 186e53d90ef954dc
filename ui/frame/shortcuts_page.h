// All keys of the window, made from the actions themselves: what one does is never written twice.
#pragma once

#include <QDialog>
#include <QMainWindow>

namespace trephine {

class ShortcutsPage : public QDialog {
  Q_OBJECT
 public:
  // Of every menu of the window, in its order. `views`: what keys do where no action has them, a
  // title and a sentence each.
  ShortcutsPage(const QMainWindow& window, const QList<QPair<QString, QString>>& views,
                QWidget* parent);
};

}  // namespace trephine
