#include "ui/structures/structure_notices.h"

#include <QGridLayout>
#include <QHBoxLayout>
#include <QVBoxLayout>

#include "ui/common/colours.h"
#include "ui/common/making.h"

namespace trephine {

namespace {
constexpr int kLines = 5;
constexpr int kProgressSteps = 1000;
}  // namespace

StructureNotices::StructureNotices(StructureEditor& editor, QWidget* parent)
    : QWidget(parent), editor_(editor), said_(wrappedLabel("structureSaid")) {
  preview_box_ = buildPreview();
  progress_box_ = buildProgress();
  box_line_ = buildBoxLine();
  setMinimumHeight(kLines * fontMetrics().lineSpacing() + take_->sizeHint().height());
  auto* layout = tight(new QVBoxLayout(this), 4);
  for (QWidget* part : {preview_box_, progress_box_, static_cast<QWidget*>(said_), box_line_}) {
    layout->addWidget(part);
  }
  layout->addStretch(1);
  connect(&editor_, &StructureEditor::stateChanged, this, &StructureNotices::showState);
  connect(&editor_, &StructureEditor::boxChanged, this, &StructureNotices::showBox);
  connect(&editor_, &StructureEditor::said, this, &StructureNotices::say);
  connect(&editor_, &StructureEditor::saidNoMore, this, [this](const QString& words) {
    if (said_->text() == words) say({});
  });
  connect(&editor_, &StructureEditor::progressed, this, [this](double fraction, const QString&) {
    progress_->setValue(int(fraction * kProgressSteps));
  });
  showState();
  showBox();
}

QWidget* StructureNotices::buildPreview() {
  auto* box = new QWidget(this);
  preview_ = wrappedLabel("structurePreview");
  take_ = namedButton("takePreview", tr("&Keep it"), false, box);
  take_->setToolTip(tr("It counts from now on (Return in a slice)"));
  auto* leave = namedButton("leavePreview", tr("&Discard it"), false, box);
  leave->setToolTip(tr("It goes again (Esc in a slice)"));
  auto* layout = tight(new QGridLayout(box));
  layout->addWidget(preview_, 0, 0, 1, 2);
  layout->addWidget(take_, 1, 0);
  layout->addWidget(leave, 1, 1);
  connect(take_, &QPushButton::clicked, &editor_, &StructureEditor::takePreview);
  connect(leave, &QPushButton::clicked, &editor_, &StructureEditor::leavePreview);
  for (QPushButton* decides : {take_, leave}) {
    connect(decides, &QPushButton::clicked, this, &StructureNotices::decided);
  }
  return box;
}

QWidget* StructureNotices::buildProgress() {
  auto* box = new QWidget(this);
  progress_ = thinProgress("structureProgress", kProgressSteps);
  auto* cancel = namedButton("cancelStructure", tr("Cancel"), false, box);
  auto* layout = tight(new QHBoxLayout(box));
  layout->addWidget(progress_, 1);
  layout->addWidget(cancel);
  connect(cancel, &QPushButton::clicked, &editor_, &StructureEditor::cancel);
  return box;
}

QWidget* StructureNotices::buildBoxLine() {
  auto* line = new QWidget(this);
  box_ = wrappedLabel("growBox");
  auto* none = namedButton("noGrowBox", tr("No bo&x"), false, line);
  auto* layout = tight(new QHBoxLayout(line));
  layout->addWidget(box_, 1);
  layout->addWidget(none);
  connect(none, &QPushButton::clicked, &editor_, &StructureEditor::leaveBox);
  return line;
}

void StructureNotices::say(const QString& words) {
  said_->setText(words.isEmpty() ? hint_ : words);
}

void StructureNotices::setHint(const QString& hint) {
  hint_ = hint;
  say({});
}

void StructureNotices::showBox() {
  const std::optional<Vec3> mm = editor_.boxSize_mm();
  box_line_->setVisible(mm.has_value());
  if (!mm) return;
  QStringList sides;
  for (int axis = 0; axis < 3; ++axis) sides << QString::number((*mm)[axis], 'f', 0);
  box_->setText(tr("Grows inside of a box of %1 mm").arg(sides.join(QStringLiteral(" \u00d7 "))));
}

void StructureNotices::showState() {
  progress_box_->setVisible(editor_.busy());
  if (!editor_.busy()) progress_->setValue(0);
  const auto& preview = editor_.preview();
  preview_box_->setVisible(preview.has_value());
  if (!preview) return;
  QString text = tr("%1 mL, of about %2 to %3 HU.")
                     .arg(preview->ml, 0, 'f', 0)
                     .arg(preview->hu.low, 0, 'f', 0)
                     .arg(preview->hu.high, 0, 'f', 0);
  if (preview->leaked) {
    text += ' ' + tr("It reaches the border of the scan or fills much of it: look whether it is "
                     "the organ alone, and all of it. A larger ball holds it back; Only HU takes "
                     "more, or less.");
  }
  if (preview->seed_off_mm > 0.0) {
    text +=
        ' ' +
        tr("The place that was clicked lies %1 mm beside it.").arg(preview->seed_off_mm, 0, 'f', 1);
  }
  text += ' ' + tr("Another click grows anew in its place.");
  preview_->setText(text);
  const bool doubtful = preview->leaked || preview->seed_off_mm > 0.0;
  colours::setText(*preview_, doubtful ? colours::kCaution : colours::kText);
}

}  // namespace trephine
