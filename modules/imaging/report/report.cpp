#include "imaging/report/report.h"

#include <algorithm>

#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/report/answers.h"
#include "imaging/report/provenance.h"
#include "volume/case_memory.h"
#include "volume/reduce.h"
#include "volume/thick_slices.h"

namespace trephine {

namespace {

Json vectorJson(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

template <class T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

bool interpolates(const ImportRequest& request) {
  return answerTo(request.answers, code::kThickSlices) == "interpolate";
}

// What comes out of it: before slices are interpolated, into how many steps, and the voxels in all.
struct Outcome {
  int steps = 1;
  std::size_t voxels = 0;
};
Outcome outcomeOf(const SeriesReport& series, const ImportRequest& request) {
  const GridGeometry& grid = series.geometry;
  const VoxelBox box = request.crop.value_or(VoxelBox{{0, 0, 0}, grid.size});
  const GridGeometry out = outcomeOf(grid, box, request.reduction);
  const int steps = interpolates(request) ? stepsBetweenSlices(out) : 1;
  return {steps, steps > 1 ? withThinSlices(out, steps).voxelCount() : out.voxelCount()};
}

Json findingJson(const Finding& finding) {
  Json slices = Json::array();
  for (const std::string& slice : finding.slices) slices.push_back(cleanUtf8(slice));
  return {{"code", finding.code.str()},
          {"severity", severityName(finding.severity)},
          {"text", cleanUtf8(finding.text)},
          {"slices", std::move(slices)},
          {"action", cleanUtf8(finding.action)}};
}

Json choiceJson(const Choice& choice) {
  return {{"code", choice.code.str()},
          {"question", choice.question},
          {"options", choice.options},
          {"words", choice.words}};
}

// `number`: its place in the report, from 1, which names it where its UID may not.
Json seriesJson(const SeriesReport& series, std::size_t number, Identity identity) {
  const bool shown = identity == Identity::shown;
  const GridGeometry& g = series.geometry;
  Json direction = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) direction.push_back(g.direction[axis][row]);
  }
  Json findings = Json::array();
  for (const Finding& finding : series.findings) findings.push_back(findingJson(finding));
  Json choices = Json::array();
  for (const Choice& choice : series.choices) choices.push_back(choiceJson(choice));
  return {{"uid", shown ? cleanUtf8(series.uid) : std::to_string(number)},
          {"description", shown ? cleanUtf8(series.description) : ""},
          {"modality", shown ? cleanUtf8(series.modality) : shownTerm(series.modality)},
          {"source", shown ? series.source : ""},
          {"slices", series.slices},
          {"phases", series.phases},
          {"memory_mb", series.memory_mb},
          {"verdict", verdictName(series.verdict)},
          {"size", g.size},
          {"spacing_mm", vectorJson(g.spacing_mm)},
          {"origin_mm", vectorJson(g.origin_mm)},
          {"direction", std::move(direction)},
          {"hu_min", orNull(series.hu_min)},
          {"hu_max", orNull(series.hu_max)},
          {"tilt_deg", series.tilt_deg},
          {"transfer_syntax", cleanUtf8(series.transfer_syntax)},
          {"lossy", series.lossy},
          {"findings", std::move(findings)},
          {"choices", std::move(choices)},
          {"volume_sha256", orNull(series.volume_sha256)}};
}

}  // namespace

std::string sentencesOf(const Finding& finding) {
  const auto stopped = [](const std::string& text) {
    return text.ends_with('.') ? text : text + ".";
  };
  std::string text = stopped(finding.text);
  if (!finding.action.empty()) text += " " + stopped(finding.action);
  return text;
}

const char* severityName(Severity severity) {
  switch (severity) {
    case Severity::notice:
      return "notice";
    case Severity::edit:
      return "edit";
    case Severity::repair:
      return "repair";
    case Severity::refusal:
      return "refusal";
  }
  return "";
}

const char* verdictName(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::repaired:
      return "repaired";
    case Verdict::refused:
      return "refused";
  }
  return "refused";
}

double readingMb(const SeriesReport& series, const ImportRequest& request) {
  const Outcome out = outcomeOf(series, request);
  const bool copied = request.reduction > 1 || out.steps > 1;
  return series.reading_mb + (copied ? voxelsMb(out.voxels) : 0.0);
}

double memoryMb(const SeriesReport& series, const ImportRequest& request) {
  return kWindow_mb +
         std::max(readingMb(series, request), openedMb(outcomeOf(series, request).voxels));
}

Json toJson(const ImportReport& report, Identity identity) {
  const bool shown = identity == Identity::shown;
  Json skipped = Json::array();
  for (const SkippedFiles& files : report.skipped) {
    skipped.push_back({{"reason", cleanUtf8(files.reason)}, {"count", files.count}});
  }
  Json series = Json::array();
  std::optional<std::string> chosen = shown ? report.chosen : std::optional<std::string>();
  for (const SeriesReport& one : report.series) {
    const std::size_t number = series.size() + 1;
    series.push_back(seriesJson(one, number, identity));
    if (!shown && report.chosen == one.uid) chosen = std::to_string(number);
  }
  Json json = {{"path", shown ? cleanUtf8(report.path) : ""},
               {"files_seen", report.files_seen},
               {"files_read", report.files_read},
               {"skipped", std::move(skipped)},
               {"series", std::move(series)},
               {"chosen", orNull(chosen)},
               {"provenance", report.provenance ? toJson(*report.provenance) : Json(nullptr)},
               {"seconds",
                {{"scan", report.seconds.scan},
                 {"read", report.seconds.read},
                 {"hash", report.seconds.hash}}},
               {"start_rss_mb", report.start_rss_mb},
               {"peak_rss_mb", report.peak_rss_mb}};
  if (report.error) {
    json["error"] = {{"code", report.error->code.str()},
                     {"what", cleanUtf8(report.error->what)},
                     {"where", shown ? cleanUtf8(report.error->where) : ""},
                     {"next", cleanUtf8(report.error->next)}};
  }
  return json;
}

}  // namespace trephine
