// The tool bar's icons, drawn as outlines so that they are sharp on every screen.
#pragma once

#include <QIcon>

namespace trephine {

enum class Symbol {
  open,
  start,
  stop,
  pause,
  undo,
  redo,
  reset,
  back,
  picture,
  save,
  view,
  cases,
  prepare,
  train,
  review,
  settings
};

QIcon symbolIcon(Symbol symbol);

}  // namespace trephine
