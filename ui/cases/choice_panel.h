// Questions that only a person can answer, each with its options.
#pragma once

#include <QWidget>

#include "imaging/importer.h"

namespace trephine {

class ChoicePanel : public QWidget {
  Q_OBJECT
 public:
  explicit ChoicePanel(QWidget* parent = nullptr);

  // Asks these; what `answers` hold is chosen already, the rest is open.
  void ask(const std::vector<Choice>& choices, const Answers& answers);
  const Answers& answers() const { return answers_; }
  bool allAnswered() const;

 signals:
  void answered();

 private:
  void addChoice(const Choice& choice);

  std::vector<Choice> choices_;
  Answers answers_;
};

}  // namespace trephine
