// One of the window's workspaces: what it shows beside and under the views, and what it does. Each
// knows its own panels and nobody else's; what all share is the shared context.
#pragma once

#include <QObject>
#include <QString>
#include <QWidget>

#include "ui/common/icons.h"

namespace trephine {

enum class Place { cases, prepare, train, review };

class Workspace : public QObject {
  Q_OBJECT
 public:
  // With a `page` it has the window to itself; else the views, with its panels around them. Null:
  // none. The window owns them.
  struct Parts {
    QWidget* page = nullptr;
    QWidget* left = nullptr;
    QWidget* right = nullptr;
    QWidget* below = nullptr;
  };

  using QObject::QObject;
  virtual QString title() const = 0;
  virtual Symbol symbol() const = 0;
  virtual Parts parts() = 0;
  // Another one comes, this one comes. The widgets are there already.
  virtual void leave() {}
  virtual void enter() {}
  // Esc, where nothing else in the window had a use for it. False: neither has this workspace.
  virtual bool escape() { return false; }
};

}  // namespace trephine
