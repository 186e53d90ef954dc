#include "imaging/series/detail/series_repeats.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "base/range.h"
#include "base/sha256.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/common/workers.h"
#include "imaging/dicom/detail/dicom_pixels.h"
#include "imaging/series/detail/series_geometry.h"

namespace trephine {

namespace {

constexpr int kMostPhases = 100;
constexpr std::size_t kMostCompared = 64;  // repeats that are read while the folder is scanned

// [first, last) of the slices at each place.
struct Place {
  std::size_t first, last;
  std::size_t count() const { return last - first; }
};

std::vector<Place> placesOf(const std::vector<double>& places_mm) {
  std::vector<Place> places;
  for (std::size_t n = 0; n < places_mm.size(); ++n) {
    if (n == 0 || places_mm[n] - places_mm[n - 1] > kSamePlace_mm) places.push_back({n, n});
    places.back().last = n + 1;
  }
  return places;
}

// What may tell the scans of a series apart, in the order in which it is asked.
constexpr const char* kKernelKey = trLater("convolution kernel");

struct Key {
  const char* name;
  std::function<std::optional<double>(const DicomHeader&)> of;
  const char* unit = "";  // in which its value is said; empty: it is not
};

// Two reconstructions of one scan share all their times.
std::vector<Key> keysOf(const std::vector<const DicomHeader*>& slices) {
  std::map<std::string, double> kernels;  // by name, numbered
  for (const DicomHeader* slice : slices) kernels[slice->kernel];
  double number = 0.0;
  for (auto& [kernel, its] : kernels) its = number++;
  std::vector<Key> keys{{kKernelKey, [kernels](const DicomHeader& h) {
                           return h.kernel.empty() ? std::nullopt
                                                   : std::optional(kernels.at(h.kernel));
                         }}};
  keys.push_back({trLater("tube voltage"), [](const DicomHeader& h) { return h.kvp; }, " kV"});
  constexpr std::pair<const char*, const char*> kNames[kPhaseKeys] = {
      {trLater("temporal position"), ""},
      {trLater("cardiac phase"), trLater(" % of the cycle")},
      {"acquisition", ""},
      {trLater("trigger time"), " ms"},
      {trLater("trigger delay"), " ms"},
      {trLater("acquisition time"), ""},
      {trLater("content time"), ""}};
  for (std::size_t key = 0; key < kPhaseKeys; ++key) {
    const auto& [name, unit] = kNames[key];
    keys.push_back({name, [key](const DicomHeader& h) { return h.phase[key]; }, unit});
  }
  return keys;
}

// Whether the series was scanned more than once, rather than that some slices repeat others.
bool areMostRepeated(const std::vector<Place>& places) {
  const auto repeated =
      std::ranges::count_if(places, [](const Place& place) { return place.count() > 1; });
  return places.size() > 1 && 2 * std::size_t(repeated) >= places.size();
}

// A slice's phase by each key's value, if the values make phases: at most one slice of each value
// at a place, and each value at half of the places at least.
std::optional<std::vector<int>> phasesBy(const Key& key,
                                         const std::vector<const DicomHeader*>& slices,
                                         const std::vector<Place>& places) {
  std::map<double, std::size_t> counts;
  std::vector<double> values;
  for (const DicomHeader* slice : slices) {
    const std::optional<double> value = key.of(*slice);
    if (!value) return std::nullopt;
    values.push_back(*value);
    ++counts[*value];
  }
  if (counts.size() < 2 || counts.size() > kMostPhases) return std::nullopt;
  for (const auto& [value, count] : counts) {
    if (count < 2 || 2 * count < places.size()) return std::nullopt;
  }
  std::vector<int> phases(slices.size());
  for (const Place& place : places) {
    for (std::size_t n = place.first; n < place.last; ++n) {
      for (std::size_t m = place.first; m < n; ++m) {
        if (values[m] == values[n]) return std::nullopt;
      }
      phases[n] = int(std::distance(counts.begin(), counts.find(values[n])));
    }
  }
  return phases;
}

// Phases that were scanned one after the other, by a number that grows from slice to slice: a place
// that comes again starts the next. Each is at half of the places at least.
std::optional<std::vector<int>> phasesInTurn(
    const std::function<std::optional<double>(const DicomHeader&)>& number,
    const std::vector<const DicomHeader*>& slices, const std::vector<Place>& places) {
  struct Taken {
    double number;
    std::size_t slice, place;
  };
  std::vector<Taken> taken;
  for (std::size_t p = 0; p < places.size(); ++p) {
    for (std::size_t n = places[p].first; n < places[p].last; ++n) {
      const std::optional<double> value = number(*slices[n]);
      if (!value) return std::nullopt;
      taken.push_back({*value, n, p});
    }
  }
  std::ranges::sort(taken, {}, &Taken::number);
  std::vector<int> phases(slices.size());
  std::vector<int> last_phase(places.size(), -1);
  std::vector<std::size_t> counts{0};
  for (std::size_t n = 0; n < taken.size(); ++n) {
    if (n > 0 && taken[n].number == taken[n - 1].number) return std::nullopt;
    if (last_phase[taken[n].place] + 1 == int(counts.size())) counts.push_back(0);
    const int phase = int(counts.size()) - 1;
    last_phase[taken[n].place] = phase;
    phases[taken[n].slice] = phase;
    ++counts.back();
  }
  const auto few = [&](std::size_t count) { return count < 2 || 2 * count < places.size(); };
  if (counts.size() > std::size_t(kMostPhases) || std::ranges::any_of(counts, few))
    return std::nullopt;
  return phases;
}

// Between places that ascend; their middle one, or 0 where there is none.
std::vector<double> stepsOf_mm(const std::vector<double>& places_mm) {
  std::vector<double> steps;
  for (std::size_t n = 1; n < places_mm.size(); ++n) {
    steps.push_back(places_mm[n] - places_mm[n - 1]);
  }
  return steps;
}

double medianStep_mm(const std::vector<double>& places_mm) {
  std::vector<double> steps = stepsOf_mm(places_mm);
  std::ranges::sort(steps);
  return steps.empty() ? 0.0 : steps[steps.size() / 2];
}

// The step of these places, where nearly all of them lie on it, a few missing [mm]; 0: they do not.
// Rounded to 0.1 mm, steps may be off by as much.
double evenStep_mm(const std::vector<double>& places_mm) {
  constexpr double kSame = 0.1, kRounded_mm = 0.11, kMostUneven = 0.1, kLeastSingle = 0.5;
  const std::vector<double> steps = stepsOf_mm(places_mm);
  if (steps.size() < 2) return 0.0;
  const double median = medianStep_mm(places_mm);
  const double tolerance_mm = std::max(kSame * median, std::min(kRounded_mm, 0.4 * median));
  double uneven = 0.0, single = 0.0;
  for (const double step : steps) {
    const double multiple = std::max(1.0, std::round(step / median));
    const bool on_it = std::abs(step - multiple * median) <= tolerance_mm;
    uneven += on_it ? 0.0 : 1.0;
    single += on_it && multiple == 1.0 ? 1.0 : 0.0;
  }
  const double all = double(steps.size());
  return uneven <= kMostUneven * all && single >= kLeastSingle * all ? median : 0.0;
}

// Whether the slices of two stacks lie between one another, at places of their own: each is even by
// itself, and where they overlap those of the one that has fewer there lie among the other's.
// Places ascend.
bool areInterleaved(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr std::size_t kFewest = 4;     // slices of a scan
  constexpr std::ptrdiff_t kShared = 3;  // of each where they overlap
  if (a.size() < kFewest || b.size() < kFewest) return false;
  const double step_a = evenStep_mm(a), step_b = evenStep_mm(b);
  if (!(std::min(step_a, step_b) > 2.0 * kSamePlace_mm)) return false;
  const double margin = 0.5 * std::max(step_a, step_b);
  const double low = std::max(a.front(), b.front()) - margin;
  const double high = std::min(a.back(), b.back()) + margin;
  std::vector<std::pair<double, int>> within;
  std::ptrdiff_t counts[2] = {0, 0};
  const std::vector<double>* both[2] = {&a, &b};
  for (int of = 0; of < 2; ++of) {
    for (const double mm : *both[of]) {
      if (mm < low || mm > high) continue;
      within.emplace_back(mm, of);
      ++counts[of];
    }
  }
  if (counts[0] < kShared || counts[1] < kShared) return false;
  std::ranges::sort(within);
  double turns = 0.0;
  for (std::size_t n = 1; n < within.size(); ++n) {
    turns += within[n].second != within[n - 1].second ? 1.0 : 0.0;
  }
  return turns >= double(std::min(counts[0], counts[1]));
}

bool anyInterleaved(const std::vector<int>& phases, const std::vector<double>& places_mm) {
  const int count = 1 + std::ranges::max(phases);
  if (count < 2 || count > kMostPhases) return false;
  std::vector<std::vector<double>> of(std::size_t(count), std::vector<double>{});
  for (std::size_t n = 0; n < phases.size(); ++n) {
    of[std::size_t(phases[n])].push_back(places_mm[n]);
  }
  for (std::size_t a = 0; a < of.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (areInterleaved(of[b], of[a])) return true;
    }
  }
  return false;
}

// A number of each slice, by which scans may be told apart; none where it does not say.
using Numbers = std::vector<std::optional<double>>;

// Each slice's phase where the slices are gone through in the order of their numbers again and
// again, in whatever direction: a slice, or several of one number, among those of the phase so far
// start the next, together with one before that is no step away. What says nothing is a phase of
// its own.
std::vector<int> bySweep(const Numbers& numbers, const std::vector<double>& places_mm) {
  constexpr double kLeastStep = 0.75;
  std::map<double, std::vector<std::size_t>> order;
  std::vector<std::size_t> silent;
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    numbers[n] ? order[*numbers[n]].push_back(n) : silent.push_back(n);
  }
  std::vector<int> phases(numbers.size(), 0);
  int phase = -1;
  std::vector<std::pair<double, std::vector<std::size_t>>> sweep;  // of the phase so far
  double low = 0.0, high = 0.0;
  // There and back: the first of the way back lies beyond the last of the way there.
  const auto turned = [&] {
    if (sweep.size() < 4) return false;
    std::vector<double> steps;
    for (std::size_t n = 1; n < sweep.size(); ++n) {
      steps.push_back(std::abs(sweep[n].first - sweep[n - 1].first));
    }
    const double last = steps.back();
    std::ranges::sort(steps);
    return last < kLeastStep * steps[steps.size() / 2];
  };
  for (const auto& [number, slices] : order) {
    double from = places_mm[slices.front()], to = from;
    for (const std::size_t n : slices) {
      from = std::min(from, places_mm[n]);
      to = std::max(to, places_mm[n]);
    }
    if (phase < 0 || (from < high && to > low)) {
      ++phase;
      low = from;
      high = to;
      if (turned()) {
        sweep.erase(sweep.begin(), sweep.end() - 1);
        for (const std::size_t n : sweep.back().second) {
          phases[n] = phase;
          low = std::min(low, places_mm[n]);
          high = std::max(high, places_mm[n]);
        }
      } else {
        sweep.clear();
      }
    }
    low = std::min(low, from);
    high = std::max(high, to);
    sweep.emplace_back(0.5 * (from + to), slices);
    for (const std::size_t n : slices) phases[n] = phase;
  }
  if (!silent.empty()) ++phase;
  for (const std::size_t n : silent) phases[n] = phase;
  return phases;
}

// Two phases, before and after the longest pause in the numbers: in each they may be in any order.
// One phase where these two are no wider stacks than both together, as any half of the slices is.
std::vector<int> byPause(const Numbers& numbers, const std::vector<double>& places_mm) {
  constexpr double kWider = 1.5;
  const std::vector<int> one(numbers.size(), 0);
  std::vector<double> sorted;
  for (const std::optional<double>& number : numbers) {
    if (!number) return one;
    sorted.push_back(*number);
  }
  std::ranges::sort(sorted);
  double longest = 0.0, after = sorted.front();
  for (std::size_t n = 1; n < sorted.size(); ++n) {
    if (sorted[n] - sorted[n - 1] <= longest) continue;
    longest = sorted[n] - sorted[n - 1];
    after = sorted[n];
  }
  std::vector<int> phases;
  std::vector<double> of[2];
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    phases.push_back(*numbers[n] >= after ? 1 : 0);
    of[phases.back()].push_back(places_mm[n]);
  }
  const double least_mm = std::min(medianStep_mm(of[0]), medianStep_mm(of[1]));
  return least_mm >= kWider * medianStep_mm(places_mm) ? phases : one;
}

// Scans whose slices lie between one another.
struct Interleaved {
  std::vector<int> phases;
  const char* told_apart_by;
};

std::optional<Interleaved> interleaved(const std::vector<const DicomHeader*>& slices,
                                       const std::vector<double>& places_mm,
                                       const std::vector<Key>& keys) {
  const auto numbersBy = [&](const auto& key) {
    Numbers numbers;
    for (const DicomHeader* slice : slices) numbers.push_back(key(*slice));
    return numbers;
  };
  const auto instance = [](const DicomHeader& h) { return parseDecimal(h.instance_number); };
  // Times of the heart's cycle differ a little from beat to beat.
  const auto alike = [](Numbers numbers) {
    constexpr double kSame = 0.03;
    std::map<double, double> least;
    for (const auto& number : numbers) {
      if (number) least[*number] = *number;
    }
    double before = 0.0;
    for (auto& [number, its] : least) {
      if (number - before <= kSame * std::abs(number)) its = before;
      before = its;
    }
    for (auto& number : numbers) {
      if (number) number = least.at(*number);
    }
    return numbers;
  };
  std::vector<std::pair<const char*, Numbers>> all;
  for (const Key& key : keys) {
    const std::string_view unit = key.unit;
    const bool of_heart = unit == " ms" || unit.starts_with(" %");
    Numbers numbers = numbersBy(key.of);
    all.emplace_back(key.name, of_heart ? alike(std::move(numbers)) : std::move(numbers));
  }
  all.emplace_back(trLater("instance number"), numbersBy(instance));
  for (const auto& [name, numbers] : all) {
    for (std::vector<int> phases : {bySweep(numbers, places_mm), byPause(numbers, places_mm)}) {
      if (anyInterleaved(phases, places_mm)) return Interleaved{std::move(phases), name};
    }
  }
  return std::nullopt;
}

// Of phases that were told apart, those that are several scans all the same, by other keys.
void refine(const std::vector<const DicomHeader*>& slices, const std::vector<double>& places_mm,
            const std::vector<Key>& keys, std::vector<int>& phases,
            std::vector<std::string_view>& told_apart_by) {
  for (int phase = 0; phase <= std::ranges::max(phases); ++phase) {
    std::vector<std::size_t> own;
    for (std::size_t n = 0; n < phases.size(); ++n) {
      if (phases[n] == phase) own.push_back(n);
    }
    std::vector<const DicomHeader*> its;
    std::vector<double> its_mm;
    for (const std::size_t n : own) {
      its.push_back(slices[n]);
      its_mm.push_back(places_mm[n]);
    }
    if (its.size() < 2) continue;
    const auto parts = interleaved(its, its_mm, keys);
    const int most = std::ranges::max(phases);
    if (!parts || most + 1 + std::ranges::max(parts->phases) > kMostPhases) continue;
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (parts->phases[i] > 0) phases[own[i]] = most + parts->phases[i];
    }
    if (std::ranges::find(told_apart_by, parts->told_apart_by) == told_apart_by.end()) {
      told_apart_by.push_back(parts->told_apart_by);
    }
  }
}

// The slices' rank at their place, and the key that tells them apart everywhere; where none does,
// by instance number.
struct Ranks {
  std::vector<int> of;
  const char* key = nullptr;
};

Ranks ranks(const std::vector<const DicomHeader*>& slices, const std::vector<Place>& places,
            const std::vector<Key>& keys) {
  const auto instance = [](const DicomHeader& h) {
    return double(parseInteger(h.instance_number).value_or(0));
  };
  const auto tells = [&](const auto& key) {
    return std::ranges::all_of(places, [&](const Place& place) {
      std::vector<double> values;
      for (std::size_t n = place.first; n < place.last; ++n) {
        const std::optional<double> value = key(*slices[n]);
        if (!value) return false;
        values.push_back(*value);
      }
      std::ranges::sort(values);
      return std::ranges::adjacent_find(values) == values.end();
    });
  };
  std::vector<int> result(slices.size(), 0);
  const auto rankBy = [&](const auto& key) {
    for (const Place& place : places) {
      std::vector<std::pair<double, std::size_t>> order;
      for (std::size_t n = place.first; n < place.last; ++n) {
        order.emplace_back(key(*slices[n]).value_or(0.0), n);
      }
      std::ranges::sort(order);
      for (std::size_t rank = 0; rank < order.size(); ++rank) {
        result[order[rank].second] = int(rank);
      }
    }
  };
  for (const Key& key : keys) {
    if (!tells(key.of)) continue;
    rankBy(key.of);
    return {std::move(result), key.name};
  }
  rankBy([&](const DicomHeader& h) { return std::optional(instance(h)); });
  return {std::move(result), nullptr};
}

// ", 10:15:00", of the day; empty where nobody wrote it down.
std::string timeText(const DicomHeader& slice) {
  const std::optional<double>& taken =
      slice.phase[kAcquisitionTime] ? slice.phase[kAcquisitionTime] : slice.phase[kContentTime];
  // HHMMSS alone, or after a date of eight digits.
  if (!taken || *taken < 0.0 || *taken > 1e15 || (*taken >= 1e6 && *taken < 1e13)) return "";
  const auto second = std::int64_t(std::fmod(*taken, 1e6));
  char text[16];
  std::snprintf(text, sizeof text, ", %02d:%02d:%02d", int(second / 10000), int(second / 100 % 100),
                int(second % 100));
  return text;
}

// " (80 kV)": what the key that tells scans apart is in this one, where a person knows its unit.
std::string valueText(const std::vector<Key>& keys, std::string_view name,
                      const DicomHeader& slice) {
  for (const Key& key : keys) {
    const auto value = key.name == name ? key.of(slice) : std::nullopt;
    if (value && *key.unit != '\0') return " (" + plainNumber(*value) + key.unit + ")";
  }
  return "";
}

// What slices with equal HU share; nothing where the pixels cannot be read.
using Pixels = std::tuple<int, int, StoredFormat, std::string>;

std::optional<Pixels> pixelsOf(PixelReader& reader, const DicomHeader& slice) {
  if (!slice.has_pixels || slice.defect != Defect::none || !slice.holdsGreyWords()) {
    return std::nullopt;
  }
  std::vector<std::int16_t> words(slice.pixelCount());
  if (!reader.read(slice, words.data())) return std::nullopt;
  return Pixels{slice.rows, slice.columns, slice.format,
                sha256Hex(words.data(), words.size() * sizeof(std::int16_t))};
}

}  // namespace

void dropEqualRepeats(Series& series, const Progress& progress) {
  struct Placed {
    double place_mm;
    std::size_t slice;
  };
  std::optional<Mat3> axes;
  std::vector<Placed> placed;
  for (std::size_t n = 0; n < series.slices.size(); ++n) {
    const DicomHeader& slice = series.slices[n];
    if (!slice.position_mm || !slice.orientation) return;
    if (!axes) axes = axesOf(*slice.orientation);
    if (!axes) return;
    placed.push_back({glm::dot(*slice.position_mm, (*axes)[2]), n});
  }
  std::ranges::stable_sort(placed, {}, &Placed::place_mm);
  std::vector<double> places_mm;
  for (const Placed& slice : placed) places_mm.push_back(slice.place_mm);
  const std::vector<Place> places = placesOf(places_mm);
  if (places.size() < 2) return;  // no volume in any case
  const std::size_t repeats = placed.size() - places.size();
  const bool scanned_again = areMostRepeated(places);

  PixelReader reader(progress);
  std::vector<bool> dropped(series.slices.size(), false);
  Finding finding{code::kDuplicateFiles, Severity::notice, "", {}, tr("One of each was kept")};
  for (const Place& place : places) {
    if (place.count() < 2) continue;
    std::vector<std::optional<Pixels>> pixels(place.count());
    // On workers, for the reader's sake.
    const ProgressPart comparing{0.99, 0.99, tr("Comparing slices")};  // of the scan's
    const Status read = forEachFile(place.count(), progress, comparing, [&](std::size_t n) {
      pixels[n] = pixelsOf(reader, series.slices[placed[place.first + n].slice]);
    });
    if (!read) return;
    std::set<Pixels> seen;
    std::size_t equal = 0;
    for (std::size_t n = 0; n < pixels.size(); ++n) {
      if (!pixels[n] || seen.insert(*std::move(pixels[n])).second) continue;
      const std::size_t slice = placed[place.first + n].slice;
      dropped[slice] = true;
      finding.slices.push_back(sliceName(series.slices[slice]));
      ++equal;
    }
    const bool different = equal + 1 < place.count();
    // Phases: where two of them are all air, a slice is still one of each.
    if (different && scanned_again) return;
    if (different && repeats > kMostCompared) break;  // too many to read them all
  }
  if (finding.slices.empty()) return;
  finding.text =
      trCount(finding.slices.size(), "{} slice repeats another at the same place, pixel by pixel",
              "{} slices repeat another at the same place, pixel by pixel");
  series.report.findings.push_back(std::move(finding));
  std::vector<DicomHeader> kept;
  for (std::size_t n = 0; n < series.slices.size(); ++n) {
    if (!dropped[n]) kept.push_back(std::move(series.slices[n]));
  }
  series.slices = std::move(kept);
}

std::vector<std::size_t> chooseRepeats(const std::vector<const DicomHeader*>& slices,
                                       const std::vector<double>& places_mm, const Answers& answers,
                                       const std::vector<DicomHeader>& all, SeriesReport& report) {
  const std::vector<Place> places = placesOf(places_mm);
  const auto [least, most] = std::ranges::minmax(places, {}, &Place::count);
  std::vector<std::size_t> chosen;
  const std::vector<Key> keys = keysOf(slices);
  std::optional<std::vector<int>> phases;
  std::vector<std::string_view> told_apart_by;  // keys: the first found the phases, the others more
  const auto found = [&](std::optional<std::vector<int>> some, const char* by) {
    if (phases || !some) return;
    phases = std::move(some);
    told_apart_by = {by};
  };
  const auto instance = [](const DicomHeader& h) { return parseDecimal(h.instance_number); };
  const bool scanned_again = areMostRepeated(places);
  const bool single = most.count() == 1 && places.size() > 1;
  // Scans that lie between one another share hardly any place.
  bool woven = false;
  if (!scanned_again && places.size() > 1) {
    if (auto scans = interleaved(slices, places_mm, keys)) {
      woven = true;
      found(std::move(scans->phases), scans->told_apart_by);
    }
  }
  if ((single && !phases) || places.size() == 1) {
    for (std::size_t n = 0; n < slices.size(); ++n) chosen.push_back(n);
    return chosen;
  }
  for (std::size_t key = 0; scanned_again && key < keys.size() && !phases; ++key) {
    found(phasesBy(keys[key], slices, places), keys[key].name);
  }
  const Ranks rank = ranks(slices, places, keys);
  if (rank.key && least.count() == most.count() && most.count() <= kMostPhases) {
    found(rank.of, rank.key);
  }
  for (std::size_t key = 0; scanned_again && key < keys.size() && !phases; ++key) {
    const bool is_time = std::string_view(keys[key].name).ends_with(" time");
    if (is_time) found(phasesInTurn(keys[key].of, slices, places), keys[key].name);
  }
  if (!phases && scanned_again) {
    found(phasesInTurn(instance, slices, places), trLater("instance number"));
  }
  const auto take = [&](const std::vector<int>& of, int wanted) {
    for (const Place& place : places) {
      for (std::size_t n = place.first; n < place.last; ++n) {
        if (of[n] == wanted) chosen.push_back(n);
      }
    }
  };

  if (phases) {
    refine(slices, places_mm, keys, *phases, told_apart_by);
    std::vector<std::string> its_keys;
    for (const std::string_view key : told_apart_by) its_keys.push_back(tr(key.data()));
    const std::string keys_text = listed(its_keys);
    report.phases = 1 + std::ranges::max(*phases);
    const bool by_kernel = told_apart_by == std::vector<std::string_view>{kKernelKey};
    Choice choice{
        code::kPhases,
        by_kernel ? tr("Which reconstruction shall be used?") : tr("Which phase shall be used?"),
        {"refuse"},
        {tr("Do not use the series")}};
    choice.on_screen.emplace_back();
    choice.shown.push_back(-1);
    for (int phase = 0; phase < report.phases; ++phase) {
      std::vector<const DicomHeader*> its;
      for (std::size_t n = 0; n < slices.size(); ++n) {
        if ((*phases)[n] == phase) its.push_back(slices[n]);
      }
      const DicomHeader& middle = *its[its.size() / 2];
      choice.options.push_back(std::to_string(phase + 1));
      choice.words.push_back(
          (by_kernel ? tr("Reconstruction {}", phase + 1)
                     : tr("Phase {} by {}", phase + 1, keys_text)) +
          valueText(keys, told_apart_by.front(), middle) +
          (middle.kernel.empty() ? "" : tr(", kernel {}", shownTerm(middle.kernel))) +
          timeText(middle) + ", " + slicesText(its.size()));
      choice.on_screen.push_back(middle.description);
      choice.shown.push_back(int(&middle - all.data()));
    }
    if (single) {
      choice.options.emplace_back("all");
      choice.words.push_back(tr("They are one scan: use all {}", slicesText(slices.size())));
      choice.on_screen.emplace_back();
      choice.shown.push_back(-1);
    }
    const std::string answer = ask(std::move(choice), answers, report.choices);
    const std::string lying = woven ? tr(" whose slices lie between one another") : "";
    const std::string text =
        by_kernel ? tr("The series holds {} reconstructions{}, told apart by {}", report.phases,
                       lying, keys_text)
                  : tr("The series holds {} phases or repeated acquisitions{}, told apart by {}",
                       report.phases, lying, keys_text);
    if (answer == "all") {
      report.findings.push_back({code::kPhases,
                                 Severity::repair,
                                 text,
                                 {},
                                 tr("All were taken as one scan, as was chosen")});
      for (std::size_t n = 0; n < slices.size(); ++n) chosen.push_back(n);
      return chosen;
    }
    if (answer == "refuse") {
      report.findings.push_back(
          {code::kPhases, Severity::refusal, text, {}, tr("Choose one of them")});
      take(*phases, 0);
    } else {
      report.findings.push_back(
          {code::kPhases, Severity::repair, text, {}, tr("Number {} was taken", answer)});
      take(*phases, *parseInteger(answer) - 1);
    }
    return chosen;
  }

  Finding finding{code::kDuplicatePositions, Severity::refusal, "", {}, ""};
  for (const Place& place : places) {
    if (place.count() > 1) finding.slices.push_back(placeText(places_mm[place.first]));
  }
  finding.text =
      trCount(finding.slices.size(), "{} place holds more than one slice, with different pixels",
              "{} places hold more than one slice, with different pixels");
  // Where most places repeat and nothing tells the phases apart, any choice would mix them.
  std::string answer = "refuse";
  if (!scanned_again) {
    answer = ask({code::kDuplicatePositions,
                  tr("Which of the slices at one place shall be used?"),
                  {"refuse", "first", "last"},
                  {tr("Do not use the series"), tr("The one that was acquired first"),
                   tr("The one that was acquired last")}},
                 answers, report.choices);
  }
  std::vector<int> wanted = rank.of;
  if (answer == "last") {
    for (const Place& place : places) {
      for (std::size_t n = place.first; n < place.last; ++n) {
        wanted[n] = int(place.count()) - 1 - wanted[n];
      }
    }
  }
  if (answer == "refuse") {
    finding.action =
        scanned_again
            ? tr("Export one of the scans alone: nothing in them tells them apart")
            : tr("Choose which to use, or remove the slices that do not belong to the scan");
  } else {
    finding.severity = Severity::repair;
    finding.action = tr("Of each place the {} was taken, the others left out", answer);
  }
  report.findings.push_back(std::move(finding));
  take(wanted, 0);
  return chosen;
}

}  // namespace trephine
