#include "machine/exercise/explain.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <locale>
#include <memory>
#include <set>
#include <sstream>

#include "base/codes.h"
#include "base/memory.h"
#include "base/tr.h"
#include "base/utf8.h"
#include "case/placement.h"
#include "exercise/arm_limits.h"
#include "exercise/names.h"
#include "haptics/haptic_core.h"
#include "machine/trades/trade_knobs.h"
#include "render/scene_renderer.h"
#include "session/arm_devices.h"
#include "session/operator_script.h"
#include "session/run_report.h"
#include "session/tissue_poke.h"
#include "volume/case_memory.h"
#include "volume/grid.h"
#include "volume/phantom.h"

namespace trephine {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int kBatches = 41;
constexpr int kBatchSize = 2000;
// A part that is slow is called less often: no more batches, and no more of one, than this allows.
constexpr auto kPartTime = 100ms, kBatchTime = 5ms;
constexpr int kBetweenLooks = 40;  // calls, so that the clock's own time is none of theirs
static_assert(kBatchSize % kBetweenLooks == 0);

// Median over the batches of the mean time of one call.
double medianNs(const std::function<void()>& call) {
  std::vector<double> ns;
  const auto end = Clock::now() + kPartTime;
  for (int batch = 0; batch < kBatches && (batch == 0 || Clock::now() < end); ++batch) {
    const auto begin = Clock::now();
    int calls = 0;
    while (calls < kBatchSize && (calls == 0 || Clock::now() < begin + kBatchTime)) {
      for (int i = 0; i < kBetweenLooks; ++i) call();
      calls += kBetweenLooks;
    }
    const std::chrono::duration<double, std::nano> took = Clock::now() - begin;
    ns.push_back(took.count() / calls);
  }
  const auto middle = ns.begin() + std::ptrdiff_t(ns.size() / 2);
  std::nth_element(ns.begin(), middle, ns.end());
  return *middle;
}

// A 64 mm cube around the origin, its lower half and 10 mm more of the firmest tissue, not
// cuttable, so that contact lasts; all of it carries that tissue's label.
Grid block(const TissueSet& tissues) {
  const auto firmest = std::max_element(
      tissues.tissues.begin(), tissues.tissues.end(),
      [](const Tissue& a, const Tissue& b) { return a.friction_N.value < b.friction_N.value; });
  Volume volume;
  volume.geometry.size = {64, 64, 64};
  volume.geometry.origin_mm = Vec3(-31.5);
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  const int hu = firmest->hu_min == kAirHu ? kAirHu + 1 : firmest->hu_min;
  std::fill_n(volume.hu.begin(), 64 * 64 * 42, std::int16_t(hu));
  std::shared_ptr<const LabelMap> labels;
  if (firmest->label) {
    labels = std::make_shared<const LabelMap>(
        LabelMap{volume.geometry, std::vector(volume.hu.size(), std::uint8_t(*firmest->label))});
  }
  return Grid(std::move(volume), std::move(labels));
}

// One voxel erased with its journal entry: the mean over a row of voxels, median of the rows.
double removalNs() {
  Volume volume;
  volume.geometry.size = {kBatchSize, kBatches, 1};
  volume.hu.assign(volume.geometry.voxelCount(), 1000);
  Grid grid(std::move(volume));
  Grid::Writer writer = *grid.takeWriter();
  CarveJournal journal(grid.geometry().voxelCount(), 1, 1);
  journal.beginStroke(0, {});
  journal.hasRoom(grid.geometry().voxelCount());
  std::size_t voxel = 0;
  return medianNs([&] { journal.erase(writer, 0, voxel++, 0); });
}

// What a run of the exercise's own script in its own case would warn of: of its beginning alone.
Result<Json> warningsAtStart(Exercise& exercise, const Rig& rig, const Progress& progress) {
  if (exercise.case_source.empty() || exercise.operator_file.empty()) return Json(nullptr);
  Result<OperatorScript> script = readOperatorScript(exercise.operator_file, exercise);
  if (!script) return script.error();
  const Result<Placement> of = openCase(exercise, progress);
  if (!of) return of.error();
  if (of->error) return *of->error;
  const Exercise& fixed = of->exercise;
  const double needed_mb = exerciseMb(of->patient.volume->geometry.voxelCount());
  if (Status enough = enoughMemory(needed_mb, tr("The first tick"), tr("the case")); !enough) {
    return enough.error();
  }
  Grid grid(Volume(*of->patient.volume), of->labels);
  HapticCore core(hapticParameters(fixed, rig), *grid.takeWriter());
  std::array<OperatorSetPoint, kMaxArms> set_points{};
  ScriptOperator(*script, fixed, armFrames(fixed, of->landmarks))
      .setPoints(0, set_points.data(), exercise.arms.size());
  TickInput input;
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    input.arms[i].position_m = set_points[i].pose_m.position;
  }
  TickRecord record;
  core.tick(input, nullptr, 0, record);
  Json warnings = Json::array();
  for (const Warning& warning : of->warnings) {
    warnings.push_back({{"code", warning.code.str()}, {"text", warning.text}});
  }
  for (const Event& event : core.events()) {
    if (event.kind != EventKind::starts_in_tissue) continue;
    const Warning warning =
        startsInTissue(exercise.arms[std::size_t(event.arm)].name, stopAtSolid(exercise.laws));
    warnings.push_back({{"code", warning.code.str()}, {"text", warning.text}});
  }
  return warnings;
}

// Keeps the optimiser from dropping a result that nobody reads.
void keep(const Vec3& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

// What the exercise sets of the knobs that were measured, beside what is recommended. Null without
// a recommendation.
Json settingsOf(const Exercise& exercise, const std::vector<RecommendedSetting>& recommended) {
  if (recommended.empty()) return nullptr;
  Json settings = Json::array();
  for (const auto& [knob, setting] : exerciseSettings(exercise)) {
    for (const RecommendedSetting& r : recommended) {
      if (r.knob != knob) continue;
      settings.push_back({{"knob", knob}, {"setting", setting}, {"recommended", r.setting}});
    }
  }
  return settings;
}

// Whether a law of the exercise, or its removal, goes by the number of this tissue.
bool isUsed(const TissueNumber& number, const Tissue& tissue, const Exercise& exercise) {
  if (!number.of(tissue)) return false;
  if (number.isCutting() && exercise.removal == RemovalKind::work && tissue.cuttable) return true;
  return std::ranges::any_of(exercise.laws, [&](LawKind law) {
    const auto& of = kLawTraits[std::size_t(law)].numbers;
    return std::ranges::find(of, number.in_tick) != of.end();
  });
}

// "Friction 0.3 N, from: a paper; published 0.2 to 0.4 N (measured)"
std::string numberWords(const TissueNumber& row, const SourcedNumber& number) {
  const std::string unit = row.shown_unit ? row.shown_unit : row.unit;
  const std::string words =
      tr("{} {}{}, from: {}", tr(row.label), plainNumber(number.value * row.shown_per),
         (unit.empty() ? "" : " ") + unit, number.source);
  const std::string known = provenanceWords(number, unit, row.shown_per);
  return known.empty() ? words : words + "; " + known;
}

// [{arm, tool, tissue, most_N, friction_N, felt, like:[tissues that it is not told apart from],
// words: one that it is not felt, or one for each of `like`}]
Json touchOf(const Exercise& exercise, const std::vector<ArmPokes>& pokes) {
  Json touch = Json::array();
  for (const ArmPokes& of : pokes) {
    for (std::size_t t = 0; t < of.curves.size(); ++t) {
      Json like = Json::array();
      for (std::size_t other : notToldApart(of, t)) {
        like.push_back(exercise.tissues.tissues[other].id);
      }
      touch.push_back(
          {{"arm", exercise.arms[of.arm].name},
           {"tool", exercise.arms[of.arm].tool},
           {"tissue", exercise.tissues.tissues[t].id},
           {"most_N", of.curves[t].most_N},
           {"friction_N", of.friction_N},
           {"felt",
            of.friction_N > 0.0 ? Json(isFeltThrough(of.curves[t], of.friction_N)) : Json(nullptr)},
           {"at_limit", of.curves[t].most_N >= 0.999 * exercise.arms[of.arm].max_force_N},
           {"like", like},
           {"words", hiddenWords(exercise, of, t)}});
    }
  }
  return touch;
}

}  // namespace

Json usedNumbers(const Exercise& exercise) {
  Json numbers = Json::array();
  for (const Tissue& tissue : exercise.tissues.tissues) {
    for (const TissueNumber& row : kTissueNumbers) {
      if (!isUsed(row, tissue, exercise)) continue;
      const SourcedNumber& number = *row.of(tissue);
      Json item{{"tissue", tissue.id}, {"number", row.key}, {"unit", row.unit}};
      SourcedNumber said = number;
      said.stated = number.confidence();
      item.update(toJson(said));
      item["text"] = numberWords(row, number);
      numbers.push_back(std::move(item));
    }
  }
  return numbers;
}

std::vector<std::pair<std::string, std::string>> exerciseSettings(const Exercise& exercise) {
  std::vector<std::pair<std::string, std::string>> settings;
  const auto add = [&](const std::string& knob, const std::string& setting) {
    const std::pair entry(knob, setting);
    if (std::find(settings.begin(), settings.end(), entry) == settings.end()) {
      settings.push_back(entry);
    }
  };
  for (const ExerciseArm& arm : exercise.arms) {
    const ExerciseTool* tool = exercise.findTool(arm.tool);
    if (!tool) continue;
    const ToolDescription& made = tool->tool.made_from;
    if (made.kind == ToolKind::blade) add("points_blade", std::to_string(made.points));
    if (made.kind == ToolKind::burr) add("points_burr", std::to_string(made.points));
  }
  add("force_at", nameOf(kForceAtNames, exercise.force_at));
  std::ostringstream rate;
  rate.imbue(std::locale::classic());
  rate << exercise.rate_hz;
  add("rate_hz", rate.str());
  add("ray_casting", rayCastingSetting(SceneRenderer::kSampleDistance, !ShadingOptions().normals));
  return settings;
}

Result<Json> explainExercise(Exercise exercise, const std::vector<RecommendedSetting>& recommended,
                             const Progress& progress) {
  Rig rig = simulatedRig(exercise);
  if (Status asked = readArmDynamics(exercise, rig); !asked) return asked.error();
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    exercise.arms[i].max_force_N = mostForce_N(exercise.arms[i], rig.arms[i].dynamics);
  }
  const Result<Json> warnings = warningsAtStart(exercise, rig, Progress(progress, 0.0, 0.5));
  if (!warnings) return warnings.error();
  HapticParameters parameters = hapticParameters(exercise, rig);
  for (int i = 0; i < parameters.tissues.count; ++i) {
    parameters.tissues.classes[std::size_t(i)].cuttable = 0;
  }
  for (ArmParameters& arm : parameters.arms) arm.map.centre_mm = Vec3(0.0);
  Grid grid = block(exercise.tissues);

  Json cost = Json::array(), arms = Json::array();
  // Nothing is timed any more once it was cancelled.
  const double parts = double(exercise.arms.size() * (exercise.laws.size() + 5) + 2);
  double timed = 0.0;
  const auto time = [&](const std::string& part, const std::function<void()>& call) {
    if (progress.cancelled()) return 0.0;
    progress.at(0.5 + 0.3 * timed++ / parts, tr("Timing {}", part));
    return medianNs(call);
  };
  for (std::size_t i = 0; i < exercise.arms.size(); ++i) {
    const ExerciseArm& arm = exercise.arms[i];
    const Tool& tool = parameters.arms[i].tool;
    const Renderable most = renderableOn(arm, rig.arms[i].dynamics, exercise.rate_hz);
    arms.push_back(
        {{"name", arm.name},
         {"plugin", rig.arms[i].device.plugin},
         {"tool", arm.tool},
         {"other_tools", arm.other_tools},
         {"force_scale", arm.map.fixed ? arm.map.fixed->force_scale : arm.map.force_scale},
         {"points", tool.points_m.size()},
         {"renderable", {{"b_max_Ns_per_m", most.b_max}, {"k_max_N_per_m", most.k_max}}}});
    const auto add = [&](const std::string& part, const std::function<void()>& call) {
      cost.push_back({{"part", part}, {"arm", arm.name}, {"ns_per_tick", time(part, call)}});
    };
    ToolContact contact(tool, grid.geometry(), parameters.touch_by_points);
    const TissueField tissue(grid, parameters.tissues);
    add("contact", [&] { contact.update(tissue, Pose{}); });
    std::vector<TouchPoint> points(exercise.force_at == ForceAt::tip ? 1 : tool.points_m.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
      points[p].tissue_class = contact.contact().tissue_class;
      points[p].weight = points.size() == 1 ? 1.0 : tool.weights[p];
      points[p].lever_m = points.size() == 1 ? Vec3(0.0) : tool.points_m[p];
    }
    LawInput input;
    input.points = points;
    input.tissues = &parameters.tissues;
    input.tissue_class = contact.contact().tissue_class;
    input.tip_class = contact.classes()[0];
    LawTissues law_tissues;
    law_tissues.use(parameters.tissues, exercise.laws);
    // With no direction the contact sphere is at the tip: half of it in tissue.
    const Pose at_surface{Vec3(0.0, 0.0, 10.0), Quat(1, 0, 0, 0)};
    for (LawKind kind : exercise.laws) {
      Law law = makeLaw(kind, points.size(), tool, grid.geometry());
      add("law " + std::string(nameOf(kLawNames, kind)), [&] {
        input.tip_m.x += 1e-6;
        law_tissues.ask(law, tissue, at_surface, input);
        ContactForce force;
        addDemanded(law, input, force);
        keep(force.elastic_N);
      });
    }
    if (stopAtSolid(exercise.laws)) {
      // Sliding over the block's top, pressed by a millimetre. It comes from above: a tool that
      // began in the tissue would be held on all sides.
      const double resting_mm = 10.0 + 1000.0 * (tool.radius_m - tool.solid_from_m.z);
      Proxy proxy(tool, grid.geometry());
      Pose at;
      at.position = Vec3(-10.0, 0.0, resting_mm + 5.0);
      proxy.place(at);
      at.position.z = resting_mm - 1.0;
      add("proxy", [&] {
        at.position.x = at.position.x > 10.0 ? -10.0 : at.position.x + 0.01;
        proxy.follow(tissue, at, Cutting::nothing);
        keep(proxy.pull().shift_mm);
      });
    }
    Removal removal(tool, grid.geometry(), exercise.removal, parameters.period_s);
    std::vector<RemovedVoxel> removed;
    removed.reserve(Removal::kMostVoxels);
    Pose moving;
    add("removal sweep", [&] {
      moving.position.x = moving.position.x > 5.0 ? -5.0 : moving.position.x + 0.01;
      removal.sweep(tissue, moving, removed);
    });
    Controller controller =
        makeController(exercise.controller, parameters.arms[i].dynamics, parameters.period_s);
    ControllerInput to_controller;
    to_controller.touching = true;
    to_controller.period_s = parameters.period_s;
    to_controller.velocity_m_s = Vec3(-0.01, 0.0, 0.0);
    add("controller " + std::string(controllerName(exercise.controller)), [&] {
      const Impedance limited = limitImpedance(controller, {12.0, 900.0});
      to_controller.rendered =
          springAndDamper(Vec3(1.0, 0.5, 0.2), limited.stiffness, limited.damping);
      to_controller.demanded_N = to_controller.rendered.at(to_controller.velocity_m_s);
      to_controller.position_m.x -= 1e-9;
      to_controller.last_sent_N = boundForce(controller, to_controller);
      keep(to_controller.last_sent_N);
    });
    OutputLimiter limiter;
    add("clamp and gate", [&] {
      keep(limiter.limit(clampForce(Vec3(4.0, 0.0, 1.0), arm.max_force_N), true, true, 0,
                         parameters.period_s));
    });
  }

  const double removal_ns = progress.cancelled() ? 0.0 : removalNs();
  cost.push_back({{"part", "removal of one voxel"}, {"arm", nullptr}, {"ns_per_tick", removal_ns}});
  HapticCore core(parameters, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  const double tick_ns = time("whole tick", [&] {
    ++input.tick;
    input.journal = core.journalState();
    input.arms[0].position_m.x = 1e-6 * double(input.tick % 1000);
    core.tick(input, nullptr, 0, record);
  });

  if (progress.cancelled())
    return Error{code::kCancelled, tr("The explanation was cancelled"), "", ""};

  const Result<std::vector<ArmPokes>> pokes = pokesOf(exercise, rig, Progress(progress, 0.8, 1.0));
  if (!pokes) return pokes.error();
  Json tissues = Json::array(), laws = Json::array();
  for (const Tissue& tissue : exercise.tissues.tissues) tissues.push_back(tissue.id);
  for (LawKind kind : exercise.laws) laws.push_back(nameOf(kLawNames, kind));
  Json bounded = Json::array();
  for (const BoundedTissue& b : boundedTissues(exercise, rig)) {
    bounded.push_back({{"arm", b.arm},
                       {"tissue", b.tissue},
                       {"damping_Ns_per_m", b.demanded.damping},
                       {"damping_felt_Ns_per_m", b.felt.damping},
                       {"stiffness_N_per_m", b.demanded.stiffness},
                       {"stiffness_felt_N_per_m", b.felt.stiffness}});
  }
  const double journal_mb = double(core.journal().ramBytes()) / (1024.0 * 1024.0);
  const bool named_case = phantomNamed(exercise.case_source).has_value();
  Json answer{{"scene", exercise.name},
              {"goal", exercise.card ? Json(exercise.card->en.goal) : Json(nullptr)},
              {"case", named_case ? Json(exercise.case_source) : Json(nullptr)},
              {"rate_hz", exercise.rate_hz},
              {"controller", controllerName(exercise.controller)},
              {"laws", laws},
              {"force_at", nameOf(kForceAtNames, exercise.force_at)},
              {"removal", nameOf(kRemovalNames, exercise.removal)},
              {"barrier", stopAtSolid(exercise.laws) ? "solid tissue stops a tool until it is cut"
                                                     : "no barrier: a tool is where its arm is"},
              {"tissues", tissues},
              {"numbers", usedNumbers(exercise)},
              {"arms", arms},
              {"warnings", *warnings},
              {"bounded", bounded},
              {"touch", touchOf(exercise, *pokes)},
              {"journal_mb", journal_mb},
              {"cost", cost},
              {"tick_ns", tick_ns}};
  if (!exercise.touch_by_points.empty()) answer["touch_by_points"] = exercise.touch_by_points;
  const Json settings = settingsOf(exercise, recommended);
  if (!settings.is_null()) answer["settings"] = settings;
  return answer;
}

namespace {
// Two tissues that are not told apart are said once.
std::vector<std::string> hiddenLines(const Json& touch) {
  std::vector<std::string> lines;
  std::set<std::array<std::string, 3>> said;
  for (const Json& of : touch) {
    const Json& words = of.at("words");
    for (std::size_t n = 0; n < words.size(); ++n) {
      std::array<std::string, 3> pair{of.at("arm"), of.at("tissue"), ""};
      if (of.at("felt") == true) pair[2] = of.at("like").at(n).get<std::string>();
      if (said.contains({pair[0], pair[2], pair[1]})) continue;
      said.insert(pair);
      lines.push_back(cleanUtf8(words.at(n).get<std::string>()));
    }
  }
  return lines;
}
}  // namespace

std::string explanationText(const Json& explained) {
  const auto word = [](const Json& j, const char* key) {
    return cleanUtf8(j.at(key).get<std::string>());
  };
  const auto number = [](const Json& j, const char* key) { return j.at(key).get<double>(); };
  const auto list = [&](const char* key) {
    std::string text;
    for (const Json& item : explained.at(key))
      text += (text.empty() ? "" : ", ") + cleanUtf8(item.get<std::string>());
    return text;
  };
  std::string text;
  const auto add = [&](const char* format, auto... values) {
    char line[512];
    std::snprintf(line, sizeof(line), format, values...);
    text += line;
  };
  text += word(explained, "scene") + "\n";
  if (explained.at("goal").is_string()) text += "  " + word(explained, "goal") + "\n";
  if (explained.at("case").is_string()) text += tr("  case: {}\n", word(explained, "case"));
  add("  %.0f Hz, controller '%s', force at: %s, removal: %s\n", number(explained, "rate_hz"),
      word(explained, "controller").c_str(), word(explained, "force_at").c_str(),
      word(explained, "removal").c_str());
  text += tr("  laws: {}\n  tissues: {}\n", list("laws"), list("tissues"));
  for (const Json& item : explained.at("numbers")) {
    text += "    " + word(item, "tissue") + ": " + word(item, "text") + "\n";
  }
  if (explained.contains("touch_by_points")) {
    text += tr("  touched by points alone: {}\n", list("touch_by_points"));
  }
  text += "  " + word(explained, "barrier") + "\n";
  for (const Json& arm : explained.at("arms")) {
    const Json& most = arm.at("renderable");
    add("  %s arm: %s, tool '%s' of %d points; shows at most %.3g N s/m and %.4g N/m\n",
        word(arm, "name").c_str(), word(arm, "plugin").c_str(), word(arm, "tool").c_str(),
        arm.at("points").get<int>(), number(most, "b_max_Ns_per_m"), number(most, "k_max_N_per_m"));
    if (number(arm, "force_scale") != 1.0) {
      text += tr("    shows forces {} times as strong as the tissue's\n",
                 plainNumber(number(arm, "force_scale")));
    }
    for (const Json& other : arm.at("other_tools")) {
      text += tr("    may be given the tool '{}'\n", cleanUtf8(other.get<std::string>()));
    }
  }
  for (const Json& b : explained.at("bounded")) {
    add("  '%s' is firmer than the %s arm shows: of %.4g N s/m and %.4g N/m, %.4g and %.4g are "
        "felt\n",
        word(b, "tissue").c_str(), word(b, "arm").c_str(), number(b, "damping_Ns_per_m"),
        number(b, "stiffness_N_per_m"), number(b, "damping_felt_Ns_per_m"),
        number(b, "stiffness_felt_N_per_m"));
  }
  std::string arm;
  for (const Json& touch : explained.at("touch")) {
    if (arm != word(touch, "arm")) {
      arm = word(touch, "arm");
      text +=
          tr("  pushed into a block of each tissue at 10 mm/s, 12 mm deep, the {} arm's {} meets "
             "at most\n",
             arm, word(touch, "tool"));
    }
    add("    %8.2f N  %s%s\n", number(touch, "most_N"), word(touch, "tissue").c_str(),
        touch.at("at_limit") == true ? tr(", all that the arm gives").c_str() : "");
  }
  for (const std::string& line : hiddenLines(explained.at("touch"))) text += "  " + line + "\n";
  if (!explained.at("locks").empty()) {
    text += tr("  locked at this workstation or by the exercise: {}\n", list("locks"));
  }
  if (explained.at("refused").is_string()) {
    text += tr("  not practised at this workstation: {}\n", word(explained, "refused"));
  }
  for (const Json& warning : explained.at("warnings")) text += "  " + word(warning, "text") + "\n";
  add("  a tick of all arms takes %.2f us here, of %.0f us; its parts, each alone:\n",
      number(explained, "tick_ns") / 1e3, 1e6 / number(explained, "rate_hz"));
  for (const Json& part : explained.at("cost")) {
    add("    %8.3f us  %s%s\n", number(part, "ns_per_tick") / 1e3, word(part, "part").c_str(),
        part.at("arm").is_string() ? (tr(", {} arm", word(part, "arm"))).c_str() : "");
  }
  add("  the journal of what is removed takes %.0f MB of memory\n",
      number(explained, "journal_mb"));
  if (!explained.contains("settings")) return text;
  for (const Json& s : explained.at("settings")) {
    text += tr("  {}: {} (recommended: {})\n", word(s, "knob"), word(s, "setting"),
               word(s, "recommended"));
  }
  return text;
}

}  // namespace trephine
