// The exercise itself: its name, what it is for, where it enters, what its card says in both
// languages, the outline that shows where to work, what a trainee may not change; and saving it,
// trying it and taking it elsewhere. It shows an exercise and tells what a person wants of it; what
// is refused is said below the group and the exercise stays.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QToolButton>
#include <QWidget>
#include <array>
#include <functional>
#include <memory>

#include "exercise/exercise.h"
#include "exercise/exercise_numbers.h"
#include "ui/common/number_rows.h"
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
  void showCase(const QString& words);
  // False: the case lacks structures, and the exercise runs on its other set already.
  void setElsewherePossible(bool possible);
  // What it is called where it is saved, and whether it is as it was saved.
  void showSaved(const QString& words);
  // Clicks on the surface add points.
  void showDrawing(bool drawing) { outline_->showDrawing(drawing); }

  // A person wants this change of the exercise as it is then; `what` of it.
  std::function<Status(const std::string& what, const std::function<void(Exercise&)>& change)>
      wanted;

 signals:
  void drawingWanted(bool on);
  void entryWanted();  // the tool that places it
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
  void setOperator(const std::string& file);
  void setElsewhere(const std::optional<TissueSet>& set);

 private:
  struct CardFields {
    QLineEdit* goal;
    QPlainTextEdit* steps;
    QLineEdit* hands;
  };
  QWidget* buildWays();
  QWidget* buildWhat();
  QWidget* buildPlaces();
  QWidget* buildCard();
  QWidget* buildLocks();
  CardFields buildLanguage(QWidget* page, const QString& suffix);
  void showLandmark();
  void nameLandmark();
  void findLandmarkBy(const QString& kind);
  void addLandmark();
  void removeLandmark();
  void showCard();
  void edit(QLabel* problem, const std::string& what, const std::function<void(Exercise&)>& change);
  void editLandmark(const std::string& what, const std::function<void(Landmark&)>& change);
  void cardEntered();
  bool eventFilter(QObject* watched, QEvent* event) override;
  static void showText(CardFields& fields, const CardText* text);
  static CardText textOf(const CardFields& fields);

  Exercise exercise_;
  std::vector<PlacedLandmark> landmarks_;
  bool showing_ = false;
  QWidget* body_;
  QLabel *locked_, *saved_;
  QPushButton *save_, *copy_, *try_, *export_, *import_;
  QFormLayout* what_form_;
  QLineEdit* name_;
  QComboBox* anatomy_;
  QListWidget* structures_;
  std::vector<std::string> of_case_;
  QLabel *what_problem_, *place_problem_, *card_problem_, *lock_problem_;
  QComboBox *landmark_, *landmark_tissue_, *landmark_found_, *view_landmark_;
  QLineEdit* landmark_name_;
  QFormLayout* place_form_;
  QLabel* landmark_kind_;
  std::unique_ptr<NumberRows<Landmark>> ray_, bulk_, place_, outward_, run_;
  std::unique_ptr<NumberRows<ExerciseView>> view_numbers_;
  QLabel *operator_, *case_, *elsewhere_;
  QToolButton *choose_elsewhere_, *no_elsewhere_;
  QCheckBox *card_on_, *chinese_on_;
  CardFields en_, zh_;
  std::optional<CardText> kept_chinese_;  // that was taken out
  QWidget *en_page_, *zh_page_;
  OutlineForm* outline_;
  std::array<QCheckBox*, kLockNames.size()> locks_{};
};

}  // namespace trephine
