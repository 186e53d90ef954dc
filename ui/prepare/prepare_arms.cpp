// Tools and arms: their panel, and where the arms reach in the views.
#include <QFileDialog>

#include "render/tool_view.h"
#include "session/arm_devices.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"
#include "ui/prepare/prepare_workspace.h"

namespace trephine {

namespace {

QColor colourOf(const SceneArm& arm, std::size_t index) {
  if (arm.name == "left") return colours::kLeftArm;
  if (arm.name == "right") return colours::kRightArm;
  return index % 2 == 0 ? colours::kLeftArm : colours::kRightArm;
}

}  // namespace

void PrepareWorkspace::connectArms() {
  tools_->wanted = [this](const Scene& scene, const std::string& what) {
    return sceneWanted(scene, what);
  };
  connect(tools_, &ToolsPanel::armChosen, this, &PrepareWorkspace::showArms);
  connect(tools_, &ToolsPanel::toolFileWanted, this, [this] {
    QFileDialog* dialog =
        bench_.fileDialog("toolFileDialog", tr("A tool file"), tr("Tools (*.json)"));
    connect(dialog, &QFileDialog::fileSelected, this,
            [this](const QString& file) { tools_->addTool(toPath(file)); });
    dialog->open();
  });
  connect(tools_, &ToolsPanel::meshWanted, this, [this] {
    QFileDialog* dialog = bench_.fileDialog("meshDialog", tr("A mesh"), tr("Surface (*.stl)"));
    connect(dialog, &QFileDialog::fileSelected, this,
            [this](const QString& file) { tools_->setMesh(toPath(file)); });
    dialog->open();
  });
  connect(views_, &FourUp::workspaceMoved, this, &PrepareWorkspace::workspaceMoved);
  connect(&workstation_, &Workstation::phaseChanged, this, &PrepareWorkspace::showArms);
  connect(&workstation_, &Workstation::caseOpened, this, &PrepareWorkspace::showArms);
  connect(&workstation_, &Workstation::structuresChanged, this, &PrepareWorkspace::showArms);
}

// Of a form: what is refused is said there.
Status PrepareWorkspace::sceneWanted(const Scene& wanted, const std::string& what) {
  // The tissues are those in use: a form may have been shown before they were edited.
  Scene scene = wanted;
  scene.tissues = workstation_.scene()->tissues;
  Status done = workstation_.edit(scene, what);
  workstation_.closeEdit();
  return done;
}

// While their tab is in front and no exercise runs: the boxes, and the tools where it begins.
void PrepareWorkspace::showArms() {
  const std::optional<Scene>& scene = workstation_.scene();
  const std::optional<Case>& of = workstation_.currentCase();
  const bool idle = workstation_.phase() == Workstation::Phase::ready;
  const bool shown = here_ && tabs_->currentIndex() == kToolTab && scene && of && idle;
  if (!shown) {
    views_->setWorkspaces({});
    if (idle) {
      view_->setTools({});
      views_->setTools({});
    }
    return;
  }
  std::string devices = std::to_string(scene->rate_hz);
  for (const SceneArm& arm : scene->arms) {
    devices += '|' + arm.plugin + '|' + std::to_string(arm.device_arm) + '|' + arm.device_config;
  }
  if (devices != workspaces_of_) {
    const Result<std::vector<Vec3>> sizes = readWorkspaces(*scene);
    workspaces_mm_ = sizes ? *sizes : std::vector<Vec3>(scene->arms.size(), Vec3(100.0));
    workspaces_of_ = devices;
  }
  const Scene placed = withFixedMaps(*scene, of->landmarks);
  std::vector<WorkspaceBox> boxes;
  std::vector<ToolView> tools;
  for (std::size_t i = 0; i < placed.arms.size(); ++i) {
    const SceneArm& arm = placed.arms[i];
    if (!arm.map.fixed) continue;
    const WorkspaceMap& map = *arm.map.fixed;
    const QColor colour = colourOf(arm, i);
    boxes.push_back({map.centre_mm, map.rotation, map.motion_scale * workspaces_mm_[i], colour,
                     i == tools_->chosenArm()});
    if (const SceneTool* tool = placed.findTool(arm.tool)) {
      tools.push_back(toolView(*tool, {map.centre_mm, map.rotation}, false, colours::rgbOf(colour)));
    }
  }
  views_->setWorkspaces(boxes);
  view_->setTools(tools);
  views_->setTools(tools);
}

// One drag is one edit.
void PrepareWorkspace::workspaceMoved(const Vec3& centre_mm, bool done) {
  const std::optional<Case>& of = workstation_.currentCase();
  if (!workstation_.scene() || !of || !isFinite(centre_mm)) return;
  Scene scene = *workstation_.scene();
  const std::size_t index = tools_->chosenArm();
  if (index >= scene.arms.size()) return;
  SceneMap& map = scene.arms[index].map;
  if (map.fixed) {
    map.fixed->centre_mm = centre_mm;
  } else {
    for (const PlacedLandmark& landmark : of->landmarks) {
      if (landmark.id != map.landmark) continue;
      map.offset_mm = glm::conjugate(landmark.frame.rotation) *
                      (centre_mm - landmark.frame.position_mm);
      for (int axis = 0; axis < 3; ++axis) {  // tenths of a mm: what a hand means
        map.offset_mm[axis] = std::round(10.0 * map.offset_mm[axis]) / 10.0;
      }
    }
  }
  const Status moved = workstation_.edit(scene, "workspace:" + scene.arms[index].name);
  if (done) workstation_.closeEdit();
  if (!moved && done) bench_.report(moved.error());
  showArms();
}

}  // namespace trephine
