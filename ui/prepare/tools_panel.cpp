#include "ui/prepare/tools_panel.h"

#include <QHBoxLayout>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "base/json.h"
#include "base/system.h"
#include "base/utf8.h"
#include "exercise/arms_file.h"
#include "exercise/exercise_edits.h"
#include "render/scene_renderer.h"
#include "ui/common/making.h"
#include "ui/common/setting_words.h"
#include "ui/common/translations.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

// What laws and controllers cost holds while these alone are changed.
bool sameButLaws(Exercise a, const Exercise& b) {
  a.laws = b.laws;
  a.controller = b.controller;
  return a == b;
}

// Of the kind that is called so.
template <class Kind>
QString costOf(const std::vector<std::pair<Kind, QString>>& costs, Kind kind) {
  const auto cost = std::ranges::find(costs, kind, [](const auto& of) { return of.first; });
  return cost == costs.end() ? QString() : cost->second;
}

}  // namespace

ToolsPanel::ToolsPanel(QWidget* parent) : QWidget(parent) {
  setObjectName("toolsPanel");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(10);
  locked_ = problemLabel("exerciseLocked", this);
  layout->addWidget(locked_);
  body_ = new QWidget(this);
  auto* groups = tight(new QVBoxLayout(body_), 12);
  buildTools();
  buildArms();
  buildLaws();
  for (FormGroup* group : {of_tools_, of_arms_, of_laws_}) groups->addWidget(group);
  layout->addWidget(body_);
  layout->addStretch(1);
  body_->setEnabled(false);
}

// --- Tools ---

void ToolsPanel::buildTools() {
  of_tools_ = new FormGroup(tr("Tools"), "toolProblem", wanted, body_);
  of_tools_->addAbove(buildToolList());
  tool_id_ = of_tools_->addFields<ExerciseTool>(kToolIdFields, "tool:");
  tool_id_->entered = [this](const ExerciseTool& other, const char*) {
    of_tools_->edit("tool name", [&](Exercise& exercise) {
      renameTool(exercise, std::size_t(tools_->currentRow()), other.id);
    });
  };
  tool_fields_ = of_tools_->addFields<ToolDescription>(kToolFields, "tool:");
  tool_fields_->entered = [this](const ToolDescription& other, const char* key) {
    editTool(key, [&](ExerciseTool& of) {
      const ToolDescription before = std::exchange(of.tool.made_from, other);
      const bool same = before.kind == other.kind && before.shape == other.shape;
      if (!same) of.tool.made_from = fitted(other);
    });
  };
  points_trade_ = new TradeView("pointsTrade", of_tools_->fields());
  of_tools_->form().addRow(points_trade_);
  of_tools_->addRow(tr("Mesh"), buildMesh(), tr("How it is drawn; what it cuts is as above."));
  look_ = of_tools_->addFields<ToolLook>(kLookFields, "tool:");
  look_->entered = [this](const ToolLook& look, const char* key) {
    editTool(key, [&](ExerciseTool& of) { of.look = look; });
  };
}

QWidget* ToolsPanel::buildToolList() {
  auto* box = new QWidget(of_tools_);
  tools_ = named(new QListWidget(box), "toolList");
  tools_->setAccessibleName(tr("Tools of the exercise"));
  tools_->setMaximumHeight(5 * fontMetrics().height() + 12);
  connect(tools_, &QListWidget::currentRowChanged, this, [this] {
    if (!showing_) showTool();
  });
  auto* add = settingButton("addTool", tr("Add a tool"),
                            tr("One of the shipped ones, or of a tool file"), box);
  add->setPopupMode(QToolButton::InstantPopup);
  auto* menu = new QMenu(add);
  add->setMenu(menu);
  connect(menu, &QMenu::aboutToShow, this, [this, menu] {
    menu->clear();
    std::vector<std::filesystem::path> files;
    std::error_code ec;
    for (std::filesystem::directory_iterator at(resourceFolder() / "tools", ec), end;
         !ec && at != end; at.increment(ec)) {
      if (at->path().extension() == ".json") files.push_back(at->path());
    }
    std::ranges::sort(files);
    for (const auto& file : files) {
      menu->addAction(toQt(file.stem()), this, [this, file] { addTool(file); });
    }
    menu->addSeparator();
    QAction* own = menu->addAction(tr("From a &file\u2026"), this, &ToolsPanel::toolFileWanted);
    own->setObjectName("toolFromFile");
  });
  remove_ = settingButton("removeTool", tr("Remove it"), tr("Where no arm has it"), box);
  connect(remove_, &QToolButton::clicked, this, &ToolsPanel::removeTool);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(add);
  buttons->addWidget(remove_);
  buttons->addStretch(1);
  auto* column = tight(new QVBoxLayout(box));
  column->addWidget(tools_);
  column->addLayout(buttons);
  return box;
}

QWidget* ToolsPanel::buildMesh() {
  QWidget* fields = of_tools_->fields();
  mesh_ = named(new QLabel(fields), "toolMesh");
  auto* choose = settingButton("chooseMesh", tr("Choose\u2026"), tr("An STL file, in mm"), fields);
  no_mesh_ = settingButton("noMesh", tr("None"), tr("A plain shape is drawn"), fields);
  connect(choose, &QToolButton::clicked, this, &ToolsPanel::meshWanted);
  connect(no_mesh_, &QToolButton::clicked, this, [this] { setMesh({}); });
  return chosenFile(mesh_, choose, no_mesh_, fields);
}

const ExerciseTool* ToolsPanel::tool() const {
  const int row = tools_->currentRow();
  const bool there = row >= 0 && std::size_t(row) < exercise_.tools.size();
  return there ? &exercise_.tools[std::size_t(row)] : nullptr;
}

// The tool is made anew of what it is described by.
void ToolsPanel::editTool(const std::string& what, const std::function<void(ExerciseTool&)>& edit) {
  if (!tool()) return;
  ExerciseTool edited = *tool();
  edit(edited);
  const Result<Tool> made = makeTool(edited.tool.made_from);
  if (!made) return of_tools_->refuse(made.error());
  edited.tool = *made;
  of_tools_->edit("tool:" + edited.id + ":" + what, [&](Exercise& exercise) {
    exercise.tools[std::size_t(tools_->currentRow())] = edited;
  });
}

void ToolsPanel::addTool(const std::filesystem::path& file) {
  const std::string stem = cleanUtf8(file.stem().string());
  std::string id = stem;
  for (int n = 2; exercise_.findTool(id); ++n) id = stem + "-" + std::to_string(n);
  const Json json{{"id", id}, {"file", file.string()}};
  JsonReader reader(json, file.string());
  const ExerciseTool added = readExerciseTool(reader, file.parent_path());
  if (Status read = reader.finish(); !read) {
    return of_tools_->refuse(
        tr("Not added. %1. %2.").arg(toQt(read.error().what), toQt(read.error().next)));
  }
  of_tools_->edit("add tool", [&](Exercise& exercise) { exercise.tools.push_back(added); });
  tools_->setCurrentRow(tools_->count() - 1);
}

void ToolsPanel::removeTool() {
  if (!tool()) return;
  const std::string& id = tool()->id;
  for (const ExerciseArm& arm : exercise_.arms) {
    const bool other = std::ranges::find(arm.other_tools, id) != arm.other_tools.end();
    if (arm.tool != id && !other) continue;
    return of_tools_->refuse(tr("Not removed. The %1 arm has it: give that another tool first.")
                                 .arg(toQt(arm.name)));
  }
  of_tools_->edit("remove tool", [row = tools_->currentRow()](Exercise& exercise) {
    exercise.tools.erase(exercise.tools.begin() + row);
  });
}

void ToolsPanel::setMesh(const std::filesystem::path& file) {
  editTool("mesh", [&](ExerciseTool& of) {
    of.look = ToolLook{};
    of.look.mesh = file;
  });
}

void ToolsPanel::showTool() {
  of_tools_->fields()->setVisible(tool());
  remove_->setEnabled(tool());
  if (!tool()) return;
  tool_id_->show(*tool());
  tool_fields_->show(tool()->tool.made_from);
  const ToolLook& look = tool()->look;
  mesh_->setText(look.mesh.empty() ? tr("plain shape") : toQt(look.mesh.filename()));
  no_mesh_->setEnabled(!look.mesh.empty());
  look_->show(look);
  look_->setVisible(!look.mesh.empty());
  showTrades();
}

// --- Arms ---

void ToolsPanel::buildArms() {
  of_arms_ = new FormGroup(tr("Arms"), "armProblem", wanted, body_);
  QWidget* fields = of_arms_->fields();
  arm_ = settingChoice("armChoice", tr("Arm"), fields);
  connect(arm_, &QComboBox::activated, this, [this] {
    showArm();
    emit armChosen();
  });
  auto* add = settingButton("addArm", tr("Add one"), tr("Another arm, as this one"), fields);
  remove_arm_ = settingButton("removeArm", tr("Remove it"), tr("One arm stays"), fields);
  connect(add, &QToolButton::clicked, this, [this] {
    if (!arm()) return;
    of_arms_->edit("add arm",
                   [index = chosenArm()](Exercise& exercise) { addArmLike(exercise, index); });
    arm_->setCurrentIndex(arm_->count() - 1);
    showArm();
    emit armChosen();
  });
  connect(remove_arm_, &QToolButton::clicked, this, [this] {
    if (!arm()) return;
    of_arms_->edit("remove arm", [index = chosenArm()](Exercise& exercise) {
      exercise.arms.erase(exercise.arms.begin() + std::ptrdiff_t(index));
    });
  });
  of_arms_->addRow(tr("Arm"), besideEachOther({arm_, add, remove_arm_}, fields),
                   tr("Drag its box in the slices: there it reaches in the patient."));
  constexpr FieldsOf<ExerciseArm> kFields = kArmFields;
  const auto fieldsOf = [this](FieldsOf<ExerciseArm> of) {
    auto made = of_arms_->addFields<ExerciseArm>(of, "arm:");
    made->entered = [this](const ExerciseArm& other, const char* key) {
      editArm(key, [&](ExerciseArm& arm) {
        arm = other.tool == arm.tool ? other : withInHand(arm, other.tool);
      });
    };
    return made;
  };
  arm_is_ = fieldsOf(kFields.first(3));
  map_ = of_arms_->addFields<ExerciseMap>(kExerciseMapFields, "arm:");
  map_->entered = [this](const ExerciseMap& map, const char* key) {
    if (!arm()) return;
    if (std::string_view(key) != "landmark") {
      return editArm(key, [&](ExerciseArm& arm) { arm.map = map; });
    }
    if (!mapAt) return;
    const ExerciseMap there = mapAt(exercise_, chosenArm(), map.landmark);
    editArm(key, [&](ExerciseArm& arm) { arm.map = there; });
  };
  fixed_ = of_arms_->addFields<WorkspaceMap>(kWorkspaceMapFields, "fixed:");
  fixed_->entered = [this](const WorkspaceMap& map, const char* key) {
    editArm(key, [&](ExerciseArm& arm) {
      arm.map.fixed = map;
      arm.map.motion_scale = map.motion_scale;
      arm.map.force_scale = map.force_scale;
    });
  };
  fixed_turn_ = of_arms_->addFields<MapTurn>(kMapTurnFields, "fixed:");
  fixed_turn_->entered = [this](const MapTurn& turn, const char* key) {
    turned_ = turn;
    editArm(key, [&](ExerciseArm& arm) {
      if (arm.map.fixed) arm.map.fixed->rotation = rotationOf(turn);
    });
  };
  arm_numbers_ = fieldsOf(kFields.subspan(3));
}

void ToolsPanel::editArm(const std::string& what, const std::function<void(ExerciseArm&)>& edit) {
  if (!arm()) return;
  of_arms_->edit("arm:" + arm()->name + ":" + what,
                 [&](Exercise& exercise) { edit(exercise.arms[chosenArm()]); });
}

void ToolsPanel::showArm() {
  if (!arm()) return;
  FieldEditor::Offers tools, others, landmarks;
  for (const ExerciseTool& of : exercise_.tools) {
    tools.emplace_back(toQt(of.id), of.id);
    if (of.id != arm()->tool) others.emplace_back(toQt(of.id), of.id);
  }
  for (const Landmark& of : exercise_.landmarks) landmarks.emplace_back(toQt(of.id), of.id);
  landmarks.emplace_back(tr("none: fixed in this patient"), "");
  (*arm_is_)["tool"].offer(tools);
  (*arm_is_)["other_tools"].offer(others);
  (*map_)["landmark"].offer(landmarks);
  arm_is_->show(*arm());
  arm_numbers_->show(*arm());
  remove_arm_->setEnabled(exercise_.arms.size() > 1);
  ExerciseMap map = arm()->map;
  if (map.fixed) map.landmark.clear();
  map_->show(map);
  if (map.fixed) {
    fixed_->show(*map.fixed);
    const Quat& rotation = map.fixed->rotation;
    const bool as_entered = std::abs(glm::dot(rotationOf(turned_), rotation)) > 1.0 - 1e-12;
    if (!as_entered) turned_ = turnOf(rotation);
    fixed_turn_->show(turned_);
  }
  fixed_->setVisible(map.fixed.has_value());
  fixed_turn_->setVisible(map.fixed.has_value());
}

// --- Laws and control ---

void ToolsPanel::buildLaws() {
  of_laws_ = new FormGroup(tr("What is felt"), "lawProblem", wanted, body_);
  QWidget* fields = of_laws_->fields();
  laws_ = of_laws_->addFields<Exercise>(kTouchFields, "scene:");
  laws_->entered = [this](const Exercise& other, const char* key) {
    of_laws_->edit(key, [&](Exercise& exercise) {
      exercise.laws = other.laws;
      exercise.controller = other.controller;
      exercise.force_at = other.force_at;
      exercise.removal = other.removal;
      exercise.rate_hz = other.rate_hz;
    });
  };
  points_ = of_laws_->addFields<Exercise>(kPointsFields, "scene:");
  points_->entered = [this](const Exercise& other, const char* key) {
    of_laws_->edit(key,
                   [&](Exercise& exercise) { exercise.touch_by_points = other.touch_by_points; });
  };
  describeCosts();
  const auto trade = [&](const char* name) {
    auto* view = new TradeView(name, fields);
    of_laws_->form().addRow(view);
    return view;
  };
  force_trade_ = trade("forceTrade");
  rate_trade_ = trade("rateTrade");
  auto* rays = wrapped(
      new QLabel(tr("Samples of a ray in 3-D: what the view draws with is in bold."), fields));
  of_laws_->form().addRow(rays);
  rays_trade_ = trade("raysTrade");
  trades_where_ = settingHint({}, fields);
  trades_where_->setObjectName("tradesWhere");
  of_laws_->form().addRow(trades_where_);
  auto* measure =
      settingButton("measureTrades", tr("Measure the trades here"),
                    tr("Some minutes, beside the window; error and cost of every setting on "
                       "this machine"),
                    fields);
  connect(measure, &QToolButton::clicked, this, &ToolsPanel::tradesWanted);
  of_laws_->form().addRow(measure);
  measure_ =
      settingButton("measureCosts", tr("Measure what each costs"),
                    tr("A second of ticks on this machine, in the exercise's firmest tissue"),
                    fields);
  connect(measure_, &QToolButton::clicked, this, &ToolsPanel::costsWanted);
  of_laws_->form().addRow(measure_);
}

// What each law and controller is called, does and costs.
void ToolsPanel::describeCosts() {
  (*laws_)["laws"].describe([this](const std::string& name) {
    const LawKind law = *kindOf(kLawNames, name);
    const LawWords& words = wordsOf(law);
    return FieldEditor::ChoiceText{fromRoom(words.name), fromRoom(words.meaning),
                                   costOf(costs_.laws, law)};
  });
  (*laws_)["controller"].describe([this](const std::string& name) {
    const ControllerKind kind = *kindOf(kControllerNames, name);
    return FieldEditor::ChoiceText{controllerWord(kind), controllerMeaning(kind),
                                   costOf(costs_.controllers, kind)};
  });
}

void ToolsPanel::showLaws() {
  laws_->show(exercise_);
  FieldEditor::Offers tissues;
  for (const Tissue& of : exercise_.tissues.tissues) tissues.emplace_back(toQt(of.name), of.id);
  (*points_)["touch_by_points"].offer(tissues);
  points_->show(exercise_);
  points_->setVisible(!exercise_.touch_by_points.empty());
  describeCosts();
  showTrades();
}

void ToolsPanel::setTrades(const std::vector<TradeRow>& rows, const QString& where) {
  trades_ = rows;
  trades_where_->setText(where);
  showTrades();
}

void ToolsPanel::showTrades() {
  const ExerciseTool* of = tool();
  const ToolDescription d = of ? of->tool.made_from : ToolDescription{};
  const char* points = d.kind == ToolKind::blade  ? "points_blade"
                       : d.kind == ToolKind::burr ? "points_burr"
                                                  : "";
  points_trade_->show(trades_, points, std::to_string(d.points));
  force_trade_->show(trades_, "force_at", nameOf(kForceAtNames, exercise_.force_at));
  rate_trade_->show(trades_, "rate_hz", plainNumber(exercise_.rate_hz));
  rays_trade_->show(trades_, "ray_casting",
                    plainNumber(SceneRenderer::kSampleDistance) + " voxels");
}

void ToolsPanel::showMeasuring(std::optional<double> share) {
  measure_->setText(share ? tr("Measuring, %1 %: stop").arg(int(100.0 * *share))
                          : tr("Measure what each costs"));
}

void ToolsPanel::setCosts(const Costs& costs) {
  costs_ = costs;
  describeCosts();
}

void ToolsPanel::setExercise(const Exercise& exercise) {
  if (exercise != exercise_) {  // what was refused was of another
    for (FormGroup* group : {of_tools_, of_arms_, of_laws_}) group->forgetRefusal();
  }
  if (!sameButLaws(exercise, exercise_)) costs_ = {};  // they were of another
  exercise_ = exercise;
  showing_ = true;
  body_->setEnabled(locked_->text().isEmpty());
  const int row = std::max(0, tools_->currentRow());
  tools_->clear();
  for (const ExerciseTool& of : exercise_.tools) {
    new QListWidgetItem(tr("%1 \u2014 %2").arg(toQt(of.id), toolKindWord(of)), tools_);
  }
  tools_->setCurrentRow(std::min(row, tools_->count() - 1));
  const int arm = std::max(0, arm_->currentIndex());
  arm_->clear();
  for (const ExerciseArm& of : exercise_.arms) arm_->addItem(toQt(of.name));
  arm_->setCurrentIndex(std::min(arm, arm_->count() - 1));
  showTool();
  showArm();
  showLaws();
  showing_ = false;
}

void ToolsPanel::setLocked(const QString& why) {
  locked_->setText(why);
  locked_->setVisible(!why.isEmpty());
  body_->setEnabled(why.isEmpty() && !exercise_.arms.empty());
}

}  // namespace trephine
