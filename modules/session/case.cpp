#include "session/case.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "imaging/importer.h"
#include "imaging/report/answers.h"
#include "scene/scene_structures.h"
#include "volume/phantom_file.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

constexpr double kReadShare = 0.9;  // of the work of opening; the rest is finding landmarks

// The best series of a DICOM folder.
Result<Case> importBest(const std::string& source, const Answers& answers,
                        const Progress& progress) {
  Result<CtFolder> folder = CtFolder::scan(source, progress);
  if (!folder) return folder.error();
  if (Status fit = folder->checkAnswers(answers); !fit) return fit.error();
  const std::optional<std::string> series = folder->bestSeries(answers);
  if (!series) {
    if (folder->report().error) return *folder->report().error;
    return Error{"ALL_REFUSED", "No series in the folder can be used", source,
                 "The import report says why for each"};
  }
  ImportRequest request;
  request.answers = answers;
  Result<Volume> volume = folder->read(*series, request, progress);
  if (!volume) return volume.error();
  const std::optional<Provenance>& provenance = folder->report().provenance;
  Case read = caseOf(std::make_shared<const Volume>(*std::move(volume)),
                     provenance ? provenance->volume_sha256 : "");
  read.provenance = provenance;
  read.identity = std::make_shared<const SourceIdentity>(folder->sourceIdentity(*series));
  return read;
}

Result<Case> read(const std::string& source, const Answers& answers, const Progress& progress) {
  const std::optional<std::string> phantom = phantomNamed(source);
  std::error_code ec;
  if (!phantom && (!isVolumeFile(source) || std::filesystem::is_directory(source, ec))) {
    return importBest(source, answers, progress);
  }
  if (phantom) {
    Result<Phantom> made = openPhantom(*phantom, progress);
    if (!made) return made.error();
    Case built_in = caseOf(std::make_shared<const Volume>(std::move(made->volume)));
    built_in.built_in = true;
    built_in.structures_built_in = made->labels.has_value();
    if (made->labels) {
      built_in.structures = std::make_shared<const LabelMap>(*std::move(made->labels));
      built_in.labels = built_in.structures;
    }
    return built_in;
  }
  Result<Volume> volume = readVolume(source, progress, answerTo(answers, "FORMS_DIFFER"));
  if (!volume) return volume.error();
  return caseOf(std::make_shared<const Volume>(*std::move(volume)));
}

// Where the case shows something else than the exercise is for.
std::optional<Warning> anatomyWarning(const Scene& scene, const std::optional<Anatomy>& anatomy) {
  if (!anatomy || anatomy->region == BodyRegion::not_sure) return {};
  const std::string shown = bodyRegionName(anatomy->region);
  if (scene.anatomy != exerciseAnatomy(anatomy->region)) {
    const bool known = scene.anatomy == "cranium" || scene.anatomy == "abdomen";
    if (!known) return {};
    return Warning{"OTHER_ANATOMY", "The case shows " +
                                        std::string(shown == "head" ? "a " : "an ") + shown +
                                        ", and the exercise is for the " + scene.anatomy};
  }
  if (anatomy->region == BodyRegion::head && !anatomy->vault) {
    return Warning{"NO_VAULT",
                   "The case shows a head whose vault is not whole in the scan: the exercise may "
                   "begin in another bone"};
  }
  return {};
}

// Where the rays of a scene's landmarks meet the body, whatever it is of.
Result<std::vector<PlacedLandmark>> onBody(const Scene& scene, const Volume& volume,
                                           const Progress& progress) {
  Scene on_body = scene;
  for (Landmark& landmark : on_body.landmarks) landmark.tissue.clear();
  auto placed = placeLandmarks(on_body, volume, nullptr, progress);
  if (placed || placed.error().code == "CANCELLED") return placed;
  // A scan may be too thin for the ball that a landmark looks for, or be of an empty shell: towards
  // its middle, then, up to the first wall.
  constexpr double kWall_mm = 2.0;
  for (Landmark& landmark : on_body.landmarks) {
    if (landmark.bulk_radius_mm == 0.0) continue;
    landmark.bulk_radius_mm = 0.0;
    landmark.run_mm = std::min(landmark.run_mm, kWall_mm);
    landmark.towards = Vec3(0.5);
    landmark.from = landmark.towards + landmark.outward;
  }
  return placeLandmarks(on_body, volume, nullptr, progress);
}

// The scene's landmarks. Where one has no place in the case: where their rays meet the body, and a
// warning says so, for an exercise is no dead end.
Result<std::vector<PlacedLandmark>> landmarksIn(const Scene& scene, Case& of,
                                                const Progress& progress) {
  auto placed = placeLandmarks(scene, *of.volume, of.labels.get(), progress);
  if (placed) return placed;
  const std::string& code = placed.error().code;
  if (code != "NO_SURFACE" && code != "TISSUE_NOT_FOUND") return placed;
  if (std::ranges::min(of.volume->geometry.size) < 2) return placed;  // one slice is no body
  auto surface = onBody(scene, *of.volume, progress);
  if (!surface) return surface.error().code == "CANCELLED" ? surface : placed;
  of.warnings.push_back({"NO_LANDMARK", "The place where the exercise begins is not in the case (" +
                                            placed.error().what +
                                            "): it begins at the body's surface"});
  return surface;
}

}  // namespace

Case caseOf(std::shared_ptr<const Volume> volume, std::string sha256) {
  Case of;
  of.sha256 = sha256.empty() ? volumeSha256(*volume) : std::move(sha256);
  of.volume = std::move(volume);
  return of;
}

const char* exerciseAnatomy(BodyRegion region) {
  return region == BodyRegion::head ? "cranium" : region == BodyRegion::abdomen ? "abdomen" : "";
}

Result<Case> readCase(const std::string& source, const Progress& progress,
                      const Answers& answers) {
  if (source.empty()) {
    return Error{"NO_CASE", "The scene names no case and none was given", "--case",
                 "Give a folder of CT, or phantom:cranium or phantom:abdomen"};
  }
  try {
    Result<Case> of = read(source, answers, Progress(progress, 0.0, 0.9));
    if (of) of->anatomy = anatomyOf(*of->volume, Progress(progress, 0.9, 1.0));
    return of;
  } catch (const std::bad_alloc&) {
    return outOfMemory("for the case", "the case");
  }
}

Status keepsCase(const std::filesystem::path& target, const std::string& source) {
  namespace fs = std::filesystem;
  std::error_code ec;
  if (source.empty() || !fs::exists(target, ec) || !fs::exists(source, ec)) return {};
  std::vector<fs::path> own{source};
  if (isVolumeFile(source) && !fs::is_directory(source, ec)) {
    if (const auto header = readVolumeFileHeader(source)) own.push_back(header->data.file);
    own.push_back(fs::path(source).replace_extension(".json"));  // of raw voxels
  }
  const fs::path to = fs::canonical(target, ec);
  for (const fs::path& file : own) {
    if (!fs::exists(file, ec)) continue;
    const fs::path from = fs::canonical(file, ec);
    if (std::mismatch(from.begin(), from.end(), to.begin(), to.end()).first != from.end()) continue;
    return Error{"CANNOT_WRITE", "This is of the case that is read, and would be lost",
                 target.string(), "Choose another name or place"};
  }
  return {};
}

Result<Case> withLabels(Case of, const std::string& file, const Progress& progress,
                        const NameHider& hide) {
  of = withStructures(std::move(of), nullptr);
  if (file.empty()) return of;
  StructureRequest request = requestOf(of, hide);
  request.ask_all = false;
  Result<StructureFit> fit = importStructures(file, *of.volume, request, progress);
  if (!fit) return fit.error();
  return withFit(std::move(of), *std::move(fit));
}

StructureRequest requestOf(const Case& of, const NameHider& hide) {
  StructureRequest request;
  if (of.provenance) request.ct = of.provenance->source_ids;
  if (hide && of.identity) {
    request.hide_names = [hide, identity = of.identity](Segmentation& segmentation) {
      return hide(segmentation, *identity);
    };
  }
  return request;
}

Case withFit(Case of, StructureFit fit) {
  of = withStructures(std::move(of), std::make_shared<const LabelMap>(std::move(fit.map)));
  of.structure_cards = std::move(fit.structures);
  for (const Finding& finding : fit.findings) {
    of.structure_warnings.push_back({finding.code, sentencesOf(finding)});
  }
  return of;
}

Case withStructures(Case of, std::shared_ptr<const LabelMap> structures) {
  of.structures = std::move(structures);
  of.labels = of.structures;
  of.structures_built_in = false;
  of.structure_cards.clear();
  of.structure_warnings.clear();
  return of;
}

Result<Case> placedIn(Scene& scene, Case of, const Progress& progress, const NameHider& hide) {
  progress.at(0.0, "Finding landmarks");
  of.landmarks.clear();
  of.misfit.reset();
  of.warnings.clear();
  if (!scene.labels_file.empty() && (!of.structures || of.structures_built_in)) {
    Result<Case> labelled = withLabels(of, scene.labels_file, Progress(), hide);
    if (!labelled) {
      of.misfit = labelled.error();
      return of;
    }
    of = *std::move(labelled);
  }
  of.labels = of.structures;
  auto structures = placeStructures(scene, of.structures);
  if (!structures) {
    of.misfit = structures.error();
    return of;
  }
  of.labels = std::move(structures->labels);
  of.warnings = of.structure_warnings;
  if (auto other = anatomyWarning(scene, of.anatomy)) of.warnings.push_back(*std::move(other));
  of.warnings.insert(of.warnings.end(), structures->warnings.begin(), structures->warnings.end());
  auto placed = landmarksIn(scene, of, progress);
  if (placed) {
    of.landmarks = *std::move(placed);
  } else if (placed.error().code == "CANCELLED") {
    return placed.error();
  } else {
    of.misfit = placed.error();
  }
  return of;
}

Result<Case> openCase(Scene& scene, const Progress& progress, const NameHider& hide) {
  Result<Case> read = readCase(scene.case_source, Progress(progress, 0.0, kReadShare));
  if (!read) return read;
  return placedIn(scene, *std::move(read), Progress(progress, kReadShare, 1.0), hide);
}

}  // namespace trephine
