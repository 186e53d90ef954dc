// Parts that tests and styles find by name.
#pragma once

#include <QLabel>
#include <QPushButton>

namespace trephine {

// A button that Enter elsewhere in a dialog leaves alone.
inline QPushButton* namedButton(const char* name, const QString& text, bool primary = false,
                                QWidget* parent = nullptr) {
  auto* made = new QPushButton(text, parent);
  made->setObjectName(name);
  made->setAutoDefault(false);
  if (primary) made->setProperty("primary", true);
  return made;
}

// Words over several lines, whatever they hold.
inline QLabel* wrappedLabel(const char* name, QWidget* parent = nullptr) {
  auto* label = new QLabel(parent);
  label->setObjectName(name);
  label->setWordWrap(true);
  label->setTextFormat(Qt::PlainText);
  return label;
}

}  // namespace trephine
