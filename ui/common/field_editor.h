// A field of a form, made of its row (base/field.h): what a person sets there and a line that says
// what it does. It shows a value and tells what a person wants instead.
#pragma once

#include <QWidget>
#include <functional>
#include <string>
#include <memory>
#include <utility>
#include <vector>

#include "base/field.h"

class QBoxLayout;
class QLabel;

namespace trephine {

class FieldEditor : public QWidget {
 public:
  // The editor that tests and screen readers find is called `name`; of three numbers there are
  // three, with "X", "Y" and "Z" behind it; of choices one each, with ":" and the choice's name.
  FieldEditor(const FieldShape& field, const QString& name, QWidget* parent);
  ~FieldEditor() override;

  // A person wants this value.
  std::function<void(const FieldValue& wanted)> entered;

  // A text of one line that is being typed stays, and a text that was not taken while the value is
  // as it was, unless `same_owner` is false; lines that have the focus stay in any case; a number
  // that is being typed or refused goes.
  void show(const FieldValue& value, bool same_owner = true);
  // A number was typed that is out of its range, or a text that was not taken; it says so.
  bool isRefused() const;
  // A text of one line that is being typed counts as entered. Numbers and lines do so when the
  // focus leaves them: WorkGuards::takeTyped().
  void takeTyped();
  // What a reference may name: the words on the screen, and the name. Shown with the next show().
  using Offers = std::vector<std::pair<QString, std::string>>;
  void offer(const Offers& offers);
  // What a choice is called, what it means, and what else is to be said of it, as its cost.
  struct ChoiceText {
    QString words, meaning, note;
  };
  void describe(const std::function<ChoiceText(const std::string& choice)>& text);

  // What stands before it in its form; empty where it says so itself.
  QString label() const;
  // "Motion scale" of "motion_scale", or as its row says.
  static QString nameOf(const FieldRow& row);

 private:
  struct Part;  // a way to edit the value, of one kind each
  struct Numbers;
  struct Flag;
  struct Line;
  struct Lines;
  struct Paragraph;
  struct Reference;
  struct References;
  struct Choice;
  struct Choices;

  void want(const FieldValue& value);
  void setRefused(bool refused);

  FieldShape field_;
  FieldValue value_;
  std::unique_ptr<Part> part_;
  bool showing_ = false;
  bool refused_ = false;  // a text, which stays to be mended
  QLabel* not_applied_ = nullptr;
};

}  // namespace trephine
