#include "session/case.h"

#include <filesystem>
#include <new>
#include <utility>

#include "base/memory.h"
#include "imaging/importer.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

constexpr double kReadShare = 0.9;  // of the work of opening; the rest is finding landmarks

// The best series of a DICOM folder.
Result<Case> importBest(const std::string& source, const Progress& progress) {
  Result<CtFolder> folder = CtFolder::scan(source, progress);
  if (!folder) return folder.error();
  const std::optional<std::string> series = folder->bestSeries();
  if (!series) {
    if (folder->report().error) return *folder->report().error;
    return Error{"ALL_REFUSED", "No series in the folder can be used", source,
                 "The import report says why for each"};
  }
  Result<Volume> volume = folder->read(*series, {}, progress);
  if (!volume) return volume.error();
  const std::optional<Provenance>& provenance = folder->report().provenance;
  Case read = caseOf(std::make_shared<const Volume>(*std::move(volume)),
                     provenance ? provenance->volume_sha256 : "");
  read.provenance = provenance;
  return read;
}

Result<Case> read(const std::string& source, const Progress& progress) {
  const std::optional<std::string> phantom = phantomNamed(source);
  std::error_code ec;
  if (!phantom && (!isVolumeFile(source) || std::filesystem::is_directory(source, ec))) {
    return importBest(source, progress);
  }
  if (phantom) {
    Result<Phantom> made = makePhantomWithLabels(*phantom, progress);
    if (!made) return made.error();
    Case built_in = caseOf(std::make_shared<const Volume>(std::move(made->volume)));
    built_in.built_in = true;
    built_in.labels_built_in = made->labels.has_value();
    if (made->labels) built_in.labels = std::make_shared<const LabelMap>(*std::move(made->labels));
    return built_in;
  }
  Result<Volume> volume = readVolume(source, progress);
  if (!volume) return volume.error();
  return caseOf(std::make_shared<const Volume>(*std::move(volume)));
}

}  // namespace

Case caseOf(std::shared_ptr<const Volume> volume, std::string sha256) {
  Case of;
  of.sha256 = sha256.empty() ? volumeSha256(*volume) : std::move(sha256);
  of.volume = std::move(volume);
  return of;
}

Result<Case> readCase(const std::string& source, const Progress& progress) {
  if (source.empty()) {
    return Error{"NO_CASE", "The scene names no case and none was given", "--case",
                 "Give a folder of CT, or phantom:cranium or phantom:abdomen"};
  }
  try {
    return read(source, progress);
  } catch (const std::bad_alloc&) {
    return outOfMemory("for the case", "the case");
  }
}

Result<Case> withLabels(Case of, const std::string& file) {
  of.labels.reset();
  of.labels_built_in = false;
  if (file.empty()) return of;
  try {
    const Result<LabelMap> map = readLabelMap(file);
    if (!map) return map.error();
    Result<LabelMap> fitted = fitTo(*map, of.volume->geometry);
    if (!fitted) return fitted.error();
    of.labels = std::make_shared<const LabelMap>(*std::move(fitted));
  } catch (const std::bad_alloc&) {
    return outOfMemory("for the label map", file);
  }
  return of;
}

Result<Case> placedIn(const Scene& scene, Case of, const Progress& progress) {
  progress.at(0.0, "Finding landmarks");
  of.landmarks.clear();
  of.misfit.reset();
  if (!scene.labels_file.empty() && (!of.labels || of.labels_built_in)) {
    Result<Case> labelled = withLabels(of, scene.labels_file);
    if (!labelled) {
      of.misfit = labelled.error();
      return of;
    }
    of = *std::move(labelled);
  }
  auto placed = placeLandmarks(scene, *of.volume, of.labels.get(), progress);
  if (placed) {
    of.landmarks = *std::move(placed);
  } else if (placed.error().code == "CANCELLED") {
    return placed.error();
  } else {
    of.misfit = placed.error();
  }
  return of;
}

Result<Case> openCase(const Scene& scene, const Progress& progress) {
  Result<Case> read = readCase(scene.case_source, Progress(progress, 0.0, kReadShare));
  if (!read) return read;
  return placedIn(scene, *std::move(read), Progress(progress, kReadShare, 1.0));
}

}  // namespace trephine
