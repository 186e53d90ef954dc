#include "ui/prepare/tools_panel.h"

#include <QHBoxLayout>
#include <QMenu>
#include <algorithm>
#include <cmath>

#include "base/json.h"
#include "base/system.h"
#include "base/utf8.h"
#include "haptics/law_input.h"
#include "render/scene_renderer.h"
#include "exercise/arms_file.h"
#include "exercise/exercise_edits.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr int kMostLetters = 40;

QString lawName(LawKind law) {
  switch (law) {
    case LawKind::viscous:
      return ToolsPanel::tr("Viscous");
    case LawKind::coulomb:
      return ToolsPanel::tr("Coulomb");
    case LawKind::elastic:
      return ToolsPanel::tr("Elastic");
    case LawKind::rupture:
      return ToolsPanel::tr("Rupture");
  }
  return {};
}

QString lawMeaning(LawKind law) {
  switch (law) {
    case LawKind::viscous:
      return ToolsPanel::tr("Tissue resists speed: f = -b v, the seed paper's puncture and cutting.");
    case LawKind::coulomb:
      return ToolsPanel::tr("Dry friction: a tool that rests is held, one that slides is braked.");
    case LawKind::elastic:
      return ToolsPanel::tr("Tissue pushes back with its stiffness, and solid tissue stops a tool.");
    case LawKind::rupture:
      return ToolsPanel::tr("A capsule gives way at its rupture force, and the force drops.");
  }
  return {};
}

// What laws and controllers cost holds while these alone are changed.
bool sameButLaws(Exercise a, const Exercise& b) {
  a.laws = b.laws;
  a.controller = b.controller;
  return a == b;
}

template <class Kind, std::size_t N>
void fill(QComboBox& box, const Names<Kind, N>& names) {
  for (const auto& [name, kind] : names) {
    QString words = QString::fromUtf8(name.data(), qsizetype(name.size()));
    words[0] = words[0].toUpper();
    box.addItem(words, int(kind));
  }
}

void chooseData(QComboBox& box, int data) {
  box.setCurrentIndex(box.findData(data));
}

// Read as a unit vector.
constexpr NumberOf<ToolLook> kAxis[] = {
    {{"axis", {-1, 1}, Given::may_be, "from the tip to the handle, in the mesh's frame"},
     &ToolLook::axis}};

}  // namespace

ToolsPanel::ToolsPanel(QWidget* parent) : QWidget(parent) {
  setObjectName("toolsPanel");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(10, 10, 10, 10);
  layout->setSpacing(10);
  locked_ = problemLabel("exerciseLocked", this);
  layout->addWidget(locked_);
  body_ = new QWidget(this);
  auto* groups = new QVBoxLayout(body_);
  groups->setContentsMargins(0, 0, 0, 0);
  groups->setSpacing(12);
  groups->addWidget(buildTools());
  groups->addWidget(buildArms());
  groups->addWidget(buildLaws());
  layout->addWidget(body_);
  layout->addStretch(1);
  body_->setEnabled(false);
}

// --- Tools ---

QWidget* ToolsPanel::buildTools() {
  auto* box = new QWidget(body_);
  auto* layout = new QVBoxLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* title = settingTitle(tr("Tools"), box);
  tools_ = new QListWidget(box);
  tools_->setObjectName("toolList");
  tools_->setAccessibleName(tr("Tools of the exercise"));
  tools_->setMaximumHeight(5 * fontMetrics().height() + 12);
  add_ = settingButton("addTool", tr("Add a tool"),
                       tr("One of the shipped ones, or of a tool file"), box);
  add_->setPopupMode(QToolButton::InstantPopup);
  add_menu_ = new QMenu(add_);
  add_->setMenu(add_menu_);
  connect(add_menu_, &QMenu::aboutToShow, this, [this] {
    add_menu_->clear();
    std::vector<std::filesystem::path> files;
    std::error_code ec;
    for (std::filesystem::directory_iterator at(resourceFolder() / "tools", ec), end;
         !ec && at != end; at.increment(ec)) {
      if (at->path().extension() == ".json") files.push_back(at->path());
    }
    std::ranges::sort(files);
    for (const auto& file : files) {
      add_menu_->addAction(toQt(file.stem()), this, [this, file] { addTool(file); });
    }
    add_menu_->addSeparator();
    QAction* own = add_menu_->addAction(tr("From a &file\u2026"), this, &ToolsPanel::toolFileWanted);
    own->setObjectName("toolFromFile");
  });
  remove_ = settingButton("removeTool", tr("Remove it"), tr("Where no arm has it"), box);
  connect(remove_, &QToolButton::clicked, this, &ToolsPanel::removeTool);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(add_);
  buttons->addWidget(remove_);
  buttons->addStretch(1);

  tool_editor_ = new QWidget(box);
  tool_form_ = settingForm(tool_editor_);
  id_ = new QLineEdit(tool_editor_);
  id_->setObjectName("toolName");
  id_->setMaxLength(kMostLetters);
  connect(id_, &QLineEdit::editingFinished, this, &ToolsPanel::nameTool);
  tool_form_->addRow(tr("Name"), withHint(id_, tr("By it the arms name the tool."), tool_editor_));
  kind_ = settingChoice("toolKind", tr("Kind of tool"), tool_editor_);
  fill(*kind_, kToolNames);
  connect(kind_, &QComboBox::activated, this, [this](int) {
    editTool("kind", [this](ExerciseTool& of) {
      ToolDescription& d = of.tool.made_from;
      d.kind = ToolKind(kind_->currentData().toInt());
      // A burr is at least as long as its head.
      if (d.kind == ToolKind::burr) d.length_mm = std::max(d.length_mm, 2.0 * d.radius_mm + 1.0);
      if (d.kind != ToolKind::burr) d.shape = BurrShape::sphere;
    });
  });
  tool_form_->addRow(tr("Kind"), withHint(kind_,
                                          tr("A needle punctures, a blade slices, a burr "
                                             "grinds."),
                                          tool_editor_));
  shape_ = settingChoice("toolShape", tr("Shape of the burr"), tool_editor_);
  fill(*shape_, kShapeNames);
  connect(shape_, &QComboBox::activated, this, [this](int) {
    editTool("shape", [this](ExerciseTool& of) {
      ToolDescription& d = of.tool.made_from;
      d.shape = BurrShape(shape_->currentData().toInt());
      if (d.shape == BurrShape::cylinder) d.head_mm = std::max(d.head_mm, 2.0 * d.radius_mm);
      d.length_mm = std::max(d.length_mm, d.head_mm + 1.0);
    });
  });
  tool_form_->addRow(tr("Shape"),
                     withHint(shape_, tr("A ball, or a rod with round ends."), tool_editor_));
  const auto numbers = [this](auto rows) {
    auto made = std::make_unique<NumberRows<ToolDescription>>(rows, *tool_form_, tool_editor_,
                                                              "tool:");
    made->entered = [this](const ToolDescription& d, const char* key) {
      editTool(key, [&](ExerciseTool& of) { of.tool.made_from = d; });
    };
    return made;
  };
  tool_numbers_ = numbers(std::span<const NumberOf<ToolDescription>>(kToolNumbers));
  shaft_ = numbers(std::span<const NumberOf<ToolDescription>>(kBurrNumbers).subspan(1));
  head_ = numbers(std::span<const NumberOf<ToolDescription>>(kCylinderNumbers));
  points_trade_ = new TradeView("pointsTrade", tool_editor_);
  tool_form_->addRow(points_trade_);
  auto* mesh_row = new QWidget(tool_editor_);
  auto* mesh_layout = new QGridLayout(mesh_row);
  mesh_layout->setContentsMargins(0, 0, 0, 0);
  mesh_layout->setSpacing(4);
  mesh_ = new QLabel(mesh_row);
  mesh_->setObjectName("toolMesh");
  auto* choose =
      settingButton("chooseMesh", tr("Choose\u2026"), tr("An STL file, in mm"), mesh_row);
  no_mesh_ = settingButton("noMesh", tr("None"), tr("A plain shape is drawn"), mesh_row);
  connect(choose, &QToolButton::clicked, this, &ToolsPanel::meshWanted);
  connect(no_mesh_, &QToolButton::clicked, this, [this] { setMesh({}); });
  mesh_layout->addWidget(mesh_, 0, 0, 1, 3);
  mesh_layout->addWidget(choose, 1, 0);
  mesh_layout->addWidget(no_mesh_, 1, 1);
  mesh_layout->setColumnStretch(2, 1);
  tool_form_->addRow(
      tr("Mesh"),
      withHint(mesh_row, tr("How it is drawn; what it cuts is as above."), tool_editor_));
  look_numbers_ = std::make_unique<NumberRows<ToolLook>>(
      std::span<const NumberOf<ToolLook>>(kLookNumbers), *tool_form_, tool_editor_, "tool:");
  look_numbers_->entered = [this](const ToolLook& look, const char* key) {
    editTool(key, [&](ExerciseTool& of) { of.look = look; });
  };
  axis_ = std::make_unique<NumberRows<ToolLook>>(std::span<const NumberOf<ToolLook>>(kAxis),
                                                 *tool_form_, tool_editor_, "tool:");
  axis_->entered = [this](const ToolLook& look, const char* key) {
    if (!(glm::length(look.axis) > 0.0)) return showTool();
    editTool(key, [&](ExerciseTool& of) { of.look.axis = glm::normalize(look.axis); });
  };
  tool_problem_ = problemLabel("toolProblem", box);
  connect(tools_, &QListWidget::currentRowChanged, this, [this] {
    if (!showing_) showTool();
  });
  layout->addWidget(title);
  layout->addWidget(tools_);
  layout->addLayout(buttons);
  layout->addWidget(tool_problem_);
  layout->addWidget(tool_editor_);
  return box;
}

ExerciseTool* ToolsPanel::tool(Exercise& exercise) const {
  const int row = tools_->currentRow();
  return row >= 0 && std::size_t(row) < exercise.tools.size() ? &exercise.tools[std::size_t(row)]
                                                           : nullptr;
}

void ToolsPanel::editExercise(QLabel* problem, const std::string& what,
                           const std::function<void(Exercise&)>& edit) {
  const Status done = wanted ? wanted(what, edit) : Status();
  if (done) return problem->hide();
  sayNotApplied(*problem, done.error());
  const Exercise as_it_is = exercise_;
  setExercise(as_it_is);
}

// The tool is made anew of what it is described by.
void ToolsPanel::editTool(const std::string& what, const std::function<void(ExerciseTool&)>& edit) {
  const ExerciseTool* of = tool(exercise_);
  if (!of) return;
  ExerciseTool edited = *of;
  edit(edited);
  const Result<Tool> made = makeTool(edited.tool.made_from);
  if (!made) {
    sayNotApplied(*tool_problem_, made.error());
    return showTool();
  }
  edited.tool = *made;
  editExercise(tool_problem_, "tool:" + edited.id + ":" + what,
            [&](Exercise& exercise) { *tool(exercise) = edited; });
}

void ToolsPanel::nameTool() {
  ExerciseTool* of = tool(exercise_);
  const std::string typed = cleanUtf8(id_->text().toStdString());
  id_->setModified(false);
  if (!of || typed == of->id) return;
  if (typed.empty()) return id_->setText(toQt(of->id));
  const std::string before = of->id;
  editExercise(tool_problem_, "tool name", [&](Exercise& exercise) {
    tool(exercise)->id = typed;
    for (ExerciseArm& arm : exercise.arms) {
      if (arm.tool == before) arm.tool = typed;
      std::ranges::replace(arm.other_tools, before, typed);
    }
  });
}

void ToolsPanel::addTool(const std::filesystem::path& file) {
  const std::string stem = cleanUtf8(file.stem().string());
  std::string id = stem;
  for (int n = 2; exercise_.findTool(id); ++n) id = stem + "-" + std::to_string(n);
  const Json json{{"id", id}, {"file", file.string()}};
  JsonReader reader(json, file.string());
  const ExerciseTool tool = readExerciseTool(reader, file.parent_path());
  if (Status read = reader.finish(); !read) {
    tool_problem_->setText(
        tr("Not added. %1. %2.").arg(toQt(read.error().what), toQt(read.error().next)));
    return tool_problem_->show();
  }
  editExercise(tool_problem_, "add tool", [&](Exercise& exercise) { exercise.tools.push_back(tool); });
  tools_->setCurrentRow(tools_->count() - 1);
}

void ToolsPanel::removeTool() {
  const ExerciseTool* of = tool(exercise_);
  if (!of) return;
  for (const ExerciseArm& arm : exercise_.arms) {
    const bool other = std::ranges::find(arm.other_tools, of->id) != arm.other_tools.end();
    if (arm.tool != of->id && !other) continue;
    tool_problem_->setText(tr("Not removed. The %1 arm has it: give that another tool first.")
                               .arg(toQt(arm.name)));
    return tool_problem_->show();
  }
  const int row = tools_->currentRow();
  editExercise(tool_problem_, "remove tool",
            [&](Exercise& exercise) { exercise.tools.erase(exercise.tools.begin() + row); });
}

void ToolsPanel::setMesh(const std::filesystem::path& file) {
  editTool("mesh", [&](ExerciseTool& of) {
    of.look = ToolLook{};
    of.look.mesh = file;
  });
}

void ToolsPanel::showTool() {
  Exercise& exercise = exercise_;
  const ExerciseTool* of = tool(exercise);
  tool_editor_->setVisible(of);
  remove_->setEnabled(of);
  if (!of) return;
  const ToolDescription& d = of->tool.made_from;
  if (!id_->hasFocus() || !id_->isModified()) id_->setText(toQt(of->id));
  chooseData(*kind_, int(d.kind));
  chooseData(*shape_, int(d.shape));
  const bool burr = d.kind == ToolKind::burr;
  tool_form_->setRowVisible(shape_->parentWidget(), burr);
  tool_numbers_->show(d);
  shaft_->show(d);
  shaft_->setVisible(burr);
  head_->show(d);
  head_->setVisible(burr && d.shape == BurrShape::cylinder);
  const bool mesh = !of->look.mesh.empty();
  mesh_->setText(mesh ? toQt(of->look.mesh.filename()) : tr("plain shape"));
  no_mesh_->setEnabled(mesh);
  look_numbers_->show(of->look);
  look_numbers_->setVisible(mesh);
  axis_->show(of->look);
  axis_->setVisible(mesh);
  showTrades();
}

// --- Arms ---

QWidget* ToolsPanel::buildArms() {
  auto* box = new QWidget(body_);
  auto* layout = new QVBoxLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* title = settingTitle(tr("Arms"), box);
  auto* fields = new QWidget(box);
  arm_form_ = settingForm(fields);
  arm_ = settingChoice("armChoice", tr("Arm"), fields);
  connect(arm_, &QComboBox::activated, this, [this] {
    showArm();
    emit armChosen();
  });
  arm_form_->addRow(tr("Arm"), withHint(arm_,
                                        tr("Drag its box in the slices: there it reaches in "
                                           "the patient."),
                                        fields));
  auto* of_arm = new QWidget(fields);
  auto* of_layout = new QGridLayout(of_arm);
  of_layout->setContentsMargins(0, 0, 0, 0);
  of_layout->setSpacing(4);
  arm_name_ = new QLineEdit(of_arm);
  arm_name_->setObjectName("armName");
  arm_name_->setAccessibleName(tr("Name of the arm"));
  arm_name_->setMaxLength(kMostLetters);
  connect(arm_name_, &QLineEdit::editingFinished, this, [this] {
    const std::string typed = cleanUtf8(arm_name_->text().toStdString());
    arm_name_->setModified(false);
    if (chosenArm() >= exercise_.arms.size() || typed == exercise_.arms[chosenArm()].name) return;
    if (typed.empty()) return showArm();
    editArm("name", [&](ExerciseArm& arm) { arm.name = typed; });
  });
  add_arm_ = settingButton("addArm", tr("Add one"), tr("Another arm, as this one"), of_arm);
  remove_arm_ = settingButton("removeArm", tr("Remove it"), tr("One arm stays"), of_arm);
  connect(add_arm_, &QToolButton::clicked, this, &ToolsPanel::addArm);
  connect(remove_arm_, &QToolButton::clicked, this, &ToolsPanel::removeArm);
  of_layout->addWidget(arm_name_, 0, 0, 1, 3);
  of_layout->addWidget(add_arm_, 1, 0);
  of_layout->addWidget(remove_arm_, 1, 1);
  of_layout->setColumnStretch(2, 1);
  arm_form_->addRow(tr("Called"), withHint(of_arm,
                                           tr("Left and right are the hands that people "
                                              "have."),
                                           fields));
  arm_tool_ = settingChoice("armTool", tr("Tool of the arm"), fields);
  connect(arm_tool_, &QComboBox::activated, this, [this](int) {
    const std::string id = arm_tool_->currentData().toString().toStdString();
    editArm("tool", [&](ExerciseArm& arm) {
      // The one that it had stays at hand.
      const std::string before = std::exchange(arm.tool, id);
      std::erase(arm.other_tools, id);
      if (before != id && arm.other_tools.size() + 1 < kMostTools) {
        arm.other_tools.push_back(before);
      }
    });
  });
  arm_form_->addRow(tr("In hand"), withHint(arm_tool_, tr("What it holds at first."), fields));
  other_tools_ = new QListWidget(fields);
  other_tools_->setObjectName("otherTools");
  other_tools_->setAccessibleName(tr("Other tools of the arm"));
  other_tools_->setMaximumHeight(4 * fontMetrics().height() + 12);
  connect(other_tools_, &QListWidget::itemChanged, this, [this] {
    if (showing_) return;
    std::vector<std::string> ids;
    for (int i = 0; i < other_tools_->count(); ++i) {
      const QListWidgetItem& item = *other_tools_->item(i);
      if (item.checkState() == Qt::Checked) {
        ids.push_back(item.data(Qt::UserRole).toString().toStdString());
      }
    }
    editArm("other tools", [&](ExerciseArm& arm) { arm.other_tools = ids; });
  });
  arm_form_->addRow(tr("Others"),
                    withHint(other_tools_, tr("What may be taken meanwhile (Ctrl+T)."), fields));
  arm_landmark_ = settingChoice("armLandmark", tr("Landmark of the arm"), fields);
  connect(arm_landmark_, &QComboBox::activated, this, [this](int) {
    const std::string id = arm_landmark_->currentData().toString().toStdString();
    const std::size_t index = chosenArm();
    if (!mapAt || index >= exercise_.arms.size()) return;
    const ExerciseMap map = mapAt(exercise_, index, id);
    editArm("landmark", [&](ExerciseArm& arm) { arm.map = map; });
  });
  arm_form_->addRow(
      tr("Landmark"),
      withHint(arm_landmark_,
               tr("The place that it goes with, on any patient; or none, in this one."), fields));
  map_numbers_ = std::make_unique<NumberRows<ExerciseMap>>(
      std::span<const NumberOf<ExerciseMap>>(kExerciseMapNumbers), *arm_form_, fields, "arm:");
  map_numbers_->entered = [this](const ExerciseMap& map, const char* key) {
    editArm(key, [&](ExerciseArm& arm) { arm.map = map; });
  };
  fixed_numbers_ = std::make_unique<NumberRows<WorkspaceMap>>(
      std::span<const NumberOf<WorkspaceMap>>(kWorkspaceMapNumbers), *arm_form_, fields, "fixed:");
  fixed_numbers_->entered = [this](const WorkspaceMap& map, const char* key) {
    editArm(key, [&](ExerciseArm& arm) {
      arm.map.fixed = map;
      arm.map.motion_scale = map.motion_scale;
      arm.map.force_scale = map.force_scale;
    });
  };
  fixed_turn_ = std::make_unique<NumberRows<MapTurn>>(
      std::span<const NumberOf<MapTurn>>(kMapTurnNumbers), *arm_form_, fields, "fixed:");
  fixed_turn_->entered = [this](const MapTurn& turn, const char* key) {
    turned_ = turn;
    editArm(key, [&](ExerciseArm& arm) {
      if (arm.map.fixed) arm.map.fixed->rotation = rotationOf(turn);
    });
  };
  arm_numbers_ = std::make_unique<NumberRows<ExerciseArm>>(
      std::span<const NumberOf<ExerciseArm>>(kArmNumbers), *arm_form_, fields, "arm:");
  arm_numbers_->entered = [this](const ExerciseArm& entered, const char* key) {
    editArm(key, [&](ExerciseArm& arm) { arm = entered; });
  };
  arm_problem_ = problemLabel("armProblem", box);
  layout->addWidget(title);
  layout->addWidget(arm_problem_);
  layout->addWidget(fields);
  return box;
}

void ToolsPanel::editArm(const std::string& what, const std::function<void(ExerciseArm&)>& edit) {
  const std::size_t index = chosenArm();
  if (index >= exercise_.arms.size()) return;
  editExercise(arm_problem_, "arm:" + exercise_.arms[index].name + ":" + what,
            [&](Exercise& exercise) { edit(exercise.arms[index]); });
}

void ToolsPanel::addArm() {
  if (chosenArm() >= exercise_.arms.size()) return;
  ExerciseArm more = exercise_.arms[chosenArm()];
  const auto named = [&](const std::string& name) {
    return std::ranges::find(exercise_.arms, name, &ExerciseArm::name) != exercise_.arms.end();
  };
  more.name = !named("left") ? "left" : !named("right") ? "right" : "arm-3";
  for (int n = 3; named(more.name); ++n) more.name = "arm-" + std::to_string(n);
  editExercise(arm_problem_, "add arm", [&](Exercise& exercise) { exercise.arms.push_back(more); });
  arm_->setCurrentIndex(arm_->count() - 1);
  showArm();
  emit armChosen();
}

void ToolsPanel::removeArm() {
  const std::size_t index = chosenArm();
  if (index >= exercise_.arms.size()) return;
  editExercise(arm_problem_, "remove arm",
            [&](Exercise& exercise) { exercise.arms.erase(exercise.arms.begin() + std::ptrdiff_t(index)); });
}

void ToolsPanel::showArm() {
  const std::size_t index = chosenArm();
  if (index >= exercise_.arms.size()) return;
  const ExerciseArm& arm = exercise_.arms[index];
  const bool before = std::exchange(showing_, true);
  arm_tool_->clear();
  other_tools_->clear();
  for (const ExerciseTool& of : exercise_.tools) {
    arm_tool_->addItem(toQt(of.id), toQt(of.id));
    if (of.id == arm.tool) continue;
    auto* item = new QListWidgetItem(toQt(of.id), other_tools_);
    item->setData(Qt::UserRole, toQt(of.id));
    item->setFlags(item->flags() | Qt::ItemIsUserCheckable);
    const bool has = std::ranges::find(arm.other_tools, of.id) != arm.other_tools.end();
    item->setCheckState(has ? Qt::Checked : Qt::Unchecked);
  }
  arm_tool_->setCurrentIndex(arm_tool_->findData(toQt(arm.tool)));
  arm_landmark_->clear();
  for (const Landmark& landmark : exercise_.landmarks) {
    arm_landmark_->addItem(toQt(landmark.id), toQt(landmark.id));
  }
  arm_landmark_->addItem(tr("none: fixed in this patient"), QString());
  arm_landmark_->setCurrentIndex(
      arm_landmark_->findData(arm.map.fixed ? QString() : toQt(arm.map.landmark)));
  if (!arm_name_->hasFocus() || !arm_name_->isModified()) arm_name_->setText(toQt(arm.name));
  remove_arm_->setEnabled(exercise_.arms.size() > 1);
  map_numbers_->setVisible(!arm.map.fixed);
  map_numbers_->show(arm.map);
  fixed_numbers_->setVisible(arm.map.fixed.has_value());
  fixed_turn_->setVisible(arm.map.fixed.has_value());
  if (arm.map.fixed) {
    fixed_numbers_->show(*arm.map.fixed);
    const Quat& rotation = arm.map.fixed->rotation;
    const bool as_entered = std::abs(glm::dot(rotationOf(turned_), rotation)) > 1.0 - 1e-12;
    if (!as_entered) turned_ = turnOf(rotation);
    fixed_turn_->show(turned_);
  }
  arm_numbers_->show(arm);
  showing_ = before;
}

// --- Laws and control ---

QWidget* ToolsPanel::buildLaws() {
  auto* box = new QWidget(body_);
  auto* layout = new QVBoxLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* title = settingTitle(tr("What is felt"), box);
  layout->addWidget(title);
  law_problem_ = problemLabel("lawProblem", box);
  layout->addWidget(law_problem_);
  for (const auto& [name, law] : kLawNames) {
    auto* check = new QCheckBox(lawName(law), box);
    check->setObjectName("law:" + QString::fromUtf8(name.data(), qsizetype(name.size())));
    connect(check, &QCheckBox::toggled, this, [this, law = law](bool on) {
      if (showing_) return;
      editExercise(law_problem_, "laws", [&](Exercise& exercise) {
        std::erase(exercise.laws, law);
        if (on) exercise.laws.push_back(law);
        std::ranges::sort(exercise.laws);
      });
    });
    auto* cost = new QLabel(box);
    cost->setObjectName(check->objectName() + ":cost");
    cost->setProperty("quiet", true);
    auto* beside = new QHBoxLayout;
    beside->addWidget(check, 1);
    beside->addWidget(cost);
    layout->addLayout(beside);
    layout->addWidget(settingHint(lawMeaning(law), box));
    laws_.emplace_back(law, check);
    law_costs_.emplace_back(law, cost);
  }
  auto* fields = new QWidget(box);
  auto* rows = settingForm(fields);
  controller_ = settingChoice("sceneController", tr("Controller"), fields);
  for (const auto& [name, kind] : kControllerNames) {
    controller_->addItem(controllerWord(kind), int(kind));
  }
  connect(controller_, &QComboBox::activated, this, [this](int) {
    editExercise(law_problem_, "controller", [this](Exercise& exercise) {
      exercise.controller = ControllerKind(controller_->currentData().toInt());
    });
  });
  controller_hint_ = settingHint({}, fields);
  controller_cost_ = new QLabel(fields);
  controller_cost_->setObjectName("controllerCost");
  controller_cost_->setProperty("quiet", true);
  controller_cost_->setWordWrap(true);
  auto* control = new QWidget(fields);
  auto* control_layout = new QVBoxLayout(control);
  control_layout->setContentsMargins(0, 0, 0, 0);
  control_layout->setSpacing(1);
  control_layout->addWidget(controller_);
  control_layout->addWidget(controller_cost_);
  control_layout->addWidget(controller_hint_);
  rows->addRow(tr("Control"), control);
  force_at_ = settingChoice("forceAt", tr("Where the force acts"), fields);
  fill(*force_at_, kForceAtNames);
  connect(force_at_, &QComboBox::activated, this, [this](int) {
    editExercise(law_problem_, "force at", [this](Exercise& exercise) {
      exercise.force_at = ForceAt(force_at_->currentData().toInt());
    });
  });
  rows->addRow(tr("Force at"),
               withHint(force_at_,
                        tr("The tip in the firmest tissue, or along the tool, each point "
                           "in its own."),
                        fields));
  force_trade_ = new TradeView("forceTrade", fields);
  rows->addRow(force_trade_);
  removal_ = settingChoice("removal", tr("How tissue is removed"), fields);
  fill(*removal_, kRemovalNames);
  connect(removal_, &QComboBox::activated, this, [this](int) {
    editExercise(law_problem_, "removal", [this](Exercise& exercise) {
      exercise.removal = RemovalKind(removal_->currentData().toInt());
    });
  });
  rows->addRow(tr("Removal"), withHint(removal_,
                                       tr("As much as the work of hand and motor pays for, "
                                          "or all that is met."),
                                       fields));
  rate_ = std::make_unique<NumberRows<Exercise>>(std::span<const NumberOf<Exercise>>(kExerciseNumbers), *rows,
                                              fields, "scene:");
  rate_->entered = [this](const Exercise& other, const char* key) {
    editExercise(law_problem_, key, [&](Exercise& exercise) { exercise.rate_hz = other.rate_hz; });
  };
  rate_trade_ = new TradeView("rateTrade", fields);
  rows->addRow(rate_trade_);
  rays_trade_ = new TradeView("raysTrade", fields);
  auto* rays =
      new QLabel(tr("Samples of a ray in 3-D: what the view draws with is in bold."), fields);
  rays->setWordWrap(true);
  rows->addRow(rays);
  rows->addRow(rays_trade_);
  trades_where_ = settingHint({}, fields);
  trades_where_->setObjectName("tradesWhere");
  rows->addRow(trades_where_);
  auto* measure =
      settingButton("measureTrades", tr("Measure the trades here"),
                    tr("Some minutes, beside the window; error and cost of every setting on "
                       "this machine"),
                    fields);
  connect(measure, &QToolButton::clicked, this, &ToolsPanel::tradesWanted);
  rows->addRow(measure);
  layout->addWidget(fields);
  measure_ =
      settingButton("measureCosts", tr("Measure what each costs"),
                    tr("A second of ticks on this machine, in the exercise's firmest tissue"), box);
  connect(measure_, &QToolButton::clicked, this, &ToolsPanel::costsWanted);
  layout->addWidget(measure_, 0, Qt::AlignLeft);
  return box;
}

void ToolsPanel::showLaws() {
  for (const auto& [law, check] : laws_) check->setChecked(names(exercise_.laws, law));
  for (const auto& [law, label] : law_costs_) {
    label->clear();
    for (const auto& [of, words] : costs_.laws) {
      if (of == law) label->setText(words);
    }
  }
  chooseData(*controller_, int(exercise_.controller));
  controller_hint_->setText(controllerMeaning(exercise_.controller));
  controller_cost_->clear();
  for (const auto& [of, words] : costs_.controllers) {
    if (of == exercise_.controller) controller_cost_->setText(words);
  }
  controller_cost_->setVisible(!controller_cost_->text().isEmpty());
  chooseData(*force_at_, int(exercise_.force_at));
  chooseData(*removal_, int(exercise_.removal));
  rate_->show(exercise_);
  showTrades();
}

void ToolsPanel::setTrades(const std::vector<TradeRow>& rows, const QString& where) {
  trades_ = rows;
  trades_where_->setText(where);
  showTrades();
}

void ToolsPanel::showTrades() {
  const ExerciseTool* of = tool(exercise_);
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
  showing_ = true;
  showLaws();
  showing_ = false;
}

void ToolsPanel::setExercise(const Exercise& exercise) {
  if (exercise != exercise_) {  // what was refused was of another
    for (QLabel* problem : {tool_problem_, arm_problem_, law_problem_}) problem->hide();
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
