// The inputs that fuzz_exercise starts from: every shipped file, and a short recording of every
// shipped scene. Each must be accepted, or the program fails.
//
// usage: fuzz_exercise_seeds FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/file.h"
#include "base/system.h"
#include "cases.h"
#include "exercise_files.h"
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

Status record(const fs::path& scene_file, const fs::path& file) {
  const Result<Scene> scene = readScene(scene_file);
  if (!scene) return scene.error();
  const Result<OperatorScript> script = dive(*scene);
  if (!script) return script.error();
  Result<std::unique_ptr<Session>> session =
      Session::create(*scene, test::placed(*scene, smallHead()), {file, *script});
  if (!session) return session.error();
  if (Status run = (*session)->freewheel(double(kTicks) / scene->rate_hz); !run) return run;
  const auto recording = SessionReader::open(file);
  if (!recording) return recording.error();
  const Result<ReplayResult> result = replay(**recording, smallHead());
  if (!result) return result.error();
  if (result->identical) return {};
  return Error{"DIFFERS", "A recording does not replay", scene_file.string(), ""};
}

Status writeSeeds(const fs::path& folder) {
  if (Status made = makeFolder(folder); !made) return made;
  for (int kind = 0; kind < kRecording; ++kind) {
    for (const auto& entry : fs::directory_iterator(resourceFolder() / kFolders[kind])) {
      if (entry.path().extension() != ".json") continue;
      const std::string name = std::string(kFolders[kind]) + "-" + entry.path().stem().string();
      if (Status s = writeSeed(folder, Kind(kind), name, entry.path()); !s) return s;
      if (kind != kScene) continue;
      const fs::path recording = folder / "recording.h5";
      if (Status s = record(entry.path(), recording); !s) return s;
      if (Status s = writeSeed(folder, kRecording, "recording-" + name, recording); !s) return s;
      fs::remove(recording);
    }
  }
  return {};
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
