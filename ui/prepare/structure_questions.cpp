#include "ui/prepare/structure_questions.h"

#include <QInputDialog>
#include <QMessageBox>
#include <QPushButton>

#include "base/range.h"
#include "imaging/segmentation/overlap_order.h"
#include "ui/common/question.h"
#include "ui/common/words.h"
#include "ui/structures/overlap_dialog.h"

namespace trephine {

StructureQuestions::StructureQuestions(Workstation& workstation, QWidget& window)
    : workstation_(workstation), window_(window) {
  connect(&workstation_, &Workstation::asked, this, &StructureQuestions::ask);
}

// Without an answer nothing changes.
void StructureQuestions::ask(const StructureQuestion& question) {
  switch (question.asked.kind) {
    case StructureAsked::Kind::option:
      return askForOption(question.asked.choice);
    case StructureAsked::Kind::order:
      return askForOrder(question.asked.names);
    case StructureAsked::Kind::threshold:
      return askForThreshold();
  }
}

void StructureQuestions::askForOption(const Choice& choice) {
  const auto use = [this](const std::string& option) {
    return [this, option] { workstation_.answer(option); };
  };
  const auto words = [](const std::string& option) {
    return option == "ct"       ? tr("&Put it on the CT, voxel by voxel")
           : option == "sform"  ? tr("Take its &sform")
           : option == "qform"  ? tr("Take its &qform")
           : option == "pixdim" ? tr("Take the steps of its &pixdim")
                                : tr("&Use it all the same");
  };
  const std::vector<std::string>& options = choice.options;
  QMessageBox* question =
      trephine::ask(&window_, "structuresQuestion", toQt(choice.question) + '.',
                    tr("What is used as it is may be felt and cut in the wrong place."),
                    words(options.front()), use(options.front()));
  connect(question, &QMessageBox::buttonClicked, this, [this, question](QAbstractButton* button) {
    if (question->buttonRole(button) == QMessageBox::RejectRole) workstation_.dropQuestion();
  });
  for (std::size_t n = 1; n < options.size(); ++n) {
    orElse(*question, "otherForm", words(options[n]), use(options[n]));
  }
}

void StructureQuestions::askForOrder(const std::vector<std::string>& names) {
  auto* dialog = new OverlapDialog(names, &window_);
  connect(dialog, &QDialog::accepted, this,
          [this, dialog] { workstation_.answer(orderAnswer(dialog->order())); });
  connect(dialog, &QDialog::rejected, this, [this] { workstation_.dropQuestion(); });
  dialog->open();
}

void StructureQuestions::askForThreshold() {
  auto* dialog = new QInputDialog(&window_);
  dialog->setObjectName("thresholdQuestion");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("A fractional segmentation"));
  dialog->setLabelText(
      tr("The file says how much of each voxel a structure has, from 0 to 1.\n"
         "A voxel is the structure's from this share on:"));
  dialog->setInputMode(QInputDialog::DoubleInput);
  dialog->setDoubleRange(0.0, 1.0);
  dialog->setDoubleDecimals(2);
  dialog->setDoubleStep(0.05);
  dialog->setDoubleValue(StructureRequest().threshold);
  connect(dialog, &QInputDialog::doubleValueSelected, this,
          [this](double value) { workstation_.answer(plainNumber(value)); });
  connect(dialog, &QDialog::rejected, this, [this] { workstation_.dropQuestion(); });
  dialog->open();
}

}  // namespace trephine
