#include "imaging/steps/volume_steps.h"

#include <algorithm>

#include "imaging/common/text.h"
#include "imaging/series/series_geometry.h"
#include "imaging/steps/coarse_grid.h"
#include "imaging/steps/couch.h"
#include "imaging/steps/face.h"
#include "volume/reduce.h"

namespace trephine {

namespace {

// Consent is asked only where there is something to consent to.
bool stepCouch(const CoarseGrid& grid, const Answers& answers, SeriesReport& series,
               Volume& volume) {
  const CouchFinding couch = findCouch(grid);
  if (!couch.found) return false;
  const std::string answer =
      ask({"COUCH",
           "A patient couch or head holder is in the scan. Take it out?",
           {"keep", "remove"},
           {"Leave the scan as it is", "Set couch and holder to air; the patient is not touched"}},
          answers, series.choices);
  const std::string text = "The scan shows a couch or holder, " + fixedText(couch.width_mm, 0) +
                           " mm wide and " + fixedText(couch.length_mm, 0) + " mm long";
  if (answer != "remove") {
    series.findings.push_back(
        {"COUCH", "notice", text, {}, "It was left in; tools can touch and cut it like tissue"});
    return false;
  }
  const std::uint64_t voxels = removeCouch(volume, couch);
  series.findings.push_back(
      {"COUCH",
       "repair",
       text,
       {},
       "It was taken out as was agreed: " + std::to_string(voxels) + " voxels became air"});
  return true;
}

bool stepFace(const CoarseGrid& grid, const Answers& answers, SeriesReport& series,
              Volume& volume) {
  const FaceFinding face = findFace(grid, series.body_part);
  if (!face.found) return false;
  const std::string answer =
      ask({"FACE",
           "The patient's face can be reconstructed from this scan. Cut it away?",
           {"keep", "deface"},
           {"Keep it; the case must then stay on this computer",
            "Cut the face away below the brow, bone included; vault, brain and ears stay"}},
          answers, series.choices);
  const std::string text = "The patient's face can be reconstructed from this scan";
  if (answer != "deface") {
    series.findings.push_back(
        {"FACE",
         "notice",
         text,
         {},
         "It was kept: the case must stay on this computer until the face is cut away"});
    return false;
  }
  const std::uint64_t voxels = deface(volume, face);
  series.findings.push_back(
      {"FACE",
       "repair",
       text,
       {},
       "The face was cut away as was agreed: " + std::to_string(voxels) + " voxels became air"});
  return true;
}

}  // namespace

Status takeVolumeSteps(const ImportRequest& request, const Progress& progress, SeriesReport& series,
                       Volume& volume, std::optional<MeasuredLoss>& loss) {
  const auto cancelled = [&] { return Error{"CANCELLED", "The import was cancelled", "", ""}; };
  progress.at(0.9, "Looking for couch and face");
  CoarseGrid grid = coarseGrid(volume);
  bool changed = stepCouch(grid, request.answers, series, volume);
  if (progress.cancelled()) return cancelled();
  if (changed) grid = coarseGrid(volume);
  changed |= stepFace(grid, request.answers, series, volume);
  if (progress.cancelled()) return cancelled();

  if (request.crop) {
    Result<Volume> part = crop(std::move(volume), *request.crop);
    if (!part) return part.error();
    volume = *std::move(part);
    changed = true;
  }
  if (request.reduction != 1) {
    progress.at(0.93, "Reducing the resolution");
    Result<Volume> small = reduced(volume, request.reduction);
    if (!small) return small.error();
    const ReductionLoss measured = reductionLoss(volume, *small, request.reduction);
    loss = MeasuredLoss{measured.rms_hu, measured.p99_hu, measured.bone_volume_change_percent};
    series.findings.push_back({"REDUCED",
                               "repair",
                               "The resolution was reduced to " +
                                   std::string(request.reduction == 2 ? "a half" : "a quarter") +
                                   " along each axis",
                               {},
                               "Against the full resolution HU differ by " +
                                   fixedText(loss->rms_hu, 1) + " (rms), 99 % of them by at most " +
                                   fixedText(loss->p99_hu, 0) + "; the volume of bone changed by " +
                                   fixedText(loss->bone_volume_change_percent, 1) + " %"});
    volume = *std::move(small);
    changed = true;
  }
  if (progress.cancelled()) return cancelled();
  if (changed || !series.hu_min) {
    const auto [low, high] = std::ranges::minmax(volume.hu);
    series.hu_min = low;
    series.hu_max = high;
  }
  return {};
}

}  // namespace trephine
