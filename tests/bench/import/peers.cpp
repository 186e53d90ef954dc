#include "bench/import/peers.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "base/child_process.h"
#include "volume/volume_files.h"

namespace trephine::bench {

namespace {

namespace fs = std::filesystem;

// Other people's programs. FOLDER is the series, OUT a folder for what they write.
struct Peer {
  const char* program;
  std::vector<std::string> arguments;
};

const std::vector<Peer>& peers() {
  static const std::vector<Peer> all{
      {"dcm2niix", {"-z", "n", "-o", "OUT", "-f", "x", "FOLDER"}},
      {"dicomtonifti", {"-s", "-r", "-o", "OUT/x.nii", "FOLDER"}},
  };
  return all;
}

// What an importer needs to know of a file to group and sort it.
const Peer& scanningPeer() {
  static const Peer peer{
      "gdcmscanner",
      {"-d", "FOLDER", "-t", "0020,000d", "-t", "0020,000e", "-t", "0008,0018", "-t", "0020,0032",
       "-t", "0020,0037", "-t", "0028,0010", "-t", "0028,0011"}};
  return peer;
}

std::string replaced(std::string text, const std::string& word, const std::string& by) {
  if (const auto at = text.find(word); at != text.npos) text.replace(at, word.size(), by);
  return text;
}

// The NIfTI volumes in a folder.
std::vector<fs::path> volumesIn(const fs::path& out) {
  std::vector<fs::path> volumes;
  std::error_code error;
  for (fs::directory_iterator it(out, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".nii") volumes.push_back(it->path());
  }
  return volumes;
}

// Where PATH has a program of this name that may be run.
std::optional<std::filesystem::path> findProgram(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path program = std::filesystem::path(folder) / name;
    std::error_code none;
    if (std::filesystem::is_regular_file(program, none) && ::access(program.c_str(), X_OK) == 0) {
      return program;
    }
  }
  return std::nullopt;
}

// Whether this system runs a program in a namespace of its own, without any network.
bool runsOffline() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  ChildCommand command;
  command.words = offline({"/bin/true"});
  command.output = "/dev/null";
  command.home = folder;
  const Result<ChildRun> run = runChild(command, Progress());
  return run && run->exit_code == 0;
}

Loader peerLoader(const Peer& peer, double limit_s, bool makes_volume) {
  Loader loader;
  loader.names = {peer.program};
  const std::optional<fs::path> program = findProgram(peer.program);
  if (!program) {
    loader.missing = "not installed";
    return loader;
  }
  if (!runsOffline()) {
    loader.missing = "this system grants no namespace without a network";
    return loader;
  }
  loader.run = [=](const LoaderTask& task) -> Result<LoaderRun> {
    std::vector<std::string> words{program->string()};
    for (const std::string& argument : peer.arguments) {
      words.push_back(
          replaced(replaced(argument, "FOLDER", task.folder.string()), "OUT", task.empty.string()));
    }
    ChildCommand command;
    command.words = offline(words);
    command.output = task.empty / "stdout";
    command.home = task.empty;
    command.limit_s = limit_s;
    command.measures_memory = true;
    Result<ChildRun> child = runChild(command, task.progress);
    if (!child) {
      if (child.error().code.str() == "CANCELLED") return child.error();
      return failedRun(child.error().what);
    }
    if (child->timed_out) return failedRun(tookTooLong(limit_s));
    LoaderRun run;
    const std::vector<fs::path> volumes = volumesIn(task.empty);
    if (child->exit_code != 0) {
      run.problem = "failed with exit code " + std::to_string(child->exit_code);
    } else if (makes_volume && volumes.size() != 1) {
      run.problem = "wrote " + std::to_string(volumes.size()) + " volumes";
    } else {
      run.samples.push_back({child->seconds, child->peak_rss_mb.value_or(0.0), std::nullopt});
    }
    if (makes_volume && !run.problem.empty()) run.correct = false;
    if (makes_volume && run.problem.empty() && task.known) {
      run.correct = holdsKnownVoxels(volumes.front(), *task.known);
    }
    return run;
  };
  return loader;
}

// +1 or -1 for a unit vector along the axis, else 0.
int wayAlong(const Vec3& direction, int axis) {
  Vec3 unit(0.0);
  unit[axis] = 1.0;
  const double along = glm::dot(direction, unit);
  return std::abs(along) > 0.999 ? (along > 0.0 ? 1 : -1) : 0;
}

}  // namespace

std::vector<std::string> offline(std::vector<std::string> words) {
  words.insert(words.begin(), {"/usr/bin/unshare", "--user", "--net"});
  return words;
}

bool holdsKnownVoxels(const fs::path& file, const KnownVolume& known) {
  const Result<Volume> read = readVolume(file);
  if (!read || read->geometry.size != known.geometry.size) return false;
  const Index3& size = read->geometry.size;
  std::array<bool, 3> turned{};
  for (int axis = 0; axis < 3; ++axis) {
    const int way = wayAlong(read->geometry.direction[axis], axis);
    if (way == 0) return false;
    turned[std::size_t(axis)] = way < 0;
  }
  Volume upright{known.geometry, {}};
  upright.hu.reserve(read->hu.size());
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      const int from_j = turned[1] ? size[1] - 1 - j : j;
      const int from_k = turned[2] ? size[2] - 1 - k : k;
      const auto row = read->hu.begin() + std::ptrdiff_t(read->geometry.indexOf(0, from_j, from_k));
      if (turned[0]) {
        std::reverse_copy(row, row + size[0], std::back_inserter(upright.hu));
      } else {
        std::copy(row, row + size[0], std::back_inserter(upright.hu));
      }
    }
  }
  return volumeSha256(upright) == known.sha256;
}

ImportSubjects withPeers(ImportSubjects subjects, double limit_s) {
  for (const Peer& peer : peers()) subjects.loaders.push_back(peerLoader(peer, limit_s, true));
  subjects.scanners.push_back(peerLoader(scanningPeer(), limit_s, false));
  return subjects;
}

}  // namespace trephine::bench
