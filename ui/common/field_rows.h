// The fields of one owner in a form, made of their rows (base/field.h).
#pragma once

#include <QFormLayout>
#include <QLabel>
#include <algorithm>
#include <functional>
#include <string_view>
#include <vector>

#include "base/field.h"
#include "ui/common/field_editor.h"

namespace trephine {

// `fields` outlives it, it outlives its editors, and it is neither copied nor moved. GUI thread.
template <class Owner>
class FieldRows {
 public:
  // Editors are called `prefix` and the row's key. Rows of one key are one field, of one member,
  // which some owners have by one row and some by another (FieldOnlyIf).
  FieldRows(FieldsOf<Owner> fields, QFormLayout& form, QWidget* parent, const QString& prefix)
      : form_(form) {
    for (const FieldOf<Owner>& field : fields) addRow(field, parent, prefix);
  }

  // A person wants this owner: a copy with one field changed. Who takes it calls show() with it;
  // who does not call it refuses it, and the field goes back (a text stays to be mended). `key` is
  // the field's.
  std::function<void(const Owner& wanted, const char* key)> entered;

  // Fields that the owner does not have are not shown. A text of one line that is being typed
  // stays, unless `same_owner` is false; lines that have the focus stay in any case; a number that
  // is being typed or refused goes.
  void show(const Owner& owner, bool same_owner = true) {
    owner_ = owner;
    for (const Row& row : rows_) {
      row.editor->show(valueOf(*row.fields.front(), owner_), same_owner);
      const bool has =
          std::ranges::any_of(row.fields, [&](auto* field) { return field->appliesTo(owner_); });
      form_.setRowVisible(row.editor, visible_ && has);
    }
  }
  // Whether a number stands there that is out of its range, which its field says itself.
  bool anyRefused() const {
    return std::ranges::any_of(rows_, [](const Row& row) { return row.editor->isRefused(); });
  }
  // A text of one line that is being typed counts as entered. Numbers and lines do so when the
  // focus leaves them: WorkGuards::takeTyped().
  void takeTyped() {
    for (const Row& row : rows_) row.editor->takeTyped();
  }
  // Shows or hides all of them; those that the owner lacks stay hidden.
  void setVisible(bool visible) {
    visible_ = visible;
    show(Owner(owner_));
  }
  // False: they stay in sight, greyed.
  void setEnabled(bool enabled) {
    for (const Row& row : rows_) row.editor->setEnabled(enabled);
  }
  // The editor of a field; there must be a row of that key.
  FieldEditor& operator[](std::string_view key) const {
    return *std::ranges::find(rows_, key, [](const Row& row) {
              return std::string_view(row.fields.front()->row.key);
            })->editor;
  }

 private:
  struct Row {
    FieldEditor* editor;
    std::vector<const FieldOf<Owner>*> fields;
  };

  void addRow(const FieldOf<Owner>& field, QWidget* parent, const QString& prefix) {
    for (Row& row : rows_) {
      if (std::string_view(row.fields.front()->row.key) != field.row.key) continue;
      return row.fields.push_back(&field);
    }
    auto* editor = new FieldEditor(shapeOf(field), prefix + field.row.key, parent);
    editor->entered = [this, &field](const FieldValue& value) {
      Owner wanted = owner_;
      setValue(field, wanted, value);
      if (entered) entered(wanted, field.row.key);
    };
    if (editor->label().isEmpty()) {
      form_.addRow(editor);
    } else {
      auto* label = new QLabel(editor->label(), parent);
      label->setBuddy(editor);
      form_.addRow(label, editor);
    }
    rows_.push_back({editor, {&field}});
  }

  QFormLayout& form_;
  Owner owner_{};
  std::vector<Row> rows_;
  bool visible_ = true;
};

}  // namespace trephine
