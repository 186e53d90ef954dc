#include "imaging/segmentation/structure_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <new>

#include "base/codes.h"
#include "base/memory.h"
#include "base/range.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/segmentation/detail/structure_hu.h"
#include "imaging/segmentation/detail/structure_place.h"
#include "imaging/segmentation/overlap_order.h"
#include "volume/codes.h"
#include "volume/grid_place.h"

namespace trephine {

namespace {

// A structure of which more lies beyond the CT is another patient's, or in another place.
constexpr double kMostOutside_percent = 50.0;

std::string number(double value, int digits = 0) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

// The patient's axis (0 left, 1 back, 2 head) that a grid's axis runs along most.
int patientAxis(const GridGeometry& g, int axis) {
  int most = 0;
  for (int p = 1; p < 3; ++p) {
    if (std::abs(g.direction[axis][p]) > std::abs(g.direction[axis][most])) most = p;
  }
  return most;
}

std::string sidesAlong(const GridGeometry& g, int axis) {
  const std::string sides[] = {tr("left and right"), tr("front and back"), tr("head and foot")};
  return sides[patientAxis(g, axis)];
}

// "82 slices (246 mm) nearer to the head".
std::string moveWords(const BetterPlace& place, const GridGeometry& g) {
  const std::uint64_t count = std::uint64_t(std::abs(place.voxels));
  const std::string steps = place.axis == 0   ? trCount(count, "{} column", "{} columns")
                            : place.axis == 1 ? trCount(count, "{} row", "{} rows")
                                              : trCount(count, "{} slice", "{} slices");
  const std::string sides[][2] = {{tr("the patient's right"), tr("the patient's left")},
                                  {tr("the front"), tr("the back")},
                                  {tr("the foot"), tr("the head")}};
  const int voxels = std::abs(place.voxels), towards = patientAxis(g, place.axis);
  const bool rising = (place.voxels > 0) == (g.direction[place.axis][towards] > 0.0);
  return tr("{} ({} mm) nearer to {}", steps, number(voxels * g.spacing_mm[place.axis]),
            sides[towards][rising]);
}

// Voxels [low, high) of the CT whose middles lie in the other grid's box, by their extremes.
VoxelBox coveredBy(const GridGeometry& of, const GridGeometry& ct) {
  const Mat4 to_ct = ct.patientToVoxel() * of.voxelToPatient();
  Vec3 low(1e30), high(-1e30);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at(corner & 1 ? of.size[0] - 0.5 : -0.5, corner & 2 ? of.size[1] - 0.5 : -0.5,
                  corner & 4 ? of.size[2] - 0.5 : -0.5);
    const Vec3 v = Vec3(to_ct * glm::dvec4(at, 1.0));
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  VoxelBox box;
  for (std::size_t a = 0; a < 3; ++a) {
    const double n = ct.size[a];
    box.low[a] = int(std::clamp(std::ceil(low[int(a)] - 1e-3), 0.0, n));
    box.high[a] = int(std::clamp(std::floor(high[int(a)] - 1e-3) + 1.0, double(box.low[a]), n));
  }
  return box;
}

// Of the CT's voxels, the share whose middles lie in the other grid; `box` holds them.
double shareCovered(const GridGeometry& of, const GridGeometry& ct, const VoxelBox& box) {
  const Mat4 to_other = of.patientToVoxel() * ct.voxelToPatient();
  const Vec3 step(to_other[0]);
  std::size_t inside = 0;
  for (int k = box.low[2]; k < box.high[2]; ++k) {
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      // The part of the row that all three axes of the other leave.
      const Vec3 start(to_other * glm::dvec4(0, j, k, 1));
      double low = box.low[0], high = box.high[0] - 1;
      for (int a = 0; a < 3; ++a) {
        const double least = -0.5 - 1e-3 - start[a];
        const double most = of.size[std::size_t(a)] - 0.5 + 1e-3 - start[a];
        if (std::abs(step[a]) < 1e-9) {
          if (least > 0.0 || most < 0.0) high = low - 1;
          continue;
        }
        low = std::max(low, std::min(least / step[a], most / step[a]));
        high = std::min(high, std::max(least / step[a], most / step[a]));
      }
      inside += std::size_t(std::max(0.0, std::floor(high) - std::ceil(low) + 1.0));
    }
  }
  return double(inside) / double(ct.voxelCount());
}

// Whether voxels of the one lie on voxels of the other: same axes but for order and sense, same
// spacing, middles within a hundredth of a voxel.
bool sharesVoxels(const GridGeometry& of, const GridGeometry& ct) {
  const Mat4 to_ct = ct.patientToVoxel() * of.voxelToPatient();
  for (int axis = 0; axis < 3; ++axis) {
    const double across = of.size[std::size_t(axis)];
    for (int p = 0; p < 3; ++p) {
      const double step = to_ct[axis][p];
      if (std::abs(step - std::round(step)) * across > 0.01 || std::abs(step) > 1.01) return false;
    }
  }
  for (int p = 0; p < 3; ++p) {
    if (std::abs(to_ct[3][p] - std::round(to_ct[3][p])) > 0.01) return false;
  }
  return true;
}

// Of each segment: voxels in the file, and how many of them have their middle beyond the CT, or
// beyond it by more than a voxel: what has a slice at its end may be half a voxel off.
struct SegmentShare {
  std::size_t voxels = 0, outside = 0, far_outside = 0;
};

std::vector<SegmentShare> sharesOf(const Segmentation& of, const GridGeometry& ct) {
  std::vector<std::array<SegmentShare, 256>> by_value(of.layers.size());
  const Mat4 to_ct = ct.patientToVoxel() * of.geometry.voxelToPatient();
  const Vec3 step(to_ct[0]);
  const Index3& size = of.geometry.size;
  const double voxel_mm =
      std::max({of.geometry.spacing_mm.x, of.geometry.spacing_mm.y, of.geometry.spacing_mm.z});
  const Vec3 slack = glm::max(Vec3(1.0), voxel_mm / ct.spacing_mm);
  const auto beyond = [&](const Vec3& v, const Vec3& by) {
    for (int a = 0; a < 3; ++a) {
      const double most = 0.5 + by[a] + 1e-3;
      if (v[a] < -most || v[a] > ct.size[std::size_t(a)] - 1.0 + most) return true;
    }
    return false;
  };
  for (std::size_t l = 0; l < of.layers.size(); ++l) {
    std::size_t voxel = 0;
    for (int k = 0; k < size[2]; ++k) {
      for (int j = 0; j < size[1]; ++j) {
        const Vec3 row(to_ct * glm::dvec4(0, j, k, 1));
        for (int i = 0; i < size[0]; ++i, ++voxel) {
          const std::uint8_t value = of.layers[l][voxel];
          if (value == 0) continue;
          SegmentShare& share = by_value[l][value];
          ++share.voxels;
          const Vec3 at = row + double(i) * step;
          if (!beyond(at, Vec3(0.0))) continue;
          ++share.outside;
          share.far_outside += beyond(at, slack);
        }
      }
    }
  }
  std::vector<SegmentShare> shares;
  for (const Segmentation::Segment& s : of.segments) shares.push_back(by_value[s.layer][s.value]);
  return shares;
}

// "slices 1 to 30 of 112", "the whole of it".
std::string partWords(const VoxelBox& box, const GridGeometry& ct) {
  static const char* const kAxes[] = {"columns", "rows", "slices"};
  std::string words;
  for (std::size_t a = 3; a-- > 0;) {
    if (box.low[a] == 0 && box.high[a] == ct.size[a]) continue;
    if (!words.empty()) words += ", ";
    const double mm = (box.high[a] - box.low[a]) * ct.spacing_mm[int(a)];
    words += tr("{} {} to {} of {} ({} of {} mm)", kAxes[a], box.low[a] + 1, box.high[a],
                ct.size[a], number(mm, 0), number(ct.size[a] * ct.spacing_mm[int(a)], 0));
  }
  return words;
}

// What is done about a choice.
class Asking {
 public:
  Asking(const Answers& answers, bool ask_all, StructureFit& fit, std::optional<Choice>& open)
      : answers_(answers), ask_all_(ask_all), fit_(fit), open_(open) {}

  // Kept only where a person says so.
  Status refuseUnless(Choice choice) {
    const auto given = answers_.find(choice.code);
    if (given == answers_.end() || given->second != "keep") {
      if (given == answers_.end()) open_ = choice;
      return notUsed(choice);
    }
    fit_.choices.push_back(std::move(choice));
    return {};
  }

  // The option that was chosen, or the one for nobody's answer.
  Result<std::string> ask(Choice choice) {
    const auto given = answers_.find(choice.code);
    std::string option = choice.options.front();
    if (given != answers_.end()) {
      if (std::ranges::find(choice.options, given->second) == choice.options.end()) {
        return Error{
            code::kBadChoice,
            tr("The choice {} has no option '{}'", choice.code.str(), cleanUtf8(given->second)), "",
            tr("Choose {}", listed(choice.options, tr("or")))};
      }
      option = given->second;
    } else if (option == "refuse" && !ask_all_) {
      option = choice.options.back();
    }
    if (option == "refuse") {
      if (given == answers_.end()) open_ = choice;
      return notUsed(choice);
    }
    fit_.choices.push_back(std::move(choice));
    return option;
  }

 private:
  const Answers& answers_;
  bool ask_all_;
  StructureFit& fit_;
  std::optional<Choice>& open_;  // that nobody has answered
};

Result<std::vector<std::size_t>> orderOf(const Segmentation& of, const Answers& answers,
                                         Asking& asking, StructureFit& fit) {
  std::vector<std::size_t> order = smallerFirst(of);
  const std::vector<Overlap> shared = overlaps(of);
  if (shared.empty()) return order;
  const auto most =
      std::max_element(shared.begin(), shared.end(),
                       [](const auto& a, const auto& b) { return a.voxels < b.voxels; });
  const double voxel_ml = of.geometry.voxelVolume_mm3() / 1000.0;
  const auto name = [&](std::size_t s) { return "'" + of.segments[s].name + "'"; };
  const std::string what = trCount(
      shared.size(), "{} pair of structures shares voxels, most of all {} and {} with {} mL",
      "{} pairs of structures share voxels, most of all {} and {} with {} mL", name(most->a),
      name(most->b), number(double(most->voxels) * voxel_ml, 1));
  Choice choice{code::kOverlap,
                tr("{}. Which of them has those voxels?", what),
                {"smaller", "first", "last"},
                {tr("The smaller one, as a vessel in the liver"),
                 tr("The one that the file has first"), tr("The one that the file has last")}};
  const auto given = answers.find(choice.code);
  if (given != answers.end() && given->second.starts_with(kOrderAnswer)) {
    auto own = orderFrom(given->second, of);
    if (!own) return own.error();
    fit.choices.push_back(std::move(choice));
    fit.overlapping = overlapping(of, shared, *own);
    fit.findings.push_back({code::kOverlap,
                            Severity::notice,
                            what,
                            {},
                            tr("The first has them, of {}", listed(fit.overlapping))});
    return own;
  }
  const Result<std::string> chosen = asking.ask(std::move(choice));
  if (!chosen) return chosen.error();
  if (*chosen != "smaller") {
    for (std::size_t s = 0; s < order.size(); ++s) {
      order[s] = *chosen == "first" ? s : order.size() - 1 - s;
    }
  }
  fit.overlapping = overlapping(of, shared, order);
  fit.findings.push_back({code::kOverlap,
                          Severity::notice,
                          what,
                          {},
                          *chosen == "smaller" ? tr("The smaller one has them")
                                               : tr("The one that comes {} has them", *chosen)});
  return order;
}

std::string stepsText(const Vec3& mm) {
  if (mm.x == mm.y && mm.y == mm.z) return plainNumber(mm.x) + " mm";
  return plainNumber(mm.x) + " x " + plainNumber(mm.y) + " x " + plainNumber(mm.z) + " mm";
}

// Along the patient's axes, the first voxel at 0, in steps of 1 mm or the CT's: what a program
// writes that was told of no place.
bool saysNoPlace(const GridGeometry& g, const GridGeometry& ct) {
  const auto inSteps = [&](const Vec3& mm) {
    return glm::all(glm::lessThan(glm::abs(g.spacing_mm - mm), Vec3(1e-3)));
  };
  if (!inSteps(Vec3(1.0)) && !inSteps(ct.spacing_mm)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int along = patientAxis(g, axis);
    const double origin = std::abs(g.origin_mm[along]);
    if (std::abs(g.direction[axis][along]) < 1.0 - 1e-6) return false;
    // The other end where slices were reversed.
    const double far_end = (g.size[std::size_t(axis)] - 1.0) * g.spacing_mm[axis];
    if (origin > 1e-6 && std::abs(origin - far_end) > 1e-6) return false;
  }
  return true;
}

// Asks what becomes of one that says nothing of its place and may be the CT's own, voxel by voxel.
Status placeByItsSize(Segmentation& of, const GridGeometry& ct, Asking& asking, StructureFit& fit) {
  const Vec3& mm = ct.spacing_mm;
  if (of.geometry.size != ct.size || !saysNoPlace(of.geometry, ct) ||
      cornersFrom_mm(of.geometry, ct) <= 0.5 * std::min({mm.x, mm.y, mm.z})) {
    return {};
  }
  const std::string what =
      tr("The file is of the CT's size and says nothing of where it lies: voxels of {}, the first "
         "at 0",
         stepsText(of.geometry.spacing_mm));
  const auto chosen = asking.ask(
      {code::kNoAffine,
       what,
       {"refuse", "keep", "ct"},
       {tr("Do not use the segmentation"), tr("Where it says, with the first voxel at 0"),
        tr("On the CT, voxel by voxel")}});
  if (!chosen) return chosen.error();
  if (*chosen == "ct") of.geometry = ct;
  fit.findings.push_back({code::kNoAffine,
                          Severity::notice,
                          what,
                          {},
                          *chosen == "ct" ? tr("It was put on the CT, voxel by voxel")
                                          : tr("It was taken at its word")});
  return {};
}

Result<StructureFit> fitted(Segmentation& of, const Volume& ct, const Answers& answers,
                            bool ask_all, const Progress& progress, std::optional<Choice>& open) {
  const GridGeometry& g = ct.geometry;
  const Error cancelled{code::kCancelled, tr("Reading the segmentation was cancelled"), "", ""};
  StructureFit fit;
  fit.format = of.format;
  for (const std::string& note : of.notes)
    fit.findings.push_back({code::kFileNote, Severity::notice, note, {}, ""});
  Asking asking(answers, ask_all, fit, open);
  if (Status placed = placeByItsSize(of, g, asking, fit); !placed) return placed.error();
  progress.at(0.0, tr("Placing the structures"));
  const std::vector<SegmentShare> shares = sharesOf(of, g);
  std::size_t all = 0, outside = 0;
  for (const SegmentShare& share : shares) {
    all += share.voxels;
    outside += share.outside;
  }
  if (all == 0) {
    return Error{code::kEmptySegmentation, tr("The file has no voxel of any structure"),
                 tr("the segmentation"), tr("Export it again, with its structures")};
  }
  if (progress.cancelled()) return cancelled;
  if (outside == all) {
    return Error{code::kLabelsElsewhere,
                 tr("The segmentation and the case do not overlap in the patient"),
                 tr("the segmentation"), tr("Choose the one that was made from this CT")};
  }
  for (std::size_t s = 0; s < shares.size(); ++s) {
    if (shares[s].voxels == 0) continue;
    const double percent = 100.0 * double(shares[s].far_outside) / double(shares[s].voxels);
    if (percent < kMostOutside_percent) continue;
    return Error{code::kHalfOutside,
                 tr("Of the structure '{}' {} % lie outside of the CT",
                    of.segments[s].name.empty() ? tr("label {}", int(of.segments[s].value))
                                                : of.segments[s].name,
                    number(percent)),
                 tr("the segmentation"), tr("Choose the one that was made from this CT")};
  }
  const auto order = orderOf(of, answers, asking, fit);
  if (!order) return order.error();
  progress.at(0.3, tr("Placing the structures"));
  const LabelMap own = merged(of, *order);
  auto map = fitTo(own, g);
  if (!map) return map.error();
  fit.map = *std::move(map);
  fit.resampled = !sharesVoxels(of.geometry, g);
  if (fit.resampled) {
    fit.findings.push_back({code::kResampled,
                            Severity::notice,
                            tr("The file's voxels are not the CT's"),
                            {},
                            tr("Each voxel of the CT takes what its middle lies in")});
  }
  fit.covers = coveredBy(of.geometry, g);
  const double covered = shareCovered(of.geometry, g, fit.covers);
  fit.covers_percent = 100.0 * covered;
  // A DICOM Segmentation leaves out the slices that have nothing of it.
  if (covered < 1.0 && of.format != "DICOM SEG") {
    fit.findings.push_back({code::kPartOfCt,
                            Severity::notice,
                            tr("The file covers {} % of the CT: {}", number(fit.covers_percent),
                               partWords(fit.covers, g)),
                            {},
                            tr("The rest of the CT has no structure")});
  }
  if (progress.cancelled()) return cancelled;
  progress.at(0.6, tr("Looking at the structures' HU"));
  const HuByLabel counts = huOf(fit.map, ct);
  // Of good ones, what is off by a voxel of either grid is no mistake.
  const double slack_mm =
      std::max({of.geometry.spacing_mm.x, of.geometry.spacing_mm.y, of.geometry.spacing_mm.z,
                g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z});
  const auto wrong = notOfTheirKind(fit.map, ct, counts, slack_mm);
  std::string mirrored;
  std::optional<BetterPlace> better;
  if (const auto axis = mirroredAxis(fit.map, ct, fit.covers, counts, wrong)) {
    mirrored = tr("its structures lie on what they are of when {}", sidesAlong(g, *axis));
  } else {
    better = betterPlace(fit.map, ct, fit.covers, slack_mm);
    if (better && better->mirrored) {
      mirrored = tr("its structures' borders lie on borders in the CT when {}",
                    sidesAlong(g, better->axis));
    }
  }
  if (!mirrored.empty()) {
    const std::string what = tr("The segmentation is mirrored: {} change places", mirrored);
    if (Status taken =
            asking.refuseUnless({code::kMirrored,
                                 what,
                                 {"refuse", "keep"},
                                 {tr("Do not use the segmentation"), tr("Use it all the same")}});
        !taken) {
      return taken.error();
    }
    fit.findings.push_back({code::kMirrored, Severity::notice, what, {}, tr("It was kept")});
  }
  if (progress.cancelled()) return cancelled;

  const double file_ml = of.geometry.voxelVolume_mm3() / 1000.0;
  const double ct_ml = g.voxelVolume_mm3() / 1000.0;
  std::vector<std::string> doubtful;
  for (std::size_t s = 0; s < of.segments.size(); ++s) {
    const Structure& structure = fit.map.structures[s];
    StructureCard card;
    card.name = structure.name;
    card.label = structure.label;
    card.colour = structure.colour;
    card.ml_in_file = double(shares[s].voxels) * file_ml;
    const auto& of_it = counts[std::size_t(structure.label)];
    card.voxels = of_it ? of_it->total() : 0;
    card.ml = double(card.voxels) * ct_ml;
    if (shares[s].voxels > 0) {
      card.outside_percent = 100.0 * double(shares[s].outside) / double(shares[s].voxels);
    }
    if (card.outside_percent > 0.0) {
      card.findings.push_back(
          {code::kOutside,
           Severity::notice,
           tr("{} % of it lie outside of the CT", number(card.outside_percent, 1)),
           {},
           tr("They are left out")});
    }
    if (card.voxels == 0) {
      card.findings.push_back(
          {code::kEmptyStructure, Severity::notice, tr("It has no voxel on the CT"), {}, ""});
    } else {
      card.hu = {of_it->percentile(0.05), of_it->percentile(0.5), of_it->percentile(0.95)};
      const auto kind = huOfKind(structure.name, structure.tissue);
      const double median = (*card.hu)[1];
      if (kind && wrong[std::size_t(structure.label)]) {
        doubtful.push_back(
            tr("'{}' has a median of {} HU, {} to {} but for a tenth, and {} has {} to {}",
               structure.name, number(median), number((*card.hu)[0]), number((*card.hu)[2]),
               tr(kind->kind), number(kind->low), number(kind->high)));
        card.findings.push_back({code::kHuNotTissue, Severity::notice, doubtful.back(), {}, ""});
      }
    }
    fit.structures.push_back(std::move(card));
  }
  std::string doubt;
  if (!doubtful.empty()) {
    doubt = tr("The HU cannot be the tissue: {}", doubtful.front());
    if (doubtful.size() > 1)
      doubt += trCount(doubtful.size() - 1, ", and {} other alike", ", and {} others alike");
  }
  if (better && !better->mirrored) {
    doubt += doubt.empty() ? tr("The structures' borders lie on nothing in the CT") : "";
    doubt += tr(". They would fit far better about {}", moveWords(*better, g));
  }
  if (!doubt.empty()) {
    const auto chosen =
        asking.ask({code::kHuNotTissue,
                    tr("{}. The segmentation may lie in a wrong place", doubt),
                    {"refuse", "keep"},
                    {tr("Do not use the segmentation"), tr("Use it all the same")}});
    if (!chosen) return chosen.error();
    fit.findings.push_back({code::kHuNotTissue, Severity::notice, doubt, {}, tr("It was kept")});
  }
  progress.at(1.0, tr("Placing the structures"));
  return fit;
}

Json toJson(const StructureCard& card);
Json toJson(const Choice& choice);

Json toJson(const Finding& finding) {
  return {{"code", finding.code.str()}, {"text", finding.text}, {"action", finding.action}};
}

template <class List>
Json listOf(const List& list) {
  Json all = Json::array();
  for (const auto& item : list) all.push_back(toJson(item));
  return all;
}

Json toJson(const StructureCard& card) {
  Json hu = nullptr;
  if (card.hu) hu = {(*card.hu)[0], (*card.hu)[1], (*card.hu)[2]};
  return {{"name", card.name},
          {"label", card.label},
          {"voxels", card.voxels},
          {"ml", card.ml},
          {"ml_in_file", card.ml_in_file},
          {"outside_percent", card.outside_percent},
          {"hu", hu},
          {"findings", listOf(card.findings)}};
}

Json toJson(const Choice& choice) {
  return {{"code", choice.code.str()}, {"question", choice.question}, {"options", choice.options}};
}

}  // namespace

Error notUsed(const Choice& choice) {
  std::vector<std::string> answers;
  for (const std::string& option : choice.options) {
    if (option != "refuse") answers.push_back(choice.code.str() + "=" + option);
  }
  return {choice.code, choice.question, tr("the segmentation"),
          tr("Export it again, choose another file, or answer {}", listed(answers, tr("or")))};
}

Result<StructureFit> fitOf(Result<FitAnswer> answer) {
  if (!answer) return answer.error();
  if (const auto* open = std::get_if<Choice>(&*answer)) return notUsed(*open);
  return std::get<StructureFit>(*std::move(answer));
}

Result<FitAnswer> fitStructures(Segmentation segmentation, const Volume& ct, const Answers& answers,
                                bool ask_all, const Progress& progress) {
  try {
    std::optional<Choice> open;
    Result<StructureFit> fit = fitted(segmentation, ct, answers, ask_all, progress, open);
    if (open) return FitAnswer(*std::move(open));
    if (!fit) return fit.error();
    return FitAnswer(*std::move(fit));
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the segmentation"), tr("the segmentation"));
  }
}

Json toJson(const StructureFit& fit) {
  return {{"format", fit.format},
          {"structures", listOf(fit.structures)},
          {"covers_percent", fit.covers_percent},
          {"covers", {{"low", fit.covers.low}, {"high", fit.covers.high}}},
          {"resampled", fit.resampled},
          {"overlapping", fit.overlapping},
          {"fractional", fit.fractional},
          {"findings", listOf(fit.findings)},
          {"choices", listOf(fit.choices)}};
}

}  // namespace trephine
