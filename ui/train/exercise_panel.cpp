#include "ui/train/exercise_panel.h"

#include <QVBoxLayout>
#include <cmath>

#include "ui/common/colours.h"
#include "ui/common/making.h"
#include "ui/common/words.h"
#include "ui/train/arms_panel.h"

namespace trephine {

namespace {

QLabel* richLabel(const char* name) {
  QLabel* label = wrappedLabel(name);
  label->setTextFormat(Qt::RichText);
  return label;
}

QLabel* heading(const QString& text) {
  return looking(new QLabel(text), {"title"});
}

QString rows(const QString& title, const std::vector<RemovedOf>& removed) {
  QString html;
  for (const RemovedOf& one : removed) {
    if (!(one.mm3 > 0.0)) continue;
    html += QStringLiteral(
                "<tr><td style='color:%1'>\u25a0&nbsp;</td><td>%2&nbsp;&nbsp;</td>"
                "<td align='right'>%3</td></tr>")
                .arg(one.colour.name(), one.name.toHtmlEscaped(), volumeWords(one.mm3));
  }
  if (html.isEmpty()) return {};
  return QStringLiteral("<tr><td colspan='3'>%1</td></tr>").arg(title.toHtmlEscaped()) + html;
}

}  // namespace

QString volumeWords(double mm3) {
  if (mm3 >= 1000.0) return ExercisePanel::tr("%1 mL").arg(mm3 / 1000.0, 0, 'f', 2);
  return ExercisePanel::tr("%1 mm\u00b3").arg(mm3, 0, 'f', mm3 < 10.0 ? 1 : 0);
}

QString stepsWords(const CardText& card) {
  QString html = QStringLiteral("<ol style='margin-left:-20px'>");
  for (const std::string& step : card.steps) {
    html += QStringLiteral("<li>%1</li>").arg(toQt(step).toHtmlEscaped());
  }
  return html + QStringLiteral("</ol>");
}

QString toolWords(const Exercise& exercise, const std::array<std::int32_t, kMaxArms>& in_hand) {
  QStringList lines;
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    const ExerciseTool& tool = *exercise.toolOf(i, std::size_t(in_hand[i]));
    lines << ExercisePanel::tr("%1: %2").arg(armName(exercise.arms[i]), toolWord(tool));
  }
  return lines.join('\n');
}

RemovedOf unnamedRemoved(double mm3) {
  return {ExercisePanel::tr("Not told apart"), colours::kQuiet, mm3};
}

ExercisePanel::ExercisePanel(QWidget* parent) : QWidget(parent) {
  title_ = wrappedLabel("exerciseTitle", {"heading"});
  goal_ = wrappedLabel("exerciseGoal");
  steps_ = richLabel("exerciseSteps");
  tools_ = wrappedLabel("exerciseTools");
  hands_ = wrappedLabel("exerciseHands");
  time_ = namedLabel("exerciseTime", {"largest"});
  removed_ = richLabel("exerciseRemoved");
  removed_->setToolTip(
      tr("What is cut now, by tissue. Not told apart: at the edge of two tissues, of HU that no "
         "tissue has, or of an enclosed tissue's HU outside of what encloses it"));
  keys_ = wrappedLabel("exerciseKeys", {"quiet"});
  keys_->setText(
      tr("Mouse or arrows: where the tool goes. Wheel up or down, Page Down or Up: presses more or "
         "less. Shift and arrows: tilt. Tab: the other hand. Space: pause. Right drag: turn the "
         "view. The tool follows the mouse wherever it goes: pause before you take it to a "
         "button."));
  card_ = namedButton("showCard", "");
  card_->hide();
  connect(card_, &QPushButton::clicked, this, &ExercisePanel::cardWanted);
  back_ = namedButton("backToPrepare", tr("&Back to Prepare"));
  back_->setToolTip(tr("Ends the try and goes on preparing the exercise"));
  back_->hide();
  connect(back_, &QPushButton::clicked, this, &ExercisePanel::backWanted);
  auto* layout = tight(new QVBoxLayout(this), 8, {12, 10, 12, 10});
  addAll(*layout, {title_, back_, card_, time_});
  layout->addWidget(heading(tr("Removed")));
  layout->addWidget(removed_);
  asked_ = new QWidget;
  auto* asked = tight(new QVBoxLayout(asked_), 8);
  asked->addWidget(heading(tr("Goal")));
  asked->addWidget(goal_);
  layout->addWidget(asked_);
  layout->addWidget(steps_);
  layout->addWidget(heading(tr("Hands")));
  addAll(*layout, {tools_, hands_, keys_});
  layout->addStretch(1);
  showIdle();
}

void ExercisePanel::setExercise(const Exercise& exercise, const QString& language) {
  title_->setText(toQt(exercise.name));
  const CardText* card = cardFor(exercise, language.toStdString());
  goal_->setText(card ? toQt(card->goal) : tr("Cut as the exercise's name says."));
  steps_->setText(card ? stepsWords(*card) : QString());
  hands_->setText(card ? toQt(card->hands) : QString());
  showTools(exercise, {});
}

void ExercisePanel::showTools(const Exercise& exercise,
                              const std::array<std::int32_t, kMaxArms>& in_hand) {
  tools_->setText(toolWords(exercise, in_hand));
}

void ExercisePanel::showTime(double seconds) {
  time_->setText(timeWords(std::uint32_t(seconds)));
}

void ExercisePanel::showRemoved(const std::vector<RemovedOf>& tissues,
                                const std::vector<RemovedOf>& structures) {
  const QString html = rows(tr("Tissue"), tissues) + rows(tr("Structure"), structures);
  removed_->setText(html.isEmpty() ? tr("nothing yet")
                                   : QStringLiteral("<table>%1</table>").arg(html));
}

void ExercisePanel::setSaidOnCard(bool goal, bool all) {
  asked_->setVisible(!goal);
  steps_->setVisible(!all && !steps_->text().isEmpty());
  hands_->setVisible(!all && !hands_->text().isEmpty());
}

void ExercisePanel::offerCard(const QString& words) {
  card_->setText(words);
  card_->setVisible(!words.isEmpty());
}

void ExercisePanel::showIdle() {
  showTime(0.0);
  showRemoved({}, {});
}

}  // namespace trephine
