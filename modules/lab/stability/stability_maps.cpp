#include "lab/stability/stability_maps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/codes.h"
#include "lab/stability/log_centres.h"
#include "plot/axis.h"

namespace trephine {

namespace {

using plot::number;

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
  map.title = "Stability ";
  if (!controller.empty()) map.title += "of '" + forPicture(controller) + "' ";
  map.title += walls ? "against walls" : "against dampers";
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

Result<std::vector<StabilityMap>> stabilityMaps(const std::vector<MapCell>& cells) {
  if (cells.empty()) {
    return Error{code::kBadArgument, "There is no cell to draw a map of", "the stability grid",
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
      return Error{code::kBadArgument, "A cell of the stability grid holds a value that cannot be",
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
    return Error{code::kBadArgument, "Every cell of the stability grid has a damper of b = 0",
                 "the stability grid", "Give dampers or walls above 0"};
  }
  return maps;
}

}  // namespace trephine
