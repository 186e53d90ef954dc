// trephine-lab: the workstation's work without a window.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string_view>

#include "app/answer.h"
#include "app/command_line.h"
#include "app/lab_commands.h"
#include "app/signals.h"
#include "base/crash_report.h"
#include "base/log.h"
#include "base/purpose.h"
#include "base/system.h"
#include "base/time_left.h"
#include "exercise/exercise_fields.h"

namespace {

trephine::Progress progress(trephine::withTimeLeft(trephine::reportToTerminal));

int run(int argc, char** argv) {
  using namespace trephine;
  const Policy policy = policyAtStart();
  CLI::App app{std::string("Trephine's laboratory. ") + kPurpose + "."};
  app.require_subcommand(1);
  app.set_version_flag("--version", buildName());
  bool json = false;

  std::string phantom, out, file, case_source, labels;
  RunArguments arguments;
  auto with_json = [&](CLI::App* command) {
    command->add_flag("--json", json, "Answer as JSON on stdout; logs go to stderr");
    return command;
  };
  auto* phantom_command =
      with_json(app.add_subcommand("phantom", "Write a built-in case as a CT series"));
  phantom_command->add_option("name", phantom, "cranium or abdomen")->required();
  phantom_command->add_option("--out", out, "Folder for the slices")->required();

  auto* import_command = with_json(app.add_subcommand("import", "Read a folder of CT, with a report"));
  ImportArguments wanted;
  import_command->add_option("path", wanted.path, "A folder or a file")->required();
  import_command->add_option("--series", wanted.series,
                             "The series to read, by its number in the report or by its UID");
  import_command->add_option("--choice", wanted.choices,
                             "CODE=OPTION: the answer to a question of the report; may be repeated");
  import_command->add_option("--phase", wanted.phase, "Which phase, from 1: as --choice PHASES=N")
      ->check(CLI::Range(1, 100000));
  auto* half = import_command->add_flag("--half", wanted.half, "Half the resolution along each axis");
  import_command->add_flag("--quarter", wanted.quarter, "A quarter of the resolution")->excludes(half);
  import_command->add_flag("--with-identity", wanted.with_identity,
                           "Path, UIDs and descriptions in the JSON, too: not for logs");
  import_command->add_option("--crop", wanted.crop,
                             "I0:I1,J0:J1,K0:K1: keep voxels I0 to I1 - 1 and so on, before --half");
  import_command->add_option("--write", wanted.write, "Save the volume as .mha, .nii or .nii.gz");
  import_command->add_option("--report", wanted.report, "Save the report card as a page (.html)");

  auto* run_command = with_json(app.add_subcommand("run", "Run an exercise with a scripted operator"));
  run_command->add_option("scene", arguments.exercise, "A scene file")->required();
  run_command->add_option("--case", arguments.case_source,
                          "A folder of CT, a volume file, phantom:cranium or phantom:abdomen");
  run_command->add_option("--labels", arguments.labels, "The case's label map, a volume file");
  run_command->add_option("--operator", arguments.operator_file, "An operator script");
  run_command->add_option("--arms", arguments.arms_file,
                          "Which devices move its arms, a file (resources/schemas/arms.md)");
  run_command->add_option("--seconds", arguments.seconds, "How long; the script's length unless given");
  run_command->add_flag("--realtime", arguments.realtime,
                        "At the clock's pace, on a thread of its own; with real arms always");
  for (const FieldOf<Exercise>& field : kTouchFields) {
    const FieldShape shape = shapeOf(field);
    if (shape.kind == FieldKind::choices) continue;
    run_command->add_option(optionOf(shape.row), arguments.settings[shape.row.key],
                            shape.row.meaning);
  }
  run_command->add_option("--save-volume", arguments.save_volume, "Save the carved volume")
      ->check(named());
  run_command
      ->add_option("--csv", arguments.csv,
                   "Save position, velocity, forces and the controller's energy, tick by tick")
      ->check(named());
  run_command->add_option("--out", arguments.out, "Folder for recording and picture")
      ->required()
      ->check(named());

  auto* replay_command = with_json(app.add_subcommand("replay", "Run a recording again and compare"));
  replay_command->add_option("file", file, "A session file")->required();
  replay_command->add_option("--case", case_source, "The case, when it was not a phantom");
  replay_command->add_option("--labels", labels, "The label map, when the session had one");

  std::vector<std::string> recordings;
  auto* recordings_command = with_json(app.add_subcommand(
      "recordings", "What each of these recordings holds; with --json a line of JSON for each"));
  recordings_command->add_option("file", recordings, "Session files")->required();

  auto* explain_command =
      with_json(app.add_subcommand("explain", "What a scene instantiates and what it costs"));
  explain_command->add_option("scene", file, "A scene file")->required();

  auto* pin_command = with_json(app.add_subcommand(
      "pin", "Ask for a PIN, and print it as the workstation's settings keep it"));

  auto* exercise_command = app.add_subcommand("exercise", "Exercises for other workstations");
  exercise_command->require_subcommand(1);
  std::string storage;
  auto* export_exercise_command = with_json(exercise_command->add_subcommand(
      "export", "Write an exercise and all that it names into a folder"));
  export_exercise_command->add_option("scene", file, "A scene file")->required();
  export_exercise_command->add_option("--case", case_source, "Instead of the scene's own case");
  export_exercise_command->add_option("--out", out, "A folder that is not there yet")->required();
  auto* import_exercise_command = with_json(exercise_command->add_subcommand(
      "import", "Take in an exercise that was exported, if it is whole"));
  import_exercise_command->add_option("folder", file, "The folder")->required();
  import_exercise_command->add_option("--storage", storage,
                                      "Where it is kept, instead of the workstation's storage");

  auto* storage_command =
      app.add_subcommand("storage", "The folder of cases, exercises and recordings");
  storage_command->require_subcommand(1);
  bool open_all = false;
  auto* list_storage_command = with_json(
      storage_command->add_subcommand("list", "Its cases, and which of them cannot be opened"));
  list_storage_command->add_option("--storage", storage, "Instead of the workstation's storage");
  list_storage_command->add_flag("--open", open_all,
                                 "Read each, and compare it with what was saved");
  auto* share_storage_command = with_json(storage_command->add_subcommand(
      "share", "Give a folder to several accounts of this machine; as root"));
  share_storage_command->add_option("folder", file, "The folder, made where it is missing")
      ->required()
      ->check(named());

  CommissionArguments commissioning;
  auto* commission_command = with_json(app.add_subcommand(
      "commission", "Whether this machine is fit: each check with its limit and the next step"));
  commission_command->add_option("--out", commissioning.out, "Folder for the page and its figures")
      ->required()
      ->check(named());
  commission_command->add_option("--storage", commissioning.storage,
                                 "Instead of the workstation's storage");
  commission_command
      ->add_option("--seconds", commissioning.seconds, "Of each row of lateness, 0.2 to 60")
      ->capture_default_str();
  commission_command
      ->add_option("--wait", commissioning.patience_s,
                   "Seconds until somebody holds the arms, 0: they are not tried")
      ->capture_default_str();
  constexpr const char* kHidden = "";  // not in the help
  commission_command->add_flag("--progress", commissioning.say_progress)->group(kHidden);
  commission_command->add_flag("--arms", commissioning.arms_alone)->group(kHidden);

  auto* structures_command = app.add_subcommand("structures", "Organs and bones of a case");
  structures_command->require_subcommand(1);
  GrowArguments growing;
  auto* grow_command = with_json(structures_command->add_subcommand(
      "grow", "A structure from one place in it, as a label map on the CT's own grid"));
  grow_command
      ->add_option("case", growing.case_source,
                   "A folder of CT, a volume file, phantom:cranium or phantom:abdomen")
      ->required();
  grow_command->add_option("--seed", growing.seed, "X,Y,Z: a place in it, mm in the patient's LPS")
      ->required();
  grow_command->add_option("--hu", growing.hu,
                           "A,B: its HU; proposed from around the seed unless given");
  grow_command->add_option("--open", growing.open_mm,
                           "Radius of the ball that has room in all of it, mm; 7 unless given");
  grow_command->add_option("--box", growing.box,
                           "X0,X1,Y0,Y1,Z0,Z1: nothing outside of it, mm, LPS");
  grow_command->add_option("--name", growing.name, "What it is called")->required()->check(named());
  grow_command->add_option("--write", growing.write, "The label map: .nii, .nii.gz, .mha or .nrrd")
      ->required();
  StructureImportArguments structures;
  auto* import_structures_command = with_json(structures_command->add_subcommand(
      "import", "Structures of a case from a segmentation: what they are and where they lie"));
  import_structures_command
      ->add_option("case", structures.case_source,
                   "A folder of CT, a volume file, phantom:cranium or phantom:abdomen")
      ->required();
  import_structures_command
      ->add_option("file", structures.file,
                   "DICOM SEG, .seg.nrrd, or a label map with its names beside it")
      ->required();
  import_structures_command->add_option("--choice", structures.choices,
                                        "CODE=OPTION: the answer to a question of its");
  import_structures_command->add_option("--threshold", structures.threshold,
                                        "Of a fractional DICOM SEG: the least share of a voxel");
  import_structures_command->add_option(
      "--write", structures.write,
      "As a label map on the CT's own grid: .nii, .nii.gz, .mha or .nrrd");
  StructureExportArguments exported;
  auto* export_structures_command = with_json(structures_command->add_subcommand(
      "export", "Structures of a case for other programs, and how many mL each has"));
  export_structures_command
      ->add_option("case", exported.case_source,
                   "A folder of CT, a volume file, phantom:cranium or phantom:abdomen")
      ->required();
  export_structures_command->add_option(
      "--structures", exported.structures,
      "A label map or segmentation of it; a built-in case has its own");
  export_structures_command->add_option("--name", exported.names, "These alone");
  export_structures_command->add_option("--choice", exported.choices,
                                        "CODE=OPTION: the answer to a question of the import's");
  export_structures_command->add_option("--threshold", exported.threshold,
                                        "Of a fractional DICOM SEG: the least share of a voxel");
  export_structures_command->add_option(
      "--write", exported.write, "A label map (.nii, .nii.gz, .mha, .nrrd) or the surfaces (.stl)");
  export_structures_command->add_option(
      "--dicom", exported.dicom,
      "Instead: a folder for a DICOM SEG and the CT beside it, under new UIDs and of nobody");
  export_structures_command->add_flag(
      "--source-uids", exported.source_uids,
      "With --dicom, of a case from DICOM: the SEG alone, which names the UIDs of that CT");
  auto* compare_command = with_json(structures_command->add_subcommand(
      "compare", "How alike two label maps of one grid are, structure by structure"));
  std::string other;
  compare_command->add_option("a", file, "A label map")->required();
  compare_command->add_option("b", other, "Another")->required();

  auto* trades_command = with_json(app.add_subcommand(
      "trades", "Speed against accuracy for every knob of touch, and what is recommended here"));
  trades_command->add_option("--out", out, "Folder for the tables")->required();
  // For the help: main() has started that program instead.
  app.add_subcommand("measure",
                     "Measurements for researchers: the program trephine-measure, of the "
                     "package trephine-researcher");

  if (const auto code = parsed(app, argc, argv)) return *code;
  setUpLog(json);
  if (const auto crashes = stateFolder()) (void)reportCrashesTo(*crashes);
  if (policy.problem) spdlog::warn("{}", policy.problem->sentence());
  if (*phantom_command) return phantomCommand(phantom, out, json, progress);
  if (*import_command) return importCommand(wanted, json, progress);
  if (*run_command) return runCommand(arguments, policy, json, progress);
  if (*pin_command) return pinCommand(json, progress);
  if (*export_exercise_command) {
    return exportExerciseCommand(file, case_source, out, json, progress);
  }
  if (*import_exercise_command) {
    return importExerciseCommand(file, storage, policy, json, progress);
  }
  if (*list_storage_command) {
    return listStorageCommand(storage, open_all, policy, json, progress);
  }
  if (*commission_command) return commissionCommand(commissioning, policy, json, progress);
  if (*share_storage_command) return shareStorageCommand(file, json);
  if (*replay_command) return replayCommand(file, case_source, labels, json, progress);
  if (*recordings_command) return recordingsCommand(recordings, json, progress);
  if (*grow_command) return growCommand(growing, json, progress);
  if (*import_structures_command) return importStructuresCommand(structures, json, progress);
  if (*export_structures_command) return exportStructuresCommand(exported, json, progress);
  if (*compare_command) return compareCommand(file, other, json, progress);
  if (*explain_command) return explainCommand(file, policy, json, progress);
  if (*trades_command) return tradesCommand(out, json, progress);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "measure") {
    return trephine::startMeasurements(argv + 1, trephine::wantsJson(argc, argv));
  }
  trephine::keepMemoryPrivate();
  trephine::cancelOnSignals(progress);
  return trephine::guarded("trephine-lab", trephine::wantsJson(argc, argv),
                           [&] { return run(argc, argv); });
}
