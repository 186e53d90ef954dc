#include "case/case.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <utility>
#include <vector>

#include "base/codes.h"
#include "base/memory.h"
#include "base/tr.h"
#include "case/codes.h"
#include "imaging/codes.h"
#include "imaging/importer.h"
#include "imaging/report/answers.h"
#include "volume/codes.h"
#include "volume/phantom_file.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

// The best series of a DICOM folder.
Result<Case> importBest(const std::string& source, const Answers& answers,
                        const Progress& progress) {
  Result<CtFolder> folder = CtFolder::scan(source, progress);
  if (!folder) return folder.error();
  if (Status fit = folder->checkAnswers(answers); !fit) return fit.error();
  const std::optional<std::string> series = folder->bestSeries(answers);
  if (!series) {
    if (folder->report().error) return *folder->report().error;
    return Error{code::kAllRefused, tr("No series in the folder can be used"), source,
                 tr("The import report says why for each")};
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
    }
    return built_in;
  }
  Result<Volume> volume = readVolume(source, progress, answerTo(answers, code::kFormsDiffer));
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

const char* exerciseAnatomy(BodyRegion region) {
  return region == BodyRegion::head ? "cranium" : region == BodyRegion::abdomen ? "abdomen" : "";
}

Result<Case> readCase(const std::string& source, const Progress& progress, const Answers& answers) {
  if (source.empty()) {
    return Error{code::kNoCase, tr("The scene names no case and none was given"), "--case",
                 tr("Give a folder of CT, or phantom:cranium or phantom:abdomen")};
  }
  try {
    Result<Case> of = read(source, answers, Progress(progress, 0.0, 0.9));
    if (of) of->source = source;
    if (of) of->anatomy = anatomyOf(*of->volume, Progress(progress, 0.9, 1.0));
    return of;
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the case"), tr("the case"));
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
    return Error{code::kCannotWrite, tr("This is of the case that is read, and would be lost"),
                 target.string(), tr("Choose another name or place")};
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
  of.structures_built_in = false;
  of.structure_cards.clear();
  of.structure_warnings.clear();
  return of;
}

}  // namespace trephine
