// One function a command of trephine-lab: does the work, prints the answer, returns the exit code.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "exercise/policy.h"

namespace trephine {

struct RunArguments {
  std::string exercise;
  std::string case_source;  // empty: the exercise's own
  std::string labels;       // empty: the exercise's own
  std::string operator_file;  // empty: the exercise's default
  std::string arms_file;      // empty: the exercise's own devices
  std::optional<double> seconds;  // empty: as long as the script
  std::map<std::string, std::string> settings;  // of the exercise, by kTouchFields' keys
  std::string save_volume;
  std::string csv;  // empty: none
  std::string out;
  bool realtime = false;
};

struct ImportArguments {
  std::string path;
  std::string series;                // empty: the CT series with most slices
  std::vector<std::string> choices;  // CODE=OPTION
  std::optional<int> phase;          // from 1
  bool half = false, quarter = false;
  bool with_identity = false;  // in the answer as JSON
  std::string crop;    // "I0:I1,J0:J1,K0:K1"
  std::string write;   // a volume file
  std::string report;  // an HTML file
};

struct GrowArguments {
  std::string case_source;
  std::string seed;  // "X,Y,Z", mm, LPS
  std::string hu;    // "A,B"; empty: proposed
  std::string box;   // "X0,X1,Y0,Y1,Z0,Z1", mm, LPS; empty: the scan
  std::optional<double> open_mm;
  std::string name;
  std::string write;
};

struct StructureImportArguments {
  std::string case_source;
  std::string file;
  std::vector<std::string> choices;  // CODE=OPTION
  std::optional<double> threshold;   // of a fractional one
  std::string write;                 // a label map; empty: none
};

struct StructureExportArguments {
  std::string case_source;
  std::string structures;            // a segmentation; empty: the case's own
  std::vector<std::string> names;    // empty: all
  std::vector<std::string> choices;  // CODE=OPTION
  std::string write;                 // a label map or a surface
  std::string dicom;                 // or a folder
  bool source_uids = false;          // which refers to the CT of the case instead of holding one
  std::optional<double> threshold;   // of a fractional segmentation
};

int growCommand(const GrowArguments& arguments, bool json, const Progress&);
int compareCommand(const std::string& a, const std::string& b, bool json, const Progress&);
int importStructuresCommand(const StructureImportArguments& arguments, bool json, const Progress&);
int exportStructuresCommand(const StructureExportArguments& arguments, bool json, const Progress&);
int phantomCommand(const std::string& name, const std::string& out, bool json, const Progress&);
int importCommand(const ImportArguments& arguments, bool json, const Progress&);
// `policy`: what the workstation locks is not changed by an argument, nor by an exercise.
int runCommand(const RunArguments& arguments, const Policy& policy, bool json, const Progress&);
int pinCommand(bool json, const Progress&);
int exportExerciseCommand(const std::string& exercise, const std::string& case_source,
                          const std::string& out, bool json, const Progress&);
// Where the window keeps its cases: `given`, or where that is empty the workstation's folder, else
// the user's own data. Errors: NO_STORAGE, and why the workstation's settings cannot be read.
Result<std::filesystem::path> storageOf(const std::string& given, const Policy& policy);
int importExerciseCommand(const std::string& folder, const std::string& storage,
                          const Policy& policy, bool json, const Progress&);
// `open`: each is read, and compared with what was saved.
int listStorageCommand(const std::string& storage, bool open, const Policy& policy, bool json,
                       const Progress&);
struct CommissionArguments {
  std::string out, storage;
  double seconds = 5.0, patience_s = 15.0;
  bool say_progress = false;
  bool arms_alone = false;  // which this program asks of itself
};
int commissionCommand(const CommissionArguments& arguments, const Policy& policy, bool json,
                      const Progress&);
int shareStorageCommand(const std::string& folder, bool json);
int replayCommand(const std::string& file, const std::string& case_source,
                  const std::string& labels, bool json, const Progress&);
// A row for each file as soon as it is read. 1 where one cannot be replayed.
int recordingsCommand(const std::vector<std::string>& files, bool json, const Progress&);
int explainCommand(const std::string& exercise, const Policy& policy, bool json, const Progress&);
// `measure ...` is a program of its own, which this one becomes; `words` are argv from "measure"
// on. Returns where it is not installed, and says so.
int startMeasurements(char** words, bool json);
int tradesCommand(const std::string& out, bool json, const Progress&);

}  // namespace trephine
