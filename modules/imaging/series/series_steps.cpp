#include "imaging/series/detail/series_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"

namespace trephine {

namespace {

constexpr double kJitter = 0.1;              // of the median step: up to here a stack is resampled
constexpr std::int64_t kMostSlices = 10000;  // of a volume with filled gaps
constexpr double kSlack_mm = 1e-6;  // what numbers of two decimals leave when they are subtracted

double stepTolerance_mm(double step) {
  return std::max(0.01, 0.01 * step);
}

// How the steps between places compare with one of them: their median, or the least.
struct Steps {
  double median_mm = 0.0, least_mm = 0.0, most_mm = 0.0;
  double step_mm = 0.0;                 // with which they were compared
  std::vector<std::int64_t> multiples;  // of that which each step is nearest to, at least 1
  std::int64_t total = 0;               // of the multiples
  bool even = true;                     // every step is its multiple, within the tolerance
  bool jittered = true;                 // ... within kJitter
  bool gaps = false;                    // a multiple over 1
  std::int64_t missing() const { return total - std::int64_t(multiples.size()); }
};

enum class StepBy { median, least };

Steps stepsOf(const Slices& slices, StepBy by = StepBy::median) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < slices.size(); ++i) {
    steps.push_back(slices[i].place_mm - slices[i - 1].place_mm);
  }
  std::vector<double> sorted = steps;
  std::ranges::sort(sorted);
  Steps result;
  result.median_mm = sorted[(sorted.size() - 1) / 2];  // of two, the smaller: never a gap
  result.least_mm = sorted.front();
  result.most_mm = sorted.back();
  result.step_mm = by == StepBy::median ? result.median_mm : result.least_mm;
  const double unit = result.step_mm;
  for (const double step : steps) {
    const double multiple = std::clamp(std::round(step / unit), 1.0, 1e9);
    const double off = std::abs(step - multiple * unit);
    const double most = kJitter * unit;
    const double tolerance =
        std::min(multiple * stepTolerance_mm(unit), std::max(most, stepTolerance_mm(unit)));
    result.even &= off <= tolerance + kSlack_mm;
    result.jittered &= off <= most;
    result.gaps |= multiple > 1.5;
    result.multiples.push_back(std::int64_t(multiple));
    result.total += result.multiples.back();
  }
  return result;
}

// By the median, or else by a step that all intervals are multiples of, half of the slices being
// there.
Steps explained(const Slices& slices) {
  Steps steps = stepsOf(slices);
  if (steps.even) return steps;
  Steps by_least = stepsOf(slices, StepBy::least);
  const bool half = by_least.missing() <= std::int64_t(by_least.multiples.size());
  return by_least.even && by_least.gaps && half ? by_least : steps;
}

// The longest row of usable slices whose steps are `step_mm` within the tolerance.
Slices longestPart(const Slices& slices, double step_mm, double tolerance_mm) {
  std::size_t best = 0, best_count = 0, first = 0;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const bool goes_on =
        i > first && slices[i].usable && slices[i - 1].usable &&
        std::abs(slices[i].place_mm - slices[i - 1].place_mm - step_mm) <= tolerance_mm;
    if (!goes_on) first = i;
    if (slices[i].usable && i - first + 1 > best_count) {
      best = first;
      best_count = i - first + 1;
    }
  }
  return {slices.begin() + std::ptrdiff_t(best),
          slices.begin() + std::ptrdiff_t(best + best_count)};
}

std::string rangeText(const Slices& slices) {
  return tr("{} to {}", placeText(slices.front().place_mm), placeText(slices.back().place_mm));
}

// The places where a slice is wanted and none can be had, and how many slices that is.
std::vector<std::string> missingPlaces(const Slices& slices, const Steps& steps,
                                       std::int64_t& missing) {
  std::vector<std::string> places;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    if (!slices[i].usable) {
      ++missing;
      places.push_back(placeText(slices[i].place_mm));
    }
    if (i + 1 == slices.size() || steps.multiples[i] < 2) continue;
    const std::int64_t gap = steps.multiples[i] - 1;
    const double step = (slices[i + 1].place_mm - slices[i].place_mm) / double(gap + 1);
    missing += gap;
    std::string text = placeText(slices[i].place_mm + step);
    if (gap > 1) {
      text += tr(" to {} ({})", placeText(slices[i + 1].place_mm - step),
                 slicesText(std::uint64_t(gap)));
    }
    places.push_back(std::move(text));
  }
  return places;
}

void trimUnusableEnds(Slices& slices) {
  while (!slices.empty() && !slices.back().usable) slices.pop_back();
  while (!slices.empty() && !slices.front().usable) slices.erase(slices.begin());
}

// Which slices of the volume lie where: `count` of them, evenly from the first place to the last.
void planSlices(const Slices& slices, std::int64_t count, Stack& stack) {
  const double first = slices.front().place_mm;
  const double step = (slices.back().place_mm - first) / double(count - 1);
  Slices usable;
  std::ranges::copy_if(slices, std::back_inserter(usable), &Slice::usable);
  stack.order.clear();
  stack.places_mm.clear();
  stack.slices.clear();
  for (const Slice& slice : usable) {
    stack.order.push_back(slice.input);
    stack.places_mm.push_back(slice.place_mm);
  }
  std::size_t upper = 0;
  for (std::int64_t k = 0; k < count; ++k) {
    const double place = first + step * double(k);
    while (upper + 1 < usable.size() && usable[upper].place_mm < place) ++upper;
    const std::size_t lower = upper > 0 ? upper - 1 : 0;
    const double span = usable[upper].place_mm - usable[lower].place_mm;
    double share = span > 0.0 ? (place - usable[lower].place_mm) / span : 0.0;
    const double near = stepTolerance_mm(step) / std::max(span, step);
    if (share < near) share = 0.0;
    if (share > 1.0 - near) share = 1.0;
    stack.slices.push_back(share == 1.0 ? SliceMixture{upper, upper, 0.0}
                                        : SliceMixture{lower, share == 0.0 ? lower : upper, share});
  }
  stack.geometry.size[2] = std::int32_t(count);
  stack.geometry.spacing_mm.z = step;
}

// One slice of the volume for each usable one: what a report states of a stack that is even or
// refused.
void planAsTheyAre(const Slices& slices, Stack& stack) {
  stack.slices.clear();
  stack.order.clear();
  stack.places_mm.clear();
  for (const Slice& slice : slices) {
    if (!slice.usable) continue;
    stack.slices.push_back({stack.order.size(), stack.order.size(), 0.0});
    stack.order.push_back(slice.input);
    stack.places_mm.push_back(slice.place_mm);
  }
  stack.geometry.size[2] = std::int32_t(slices.size());
}

void keepPart(const Slices& part, Code code, const std::string& text, Stack& stack) {
  stack.findings.push_back(
      {code,
       Severity::repair,
       text,
       {},
       tr("Only the longest even part was taken, {}, {}; the rest is not there", rangeText(part),
          slicesText(part.size()))});
  planSlices(part, std::int64_t(part.size()), stack);
}

// Places on a line of even steps that they were rounded from.
struct Line {
  Slices slices;
  double step_mm = 0.0;
  std::int64_t missing = 0;  // slices between the first and the last one
  bool numbered_on = false;  // StackInput's
};

Finding roundedFinding(double grid_mm, double step_mm) {
  return {code::kRoundedPositions,
          Severity::repair,
          tr("The positions of the slices were rounded to {} mm", fixedText(grid_mm, 1)),
          {},
          tr("They were put back on the line that explains them all, with a step of {} mm",
             fixedText(step_mm, 3))};
}

// Slices that are not there, or are there and lost, in a stack that is even otherwise (or nearly).
void planGaps(Slices slices, const Steps& steps, const Answers& answers,
              const std::string& lost_text, const std::optional<Line>& rounded, double grid_mm,
              Stack& stack) {
  std::int64_t missing = 0;
  const std::vector<std::string> places = missingPlaces(slices, steps, missing);
  const std::string gaps =
      trCount(std::uint64_t(missing), "{} slice is missing from a stack with a step of {}",
              "{} slices are missing from a stack with a step of {}", lengthText(steps.step_mm));
  const std::string text =
      rounded
          ? tr("Either {}, or none is and the positions were rounded to {} mm from steps of {} mm",
               gaps, fixedText(grid_mm, 1), fixedText(rounded->step_mm, 3))
          : gaps + lost_text;
  const Slices part =
      longestPart(slices, steps.step_mm,
                  steps.even ? stepTolerance_mm(steps.step_mm) : kJitter * steps.step_mm);
  Choice choice{code::kMissingSlices,
                places.size() == 1 ? tr("What shall become of the gap?")
                                   : tr("What shall become of the gaps?"),
                {"refuse"},
                {tr("Do not use the series")}};
  // From the first usable slice to the last.
  std::int64_t filled = steps.total + 1;
  for (std::size_t i = 0; i < slices.size() && !slices[i].usable; ++i) filled -= steps.multiples[i];
  for (std::size_t i = slices.size(); i-- > 0 && !slices[i].usable;) {
    filled -= steps.multiples[i - 1];
  }
  // A volume that is mostly made up is none.
  const bool fillable = filled <= 2 * std::ranges::count(slices, true, &Slice::usable);
  if (fillable) {
    choice.options.push_back("fill");
    choice.words.push_back(
        tr("Fill in by interpolation between the slices beside, and name them in the report"));
  }
  if (part.size() > 1) {
    choice.options.push_back("part");
    choice.words.push_back(tr("Use only the longest part without a gap: {}, {}", rangeText(part),
                              slicesText(part.size())));
  }
  if (rounded) {
    choice.options.push_back("line");
    choice.words.push_back(
        tr("None is missing: their positions were rounded to {} mm, from even steps of {} mm",
           fixedText(grid_mm, 1), fixedText(rounded->step_mm, 3)));
  }
  const std::string answer = ask(std::move(choice), answers, stack.choices);
  if (answer == "line") {
    stack.findings.push_back({code::kMissingSlices,
                              Severity::repair,
                              text,
                              {},
                              tr("None is missing, as was chosen: positions that were rounded to "
                                 "{} mm were put back on even steps of {} mm",
                                 fixedText(grid_mm, 1), fixedText(rounded->step_mm, 3))});
    planAsTheyAre(rounded->slices, stack);
    stack.geometry.spacing_mm.z = rounded->step_mm;
    return;
  }
  if (answer == "part") return keepPart(part, code::kMissingSlices, text, stack);
  if (answer == "fill") {
    const std::size_t before = slices.size();
    trimUnusableEnds(slices);
    const bool trimmed = slices.size() < before;
    planSlices(slices, filled, stack);
    stack.findings.push_back({code::kMissingSlices, Severity::repair, text, places,
                              tr("Filled in by interpolation: what lies there was not scanned, and "
                                 "a lesion in it cannot be seen{}",
                                 (trimmed ? tr(". Ends that cannot be read were cut off") : ""))});
    return;
  }
  planAsTheyAre(slices, stack);
  stack.findings.push_back(
      {code::kMissingSlices, Severity::refusal, text, places,
       rounded    ? rounded->numbered_on
                        ? tr("Choose which it is: its slices are numbered without a break, as where "
                                "none is missing")
                        : tr("Choose which it is: count the slices where the series comes from")
          : fillable ? tr("Copy or export the series again, or choose to fill in")
                  : tr("Copy or export the series again")});
}

void planUneven(const Slices& slices, const Steps& steps, const Answers& answers, Stack& stack) {
  Slices whole = slices;
  trimUnusableEnds(whole);
  const double extent = whole.back().place_mm - whole.front().place_mm;
  const double wanted = std::round(extent / steps.median_mm) + 1.0;
  const auto count = std::int64_t(std::min(wanted, double(kMostSlices) + 1.0));
  const std::string text =
      tr("The steps between slices vary from {} to {} mm (median {} mm)",
         fixedText(steps.least_mm, 3), fixedText(steps.most_mm, 3), fixedText(steps.median_mm, 3));
  const Slices part = longestPart(slices, steps.median_mm, stepTolerance_mm(steps.median_mm));
  Choice choice{code::kUnevenSpacing,
                tr("How shall the uneven steps be used?"),
                {"refuse"},
                {tr("Do not use the series")}};
  if (count > 1 && count <= kMostSlices) {
    choice.options.push_back("resample");
    choice.words.push_back(tr("Interpolate {} at even steps of about {}",
                              slicesText(std::uint64_t(count)), lengthText(steps.median_mm)));
  }
  if (part.size() > 1) {
    choice.options.push_back("part");
    choice.words.push_back(
        tr("Use only the longest even part: {}, {}", rangeText(part), slicesText(part.size())));
  }
  const std::string answer = ask(std::move(choice), answers, stack.choices);
  if (answer == "part") return keepPart(part, code::kUnevenSpacing, text, stack);
  if (answer == "resample") {
    planSlices(whole, count, stack);
    stack.findings.push_back({code::kUnevenSpacing,
                              Severity::repair,
                              text,
                              {},
                              tr("Slices were interpolated at even steps of {}; where the scan is "
                                 "coarse, detail is only apparent",
                                 lengthText(stack.geometry.spacing_mm.z))});
    return;
  }
  planAsTheyAre(slices, stack);
  stack.findings.push_back({code::kUnevenSpacing,
                            Severity::refusal,
                            text,
                            {},
                            tr("Export the series with even spacing, or choose how to use it")});
}

// The coarsest grid that a writer rounds to and that all positions lie on, along the axes on which
// they differ [mm]; 0: none.
double roundedTo_mm(const std::vector<Vec3>& positions_mm) {
  for (const double grid_mm : {1.0, 0.5, 0.1}) {
    bool all = true;
    for (int axis = 0; axis < 3; ++axis) {
      const double first = positions_mm.front()[axis];
      bool differ = false, on_grid = true;
      for (const Vec3& p : positions_mm) {
        differ |= p[axis] != first;
        on_grid &= std::abs(p[axis] / grid_mm - std::round(p[axis] / grid_mm)) <= 1e-5;
      }
      all &= on_grid || !differ;
    }
    if (all) return grid_mm;
  }
  return 0.0;
}

// The number of each slice on a line of this step, where some such line can be rounded to all their
// places, by `most_mm` each: with as few slices missing as that takes. Nothing where none can.
std::optional<std::vector<double>> numbersOf(const Slices& slices, double step_mm, double most_mm) {
  const double slack_mm = 1e-6 * step_mm;
  std::vector<double> numbers{0.0};
  // Where the line may begin, by the slices so far.
  double low = slices.front().place_mm - most_mm, high = slices.front().place_mm + most_mm;
  for (std::size_t i = 1; i < slices.size(); ++i) {
    double number = numbers.back() + 1.0;
    double here = slices[i].place_mm - number * step_mm;
    if (here - most_mm > high + slack_mm) {
      number += std::ceil((here - most_mm - high - slack_mm) / step_mm);
      here = slices[i].place_mm - number * step_mm;
    }
    low = std::max(low, here - most_mm);
    high = std::min(high, here + most_mm);
    if (low > high + slack_mm) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

// The slices on the line of this step that lies nearest to their places.
Slices onLineOf(const Slices& slices, const std::vector<double>& numbers, double step_mm) {
  double start = 0.0;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    start += (slices[i].place_mm - step_mm * numbers[i]) / double(slices.size());
  }
  Slices fitted = slices;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    fitted[i].place_mm = start + step_mm * numbers[i];
  }
  return fitted;
}

bool moved(const Slices& fitted, const Slices& slices) {
  for (std::size_t i = 0; i < slices.size(); ++i) {
    if (std::abs(fitted[i].place_mm - slices[i].place_mm) > kSamePlace_mm) return true;
  }
  return false;
}

// The line of this step, with as few slices missing as it takes.
std::optional<Line> lineOfStep(const Slices& slices, double step_mm, double most_mm) {
  const auto numbers = numbersOf(slices, step_mm, most_mm);
  if (!numbers) return std::nullopt;
  return Line{onLineOf(slices, *numbers, step_mm), step_mm,
              std::int64_t(numbers->back()) - std::int64_t(slices.size()) + 1};
}

// How far places lie at most from the line of this step that is nearest to them in this sense, as
// slices with these numbers.
double farthest_mm(const Slices& slices, const std::vector<double>& numbers, double step_mm) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const double start = slices[i].place_mm - step_mm * numbers[i];
    low = std::min(low, start);
    high = std::max(high, start);
  }
  return 0.5 * (high - low);
}

// The step whose line all places were rounded from, by `most_mm` at most: that of the least squares
// where it serves, else the one whose farthest place is nearest. Nothing where there is none.
std::optional<double> roundedStep_mm(const Slices& slices, const std::vector<double>& numbers,
                                     double most_mm) {
  const double n = double(slices.size()), first = slices.front().place_mm;
  double sum = 0.0, squares = 0.0, places = 0.0, products = 0.0;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    sum += numbers[i];
    squares += numbers[i] * numbers[i];
    places += slices[i].place_mm - first;
    products += numbers[i] * (slices[i].place_mm - first);
  }
  const double least_squares = (n * products - sum * places) / (n * squares - sum * sum);
  const double allowed = most_mm * (1.0 + 1e-6);
  if (farthest_mm(slices, numbers, least_squares) <= allowed) return least_squares;
  if (farthest_mm(slices, numbers, least_squares) > 2.0 * most_mm) return std::nullopt;
  // farthest_mm() is convex in the step.
  double low = least_squares - 4.0 * most_mm / numbers.back(), high = 2.0 * least_squares - low;
  for (int turn = 0; turn < 80; ++turn) {
    const double third = (high - low) / 3.0;
    const bool left =
        farthest_mm(slices, numbers, low + third) < farthest_mm(slices, numbers, high - third);
    (left ? high : low) += left ? -third : third;
  }
  const double nearest = 0.5 * (low + high);
  if (farthest_mm(slices, numbers, nearest) > allowed) return std::nullopt;
  return nearest;
}

// The line of any step, by whole numbers of steps with as few slices missing as any line explains.
// A step that is known tells a gap from one that was rounded; few slices tell it less well.
// Rounding moves a place by `most_mm` at most, and a step by less than twice that.
std::optional<Line> lineOfAnyStep(const Slices& slices, double most_mm,
                                  const std::optional<double>& known_mm,
                                  std::int64_t most_missing) {
  const double n = double(slices.size());
  const double first = slices.front().place_mm, extent = slices.back().place_mm - first;
  for (std::int64_t missing = 0; missing <= most_missing; ++missing) {
    const double guess = extent / (n - 1.0 + double(missing));
    std::vector<double> numbers;
    bool fits = true;
    for (const Slice& slice : slices) {
      // Rounded places tell the numbers themselves where none is missing.
      const double number =
          missing == 0 ? double(numbers.size()) : std::round((slice.place_mm - first) / guess);
      fits &= numbers.empty() || number > numbers.back();
      numbers.push_back(number);
    }
    const auto step = fits ? roundedStep_mm(slices, numbers, most_mm) : std::nullopt;
    fits &= step &&
            (!known_mm || std::abs(*step - *known_mm) <= std::max(0.01 * *known_mm, most_mm / n));
    for (std::size_t i = 1; i < slices.size() && fits; ++i) {
      const double steps = (numbers[i] - numbers[i - 1]) * *step;
      const double is = slices[i].place_mm - slices[i - 1].place_mm;
      fits = std::abs(is - steps) < 2.0 * most_mm * (1.0 - 1e-6);
    }
    if (fits) return Line{onLineOf(slices, numbers, *step), *step, missing};
  }
  return {};
}

// Whether it is less likely than `chance` that one of so many lines says which intervals are longer
// than the others, where any of them may be.
bool tellsLongerSteps(const Slices& slices, double grid_mm, double lines, double chance) {
  const double intervals = double(slices.size()) - 1.0;
  double least = std::numeric_limits<double>::infinity(), longer = 0.0;
  for (std::size_t i = 1; i < slices.size(); ++i) {
    least = std::min(least, slices[i].place_mm - slices[i - 1].place_mm);
  }
  for (std::size_t i = 1; i < slices.size(); ++i) {
    longer += slices[i].place_mm - slices[i - 1].place_mm > least + 0.5 * grid_mm ? 1.0 : 0.0;
  }
  const double log_patterns = std::lgamma(intervals + 1.0) - std::lgamma(longer + 1.0) -
                              std::lgamma(intervals - longer + 1.0);
  return log_patterns >= std::log(lines / chance);
}

// How far rounding to a grid moves a place along the normal at most.
double mostRounded_mm(double grid_mm, const Vec3& normal) {
  return 0.5 * grid_mm * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
}

struct Rounded {
  std::optional<Line> taken, offered;
};

// The line that places on a grid were rounded from. Where even steps with gaps explain them as
// well, it is taken if the header states its step or if it cannot be chance, and else offered.
// Uneven steps leave nothing simpler.
Rounded lineFor(const Slices& slices, const Steps& steps, const StackInput& input, double grid_mm,
                double most_mm) {
  constexpr double kChance = 1e-3;
  // What is a whole number of the grid's steps is not moved by rounding.
  const auto ofStep = [&](const std::optional<double>& said_mm) -> std::optional<Line> {
    const double step_mm = std::abs(said_mm.value_or(0.0)), of_grid = step_mm / grid_mm;
    if (!(step_mm > 0.0) || std::abs(of_grid - std::round(of_grid)) <= 1e-6) return std::nullopt;
    return lineOfStep(slices, step_mm, most_mm);
  };
  std::optional<double> between_mm;
  if (input.spacing_between_mm) between_mm = std::abs(*input.spacing_between_mm);
  const double n = double(slices.size());
  const auto half = std::int64_t(slices.size() / 2);
  // Numbers without a break are a statement, too.
  const double chance = !steps.even || input.numbered_on ? 1.0 : kChance;
  // What is as thick as the steps are is stated to lie so.
  const bool as_thick =
      input.thickness_mm && std::abs(*input.thickness_mm - steps.step_mm) <= 0.01 * steps.step_mm;
  const std::int64_t most_missing = !steps.even ? half : between_mm ? steps.missing() - 1 : 0;
  Rounded rounded;
  // Of `lines` lines of its kind.
  const auto take = [&](const std::optional<Line>& line, double lines) {
    if (!line || !moved(line->slices, slices)) return false;
    if (steps.even && line->missing >= steps.missing()) return false;
    const bool stated = lines == 0.0;
    const bool taken = stated || tellsLongerSteps(slices, grid_mm, lines, chance);
    if (taken && line->missing <= half) {
      rounded.taken = line;
      return true;
    }
    if (steps.even && line->missing == 0 && !rounded.offered) rounded.offered = line;
    return false;
  };
  if (take(ofStep(between_mm), 0.0)) return rounded;
  if (!between_mm) {
    const auto by_thickness = ofStep(input.thickness_mm);
    const bool whole = by_thickness && by_thickness->missing == 0;
    // Without a gap it leaves uneven steps no other reading.
    if (take(by_thickness, whole && !steps.even ? 0.0 : n)) return rounded;
  }
  if (steps.even && as_thick && !between_mm) return rounded;
  take(lineOfAnyStep(slices, most_mm, between_mm, most_missing), between_mm ? n : n * n);
  return rounded;
}

}  // namespace

std::optional<Finding> takeApart(std::vector<Vec3>& positions_mm, const Vec3& normal,
                                 double step_mm) {
  const double grid_mm = roundedTo_mm(positions_mm);
  if (!(grid_mm > 0.0) || !(step_mm > 0.0) || step_mm >= grid_mm) return std::nullopt;
  Slices slices;
  bool fell_together = false;
  for (std::size_t n = 0; n < positions_mm.size(); ++n) {
    slices.push_back({n, glm::dot(positions_mm[n], normal), true});
    if (n == 0) continue;
    fell_together |= slices[n].place_mm - slices[n - 1].place_mm <= kSamePlace_mm;
  }
  const auto numbers = numbersOf(slices, step_mm, mostRounded_mm(grid_mm, normal));
  if (!fell_together || !numbers) return std::nullopt;
  const Slices fitted = onLineOf(slices, *numbers, step_mm);
  for (std::size_t n = 0; n < positions_mm.size(); ++n) {
    positions_mm[n] += normal * (fitted[n].place_mm - slices[n].place_mm);
  }
  return roundedFinding(grid_mm, step_mm);
}

void planAlongNormal(Slices slices, const StackInput& input, const Vec3& normal,
                     const Answers& answers, Stack& stack) {
  const std::string& lost_text = input.lost_text;
  Steps steps = explained(slices);
  const double grid_mm = roundedTo_mm(input.positions_mm);
  // Without a gap that a rounding could explain as well.
  std::optional<Line> offered;
  if (grid_mm > 0.0 && (!steps.even || steps.gaps)) {
    const Rounded rounded = lineFor(slices, steps, input, grid_mm, mostRounded_mm(grid_mm, normal));
    offered = rounded.offered;
    if (offered) offered->numbered_on = input.numbered_on;
    if (rounded.taken && explained(rounded.taken->slices).even) {
      slices = rounded.taken->slices;
      steps = explained(slices);
      stack.findings.push_back(roundedFinding(grid_mm, steps.step_mm));
    }
  }
  stack.geometry.spacing_mm.z = steps.step_mm;
  const auto usable = std::ranges::count(slices, true, &Slice::usable);
  const bool lost = std::size_t(usable) < slices.size();
  if (usable < 2) {
    planAsTheyAre(slices, stack);
    stack.findings.push_back({code::kMissingSlices,
                              Severity::refusal,
                              tr("{} of {} cannot be used{}", slices.size() - std::size_t(usable),
                                 slicesText(slices.size()), lost_text),
                              {},
                              tr("Copy these files again from their source")});
  } else if ((steps.gaps || lost) && (steps.even || steps.jittered) && steps.total < kMostSlices) {
    planGaps(slices, steps, answers, lost_text, lost ? std::nullopt : offered, grid_mm, stack);
  } else if (steps.even && !steps.gaps) {
    planAsTheyAre(slices, stack);
    stack.geometry.spacing_mm.z =
        (slices.back().place_mm - slices.front().place_mm) / double(slices.size() - 1);
  } else if (steps.jittered && !steps.gaps) {
    planSlices(slices, std::int64_t(slices.size()), stack);
    if (stack.oneToOne()) return;  // within what even steps may differ
    stack.findings.push_back({code::kResampledSpacing,
                              Severity::repair,
                              tr("The steps between slices vary from {} to {} mm",
                                 fixedText(steps.least_mm, 3), fixedText(steps.most_mm, 3)),
                              {},
                              tr("Slices were interpolated at even steps of {} mm; the scan's "
                                 "extent is kept, and fine detail is slightly blurred",
                                 fixedText(stack.geometry.spacing_mm.z, 3))});
  } else {
    planUneven(slices, steps, answers, stack);
  }
}

}  // namespace trephine
