// The exercise itself: its name, what it is for, where it enters, what its card says in both
// languages, the outline that shows where to work, what a trainee may not change; and saving it,
// trying it and taking it elsewhere. It shows an exercise and tells what a person wants of it; what
// is refused is said below the group and the exercise stays.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QPushButton>
#include <functional>
#include <memory>

#include "exercise/exercise_fields.h"
#include "ui/prepare/outline_form.h"

namespace trephine {

class ExerciseForm : public QWidget {
  Q_OBJECT
 public:
  explicit ExerciseForm(QWidget* parent = nullptr);

  // `landmarks`: as they are placed in the open case.
  void setExercise(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks);
  // Names of the case's structures, to be asked for.
  void setStructures(const std::vector<std::string>& names);
  void setLocked(const QString& why);
  // Sets of this workstation, a name and a file each: asked for whenever they are offered.
  std::function<std::vector<std::pair<QString, std::filesystem::path>>()> sets;

  // What it is made on: the case, and how many structures that has.
  void showCase(const QString& words) { case_->setText(words); }
  // False: the case lacks structures, and the exercise runs on its other set already.
  void setElsewherePossible(bool possible) {
    for (QWidget* of : {choose_elsewhere_, no_elsewhere_}) of->setEnabled(possible);
  }
  // Another exercise comes: its Chinese text is of its English one, and nothing of it is refused.
  void forgetCard();
  // A text of it stands there and was not taken.
  bool anyRefused() const { return en_->anyRefused() || zh_->anyRefused(); }
  // Whether it is one of this workstation's own, and as it was saved.
  void showSaved(const QString& words);
  // Clicks on the surface add points.
  void showDrawing(bool drawing) { outline_->showDrawing(drawing); }

  ExerciseEdited wanted;

 signals:
  void drawingWanted(bool on);
  // The tool that places the landmark of this id, to be used once.
  void placeWanted(const std::string& landmark);
  void looksWanted();  // as they are now
  void operatorWanted();
  void labelsWanted();     // structures of the case from a file
  void elsewhereWanted();  // a set of tissues for other cases, of a file
  void elsewhereChosen(const std::filesystem::path& set);
  void saveWanted();
  void saveCopyWanted();
  void tryWanted();
  void exportWanted();
  void importWanted();

 public slots:
  void setOperator(const std::string& file) {
    what_->edit("operator", [&](Exercise& exercise) { exercise.operator_file = file; });
  }
  void setElsewhere(const std::optional<TissueSet>& set) {
    what_->edit("elsewhere", [&](Exercise& exercise) { exercise.tissues_elsewhere = set; });
  }

 private:
  QWidget* buildWays();
  void buildWhat();
  QWidget* buildCase();
  QWidget* buildElsewhere();
  QWidget* buildOperator();
  void buildPlaces();
  QWidget* buildEntry();
  void buildCard();
  QCheckBox* cardSwitch(const char* name, const QString& words,
                        const std::function<void(Exercise&, bool on)>& edit);
  std::unique_ptr<FieldRows<CardText>> cardFields(const QString& prefix,
                                                  CardText* (*text)(ExerciseCard&));
  void buildLocks();
  void showStructures();
  void showLandmark();
  void showCard();
  const Landmark* landmark() const;
  void editLandmark(const std::string& what, const std::function<void(Landmark&)>& change);
  void findLandmarkBy(int way);

  Exercise exercise_;
  std::vector<PlacedLandmark> landmarks_;
  bool showing_ = false;
  QWidget* body_;
  QLabel *locked_, *saved_;
  QPushButton *save_, *copy_, *try_, *export_, *import_;
  std::vector<std::string> of_case_;
  FormGroup *what_, *places_, *card_, *lock_;
  std::unique_ptr<FieldRows<Exercise>> what_fields_, lock_fields_;
  std::unique_ptr<FieldRows<Landmark>> landmark_is_, landmark_numbers_;
  std::unique_ptr<FieldRows<ExerciseView>> view_;
  std::unique_ptr<FieldRows<CardText>> en_, zh_;
  QComboBox *landmark_, *landmark_found_;
  QLabel* landmark_kind_;
  QLabel *operator_, *case_, *elsewhere_;
  QToolButton *choose_elsewhere_, *no_elsewhere_;
  QCheckBox *card_on_, *chinese_on_;
  std::optional<ExerciseCard> kept_chinese_;  // the card whose Chinese text was taken out
  QLabel* chinese_old_;
  OutlineForm* outline_;
};

}  // namespace trephine
