// Tools and arms of the exercise: what is in the hands, where an arm reaches in the patient, which
// laws are felt and what keeps them steady. It shows an exercise and tells what a person wants of
// it; what is refused is said below the field's group and the exercise stays.
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QToolButton>
#include <filesystem>
#include <functional>
#include <memory>

#include "exercise/exercise_fields.h"
#include "ui/prepare/form_group.h"
#include "ui/prepare/trade_view.h"

namespace trephine {

class ToolsPanel : public QWidget {
  Q_OBJECT
 public:
  explicit ToolsPanel(QWidget* parent = nullptr);

  void setExercise(const Exercise& exercise);
  // Why nothing may be changed; empty: it may.
  void setLocked(const QString& why);
  std::size_t chosenArm() const { return std::size_t(std::max(0, arm_->currentIndex())); }
  // "3.1 us a tick", by law and by controller, as this machine has them; empty: not measured.
  struct Costs {
    std::vector<std::pair<LawKind, QString>> laws;
    std::vector<std::pair<ControllerKind, QString>> controllers;
  };
  void setCosts(const Costs& costs);
  // What settings cost and get wrong, and where that was measured.
  void setTrades(const std::vector<TradeRow>& rows, const QString& where);
  // How far that is; nothing: it is not being measured.
  void showMeasuring(std::optional<double> share);

  ExerciseEdited wanted;
  // The map of an arm that goes with that landmark instead, or, with "", stays where it is in this
  // patient.
  std::function<ExerciseMap(const Exercise& exercise, std::size_t arm, const std::string& landmark)>
      mapAt;

 signals:
  void armChosen();
  void toolFileWanted();  // of an own tool
  void meshWanted();
  void costsWanted();
  void tradesWanted();

 public slots:
  // A tool file becomes one of the exercise's.
  void addTool(const std::filesystem::path& file);
  void setMesh(const std::filesystem::path& file);

 private:
  void buildTools();
  QWidget* buildToolList();
  QWidget* buildMesh();
  void buildArms();
  void buildLaws();
  void showTool();
  void showArm();
  void showLaws();
  void showTrades();
  void describeCosts();
  const ExerciseTool* tool() const;
  const ExerciseArm* arm() const {
    return chosenArm() < exercise_.arms.size() ? &exercise_.arms[chosenArm()] : nullptr;
  }
  void editTool(const std::string& what, const std::function<void(ExerciseTool&)>& edit);
  void editArm(const std::string& what, const std::function<void(ExerciseArm&)>& edit);
  void removeTool();

  Exercise exercise_;
  bool showing_ = false;
  QWidget* body_;
  QLabel* locked_;
  FormGroup *of_tools_, *of_arms_, *of_laws_;
  QListWidget* tools_;
  QToolButton* remove_;
  std::unique_ptr<FieldRows<ExerciseTool>> tool_id_;
  std::unique_ptr<FieldRows<ToolDescription>> tool_fields_;
  std::unique_ptr<FieldRows<ToolLook>> look_;
  QLabel* mesh_;
  QToolButton *no_mesh_, *remove_arm_;
  QComboBox* arm_;
  std::unique_ptr<FieldRows<ExerciseArm>> arm_is_, arm_numbers_;
  std::unique_ptr<FieldRows<ExerciseMap>> map_;
  std::unique_ptr<FieldRows<WorkspaceMap>> fixed_;
  std::unique_ptr<FieldRows<MapTurn>> fixed_turn_;
  MapTurn turned_;  // as it was entered: other angles are the same rotation
  std::unique_ptr<FieldRows<Exercise>> laws_, points_;
  QToolButton* measure_;
  Costs costs_;
  std::vector<TradeRow> trades_;
  TradeView *points_trade_, *force_trade_, *rate_trade_, *rays_trade_;
  QLabel* trades_where_;
};

}  // namespace trephine
