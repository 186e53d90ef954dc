// Questions that only a person can answer, each with its options, and a slice where that tells them
// apart.
#pragma once

#include <QLabel>
#include <QWidget>
#include <map>
#include <vector>

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
  // The slices that options show, and one of them.
  std::vector<int> slicesShown() const;
  void setPicture(int slice, const QImage& picture);

 signals:
  void answered();

 private:
  void addChoice(const Choice& choice);

  std::vector<Choice> choices_;
  Answers answers_;
  std::multimap<int, QLabel*> pictures_;  // by slice
};

}  // namespace trephine
