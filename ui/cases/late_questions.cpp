#include "ui/cases/late_questions.h"

#include <QAbstractButton>
#include <QVBoxLayout>
#include <algorithm>

#include "imaging/codes.h"
#include "ui/cases/import_words.h"
#include "ui/common/making.h"
#include "ui/common/setting_words.h"

namespace trephine {

LateQuestions::LateQuestions(QWidget* parent) : QWidget(parent) {
  loss_ = wrappedLabel("lossWords");
  couch_ = wrappedLabel("couchNote", {"quiet"});
  couch_->setText(tr("In the slices, what would be taken out is tinted."));
  face_ = wrappedLabel("faceWarning");
  face_->setText(
      tr("From this CT the face can be made visible, and the patient recognised. Keep it "
         "only where the exercise needs it and everyone who sees the case may know who "
         "it is."));
  choices_ = new ChoicePanel;
  choices_->setObjectName("lateChoices");
  auto* layout = tight(new QVBoxLayout(this), 10, {8, 0, 8, 0});
  layout->addWidget(settingTitle(tr("Before the case opens"), this));
  layout->addWidget(loss_);
  layout->addWidget(face_);
  layout->addWidget(couch_);
  layout->addWidget(choices_);
  layout->addStretch(1);
  connect(choices_, &ChoicePanel::answered, this, &LateQuestions::answered);
}

void LateQuestions::ask(const std::optional<MeasuredLoss>& loss, bool couch_found,
                        const std::vector<Choice>& questions) {
  loss_->setText(loss ? lossWords(*loss) : QString());
  loss_->setVisible(!loss_->text().isEmpty());
  couch_->setVisible(couch_found);
  face_->setVisible(std::ranges::find(questions, code::kFace, &Choice::code) != questions.end());
  choices_->ask(questions, {});
}

bool LateQuestions::focusFirst() {
  auto* first = choices_->findChild<QAbstractButton*>();
  if (first) first->setFocus();
  return first;
}

}  // namespace trephine
