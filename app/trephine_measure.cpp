// trephine-measure: measurements for those who develop and study Trephine.
#include <CLI/CLI.hpp>

#include "app/answer.h"
#include "app/command_line.h"
#include "app/measure_commands.h"
#include "app/signals.h"
#include "base/crash_report.h"
#include "base/log.h"
#include "base/purpose.h"
#include "base/system.h"
#include "base/time_left.h"
#include "exercise/policy.h"

namespace {

trephine::Progress progress(trephine::withTimeLeft(trephine::reportToTerminal));

int run(int argc, char** argv) {
  using namespace trephine;
  const Policy policy = policyAtStart();
  CLI::App app{std::string("Measurements, each with its reference from the same run. ") + kPurpose +
               "."};
  app.require_subcommand(1);
  app.set_version_flag("--version", buildName());
  constexpr const char* kHidden = "";  // not in the help
  bool json = false;
  std::string out, file, case_source;
  auto with_json = [&](CLI::App* command) {
    command->add_flag("--json", json, "Answer as JSON on stdout; logs go to stderr");
    return command;
  };
  auto* upload_command = with_json(app.add_subcommand("upload", "Partial against full upload"));
  auto* stability_command = with_json(
      app.add_subcommand("stability", "Every controller over a grid of arms, hands and tissues"));
  StabilityArguments stability;
  stability_command->add_option("--grid", stability.grid,
                                "A grid of your own (JSON); the full grid unless given");
  stability_command
      ->add_option("--sets", stability.sets,
                   "Which of grid,long,moving,hands,claims,rest; all unless given, of a "
                   "grid of your own only grid")
      ->check(named());
  stability_command->add_option("--seconds", stability.seconds,
                                "How long a cell runs; 2, long 30, moving 5, rest 60 unless given");
  stability_command->add_option("--out", stability.out, "Folder for the table and the maps")
      ->required();
  auto* extremes_command = with_json(app.add_subcommand(
      "extremes",
      "Values at the edge of what can be given, through the real loop, and tools that "
      "press, rest and come back"));
  extremes_command->add_option("--case", case_source, "A real skull for the barrier as well");
  extremes_command->add_option("--out", out, "Folder for the table")->required();
  auto* haptics_command = with_json(app.add_subcommand(
      "haptics", "What a tick costs, and how true the push of elastic tissue is"));
  haptics_command->add_option("--out", out, "Folder for the table")->required();
  auto* tissue_command = with_json(
      app.add_subcommand("tissue", "The laws and numbers of tissue beside published measurements"));
  tissue_command->add_option("--out", out, "Folder for tables and plots")->required();
  auto* render_command = with_json(app.add_subcommand(
      "render", "What a picture costs and how true it is, beside VTK's own ray caster"));
  render_command->add_option("--case", case_source, "Bone in a case of your own as well");
  render_command->add_option("--out", out, "Folder for the table and the pictures")->required();
  auto* trades_command = with_json(app.add_subcommand(
      "trades", "Speed against accuracy for every knob of touch, and what is recommended here"));
  trades_command->add_option("--out", out, "Folder for tables and charts")->required();
  auto* measure_import_command =
      with_json(app.add_subcommand("import", "How fast CT is read, against a plain read"));
  ImportOptions import_options;
  int edge = import_options.series.size[0];
  measure_import_command->footer(kOtherPrograms);
  measure_import_command->add_flag_callback(
      "--peers", [] { throw CLI::ValidationError("--peers", kOtherPrograms); },
      "Other programs too: moved to bench_import");
  measure_import_command->add_option("--series", import_options.series.names,
                                     "Only int16 or u12; both unless given");
  measure_import_command->add_option("--size", edge, "Rows and columns")->capture_default_str();
  measure_import_command->add_option("--slices", import_options.series.size[2], "Of each series")
      ->capture_default_str();
  measure_import_command->add_option("--repetitions", import_options.repetitions)
      ->capture_default_str();
  measure_import_command
      ->add_option("--scan-series", import_options.series.scan_series,
                   "Series in the folder whose headers are read")
      ->capture_default_str();
  measure_import_command
      ->add_option("--scan-slices", import_options.series.scan_slices, "Slices of each of them")
      ->capture_default_str();
  measure_import_command->add_option("--out", out, "Folder for the table")->required();
  auto* read_command =
      with_json(app.add_subcommand("read", "Read every byte of a folder's files, and no more"));
  read_command->add_option("path", file, "A folder")->required();
  auto* devices_command = with_json(app.add_subcommand(
      "devices", "Arms that are plugged in, or emulated, in a closed loop and in trouble"));
  DeviceArguments devices;
  devices_command->add_option("--seconds", devices.seconds, "Of the closed loop")
      ->capture_default_str();
  devices_command->add_option("--bench", devices.benches,
                              "A library that emulates devices, and can take them out");
  devices_command->add_option("--trials", devices.trials, "Of each trouble, with a bench")
      ->capture_default_str();
  devices_command->add_option("--out", out, "Folder for the table")->required();
  devices_command->add_option("--one", devices.one)->group(kHidden);
  devices_command->add_option("--wait", devices.wait_s)->group(kHidden);
  devices_command->add_option("--recording", devices.recording)->group(kHidden);
  auto* headset_command = with_json(app.add_subcommand(
      "headset", "Pictures for two eyes beside an exercise, and a headset that goes and comes"));
  HeadsetArguments headset;
  headset_command
      ->add_option("--seconds", headset.seconds, "Of the exercise, with and without, 2 to 600")
      ->capture_default_str();
  headset_command
      ->add_option("--toggles", headset.toggles,
                   "How often it is switched on and off, at most 1000")
      ->capture_default_str();
  headset_command->add_option("--losses", headset.losses, "Of each of five kinds, at most 1000")
      ->capture_default_str();
  headset_command->add_flag("--no-pictures", headset.no_pictures,
                            "No pictures of both eyes for each scene");
  headset_command->add_option("--out", out, "Folder for the recording and pictures")
      ->required()
      ->check(named());
  auto* jitter_command =
      with_json(app.add_subcommand("jitter", "How late the haptic thread wakes on this machine"));
  double seconds = 5.0;
  jitter_command->add_option("--seconds", seconds, "For each row")->capture_default_str();
  jitter_command->add_option("--out", out, "Folder for the table")->required();

  if (const auto code = parsed(app, argc, argv)) return *code;
  setUpLog(json);
  if (const auto crashes = stateFolder()) (void)reportCrashesTo(*crashes);
  if (policy.problem) spdlog::warn("{}", policy.problem->sentence());
  if (*upload_command) return measureUploadCommand(json, progress);
  if (*stability_command) return measureStabilityCommand(stability, json, progress);
  if (*extremes_command) return measureExtremesCommand(case_source, out, json, progress);
  if (*haptics_command) return measureHapticsCommand(out, json, progress);
  if (*tissue_command) return measureTissueCommand(out, json, progress);
  if (*render_command) return measureRenderCommand(case_source, out, json, progress);
  if (*trades_command) return measureTradesCommand(out, json, progress);
  if (*measure_import_command) {
    import_options.series.size[0] = import_options.series.size[1] = edge;
    return measureImportCommand(import_options, out, json, progress);
  }
  if (*read_command) return measureReadCommand(file, json, progress);
  if (*devices_command) return measureDevicesCommand(devices, out, json, progress);
  if (*headset_command) return measureHeadsetCommand(headset, out, json, progress);
  if (*jitter_command) return measureJitterCommand(seconds, out, json, progress);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  trephine::keepMemoryPrivate();
  trephine::cancelOnSignals(progress);
  return trephine::guarded("trephine-measure", trephine::wantsJson(argc, argv),
                           [&] { return run(argc, argv); });
}
