// What a person is asked about a file with structures, and the answer's way back.
#pragma once

#include <QObject>
#include <QWidget>
#include <string>
#include <vector>

#include "ui/work/workstation.h"

namespace trephine {

class StructureQuestions : public QObject {
  Q_OBJECT
 public:
  // `window`: what they stand over.
  StructureQuestions(Workstation& workstation, QWidget& window);

 private:
  void ask(const StructureQuestion& question);
  void askForOption(const Choice& choice);
  void askForOrder(const std::vector<std::string>& names);
  void askForThreshold();

  Workstation& workstation_;
  QWidget& window_;
};

}  // namespace trephine
