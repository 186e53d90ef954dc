// The inputs that fuzz_exercise starts from: every shipped file, and a short recording of every
// shipped exercise. Each must be accepted, or the program fails.
//
// usage: fuzz_exercise_seeds FOLDER
#include <hdf5.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/file.h"
#include "base/system.h"
#include "cases.h"
#include "exchange/exercise_folder.h"
#include "exercise_files.h"
#include "imaging/codes.h"
#include "imaging/report/provenance.h"
#include "library/case_record.h"
#include "session/session.h"
#include "training/replay.h"

namespace trephine::fuzz {

namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Status writeSeed(const fs::path& folder, Kind kind, const std::string& name, const fs::path& file) {
  return writeTextFile(folder / name, char(kind) + contentOf(file));
}

Status record(const fs::path& exercise_file, const fs::path& file) {
  const Result<Exercise> exercise = readExercise(exercise_file);
  if (!exercise) return exercise.error();
  const Result<OperatorScript> script = dive(*exercise);
  if (!script) return script.error();
  Result<std::unique_ptr<Session>> session =
      Session::create(test::placed(*exercise, smallHead()), {file, *script});
  if (!session) return session.error();
  if (Status run = (*session)->freewheel(double(kTicks) / exercise->rate_hz); !run) return run;
  const auto recording = SessionReader::open(file);
  if (!recording) return recording.error();
  const Result<ReplayResult> result = replay(**recording, smallHead());
  if (!result) return result.error();
  if (result->identical) return {};
  return Error{Code("DIFFERS"), "A recording does not replay", exercise_file.string(), ""};
}

// A recording whose ticks are a link to a pipe, and one whose events lie in another file: refused,
// and opening nothing.
Status writeForeign(const fs::path& folder, const fs::path& recording, const std::string& name) {
  const auto with = [&](const std::string& kind, const char* dataset, const auto& put) {
    const fs::path foreign = folder / "foreign.h5";
    fs::copy_file(recording, foreign, fs::copy_options::overwrite_existing);
    const hid_t file = H5Fopen(foreign.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(file, dataset, H5P_DEFAULT);
    put(file);
    H5Fclose(file);
    if (SessionReader::open(foreign))
      return Error{Code("TAKEN"), "A foreign recording is taken", kind, ""};
    const Status written = writeSeed(folder, kRecording, kind + "-" + name, foreign);
    fs::remove(foreign);
    return written ? Error{} : written.error();
  };
  const Error linked = with("linked", "ticks", [](hid_t file) {
    H5Lcreate_external("scenes/pipe.json", "/x", file, "ticks", H5P_DEFAULT, H5P_DEFAULT);
  });
  if (!linked.code.empty()) return linked;
  const Error outside = with("outside", "events", [](hid_t file) {
    const hsize_t count = 8;
    const hid_t space = H5Screate_simple(1, &count, nullptr), made = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(made, "/dev/zero", 0, 64);
    H5Dclose(H5Dcreate2(file, "events", H5T_NATIVE_INT64, space, H5P_DEFAULT, made, H5P_DEFAULT));
    H5Pclose(made);
    H5Sclose(space);
  });
  return outside.code.empty() ? Status() : Status(outside);
}

// The list of an exported exercise, and what a case of the library says of itself.
Status writeOfCases(const fs::path& folder) {
  const fs::path stick = folder / "stick";
  const auto exported =
      exportExercise(resourceFolder() / "scenes" / "liver-one-arm.json", "", stick);
  if (!exported) return exported.error();
  if (Status s = writeSeed(folder, kList, "list", stick / "exercise.json"); !s) return s;
  fs::remove_all(stick);
  CaseRecord record;
  record.name = "Head 2026-11-24 1";
  record.imported = "2026-11-24T09:30:00";
  record.region = BodyRegion::head;
  record.grid.size = {48, 48, 48};
  record.volume_sha256 = std::string(64, 'a');
  record.verdict = Verdict::repaired;
  record.structures = {{"liver", 1500.0, Vec3(0.5)}};
  record.names_key = "0123456789abcdef";
  if (Result<CaseRecord> again = caseRecordFrom(toJson(record), "case"); !again)
    return again.error();
  if (Status s = writeTextFile(folder / "case", char(kCase) + toJson(record).dump()); !s) return s;
  Provenance of;
  of.source = "DICOM";
  of.answers = {{code::kFace, "deface"}};
  of.changes = {{code::kGantryTilt, Severity::repair, "The stack leans", {"3"}, "Straightened"}};
  if (Result<Provenance> again = provenanceFrom(toJson(of), "p"); !again) return again.error();
  return writeTextFile(folder / "provenance", char(kProvenance) + toJson(of).dump());
}

Status writeSeeds(const fs::path& folder) {
  if (Status made = makeFolder(folder); !made) return made;
  for (int kind = 0; kind < kRecording; ++kind) {
    for (const auto& entry : fs::directory_iterator(resourceFolder() / kFolders[kind])) {
      if (entry.path().extension() != ".json") continue;
      const std::string name = std::string(kFolders[kind]) + "-" + entry.path().stem().string();
      if (Status s = writeSeed(folder, Kind(kind), name, entry.path()); !s) return s;
      if (kind != kExercise) continue;
      const fs::path recording = folder / "recording.h5";
      if (Status s = record(entry.path(), recording); !s) return s;
      if (Status s = writeSeed(folder, kRecording, "recording-" + name, recording); !s) return s;
      if (Status s = writeForeign(folder, recording, name); !s) return s;
      fs::remove(recording);
    }
  }
  return writeOfCases(folder);
}

}  // namespace

}  // namespace trephine::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_exercise_seeds FOLDER\n");
    return 2;
  }
  if (const trephine::Status written = trephine::fuzz::writeSeeds(argv[1]); !written) {
    std::fprintf(stderr, "fuzz_exercise_seeds: %s\n", written.error().sentence().c_str());
    return 1;
  }
  return 0;
}
