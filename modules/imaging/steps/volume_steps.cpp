#include "imaging/steps/detail/volume_steps.h"

#include <algorithm>

#include "imaging/common/detail/text.h"
#include "imaging/series/detail/series_geometry.h"
#include "base/codes.h"
#include "imaging/codes.h"
#include "imaging/steps/coarse_grid.h"
#include "imaging/steps/couch.h"
#include "imaging/steps/face.h"
#include "imaging/steps/face_check.h"
#include "volume/reduce.h"

namespace trephine {

namespace {

// Consent is asked only where there is something to consent to.
bool stepCouch(const CoarseGrid& grid, const Answers& answers, SeriesReport& series,
               Volume& volume) {
  const CouchFinding couch = findCouch(grid);
  if (!couch.found) return false;
  const std::string answer =
      ask({code::kCouch,
           "A patient couch or head holder is in the scan. Take it out?",
           {"keep", "remove"},
           {"Leave the scan as it is", "Set couch and holder to air; the patient is not touched"}},
          answers, series.choices);
  const std::string text = "The scan shows a couch or holder, " + fixedText(couch.width_mm, 0) +
                           " mm wide and " + fixedText(couch.length_mm, 0) + " mm long";
  if (answer != "remove") {
    series.findings.push_back({code::kCouch,
                               Severity::notice,
                               text,
                               {},
                               "It was left in; tools can touch and cut it like tissue"});
    return false;
  }
  const std::uint64_t voxels = removeCouch(volume, couch);
  series.findings.push_back(
      {code::kCouch,
       Severity::repair,
       text,
       {},
       "It was taken out as was agreed: " + std::to_string(voxels) + " voxels became air"});
  return true;
}

// Of a mark's surroundings as they were: from this share on it is still there.
constexpr double kStillThere = 0.25;
// Flesh and bone beyond the face that go without a question.
constexpr double kLittle_mL = 20.0;

const char* const kFaceText = "The patient's face can be reconstructed from this scan";

// Whether the crop keeps some of what the cut would take, or an eye, nose or mouth elsewhere. A
// face that it leaves out needs no cut.
bool keepsFace(const VoxelBox& kept, const CoarseGrid& grid, const FaceFinding& face,
               const Volume& volume) {
  for (int s = 0; s < grid.size[2]; ++s) {
    for (int b = 0; b < grid.size[1]; ++b) {
      for (int a = 0; a < grid.size[0]; ++a) {
        const bool matter = grid.mean[grid.indexOf(a, b, s)] > -500;
        if (matter && grid.isIn(kept, a, b, s) && face.clears(grid.place_mm(a, b, s))) return true;
      }
    }
  }
  const FaceMarks marks = findFaceMarks(faceGrid(volume));
  std::vector<Vec3> places = marks.eyes;
  if (marks.nose) places.push_back(*marks.nose);
  if (marks.mouth) places.push_back(*marks.mouth);
  return std::ranges::any_of(places, [&](const Vec3& place) {
    const Index3 cell = grid.cellAt(place);
    return grid.isIn(kept, cell[0], cell[1], cell[2]);
  });
}

// What is wrong after the cut, in words; empty where the face is gone for sure.
std::string faceDoubt(const FaceMarks& marks, const CoarseGrid& before, const CoarseGrid& after) {
  if (marks.eyes.empty() && !marks.nose) {
    return "neither eyes nor nose can be recognised in this scan, so that nothing tells whether "
           "the "
           "cut took them";
  }
  const FaceLeft left = faceLeft(marks, before, after);
  std::vector<std::string> there;
  if (left.eyes >= kStillThere) there.emplace_back("eyes");
  if (left.nose >= kStillThere) there.emplace_back("nose");
  if (left.mouth >= kStillThere) there.emplace_back("mouth");
  if (there.empty()) return "";
  return listed(there) + " can still be seen after the cut";
}

std::string beyondText(const BeyondFace& beyond) {
  std::string text;
  if (beyond.throat_mL >= 1.0) text += fixedText(beyond.throat_mL, 0) + " mL of the throat";
  if (beyond.beside_mL >= 1.0) {
    text += (text.empty() ? "" : " and ") + fixedText(beyond.beside_mL, 0) +
            " mL beside and above the face, such as arms or hands";
  }
  if (beyond.bone_mL >= 1.0) text += ", bone included";
  return text;
}

Error refuse(Code code, const std::string& text, const std::string& action, SeriesReport& series) {
  series.findings.push_back({code, Severity::refusal, text, {}, action});
  series.verdict = Verdict::refused;
  return Error{code, text, "", action};
}

// Whether voxels changed. Errors: FACE_TAKES_MORE, FACE_REMAINS; the voxels are of no use then.
Result<bool> stepFace(const CoarseGrid& grid, const ImportRequest& request, SeriesReport& series,
                      Volume& volume) {
  const FaceFinding face = findFace(grid, series.body_part);
  if (!face.found) return false;
  const VoxelBox kept_box = request.crop.value_or(VoxelBox{{0, 0, 0}, volume.geometry.size});
  if (request.crop && !keepsFace(kept_box, grid, face, volume)) return false;
  const auto kept = [&](const std::string& why) {
    series.findings.push_back(
        {code::kFace,
         Severity::notice,
         kFaceText,
         {},
         why + "It was kept: the case must stay on this computer until the face is cut away"});
    return false;
  };
  const std::string answer =
      ask({code::kFace,
           "The patient's face can be reconstructed from this scan. Cut it away?",
           {"keep", "deface"},
           {"Keep it; the case must then stay on this computer",
            "Cut the face away below the brow, bone included; vault, brain and ears stay"}},
          request.answers, series.choices);
  if (answer != "deface") return kept("");

  const BeyondFace beyond = beyondFace(grid, face, kept_box);
  const std::string more = beyondText(beyond);
  if (beyond.throat_mL + beyond.beside_mL >= kLittle_mL) {
    const std::string agreed = ask(
        {code::kFaceTakesMore,
         "The cut that takes the face away takes more than the face: " + more + ". Cut it away?",
         {"refuse", "accept", "keep"},
         {"Do not read this series so", "Cut all of it away",
          "Keep face and all; the case must then stay on this computer"}},
        request.answers, series.choices);
    if (agreed == "keep") return kept("The cut would have taken more: " + more + ". ");
    if (agreed != "accept") {
      return refuse(code::kFaceTakesMore, "The cut that takes the face away takes more: " + more,
                    "Accept it, keep the face, or crop the scan to the head", series);
    }
  }

  const bool may_keep = request.answers.contains(code::kFaceRemains) &&
                        request.answers.at(code::kFaceRemains) == "keep";
  CoarseGrid before = faceGrid(volume);
  const FaceMarks marks = findFaceMarks(before);
  TakenVoxels taken;
  const std::uint64_t voxels = deface(volume, face, may_keep ? &taken : nullptr);
  const std::string doubt = faceDoubt(marks, before, faceGrid(volume));
  if (!doubt.empty()) {
    const std::string text = "It could not be made sure that the face is gone: " + doubt;
    ask({code::kFaceRemains,
         text + ". Keep the face?",
         {"refuse", "keep"},
         {"Do not read this series so",
          "Keep the whole face; the case must then stay on this computer"}},
        request.answers, series.choices);
    if (!may_keep) {
      return refuse(
          code::kFaceRemains, text,
          "Crop the head away, or keep the face; the case must then stay on this computer", series);
    }
    for (const auto& slice : taken) {
      for (const auto& [n, hu] : slice) volume.hu[n] = hu;
    }
    return kept(text + ". ");
  }
  series.findings.push_back({code::kFace,
                             Severity::repair,
                             kFaceText,
                             {},
                             "The face was cut away as was agreed: " + std::to_string(voxels) +
                                 " voxels became air" +
                                 (more.empty() ? "" : ", with them " + more) +
                                 ". Eyes, nose and mouth were looked for again: none is left"});
  return true;
}

}  // namespace

Status takeVolumeSteps(const ImportRequest& request, const Progress& progress, SeriesReport& series,
                       Volume& volume, std::optional<MeasuredLoss>& loss) {
  const auto cancelled = [&] {
    return Error{code::kCancelled, "The import was cancelled", "", ""};
  };
  progress.at(0.9, "Looking for couch and face");
  CoarseGrid grid = coarseGrid(volume);
  bool changed = stepCouch(grid, request.answers, series, volume);
  if (progress.cancelled()) return cancelled();
  if (changed) grid = coarseGrid(volume);
  const Result<bool> faced = stepFace(grid, request, series, volume);
  if (!faced) return faced.error();
  changed |= *faced;
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
    series.findings.push_back({code::kReduced,
                               Severity::repair,
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
