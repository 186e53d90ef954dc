#include "lab/touch/tissue_experiments.h"

#include <algorithm>
#include <cmath>

#include "base/codes.h"
#include "base/system.h"

namespace trephine::tissue_experiments {

namespace {

constexpr double kSpeed_mm_s = 5.0;
const std::vector<LawKind> kBoneLaws{LawKind::viscous, LawKind::coulomb, LawKind::elastic};

constexpr const char* kEstimated = "estimate of the comparison";

Tissue tissueOf(const TissueSet& set, const char* id) {
  return *set.find(id);
}

Tool bladeOf(double edge_mm) {
  return *makeTool({ToolKind::blade, edge_mm, 16, 0.6});
}

// Against the way down: what a hand that pushes in feels.
double upwards_N(const TissueSample& s) {
  return s.demanded_N.z;
}

struct Fit {
  double slope = 0.0, r2 = 0.0;
};
Fit line(const std::vector<std::pair<double, double>>& points) {
  double n = double(points.size()), sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (const auto& [x, y] : points) {
    sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
  }
  const double dx = n * sxx - sx * sx, dy = n * syy - sy * sy, dxy = n * sxy - sx * sy;
  if (!(dx > 0.0) || !(dy > 0.0)) return {};
  return {dxy / dx, dxy * dxy / (dx * dy)};
}

// The ticks of a time.
std::vector<TissueSample> part(const TissueTrace& trace, double from_s, double to_s) {
  std::vector<TissueSample> out;
  for (const TissueSample& s : trace.samples) {
    if (s.t_s >= from_s && s.t_s < to_s) out.push_back(s);
  }
  return out;
}

const TissueSample& peakOf(const std::vector<TissueSample>& samples) {
  return *std::max_element(
      samples.begin(), samples.end(),
      [](const TissueSample& a, const TissueSample& b) { return upwards_N(a) < upwards_N(b); });
}

// The greatest fall of the force within so many seconds.
double dropWithin(const std::vector<TissueSample>& samples, double seconds) {
  double most = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = i + 1; j < samples.size() && samples[j].t_s - samples[i].t_s <= seconds;
         ++j) {
      most = std::max(most, upwards_N(samples[i]) - upwards_N(samples[j]));
    }
  }
  return most;
}

double meanForce(const std::vector<TissueSample>& samples, double from_mm, double to_mm) {
  double sum = 0.0;
  int count = 0;
  for (const TissueSample& s : samples) {
    if (-s.arm_mm.z < from_mm || -s.arm_mm.z > to_mm) continue;
    sum += upwards_N(s);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

// Work of a way in [J], by the force against it.
double work_J(const std::vector<TissueSample>& samples) {
  double sum = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const Vec3 mean_N = 0.5 * (samples[i].demanded_N + samples[i - 1].demanded_N);
    sum -= 0.001 * glm::dot(mean_N, samples[i].arm_mm - samples[i - 1].arm_mm);
  }
  return sum;
}

std::vector<std::pair<double, double>> overDepth(const std::vector<TissueSample>& samples) {
  std::vector<std::pair<double, double>> out;
  for (const TissueSample& s : samples) out.emplace_back(-s.arm_mm.z, upwards_N(s));
  return out;
}

TissueRow row(const char* experiment, const char* quantity, const char* unit, double ours,
              std::optional<double> low, std::optional<double> high, BandKind kind, NumberUse use,
              const char* source, const char* confidence) {
  return {experiment, quantity, unit, ours, low, high, kind, use, source, confidence};
}

}  // namespace

Result<Shipped> readShipped() {
  Shipped shipped;
  for (const auto& [name, set] :
       {std::pair("abdomen", &shipped.abdomen), std::pair("cranium", &shipped.cranium)}) {
    Result<TissueSet> read =
        readTissueSet(resourceFolder() / "tissues" / (std::string(name) + ".json"));
    if (!read) return read.error();
    *set = *std::move(read);
  }
  for (const auto& [set, ids] :
       {std::pair(&shipped.abdomen,
                  std::vector{"fat", "skin", "liver", "muscle", "capsule", "kidney"}),
        std::pair(&shipped.cranium, std::vector{"brain", "dura", "bone"})}) {
    for (const char* id : ids) {
      if (set->find(id)) continue;
      return Error{code::kBadArgument, "The shipped set " + set->name + " has no tissue " + id,
                   set->name, "Install the shipped tissues"};
    }
  }
  return shipped;
}

std::vector<ScaledForce> scaledNumbers(const Shipped& shipped) {
  std::vector<ScaledForce> scaled;
  for (const TissueSet* set : {&shipped.abdomen, &shipped.cranium}) {
    for (const Tissue& tissue : set->tissues) {
      for (const TissueNumber& row : kTissueNumbers) {
        const SourcedNumber* number = row.of(tissue);
        if (!number || !number->isOutOfRange()) continue;
        scaled.push_back({tissue.id, row.key, row.unit, number->nearestPublished(), number->value});
      }
    }
  }
  return scaled;
}

Status liverPuncture(const Shipped& shipped, TissueMeasurement& out) {
  const std::vector<TissueLayer> liver{{tissueOf(shipped.abdomen, "capsule"), 1.0},
                                       {tissueOf(shipped.abdomen, "liver"), 50.0}};
  const Tool needle = needleOf(1.2);
  const double depth_mm = 40.0, above_mm = 2.0;
  const Vec3 top(0.1, 0.1, above_mm), bottom(0.1, 0.1, -depth_mm);
  const std::vector<Vec3> twice{top, bottom, top, bottom, top};
  Result<TissueTrace> trace = runStroke(softStroke(liver, needle, twice, kSpeed_mm_s));
  if (!trace) return trace.error();
  const double leg_s = (depth_mm + above_mm) / kSpeed_mm_s;
  const auto in = part(*trace, 0.0, leg_s), back = part(*trace, leg_s, 2.0 * leg_s),
             again = part(*trace, 2.0 * leg_s, 3.0 * leg_s);

  // A1: rise, drop, straight line.
  const TissueSample& peak = peakOf(part(*trace, 0.0, (above_mm + 6.0) / kSpeed_mm_s));
  const double peak_N = upwards_N(peak), peak_mm = -peak.arm_mm.z;
  const double first_mm = -firstTouch_mm(in);
  const double half_N =
      meanForce(in, 0.5 * (first_mm + peak_mm) - 0.02, 0.5 * (first_mm + peak_mm) + 0.02);
  double after_N = peak_N;
  for (const TissueSample& s : in) {
    const double on_mm = -s.arm_mm.z - peak_mm;
    if (on_mm > 0.0 && on_mm <= 1.0) after_N = std::min(after_N, upwards_N(s));
  }
  std::vector<std::pair<double, double>> straight;
  for (const TissueSample& s : in) {
    if (-s.arm_mm.z > peak_mm + 2.0 && -s.arm_mm.z < depth_mm - 0.1) {
      straight.emplace_back(-s.arm_mm.z, upwards_N(s));
    }
  }
  const Fit fit = line(straight);
  const auto A1 = [&](const char* quantity, const char* unit, double ours,
                      std::optional<double> low, std::optional<double> high, NumberUse use) {
    out.rows.push_back(row("A1", quantity, unit, ours, low, high, BandKind::estimate, use,
                           kEstimated, "estimate"));
  };
  A1("force at half the travel, of the peak", "", half_N / peak_N, {}, 0.35, NumberUse::fitted);
  A1("peak", "N", peak_N, 0.3, 2.0, NumberUse::fitted);
  A1("drop within 1 mm, of the peak", "", (peak_N - after_N) / peak_N, 0.2, 0.7, NumberUse::fitted);
  A1("straightness after the drop, R2", "", fit.r2, 0.9, {}, NumberUse::predicted);
  A1("slope after the drop", "mN/mm", 1000.0 * fit.slope, 5.0, 40.0, NumberUse::fitted);
  out.curves.push_back({"A1", "A needle 1.2 mm wide into liver, 5 mm/s", "travel", "mm",
                        overDepth(in), 0.3, 2.0, "peak, estimated"});

  // A2: the same hole again.
  const double again_N = upwards_N(
      peakOf(part(*trace, 2.0 * leg_s, 2.0 * leg_s + (above_mm + peak_mm + 2.0) / kSpeed_mm_s)));
  out.rows.push_back(row("A2", "peak in the old hole, of the first", "", again_N / peak_N, {}, 0.3,
                         BandKind::estimate, NumberUse::predicted, kEstimated, "estimate"));
  const double area_m2 = 1.2e-3 * 0.001 * depth_mm;
  out.rows.push_back(row("A2", "work beyond that of the old hole, by cut area", "J/m2",
                         (work_J(in) - work_J(again)) / area_m2, 76.0, 225.0, BandKind::published,
                         NumberUse::fitted,
                         "Gokgol 2012 (10.1016/j.medengphy.2011.09.030); Liu 2022 "
                         "(10.1186/s10033-022-00767-4), table 2",
                         "measured; the range second-hand"));
  out.curves.push_back({"A2", "The same hole again", "travel", "mm", overDepth(again)});

  // A3: out of it.
  int opposed = 0, moving = 0;
  for (const TissueSample& s : back) {
    if (-s.arm_mm.z > depth_mm - 4.0 || -s.arm_mm.z < 1.5) continue;
    ++moving;
    opposed += upwards_N(s) <= 0.0;
  }
  const double out_N = -meanForce(back, 10.0, 30.0), rubs_N = meanForce(again, 10.0, 30.0);
  double left_N = 0.0;
  for (const TissueSample& s : back) {
    if (s.arm_mm.z > 1.0) left_N = std::max(left_N, glm::length(s.demanded_N));
  }
  const auto A3 = [&](const char* quantity, const char* unit, double ours, double low,
                      double high) {
    out.rows.push_back(row("A3", quantity, unit, ours, low, high, BandKind::estimate,
                           NumberUse::predicted, kEstimated, "estimate"));
  };
  A3("share of the way out against which it pulls", "", double(opposed) / moving, 1.0, 1.0);
  A3("pull, of the friction of the way in", "", out_N / rubs_N, 0.8, 1.2);
  A3("force at exit", "N", left_N, 0.0, 0.0);
  out.curves.push_back({"A3", "Withdrawal", "travel", "mm", overDepth(back)});

  // A5: the speed.
  double least_N = peak_N, most_N = peak_N, sum_N = peak_N;
  for (double mm_per_s : {1.0, 10.0}) {
    Result<TissueTrace> other =
        runStroke(softStroke(liver, needle, {top, Vec3(0.1, 0.1, -6.0)}, mm_per_s));
    if (!other) return other.error();
    const double other_N = upwards_N(peakOf(other->samples));
    least_N = std::min(least_N, other_N);
    most_N = std::max(most_N, other_N);
    sum_N += other_N;
    if (mm_per_s > 5.0) {
      out.curves.push_back(
          {"A5", "The same at 10 mm/s", "travel", "mm", overDepth(other->samples)});
    }
  }
  out.rows.push_back(row("A5", "change of the peak from 1 to 10 mm/s", "%",
                         100.0 * 3.0 * (most_N - least_N) / sum_N, {}, 15.0, BandKind::estimate,
                         NumberUse::predicted,
                         "estimate of the comparison after Frick 2001 "
                         "(10.1016/S0021-9290(01)00099-9): none, in skin",
                         "estimate"));
  return {};
}

Status skinToKidney(const Shipped& shipped, TissueMeasurement& out) {
  const TissueSet& set = shipped.abdomen;
  const double path_mm = 60.0;
  Result<TissueTrace> trace = runStroke(
      softStroke({{tissueOf(set, "skin"), 4.0},
                  {tissueOf(set, "fat"), 18.0},
                  {tissueOf(set, "muscle"), 26.0},
                  {tissueOf(set, "kidney"), 20.0}},
                 needleOf(1.27), {Vec3(0.1, 0.1, 2.0), Vec3(0.1, 0.1, -path_mm)}, kSpeed_mm_s));
  if (!trace) return trace.error();
  const TissueSample& peak = peakOf(part(*trace, 0.0, 14.0 / kSpeed_mm_s));
  std::vector<std::pair<double, double>> path;
  for (const TissueSample& s : trace->samples) {
    if (-s.arm_mm.z > -peak.arm_mm.z + 0.5) path.emplace_back(-s.arm_mm.z, upwards_N(s));
  }
  constexpr const char* kSource = "J Endourol 2016-17 (10.1089/end.2016.0342)";
  out.rows.push_back(row("A4", "peak at the skin", "N", upwards_N(peak), 2.2, 3.3,
                         BandKind::published, NumberUse::fitted, kSource, "measured"));
  out.rows.push_back(row("A4", "mean slope of the path to the kidney", "mN/mm",
                         1000.0 * line(path).slope, 35.0, 59.0, BandKind::published,
                         NumberUse::fitted, kSource, "measured"));
  out.curves.push_back({"A4", "An access needle from skin to kidney", "travel", "mm",
                        overDepth(trace->samples), 2.2, 3.3, "peak at the skin, measured"});
  return {};
}

Status duraPuncture(const Shipped& shipped, TissueMeasurement& out) {
  const TissueSet& set = shipped.cranium;
  Result<TissueTrace> trace =
      runStroke(softStroke({{tissueOf(set, "dura"), 0.5}, {tissueOf(set, "brain"), 20.0}},
                           needleOf(0.9), {Vec3(0.1, 0.1, 1.0), Vec3(0.1, 0.1, -10.0)}, 3.3));
  if (!trace) return trace.error();
  const double first_mm = -firstTouch_mm(trace->samples);
  const TissueSample& peak = peakOf(trace->samples);
  out.rows.push_back(row("A6", "travel until the dura gives way", "mm", -peak.arm_mm.z - first_mm,
                         2.0, 6.0, BandKind::published, NumberUse::fitted,
                         "Zarzur and Goncalves 1992 (Reg Anesth 17(4):216)", "measured"));
  out.rows.push_back(row("A6", "drop within 20 ms", "N", dropWithin(trace->samples, 0.020), 0.2,
                         2.0, BandKind::estimate, NumberUse::fitted,
                         "estimate of the comparison after PLOS ONE 2021 "
                         "(10.1371/journal.pone.0247346)",
                         "derived"));
  out.curves.push_back({"A6", "A spinal needle 0.9 mm wide through dura of 0.5 mm", "travel", "mm",
                        overDepth(trace->samples)});
  return {};
}

Status brainStrokes(const Shipped& shipped, TissueMeasurement& out) {
  const std::vector<TissueLayer> brain{{tissueOf(shipped.cranium, "brain"), 20.0}};
  constexpr const char* kSource = "Marcus 2014 (10.1002/rcs.1568), cadaver, medians";
  const std::vector<Vec3> places{{-6, 0.1, 1}, {-6, 0.1, -5}, {4, 0.1, -5}};
  TissueStroke stroke = softStroke(brain, bladeOf(16.0), places, kSpeed_mm_s);
  stroke.wide_mm = 36.0;
  Result<TissueTrace> cut = runStroke(stroke);
  if (!cut) return cut.error();
  double sum_N = 0.0;
  int count = 0;
  std::vector<std::pair<double, double>> along;
  for (const TissueSample& s : cut->samples) {
    if (s.arm_mm.z > -5.0 || s.arm_mm.x < -4.0) continue;
    const double force_N = -s.demanded_N.x;
    along.emplace_back(s.arm_mm.x + 6.0, force_N);
    sum_N += glm::length(s.demanded_N);
    ++count;
  }
  out.rows.push_back(row("A7", "stroke of a blade over 10 mm, mean", "N", sum_N / count, 0.02, 0.15,
                         BandKind::published, NumberUse::fitted, kSource, "measured"));
  out.curves.push_back({"A7", "A blade through brain, 5 mm deep", "travel", "mm", along, 0.02, 0.15,
                        "carrying incision, measured"});
  Result<TissueTrace> stab =
      runStroke(softStroke(brain, needleOf(1.2), {{0.1, 0.1, 0}, {0.1, 0.1, -5}}, kSpeed_mm_s));
  if (!stab) return stab.error();
  std::vector<double> forces_N;
  for (const TissueSample& s : stab->samples) forces_N.push_back(upwards_N(s));
  std::nth_element(forces_N.begin(), forces_N.begin() + std::ptrdiff_t(forces_N.size() / 2),
                   forces_N.end());
  out.rows.push_back(row("A7", "a stab of 5 mm, 1.2 mm wide, median", "N",
                         forces_N[forces_N.size() / 2], 0.0, 0.02, BandKind::published,
                         NumberUse::predicted, kSource, "measured"));
  TissueStroke press =
      softStroke(brain, *makeTool({ToolKind::burr, 30.0, 32, 3.0, 8}),
                 {{0.1, 0.1, 1}, {0.1, 0.1, -3}, {0.1, 0.1, -3.0001}}, kSpeed_mm_s);
  press.wide_mm = 36.0;
  Result<TissueTrace> pressed = runStroke(press);
  if (!pressed) return pressed.error();
  out.rows.push_back(row("A7", "a ball of 6 mm pressed in by 3 mm", "N",
                         upwards_N(pressed->samples.back()), 0.03, 0.18, BandKind::published,
                         NumberUse::predicted, kSource, "measured"));
  return {};
}

Status liverCut(const Shipped& shipped, TissueMeasurement& out) {
  const Tissue liver = tissueOf(shipped.abdomen, "liver");
  const double edge_mm = 10.0;
  const std::vector<Vec3> places{{-12, 0.1, 1}, {-12, 0.1, -edge_mm}, {12, 0.1, -edge_mm}};
  TissueStroke stroke = softStroke({{liver, 30.0}}, bladeOf(16.0), places, kSpeed_mm_s);
  stroke.wide_mm = 44.0;
  Result<TissueTrace> cut = runStroke(stroke);
  if (!cut) return cut.error();
  std::vector<std::pair<double, double>> along;
  for (const TissueSample& s : cut->samples) {
    if (s.arm_mm.z > -edge_mm || s.arm_mm.x < -4.0) continue;
    along.emplace_back(s.arm_mm.x + 12.0, -s.demanded_N.x);
  }
  double sum_N = 0.0;
  int drops = 0;
  std::vector<double> straight;
  std::vector<std::pair<double, double>> rise;
  for (std::size_t i = 0; i < along.size(); ++i) {
    sum_N += along[i].second;
    if (i > 0 && along[i].second < 0.95 * along[i - 1].second) {
      ++drops;
      if (rise.size() > 8) straight.push_back(line(rise).r2);
      rise.clear();
    }
    rise.push_back(along[i]);
  }
  double least = straight.empty() ? 0.0 : straight[0];
  for (double r2 : straight) least = std::min(least, r2);
  const double way_mm = along.back().first - along.front().first;
  const double expected_N = 0.001 * edge_mm * liver.toughness_J_per_m2->value;
  out.rows.push_back(row("A8", "drops by 10 mm of the cut", "", 10.0 * drops / way_mm, 1.0, {},
                         BandKind::estimate, NumberUse::fitted,
                         "estimate of the comparison after Chanthasopeephan 2003 "
                         "(10.1114/1.1624601): a saw-tooth, spacing not read",
                         "estimate"));
  out.rows.push_back(row("A8", "straightness of the rises, least R2", "", least, 0.9, {},
                         BandKind::estimate, NumberUse::fitted, kEstimated, "estimate"));
  out.rows.push_back(row("A8", "mean, of toughness times engaged edge", "",
                         sum_N / double(along.size()) / expected_N, 0.7, 1.3, BandKind::estimate,
                         NumberUse::fitted, kEstimated, "estimate"));
  out.curves.push_back({"A8", "A blade through liver, 10 mm of its edge engaged", "travel", "mm",
                        along, 0.7 * expected_N, 1.3 * expected_N,
                        "toughness times engaged edge, 30 %"});
  return {};
}

namespace {

TissueStroke burrStroke(const Tissue& bone, double motor_W, double thick_mm) {
  TissueStroke stroke;
  stroke.layers = {{bone, thick_mm}};
  stroke.tool = *makeTool({ToolKind::burr, 30.0, 32, 3.0, 8, BurrShape::sphere, 0.0, motor_W});
  stroke.laws = kBoneLaws;
  stroke.wide_mm = 36.0;
  stroke.peak_force_N = 30.0;
  return stroke;
}

}  // namespace

Status burrByPush(const Shipped& shipped, TissueMeasurement& out) {
  const Tissue bone = tissueOf(shipped.cranium, "bone");
  std::vector<double> rates;
  std::vector<std::pair<double, double>> curve;
  for (double push_N : {0.0, 2.0, 5.0, 10.0}) {
    TissueStroke stroke = burrStroke(bone, 4.0, 40.0);
    TissueHand hand;
    hand.push_N = push_N;
    hand.mass_kg = 0.2;
    stroke.hand = hand;
    stroke.seconds = 1.5;
    stroke.way = [](double) { return Vec3(0.1, 0.1, 0.0); };
    Result<TissueTrace> trace = runStroke(stroke);
    if (!trace) return trace.error();
    int late = 0;
    for (const TissueSample& s : trace->samples) late += s.t_s >= 0.5 ? s.removed_voxels : 0;
    rates.push_back(late * std::pow(stroke.spacing_mm, 3.0) / 1.0);
    curve.emplace_back(push_N, rates.back());
  }
  double rising = rates[1] - rates[0];
  for (std::size_t i = 1; i < rates.size(); ++i) rising = std::min(rising, rates[i] - rates[i - 1]);
  out.rows.push_back(row("A9", "rate at no push", "mm3/s", rates[0], 0.0, 0.0, BandKind::estimate,
                         NumberUse::predicted, kEstimated, "estimate"));
  out.rows.push_back(row("A9", "least rise of the rate from push to push", "mm3/s", rising, 1e-9,
                         {}, BandKind::estimate, NumberUse::predicted, kEstimated, "estimate"));
  out.rows.push_back(row("A9", "rate at 5 N", "mm3/s", rates[2], 3.0, 30.0, BandKind::estimate,
                         NumberUse::predicted, kEstimated, "estimate"));
  out.curves.push_back({"A9", "Rate of a burr by push", "push", "N", curve, 3.0, 30.0,
                        "rate at 5 N, estimated", "rate", "mm3/s"});
  return {};
}

Status energyOfBurr(const Shipped& shipped, TissueMeasurement& out) {
  const Tissue bone = tissueOf(shipped.cranium, "bone");
  const double u = bone.cutting_J_per_mm3->value, motor_W = 0.6;
  std::vector<std::pair<double, double>> curve;
  for (double spacing_mm : {0.3, 0.5, 1.0}) {
    TissueStroke stroke = burrStroke(bone, motor_W, 14.0);
    stroke.spacing_mm = spacing_mm;
    stroke.wide_mm = 24.0;
    goThrough(stroke, {{0.1, 0.1, 0.2}, {0.1, 0.1, -8.0}}, 2.0);
    Result<TissueTrace> trace = runStroke(stroke);
    if (!trace) return trace.error();
    double first_s = stroke.seconds;
    for (const TissueSample& s : trace->samples) {
      if (glm::length(s.demanded_N) > 0.0) {
        first_s = s.t_s;
        break;
      }
    }
    const double ours = motor_W * (stroke.seconds - first_s) / trace->removed_mm3 / u;
    curve.emplace_back(spacing_mm, ours);
    const std::string quantity =
        "motor's work by removed volume, of u, voxels of " + plainNumber(spacing_mm) + " mm";
    out.rows.push_back(row("A10", quantity.c_str(), "", ours, 0.9, 1.1, BandKind::estimate,
                           NumberUse::predicted, kEstimated, "estimate"));
  }
  out.curves.push_back({"A10", "Energy by volume on three grids", "voxel", "mm", curve, 0.9, 1.1,
                        "10 %", "energy by volume / u", ""});
  return {};
}

Status burrThroughVault(const Shipped& shipped, TissueMeasurement& out) {
  // One class today: outer table, diploe and inner table are the same bone.
  const Tissue bone = tissueOf(shipped.cranium, "bone");
  TissueStroke stroke = burrStroke(bone, 4.0, 2.0);
  stroke.layers = {{bone, 2.0}, {bone, 3.0}, {bone, 2.0}};
  goThrough(stroke, {{0.1, 0.1, 0.5}, {0.1, 0.1, -12.0}}, 1.0);
  Result<TissueTrace> trace = runStroke(stroke);
  if (!trace) return trace.error();
  // The ball's foremost point in each table.
  const double outer_N = meanForce(trace->samples, 0.5, 2.0);
  const double diploe_N = meanForce(trace->samples, 2.5, 4.5);
  const double inner_N = meanForce(trace->samples, 5.5, 6.9);
  const double through_N = meanForce(trace->samples, 9.8, 10.2);
  const auto A11 = [&](const char* quantity, double ours, double high) {
    out.rows.push_back(row("A11", quantity, "", ours, {}, high, BandKind::estimate,
                           NumberUse::predicted, kEstimated, "estimate"));
  };
  A11("thrust in the diploe, of that in the outer table", diploe_N / outer_N, 0.5);
  A11("thrust in the inner table, of that in the outer one", inner_N / outer_N, 1.0);
  A11("thrust a radius after breakthrough, of that in the outer table", through_N / outer_N, 0.1);
  out.curves.push_back(
      {"A11", "A burr through the vault at 1 mm/s", "travel", "mm", overDepth(trace->samples)});
  return {};
}

Status burrHoleByHand(const Shipped& shipped, TissueMeasurement& out) {
  const Tissue bone = tissueOf(shipped.cranium, "bone");
  TissueStroke stroke = burrStroke(bone, 4.0, 7.0);
  stroke.hand = TissueHand{};
  goThrough(stroke, {{0.1, 0.1, 1.0}, {0.1, 0.1, -12.0}}, 3.0);
  Result<TissueTrace> trace = runStroke(stroke);
  if (!trace) return trace.error();
  double sum_N = 0.0, most_N = 0.0;
  int count = 0;
  for (const TissueSample& s : trace->samples) {
    const double force_N = glm::length(s.demanded_N);
    if (!(force_N > 0.0)) continue;
    sum_N += force_N;
    most_N = std::max(most_N, force_N);
    ++count;
  }
  constexpr const char* kSource =
      "Investigation of variable factors in drilling bone (J Oral Surg "
      "1977, as remembered); 20 operators, animal bone";
  out.rows.push_back(row("A12", "hand on the burr, mean", "N", count > 0 ? sum_N / count : 0.0, 4.0,
                         19.0, BandKind::published, NumberUse::predicted, kSource, "measured"));
  out.rows.push_back(row("A12", "hand on the burr, peak", "N", most_N, 6.0, 24.0,
                         BandKind::published, NumberUse::predicted, kSource, "measured"));
  out.curves.push_back({"A12", "A burr hole by a hand of 1000 N/m", "travel", "mm",
                        overDepth(trace->samples), 4.0, 19.0, "mean, measured"});
  return {};
}

}  // namespace trephine::tissue_experiments
