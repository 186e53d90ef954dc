#include "ui/train/result_page.h"

#include <QHBoxLayout>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ui/common/making.h"
#include "ui/common/words.h"
#include "volume/label_map.h"

namespace trephine {

namespace {

constexpr int kResultWidest = 560;

QString row(const QString& what, const QString& value) {
  return QStringLiteral("<tr><td>%1&nbsp;&nbsp;&nbsp;</td><td align='right'>%2</td></tr>")
      .arg(what.toHtmlEscaped(), value.toHtmlEscaped());
}

QString title(const QString& text) {
  return QStringLiteral("<tr><td colspan='2'><b>%1</b></td></tr>").arg(text.toHtmlEscaped());
}

QString timesWords(std::uint64_t times) {
  return times == 1 ? ResultPage::tr("once") : ResultPage::tr("%1 times").arg(times);
}

// "12 mm3 of 1.2 L": of the structure, where it is one.
QString cutWords(double mm3, const CutStructure* of) {
  if (!of) return volumeWords(mm3);
  return ResultPage::tr("%1 of %2").arg(volumeWords(mm3), volumeWords(1000.0 * of->ml));
}

// The structure that a tissue is named after. What was cut of it is the tissue's own row, as long
// as both count the same voxels.
const CutStructure* structureOf(const RemovedOf& tissue, const ExerciseResult& result) {
  for (const CutStructure& one : result.structures) {
    const bool same = std::abs(1000.0 * one.cut_ml - tissue.mm3) < 0.5;
    if (same && sameName(one.name, tissue.name.toStdString())) return &one;
  }
  return nullptr;
}

}  // namespace

ResultPage::ResultPage(QWidget& over) : FloatingCard(over, At::middle, kResultWidest) {
  setObjectName("resultPage");
  title_ = wrapped(named(new QLabel, "resultTitle", {"heading"}));
  goal_ = wrapped(named(new QLabel, "resultGoal"));
  time_ = named(new QLabel, "resultTime", {"large"});
  rows_ = wrapped(named(new QLabel, "resultRows"));
  rows_->setTextFormat(Qt::RichText);
  auto* purpose = looking(new QLabel(purposeText()), {"quiet"});
  again_ = named(new QPushButton(tr("Try &again")), "resultAgain", {"primary"});
  again_->setToolTip(tr("On whole tissue; the recording of this one stays"));
  replay_ = named(new QPushButton(tr("Check by &replay")), "resultReplay");
  look_ = named(new QPushButton(tr("&Look at it (Esc)")), "resultLook");
  look_->setToolTip(tr(
      "Puts this page aside: the tissue stays as it was left until the next start, and the panel "
      "at the left brings the page back"));
  auto* buttons = new QHBoxLayout;
  buttons->addStretch(1);
  for (QPushButton* each : {again_, replay_, look_}) buttons->addWidget(each);
  buttons->addStretch(1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(20, 16, 20, 16);
  layout->setSpacing(10);
  addAll(*layout, {title_, goal_, time_, rows_});
  layout->addLayout(buttons);
  layout->addWidget(purpose, 0, Qt::AlignCenter);
  connect(again_, &QPushButton::clicked, this, &ResultPage::againWanted);
  connect(replay_, &QPushButton::clicked, this, &ResultPage::replayWanted);
  connect(look_, &QPushButton::clicked, this, &ResultPage::lookWanted);
}

void ResultPage::setResult(const ExerciseResult& result) {
  title_->setText(tr("Result: %1").arg(result.exercise));
  goal_->setText(tr("What was asked: %1").arg(result.goal));
  goal_->setVisible(!result.goal.isEmpty());
  time_->setText(tr("Time %1").arg(timeWords(std::uint32_t(result.seconds))));
  QString html = title(tr("Removed"));
  int removed = 0;
  for (const RemovedOf& one : result.tissues) {
    if (!(one.mm3 > 0.0)) continue;
    ++removed;
    html += row(one.name, cutWords(one.mm3, structureOf(one, result)));
  }
  if (removed == 0 && !(result.unnamed_mm3 > 0.0)) html += row(tr("nothing"), {});
  if (result.unnamed_mm3 > 0.0) {
    const RemovedOf rest = unnamedRemoved(result.unnamed_mm3);
    html += row(rest.name, volumeWords(rest.mm3));
    html += QStringLiteral("<tr><td colspan='2'><i>%1</i></td></tr>")
                .arg(tr("It lay at the edge of two tissues, had HU that no tissue has, or had "
                        "those of an enclosed tissue outside of what encloses it.")
                         .toHtmlEscaped());
  }
  bool any = false;
  for (const CutStructure& one : result.structures) {
    const auto names_it = [&](const RemovedOf& tissue) {
      return structureOf(tissue, result) == &one;
    };
    if (!(one.cut_ml > 0.0) || std::ranges::any_of(result.tissues, names_it)) continue;
    if (!std::exchange(any, true)) html += title(tr("Of the structures"));
    html += row(toQt(one.name), cutWords(1000.0 * one.cut_ml, &one));
  }
  html += title(tr("Path of the tools"));
  for (const ExerciseResult::Way& way : result.ways) {
    html += row(way.hand,
                tr("%1 cm, at most %2 N").arg(way.mm / 10.0, 0, 'f', 1).arg(way.most_N, 0, 'f', 1));
  }
  if (result.undos + result.rewinds > 0) {
    html += title(tr("Taken back"));
    if (result.undos > 0) html += row(tr("By undo"), timesWords(result.undos));
    if (result.rewinds > 0) html += row(tr("By going back or reset"), timesWords(result.rewinds));
    if (result.brought_back_mm3 > 0.0) {
      html += row(tr("Tissue that was cut and put back"), volumeWords(result.brought_back_mm3));
    }
  }
  if (result.late > 0) {
    html += title(tr("Touch"));
    html += row(tr("Force came late"), timesWords(result.late));
  }
  rows_->setText(QStringLiteral("<table width='100%'>%1</table>").arg(html));
  replay_->setEnabled(result.recorded);
  place();
}

}  // namespace trephine
