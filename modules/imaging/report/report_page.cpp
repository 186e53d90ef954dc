#include "imaging/report/report_page.h"

#include <algorithm>

#include "base/html.h"
#include "base/purpose.h"
#include "base/system.h"
#include "base/tr.h"
#include "imaging/common/detail/text.h"
#include "imaging/dicom/detail/transfer_syntax.h"

namespace trephine {

namespace {

constexpr std::size_t kMostSeries = 8;  // in full; the others are counted
constexpr std::size_t kMostSlices = 6;  // named in a finding

std::string escaped(std::string_view text) {
  return inHtml(cleanUtf8(text));
}

std::string verdictSentence(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return tr("PASS &#8211; can be used as it is");
    case Verdict::repaired:
      return tr("REPAIRED &#8211; can be used; what was changed is said below");
    case Verdict::refused:
      return tr("REFUSED &#8211; cannot be used as it is; what to do is said below");
  }
  return "";
}

const char* verdictColour(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "#1b6e3c";
    case Verdict::repaired:
      return "#8a5a00";
    case Verdict::refused:
      return "#a02020";
  }
  return "#000000";
}

std::string row(const std::string& name, const std::string& value) {
  return "<tr><td><b>" + name + "</b></td><td>" + value + "</td></tr>\n";
}

std::string slicesText(const std::vector<std::string>& slices) {
  std::string text;
  for (std::size_t n = 0; n < std::min(slices.size(), kMostSlices); ++n) {
    text += (n == 0 ? "" : ", ") + escaped(slices[n]);
  }
  if (slices.size() > kMostSlices) {
    text += tr(" and {} more", slices.size() - kMostSlices);
  }
  return text;
}

std::string findingRow(const Finding& finding) {
  std::string text = escaped(finding.text) + ".";
  if (!finding.slices.empty()) text += " At: " + slicesText(finding.slices) + ".";
  return "<tr><td>" + escaped(severityName(finding.severity)) + "</td><td>" + text + "</td><td>" +
         escaped(finding.action) + (finding.action.empty() ? "" : ".") +
         "</td><td><font size=\"1\">" + escaped(finding.code.str()) + "</font></td></tr>\n";
}

std::string findingsTable(const SeriesReport& series) {
  std::string html =
      "<table border=\"1\" cellspacing=\"0\" cellpadding=\"3\" width=\"100%\">\n"
      "<tr><th align=\"left\">" +
      tr("Severity") + "</th><th align=\"left\">" + tr("What was found") +
      "</th><th align=\"left\">" + tr("What was done, or is to do") + "</th><th align=\"left\">" +
      tr("Code") + "</th></tr>\n";
  for (const Finding& finding : series.findings) html += findingRow(finding);
  return html + "</table>\n";
}

std::string choiceTable(const Choice& choice) {
  std::string html = "<p>" + escaped(choice.question) + "</p>\n<table cellpadding=\"2\">\n";
  for (std::size_t n = 0; n < choice.options.size(); ++n) {
    html += "<tr><td><font size=\"1\">" + escaped(choice.code.str() + "=" + choice.options[n]) +
            "</font></td><td>" + escaped(choice.words[n]) + "</td></tr>\n";
  }
  return html + "</table>\n";
}

// `number` of `count`, as the page lists them.
std::string seriesSection(const SeriesReport& series, std::size_t number, std::size_t count,
                          bool chosen) {
  const GridGeometry& g = series.geometry;
  std::string html =
      tr("<h3>Series {} of {}{}: <font color=\"{}\">{}</font></h3>\n<table cellpadding=\"2\">\n",
         number, count, (chosen ? " (opened)" : ""), verdictColour(series.verdict),
         verdictSentence(series.verdict));
  html += row("Kind", escaped(series.modality.empty() ? "unknown" : shownTerm(series.modality)) +
                          ", " + escaped(series.source) +
                          (series.transfer_syntax.empty()
                               ? ""
                               : ", " + escaped(transferSyntaxName(series.transfer_syntax))));
  html += row("Slices", std::to_string(series.slices) +
                            (series.phases > 1 ? tr(" in {} phases", series.phases) : ""));
  html += row("Volume", tr("{} &times; {} &times; {} voxels of {} &times; {} &times; {} mm",
                           g.size[0], g.size[1], g.size[2], fixedText(g.spacing_mm.x, 3),
                           fixedText(g.spacing_mm.y, 3), fixedText(g.spacing_mm.z, 3)));
  if (series.hu_min && series.hu_max) {
    html += row("Values", tr("{} to {} HU", *series.hu_min, *series.hu_max));
  }
  if (series.lossy) html += row("Compression", tr("with loss"));
  html += "</table>\n";
  if (series.findings.empty()) html += "<p>" + tr("Nothing to remark.") + "</p>\n";
  if (!series.findings.empty()) html += findingsTable(series);
  for (const Choice& choice : series.choices) html += choiceTable(choice);
  return html;
}

std::string provenanceSection(const Provenance& provenance) {
  std::string html = "<h3>" + tr("How the volume was made") + "</h3>\n<table cellpadding=\"2\">\n";
  for (const auto& [code, option] : provenance.answers) {
    html += row(tr("Choice {}", escaped(code.str())), escaped(option));
  }
  if (const auto& box = provenance.crop) {
    std::string text;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr const char* kNames[] = {"columns ", ", rows ", ", slices "};
      text += tr("{}{} to {}", kNames[axis], box->low[axis] + 1, box->high[axis]);
    }
    html += row(tr("Crop (counted from 1)"), text);
  }
  if (provenance.reduction > 1) {
    html += row("Resolution", provenance.reduction == 2 ? "half" : "a quarter");
  }
  if (const auto& loss = provenance.loss) {
    html += row(tr("Measured loss"),
                tr("{} HU rms, 99 % below {} HU, volume of bone {}{} %", fixedText(loss->rms_hu, 1),
                   fixedText(loss->p99_hu, 0), (loss->bone_volume_change_percent >= 0.0 ? "+" : ""),
                   fixedText(loss->bone_volume_change_percent, 1)));
  }
  html += row("Fingerprint", "<font size=\"1\">" + escaped(provenance.volume_sha256) + "</font>");
  return html + "</table>\n";
}

}  // namespace

std::string reportPage(const ImportReport& report, const std::optional<std::string>& only) {
  std::string html =
      "<!DOCTYPE html>\n<html><head><meta charset=\"utf-8\"><title>CT import report</title>\n"
      "<style>@page { size: A4; margin: 15mm } body { font-family: sans-serif; font-size: 9pt }"
      " h2 { font-size: 14pt } h3 { font-size: 10pt; margin: 8px 0 2px 0 }"
      " table { font-size: 8pt; border-collapse: collapse }</style></head><body>\n"
      "<h2>CT import report</h2>\n<p>" +
      tr(kPurpose) + ". This page names no patient.</p>\n";
  if (report.error) {
    html +=
        "<p><b>" + escaped(report.error->what) + ".</b> " + escaped(report.error->next) + ".</p>\n";
  }
  // What was opened first, then what can be, then the rest.
  std::vector<std::size_t> order;
  const std::optional<std::string>& of = only ? only : report.chosen;
  for (std::size_t n = 0; n < report.series.size(); ++n) {
    if (!of || *of == report.series[n].uid) order.push_back(n);
  }
  const std::size_t others = report.series.size() - order.size();
  const auto chosen = [&](std::size_t n) { return report.chosen == report.series[n].uid; };
  std::ranges::stable_sort(order, {}, [&](std::size_t n) {
    return chosen(n) ? 0 : report.series[n].verdict != Verdict::refused ? 1 : 2;
  });
  for (std::size_t n = 0; n < std::min(order.size(), kMostSeries); ++n) {
    html += seriesSection(report.series[order[n]], of ? order[n] + 1 : n + 1, report.series.size(),
                          chosen(order[n]));
  }
  if (others > 0) {
    html += trCount(others, "<p>The folder holds {} other series, which is not told of here.</p>\n",
                    "<p>The folder holds {} other series, which are not told of here.</p>\n");
  }
  if (order.size() > kMostSeries) {
    html += trCount(order.size() - kMostSeries,
                    "<p>{} more series was found; the window lists all.</p>\n",
                    "<p>{} more series were found; the window lists all.</p>\n");
  }
  if (report.provenance) html += provenanceSection(*report.provenance);
  html += trCount(std::uint64_t(report.files_seen), "<h3>Files</h3>\n<p>{} file was seen, {} read.",
                  "<h3>Files</h3>\n<p>{} files were seen, {} read.", report.files_read);
  for (const SkippedFiles& skipped : report.skipped) {
    html += tr(" Skipped {}: {}.", skipped.count, escaped(skipped.reason));
  }
  return html + "</p>\n<p><font size=\"1\">Trephine " + escaped(buildName()) +
         "</font></p>\n</body></html>\n";
}

}  // namespace trephine
