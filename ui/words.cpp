#include "ui/words.h"

#include <QCoreApplication>
#include <QFile>
#include <QStringList>

#include "haptics/haptic_types.h"

namespace trephine {

namespace {
QString tr(const char* text) {
  return QCoreApplication::translate("Words", text);
}
}  // namespace

QString toQt(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

std::filesystem::path toPath(const QString& text) {
  return QFile::encodeName(text).toStdString();
}

QString toQt(const std::filesystem::path& path) {
  return QFile::decodeName(QByteArray::fromStdString(path.string()));
}

QString purposeText() {
  return tr("For training, not for diagnosis or treatment planning");
}

QString verdictWord(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return tr("Pass");
    case Verdict::repaired:
      return tr("Repaired");
    case Verdict::refused:
      return tr("Refused");
  }
  return {};
}

QString controllerWord(ControllerKind kind) {
  switch (kind) {
    case ControllerKind::off:
      return tr("Off");
    case ControllerKind::seed:
      return tr("Passivity (seed)");
    case ControllerKind::bounded:
      return tr("Bounded");
  }
  return {};
}

QString controllerPartWords(std::uint32_t parts) {
  QStringList words;
  if (parts & kPartArmBound) words << tr("bounded by the arm");
  if (parts & kPartLearned) words << tr("less, since it shook");
  if (parts & kPartDamping) words << tr("damping added");
  if (parts & kPartCredit) words << tr("energy held back");
  if (parts & kPartHold) words << tr("held at rest");
  if (parts & kPartClamp) words << tr("at the arm's limit");
  if (parts & kPartLimiter) words << tr("rising slowly");
  if (parts & kPartEstimate) words << tr("position estimated");
  if (parts & kPartPrediction) words << tr("for when it acts");
  return words.isEmpty() ? tr("nothing to do") : words.join(", ");
}

QString faultWords(std::uint32_t faults) {
  QStringList words;
  if (faults & kFaultDeviceLost) words << tr("The arm does not answer: check its cable.");
  if (faults & kFaultStuck) words << tr("The arm's driver does not return: it was left behind.");
  if (faults & kFaultNonFinite) {
    words << tr("A pose or a force was not a number. The force stays off until you ask for it.");
  }
  if (faults & kFaultStalled) {
    words << tr(
        "The computer was too busy three times within 30 s, or once for over 2 s. The force "
        "stays off until you ask for it.");
  }
  if (faults == kFaultLate) {
    words << tr(
        "The computer was too busy: a step came more than 20 ms late. The force comes back "
        "by itself.");
  }
  return words.join('\n');
}

QString findingWords(const SeriesReport& series) {
  QStringList lines;
  for (const Finding& finding : series.findings) {
    QString line = toQt(finding.text);
    if (!line.isEmpty() && !line.endsWith('.')) line += '.';
    if (!finding.action.empty()) line += ' ' + toQt(finding.action);
    if (!line.endsWith('.')) line += '.';
    lines << line;
  }
  return lines.join('\n');
}

QString timeWords(std::uint32_t seconds) {
  return QStringLiteral("%1:%2").arg(seconds / 60).arg(seconds % 60, 2, 10, QLatin1Char('0'));
}

QString sizeWords(const GridGeometry& g) {
  return tr("%1 \u00d7 %2 \u00d7 %3 voxels\n%4 \u00d7 %5 \u00d7 %6 mm")
      .arg(g.size[0])
      .arg(g.size[1])
      .arg(g.size[2])
      .arg(g.spacing_mm.x, 0, 'f', 2)
      .arg(g.spacing_mm.y, 0, 'f', 2)
      .arg(g.spacing_mm.z, 0, 'f', 2);
}

}  // namespace trephine
