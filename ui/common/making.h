// What is set of a new widget, action or layout where it is made, in one expression.
#pragma once

#include <QBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <initializer_list>

namespace trephine {

using Looks = std::initializer_list<const char*>;

// `looks`: what the style sheet draws otherwise ("quiet", "large", "title", "heading").
template <class Object>
Object* looking(Object* object, Looks looks) {
  for (const char* look : looks) object->setProperty(look, true);
  return object;
}

// With the name by which settings and tests find it.
template <class Object>
Object* named(Object* object, const QString& name, Looks looks = {}) {
  object->setObjectName(name);
  return looking(object, looks);
}

template <class Label>
Label* wrapped(Label* label) {
  label->setWordWrap(true);
  return label;
}

// Without margins, or with these alone; `spacing` in pixels, negative: the style's.
template <class Layout>
Layout* tight(Layout* layout, int spacing = -1, const QMargins& margins = {}) {
  layout->setContentsMargins(margins);
  if (spacing >= 0) layout->setSpacing(spacing);
  return layout;
}

// A button that Enter elsewhere in a dialog leaves alone.
inline QPushButton* namedButton(const char* name, const QString& text, bool primary = false,
                                QWidget* parent = nullptr) {
  auto* button = named(new QPushButton(text, parent), name);
  button->setAutoDefault(false);
  if (primary) looking(button, {"primary"});
  return button;
}

// Words that a part fills in.
inline QLabel* namedLabel(const char* name, Looks looks = {}) {
  return named(new QLabel, name, looks);
}

// The same over several lines, as plain text: whatever they hold.
inline QLabel* wrappedLabel(const char* name, Looks looks = {}) {
  QLabel* label = wrapped(namedLabel(name, looks));
  label->setTextFormat(Qt::PlainText);
  return label;
}

// How far something is, as a thin bar of so many steps.
inline QProgressBar* thinProgress(const char* name, int steps) {
  auto* bar = named(new QProgressBar, name);
  bar->setRange(0, steps);
  bar->setTextVisible(false);
  bar->setMaximumHeight(14);
  return bar;
}

// One after the other.
inline void addAll(QBoxLayout& into, std::initializer_list<QWidget*> widgets) {
  for (QWidget* widget : widgets) into.addWidget(widget);
}

}  // namespace trephine
