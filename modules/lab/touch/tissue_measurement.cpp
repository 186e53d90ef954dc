#include "lab/touch/tissue_measurement.h"

#include <algorithm>
#include <cstdio>

#include "base/codes.h"
#include "base/file.h"
#include "lab/touch/tissue_experiments.h"

namespace trephine {

namespace {

const char* nameOfKind(BandKind kind) {
  return kind == BandKind::published ? "published" : "estimate";
}
const char* nameOfUse(NumberUse use) {
  return use == NumberUse::fitted ? "fitted" : "predicted";
}

Json endOf(const std::optional<double>& end) {
  return end ? Json(*end) : Json(nullptr);
}

std::string bandText(const TissueRow& row) {
  char text[64];
  if (row.low && row.high) {
    std::snprintf(text, sizeof(text), "%.4g to %.4g", *row.low, *row.high);
  } else if (row.low) {
    std::snprintf(text, sizeof(text), "%.4g or more", *row.low);
  } else {
    std::snprintf(text, sizeof(text), "at most %.4g", row.high.value_or(0.0));
  }
  return text;
}

// Of the rows of a kind.
struct Tally {
  int inside = 0, all = 0;
};

}  // namespace

Result<TissueMeasurement> measureTissue(const Progress& progress) {
  using namespace tissue_experiments;
  Result<Shipped> shipped = readShipped();
  if (!shipped) return shipped.error();
  TissueMeasurement out;
  out.scaled = scaledNumbers(*shipped);
  using Experiment = Status (*)(const Shipped&, TissueMeasurement&);
  const Experiment experiments[] = {liverPuncture, skinToKidney,     duraPuncture,
                                    brainStrokes,  liverCut,         burrByPush,
                                    energyOfBurr,  burrThroughVault, burrHoleByHand};
  double done = 0.0;
  for (Experiment experiment : experiments) {
    if (progress.cancelled()) {
      return Error{code::kCancelled, "The measurement was cancelled", "tissue", ""};
    }
    if (Status measured = experiment(*shipped, out); !measured) return measured.error();
    done += 1.0 / double(std::size(experiments));
    progress.at(done, "tissue");
  }
  std::stable_sort(out.rows.begin(), out.rows.end(), [](const TissueRow& a, const TissueRow& b) {
    return std::stoi(a.experiment.substr(1)) < std::stoi(b.experiment.substr(1));
  });
  return out;
}

Json toJson(const TissueMeasurement& measured) {
  Json rows = Json::array(), scaled = Json::array();
  for (const TissueRow& row : measured.rows) {
    rows.push_back({{"experiment", row.experiment},
                    {"quantity", row.quantity},
                    {"unit", row.unit},
                    {"ours", row.ours},
                    {"published", {endOf(row.low), endOf(row.high)}},
                    {"kind", nameOfKind(row.kind)},
                    {"use", nameOfUse(row.use)},
                    {"source", row.source},
                    {"confidence", row.confidence},
                    {"inside", row.inside()}});
  }
  for (const ScaledForce& one : measured.scaled) {
    scaled.push_back({{"tissue", one.tissue},
                      {"quantity", one.quantity},
                      {"unit", one.unit},
                      {"published", one.published},
                      {"shipped", one.shipped},
                      {"factor", one.shipped / one.published}});
  }
  return {{"rows", rows}, {"scaled", scaled}};
}

std::string toText(const TissueMeasurement& measured) {
  std::string text;
  char line[300];
  Tally published, estimated;
  int predicted = 0;
  for (const TissueRow& row : measured.rows) {
    std::snprintf(line, sizeof(line), "%-4s %-62s %10.4g %-6s %-18s %-9s %-9s %s\n",
                  row.experiment.c_str(), row.quantity.c_str(), row.ours, row.unit.c_str(),
                  bandText(row).c_str(), nameOfKind(row.kind), nameOfUse(row.use),
                  row.inside() ? "inside" : "OUTSIDE");
    text += line;
    Tally& tally = row.kind == BandKind::published ? published : estimated;
    ++tally.all;
    tally.inside += row.inside();
    predicted += row.inside() && row.kind == BandKind::published && row.use == NumberUse::predicted;
  }
  std::snprintf(line, sizeof(line),
                "%d of %d rows of published bands inside, %d of %d of estimated ones; %d predicted "
                "and inside a published band\n",
                published.inside, published.all, estimated.inside, estimated.all, predicted);
  text += line;
  for (const ScaledForce& one : measured.scaled) {
    std::snprintf(line, sizeof(line), "scaled: %s, %s: %.4g instead of %.4g %s, by %.2f\n",
                  one.tissue.c_str(), one.quantity.c_str(), one.shipped, one.published,
                  one.unit.c_str(), one.shipped / one.published);
    text += line;
  }
  return text;
}

Status writeTissueTables(const TissueMeasurement& measured, const std::filesystem::path& out) {
  std::string table = "experiment,quantity,unit,ours,low,high,kind,use,inside,source\n";
  const auto quoted = [](const std::string& text) { return '"' + text + '"'; };
  for (const TissueRow& row : measured.rows) {
    table += row.experiment + ',' + quoted(row.quantity) + ',' + row.unit + ',' +
             plainNumber(row.ours) + ',' + (row.low ? plainNumber(*row.low) : "") + ',' +
             (row.high ? plainNumber(*row.high) : "") + ',' + nameOfKind(row.kind) + ',' +
             nameOfUse(row.use) + ',' + (row.inside() ? "yes" : "no") + ',' + quoted(row.source) +
             '\n';
  }
  if (Status written = writeTextFile(out / "tissue.csv", table); !written) return written;
  for (const TissueCurve& curve : measured.curves) {
    std::string csv =
        curve.x_title + '_' + curve.x_unit + ',' + curve.y_title + '_' + curve.y_unit + '\n';
    for (const auto& [x, y] : curve.points) csv += plainNumber(x) + ',' + plainNumber(y) + '\n';
    if (Status written = writeTextFile(out / (curve.experiment + ".csv"), csv); !written) {
      return written;
    }
  }
  return {};
}

}  // namespace trephine
