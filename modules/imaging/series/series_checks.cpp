// What a series' headers say about it: kind, values, pixels, geometry. Each check adds a finding
// with its own code; README.md lists them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "imaging/common/text.h"
#include "imaging/dicom/transfer_syntax.h"
#include "imaging/series/series.h"
#include "imaging/series/series_geometry.h"
#include "imaging/series/series_kind.h"
#include "imaging/series/series_repeats.h"
#include "volume/case_memory.h"

namespace trephine {

namespace {

class Findings {
 public:
  explicit Findings(Series& series) : series_(series) {}

  void refuse(const char* code, std::string text, std::string action,
              std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, "refusal", std::move(text), std::move(slices), std::move(action)});
  }
  void repaired(const char* code, std::string text, std::string action,
                std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, "repair", std::move(text), std::move(slices), std::move(action)});
  }
  void notice(const char* code, std::string text, std::string action,
              std::vector<std::string> slices = {}) {
    series_.report.findings.push_back(
        {code, "notice", std::move(text), std::move(slices), std::move(action)});
  }
  // The names of all slices that `test` holds for.
  template <class Test>
  std::vector<std::string> slicesWhere(Test test) const {
    std::vector<std::string> names;
    for (const DicomHeader& header : series_.slices) {
      if (test(header)) names.push_back(sliceName(header));
    }
    return names;
  }

 private:
  Series& series_;
};

std::string countOfSlices(const std::vector<std::string>& slices, std::string_view one_does = "",
                          std::string_view many_do = "") {
  return counted(slices.size(), "slice", one_does, many_do);
}

// The slice that speaks for all: one with pixels where there is one, so with a whole header.
const DicomHeader& typicalSlice(const std::vector<DicomHeader>& slices) {
  const auto whole = std::ranges::find(slices, true, &DicomHeader::has_pixels);
  return whole == slices.end() ? slices.front() : *whole;
}

// Series of which no volume can come whatever their geometry. True where one of these it is.
bool refusedByKind(const DicomHeader& first, Findings& findings) {
  constexpr const char* kChooseCt = "Choose a CT series";
  const std::string& kind = first.sop_class;
  const bool secondary = kind.starts_with("1.2.840.10008.5.1.4.1.1.7");
  if (!first.has_pixels && first.defect == Defect::none) {
    findings.refuse(
        "NOT_AN_IMAGE_SERIES",
        (first.modality.empty() ? "The files" : "The files of this " + first.modality + " series") +
            std::string(" hold no pixels"),
        kChooseCt);
  } else if (secondary) {
    findings.refuse("SECONDARY_CAPTURE", "The series holds captured pictures, not slices",
                    kChooseCt);
  } else if (!isCt(first) || (!first.modality.empty() && first.modality != "CT")) {
    findings.refuse("NOT_CT",
                    "The series is " + (first.modality.empty() ? "no CT" : first.modality) +
                        ": its values are not HU",
                    kChooseCt);
  } else if (isLocalizer(first)) {
    findings.refuse("LOCALIZER", "The series is a localizer (scout), not a stack of slices",
                    kChooseCt);
  } else if (first.frames > 1 && !first.position_mm && first.defect != Defect::size_mismatch) {
    findings.refuse("MULTIFRAME",
                    "The series is stored as multi-frame pictures that do not say where each frame "
                    "lies",
                    "Export it as enhanced CT, or as classic CT with one file a slice");
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
    findings.refuse("UNSUPPORTED_TRANSFER_SYNTAX",
                    "The transfer syntax " + transferSyntaxName(uid) + " (" + cleanUtf8(uid) +
                        ") of " + counted(std::uint64_t(count), "slice") + " cannot be read",
                    "Export the series uncompressed (Explicit VR Little Endian)");
  }
}

void checkLoss(Series& series, const Answers& answers, Findings& findings) {
  const auto lossy = findings.slicesWhere([](const DicomHeader& h) { return h.lossy; });
  if (lossy.empty()) return;
  const std::string text = countOfSlices(lossy, "was", "were") + " compressed with loss";
  const std::string answer =
      ask({"LOSSY_SOURCE",
           "The series was compressed with loss: its HU are not those of the scanner. Use it?",
           {"refuse", "accept"},
           {"Do not use the series", "Use it for training, marked as lossy"}},
          answers, series.report.choices);
  if (answer == "accept") {
    findings.repaired("LOSSY_SOURCE", text,
                      "They were taken as they are, as was agreed: small differences of HU are "
                      "not real",
                      lossy);
  } else {
    findings.refuse("LOSSY_SOURCE", text, "Use the original series, or agree to the loss", lossy);
  }
}

void checkValues(const Series& series, Findings& findings) {
  const DicomHeader& first = typicalSlice(series.slices);
  const bool grey = first.photometric == "MONOCHROME1" || first.photometric == "MONOCHROME2";
  if (first.samples != 1 || (!grey && !first.photometric.empty())) {
    findings.refuse("COLOUR", "The pixels are colour (" + first.photometric + "), not HU",
                    "Export the original CT slices");
  }
  const auto odd_format = findings.slicesWhere([](const DicomHeader& h) {
    return h.has_pixels && h.samples == 1 &&
           (!h.holdsGreyWords() || h.ambiguous_order || h.photometric.empty());
  });
  if (!odd_format.empty()) {
    findings.refuse("PIXEL_FORMAT",
                    countOfSlices(odd_format, "does", "do") +
                        " not say 8 or 16 allocated bits, as many stored bits or fewer, rows and "
                        "columns up to 8192 and photometric interpretation as CT must",
                    "Export the series again as CT with 16-bit pixels", odd_format);
  }
  const auto not_hu = findings.slicesWhere([](const DicomHeader& h) {
    return h.has_pixels && !h.rescale_type.empty() && h.rescale_type != "HU" &&
           h.rescale_type != "US";
  });
  if (!not_hu.empty()) {
    findings.refuse("NOT_HU", "The values are " + first.rescale_type + ", not HU",
                    "Choose the series in HU", not_hu);
  }
  const auto bad =
      findings.slicesWhere([](const DicomHeader& h) { return h.has_pixels && h.rescale_bad; });
  if (!bad.empty()) {
    findings.refuse("BAD_RESCALE",
                    "The rescale slope or intercept of " + countOfSlices(bad) + " is no number",
                    "Export the series again", bad);
  }
  const auto raw = findings.slicesWhere(
      [](const DicomHeader& h) { return h.has_pixels && !h.intercept_given && !h.rescale_bad; });
  const auto scaled =
      findings.slicesWhere([](const DicomHeader& h) { return h.has_pixels && h.intercept_given; });
  if (!raw.empty() && !scaled.empty()) {
    findings.refuse(
        "BAD_RESCALE",
        countOfSlices(raw, "lacks", "lack") + " the rescale intercept that the others have",
        "Export the series again", raw);
  }
  const auto unscaled = findings.slicesWhere(
      [](const DicomHeader& h) { return h.has_pixels && !h.rescale_given && !h.rescale_bad; });
  if (!unscaled.empty()) {
    findings.notice(
        "RESCALE_DEFAULT",
        countOfSlices(unscaled, "lacks", "lack") + " a rescale slope (or have 0) or intercept",
        "Slope 1 and intercept 0 were taken where absent", unscaled);
  }
  if (first.photometric == "MONOCHROME1") {
    findings.notice("MONOCHROME1", "The series is meant to be shown with white for low values",
                    "The HU are not touched by that");
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
  findings.refuse(
      "SIZE_MISMATCH",
      countOfSlices(mismatched, "contradicts itself (", "contradict themselves (the last: ") +
          text + ")",
      "Export the series again", mismatched);
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
  std::string text = "; " + std::to_string(lost.size()) + " of these cannot be read:";
  for (std::size_t n = 0; n < std::min<std::size_t>(lost.size(), 5); ++n) {
    text += (n == 0 ? " " : ", ") + sliceName(*lost[n]);
  }
  if (lost.size() > 5) text += " and others";
  const std::string& why = lost.back()->defect_text;
  return text + " (" + (why.empty() ? "it has no pixels" : why) + ")";
}

// Slices that are cut before they say where they lie: their gap may not show.
void checkUnplaced(const std::vector<const DicomHeader*>& lost, bool others_are_placed,
                   const Answers& answers, SeriesReport& report, Findings& findings) {
  if (lost.empty()) return;
  std::vector<std::string> names;
  for (const DicomHeader* header : lost) names.push_back(sliceName(*header));
  const std::string& why = lost.back()->defect_text;
  const std::string text = countOfSlices(names) + " cannot be read, and " +
                           (names.size() == 1 ? "its place is" : "their places are") +
                           " not known (" + (why.empty() ? "it has no pixels" : why) + ")";
  const auto given = answers.find("MISSING_SLICES");
  const bool agreed = others_are_placed && given != answers.end() && given->second != "refuse";
  const bool asked =
      std::ranges::find(report.choices, "MISSING_SLICES", &Choice::code) != report.choices.end();
  if (!asked && others_are_placed) {
    report.choices.push_back({"MISSING_SLICES",
                              "Slices are damaged before they say where they belong. Use the rest?",
                              {"refuse", "part"},
                              {"Do not use the series", "Use it without them"}});
  }
  if (agreed) {
    findings.repaired("MISSING_SLICES", text, "They were left out", names);
  } else {
    findings.refuse("MISSING_SLICES", text, "Copy these files again from their source", names);
  }
}

using Headers = std::vector<const DicomHeader*>;

// Whether slices of different parts lie at one place: then they are scans of the same, not one scan.
bool overlap(const Headers& placed) {
  const auto axes = axesOf(*placed.front()->orientation);
  if (!axes) return true;
  Headers sorted = placed;
  const auto place_mm = [&](const DicomHeader* h) { return glm::dot(*h->position_mm, (*axes)[2]); };
  std::ranges::sort(sorted, {}, place_mm);
  for (std::size_t n = 1; n < sorted.size(); ++n) {
    if (sorted[n]->part != sorted[n - 1]->part &&
        place_mm(sorted[n]) - place_mm(sorted[n - 1]) <= kSamePlace_mm) {
      return true;
    }
  }
  return false;
}

// Of a series in parts those that are wanted: all, joined, or one of them.
Headers chooseParts(const Series& series, Headers placed, const Answers& answers,
                    SeriesReport& report, Findings& findings) {
  constexpr int kMostOffered = 9;
  if (series.parted_by.empty() || placed.empty()) return placed;
  std::map<int, std::size_t> counts;
  for (const DicomHeader* header : placed) ++counts[header->part];
  const bool joinable = !overlap(placed);
  Choice choice{"PARTS",
                "The slices do not say that they are of one scan. How shall they be used?",
                {"refuse"},
                {"Do not use the series"}};
  const std::string differing = listed(series.parted_by);
  if (joinable) {
    choice.options.push_back("join");
    choice.words.push_back("Join all " + counted(placed.size(), "slice") +
                           ": it is assumed that they are one scan of one patient who lay "
                           "still, whatever the " +
                           differing + " say");
  }
  for (const auto& [part, count] : counts) {
    if (part >= kMostOffered || count < 2) continue;
    choice.options.push_back(std::to_string(part + 1));
    choice.words.push_back("Use only part " + std::to_string(part + 1) + ": " +
                           std::to_string(count) + " of " + counted(placed.size(), "slice"));
  }
  const std::string text = "The series falls into " + std::to_string(counts.size()) +
                           " parts that differ in " + differing;
  const std::string answer = ask(std::move(choice), answers, report.choices);
  if (answer == "join") {
    findings.repaired("PARTS", text,
                      "They were joined: it was assumed that they are one scan of one patient who "
                      "lay still");
    return placed;
  }
  if (answer == "refuse") {
    findings.refuse("PARTS", text,
                    joinable ? "Join them, or choose a part" : "Choose a part of the series");
    if (joinable) return placed;
  }
  const int wanted = answer == "refuse" ? 0 : *parseInteger(answer) - 1;
  const std::size_t whole = placed.size();
  std::erase_if(placed, [&](const DicomHeader* header) { return header->part != wanted; });
  if (answer != "refuse") {
    findings.repaired("PARTS", text,
                      "Part " + answer + " was taken, " + std::to_string(placed.size()) + " of " +
                          counted(whole, "slice") + "; the others were left out");
  }
  return placed;
}

// What slices of one volume must share beyond their geometry.
void checkAcquisition(const Headers& used, const Answers& answers, SeriesReport& report,
                      Findings& findings) {
  std::vector<std::string> differing;
  // Absent values contradict nothing.
  const auto words = [&](const char* name, bool shown, const auto& value) {
    std::map<std::string, int> counts;
    for (const DicomHeader* header : used) {
      if (const std::string text = value(*header); !text.empty()) ++counts[text];
    }
    if (counts.size() < 2) return;
    std::vector<std::string> some;
    for (const auto& [text, count] : counts) {
      if (some.size() == 3) {
        some.push_back("others");
        break;
      }
      some.push_back(text + " in " + std::to_string(count));
    }
    differing.push_back(name + (shown ? " (" + listed(some) + ")" : ""));
  };
  const auto numbers = [&](const char* name, const char* unit, double tolerance,
                           std::optional<double> DicomHeader::*value) {
    std::optional<double> least, most;
    for (const DicomHeader* header : used) {
      if (!(header->*value)) continue;
      least = std::min(least.value_or(*(header->*value)), *(header->*value));
      most = std::max(most.value_or(*(header->*value)), *(header->*value));
    }
    if (!least || *most - *least <= tolerance * std::max(std::abs(*least), std::abs(*most))) return;
    differing.push_back(name + (" (" + fixedText(*least, 2) + " to ") + fixedText(*most, 2) + " " +
                        unit + ")");
  };
  words("convolution kernel", true, [](const DicomHeader& h) { return h.kernel; });
  numbers("tube voltage", "kV", 0.01, &DicomHeader::kvp);
  numbers("slice thickness", "mm", 0.01, &DicomHeader::thickness_mm);
  words("image type", true, [](const DicomHeader& h) {
    std::string text;
    for (const std::string& value : h.image_type) text += (text.empty() ? "" : "\\") + value;
    return text;
  });
  // A description may hold a name.
  words("series description", false, [](const DicomHeader& h) { return h.description; });
  if (differing.empty()) return;
  const std::string text = "The slices were not all made in one way: they differ in " +
                           listed(differing);
  const std::string answer =
      ask({"MIXED_SLICES",
           "The slices were not all made in one way. Use them as one volume?",
           {"refuse", "accept"},
           {"Do not use the series", "Use them as one volume: equal tissue may differ in HU and "
                                     "sharpness from slice to slice"}},
          answers, report.choices);
  if (answer == "accept") {
    findings.repaired("MIXED_SLICES", text, "They were taken as one volume, as was agreed");
  } else {
    findings.refuse("MIXED_SLICES", text,
                    "Use a series of one acquisition, or agree to take them as one");
  }
}

// Whether there are enough slices, near enough to each other, to be cut.
void checkDensity(const Headers& used, const Stack& stack, const Answers& answers,
                  SeriesReport& report, Findings& findings) {
  constexpr std::size_t kFewest = 4;
  constexpr double kWidestStep_mm = 20.0, kMostThicknesses = 5.0;
  if (used.empty()) return;
  const double step_mm = stack.geometry.spacing_mm.z;
  double thickness_mm = 0.0;
  for (const DicomHeader* header : used) {
    thickness_mm = std::max(thickness_mm, header->thickness_mm.value_or(0.0));
  }
  std::vector<std::string> why;
  if (used.size() < kFewest) why.push_back("there are only " + std::to_string(used.size()));
  if (step_mm > kWidestStep_mm) why.push_back("they lie " + placeText(step_mm) + " apart");
  if (thickness_mm > 0.0 && step_mm >= kMostThicknesses * thickness_mm) {
    why.push_back("each is " + placeText(thickness_mm) + " thick and the next is " +
                  placeText(step_mm) + " away");
  }
  if (why.empty()) {
    if (thickness_mm > 0.0 && step_mm > 1.05 * thickness_mm) {
      findings.notice("GAPS_BETWEEN_SLICES",
                      "The slices are " + placeText(thickness_mm) + " thick and lie " +
                          placeText(step_mm) + " apart: what lies between was not scanned",
                      "It is interpolated where the volume is drawn and cut");
    }
    return;
  }
  const std::string text = "The slices are too few or too far apart to be cut: " + listed(why);
  const std::string answer =
      ask({"SPARSE_SLICES",
           "The slices are too few or too far apart to be cut. Use them all the same?",
           {"refuse", "accept"},
           {"Do not use the series",
            "Use them: what lies between them was not scanned and is only guessed"}},
          answers, report.choices);
  if (answer == "accept") {
    findings.repaired("SPARSE_SLICES", text, "They were used all the same, as was agreed");
  } else {
    findings.refuse("SPARSE_SLICES", text, "Choose a series of thin slices");
  }
}

// What headers say of where slices lie, beside their positions.
void checkContradictions(const Headers& in_order, const Stack& stack, const Answers& answers,
                         SeriesReport& report, Findings& findings) {
  constexpr double kTilt_deg = 1.0;
  if (in_order.size() < 2) return;
  const double step_mm = stack.geometry.spacing_mm.z;  // along the normal
  const double slant = 1.0 / std::cos(stack.tilt_deg * std::numbers::pi / 180.0);
  const auto near = [](double a, double b, double tolerance) {
    return std::abs(a - b) <= tolerance;
  };

  // Steps of the slice location against those of the positions, along the normal or the table.
  double worst_mm = 0.0, said_mm = 0.0, is_mm = 0.0;
  for (std::size_t n = 1; n < in_order.size(); ++n) {
    const auto &a = in_order[n - 1]->location_mm, &b = in_order[n]->location_mm;
    if (!a || !b) continue;
    const double said = std::abs(*b - *a), is = stack.places_mm[n] - stack.places_mm[n - 1];
    const double off = std::min(std::abs(said - is), std::abs(said - is * slant));
    if (off > worst_mm) {
      worst_mm = off;
      said_mm = said;
      is_mm = is;
    }
  }
  if (worst_mm > std::max(0.15, 0.1 * step_mm)) {
    const std::string text = "The slice locations contradict the positions: between two slices " +
                             placeText(is_mm) + " by position and " + placeText(said_mm) +
                             " by slice location";
    const std::string answer =
        ask({"LOCATION_MISMATCH",
             "Slice locations and positions contradict each other. Believe the positions?",
             {"refuse", "positions"},
             {"Do not use the series",
              "Believe the positions: if they are wrong, lengths in the volume are wrong"}},
            answers, report.choices);
    if (answer == "positions") {
      findings.repaired("LOCATION_MISMATCH", text, "The positions were believed, as was agreed");
    } else {
      findings.refuse("LOCATION_MISMATCH", text,
                      "Export the series again, or agree to believe the positions");
    }
  }
  std::optional<double> between_mm, tilt_deg;
  for (const DicomHeader* header : in_order) {
    if (header->spacing_between_mm) between_mm = std::abs(*header->spacing_between_mm);
    if (header->tilt_deg) tilt_deg = std::abs(*header->tilt_deg);
  }
  const double tolerance_mm = std::max(0.05, 0.02 * step_mm);
  if (between_mm && !near(*between_mm, step_mm, tolerance_mm) &&
      !near(*between_mm, step_mm * slant, tolerance_mm)) {
    findings.repaired("SPACING_MISMATCH",
                      "The header says that slices lie " + placeText(*between_mm) +
                          " apart, by their positions it is " + placeText(step_mm),
                      "The positions were believed");
  }
  if (tilt_deg && !near(*tilt_deg, stack.tilt_deg, kTilt_deg)) {
    findings.repaired("TILT_MISMATCH",
                      "The header says that the gantry was tilted by " + fixedText(*tilt_deg, 1) +
                          " degrees, by the slices' positions it is " +
                          fixedText(stack.tilt_deg, 1),
                      "The positions were believed");
  }
}

// The same for all of a stack: of a joined one the mean, which is nearest to all.
void takeOrientation(const Headers& used, bool joined, StackInput& input) {
  if (!joined) return;
  const double share = 1.0 / double(used.size());
  input.pixel_spacing_mm.fill(0.0);
  input.orientation.fill(0.0);
  for (const DicomHeader* header : used) {
    for (std::size_t n = 0; n < 2; ++n) {
      input.pixel_spacing_mm[n] += share * (*header->pixel_spacing_mm)[n];
    }
    for (std::size_t n = 0; n < 6; ++n) input.orientation[n] += share * (*header->orientation)[n];
  }
}

SeriesPlan checkGeometry(Series& series, const Answers& answers, Findings& findings) {
  SeriesPlan plan;
  const auto nowhere =
      findings.slicesWhere([](const DicomHeader& h) { return h.has_pixels && !isPlaced(h); });
  if (!nowhere.empty()) {
    findings.refuse("NO_GEOMETRY",
                    countOfSlices(nowhere, "lacks", "lack") +
                        " a usable position, orientation or pixel spacing",
                    "Export the series again with its geometry", nowhere);
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
    if (const auto axes = axesOf(*first.orientation)) {
      std::vector<double> places_mm;
      for (const DicomHeader* h : placed) {
        places_mm.push_back(glm::dot(*h->position_mm, (*axes)[2]));
      }
      used = chooseRepeats(placed, places_mm, answers, series.slices, report);
    }
    StackInput input{first.rows, first.columns, *first.pixel_spacing_mm, *first.orientation, {}, {},
                     ""};
    for (const std::size_t n : used) {
      input.positions_mm.push_back(*placed[n]->position_mm);
      input.usable.push_back(!isLost(*placed[n]));
      if (isLost(*placed[n])) lost.push_back(placed[n]);
    }
    Headers taken;
    for (const std::size_t n : used) taken.push_back(placed[n]);
    const bool joined = std::ranges::any_of(
        taken, [&](const DicomHeader* h) { return h->part != taken.front()->part; });
    takeOrientation(taken, joined, input);
    const DicomHeader& typical = *taken[taken.size() / 2];
    input.spacing_between_mm = typical.spacing_between_mm;
    input.thickness_mm = typical.thickness_mm;
    input.lost_text = lostText(lost);
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
    if (plan.stack.geometry.size[2] > 1) {  // else it is no stack, as is said already
      checkAcquisition(in_order, answers, report, findings);
      checkDensity(in_order, plan.stack, answers, report, findings);
      checkContradictions(in_order, plan.stack, answers, report, findings);
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
    checkLoss(series, answers, findings);
    checkSizes(series, findings);
    plan = checkGeometry(series, answers, findings);
    if (const Status size = checkSize(report.geometry.size, ""); !size) {
      findings.refuse(size.error().code == "TOO_LARGE" ? "TOO_LARGE" : "PIXEL_FORMAT",
                      size.error().what, size.error().next);
    }
    report.reading_mb = readingMb(plan, report);
    report.memory_mb = memoryMb(report, {});
  }
  // Answers that cannot save the series are not asked for.
  const auto asked = [&](const Finding& finding) {
    return finding.severity != "refusal" ||
           std::ranges::find(report.choices, finding.code, &Choice::code) != report.choices.end();
  };
  if (!std::ranges::all_of(report.findings, asked)) report.choices.clear();
  conclude(series);
  return plan;
}

}  // namespace trephine
