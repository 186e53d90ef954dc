// The exercise itself: its form, the outline that is clicked, saving it, trying it, and taking it
// to other workstations. Between the form, the views and the workstation.
#pragma once

#include <QObject>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ui/prepare/exercise_form.h"
#include "ui/prepare/outline_tool.h"
#include "ui/work/work_guards.h"

namespace trephine {

class ExerciseTab : public QObject {
  Q_OBJECT
 public:
  // `storage`: the folder that exercises are saved in.
  ExerciseTab(Workstation& workstation, Messages& messages, WorkGuards& guards, Toolbox& toolbox,
              const std::filesystem::path& storage, ExerciseForm& form, QObject* parent);

  // Whether it is seen; the form is filled while it is.
  void show(bool in_front);
  // In the storage folder, in its own place or as another one. `then` follows once it is written.
  // `on_another_case`: in the place of one that was made on another case, which is asked otherwise.
  void save(bool copy, WorkGuards::Next then, bool on_another_case = false);

  // Those that there are.
  std::function<std::vector<std::filesystem::path>()> exercises;
  // Whether the case has the structures as they are now, and what gives it them.
  std::function<bool()> structuresInCase;
  std::function<void(WorkGuards::Next then)> saveInCase;

  // Whether a text was typed and not taken.
  bool anyRefused() const;
  // One of this workstation: saving writes the file that it was opened from.
  bool isOwn() const;

 signals:
  void saved();
  void exercisesChanged();  // in the storage folder
  void takeInWanted(const std::filesystem::path& folder);  // of another workstation's exercise
  void tryWanted();
  void labelsWanted();  // structures of the case from a file
  void placeWanted(const std::string& landmark);  // as the form's

 private:
  void refresh();
  QString caseWords() const;
  bool isShipped() const;
  void takeElsewhere(const std::filesystem::path& file);
  void draw(bool on);
  std::optional<Exercise> exerciseToSave();
  std::string freeName(const std::string& wanted) const;
  struct OnDisk {
    std::filesystem::path file;
    std::string text;
  };
  void askToReplace(const char* name, const QString& why, const QString& what,
                    const WorkGuards::Next& replace, const WorkGuards::Next& then);
  static OnDisk onDisk(const std::filesystem::path& file);
  void tryIt();
  void exportIt();
  void exportSaved();
  void importIt();

  Workstation& workstation_;
  Messages& messages_;
  WorkGuards& guards_;
  std::filesystem::path storage_;
  Toolbox& toolbox_;
  OutlineTool outline_;
  ExerciseForm* form_;
  bool in_front_ = false;
  std::filesystem::path shown_;  // the file of what the form shows
  OnDisk opened_;  // the exercise's file as it was opened, or saved, here
};

}  // namespace trephine
