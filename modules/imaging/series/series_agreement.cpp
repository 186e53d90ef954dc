#include "imaging/series/detail/series_agreement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/tr.h"
#include "imaging/codes.h"

namespace trephine {

namespace {

// Whether slices of different parts lie at one place: then they are scans of the same, not one
// scan.
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

std::string inCapitals(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
  }
  return text;
}

}  // namespace

Headers chooseParts(const Series& series, Headers placed, const Answers& answers,
                    SeriesReport& report, Findings& findings) {
  constexpr int kMostOffered = 9;
  if (series.parted_by.empty() || placed.empty()) return placed;
  std::map<int, std::size_t> counts;
  for (const DicomHeader* header : placed) ++counts[header->part];
  const bool joinable = !overlap(placed);
  Choice choice{code::kParts,
                tr("The slices do not say that they are of one scan. How shall they be used?"),
                {"refuse"},
                {tr("Do not use the series")}};
  const std::string differing = listed(series.parted_by);
  if (joinable) {
    choice.options.push_back("join");
    choice.words.push_back(
        tr("Join all {}: it is assumed that they are one scan of one patient who lay still, "
           "whatever is said of {}",
           slicesText(placed.size()), differing));
  }
  for (const auto& [part, count] : counts) {
    if (part >= kMostOffered || count < 2) continue;
    choice.options.push_back(std::to_string(part + 1));
    choice.words.push_back(
        tr("Use only part {}: {} of {}", part + 1, count, slicesText(placed.size())));
  }
  const bool offers_part = choice.options.size() > 2;
  const std::string text =
      trCount(counts.size(), "The series falls into {} part that differs in {}",
              "The series falls into {} parts that differ in {}", differing);
  const std::string answer = ask(std::move(choice), answers, report.choices);
  if (answer == "join") {
    findings.repaired(
        code::kParts, text,
        tr("They were joined: it was assumed that they are one scan of one patient who "
           "lay still"));
    return placed;
  }
  if (answer == "refuse") {
    findings.refuse(code::kParts, text,
                    !joinable     ? tr("Choose a part of the series")
                    : offers_part ? tr("Join them, or choose a part")
                                  : tr("Join them, or use another series"));
    if (joinable) return placed;
  }
  const int wanted = answer == "refuse" ? 0 : *parseInteger(answer) - 1;
  const std::size_t whole = placed.size();
  std::erase_if(placed, [&](const DicomHeader* header) { return header->part != wanted; });
  if (answer != "refuse") {
    findings.repaired(code::kParts, text,
                      tr("Part {} was taken, {} of {}; the others were left out", answer,
                         placed.size(), slicesText(whole)));
  }
  return placed;
}

void checkAcquisition(const Headers& used, const Answers& answers, Findings& findings) {
  std::vector<std::string> differing, unsaid, odd_ones;
  // Slices that say another thing than most do.
  const auto unlikeMost = [&](const auto& key) {
    std::map<std::string, int> counts;
    for (const DicomHeader* header : used) ++counts[key(*header)];
    const auto most = std::ranges::max_element(counts, {}, [](const auto& c) { return c.second; });
    for (const DicomHeader* header : used) {
      if (key(*header) == most->first) continue;
      const std::string name = sliceName(*header);
      if (std::ranges::find(odd_ones, name) == odd_ones.end()) odd_ones.push_back(name);
    }
  };
  // Absent values contradict nothing, and small letters are those that somebody typed.
  const auto words = [&](const char* name, bool shown, const auto& value) {
    const auto key = [&](const DicomHeader& header) { return inCapitals(value(header)); };
    std::map<std::string, std::pair<std::string, int>> said;
    int silent = 0;
    for (const DicomHeader* header : used) {
      const std::string text = value(*header);
      if (text.empty()) {
        ++silent;
        continue;
      }
      auto& [first, count] = said[inCapitals(text)];
      if (count++ == 0) first = text;
    }
    if (!said.empty() && silent > 0) unsaid.push_back(tr("{} in {}", tr(name), silent));
    if (said.size() < 2) return;
    std::vector<std::string> some;
    for (const auto& [key_, one] : said) {
      if (some.size() == 3) {
        some.push_back(tr("others"));
        break;
      }
      some.push_back(tr("{} in {}", shownTerm(one.first), one.second));
    }
    differing.push_back(tr(name) + (shown ? " (" + listed(some) + ")" : ""));
    unlikeMost(key);
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
    differing.push_back(
        tr("{} ({} to {} {})", tr(name), fixedText(*least, 2), fixedText(*most, 2), unit));
    unlikeMost([&](const DicomHeader& h) { return fixedText((h.*value).value_or(0.0), 3); });
  };
  words(trLater("convolution kernel"), true, [](const DicomHeader& h) { return h.kernel; });
  numbers(trLater("tube voltage"), "kV", 0.01, &DicomHeader::kvp);
  numbers(trLater("slice thickness"), "mm", 0.01, &DicomHeader::thickness_mm);
  // From the fourth on its values are the maker's own.
  words(trLater("image type"), true, [](const DicomHeader& h) {
    std::string text;
    for (std::size_t n = 0; n < std::min<std::size_t>(h.image_type.size(), 3); ++n) {
      text += (text.empty() ? "" : "\\") + h.image_type[n];
    }
    return text;
  });
  // What may hold a name is not shown.
  words(trLater("series description"), false, [](const DicomHeader& h) { return h.description; });
  words("scanner", false, [](const DicomHeader& h) { return h.scanner; });
  words(trLater("position of the patient"), true,
        [](const DicomHeader& h) { return h.patient_position; });
  words(trLater("contrast agent"), false, [](const DicomHeader& h) { return h.contrast; });
  if (!unsaid.empty()) {
    findings.notice(code::kPartlySaid,
                    tr("Not all slices say how they were made: absent are {}", listed(unsaid)),
                    tr("What is absent was taken to be as in the others"));
  }
  if (differing.empty()) return;
  const std::string text =
      tr("The slices were not all made in one way: they differ in {}", listed(differing));
  findings.askConsent(
      {code::kMixedSlices,
       tr("The slices were not all made in one way. Use them as one volume?"),
       {"refuse", "accept"},
       {tr("Do not use the series"), tr("Use them as one volume: equal tissue may differ in HU and "
                                        "sharpness from slice to slice")}},
      answers, text, tr("They were taken as one volume, as was agreed"),
      tr("Use a series of one acquisition, or agree to take them as one"), odd_ones);
}

void checkDensity(const Headers& used, const Stack& stack, const Answers& answers,
                  Findings& findings) {
  constexpr std::size_t kFewest = 4;
  constexpr double kWidestStep_mm = 20.01, kMostThicknesses = 5.0;
  if (used.empty()) return;
  const double step_mm = stack.geometry.spacing_mm.z;
  double thickness_mm = 0.0;
  for (const DicomHeader* header : used) {
    thickness_mm = std::max(thickness_mm, header->thickness_mm.value_or(0.0));
  }
  std::vector<std::string> why;
  const bool few = used.size() < kFewest;
  if (few) why.push_back(tr("there are only {}", used.size()));
  if (step_mm > kWidestStep_mm) why.push_back(tr("they lie {} apart", lengthText(step_mm)));
  if (thickness_mm > 0.0 && step_mm >= kMostThicknesses * thickness_mm) {
    why.push_back(tr("each is {} thick and the next is {} away", lengthText(thickness_mm),
                     lengthText(step_mm)));
  }
  if (why.empty()) {
    if (thickness_mm > 0.0 && step_mm > 1.05 * thickness_mm) {
      findings.notice(
          code::kGapsBetweenSlices,
          tr("The slices are {} thick and lie {} apart: what lies between was not scanned",
             lengthText(thickness_mm), lengthText(step_mm)),
          tr("It is interpolated where the volume is drawn and cut"));
    }
    return;
  }
  const std::string text = tr("The slices are too few or too far apart to be cut: {}", listed(why));
  findings.askConsent(
      {code::kSparseSlices,
       tr("The slices are too few or too far apart to be cut. Use them all the same?"),
       {"refuse", "accept"},
       {tr("Do not use the series"),
        few ? tr("Use them: they cover next to nothing")
            : tr("Use them: what lies between them was not scanned and is only guessed")}},
      answers, text, tr("They were used all the same, as was agreed"),
      few ? tr("Choose a series that covers the anatomy") : tr("Choose a series of thin slices"));
}

void checkContradictions(const Headers& in_order, const Stack& stack, const Answers& answers,
                         Findings& findings) {
  constexpr double kTilt_deg = 1.0;
  if (in_order.size() < 2) return;
  const double step_mm = stack.geometry.spacing_mm.z;  // along the normal
  const double slant = 1.0 / std::cos(stack.tilt_deg * std::numbers::pi / 180.0);
  const auto near = [](double a, double b, double tolerance) {
    return std::abs(a - b) <= tolerance;
  };

  // Steps of the slice location against those of the positions, along the normal or the table.
  // Slices without one are passed over; a location that never changes says nothing, and one in
  // whole millimetres may be off by as much as one.
  std::vector<std::size_t> located;
  for (std::size_t n = 0; n < in_order.size(); ++n) {
    if (in_order[n]->location_mm) located.push_back(n);
  }
  const auto location_mm = [&](std::size_t n) { return *in_order[n]->location_mm; };
  const bool whole = std::ranges::all_of(
      located, [&](std::size_t n) { return location_mm(n) == std::round(location_mm(n)); });
  const bool constant = std::ranges::all_of(
      located, [&](std::size_t n) { return location_mm(n) == location_mm(located.front()); });
  double worst_mm = 0.0, said_mm = 0.0, is_mm = 0.0, drift_mm = 0.0;
  for (std::size_t i = 1; i < located.size() && !constant; ++i) {
    const std::size_t from = located[i - 1], to = located[i];
    const auto off_mm = [&](std::size_t first) {
      const Vec3 moved = *in_order[to]->position_mm - *in_order[first]->position_mm;
      const double said = std::abs(location_mm(to) - location_mm(first));
      double off = std::abs(said - std::abs(stack.places_mm[to] - stack.places_mm[first]));
      // Along the table, or as a coordinate.
      const double length = glm::length(moved);
      for (const double is : {length, std::abs(moved.x), std::abs(moved.y), std::abs(moved.z)}) {
        if (is >= 0.5 * length) off = std::min(off, std::abs(said - is));
      }
      return off;
    };
    drift_mm = std::max(drift_mm, off_mm(located.front()));
    if (const double off = off_mm(from); off > worst_mm) {
      worst_mm = off;
      said_mm = std::abs(location_mm(to) - location_mm(from));
      is_mm = stack.places_mm[to] - stack.places_mm[from];
    }
  }
  if (whole && drift_mm <= 1.0) worst_mm = 0.0;
  if (worst_mm > std::max(0.15, 0.1 * step_mm)) {
    const std::string text =
        tr("The slice locations contradict the positions: between two slices {} by position and {} "
           "by slice location",
           lengthText(is_mm), lengthText(said_mm));
    findings.askConsent(
        {code::kLocationMismatch,
         tr("Slice locations and positions contradict each other. Believe the positions?"),
         {"refuse", "positions"},
         {tr("Do not use the series"),
          tr("Believe the positions: if they are wrong, lengths in the volume are wrong")}},
        answers, text, tr("The positions were believed, as was agreed"),
        tr("Export the series again, or agree to believe the positions"));
  }
  std::optional<double> between_mm, tilt_deg;
  for (const DicomHeader* header : in_order) {
    // Of several that it says, the one that lies farthest off.
    const auto said = header->spacing_between_mm;
    if (said &&
        (!between_mm || std::abs(std::abs(*said) - step_mm) > std::abs(*between_mm - step_mm))) {
      between_mm = std::abs(*said);
    }
    if (header->tilt_deg) tilt_deg = std::abs(*header->tilt_deg);
  }
  const double tolerance_mm = std::max(0.05, 0.02 * step_mm);
  if (between_mm && !near(*between_mm, step_mm, tolerance_mm) &&
      !near(*between_mm, step_mm * slant, tolerance_mm)) {
    findings.repaired(code::kSpacingMismatch,
                      tr("The header says that slices lie {} apart, by their positions it is {}",
                         lengthText(*between_mm), lengthText(step_mm)),
                      tr("The positions were believed"));
  }
  if (tilt_deg && !near(*tilt_deg, stack.tilt_deg, kTilt_deg)) {
    findings.repaired(code::kTiltMismatch,
                      tr("The header says that the gantry was tilted by {} degrees, by the slices' "
                         "positions it is {}",
                         fixedText(*tilt_deg, 1), fixedText(stack.tilt_deg, 1)),
                      tr("The positions were believed"));
  }
}

void takeMeanOrientation(const Headers& used, StackInput& input) {
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

}  // namespace trephine
