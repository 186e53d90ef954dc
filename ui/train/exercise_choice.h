// Which exercise it is: the list of them, of which what the workstation does not allow cannot be
// chosen; opening another; what is said of the one that is open, and what is asked where the case
// does not fit it. Window's thread.
#pragma once

#include <QComboBox>
#include <QObject>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "ui/work/app_context.h"

namespace trephine {

class ExerciseChoice : public QObject {
  Q_OBJECT
 public:
  // The list is empty until fill().
  ExerciseChoice(AppContext& app, QObject* parent);

  // For a bar, which owns it.
  QComboBox* list() const { return list_; }
  // Anew, with the exercises that there are.
  void fill();
  // The exercise that is open, in the list; without one, the one that an imported case would get.
  void showInUse();
  // An exercise that is about to open may not be in the list.
  void showNone() { list_->setCurrentIndex(-1); }
  // Where one is, and stays once another exercise is open: the list is over Prepare too.
  void stayIn(Place place) { place_ = place; }
  // Goes on with the exercise; where the case is not what it is for it asks first, once a case and
  // exercise.
  void unlessItDoesNotFit(WorkGuards::Next go_on);

 signals:
  // The list shows an exercise with this controller; none: no exercise is open.
  void controllerShown(std::optional<trephine::ControllerKind> controller);
  void structureWanted();  // that the exercise needs and the case lacks

 private:
  void choose(int index);
  void showOpening(const Exercise& exercise, const std::filesystem::path& file);
  void showPhase();
  void showAllowed();
  void refuse(int index, const QString& why);
  void sayWhatIsOpen();

  AppContext& app_;
  Workstation& workstation_;
  Messages& messages_;
  QComboBox* list_;
  std::vector<std::pair<std::filesystem::path, Exercise>> listed_;  // the workstation's exercises
  Place place_ = Place::prepare;
  QString said_;         // the last one that was open
  bool warned_ = false;  // of this case in this exercise, and it was gone on
};

}  // namespace trephine
