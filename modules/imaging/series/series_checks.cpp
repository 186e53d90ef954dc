// What a series' headers say about it: kind, values, pixels, geometry. Each check adds a finding
// with its own code; README.md lists them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "base/codes.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/dicom/detail/transfer_syntax.h"
#include "imaging/report/answers.h"
#include "imaging/series/detail/findings.h"
#include "imaging/series/detail/series.h"
#include "imaging/series/detail/series_agreement.h"
#include "imaging/series/detail/series_geometry.h"
#include "imaging/series/detail/series_kind.h"
#include "imaging/series/detail/series_repeats.h"
#include "imaging/series/detail/series_steps.h"
#include "volume/case_memory.h"
#include "volume/codes.h"

namespace trephine {

namespace {

// The slice that speaks for all: one with pixels where there is one, so with a whole header.
const DicomHeader& typicalSlice(const std::vector<DicomHeader>& slices) {
  const auto whole = std::ranges::find(slices, true, &DicomHeader::has_pixels);
  return whole == slices.end() ? slices.front() : *whole;
}

// Series of which no volume can come whatever their geometry. True where one of these it is.
bool refusedByKind(const DicomHeader& first, Findings& findings) {
  const std::string choose_ct = tr("Choose a CT series");
  const std::string open_as_structures =
      tr("It holds structures: open their CT first, then this file under Structures, Open");
  const std::string& kind = first.sop_class;
  const bool secondary = kind.starts_with("1.2.840.10008.5.1.4.1.1.7");
  if (!first.has_pixels && first.modality == "RTSTRUCT") {
    findings.refuse(
        code::kNotAnImageSeries, tr("The series holds structures as contours, not a CT"),
        tr("Export them as a DICOM Segmentation or as a label map: contours are not read "
           "yet"));
  } else if (!first.has_pixels && first.defect == Defect::none) {
    findings.refuse(
        code::kNotAnImageSeries,
        tr("{} hold no pixels",
           (first.modality.empty() ? tr("The files")
                                   : tr("The files of this {} series", shownTerm(first.modality)))),
        choose_ct);
  } else if (secondary) {
    findings.refuse(code::kSecondaryCapture, tr("The series holds captured pictures, not slices"),
                    choose_ct);
  } else if (!isCt(first) || (!first.modality.empty() && first.modality != "CT")) {
    findings.refuse(code::kNotCt,
                    tr("The series is {}: its values are not HU",
                       (first.modality.empty() ? tr("no CT") : shownTerm(first.modality))),
                    first.modality == "SEG" ? open_as_structures : choose_ct);
  } else if (isLocalizer(first)) {
    findings.refuse(code::kLocalizer,
                    tr("The series is a localizer (scout), not a stack of slices"), choose_ct);
  } else if (first.frames > 1 && !first.position_mm && first.defect != Defect::size_mismatch) {
    findings.refuse(
        code::kMultiframe,
        tr("The series is stored as multi-frame pictures that do not say where each frame "
           "lies"),
        tr("Export it as enhanced CT, or as classic CT with one file a slice"));
  } else {
    return false;
  }
  return true;
}

void checkTransferSyntax(const Series& series, Findings& findings) {
  std::map<std::string, int> counts;
  for (const DicomHeader& header : series.slices) ++counts[header.transfer_syntax];
  for (const auto& [uid, count] : counts) {
    if (findTransferSyntax(uid)) continue;
    findings.refuse(code::kUnsupportedTransferSyntax,
                    tr("The transfer syntax {}{} of {} cannot be read", transferSyntaxName(uid),
                       (uid.starts_with("1.2.840.10008.") ? " (" + cleanUtf8(uid) + ")" : ""),
                       slicesText(std::uint64_t(count))),
                    tr("Export the series uncompressed (Explicit VR Little Endian)"));
  }
}

void checkLoss(const Answers& answers, Findings& findings) {
  const auto lossy = findings.slicesWhere([](const DicomHeader& h) { return h.lossy; });
  if (lossy.empty()) return;
  const std::string text = trCount(lossy.size(), "{} slice was compressed with loss",
                                   "{} slices were compressed with loss");
  findings.askConsent(
      {code::kLossySource,
       tr("The series was compressed with loss: its HU are not those of the scanner. Use it?"),
       {"refuse", "accept"},
       {tr("Do not use the series"), tr("Use it for training, marked as lossy")}},
      answers, text,
      tr("They were taken as they are, as was agreed: small differences of HU are "
         "not real"),
      tr("Use the original series, or agree to the loss"), lossy);
}

void checkValues(const Series& series, Findings& findings) {
  const DicomHeader& first = typicalSlice(series.slices);
  const bool grey = first.photometric == "MONOCHROME1" || first.photometric == "MONOCHROME2";
  if (first.samples != 1 || (!grey && !first.photometric.empty())) {
    findings.refuse(code::kColour,
                    tr("The pixels are colour ({}), not HU", shownTerm(first.photometric)),
                    tr("Export the original CT slices"));
  }
  const auto odd_format = findings.slicesWhere([](const DicomHeader& h) {
    return h.has_pixels && h.samples == 1 &&
           (!h.holdsGreyWords() || h.ambiguous_order || h.photometric.empty());
  });
  if (!odd_format.empty()) {
    findings.refuse(
        code::kPixelFormat,
        trCount(
            odd_format.size(),
            "{} slice does not say 8 or 16 allocated bits, as many stored bits or fewer, rows and "
            "columns up to 8192 and photometric interpretation as CT must",
            "{} slices do not say 8 or 16 allocated bits, as many stored bits or fewer, rows and "
            "columns up to 8192 and photometric interpretation as CT must"),
        tr("Export the series again as CT with 16-bit pixels"), odd_format);
  }
  const auto not_hu = findings.slicesWhere([](const DicomHeader& h) {
    return h.has_pixels && !h.rescale_type.empty() && h.rescale_type != "HU" &&
           h.rescale_type != "US";
  });
  if (!not_hu.empty()) {
    findings.refuse(code::kNotHu, tr("The values are {}, not HU", shownTerm(first.rescale_type)),
                    tr("Choose the series in HU"), not_hu);
  }
  const auto bad =
      findings.slicesWhere([](const DicomHeader& h) { return h.has_pixels && h.rescale_bad; });
  if (!bad.empty()) {
    findings.refuse(code::kBadRescale,
                    tr("The rescale slope or intercept of {} is no number that CT could have",
                       slicesText(bad.size())),
                    tr("Export the series again"), bad);
  }
  const auto raw = findings.slicesWhere(
      [](const DicomHeader& h) { return h.has_pixels && !h.intercept_given && !h.rescale_bad; });
  const auto scaled =
      findings.slicesWhere([](const DicomHeader& h) { return h.has_pixels && h.intercept_given; });
  if (!raw.empty() && !scaled.empty()) {
    findings.refuse(code::kBadRescale,
                    trCount(raw.size(), "{} slice lacks the rescale intercept that the others have",
                            "{} slices lack the rescale intercept that the others have"),
                    tr("Export the series again"), raw);
  }
  const auto unscaled = findings.slicesWhere(
      [](const DicomHeader& h) { return h.has_pixels && !h.rescale_given && !h.rescale_bad; });
  if (!unscaled.empty()) {
    findings.notice(
        code::kRescaleDefault,
        trCount(unscaled.size(), "{} slice lacks a rescale slope (or has 0) or intercept",
                "{} slices lack a rescale slope (or have 0) or intercept"),
        tr("Slope 1 and intercept 0 were taken where absent"), unscaled);
  }
  if (first.photometric == "MONOCHROME1") {
    findings.notice(code::kMonochrome1,
                    tr("The series is meant to be shown with white for low values"),
                    tr("The HU are not touched by that"));
  }
}

void checkSizes(const Series& series, Findings& findings) {
  std::vector<std::string> mismatched;
  std::string text;
  for (const DicomHeader& header : series.slices) {
    if (header.defect != Defect::size_mismatch) continue;
    mismatched.push_back(sliceName(header));
    text = header.defect_text;
  }
  if (mismatched.empty()) return;
  findings.refuse(code::kSizeMismatch,
                  trCount(mismatched.size(), "{} slice contradicts itself ({1})",
                          "{} slices contradict themselves (the last: {1})", text),
                  tr("Export the series again"), mismatched);
}

bool isLost(const DicomHeader& header) {
  return header.defect == Defect::cut || !header.has_pixels;
}

bool isPlaced(const DicomHeader& header) {
  constexpr double kFarthest_mm = 1e6, kWidestPixel_mm = 1e3, kNarrowestPixel_mm = 1e-4;
  if (!header.position_mm || !header.orientation || !header.pixel_spacing_mm) return false;
  const auto& p = *header.position_mm;
  const auto [least, most] = std::ranges::minmax(*header.pixel_spacing_mm);
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < kFarthest_mm &&
         most < kWidestPixel_mm && least > kNarrowestPixel_mm;
}

// "; of these cannot be read: slice 2 (its pixels are cut short)"
std::string lostText(const std::vector<const DicomHeader*>& lost) {
  if (lost.empty()) return "";
  std::string text =
      trCount(lost.size(), "; {} slice cannot be read:", "; {} slices cannot be read:");
  for (std::size_t n = 0; n < std::min<std::size_t>(lost.size(), 5); ++n) {
    text += (n == 0 ? " " : ", ") + sliceName(*lost[n]);
  }
  if (lost.size() > 5) text += tr(" and others");
  const std::string& why = lost.back()->defect_text;
  return text + " (" + (why.empty() ? tr("it has no pixels") : why) + ")";
}

// Slices that are cut before they say where they lie: their gap may not show.
void checkUnplaced(const std::vector<const DicomHeader*>& lost, bool others_are_placed,
                   const Answers& answers, SeriesReport& report, Findings& findings) {
  if (lost.empty()) return;
  std::vector<std::string> names;
  for (const DicomHeader* header : lost) names.push_back(sliceName(*header));
  const std::string& why = lost.back()->defect_text;
  const std::string text =
      trCount(names.size(), "{} slice cannot be read, and its place is not known ({1})",
              "{} slices cannot be read, and their places are not known ({1})",
              why.empty() ? tr("it has no pixels") : why);
  const auto given = answers.find(code::kMissingSlices);
  const bool agreed = others_are_placed && given != answers.end() && given->second != "refuse";
  const bool asked = std::ranges::find(report.choices, code::kMissingSlices, &Choice::code) !=
                     report.choices.end();
  if (!asked && others_are_placed) {
    report.choices.push_back(
        {code::kMissingSlices,
         tr("Slices are damaged before they say where they belong. Use the rest?"),
         {"refuse", "part"},
         {tr("Do not use the series"), tr("Use it without them")}});
  }
  if (agreed) {
    findings.repaired(code::kMissingSlices, text, tr("They were left out"), names);
  } else {
    findings.refuse(code::kMissingSlices, text, tr("Copy these files again from their source"),
                    names);
  }
}

// The step that headers state beside the positions, by which slices at one place can be told apart:
// that between slices, or of their locations. 0: none.
double statedStep_mm(const Headers& slices) {
  if (slices.size() < 2) return 0.0;
  const auto all = [&](const auto& test) { return std::ranges::all_of(slices, test); };
  const std::optional<double> stated = slices.front()->spacing_between_mm;
  if (stated && all([&](const DicomHeader* h) { return h->spacing_between_mm == stated; })) {
    return std::abs(*stated);
  }
  if (!all([](const DicomHeader* h) { return h->location_mm.has_value(); })) return 0.0;
  std::vector<double> locations_mm;
  for (const DicomHeader* h : slices) locations_mm.push_back(*h->location_mm);
  std::ranges::sort(locations_mm);
  const double step_mm =
      (locations_mm.back() - locations_mm.front()) / double(locations_mm.size() - 1);
  for (std::size_t n = 1; n < locations_mm.size(); ++n) {
    if (std::abs(locations_mm[n] - locations_mm[n - 1] - step_mm) > 0.05 * step_mm) return 0.0;
  }
  return step_mm;
}

// Whether instance numbers run on without a break, up or down, as the slices lie: none is missing.
bool areNumberedOn(const Headers& taken, const Vec3& normal) {
  std::vector<std::pair<double, int>> numbers;
  for (const DicomHeader* h : taken) {
    const auto number = parseInteger(h->instance_number);
    if (!number) return false;
    numbers.emplace_back(glm::dot(*h->position_mm, normal), *number);
  }
  if (numbers.size() < 3) return false;
  std::ranges::sort(numbers);
  const int step = numbers[1].second - numbers[0].second;
  if (std::abs(step) != 1) return false;
  for (std::size_t n = 1; n < numbers.size(); ++n) {
    if (numbers[n].second - numbers[n - 1].second != step) return false;
  }
  return true;
}

// By place, and at one place in the order of locations, which may be rounded as places are, and
// then of instance numbers, whichever way each of them runs.
void orderAsScanned(Headers& slices, const Vec3& normal) {
  const auto place_mm = [&](const DicomHeader* h) { return glm::dot(*h->position_mm, normal); };
  const auto location_mm = [](const DicomHeader* h) { return h->location_mm.value_or(0.0); };
  const auto number = [](const DicomHeader* h) {
    return parseDecimal(h->instance_number).value_or(0.0);
  };
  std::ranges::stable_sort(slices, {}, place_mm);
  const DicomHeader *first = slices.front(), *last = slices.back();
  const double up = location_mm(last) < location_mm(first) ? -1.0 : 1.0;
  const double on = number(last) < number(first) ? -1.0 : 1.0;
  std::ranges::stable_sort(slices, {}, [&](const DicomHeader* h) {
    return std::tuple(place_mm(h), up * location_mm(h), on * number(h));
  });
}

// Bits that a codestream has beyond those that its header says.
void checkBits(const Series& series, Findings& findings) {
  const auto more = [](const DicomHeader& h) { return h.said_bits_stored > 0; };
  const auto slices = findings.slicesWhere(more);
  if (slices.empty()) return;
  const DicomHeader& one = *std::ranges::find_if(series.slices, more);
  findings.repaired(code::kBitsStored,
                    tr("The header says {} bits a pixel, and the compressed pixels have {}",
                       one.said_bits_stored, one.format.bits_stored),
                    tr("All of their bits were taken"), slices);
}

// Of one patient, by ID and birth date (series.cpp).
void checkNames(const std::vector<DicomHeader>& slices, Findings& findings) {
  std::set<std::string> names;
  for (const DicomHeader& slice : slices) {
    if (!slice.patient.front().empty()) names.insert(slice.patient.front());
  }
  if (names.size() < 2) return;
  findings.notice(code::kNamesDiffer,
                  tr("The patient's name is not the same in all slices; ID and birth date are"),
                  tr("Nothing was changed; look whether all of them are of one patient"));
}

// Slices of one series whose values grow as HU do, and others whose values fall.
void checkSlopes(const Answers& answers, Findings& findings) {
  const auto falling = findings.slicesWhere(
      [](const DicomHeader& h) { return h.has_pixels && h.format.slope < 0.0; });
  const auto rising = findings.slicesWhere(
      [](const DicomHeader& h) { return h.has_pixels && h.format.slope > 0.0; });
  if (!falling.empty() && rising.empty()) {
    findings.notice(code::kNegativeSlope,
                    tr("The rescale slope is negative: a higher stored value is a lower HU"),
                    tr("Nothing was changed; look whether bone is bright"));
  }
  if (falling.empty() || rising.empty()) return;
  const auto& fewer = falling.size() < rising.size() ? falling : rising;
  findings.askConsent(
      {code::kSlopesDiffer,
       tr("In some slices a higher stored value is a lower HU, in the others a higher one. Use "
          "them?"),
       {"refuse", "accept"},
       {tr("Do not use the series"), tr("Use them as their headers say")}},
      answers,
      tr("The rescale slope of {} has another sign than the others'", slicesText(fewer.size())),
      tr("Each was taken as its header says, as was agreed"),
      tr("Look at these slices: in one with a wrong sign bone is dark. Export the series again"),
      fewer);
}

// Parts of an image that was written into several files and are not there. A gap between the parts
// that are there is asked about as one of slices.
void checkConcatenation(const std::vector<DicomHeader>& slices, const Answers& answers,
                        const std::vector<Choice>& asked, Findings& findings) {
  std::map<std::string, std::pair<std::set<int>, int>> images;  // numbers, and how many
  for (const DicomHeader& slice : slices) {
    if (slice.concatenation.empty() || slice.in_concatenation < 1) continue;
    auto& [numbers, total] = images[slice.concatenation];
    numbers.insert(slice.in_concatenation);
    total = std::max(total, slice.concatenated);
  }
  std::vector<std::string> missing;
  constexpr int kMost = 1000;
  for (const auto& [uid, image] : images) {
    const auto& [numbers, total] = image;
    const int last = std::min(kMost, std::max(total, *numbers.rbegin()));
    for (int n = 1; n <= last; ++n) {
      if (numbers.contains(n)) continue;
      missing.push_back(tr("part {}{}", n, (total > 0 ? tr(" of {}", total) : "")));
    }
  }
  if (missing.empty()) return;
  const std::string text =
      trCount(missing.size(), "The series was written in parts, of which {1} is missing",
              "The series was written in parts, of which {1} are missing", listed(missing));
  if (std::ranges::find(asked, code::kMissingSlices, &Choice::code) != asked.end()) {
    const std::string answer = answerTo(answers, code::kMissingSlices);
    return findings.notice(code::kIncomplete, text,
                           answer.empty() || answer == "refuse"
                               ? tr("Copy all files of the series again")
                               : tr("The gap that they leave became what was chosen for it"));
  }
  findings.askConsent(
      {code::kIncomplete,
       tr("Not all parts of the series are there. Use those that are?"),
       {"refuse", "accept"},
       {tr("Do not use the series"), tr("Use them: the scan covers less than it did")}},
      answers, text, tr("The parts that are there were used, as was agreed"),
      tr("Copy all files of the series again, or agree to use what is there"));
}

// Slices that all claim one place and say beside it where they lie: cone-beam scanners write so.
void placeByLocation(const Headers& placed, const Vec3& normal, const Answers& answers,
                     std::vector<Vec3>& positions_mm, SeriesReport& report) {
  std::vector<double> places_mm, locations_mm;
  for (std::size_t n = 0; n < placed.size(); ++n) {
    if (!placed[n]->location_mm) return;
    places_mm.push_back(glm::dot(positions_mm[n], normal));
    locations_mm.push_back(*placed[n]->location_mm);
  }
  if (placed.size() < 3) return;
  const auto [low, high] = std::ranges::minmax(places_mm);
  std::vector<double> sorted = locations_mm;
  std::ranges::sort(sorted);
  const double step_mm = (sorted.back() - sorted.front()) / double(sorted.size() - 1);
  bool even = step_mm > kSamePlace_mm;
  for (std::size_t n = 1; n < sorted.size(); ++n) {
    even &= std::abs(sorted[n] - sorted[n - 1] - step_mm) <= 0.1 * step_mm;
  }
  if (high - low > kSamePlace_mm || !even) return;
  const std::string text =
      tr("All slices claim one place, and their slice locations lie {} apart", lengthText(step_mm));
  const std::string answer = ask(
      {code::kOneLocation,
       tr("All slices claim one place. Shall they lie where their slice locations say?"),
       {"refuse", "locations"},
       {tr("Do not use the series"),
        tr("Place them by slice location, upwards as it grows: head and foot may be exchanged")}},
      answers, report.choices);
  if (answer == "refuse") return;  // said when they are stacked
  for (std::size_t n = 0; n < positions_mm.size(); ++n) {
    positions_mm[n] += normal * (locations_mm[n] - sorted.front());
  }
  report.findings.push_back({code::kOneLocation,
                             Severity::repair,
                             text,
                             {},
                             tr("They were placed by their slice locations, as was chosen")});
}

SeriesPlan checkGeometry(Series& series, const Answers& answers, Findings& findings) {
  SeriesPlan plan;
  const auto nowhere =
      findings.slicesWhere([](const DicomHeader& h) { return h.has_pixels && !isPlaced(h); });
  if (!nowhere.empty()) {
    findings.refuse(
        code::kNoGeometry,
        trCount(nowhere.size(), "{} slice lacks a usable position, orientation or pixel spacing",
                "{} slices lack a usable position, orientation or pixel spacing"),
        tr("Export the series again with its geometry"), nowhere);
    return plan;
  }
  Headers placed, unplaced, lost;
  for (const DicomHeader& header : series.slices) {
    (isPlaced(header) ? placed : unplaced).push_back(&header);
  }
  SeriesReport& report = series.report;
  placed = chooseParts(series, std::move(placed), answers, report, findings);
  if (!placed.empty()) {
    const auto whole = std::ranges::find_if(placed, [](const auto* h) { return h->has_pixels; });
    const DicomHeader& first = whole == placed.end() ? *placed.front() : **whole;
    std::vector<std::size_t> used(placed.size());
    for (std::size_t n = 0; n < used.size(); ++n) used[n] = n;
    std::vector<Vec3> positions_mm;
    for (const DicomHeader* h : placed) positions_mm.push_back(*h->position_mm);
    if (const auto axes = axesOf(*first.orientation)) {
      const Vec3 normal = (*axes)[2];
      placeByLocation(placed, normal, answers, positions_mm, report);
      Headers scanned = placed;
      orderAsScanned(scanned, normal);
      std::vector<Vec3> apart_mm;
      for (const DicomHeader* h : scanned) apart_mm.push_back(*h->position_mm);
      if (std::optional<Finding> rounded = takeApart(apart_mm, normal, statedStep_mm(scanned))) {
        placed = std::move(scanned);
        positions_mm = std::move(apart_mm);
        report.findings.push_back(*std::move(rounded));
      }
      std::vector<double> places_mm;
      for (const Vec3& position : positions_mm) places_mm.push_back(glm::dot(position, normal));
      used = chooseRepeats(placed, places_mm, answers, series.slices, report);
    }
    StackInput input{first.rows, first.columns, *first.pixel_spacing_mm, *first.orientation, {}, {},
                     ""};
    for (const std::size_t n : used) {
      input.positions_mm.push_back(positions_mm[n]);
      input.usable.push_back(!isLost(*placed[n]));
      if (isLost(*placed[n])) lost.push_back(placed[n]);
    }
    Headers taken;
    for (const std::size_t n : used) taken.push_back(placed[n]);
    const bool joined = std::ranges::any_of(
        taken, [&](const DicomHeader* h) { return h->part != taken.front()->part; });
    if (joined) takeMeanOrientation(taken, input);
    const DicomHeader& typical = *taken[taken.size() / 2];
    input.spacing_between_mm = typical.spacing_between_mm;
    input.thickness_mm = typical.thickness_mm;
    input.lost_text = lostText(lost);
    if (const auto axes = axesOf(*first.orientation)) {
      input.numbered_on = areNumberedOn(taken, (*axes)[2]);
    }
    plan.stack = stackSlices(input, answers);
    report.geometry = plan.stack.geometry;
    report.tilt_deg = plan.stack.tilt_deg;
    std::ranges::move(plan.stack.findings, std::back_inserter(report.findings));
    std::ranges::move(plan.stack.choices, std::back_inserter(report.choices));
    Headers in_order;
    for (const std::size_t n : plan.stack.order) {
      in_order.push_back(taken[n]);
      plan.sources.push_back(std::size_t(taken[n] - series.slices.data()));
    }
    // Else it is no stack, as is said already.
    if (plan.stack.geometry.size[2] > 1 && plan.stack.places_mm.size() == in_order.size()) {
      checkAcquisition(in_order, answers, findings);
      checkDensity(in_order, plan.stack, answers, findings);
      checkContradictions(in_order, plan.stack, answers, findings);
    }
  }
  checkUnplaced(unplaced, !placed.empty(), answers, report, findings);
  return plan;
}

// By place where every slice has one, else by instance number.
void orderSlices(std::vector<DicomHeader>& slices) {
  std::ranges::stable_sort(slices, {}, [](const DicomHeader& header) {
    return parseInteger(header.instance_number).value_or(std::numeric_limits<int>::max());
  });
  const auto first = std::ranges::find_if(slices, isPlaced);
  if (first == slices.end()) return;
  const auto axes = axesOf(*first->orientation);
  if (!axes) return;
  std::ranges::stable_sort(slices, {}, [&](const DicomHeader& header) {
    return isPlaced(header) ? glm::dot(*header.position_mm, (*axes)[2])
                            : std::numeric_limits<double>::max();
  });
}

double readingMb(const SeriesPlan& plan, const SeriesReport& report) {
  std::size_t voxels = report.geometry.voxelCount();
  if (!plan.stack.oneToOne()) {
    voxels += plan.sources.size() * std::size_t(report.geometry.size[0]) *
              std::size_t(report.geometry.size[1]);
  }
  return voxelsMb(voxels);
}

}  // namespace

SeriesPlan assessSeries(Series& series, const Answers& answers) {
  SeriesReport& report = series.report;
  report.findings.resize(series.findings_kept);
  report.choices.clear();
  report.phases = 1;
  Findings findings(series);
  orderSlices(series.slices);
  const DicomHeader& first = typicalSlice(series.slices);
  report.description = first.description;
  report.body_part = first.body_part;
  report.modality = first.modality.empty() && isCt(first) ? "CT" : first.modality;
  report.transfer_syntax = cleanUtf8(first.transfer_syntax);
  report.slices = int(series.slices.size());
  report.geometry = {};
  report.geometry.size = {first.columns, first.rows, std::int32_t(series.slices.size())};
  report.geometry.spacing_mm = Vec3(0.0);
  if (first.pixel_spacing_mm) {
    report.geometry.spacing_mm.x = (*first.pixel_spacing_mm)[1];
    report.geometry.spacing_mm.y = (*first.pixel_spacing_mm)[0];
  }
  report.lossy = std::ranges::any_of(series.slices, &DicomHeader::lossy);

  SeriesPlan plan;
  if (!refusedByKind(first, findings)) {
    checkTransferSyntax(series, findings);
    checkValues(series, findings);
    checkKind(series, answers);
    checkLoss(answers, findings);
    checkSizes(series, findings);
    checkSlopes(answers, findings);
    checkBits(series, findings);
    checkNames(series.slices, findings);
    plan = checkGeometry(series, answers, findings);
    plan.whole_words = answerTo(answers, code::kHighBits) == "use";
    checkConcatenation(series.slices, answers, report.choices, findings);
    if (const Status size = checkSize(report.geometry.size, ""); !size) {
      findings.refuse(size.error().code == code::kTooLarge ? code::kTooLarge : code::kPixelFormat,
                      size.error().what, size.error().next);
    }
    report.reading_mb = readingMb(plan, report);
    report.memory_mb = memoryMb(report, {});
  }
  // Answers that cannot save the series are not asked for.
  const auto asked = [&](const Finding& finding) {
    return finding.severity != Severity::refusal ||
           std::ranges::find(report.choices, finding.code, &Choice::code) != report.choices.end();
  };
  if (!std::ranges::all_of(report.findings, asked)) report.choices.clear();
  assignVerdict(series);
  return plan;
}

}  // namespace trephine
