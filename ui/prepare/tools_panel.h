// Tools and arms of the exercise: what is in the hands, where an arm reaches in the patient, which
// laws are felt and what keeps them steady. It shows an exercise and tells what a person wants of
// it; what is refused is said below the field's group and the exercise stays.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidget>
#include <filesystem>
#include <functional>
#include <memory>

#include "exercise/exercise.h"
#include "exercise/exercise_numbers.h"
#include "ui/common/number_rows.h"
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

  // A person wants this change of the exercise as it is then; `what` of it.
  std::function<Status(const std::string& what, const std::function<void(Exercise&)>& change)>
      wanted;
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
  QWidget* buildTools();
  QWidget* buildArms();
  QWidget* buildLaws();
  void showTool();
  void showArm();
  void showLaws();
  void showTrades();
  ExerciseTool* tool(Exercise& exercise) const;
  void editTool(const std::string& what, const std::function<void(ExerciseTool&)>& edit);
  void editArm(const std::string& what, const std::function<void(ExerciseArm&)>& edit);
  void editExercise(QLabel* problem, const std::string& what,
                    const std::function<void(Exercise&)>& edit);
  void removeTool();
  void nameTool();
  void addArm();
  void removeArm();

  Exercise exercise_;
  bool showing_ = false;
  QWidget* body_;
  QLabel* locked_;
  QListWidget* tools_;
  QToolButton *add_, *remove_;
  QMenu* add_menu_;
  QWidget* tool_editor_;
  QLineEdit* id_;
  QComboBox *kind_, *shape_;
  QFormLayout* tool_form_;
  QLabel* mesh_;
  QToolButton* no_mesh_;
  std::unique_ptr<NumberRows<ToolDescription>> tool_numbers_, shaft_, head_;
  std::unique_ptr<NumberRows<ToolLook>> look_numbers_, axis_;
  QLabel *tool_problem_, *arm_problem_, *law_problem_;
  QComboBox *arm_, *arm_tool_, *arm_landmark_;
  QListWidget* other_tools_;
  QLineEdit* arm_name_;
  QToolButton *add_arm_, *remove_arm_;
  QFormLayout* arm_form_;
  std::unique_ptr<NumberRows<ExerciseMap>> map_numbers_;
  std::unique_ptr<NumberRows<WorkspaceMap>> fixed_numbers_;
  std::unique_ptr<NumberRows<MapTurn>> fixed_turn_;
  MapTurn turned_;  // as it was entered: other angles are the same rotation
  std::unique_ptr<NumberRows<ExerciseArm>> arm_numbers_;
  std::vector<std::pair<LawKind, QCheckBox*>> laws_;
  std::vector<std::pair<LawKind, QLabel*>> law_costs_;
  QComboBox *controller_, *force_at_, *removal_;
  QLabel *controller_hint_, *controller_cost_;
  QToolButton* measure_;
  std::unique_ptr<NumberRows<Exercise>> rate_;
  Costs costs_;
  std::vector<TradeRow> trades_;
  TradeView *points_trade_, *force_trade_, *rate_trade_, *rays_trade_;
  QLabel* trades_where_;
};

}  // namespace trephine
