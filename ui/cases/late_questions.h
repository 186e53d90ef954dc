// What is said and asked of a series once it was read, before its case opens: what was lost, a
// couch that could go, a face that could be recognised.
#pragma once

#include <QLabel>
#include <QWidget>
#include <optional>
#include <vector>

#include "ui/cases/choice_panel.h"

namespace trephine {

class LateQuestions : public QWidget {
  Q_OBJECT
 public:
  explicit LateQuestions(QWidget* parent = nullptr);

  void ask(const std::optional<MeasuredLoss>& loss, bool couch_found,
           const std::vector<Choice>& questions);
  bool allAnswered() const { return choices_->allAnswered(); }
  const Answers& answers() const { return choices_->answers(); }
  bool focusFirst();  // false: nothing is asked

 signals:
  void answered();  // one of them

 private:
  ChoicePanel* choices_;
  QLabel *loss_, *couch_, *face_;
};

}  // namespace trephine
