#include "lab/explain.h"

#include <algorithm>
#include <chrono>
#include <functional>

#include "haptics/haptic_core.h"
#include "volume/grid.h"

namespace trephine {

namespace {

constexpr int kBatches = 41;
constexpr int kBatchSize = 2000;

// Median over the batches of the mean time of one call.
double medianNs(const std::function<void()>& call) {
  std::vector<double> ns;
  for (int batch = 0; batch < kBatches; ++batch) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kBatchSize; ++i) call();
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
    ns.push_back(took.count() / kBatchSize);
  }
  std::nth_element(ns.begin(), ns.begin() + kBatches / 2, ns.end());
  return ns[kBatches / 2];
}

// A 64 mm cube of the firmest tissue around the origin, not cuttable, so that contact lasts.
Volume block(const TissueSet& tissues) {
  const auto firmest = std::max_element(
      tissues.tissues.begin(), tissues.tissues.end(),
      [](const Tissue& a, const Tissue& b) { return a.yield_N.value < b.yield_N.value; });
  Volume volume;
  volume.geometry.size = {64, 64, 64};
  volume.geometry.origin_mm = Vec3(-31.5);
  volume.hu.assign(volume.geometry.voxelCount(), std::int16_t(firmest->hu_min));
  return volume;
}

// One voxel erased with its journal entry: the mean over a row of voxels, median of the rows.
double removalNs() {
  Volume volume;
  volume.geometry.size = {kBatchSize, kBatches, 1};
  volume.hu.assign(volume.geometry.voxelCount(), 1000);
  Grid grid(std::move(volume));
  Grid::Writer writer = *grid.takeWriter();
  CarveJournal journal(grid.geometry().voxelCount(), 1);
  journal.beginStroke(0);
  std::size_t voxel = 0;
  return medianNs([&] { journal.erase(writer, 0, voxel++, 0); });
}

// Keeps the optimiser from dropping a result that nobody reads.
void keep(const Vec3& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

}  // namespace

Result<Json> explainScene(const Scene& scene) {
  HapticParameters parameters = hapticParameters(scene);
  for (int i = 0; i < parameters.tissues.count; ++i) {
    parameters.tissues.classes[std::size_t(i)].cuttable = 0;
  }
  for (ArmParameters& arm : parameters.arms) arm.map.centre_mm = Vec3(0.0);
  Grid grid(block(scene.tissues));
  const Mat4 to_voxel = grid.geometry().patientToVoxel();

  Json cost = Json::array(), arms = Json::array();
  for (std::size_t i = 0; i < scene.arms.size(); ++i) {
    const SceneArm& arm = scene.arms[i];
    const Tool& tool = parameters.arms[i].tool;
    arms.push_back({{"name", arm.name},
                    {"plugin", arm.plugin},
                    {"tool", arm.tool},
                    {"points", tool.points_m.size()}});
    const auto add = [&](std::string part, double ns) {
      cost.push_back({{"part", std::move(part)}, {"arm", arm.name}, {"ns_per_tick", ns}});
    };
    std::vector<Hit> hits;
    hits.reserve(tool.points_m.size());
    Contact contact;
    add("contact", medianNs([&] {
          contact = findContact(grid, to_voxel, parameters.tissues, tool, Pose{}, contact,
                                parameters.contact_hold_mm, hits);
        }));
    LawInput input{Vec3(0.0), Vec3(0.01, 0.0, 0.0), contact, {}};
    if (contact.touching()) {
      input.tissue = parameters.tissues.classes[std::size_t(contact.tissue_class)];
    }
    for (LawKind kind : scene.laws) {
      Law law = makeLaw(kind);
      const auto name = std::find_if(kLawNames.begin(), kLawNames.end(),
                                     [&](const auto& entry) { return entry.second == kind; });
      add("law " + std::string(name->first), medianNs([&] {
            input.tip_m.x += 1e-6;
            keep(lawForce(law, input));
          }));
    }
    Controller controller = makeController(scene.controller);
    const ControllerInput controller_input{Vec3(1.0, 0.5, 0.2), Vec3(-0.01, 0.0, 0.0),
                                           parameters.period_s};
    add("controller " + std::string(controllerName(scene.controller)), medianNs([&] {
          keep(std::visit([&](auto& c) { return c.bound(controller_input); }, controller));
        }));
    ForceGate gate;
    add("clamp and gate", medianNs([&] {
          keep(gate.pass(clampForce(Vec3(4.0, 0.0, 1.0), arm.max_force_N), true, true, 0,
                         parameters.period_s));
        }));
  }

  const double removal_ns = removalNs();
  cost.push_back({{"part", "removal of one voxel"}, {"arm", nullptr}, {"ns_per_tick", removal_ns}});
  HapticCore core(parameters, *grid.takeWriter());
  TickInput input;
  TickRecord record;
  const double tick_ns = medianNs([&] {
    ++input.tick;
    input.arms[0].position_m.x = 1e-6 * double(input.tick % 1000);
    core.tick(input, nullptr, 0, record);
  });

  Json tissues = Json::array(), laws = Json::array();
  for (const Tissue& tissue : scene.tissues.tissues) tissues.push_back(tissue.id);
  for (LawKind kind : scene.laws) {
    for (const auto& [name, k] : kLawNames) {
      if (k == kind) laws.push_back(name);
    }
  }
  const double journal_mb = double(parameters.journal_voxels * sizeof(CarveJournal::Entry) +
                                   parameters.journal_strokes * sizeof(CarveJournal::Stroke)) /
                            (1024.0 * 1024.0);
  const bool named_case = scene.case_source.rfind("phantom:", 0) == 0;
  return Json{{"scene", scene.name},
              {"case", named_case ? Json(scene.case_source) : Json(nullptr)},
              {"rate_hz", scene.rate_hz},
              {"controller", controllerName(scene.controller)},
              {"laws", laws},
              {"removal", "on_contact"},
              {"tissues", tissues},
              {"arms", arms},
              {"journal_mb", journal_mb},
              {"cost", cost},
              {"tick_ns", tick_ns}};
}

}  // namespace trephine
