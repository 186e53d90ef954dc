// An exercise becomes a folder.
#include <algorithm>
#include <set>

#include "base/codes.h"
#include "base/file.h"
#include "base/tr.h"
#include "case/case.h"
#include "exchange/exercise_folder.h"
#include "exchange/exercise_parts.h"
#include "exchange/named_files.h"
#include "exercise/exercise.h"
#include "session/operator_script.h"
#include "volume/phantom.h"
#include "volume/segmentation.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr double kCaseShare = 0.8;  // of the work

// Of a folder of the library, else what was given.
struct CaseFiles {
  std::string volume, structures;
};
CaseFiles caseFiles(const std::string& source) {
  std::error_code ec;
  const fs::path folder = source;
  if (!fs::is_regular_file(folder / "case.json", ec)) return {source, {}};
  const fs::path structures = folder / "structures.seg.nrrd";
  return {(folder / "volume.mha").string(),
          fs::is_regular_file(structures, ec) ? structures.string() : std::string()};
}

class Exporter {
 public:
  Exporter(const fs::path& exercise_file, const Exercise& exercise, PartFolder& to)
      : from_(exercise_file.parent_path()), exercise_(exercise), to_(to) {}

  Status copyCase(Json& json, Exercise exercise, const std::string& case_source,
                  const NameHider& hide, const Progress& progress) {
    const CaseFiles given = caseFiles(case_source);
    if (!given.volume.empty() && given.volume != exercise.case_source) {
      // What the exercise says of its own case does not hold of another (onCase).
      const bool had_elsewhere = exercise.tissues_elsewhere.has_value();
      exercise = onCase(std::move(exercise), given.volume);
      if (exercise.labels_file.empty()) json.erase("labels");
      if (!exercise.outline) json.erase("outline");
      if (had_elsewhere && !exercise.tissues_elsewhere) json["tissues"] = toJson(exercise.tissues);
    }
    const std::string labels = given.structures.empty() ? exercise.labels_file : given.structures;
    json.erase("labels");
    if (exercise.case_source.empty()) return {};
    const auto phantom = phantomNamed(exercise.case_source);
    const bool built_in = phantom.has_value();
    if (built_in) {
      if (const auto there = phantomGeometry(*phantom); !there) return there.error();
    }
    json["case"] = exercise.case_source;
    if (built_in && labels.empty()) return {};
    Result<Case> of = readCase(exercise.case_source, Progress(progress, 0.0, 0.6));
    if (of && !labels.empty()) of = withLabels(*of, labels, Progress(progress, 0.6, 0.7), hide);
    if (!of) return of.error();
    if (!built_in) {
      json["case"] = "case/volume.mha";
      const auto write = [&](const fs::path& file) {
        return writeVolume(slabsOf(*of->volume), file, Progress(progress, 0.7, 0.9));
      };
      if (Status written = to_.write("case/volume.mha", write); !written) return written;
    }
    if (labels.empty()) return {};
    json["labels"] = "case/structures.seg.nrrd";
    return to_.write("case/structures.seg.nrrd", [&](const fs::path& file) {
      return writeSegmentation(*of->structures, file, false, Progress(progress, 0.9, 1.0));
    });
  }

  Status copyNamed(NamedFile kind, const std::string& id, Json& name) {
    const fs::path file = (from_ / name.get<std::string>()).lexically_normal();
    switch (kind) {
      case NamedFile::caseVolume:
      case NamedFile::labels:
        return {};  // written already
      case NamedFile::tissues:
        return copyJson(file, "tissues.json", name, [this](Json& tissues, const fs::path& folder) {
          Json* elsewhere = elsewhereOf(tissues);
          if (!elsewhere) return Status();
          const fs::path other = (folder / elsewhere->get<std::string>()).lexically_normal();
          // It holds everywhere: what it names itself is never looked at.
          return copyJson(other, "tissues-elsewhere.json", *elsewhere,
                          [](Json& set, const fs::path&) {
                            set.erase("elsewhere");
                            return Status();
                          });
        });
      case NamedFile::tool: {
        const std::string as = own("tools/", id, ".json");
        return copyJson(file, as, name, [&](Json& tool, const fs::path& folder) {
          Json* mesh = meshOf(tool);
          if (!mesh) return Status();
          const fs::path of = folder / mesh->get<std::string>();
          const std::string mesh_as = fs::path(as).replace_extension(".stl").string();
          *mesh = fs::path(mesh_as).filename().string();  // beside the tool
          return to_.copyMesh(of, mesh_as);
        });
      }
      case NamedFile::mesh:
        name = own("tools/", id, ".stl");
        return to_.copyMesh(file, name.get<std::string>());
      case NamedFile::operatorScript: {
        const Result<OperatorScript> script = readOperatorScript(file, exercise_);
        if (!script) return script.error();
        name = "operator.json";
        return to_.copy(file, "operator.json");
      }
    }
    return {};
  }

 private:
  using Mend = std::function<Status(Json&, const fs::path& folder)>;

  // `name` becomes `as`, a path from the folder of what names it.
  Status copyJson(const fs::path& file, const std::string& as, Json& name, const Mend& mend) {
    Result<Json> json = readJsonFile(file);
    if (!json) return json.error();
    if (Status mended = mend(*json, file.parent_path()); !mended) return mended;
    name = as;
    return to_.writeText(as, json->dump(1) + '\n');
  }

  // A name of its own: what a person called a tool, as far as it is letters and digits.
  std::string own(const std::string& folder, const std::string& id, const std::string& extension) {
    std::string stem = plainName(id, "part");
    for (int n = 2; !taken_.insert(folder + stem).second; ++n) {
      stem = plainName(id, "part") + "-" + std::to_string(n);
    }
    return folder + stem + extension;
  }

  fs::path from_;
  const Exercise& exercise_;
  PartFolder& to_;
  std::set<std::string> taken_;
};

// From a folder to a file: within one storage folder it stays true when that is moved.
std::string pathFrom(const fs::path& folder, const fs::path& file, const fs::path& storage) {
  std::error_code ec;
  const fs::path of = fs::absolute(file, ec).lexically_normal();
  const fs::path root = fs::absolute(storage, ec).lexically_normal();
  const auto parts = std::mismatch(root.begin(), root.end(), of.begin(), of.end());
  if (parts.first != root.end()) return of.string();
  return of.lexically_relative(fs::absolute(folder, ec).lexically_normal()).string();
}

// The files that saving makes anew, of the exercise that lies there: paths in the folder. Its case
// and the structures of that are not among them.
std::set<fs::path> filesOf(const fs::path& folder) {
  std::set<fs::path> files{kSceneFile, kListFile};
  const auto add = [&](const fs::path& by, const std::string& name) {
    files.insert((by.parent_path() / name).lexically_normal());
  };
  Result<Json> exercise = readJsonFile(folder / kSceneFile);
  if (!exercise) return files;
  (void)eachNamedFile(*exercise, [&](NamedFile kind, const std::string&, Json& name) {
    const std::string file = name.get<std::string>();
    if (kind == NamedFile::caseVolume || kind == NamedFile::labels) return Status();
    add(kSceneFile, file);
    if (kind != NamedFile::tissues && kind != NamedFile::tool) return Status();
    Result<Json> json = readJsonFile(folder / file);
    const Json* inner = !json                     ? nullptr
                        : kind == NamedFile::tool ? meshOf(*json)
                                                  : elsewhereOf(*json);
    if (inner) add(file, inner->get<std::string>());
    return Status();
  });
  return files;
}

}  // namespace

Result<fs::path> saveExercise(const Exercise& exercise, const fs::path& folder,
                              const fs::path& storage, const Progress& progress) {
  Json json = exerciseFile(exercise);
  if (Result<Exercise> valid = parseExercise(json, folder / kSceneFile); !valid)
    return valid.error();
  std::error_code ec;
  const bool fresh = fs::symlink_status(folder, ec).type() == fs::file_type::not_found;
  Result<PartFolder> part = PartFolder::make(folder);
  if (!part) return part.error();
  Exporter exporter(folder / kSceneFile, exercise, *part);
  const Status named = eachNamedFile(json, [&](NamedFile kind, const std::string& id, Json& name) {
    if (kind != NamedFile::caseVolume && kind != NamedFile::labels) {
      return exporter.copyNamed(kind, id, name);
    }
    name = pathFrom(folder, name.get<std::string>(), storage);
    return Status();
  });
  if (!named) return named.error();
  if (Status written = part->writeText(kSceneFile, json.dump(1) + '\n'); !written) {
    return written.error();
  }
  if (progress.cancelled()) return Error{code::kCancelled, tr("It was cancelled"), "", ""};
  // Where there was nothing, what another program has put there meanwhile is not replaced.
  const Status done = fresh ? part->become() : part->becomeInstead(filesOf(folder));
  if (!done) return done.error();
  return folder / kSceneFile;
}

Result<ExportedExercise> exportExercise(const fs::path& exercise_file,
                                        const std::string& case_source, const fs::path& folder,
                                        const Progress& progress, const NameHider& hide) {
  Result<Json> json = readJsonFile(exercise_file);
  if (!json) return json.error();
  const Result<Exercise> exercise = parseExercise(*json, exercise_file);
  if (!exercise) return exercise.error();
  if (Status free = checkFreeFolder(folder); !free) return free.error();
  Result<PartFolder> part = PartFolder::make(folder);
  if (!part) return part.error();
  Exporter exporter(exercise_file, *exercise, *part);
  progress.at(0.0, tr("Reading the case"));
  if (Status copied = exporter.copyCase(*json, *exercise, case_source, hide,
                                        Progress(progress, 0.0, kCaseShare));
      !copied) {
    return copied.error();
  }
  const Status named = eachNamedFile(*json, [&](NamedFile kind, const std::string& id, Json& name) {
    return exporter.copyNamed(kind, id, name);
  });
  if (!named) return named.error();
  if (Status written = part->writeText(kSceneFile, json->dump(1) + '\n'); !written) {
    return written.error();
  }
  Result<std::vector<ExercisePart>> parts =
      part->writeList(kSceneFile, Progress(progress, kCaseShare, 1.0));
  if (!parts) return parts.error();
  // What came out can be read as it went in.
  if (Result<Exercise> again = readExercise(part->path() / kSceneFile); !again)
    return again.error();
  if (Status done = part->become(); !done) return done.error();
  return ExportedExercise{folder, *std::move(parts)};
}

}  // namespace trephine
