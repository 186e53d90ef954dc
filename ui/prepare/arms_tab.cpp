#include "ui/prepare/arms_tab.h"

#include <QStandardPaths>
#include <algorithm>
#include <cmath>

#include "base/child_process.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/locked_folder.h"
#include "base/log.h"
#include "base/system.h"
#include "base/tr.h"
#include "machine/codes.h"
#include "machine/ticks/law_costs.h"
#include "machine/trades/recommended.h"
#include "machine/trades/trades_measurement.h"
#include "render/tool_mesh.h"
#include "render/tool_view.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

ArmsTab::ArmsTab(Workstation& workstation, FourUp& views, Messages& messages, ToolsPanel& tools,
                 QObject* parent)
    : QObject(parent),
      workstation_(workstation),
      messages_(messages),
      views_(&views),
      tools_(&tools) {
  tools_->wanted = [this](const std::string& what, const auto& change) {
    return workstation_.edit(what, change);
  };
  tools_->mapAt = [this](const Exercise& exercise, std::size_t arm, const std::string& landmark) {
    const std::optional<Placement>& placed = workstation_.placed();
    return placed ? movedTo(exercise, arm, landmark, placed->landmarks) : exercise.arms[arm].map;
  };
  connect(tools_, &ToolsPanel::armChosen, this, &ArmsTab::showBoxes);
  connect(tools_, &ToolsPanel::toolFileWanted, this, [this] {
    messages_.askForFile("toolFileDialog", tr("A tool file"), tr("Tools (*.json)"),
                         [this](const auto& file) { tools_->addTool(file); });
  });
  connect(tools_, &ToolsPanel::meshWanted, this, [this] {
    messages_.askForFile("meshDialog", tr("A mesh"), tr("Surface (*.stl)"),
                         [this](const auto& file) {
                           const Status mesh = checkToolMesh(file);
                           mesh ? tools_->setMesh(file) : messages_.report(mesh.error());
                         });
  });
  connect(tools_, &ToolsPanel::tradesWanted, this, &ArmsTab::measureTrades);
  showTrades();
  connect(tools_, &ToolsPanel::costsWanted, this, &ArmsTab::measureCosts);
  connect(&costing_, &BackgroundTask::progressed, this,
          [this](double share) { tools_->showMeasuring(share); });
  connect(views_, &FourUp::workspaceMoved, this, &ArmsTab::workspaceMoved);
  connect(&workstation_, &Workstation::editsChanged, this, &ArmsTab::refresh);
  connect(&workstation_, &Workstation::locksChanged, this, &ArmsTab::refresh);
  connect(&workstation_, &Workstation::phaseChanged, this, &ArmsTab::showBoxes);
  connect(&workstation_, &Workstation::armsAnswered, this, &ArmsTab::showBoxes);
  connect(&workstation_, &Workstation::caseOpened, this, &ArmsTab::showBoxes);
  connect(&workstation_, &Workstation::structuresChanged, this, &ArmsTab::showBoxes);
}

// A second or two in the background; once more, and it is given up.
void ArmsTab::measureCosts() {
  if (costing_.busy()) return costing_.cancel();
  if (!workstation_.exercise()) return;
  if (workstation_.session()) {
    return messages_.say(
        tr("An exercise is running: it would be measured with it. Stop it first."));
  }
  tools_->showMeasuring(0.0);
  costing_.run(
      [exercise = *workstation_.exercise()](const Progress& progress) {
        return measureLawCosts(exercise, progress);
      },
      [this](Result<LawCosts> costs) {
        tools_->showMeasuring({});
        if (!costs) {
          if (costs.error().code != code::kCancelled) messages_.report(costs.error());
          return;
        }
        ToolsPanel::Costs words;
        for (const auto& [law, ns] : costs->law_ns) {
          words.laws.emplace_back(
              law, ns > costs->noise_ns
                       ? tr("%1 \u00b5s a tick").arg(ns / 1000.0, 0, 'f', 2)
                       : tr("under %1 \u00b5s")
                             .arg(std::max(costs->noise_ns, 10.0) / 1000.0, 0, 'f', 2));
        }
        for (const auto& [kind, ns] : costs->controller_ns) {
          words.controllers.emplace_back(
              kind, tr("%1 \u00b5s a tick, all of it, one arm").arg(ns / 1000.0, 0, 'f', 2));
        }
        tools_->setCosts(words);
      });
}

namespace {

// Of this person on this machine.
std::filesystem::path ownFolder() {
  return toPath(QStandardPaths::writableLocation(QStandardPaths::AppConfigLocation));
}

}  // namespace

// As measured here, else those alone that are recommended, by hospital or makers.
void ArmsTab::showTrades() {
  std::vector<RecommendedSetting> here;
  if (auto read = recommendedHere(workstation_.policy(), ownFolder())) {
    here = *std::move(read);
  } else {
    spdlog::warn("Nothing is recommended: {}", read.error().what);
  }
  if (auto measured = readTrades(ownFolder() / "trades.json")) {
    for (TradeRow& row : measured->rows) {
      const auto of = std::ranges::find(here, row.knob, &RecommendedSetting::knob);
      row.recommended = of != here.end() && of->setting == row.setting;
    }
    return tools_->setTrades(measured->rows, tr("Measured on this machine."));
  }
  std::vector<TradeRow> rows;
  for (const RecommendedSetting& of : here) {
    rows.push_back(
        {of.knob, of.setting, of.error, of.error_unit, of.cost, of.cost_unit, "", true, {}});
  }
  tools_->setTrades(rows, tr("The recommended ones alone: measure them here to see all."));
}

// By the program of the laboratory, beside this one: it draws as well.
void ArmsTab::measureTrades() {
  workstation_.save(
      tr("The trades are measured."),
      [to = ownFolder()](const Progress& progress) -> Status {
        const Result<std::filesystem::path> temporary = temporaryFolder();
        if (!temporary) return temporary.error();
        const Result<LockedFolder> out =
            LockedFolder::make(*temporary, ".trephine-trades-", *temporary);
        if (!out) return out.error();
        progress.at(0.0, trephine::tr("Measuring, some minutes"));
        constexpr double kLongest_s = 1200.0;
        const Result<ChildRun> run =
            runChild({{labProgram().string(), "trades", "--out", out->path().string(), "--json"},
                      out->path() / "answer.json",
                      out->path(),
                      kLongest_s},
                     progress);
        if (!run) return run.error();
        if (run->exit_code != 0) {
          return Error{code::kNotMeasured, trephine::tr("The measurement did not come to its end"),
                       "trephine-lab",
                       trephine::tr("Run 'trephine-lab trades --out DIR' to see why")};
        }
        if (Status made = makeFolder(to); !made) return made;
        for (const char* file : {"trades.json", "recommended.json"}) {
          const Result<Json> json = readJsonFile(out->path() / file);
          if (!json) return json.error();
          if (Status written = writeTextFile(to / file, json->dump(1) + '\n'); !written) {
            return written;
          }
        }
        return {};
      },
      [this] { showTrades(); });
}

void ArmsTab::show(bool in_front) {
  if (in_front && !in_front_) showTrades();  // commissioned since, perhaps
  in_front_ = in_front;
  refresh();
}

void ArmsTab::refresh() {
  if (in_front_ && workstation_.exercise()) {
    tools_->setLocked(
        workstation_.anyLocked()
            ? tr("The exercise is locked. %1.")
                  .arg(lockedWords(workstation_.policy(), !workstation_.policy().locks.empty()))
            : QString());
    tools_->setExercise(*workstation_.exercise());
  }
  showBoxes();
}

// While their tab is in front and no exercise runs: the boxes, and the tools where it begins.
void ArmsTab::showBoxes() {
  const std::optional<Exercise>& exercise = workstation_.exercise();
  const Case* of = workstation_.currentCase();
  const bool idle = workstation_.phase() == Workstation::Phase::ready;
  const bool shown = in_front_ && exercise && of && idle;
  if (!shown) {
    views_->setWorkspaces({});
    if (idle) {
      views_->threeD().setTools({});
      views_->setTools({});
    }
    return;
  }
  std::vector<Vec3> workspaces_mm = workstation_.workspaces_mm();
  workspaces_mm.resize(exercise->arms.size(), Vec3(100.0));  // of an arm that is not there
  const Exercise placed = withFixedMaps(*exercise, workstation_.placed()->landmarks);
  std::vector<WorkspaceBox> boxes;
  std::vector<ToolView> tools;
  for (std::size_t i = 0; i < placed.arms.size(); ++i) {
    const ExerciseArm& arm = placed.arms[i];
    if (!arm.map.fixed) continue;
    const WorkspaceMap& map = *arm.map.fixed;
    const QColor colour = colours::ofArm(arm, i);
    boxes.push_back({map.centre_mm, map.rotation, map.motion_scale * workspaces_mm[i], colour,
                     i == tools_->chosenArm()});
    if (const ExerciseTool* tool = placed.findTool(arm.tool)) {
      tools.push_back(
          toolView(*tool, {map.centre_mm, map.rotation}, false, colours::rgbOf(colour)));
    }
  }
  views_->setWorkspaces(boxes);
  views_->threeD().setTools(tools);
  views_->setTools(tools);
}

// One drag is one edit.
void ArmsTab::workspaceMoved(const Vec3& centre_mm, bool done) {
  const Case* of = workstation_.currentCase();
  if (!workstation_.exercise() || !of || !isFinite(centre_mm)) return;
  Exercise exercise = *workstation_.exercise();
  const std::size_t index = tools_->chosenArm();
  if (index >= exercise.arms.size()) return;
  ExerciseMap& map = exercise.arms[index].map;
  if (map.fixed) {
    map.fixed->centre_mm = centre_mm;
  } else {
    for (const PlacedLandmark& landmark : workstation_.placed()->landmarks) {
      if (landmark.id != map.landmark) continue;
      map.offset_mm =
          glm::conjugate(landmark.frame.rotation) * (centre_mm - landmark.frame.position_mm);
      for (int axis = 0; axis < 3; ++axis) {  // tenths of a mm: what a hand means
        map.offset_mm[axis] = std::round(10.0 * map.offset_mm[axis]) / 10.0;
      }
    }
  }
  const Status moved = workstation_.edit(exercise, "workspace:" + exercise.arms[index].name);
  if (done) workstation_.closeEdit();
  if (!moved && done) messages_.report(moved.error());
  showBoxes();
}

}  // namespace trephine
