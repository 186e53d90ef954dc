#include "ui/cases/import_words.h"

#include <QCoreApplication>
#include <QStringList>
#include <algorithm>

#include "imaging/codes.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr std::size_t kSlicesNamed = 6;
constexpr double kMb_per_GB = 1024.0;

QString tr(const char* text) {
  return QCoreApplication::translate("trephine", text);
}

QString sentence(QString text) {
  if (!text.isEmpty() && !text.endsWith('.') && !text.endsWith('?') && !text.endsWith('!')) {
    text += '.';
  }
  return text;
}

int countOf(const SeriesReport& series, Severity severity) {
  return int(std::ranges::count(series.findings, severity, &Finding::severity));
}

// The title of a group of findings, and what such findings mean for the volume.
struct SeverityWords {
  Severity severity;
  const char* title;
  const char* meaning;
  const QColor& colour;
};
const SeverityWords kRefusedRepairs{
    Severity::repair, QT_TRANSLATE_NOOP("trephine", "What would be put right"),
    QT_TRANSLATE_NOOP("trephine", "Nothing was changed so far."), colours::kCaution};
const SeverityWords kOfStructures{
    Severity::refusal, QT_TRANSLATE_NOOP("trephine", "How it is used"),
    QT_TRANSLATE_NOOP("trephine", "It is no volume by itself: choose it beside its CT."),
    colours::kQuiet};
const SeverityWords kSeverities[] = {
    {Severity::refusal, QT_TRANSLATE_NOOP("trephine", "Why it cannot be used as it is"),
     QT_TRANSLATE_NOOP("trephine", "A volume made of it as it is could be wrong."), colours::kBad},
    {Severity::repair, QT_TRANSLATE_NOOP("trephine", "What is put right"),
     QT_TRANSLATE_NOOP("trephine", "Here the volume differs from the files, in this way only."),
     colours::kCaution},
    {Severity::edit, QT_TRANSLATE_NOOP("trephine", "What was changed as you asked"),
     QT_TRANSLATE_NOOP("trephine",
                       "Here the volume differs from the files, because you wanted it."),
     colours::kQuiet},
    {Severity::notice, QT_TRANSLATE_NOOP("trephine", "Good to know"),
     QT_TRANSLATE_NOOP("trephine", "This takes nothing from the volume."), colours::kQuiet},
};

// Slices by their numbers, or where along the stack they lie.
QString placesWords(const std::vector<std::string>& slices) {
  return slices.front().ends_with(" mm") ? tr("Where along the stack: %1.").arg(slicesWords(slices))
                                         : tr("Slices: %1.").arg(slicesWords(slices));
}

QString findingHtml(const Finding& finding) {
  QString html = "<p style='margin-top:3px; margin-bottom:7px; line-height:115%;'>" +
                 sentence(toQt(finding.text)).toHtmlEscaped();
  if (!finding.slices.empty()) {
    html += QString(" <span style='color:%1'>").arg(colours::kQuiet.name()) +
            placesWords(finding.slices).toHtmlEscaped() + "</span>";
  }
  if (!finding.action.empty()) {
    html += "<br>\u2192 " + sentence(toQt(finding.action)).toHtmlEscaped();
  }
  return html + "</p>";
}

QString factsHtml(const SeriesReport& series) {
  const GridGeometry& g = series.geometry;
  QStringList rows;
  const auto add = [&](const QString& name, const QString& value) {
    rows << QString("<tr><td style='color:%1; padding-right:10px;'>%2</td><td>%3</td></tr>")
                .arg(colours::kQuiet.name(), name.toHtmlEscaped(), value.toHtmlEscaped());
  };
  if (g.voxelCount() > 0 && g.spacing_mm.z > 0.0) {
    add(tr("Voxels"), tr("%1 \u00d7 %2 \u00d7 %3").arg(g.size[0]).arg(g.size[1]).arg(g.size[2]));
    add(tr("Voxel size"), tr("%1 \u00d7 %2 \u00d7 %3 mm")
                              .arg(g.spacing_mm.x, 0, 'f', 2)
                              .arg(g.spacing_mm.y, 0, 'f', 2)
                              .arg(g.spacing_mm.z, 0, 'f', 2));
    add(tr("Extent"), tr("%1 \u00d7 %2 \u00d7 %3 mm")
                          .arg(g.size[0] * g.spacing_mm.x, 0, 'f', 0)
                          .arg(g.size[1] * g.spacing_mm.y, 0, 'f', 0)
                          .arg(g.size[2] * g.spacing_mm.z, 0, 'f', 0));
  }
  if (!series.body_part.empty()) add(tr("Body part"), toQt(series.body_part));
  if (series.phases > 1) add(tr("Phases"), QString::number(series.phases));
  if (series.tilt_deg != 0.0) {
    const bool tilted = std::ranges::find(series.findings, code::kShearedSideways,
                                          &Finding::code) == series.findings.end();
    add(tilted ? tr("Gantry tilt") : tr("Sheared by"),
        tr("%1\u00b0").arg(series.tilt_deg, 0, 'f', 1));
  }
  if (series.hu_min && series.hu_max) {
    add(tr("HU"), tr("%1 to %2").arg(*series.hu_min).arg(*series.hu_max));
  }
  if (series.source != "DICOM") add(tr("Format"), toQt(series.source));
  if (series.lossy) add(tr("Compression"), tr("with loss: HU are not exact"));
  return rows.isEmpty() ? QString() : "<table cellspacing='2'>" + rows.join("") + "</table>";
}

}  // namespace

QString stateWord(SeriesState state) {
  switch (state) {
    case SeriesState::pass:
      return verdictWord(Verdict::pass);
    case SeriesState::repaired:
      return verdictWord(Verdict::repaired);
    case SeriesState::answered:
      return tr("As answered");
    case SeriesState::asks:
      return tr("Has a question");
    case SeriesState::structures:
      return tr("Structures");
    case SeriesState::refused:
      return verdictWord(Verdict::refused);
  }
  return {};
}

QColor stateColour(SeriesState state) {
  switch (state) {
    case SeriesState::pass:
      return colours::kGood;
    case SeriesState::repaired:
    case SeriesState::answered:
      return colours::kCaution;
    case SeriesState::asks:
      return colours::kAccent;
    case SeriesState::structures:
      return colours::kText;
    case SeriesState::refused:
      return colours::kBad;
  }
  return colours::kText;
}

QString verdictSentence(const SeriesReport& series, const Answers& answers) {
  switch (seriesState(series, answers)) {
    case SeriesState::pass:
      return tr("Ready to use.");
    case SeriesState::repaired: {
      const int repairs = countOf(series, Severity::repair);
      return repairs == 1 ? tr("Can be used. One thing is put right, as told below.")
                          : tr("Can be used. %1 things are put right, as told below.").arg(repairs);
    }
    case SeriesState::answered:
      return tr("Can be used as you answered.");
    case SeriesState::asks:
      return tr("Can be used once you have answered.");
    case SeriesState::structures:
      return tr("Structures of a CT: they come with it, or are opened later.");
    case SeriesState::refused:
      break;
  }
  const int reasons = countOf(series, Severity::refusal);
  return reasons <= 1 ? tr("Cannot be used, for the reason told below.")
                      : tr("Cannot be used, for %1 reasons told below.").arg(reasons);
}

QString seriesName(const SeriesReport& series) {
  if (!series.description.empty()) return toQt(series.description);
  return series.modality.empty() ? tr("Without description")
                                 : tr("%1 without description").arg(toQt(series.modality));
}

QString seriesLine(const SeriesReport& series) {
  QStringList parts;
  parts << (series.modality.empty() ? toQt(series.source) : toQt(series.modality));
  parts << (series.slices == 1 ? tr("1 slice") : tr("%1 slices").arg(series.slices));
  if (series.geometry.size[0] > 0) {
    parts << tr("%1 \u00d7 %2").arg(series.geometry.size[0]).arg(series.geometry.size[1]);
  }
  return parts.join(" \u00b7 ");
}

QString slicesWords(const std::vector<std::string>& slices) {
  QStringList named;
  for (const std::string& slice : slices) {
    if (std::size_t(named.size()) == kSlicesNamed) break;
    named << toQt(slice);
  }
  const std::size_t more = slices.size() - std::size_t(named.size());
  return more == 0 ? named.join(", ") : tr("%1 and %2 more").arg(named.join(", ")).arg(more);
}

QString megabytes(double mb) {
  if (mb < 0.1) return tr("under 0.1 MB");
  return mb < 1000.0 ? tr("%1 MB").arg(mb, 0, 'f', mb < 9.95 ? 1 : 0)
                     : tr("%1 GB").arg(mb / kMb_per_GB, 0, 'f', 1);
}

QString memoryWords(double needed_mb, double free_mb) {
  if (needed_mb <= 0.0) return {};
  const QString both = tr("Opening it and practising on it needs %1 of memory; %2 are free.")
                           .arg(megabytes(needed_mb), megabytes(free_mb));
  return needed_mb < free_mb
             ? both
             : both + ' ' + tr("Close other programs, crop it, or take a lower resolution.");
}

QString lossWords(const MeasuredLoss& loss) {
  return tr("Against the full resolution, HU are off by %1 (root mean square), by more than %2 in "
            "one "
            "voxel of a hundred; the volume of bone changes by %3 %.")
      .arg(loss.rms_hu, 0, 'f', 1)
      .arg(loss.p99_hu, 0, 'f', 0)
      .arg(QString::asprintf("%+.1f", loss.bone_volume_change_percent));
}

QString gridWords(const GridGeometry& g) {
  return sizeWords(g).replace(QStringLiteral("\n"), QStringLiteral(", "));
}

QString reportHtml(const SeriesReport& series) {
  QString html = factsHtml(series);
  for (const SeverityWords& severity : kSeverities) {
    if (countOf(series, severity.severity) == 0) continue;
    const bool undone = series.verdict == Verdict::refused && severity.severity == Severity::repair;
    const bool structures = seriesState(series, {}) == SeriesState::structures &&
                            severity.severity == Severity::refusal;
    const SeverityWords& words = undone ? kRefusedRepairs : structures ? kOfStructures : severity;
    html += QString(
                "<p style='margin-top:12px; margin-bottom:0px; line-height:115%;'>"
                "<b style='color:%1'>%2</b><br><span style='color:%3'>%4</span></p>")
                .arg(words.colour.name(), tr(words.title).toHtmlEscaped(), colours::kQuiet.name(),
                     tr(words.meaning).toHtmlEscaped());
    for (const Finding& finding : series.findings) {
      if (finding.severity == words.severity) html += findingHtml(finding);
    }
  }
  return html;
}

QString folderWords(const ImportReport& report) {
  QStringList lines;
  lines << (report.files_seen == 1 ? tr("1 file") : tr("%1 files").arg(report.files_seen)) + ", " +
               (report.series.size() == 1 ? tr("1 series")
                                          : tr("%1 series").arg(report.series.size()));
  for (const SkippedFiles& files : report.skipped) {
    lines << tr("%1 left out: %2").arg(files.count).arg(toQt(files.reason));
  }
  return lines.join('\n');
}

}  // namespace trephine
