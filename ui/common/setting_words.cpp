#include "ui/common/setting_words.h"

#include <QCoreApplication>
#include <QRegularExpression>
#include <QVBoxLayout>
#include <algorithm>
#include <string_view>

#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/translations.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

// A meaning as sentences, with the row's range.
QString withRange(QString meaning, const FieldRow& row) {
  meaning.remove('`');
  meaning[0] = meaning[0].toUpper();
  constexpr double kNoLimit = 1e6;  // nobody comes there
  if (row.range.high >= kNoLimit) {
    return QCoreApplication::translate("Setting", "%1%2.")
        .arg(meaning)
        .arg(*row.range.unit ? ", " + QString(row.range.unit) : QString());
  }
  return QCoreApplication::translate("Setting", "%1. %2 to %3%4.")
      .arg(meaning)
      .arg(row.range.low, 0, 'g', 6)
      .arg(row.range.high, 0, 'g', 6)
      .arg(*row.range.unit ? ' ' + QString(row.range.unit) : QString());
}

}  // namespace

QString shortMeaningOf(const FieldRow& row) {
  static const QRegularExpression kRest(" *[;:(].*$",
                                        QRegularExpression::DotMatchesEverythingOption);
  const QString meaning = fromRoom(row.meaning).remove(kRest);
  return meaning.isEmpty() ? QString() : withRange(meaning, row);
}

QString meaningOf(const FieldRow& row) {
  return *row.meaning ? withRange(fromRoom(row.meaning), row) : QString();
}

double stepOfUnit(const char* unit) {
  const std::string_view of = unit;
  if (of == "mm" || of == "W" || of == "\u00b0") return 1.0;
  if (of == "N") return 0.1;
  if (of == "Hz") return 100.0;
  return 0.05;
}

namespace {

// A wrapped text that always has room for its lines: forms within forms do not ask for it.
class HintLabel : public QLabel {
 public:
  using QLabel::QLabel;
  QSize minimumSizeHint() const override {
    return {QLabel::minimumSizeHint().width(), std::max(0, heightForWidth(width()))};
  }

 protected:
  void resizeEvent(QResizeEvent* event) override {
    QLabel::resizeEvent(event);
    updateGeometry();  // minimumSizeHint() follows the width
  }
};

}  // namespace

QLabel* settingHint(const QString& words, QWidget* parent) {
  auto* label = new HintLabel(words, parent);
  label->setWordWrap(true);
  QFont small = label->font();
  small.setPointSizeF(small.pointSizeF() * 0.88);
  label->setFont(small);
  colours::setText(*label, colours::kQuiet);
  label->setProperty("hint", true);
  return label;
}

QLabel* settingText(const char* name, QWidget* parent) {
  auto* label = named(new HintLabel(parent), name);
  label->setWordWrap(true);
  return label;
}

QWidget* withHint(QWidget* field, const QString& words, QWidget* parent) {
  auto* both = new QWidget(parent);
  auto* column = tight(new QVBoxLayout(both), 1);
  column->addWidget(field);
  column->addWidget(settingHint(words, both));
  return both;
}

QLabel* problemLabel(const char* name, QWidget* parent) {
  auto* label = wrapped(named(new QLabel(parent), name));
  colours::setText(*label, colours::kCaution);
  label->hide();
  return label;
}

void sayNotApplied(QLabel& problem, const Error& why) {
  problem.setText(QCoreApplication::translate("Setting", "Not applied. %1. %2.")
                      .arg(toQt(why.what), toQt(why.next)));
  problem.show();
}

QFormLayout* settingForm(QWidget* of) {
  auto* layout = tight(new QFormLayout(of));
  layout->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  layout->setRowWrapPolicy(QFormLayout::WrapLongRows);
  layout->setVerticalSpacing(6);
  return layout;
}

QComboBox* settingChoice(const char* name, const QString& accessible, QWidget* parent) {
  auto* box = named(new QComboBox(parent), name);
  box->setAccessibleName(accessible);
  box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  box->setMinimumContentsLength(3);
  return box;
}

QToolButton* settingButton(const char* name, const QString& text, const QString& tip,
                           QWidget* parent) {
  auto* made = named(new QToolButton(parent), name);
  made->setText(text);
  made->setToolTip(tip);
  made->setFocusPolicy(Qt::TabFocus);
  return made;
}

QLabel* settingTitle(const QString& words, QWidget* parent) {
  return looking(new QLabel(words, parent), {"title"});
}

}  // namespace trephine
