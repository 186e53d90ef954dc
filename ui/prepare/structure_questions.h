// What a person is asked about a file with structures, and the answer's way back.
#pragma once

#include <QObject>
#include <string>
#include <vector>

#include "ui/work/app_context.h"

namespace trephine {

class StructureQuestions : public QObject {
  Q_OBJECT
 public:
  explicit StructureQuestions(AppContext& app);

 private:
  void ask(const StructureQuestion& question);
  void askForOption(const Choice& choice);
  void askForOrder(const std::vector<std::string>& names);
  void askForThreshold();

  AppContext& app_;
  Workstation& workstation_;
};

}  // namespace trephine
