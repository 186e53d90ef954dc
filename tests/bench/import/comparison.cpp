#include "bench/import/comparison.h"

#include <cstdio>

namespace trephine::bench {

namespace {

bool isOurs(const ImportRow& row) {
  return row.loader.starts_with("trephine");
}

std::optional<double> fastestPeer(const ImportMeasurement& m, const std::string& series) {
  std::optional<double> fastest;
  for (const ImportRow& row : m.rows) {
    if (row.series != series || isOurs(row) || row.correct != true || !row.seconds_median) continue;
    if (!fastest || *row.seconds_median < *fastest) fastest = row.seconds_median;
  }
  return fastest;
}

Json orNull(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

}  // namespace

PeerRatios peerRatiosOf(const ImportMeasurement& m) {
  PeerRatios ratios;
  ratios.command_to_dcm2niix =
      ratioOf(secondsOf(m, "int16", "trephine command"), secondsOf(m, "int16", "dcm2niix"));
  std::optional<double> ours, peer;
  for (const ScanRow& row : m.scan) {
    (row.loader == "trephine" ? ours : peer) = row.seconds_median;
  }
  ratios.scan_to_gdcmscanner = ratioOf(ours, peer);
  for (const char* series : {"deflated", "rle", "jpegls", "jpegll", "j2k"}) {
    ratios.compressed.emplace_back(
        series, ratioOf(secondsOf(m, series, "trephine command"), fastestPeer(m, series)));
  }
  return ratios;
}

Json toJson(const ImportMeasurement& measurement) {
  Json out = trephine::toJson(measurement);
  const PeerRatios ratios = peerRatiosOf(measurement);
  out["ratios"]["command_to_dcm2niix"] = orNull(ratios.command_to_dcm2niix);
  out["ratios"]["scan_to_gdcmscanner"] = orNull(ratios.scan_to_gdcmscanner);
  for (const auto& [series, value] : ratios.compressed) {
    out["ratios"]["compressed"][series] = orNull(value);
  }
  return out;
}

std::string toText(const ImportMeasurement& measurement) {
  std::string text = trephine::toText(measurement);
  const auto put = [&](const std::string& name, const std::optional<double>& value) {
    char line[200], figure[20] = "-";
    if (value) std::snprintf(figure, sizeof figure, "%.2f", *value);
    std::snprintf(line, sizeof line, "%-56s %6s\n", name.c_str(), figure);
    text += line;
  };
  const PeerRatios ratios = peerRatiosOf(measurement);
  put("int16: command without hash / dcm2niix", ratios.command_to_dcm2niix);
  put("scan / gdcmscanner", ratios.scan_to_gdcmscanner);
  for (const auto& [series, value] : ratios.compressed) {
    put(series + ": command without hash / fastest peer that is right", value);
  }
  return text;
}

}  // namespace trephine::bench
