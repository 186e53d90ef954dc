#include "imaging/steps/detail/volume_steps.h"

#include <algorithm>

#include "base/codes.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/series/detail/series_geometry.h"
#include "imaging/steps/coarse_grid.h"
#include "imaging/steps/couch.h"
#include "imaging/steps/face.h"
#include "imaging/steps/face_check.h"
#include "volume/reduce.h"
#include "volume/thick_slices.h"

namespace trephine {

namespace {

// Consent is asked only where there is something to consent to.
bool stepCouch(const CoarseGrid& grid, const Answers& answers, SeriesReport& series,
               Volume& volume) {
  const CouchFinding couch = findCouch(grid);
  if (!couch.found) return false;
  const std::string answer = ask({code::kCouch,
                                  tr("A patient couch or head holder is in the scan. Take it out?"),
                                  {"keep", "remove"},
                                  {tr("Leave the scan as it is"),
                                   tr("Set couch and holder to air; the patient is not touched")}},
                                 answers, series.choices);
  const std::string text = tr("The scan shows a couch or holder, {} mm wide and {} mm long",
                              fixedText(couch.width_mm, 0), fixedText(couch.length_mm, 0));
  if (answer != "remove") {
    series.findings.push_back({code::kCouch,
                               Severity::notice,
                               text,
                               {},
                               !answers.contains(code::kCouch)
                                   ? tr("It stays in where nothing else is chosen; tools can touch "
                                        "and cut it like tissue")
                                   : tr("It was left in; tools can touch and cut it like tissue")});
    return false;
  }
  const std::uint64_t voxels = removeCouch(volume, couch);
  series.findings.push_back({code::kCouch,
                             Severity::edit,
                             text,
                             {},
                             tr("It was taken out as was agreed: {} voxels became air", voxels)});
  return true;
}

// Of a mark's surroundings as they were: from this share on it is still there.
constexpr double kStillThere = 0.25;
// Flesh and bone beyond the face that go without a question.
constexpr double kLittle_mL = 20.0;

const char* const kFaceText = trLater("The patient's face can be reconstructed from this scan");

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
    return tr(
        "neither eyes nor nose can be recognised in this scan, so that nothing tells whether "
        "the "
        "cut took them");
  }
  const FaceLeft left = faceLeft(marks, before, after);
  std::vector<std::string> there;
  if (left.eyes >= kStillThere) there.emplace_back("eyes");
  if (left.nose >= kStillThere) there.emplace_back("nose");
  if (left.mouth >= kStillThere) there.emplace_back("mouth");
  if (there.empty()) return "";
  return tr("{} can still be seen after the cut", listed(there));
}

std::string beyondText(const BeyondFace& beyond) {
  std::string text;
  if (beyond.throat_mL >= 1.0) text += tr("{} mL of the throat", fixedText(beyond.throat_mL, 0));
  if (beyond.beside_mL >= 1.0) {
    text += tr("{}{} mL beside and above the face, such as arms or hands",
               (text.empty() ? "" : " and "), fixedText(beyond.beside_mL, 0));
  }
  if (beyond.bone_mL >= 1.0) text += tr(", bone included");
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
         tr(kFaceText),
         {},
         tr("{}It was kept: the case must stay on this computer until the face is cut away", why)});
    return false;
  };
  const std::string answer =
      ask({code::kFace,
           tr("The patient's face can be reconstructed from this scan. Cut it away?"),
           {"keep", "deface"},
           {tr("Keep it; the case must then stay on this computer"),
            tr("Cut the face away below the brow, bone included; vault, brain and ears stay")}},
          request.answers, series.choices);
  if (answer != "deface") return kept("");

  const BeyondFace beyond = beyondFace(grid, face, kept_box);
  const std::string more = beyondText(beyond);
  if (beyond.throat_mL + beyond.beside_mL >= kLittle_mL) {
    const std::string agreed = ask(
        {code::kFaceTakesMore,
         tr("The cut that takes the face away takes more than the face: {}. Cut it away?", more),
         {"refuse", "accept", "keep"},
         {tr("Do not read this series so"), tr("Cut all of it away"),
          tr("Keep face and all; the case must then stay on this computer")}},
        request.answers, series.choices);
    if (agreed == "keep") return kept(tr("The cut would have taken more: {}. ", more));
    if (agreed != "accept") {
      return refuse(code::kFaceTakesMore,
                    tr("The cut that takes the face away takes more: {}", more),
                    tr("Accept it, keep the face, or crop the scan to the head"), series);
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
    const std::string text = tr("It could not be made sure that the face is gone: {}", doubt);
    ask({code::kFaceRemains,
         tr("{}. Keep the face?", text),
         {"refuse", "keep"},
         {tr("Do not read this series so"),
          tr("Keep the whole face; the case must then stay on this computer")}},
        request.answers, series.choices);
    if (!may_keep) {
      return refuse(
          code::kFaceRemains, text,
          tr("Crop the head away, or keep the face; the case must then stay on this computer"),
          series);
    }
    for (const auto& slice : taken) {
      for (const auto& [n, hu] : slice) volume.hu[n] = hu;
    }
    return kept(text + ". ");
  }
  series.findings.push_back({code::kFace,
                             Severity::edit,
                             tr(kFaceText),
                             {},
                             tr("The face was cut away as was agreed: {} voxels became air{}. "
                                "Eyes, nose and mouth were looked for again: none is left",
                                voxels, (more.empty() ? "" : tr(", with them {}", more)))});
  return true;
}

// Whether slices were put between the slices. Errors: OUT_OF_MEMORY, BAD_SIZE.
Result<bool> stepThickSlices(const ImportRequest& request, SeriesReport& series, Volume& volume) {
  const Answers& answers = request.answers;
  const std::string reduced = request.reduction > 1 ? tr(" at the reduced resolution") : "";
  const int steps = stepsBetweenSlices(volume.geometry);
  if (steps == 1) return false;
  const double apart_mm = volume.geometry.spacing_mm.z;
  const std::string thin = fixedText(apart_mm / steps, 2);
  const std::string answer = ask(
      {code::kThickSlices,
       tr("The slices lie {} mm apart{}. Interpolate slices {} mm apart between them?",
          fixedText(apart_mm, 2), reduced, thin),
       {"keep", "interpolate"},
       {tr("Keep the slices: needles and blades cut too much across them, a turning burr or saw "
           "sinks in up to {} mm before it is stopped",
           fixedText(0.5 * apart_mm, 1)),
        tr("Interpolate (better for touch): each tool cuts as wide as it is; detail between the "
           "slices is only apparent, and the case is {} times as large",
           steps)}},
      answers, series.choices);
  const std::string text =
      tr("The slices lie {} mm apart{}, which is coarse for touch: a tool meets "
         "and cuts voxels whole",
         fixedText(apart_mm, 2), reduced);
  if (answer != "interpolate") {
    series.findings.push_back({code::kThickSlices,
                               Severity::notice,
                               text,
                               {},
                               tr("As they are, touch and cuts are off by up to {} mm across them",
                                  fixedText(0.5 * apart_mm, 1))});
    return false;
  }
  Result<Volume> between = withThinSlices(volume, steps);
  if (!between) return between.error();
  series.findings.push_back(
      {code::kThickSlices,
       Severity::edit,
       text,
       {},
       tr("Slices {} mm apart were interpolated between them, as was chosen: {} became {}. Detail "
          "between these slices is only apparent",
          thin, volume.geometry.size[2], between->geometry.size[2])});
  volume = *std::move(between);
  return true;
}

}  // namespace

Status takeVolumeSteps(const ImportRequest& request, const Progress& progress, SeriesReport& series,
                       Volume& volume, std::optional<MeasuredLoss>& loss) {
  const auto cancelled = [&] {
    return Error{code::kCancelled, tr("The import was cancelled"), "", ""};
  };
  progress.at(0.9, tr("Looking for couch and face"));
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
    progress.at(0.93, tr("Reducing the resolution"));
    Result<Volume> small = reduced(volume, request.reduction);
    if (!small) return small.error();
    const ReductionLoss measured = reductionLoss(volume, *small, request.reduction);
    loss = MeasuredLoss{measured.rms_hu, measured.p99_hu, measured.bone_volume_change_percent};
    series.findings.push_back({code::kReduced,
                               Severity::edit,
                               tr("The resolution was reduced to {} along each axis",
                                  request.reduction == 2 ? "a half" : "a quarter"),
                               {},
                               tr("Against the full resolution HU differ by {} (rms), 99 % of them "
                                  "by at most {}; the volume of bone changed by {} %",
                                  fixedText(loss->rms_hu, 1), fixedText(loss->p99_hu, 0),
                                  fixedText(loss->bone_volume_change_percent, 1))});
    volume = *std::move(small);
    changed = true;
  }
  if (progress.cancelled()) return cancelled();
  const Result<bool> thinner = stepThickSlices(request, series, volume);
  if (!thinner) return thinner.error();
  changed |= *thinner;
  if (progress.cancelled()) return cancelled();
  if (changed || !series.hu_min) {
    const auto [low, high] = std::ranges::minmax(volume.hu);
    series.hu_min = low;
    series.hu_max = high;
  }
  return {};
}

}  // namespace trephine
