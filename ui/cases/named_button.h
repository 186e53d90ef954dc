// A button that tests and styles find by name, and that Enter elsewhere in a dialog leaves alone.
#pragma once

#include <QPushButton>

namespace trephine {

inline QPushButton* namedButton(const char* name, const QString& text, bool primary = false) {
  auto* made = new QPushButton(text);
  made->setObjectName(name);
  made->setAutoDefault(false);
  if (primary) made->setProperty("primary", true);
  return made;
}

}  // namespace trephine
