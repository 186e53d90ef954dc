// What is set of a new widget, action or layout where it is made, in one expression.
#pragma once

#include <QBoxLayout>
#include <QWidget>
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

// Without margins; `spacing` in pixels, negative: the style's.
template <class Layout>
Layout* tight(Layout* layout, int spacing = -1) {
  layout->setContentsMargins(0, 0, 0, 0);
  if (spacing >= 0) layout->setSpacing(spacing);
  return layout;
}

// One after the other.
inline void addAll(QBoxLayout& into, std::initializer_list<QWidget*> widgets) {
  for (QWidget* widget : widgets) into.addWidget(widget);
}

}  // namespace trephine
