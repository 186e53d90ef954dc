// One function a command of trephine-measure: measures, prints the answer, returns the exit code.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "lab/import/import_measurement.h"

namespace trephine {

struct StabilityArguments {
  std::string grid;               // empty: the full grid
  std::string sets;               // "grid,long"; empty: all, or only `grid` where a grid is given
  std::optional<double> seconds;  // empty: as each set has it
  std::string out;
};

struct DeviceArguments {
  double seconds = 60.0;
  int trials = 20;
  std::vector<std::string> benches;  // libraries; empty: what is plugged in
  // One trial alone, which this program asks of itself.
  std::string one;  // "unplugged", "blocked", or empty
  double wait_s = 1.0;
  std::string recording;
};

struct HeadsetArguments {
  double seconds = 20.0;
  int toggles = 50, losses = 20;
  bool no_pictures = false;
};

int measureUploadCommand(bool json, const Progress&);
int measureStabilityCommand(const StabilityArguments& arguments, bool json, const Progress&);
int measureExtremesCommand(const std::string& case_source, const std::string& out, bool json,
                           const Progress&);
int measureHapticsCommand(const std::string& out, bool json, const Progress&);
int measureRenderCommand(const std::string& case_source, const std::string& out, bool json,
                         const Progress&);
int measureTissueCommand(const std::string& out, bool json, const Progress&);
int measureTradesCommand(const std::string& out, bool json, const Progress&);
constexpr const char* kOtherPrograms =
    "Other programs and compressed series are measured by bench_import, which is built with the "
    "tests (tests/bench/import)";
int measureImportCommand(const ImportOptions& options, const std::string& out, bool json,
                         const Progress&);
int measureReadCommand(const std::string& path, bool json, const Progress&);
int measureDevicesCommand(const DeviceArguments& arguments, const std::string& out, bool json,
                          const Progress&);
int measureHeadsetCommand(const HeadsetArguments& arguments, const std::string& out, bool json,
                          const Progress& progress);
int measureJitterCommand(double seconds, const std::string& out, bool json, const Progress&);

}  // namespace trephine
