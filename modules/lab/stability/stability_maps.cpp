#include "lab/stability/stability_maps.h"

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartXY.h>
#include <vtkContext2D.h>
#include <vtkContextItem.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkPlotLine.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "base/file.h"
#include "base/math.h"
#include "lab/common/chart_picture.h"
#include "render/display_probe.h"
#include "render/picture.h"

namespace trephine {

namespace {

constexpr std::size_t kMostCurves = 4;  // a family: masses, or encoder steps

// The same in every locale; 1e6, not 1e+06.
std::string number(double value, int digits = 4) {
  char text[40];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits);
  std::string result(text, end.ptr);
  const std::size_t e = result.find('e');
  if (e == std::string::npos) return result;
  const bool negative = result[e + 1] == '-';
  std::size_t first = e + 2;
  while (first + 1 < result.size() && result[first] == '0') ++first;
  return result.substr(0, e + 1) + (negative ? "-" : "") + result.substr(first);
}

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto same = [](double a, double b) { return b - a <= 1e-9 * b; };
  values.erase(std::unique(values.begin(), values.end(), same), values.end());
  return values;
}

std::string listed(const std::vector<double>& values, const std::string& unit, double scale = 1.0) {
  std::string text;
  if (values.size() > 5) {
    text = std::to_string(values.size()) + " values from " + number(values.front() * scale) +
           " to " + number(values.back() * scale);
  } else {
    for (const double value : values) {
      if (!text.empty()) text += ", ";
      text += number(value * scale);
    }
  }
  return text + " " + unit;
}

// At most `most` of them, evenly through the order, the first and the last among them.
std::vector<double> some(const std::vector<double>& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<double> chosen;
  for (std::size_t i = 0; i < most; ++i) {
    chosen.push_back(values[i * (values.size() - 1) / (most - 1)]);
  }
  return chosen;
}

std::string ofHowMany(std::size_t shown, std::size_t all, const std::string& things) {
  if (shown == all) return {};
  return " (" + std::to_string(shown) + " of " + std::to_string(all) + " " + things + ")";
}

using Hand = std::pair<double, double>;  // b, k: the lightest first

std::string described(const Hand& hand) {
  if (hand == Hand()) return "none";
  return number(hand.second) + " N/m + " + number(hand.first) + " N s/m";
}

std::string listed(const std::set<Hand>& hands) {
  std::string result;
  if (hands.size() <= 4) {
    for (const Hand& hand : hands) result += (result.empty() ? "" : "; ") + described(hand);
    return result;
  }
  double softest = hands.begin()->second, stiffest = 0.0;
  for (const Hand& hand : hands) {
    softest = std::min(softest, hand.second);
    stiffest = std::max(stiffest, hand.second);
  }
  return std::to_string(hands.size()) + " different ones from " + number(softest) + " to " +
         number(stiffest) + " N/m and " + number(hands.begin()->first) + " to " +
         number(hands.rbegin()->first) + " N s/m";
}

// What may stand in a file name and in a picture: names come from files that others write.
std::string forFile(const std::string& name) {
  std::string safe;
  for (const char c : name.substr(0, 80)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || (c == '.' && !safe.empty());
    safe += plain ? c : '_';
  }
  return safe.empty() ? "controller" : safe;
}

std::string forPicture(const std::string& name) {
  std::string safe;
  for (const char c : name.substr(0, 50)) safe += c >= ' ' && c <= '~' ? c : '?';
  return name.size() > 50 ? safe + "..." : safe;
}

bool possible(const MapCell& cell) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  const auto notNegative = [](double value) { return std::isfinite(value) && value >= 0.0; };
  return positive(cell.mass_kg) && positive(cell.period_s) && cell.delay_samples >= 0 &&
         notNegative(cell.encoder_m) && notNegative(cell.hand_k) && notNegative(cell.hand_b) &&
         notNegative(cell.tissue_b) && notNegative(cell.tissue_k);
}

std::vector<LimitCurve> damperLimits(const std::vector<double>& masses) {
  std::vector<LimitCurve> curves;
  const std::vector<double> shown = some(masses, kMostCurves);
  for (const double mass : shown) {
    const std::string m = "m = " + number(mass, 3) + " kg";
    curves.push_back({m, "b = 2 m/T, no hand, " + m, false,
                      [=](double period) { return damperLimit_Ns_per_m(mass, period); }});
  }
  curves.back().legend += ofHowMany(shown.size(), masses.size(), "masses");
  return curves;
}

// A marker may hold cells with and without a hand, for which the limits lie far apart: both are
// drawn. The lightest hand is the one that damps least.
std::vector<LimitCurve> wallLimits(const std::set<Hand>& hands,
                                   const std::vector<double>& encoders) {
  std::vector<LimitCurve> curves;
  const auto colgate = [&](const std::string& name, const std::string& who, double damping) {
    curves.push_back({name, "Colgate & Schenkel K = 2 b/T, b = " + who, true,
                      [=](double period) { return wallLimit_N_per_m(damping, period); }});
  };
  const std::string arm = number(kArmDamping_Ns_per_m);
  double damping = kArmDamping_Ns_per_m;
  std::string same = "b = " + arm + " N s/m";
  const auto lightest = hands.upper_bound(Hand());
  if (lightest != hands.end()) {
    damping += lightest->first;
    same = "b with hand";
    colgate("C&S, hand",
            arm + " (arm) + " + number(lightest->first) +
                " N s/m (lightest hand: " + described(*lightest) + ")",
            damping);
  }
  if (hands.count(Hand())) {
    colgate("C&S, no hand", arm + " N s/m (arm, no hand)", kArmDamping_Ns_per_m);
  }
  std::vector<double> steps = encoders;
  std::erase(steps, 0.0);
  const std::vector<double> shown = some(steps, kMostCurves - 1);
  const std::string formula = "Abbott & Okamura 2005 K = min(2 b/T, 2 f_c/step), " + same +
                              ", f_c = " + number(kArmFriction_N) + " N (arm), step ";
  for (const double step : shown) {
    const std::string mm = number(step * 1000.0, 3) + " mm";
    curves.push_back({"A&O, " + mm, formula + mm, false, [=](double period) {
                        return encoderLimit_N_per_m(damping, period, kArmFriction_N, step);
                      }});
  }
  if (!shown.empty()) curves.back().legend += ofHowMany(shown.size(), steps.size(), "steps");
  return curves;
}

StabilityMap mapOf(const std::string& controller, bool walls,
                   const std::vector<const MapCell*>& cells) {
  const auto tissueOf = [=](const MapCell& cell) { return walls ? cell.tissue_k : cell.tissue_b; };
  std::vector<double> masses, periods, delays, encoders, tissues, dampings;
  std::set<Hand> hands;
  for (const MapCell* cell : cells) {
    masses.push_back(cell->mass_kg);
    periods.push_back(cell->period_s);
    delays.push_back(cell->delay_samples);
    encoders.push_back(cell->encoder_m);
    tissues.push_back(tissueOf(*cell));
    dampings.push_back(cell->tissue_b);
    hands.insert({cell->hand_b, cell->hand_k});
  }
  masses = distinct(masses);
  delays = distinct(delays);
  encoders = distinct(encoders);
  dampings = distinct(dampings);

  StabilityMap map;
  map.controller = controller;
  map.walls = walls;
  map.conditions = "Mass " + listed(masses, "kg") + ";  delay " +
                   listed(delays, delays.back() == 1.0 ? "sample" : "samples") +
                   ";  encoder step " + listed(encoders, "mm", 1000.0);
  if (walls && dampings.back() > 0.0) {
    map.conditions += ";  damping of the wall " + listed(dampings, "N s/m");
  }
  map.hands = "Hand: " + listed(hands);
  map.periods = logCentres(periods, kMostCentres);
  map.tissues = logCentres(tissues, kMostCentres);
  map.periods_exact = map.periods == distinct(periods);
  map.tissues_exact = map.tissues == distinct(tissues);
  if (!map.periods_exact) {
    map.note += std::to_string(distinct(periods).size()) + " periods put together into " +
                std::to_string(map.periods.size()) + ".  ";
  }
  if (!map.tissues_exact) {
    map.note += std::to_string(distinct(tissues).size()) + (walls ? " stiffnesses" : " dampings") +
                " put together into " + std::to_string(map.tissues.size()) + ".  ";
  }
  std::map<std::pair<std::size_t, std::size_t>, MapBin> bins;
  for (const MapCell* cell : cells) {
    const std::size_t i = nearestCentre(map.periods, cell->period_s);
    const std::size_t j = nearestCentre(map.tissues, tissueOf(*cell));
    MapBin& bin = bins[{i, j}];
    bin.period_s = map.periods[i];
    bin.tissue = map.tissues[j];
    ++bin.total;
    if (!cell->stable) ++bin.unstable;
  }
  for (const auto& [where, bin] : bins) map.bins.push_back(bin);
  map.limits = walls ? wallLimits(hands, encoders) : damperLimits(masses);

  std::string hand = "all-hands";
  if (hands.size() == 1) {
    const Hand& only = *hands.begin();
    hand = only == Hand() ? "no-hand" : "hand-" + number(only.second) + "-" + number(only.first);
  }
  map.file_name = forFile(controller) + (walls ? "-walls-" : "-dampers-") + hand;
  return map;
}

}  // namespace

double damperLimit_Ns_per_m(double mass_kg, double period_s) {
  return 2.0 * mass_kg / period_s;
}

double wallLimit_N_per_m(double damping_Ns_per_m, double period_s) {
  return 2.0 * damping_Ns_per_m / period_s;
}

double encoderLimit_N_per_m(double damping_Ns_per_m, double period_s, double friction_N,
                            double encoder_m) {
  return std::min(wallLimit_N_per_m(damping_Ns_per_m, period_s), 2.0 * friction_N / encoder_m);
}

std::vector<double> logCentres(std::vector<double> values, std::size_t most) {
  values = distinct(std::move(values));
  if (values.size() < 2) return values;
  const double low = std::log10(values.front()), high = std::log10(values.back());
  const double gap = (high - low) / double(most - 1);
  bool apart = values.size() <= most;
  for (std::size_t i = 1; i < values.size() && apart; ++i) {
    apart = std::log10(values[i]) - std::log10(values[i - 1]) >= gap * (1.0 - 1e-9);
  }
  if (apart) return values;
  std::vector<double> centres(most);
  for (std::size_t i = 0; i < most; ++i) centres[i] = std::pow(10.0, low + gap * double(i));
  centres.front() = values.front();
  centres.back() = values.back();
  return centres;
}

std::size_t nearestCentre(const std::vector<double>& centres, double value) {
  const auto above = std::lower_bound(centres.begin(), centres.end(), value);
  if (above == centres.begin()) return 0;
  const std::size_t i = std::size_t(above - centres.begin());
  if (above == centres.end()) return i - 1;
  const double up = std::log10(centres[i]) - std::log10(value);
  return up < std::log10(value) - std::log10(centres[i - 1]) ? i : i - 1;
}

Result<std::vector<StabilityMap>> stabilityMaps(const std::vector<MapCell>& cells) {
  if (cells.empty()) {
    return Error{"BAD_ARGUMENT", "There is no cell to draw a map of", "the stability grid",
                 "Judge at least one cell"};
  }
  struct Kinds {
    std::vector<const MapCell*> dampers, walls;
    std::size_t left_out = 0;
  };
  std::vector<std::string> order;
  std::map<std::string, Kinds> controllers;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const MapCell& cell = cells[i];
    if (!possible(cell)) {
      return Error{"BAD_ARGUMENT", "A cell of the stability grid holds a value that cannot be",
                   "cell " + std::to_string(i + 1) + ", controller " + forPicture(cell.controller),
                   "Mass and period must lie above 0, all else at 0 or above"};
    }
    const auto [entry, first] = controllers.try_emplace(cell.controller);
    if (first) order.push_back(cell.controller);
    if (cell.tissue_k > 0.0) {
      entry->second.walls.push_back(&cell);
    } else if (cell.tissue_b > 0.0) {
      entry->second.dampers.push_back(&cell);
    } else {
      ++entry->second.left_out;
    }
  }
  std::vector<StabilityMap> maps;
  std::set<std::string> names;
  for (const std::string& controller : order) {
    const Kinds& kinds = controllers[controller];
    for (const bool walls : {false, true}) {
      const auto& of_kind = walls ? kinds.walls : kinds.dampers;
      if (of_kind.empty()) continue;
      StabilityMap map = mapOf(controller, walls, of_kind);
      if (!walls && kinds.left_out > 0) {
        map.note += std::to_string(kinds.left_out);
        map.note += kinds.left_out == 1 ? " cell" : " cells";
        map.note += " with b = 0 left out.";
      }
      std::string name = map.file_name;  // two controllers may become one name
      for (int i = 2; !names.insert(name).second; ++i) {
        name = map.file_name + "-" + std::to_string(i);
      }
      map.file_name = name + ".png";
      maps.push_back(std::move(map));
    }
  }
  if (maps.empty()) {
    return Error{"BAD_ARGUMENT", "Every cell of the stability grid has a damper of b = 0",
                 "the stability grid", "Give dampers or walls above 0"};
  }
  return maps;
}

namespace {

constexpr int kWidth = 1200, kHeight = 900;  // lengths on the page are pixels of the picture
constexpr float kLeft = 120.0f, kBottom = 248.0f, kAcross = 900.0f, kUp = 524.0f;  // the plot
constexpr float kFringeX = 56.0f, kFringeY = 26.0f;  // between the outer markers and the edge
constexpr int kFine = kChartFine;

using Colour = std::array<unsigned char, 3>;
constexpr Colour kBlack{0, 0, 0}, kWhite{255, 255, 255}, kGrey{90, 90, 90}, kEdge{60, 60, 60};

// Told apart by shape and by lightness as well, for those who see colours otherwise.
enum class Shape { pill, rectangle, hexagon };
struct Look {
  Shape shape;
  Colour fill, ink;
  const char* legend;
};
constexpr std::array<Look, 5> kLooks{{
    {Shape::pill, {46, 170, 125}, kBlack, "every cell stable"},
    {Shape::rectangle, {255, 239, 170}, kBlack, "up to a third unstable"},
    {Shape::rectangle, {252, 202, 70}, kBlack, "up to two thirds unstable"},
    {Shape::rectangle, {240, 145, 25}, kBlack, "more than two thirds unstable"},
    {Shape::hexagon, {165, 15, 38}, kWhite, "every cell unstable"},
}};

bool mixed(const MapBin& bin) {
  return bin.unstable > 0 && bin.unstable < bin.total;
}

const Look& lookOf(const MapBin& bin) {
  if (!mixed(bin)) return kLooks[bin.unstable == 0 ? 0 : 4];
  if (3 * bin.unstable <= bin.total) return kLooks[1];
  return 3 * bin.unstable <= 2 * bin.total ? kLooks[2] : kLooks[3];
}

struct Stroke {
  Colour colour = kEdge;
  float width = 1.0f;
  std::array<float, 4> dashes{};  // on and off in turn; all 0: solid
};
constexpr std::array<Stroke, 2> kGuides{{{kBlack, 2.5f, {}}, {kBlack, 2.5f, {3, 5, 3, 5}}}};
constexpr std::array<Stroke, kMostCurves> kStrokes{{{{0, 92, 175}, 2.5f, {10, 6, 10, 6}},
                                                    {{150, 45, 140}, 2.5f, {13, 5, 3, 5}},
                                                    {{110, 60, 0}, 2.5f, {20, 5, 20, 5}},
                                                    {{0, 115, 145}, 2.5f, {3, 4, 3, 4}}}};

void apply(const Stroke& stroke, vtkPen* pen) {
  pen->SetColor(stroke.colour[0], stroke.colour[1], stroke.colour[2]);
  pen->SetOpacity(255);
  pen->SetWidth(stroke.width * kFine);
  pen->SetLineType(vtkPen::SOLID_LINE);
}

// The pieces of a line that are inked, two points each. Not VTK's dashes: they do not grow with the
// line.
std::vector<glm::vec2> inked(const std::vector<glm::vec2>& line,
                             const std::array<float, 4>& dashes) {
  std::vector<glm::vec2> pieces;
  float along = 0.0f;
  const float period = dashes[0] + dashes[1] + dashes[2] + dashes[3];
  for (std::size_t i = 1; i < line.size(); ++i) {
    const float at = period > 0.0f ? std::fmod(along, period) : 0.0f;
    const bool on = period == 0.0f || at < dashes[0] ||
                    (at >= dashes[0] + dashes[1] && at < period - dashes[3]);
    if (on) pieces.insert(pieces.end(), {line[i - 1], line[i]});
    along += glm::distance(line[i - 1], line[i]);
  }
  return pieces;
}

// One logarithmic axis. The chart's own axes count pixels of the page, so that a single value or a
// narrow range has its map as well: VTK's logarithmic axes want decades, and its plots hold floats.
struct LogAxis {
  double low = 0.0, high = 1.0;  // decades
  float from = 0.0f, length = 1.0f;
  float pixel(double value) const {
    return from + length * float((std::log10(value) - low) / (high - low));
  }
  double decadeAt(float pixel) const {
    return low + double((pixel - from) / length) * (high - low);
  }
  double decades(float pixels) const { return double(pixels / length) * (high - low); }
  bool holds(double value) const {
    const double at = std::log10(value);
    return at >= low && at <= high;
  }
  float spacing(const std::vector<double>& centres) const {
    float least = length;
    for (std::size_t i = 1; i < centres.size(); ++i) {
      least = std::min(least, pixel(centres[i]) - pixel(centres[i - 1]));
    }
    return least;
  }
};

// From `low` to `high` decades with a fringe for half a marker.
LogAxis axisOver(double low, double high, float from, float length, float fringe) {
  const double range = high - low;
  const double margin = range > 0.0 ? range * double(fringe / (length - 2.0f * fringe)) : 0.2;
  return {low - margin, high + margin, from, length};
}

LogAxis periodAxis(const StabilityMap& map) {
  return axisOver(std::log10(map.periods.front()), std::log10(map.periods.back()), kLeft, kAcross,
                  kFringeX);
}

// The curves belong to the map too, at least where they end, unless that is far from all markers or
// would press these together.
LogAxis tissueAxis(const StabilityMap& map, const LogAxis& x) {
  constexpr double kFar = 2.0;
  constexpr float kLeastSpacing = 20.0f;
  const double first = std::log10(map.tissues.front()), last = std::log10(map.tissues.back());
  double low = first, high = last;
  LogAxis axis = axisOver(low, high, kBottom, kUp, kFringeY);
  for (const LimitCurve& limit : map.limits) {
    for (const double period : {map.periods.back(), std::pow(10.0, x.high)}) {
      const double end = std::log10(limit.at(period));
      if (!(end > first - kFar && end < last + kFar)) continue;
      const LogAxis wider =
          axisOver(std::min(low, end), std::max(high, end), kBottom, kUp, kFringeY);
      if (wider.spacing(map.tissues) < kLeastSpacing) continue;
      low = std::min(low, end);
      high = std::max(high, end);
      axis = wider;
    }
  }
  return axis;
}

// The values themselves where their labels have room, else round numbers.
std::vector<double> ticksOf(const LogAxis& axis, const std::vector<double>& centres, bool exact,
                            float room) {
  const double gap = axis.decades(room);
  std::vector<double> own;
  for (const double centre : centres) {
    if (own.empty() || std::log10(centre) - std::log10(own.back()) >= gap) own.push_back(centre);
  }
  if (exact && own.size() == centres.size()) return own;
  const int every = std::max(1, int(std::ceil(gap)));
  const bool halves = axis.high - axis.low < 3.0 && gap < 0.3;
  std::vector<double> round;
  for (int decade = int(std::floor(axis.low)); decade <= axis.high; ++decade) {
    if (decade % every != 0) continue;
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, decade);
      if ((digit == 1.0 || halves) && axis.holds(value)) round.push_back(value);
    }
  }
  return round.size() < 2 ? own : round;
}

// The part of the curve that lies on the map, pixel by pixel; it falls, so that it is one piece.
std::vector<glm::vec2> onMap(const LimitCurve& limit, const LogAxis& x, const LogAxis& y) {
  std::vector<glm::vec2> points;
  for (int i = 0; i <= int(x.length); ++i) {
    const float at = x.from + float(i);
    const double value = limit.at(std::pow(10.0, x.decadeAt(at)));
    if (y.holds(value)) points.push_back({at, y.pixel(value)});
  }
  return points;
}

struct DrawnCurve {
  const LimitCurve* limit = nullptr;
  Stroke stroke;
  bool visible = false;
};

struct Sheet {
  const StabilityMap& map;
  LogAxis x, y;
  std::vector<double> ticks_x, ticks_y;
  std::vector<DrawnCurve> curves;
  float marker_width, marker_height;
};

// The grid and the markers, under the curves.
class Ground : public vtkContextItem {
 public:
  static Ground* New();
  vtkTypeMacro(Ground, vtkContextItem);
  const Sheet* sheet = nullptr;

  bool Paint(vtkContext2D* painter) override {
    apply({{225, 225, 225}}, painter->GetPen());
    const float right = kLeft + kAcross, top = kBottom + kUp;
    for (const double tick : sheet->ticks_x) {
      const float at = sheet->x.pixel(tick);
      line(painter, at, kBottom, at, top);
    }
    for (const double tick : sheet->ticks_y) {
      const float at = sheet->y.pixel(tick);
      line(painter, kLeft, at, right, at);
    }
    for (const MapBin& bin : sheet->map.bins) {
      marker(painter, lookOf(bin), sheet->x.pixel(bin.period_s), sheet->y.pixel(bin.tissue),
             sheet->marker_width, sheet->marker_height);
    }
    return true;
  }

  static void line(vtkContext2D* painter, float x1, float y1, float x2, float y2) {
    painter->DrawLine(x1 * kFine, y1 * kFine, x2 * kFine, y2 * kFine);
  }

  static void marker(vtkContext2D* painter, const Look& look, float at_x, float at_y, float width,
                     float height) {
    const float w = 0.5f * width, h = 0.5f * height;
    std::vector<float> points;
    const auto add = [&](float dx, float dy) {
      points.push_back((at_x + dx) * kFine);
      points.push_back((at_y + dy) * kFine);
    };
    if (look.shape == Shape::rectangle) {
      for (const auto& [dx, dy] : {std::pair{-w, -h}, {w, -h}, {w, h}, {-w, h}}) add(dx, dy);
    } else if (look.shape == Shape::hexagon) {
      const float t = w - std::min(0.5f * h, 0.3f * w);
      for (const auto& [dx, dy] :
           {std::pair{-w, 0.0f}, {-t, -h}, {t, -h}, {w, 0.0f}, {t, h}, {-t, h}}) {
        add(dx, dy);
      }
    } else {
      const float r = std::min(w, h);
      for (const float side : {1.0f, -1.0f}) {
        for (int i = -6; i <= 6; ++i) {
          const float angle = std::numbers::pi_v<float> / 12.0f * float(i);
          add(side * (w - r + r * std::cos(angle)), side * r * std::sin(angle));
        }
      }
    }
    const int n = int(points.size() / 2);
    painter->GetPen()->SetLineType(vtkPen::NO_PEN);
    painter->GetBrush()->SetColor(look.fill[0], look.fill[1], look.fill[2], 255);
    painter->DrawPolygon(points.data(), n);
    points.push_back(points[0]);
    points.push_back(points[1]);
    apply({}, painter->GetPen());
    painter->DrawPoly(points.data(), n + 1);
  }

 protected:
  Ground() = default;
};
vtkStandardNewMacro(Ground);

// Texts and the legend, over the curves.
class Lettering : public vtkContextItem {
 public:
  static Lettering* New();
  vtkTypeMacro(Lettering, vtkContextItem);
  const Sheet* sheet = nullptr;

  bool Paint(vtkContext2D* painter) override {
    painter_ = painter;
    headings();
    axisTitles();
    counts();
    curveNames();
    legend();
    return true;
  }

 protected:
  Lettering() = default;

 private:
  void use(int size, Colour colour = kBlack, bool bold = false, bool centred = false) {
    vtkNew<vtkTextProperty> look;
    look->SetFontFamilyToArial();
    look->SetFontSize(size * kFine);
    look->SetBold(bold);
    look->SetColor(colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
    if (centred) look->SetJustificationToCentered();
    look->SetVerticalJustificationToCentered();
    painter_->ApplyTextProp(look);
  }

  void words(float at_x, float at_y, const std::string& text) {
    painter_->DrawString(at_x * kFine, at_y * kFine, text);
  }

  float widthOf(const std::string& text) {
    float bounds[4];
    painter_->ComputeStringBounds(text, bounds);
    return bounds[2] / kFine;
  }

  // So that a long text is not cut off.
  int sizeThatFits(const std::string& text, float room, int size, bool bold = false) {
    for (; size > 9; --size) {
      use(size, kBlack, bold);
      if (widthOf(text) <= room) break;
    }
    return size;
  }

  void headings() {
    constexpr float kRoom = float(kWidth) - 48.0f;
    const StabilityMap& map = sheet->map;
    std::string title = "Stability ";
    if (!map.controller.empty()) title += "of '" + forPicture(map.controller) + "' ";
    title += map.walls ? "against walls" : "against dampers";
    use(sizeThatFits(title, kRoom, 26, true), kBlack, true);
    words(24.0f, 872.0f, title);
    float row = 840.0f;
    for (const std::string& text : {map.conditions, map.hands, map.note}) {
      if (text.empty()) continue;
      use(sizeThatFits(text, kRoom, 16), kGrey);
      words(24.0f, row, text);
      row -= 23.0f;
    }
  }

  // Not the chart's own, which stand on the numbers where these are long.
  void axisTitles() {
    vtkNew<vtkTextProperty> look;
    look->SetFontFamilyToArial();
    look->SetFontSize(18 * kFine);
    look->SetColor(0.0, 0.0, 0.0);
    look->SetJustificationToCentered();
    look->SetVerticalJustificationToCentered();
    painter_->ApplyTextProp(look);
    words(kLeft + kAcross / 2.0f, kBottom - 44.0f, "Sampling period T [ms]");
    look->SetOrientation(90.0);
    painter_->ApplyTextProp(look);
    words(32.0f, kBottom + kUp / 2.0f,
          sheet->map.walls ? "Stiffness of the wall k [N/m]" : "Damping of the tissue b [N s/m]");
  }

  std::string countOf(const MapBin& bin) const {
    if (!percent_) return std::to_string(bin.unstable) + "/" + std::to_string(bin.total);
    if (!mixed(bin)) return {};  // the colour says it
    const double share = 100.0 * double(bin.unstable) / double(bin.total);
    return std::to_string(std::clamp(int(std::lround(share)), 1, 99)) + "%";
  }

  bool countsFit(int size) {
    std::size_t longest = 0;
    float widest = 0.0f;
    use(size);
    for (const MapBin& bin : sheet->map.bins) {
      const std::string count = countOf(bin);
      if (count.size() <= longest) continue;
      longest = count.size();
      widest = widthOf(std::string(longest, '8'));
    }
    return widest <= sheet->marker_width - 6.0f && float(size) <= sheet->marker_height - 4.0f;
  }

  // Both numbers where the markers have room for them, else a percentage.
  void counts() {
    int size = 16;
    while (size > 11 && !countsFit(size)) --size;
    if (!countsFit(size)) {
      percent_ = true;
      for (size = 14; size > 10 && !countsFit(size);) --size;
    }
    for (const MapBin& bin : sheet->map.bins) {
      const std::string count = countOf(bin);
      if (count.empty()) continue;
      const Look& look = lookOf(bin);
      const float at_x = sheet->x.pixel(bin.period_s), at_y = sheet->y.pixel(bin.tissue);
      use(size, look.ink, false, true);
      // A plate, so that no curve runs through the number.
      const float w = widthOf(count) + 4.0f, h = std::min(float(size), sheet->marker_height - 3.0f);
      painter_->GetPen()->SetLineType(vtkPen::NO_PEN);
      painter_->GetBrush()->SetColor(look.fill[0], look.fill[1], look.fill[2], 255);
      painter_->DrawRect((at_x - w / 2.0f) * kFine, (at_y - h / 2.0f) * kFine, w * kFine,
                         h * kFine);
      words(at_x, at_y, count);
    }
  }

  // Beside the curves' right ends, moved apart where these lie together.
  void curveNames() {
    constexpr float kApart = 21.0f, kEnd = kLeft + kAcross;
    const double last = std::pow(10.0, sheet->x.high);
    struct Name {
      const DrawnCurve* curve;
      float end, at;
    };
    std::vector<Name> names;
    for (const DrawnCurve& curve : sheet->curves) {
      const double limit = curve.limit->at(last);
      if (!sheet->y.holds(limit)) continue;
      names.push_back({&curve, sheet->y.pixel(limit), sheet->y.pixel(limit)});
    }
    std::stable_sort(names.begin(), names.end(),
                     [](const Name& a, const Name& b) { return a.end < b.end; });
    for (std::size_t i = 1; i < names.size(); ++i) {
      names[i].at = std::max(names[i].at, names[i - 1].at + kApart);
    }
    float ceiling = kBottom + kUp;
    for (std::size_t i = names.size(); i-- > 0; ceiling = names[i].at - kApart) {
      names[i].at = std::min(names[i].at, ceiling);
    }
    for (const Name& name : names) {
      const Colour colour = name.curve->stroke.colour;
      apply({colour}, painter_->GetPen());
      Ground::line(painter_, kEnd, name.end, kEnd + 22.0f, name.at);
      const std::string& text = name.curve->limit->name;
      use(sizeThatFits(text, float(kWidth) - kEnd - 35.0f, 16), colour);
      words(kEnd + 27.0f, name.at, text);
    }
  }

  void legend() {
    constexpr float kTop = 168.0f, kRow = 25.0f, kColumn = 352.0f, kText = kColumn + 58.0f;
    use(16, kBlack, true);
    words(24.0f, kTop, percent_ ? "Markers: percent unstable" : "Markers: unstable / total");
    words(kColumn, kTop, "Published limits: stable below, without delay");
    float row = kTop;
    for (const Look& look : kLooks) {
      row -= kRow;
      Ground::marker(painter_, look, 42.0f, row, 36.0f, 18.0f);
      use(16);
      words(70.0f, row, look.legend);
    }
    std::vector<std::string> texts;
    int size = 16;
    for (const DrawnCurve& curve : sheet->curves) {
      texts.push_back(curve.limit->legend + (curve.visible ? "" : ": outside this map"));
      size = sizeThatFits(texts.back(), float(kWidth) - kText - 16.0f, size);
    }
    row = kTop;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      row -= kRow;
      const Stroke& stroke = sheet->curves[i].stroke;
      apply(stroke, painter_->GetPen());
      std::vector<glm::vec2> sample;
      for (int at = 0; at <= 48; ++at) sample.push_back({kColumn + float(at), row});
      const std::vector<glm::vec2> pieces = inked(sample, stroke.dashes);
      for (std::size_t end = 1; end < pieces.size(); end += 2) {
        Ground::line(painter_, pieces[end - 1].x, row, pieces[end].x, row);
      }
      use(size);
      words(kText, row, texts[i]);
    }
  }

  vtkContext2D* painter_ = nullptr;
  bool percent_ = false;
};
vtkStandardNewMacro(Lettering);

void setUp(vtkAxis* axis, const LogAxis& range, const std::vector<double>& ticks, double scale) {
  std::vector<std::string> names;
  for (int digits = 6; digits < 16; ++digits) {  // until they differ
    names.clear();
    for (const double tick : ticks) names.push_back(number(tick * scale, digits));
    if (std::set<std::string>(names.begin(), names.end()).size() == names.size()) break;
  }
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    positions->InsertNextValue(range.pixel(ticks[i]));
    labels->InsertNextValue(names[i]);
  }
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetRange(range.from, range.from + range.length);
  axis->SetCustomTickPositions(positions, labels);
  axis->SetTickLength(5.0f * kFine);
  axis->SetLabelOffset(8.0f * kFine);
  axis->SetGridVisible(false);
  axis->SetTitleVisible(false);
  axis->GetLabelProperties()->SetFontSize(16 * kFine);
  apply({}, axis->GetPen());
}

// Two points a piece.
void addPieces(vtkChartXY* chart, const std::vector<glm::vec2>& pieces, const Stroke& stroke) {
  if (pieces.empty()) return;
  vtkNew<vtkTable> table;
  vtkNew<vtkDoubleArray> across, up;
  across->SetName("across");
  up->SetName("up");
  for (const glm::vec2& point : pieces) {
    across->InsertNextValue(point.x);
    up->InsertNextValue(point.y);
  }
  table->AddColumn(across);
  table->AddColumn(up);
  vtkNew<vtkPlotLine> line;
  line->SetInputData(table, 0, 1);
  line->SetPolyLine(false);
  apply(stroke, line->GetPen());
  chart->AddPlot(line);
}

Picture draw(const StabilityMap& map) {
  const LogAxis x = periodAxis(map);
  Sheet sheet{map, x, tissueAxis(map, x), {}, {}, {}, 0.0f, 0.0f};
  sheet.ticks_x = ticksOf(sheet.x, map.periods, map.periods_exact, 70.0f);
  sheet.ticks_y = ticksOf(sheet.y, map.tissues, map.tissues_exact, 20.0f);
  sheet.marker_width = std::min(84.0f, 0.84f * sheet.x.spacing(map.periods));
  sheet.marker_height = std::min(30.0f, 0.8f * sheet.y.spacing(map.tissues));

  vtkNew<vtkChartXY> chart;
  chart->SetLayoutStrategy(vtkChart::AXES_TO_RECT);
  chart->SetSize(vtkRectf(kLeft * kFine, kBottom * kFine, kAcross * kFine, kUp * kFine));
  chart->SetShowLegend(false);
  chart->SetRenderEmpty(true);
  setUp(chart->GetAxis(vtkAxis::BOTTOM), sheet.x, sheet.ticks_x, 1000.0);
  setUp(chart->GetAxis(vtkAxis::LEFT), sheet.y, sheet.ticks_y, 1.0);
  // The other two sides of the frame. A chart without a plot would not draw its axes either.
  const glm::vec2 corner(kLeft + kAcross - 0.5f, kBottom + kUp - 0.5f);
  addPieces(chart, {{kLeft, corner.y}, corner, corner, {corner.x, kBottom}}, {});
  std::size_t guides = 0, others = 0;
  std::vector<std::vector<glm::vec2>> lines;
  for (const LimitCurve& limit : map.limits) {
    const Stroke& stroke = limit.guides ? kGuides[guides++] : kStrokes[others++];
    lines.push_back(onMap(limit, sheet.x, sheet.y));
    sheet.curves.push_back({&limit, stroke, lines.back().size() > 1});
    // Above the markers the curves need white edges to be seen.
    addPieces(chart, inked(lines.back(), {}), {kWhite, stroke.width + 2.0f, {}});
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Stroke& stroke = sheet.curves[i].stroke;
    addPieces(chart, inked(lines[i], stroke.dashes), stroke);
  }

  vtkNew<Ground> ground;
  vtkNew<Lettering> lettering;
  ground->sheet = lettering->sheet = &sheet;
  return drawItems({ground.GetPointer(), chart.GetPointer(), lettering.GetPointer()}, kWidth,
                   kHeight);
}

}  // namespace

Result<std::vector<std::filesystem::path>> writeStabilityMaps(const std::vector<MapCell>& cells,
                                                              const std::filesystem::path& folder,
                                                              const Progress& progress) {
  const Result<std::vector<StabilityMap>> maps = stabilityMaps(cells);
  if (!maps) return maps.error();
  if (Status display = probeDisplay(); !display) return display.error();
  if (Status made = makeFolder(folder); !made) return made.error();
  std::vector<std::filesystem::path> files;
  for (const StabilityMap& map : *maps) {
    if (progress.cancelled()) {
      return Error{"CANCELLED", "The drawing of the maps was cancelled", folder.string(), ""};
    }
    progress.at(double(files.size()) / double(maps->size()), map.file_name);
    const std::filesystem::path file = folder / map.file_name;
    if (Status written = writePng(draw(map), file); !written) return written.error();
    files.push_back(file);
  }
  progress.at(1.0, "done");
  return files;
}

}  // namespace trephine
