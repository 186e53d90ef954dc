#include "ui/common/field_editor.h"

#include <QCheckBox>
#include <QComboBox>
#include <QCoreApplication>
#include <QEvent>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QPlainTextEdit>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "base/utf8.h"
#include "ui/common/making.h"
#include "ui/common/number_field.h"
#include "ui/common/setting_words.h"
#include "ui/common/translations.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

QString capital(QString words) {
  if (!words.isEmpty()) words[0] = words[0].toUpper();
  return words;
}

std::vector<std::string> textsOf(const FieldValue& value) {
  return std::get<std::vector<std::string>>(value);
}

bool isTyped(const FieldShape& field) {
  return field.kind == FieldKind::text || field.kind == FieldKind::lines;
}

void setRows(QWidget& box, int rows) {
  box.setMaximumHeight(rows * box.fontMetrics().height() + 12);
}

}  // namespace

struct FieldEditor::Part {
  Part(FieldEditor& of, const QString& name) : of(of), name(name) {}
  virtual ~Part() = default;
  virtual void show(const FieldValue& value) = 0;
  virtual bool isRefused() const { return false; }
  virtual void takeTyped() {}
  virtual void forgetTyped() {}
  virtual void offer(const Offers&) {}
  virtual void describe(const std::function<ChoiceText(const std::string&)>&) {}

  template <class Editor>
  Editor* made(Editor* editor) {
    editor->setObjectName(name);
    editor->setAccessibleName(nameOf(of.field_.row).remove('&'));
    of.setFocusProxy(editor);
    return editor;
  }

  FieldEditor& of;
  QString name;
};

// One number, or three.
struct FieldEditor::Numbers : Part {
  Numbers(FieldEditor& of, const QString& name, QVBoxLayout& column) : Part(of, name) {
    const FieldKind kind = of.field_.kind;
    const bool three = kind == FieldKind::three_numbers || kind == FieldKind::direction;
    auto* beside = tight(new QHBoxLayout, 3);
    for (int part = 0; part < (three ? 3 : 1); ++part) {
      const char* const parts[] = {"X", "Y", "Z"};
      beside->addLayout(add(three ? name + parts[part] : name, three, part), 1);
    }
    column.addLayout(beside);
    of.setFocusProxy(boxes.front());
  }
  QLayout* add(const QString& called, bool three, int part) {
    const FieldRow& row = of.field_.row;
    const bool whole = of.field_.kind == FieldKind::whole;
    auto* box = new DecimalField(called, &of);
    const char* const unit = *row.shown_unit ? row.shown_unit : row.range.unit;
    box->setDecimals(row.decimals >= 0 ? row.decimals
                     : whole           ? 0
                     : !three || row.range.high <= 10.0 ? 3
                                                        : 1);
    box->setLimits(row.range.low * row.shown_per, row.range.high * row.shown_per);
    box->setSingleStep(row.step > 0.0 ? row.step : whole ? 1.0 : stepOfUnit(unit));
    if (!three && *unit) box->setSuffix(' ' + QString(unit));
    if (three) box->setButtonSymbols(QAbstractSpinBox::NoButtons);
    constexpr int kLeast_px = 34;  // of a narrow column, three beside each other
    box->setMinimumWidth(kLeast_px);
    box->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    box->setAccessibleName(nameOf(row));
    box->setToolTip(meaningOf(row));
    box->entered = [this, part] { take(part); };
    boxes.push_back(box);
    return box->withReason();
  }
  // As it is shown.
  double number(int part) const {
    const auto* one = std::get_if<double>(&of.value_);
    return of.field_.row.shown_per * (one ? *one : std::get<Vec3>(of.value_)[part]);
  }
  bool isRefused() const override {
    return std::ranges::any_of(boxes, &DecimalField::isRefused);
  }
  void show(const FieldValue&) override {
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i]->show(number(int(i)));
  }
  void take(int part) {
    const DecimalField& box = *boxes[std::size_t(part)];
    // What is shown rounded and was not typed stays to the digit.
    if (std::abs(box.wanted() - number(part)) < 0.5 * std::pow(10.0, -box.decimals())) return;
    FieldValue wanted = of.value_;
    if (auto* three = std::get_if<Vec3>(&wanted)) {
      (*three)[part] = box.wanted() / of.field_.row.shown_per;
      const double length = glm::length(*three);
      if (of.field_.kind == FieldKind::direction && length > 0.0) *three /= length;
    } else {
      wanted = box.wanted() / of.field_.row.shown_per;
    }
    of.want(wanted);
  }
  std::vector<DecimalField*> boxes;
};

struct FieldEditor::Flag : Part {
  Flag(FieldEditor& of, const QString& name, QVBoxLayout& column) : Part(of, name) {
    box = made(new QCheckBox(nameOf(of.field_.row), &of));
    QObject::connect(box, &QCheckBox::toggled, &of, [this](bool on) { this->of.want(on); });
    column.addWidget(box);
  }
  void show(const FieldValue& value) override { box->setChecked(std::get<bool>(value)); }
  QCheckBox* box;
};

// A text of one line; an empty one is given up where there must be one.
struct FieldEditor::Line : Part {
  Line(FieldEditor& of, const QString& name, QVBoxLayout& column) : Part(of, name) {
    edit = made(new QLineEdit(&of));
    if (of.field_.row.range.high > 0.0) edit->setMaxLength(int(of.field_.row.range.high));
    QObject::connect(edit, &QLineEdit::editingFinished, &of, [this] { take(); });
    column.addWidget(edit);
  }
  void take() {
    const std::string typed = cleanUtf8(edit->text().toStdString());
    edit->setModified(false);
    const bool needed = of.field_.row.range.low >= 1.0;
    if (typed == std::get<std::string>(of.value_) || (typed.empty() && needed)) {
      of.setRefused(false);
      return show(of.value_);
    }
    // Its own undo ends here: Ctrl+Z takes back edits from now on.
    const int at = edit->cursorPosition();
    edit->setText(edit->text());
    edit->setCursorPosition(at);
    of.want(typed);
  }
  void takeTyped() override {
    if (edit->isModified()) take();
  }
  void forgetTyped() override { edit->setModified(false); }
  void show(const FieldValue& value) override {
    if (edit->hasFocus() && edit->isModified()) return;
    const QString text = toQt(std::get<std::string>(value));
    if (edit->text() == text) return;
    edit->setText(text);
    edit->setCursorPosition(0);
    edit->setToolTip(text);
  }
  QLineEdit* edit;
};

// A text that is read over several lines and has none of its own: Return leaves the field.
struct FieldEditor::Paragraph : Part, QObject {
  Paragraph(FieldEditor& of, const QString& name, QVBoxLayout& column) : Part(of, name) {
    edit = made(new QPlainTextEdit(&of));
    edit->setTabChangesFocus(true);
    edit->setMinimumWidth(34);  // of a narrow column
    edit->setFixedHeight(of.field_.row.lines * edit->fontMetrics().lineSpacing() + 12);
    edit->installEventFilter(this);
    column.addWidget(edit);
  }
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::FocusOut) takeTyped();
    if (event->type() == QEvent::KeyPress) {
      const int key = static_cast<QKeyEvent*>(event)->key();
      if (key == Qt::Key_Return || key == Qt::Key_Enter) {
        takeTyped();
        QCoreApplication::sendEvent(&of, event);  // as a line edit hands it on
        return true;
      }
    }
    return QObject::eventFilter(watched, event);
  }
  void take() {
    QString line = edit->toPlainText();  // what was pasted may have several
    const std::string typed = cleanUtf8(line.replace('\n', ' ').trimmed().toStdString());
    edit->document()->setModified(false);
    const bool needed = of.field_.row.range.low >= 1.0;
    if (typed == std::get<std::string>(of.value_) || (typed.empty() && needed)) {
      of.setRefused(false);
      return show(of.value_);
    }
    of.want(typed);
  }
  void takeTyped() override {
    if (edit->document()->isModified()) take();
  }
  void forgetTyped() override { edit->document()->setModified(false); }
  void show(const FieldValue& value) override {
    if (edit->hasFocus() && edit->document()->isModified()) return;
    const QString text = toQt(std::get<std::string>(value));
    if (edit->toPlainText() != text) edit->setPlainText(text);
  }
  QPlainTextEdit* edit;
};

// A list of texts, one a line.
struct FieldEditor::Lines : Part, QObject {
  Lines(FieldEditor& of, const QString& name, QVBoxLayout& column) : Part(of, name) {
    edit = made(new QPlainTextEdit(&of));
    edit->setTabChangesFocus(true);
    edit->setMinimumWidth(34);  // of a narrow column
    edit->setFixedHeight(6 * edit->fontMetrics().height());
    edit->installEventFilter(this);
    column.addWidget(edit);
  }
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::FocusOut) {
      std::vector<std::string> texts;
      for (const QString& line : edit->toPlainText().split('\n')) {
        if (std::string text = cleanUtf8(line.toStdString()); !text.empty()) {
          texts.push_back(std::move(text));
        }
      }
      if (texts != textsOf(of.value_)) {
        of.want(texts);
      } else {
        of.setRefused(false);
      }
    }
    return QObject::eventFilter(watched, event);
  }
  void show(const FieldValue& value) override {
    QStringList lines;
    for (const std::string& text : textsOf(value)) lines << toQt(text);
    const QString text = lines.join('\n');
    if (!edit->hasFocus() && edit->toPlainText() != text) edit->setPlainText(text);
  }
  QPlainTextEdit* edit;
};

// The name of something else: one of those that are offered. Another name stays to be seen.
struct FieldEditor::Reference : Part {
  Reference(FieldEditor& of, const QString& name, QVBoxLayout& column) : Part(of, name) {
    box = settingChoice(qPrintable(name), nameOf(of.field_.row), &of);
    QObject::connect(box, &QComboBox::activated, &of,
                     [this](int) { this->of.want(box->currentData().toString().toStdString()); });
    column.addWidget(box);
  }
  void offer(const Offers& names) override { offers = names; }
  void show(const FieldValue& value) override {
    const QString name = toQt(std::get<std::string>(value));
    box->clear();
    for (const auto& [words, of_it] : offers) box->addItem(words, toQt(of_it));
    if (box->findData(name) < 0) box->addItem(name, name);
    box->setCurrentIndex(box->findData(name));
  }
  QComboBox* box;
  Offers offers;
};

// Some of those that are offered, in their order.
struct FieldEditor::References : Part {
  References(FieldEditor& of, const QString& name, QVBoxLayout& column) : Part(of, name) {
    list = made(new QListWidget(&of));
    setRows(*list, 4);
    QObject::connect(list, &QListWidget::itemChanged, &of, [this] {
      std::vector<std::string> names;
      for (int i = 0; i < list->count(); ++i) {
        const QListWidgetItem& item = *list->item(i);
        if (item.checkState() == Qt::Checked) {
          names.push_back(item.data(Qt::UserRole).toString().toStdString());
        }
      }
      this->of.want(names);
    });
    column.addWidget(list);
  }
  void offer(const Offers& names) override { offers = names; }
  void show(const FieldValue& value) override {
    const std::vector<std::string> chosen = textsOf(value);
    Offers all = offers;
    for (auto name = chosen.rbegin(); name != chosen.rend(); ++name) {
      const bool offered = std::ranges::find(offers, *name, &Offers::value_type::second) != offers.end();
      if (!offered) all.insert(all.begin(), {toQt(*name), *name});
    }
    list->clear();
    for (const auto& [words, name] : all) {
      auto* item = new QListWidgetItem(words, list);
      item->setData(Qt::UserRole, toQt(name));
      item->setFlags(item->flags() | Qt::ItemIsUserCheckable);
      const bool has = std::ranges::find(chosen, name) != chosen.end();
      item->setCheckState(has ? Qt::Checked : Qt::Unchecked);
    }
  }
  QListWidget* list;
  Offers offers;
};

struct FieldEditor::Choice : Part {
  Choice(FieldEditor& of, const QString& name, QVBoxLayout& column) : Part(of, name) {
    box = settingChoice(qPrintable(name), nameOf(of.field_.row), &of);
    for (const std::string_view choice : of.field_.names) {
      const QString named = toQt(std::string(choice));
      box->addItem(capital(fromRoom(qPrintable(named))), named);
    }
    QObject::connect(box, &QComboBox::activated, &of,
                     [this](int) { this->of.want(box->currentData().toString().toStdString()); });
    note = settingText(qPrintable(name + ":note"), &of);
    note->setProperty("quiet", true);
    meaning = settingHint({}, &of);
    column.addWidget(box);
    column.addWidget(note);
    column.addWidget(meaning);
    showText();
  }
  void describe(const std::function<ChoiceText(const std::string&)>& by) override {
    text = by;
    for (int i = 0; i < box->count(); ++i) box->setItemText(i, textOf(i).words);
    showText();
  }
  ChoiceText textOf(int item) const {
    return text ? text(box->itemData(item).toString().toStdString()) : ChoiceText{};
  }
  void showText() {
    const ChoiceText of_it = textOf(box->currentIndex());
    note->setText(of_it.note);
    note->setVisible(!of_it.note.isEmpty());
    meaning->setText(of_it.meaning);
    meaning->setVisible(!of_it.meaning.isEmpty());
  }
  void show(const FieldValue& value) override {
    box->setCurrentIndex(box->findData(toQt(std::get<std::string>(value))));
    showText();
  }
  QComboBox* box;
  QLabel *note, *meaning;
  std::function<ChoiceText(const std::string&)> text;
};

struct FieldEditor::Choices : Part {
  struct One {
    std::string name;
    QCheckBox* box;
    QLabel *note, *meaning;
  };
  Choices(FieldEditor& of, const QString& name, QVBoxLayout& column) : Part(of, name) {
    for (const std::string_view choice : of.field_.names) {
      One one{std::string(choice), new QCheckBox(&of), new QLabel(&of), settingHint({}, &of)};
      one.box->setText(capital(fromRoom(one.name.c_str())));
      one.box->setObjectName(name + ':' + toQt(one.name));
      one.note->setObjectName(one.box->objectName() + ":note");
      one.note->setProperty("quiet", true);
      one.meaning->hide();
      QObject::connect(one.box, &QCheckBox::toggled, &of, [this] { take(); });
      auto* beside = new QHBoxLayout;
      beside->addWidget(one.box, 1);
      beside->addWidget(one.note);
      column.addLayout(beside);
      column.addWidget(one.meaning);
      all.push_back(one);
    }
  }
  void take() {
    std::vector<std::string> names;
    for (const One& one : all) {
      if (one.box->isChecked()) names.push_back(one.name);
    }
    of.want(names);
  }
  void describe(const std::function<ChoiceText(const std::string&)>& text) override {
    for (const One& one : all) {
      const ChoiceText of_it = text(one.name);
      one.box->setText(of_it.words);
      one.note->setText(of_it.note);
      one.meaning->setText(of_it.meaning);
      one.meaning->setVisible(!of_it.meaning.isEmpty());
    }
  }
  void show(const FieldValue& value) override {
    const std::vector<std::string> names = textsOf(value);
    for (const One& one : all) {
      one.box->setChecked(std::ranges::find(names, one.name) != names.end());
    }
  }
  std::vector<One> all;
};

FieldEditor::FieldEditor(const FieldShape& field, const QString& name, QWidget* parent)
    : QWidget(parent), field_(field) {
  auto* column = tight(new QVBoxLayout(this), 1);
  switch (field.kind) {
    case FieldKind::number:
    case FieldKind::whole:
      value_ = 0.0;
      part_ = std::make_unique<Numbers>(*this, name, *column);
      break;
    case FieldKind::three_numbers:
    case FieldKind::direction:
      value_ = Vec3(0.0);
      part_ = std::make_unique<Numbers>(*this, name, *column);
      break;
    case FieldKind::flag:
      value_ = false;
      part_ = std::make_unique<Flag>(*this, name, *column);
      break;
    case FieldKind::text:
      value_ = std::string();
      if (field.row.lines > 1) {
        part_ = std::make_unique<Paragraph>(*this, name, *column);
      } else {
        part_ = std::make_unique<Line>(*this, name, *column);
      }
      break;
    case FieldKind::lines:
      value_ = std::vector<std::string>();
      part_ = std::make_unique<Lines>(*this, name, *column);
      break;
    case FieldKind::reference:
      value_ = std::string();
      part_ = std::make_unique<Reference>(*this, name, *column);
      break;
    case FieldKind::references:
      value_ = std::vector<std::string>();
      part_ = std::make_unique<References>(*this, name, *column);
      break;
    case FieldKind::choice:
      value_ = std::string();
      part_ = std::make_unique<Choice>(*this, name, *column);
      break;
    case FieldKind::choices:
      value_ = std::vector<std::string>();
      part_ = std::make_unique<Choices>(*this, name, *column);
      break;
  }
  const bool number = field.kind <= FieldKind::direction;
  const QString help = *field.row.help ? fromRoom(field.row.help)
                       : number        ? shortMeaningOf(field.row)
                                       : QString();
  if (!help.isEmpty()) column->addWidget(settingHint(help, this));
  if (!isTyped(field)) return;
  not_applied_ = problemLabel(qPrintable(name + "NotApplied"), this);
  not_applied_->setText(
      QCoreApplication::translate("Setting", "Not applied: shorten or change it."));
  column->addWidget(not_applied_);
}

FieldEditor::~FieldEditor() = default;

void FieldEditor::want(const FieldValue& value) {
  if (showing_ || !entered) return;
  const FieldValue before = value_;
  entered(value);
  if (!isTyped(field_)) return show(FieldValue(value_));  // what was refused
  setRefused(value_ == before);
}

void FieldEditor::setRefused(bool refused) {
  refused_ = refused;
  if (not_applied_) not_applied_->setVisible(refused);
}

bool FieldEditor::isRefused() const {
  return refused_ || part_->isRefused();
}

void FieldEditor::takeTyped() {
  part_->takeTyped();
}

void FieldEditor::show(const FieldValue& value, bool same_owner) {
  if (!same_owner) part_->forgetTyped();
  if (same_owner && refused_ && value == value_) return;
  setRefused(false);
  const bool before = std::exchange(showing_, true);
  value_ = value;
  part_->show(value);
  showing_ = before;
}

void FieldEditor::offer(const Offers& offers) {
  part_->offer(offers);
}

void FieldEditor::describe(const std::function<ChoiceText(const std::string& choice)>& text) {
  part_->describe(text);
}

QString FieldEditor::label() const {
  const bool own = field_.kind == FieldKind::flag || field_.kind == FieldKind::choices;
  return own ? QString() : nameOf(field_.row);
}

QString FieldEditor::nameOf(const FieldRow& row) {
  return fromRoom(*row.label ? row.label : qPrintable(capital(toQt(wordsOf(row)))));
}

}  // namespace trephine
