#include "ui/common/words.h"

#include <QCoreApplication>
#include <QFile>
#include <QStringList>

#include "haptics/bounded_controller.h"
#include "haptics/haptic_types.h"

namespace trephine {

namespace {
QString tr(const char* text) {
  return QCoreApplication::translate("trephine", text);
}

struct PartWords {
  ControllerPart part;
  const char *words, *meaning;
};

constexpr PartWords kPartWords[] = {
    {kPartArmBound, QT_TRANSLATE_NOOP("trephine", "softer, for this arm"),
     QT_TRANSLATE_NOOP(
         "trephine",
         "the tissue is firmer than this arm can show without shaking, so it is shown "
         "as firm as the arm can.")},
    {kPartLearned, QT_TRANSLATE_NOOP("trephine", "softer, since it shook"),
     QT_TRANSLATE_NOOP("trephine",
                       "the arm shook in this hand, so less is shown until it has been calm.")},
    {kPartDamping, QT_TRANSLATE_NOOP("trephine", "damped"),
     QT_TRANSLATE_NOOP("trephine",
                       "a little damping goes with each spring, so that it does not ring.")},
    {kPartCredit, QT_TRANSLATE_NOOP("trephine", "held back, not to push by itself"),
     QT_TRANSLATE_NOOP("trephine",
                       "the force would give the hand more energy than the hand put in, so it is "
                       "made smaller.")},
    {kPartHold, QT_TRANSLATE_NOOP("trephine", "steady while it rests"),
     QT_TRANSLATE_NOOP("trephine",
                       "the tool rests, so the force stays as it is and does not buzz between two "
                       "steps of the encoder.")},
    {kPartClamp, QT_TRANSLATE_NOOP("trephine", "at the arm's limit"),
     QT_TRANSLATE_NOOP("trephine", "the tissue demands more force than the arm has.")},
    {kPartLimiter, QT_TRANSLATE_NOOP("trephine", "rising slowly"),
     QT_TRANSLATE_NOOP(
         "trephine",
         "after a pause, a change or a late step the force comes back slowly, so that "
         "it does not kick.")},
    {kPartEstimate, QT_TRANSLATE_NOOP("trephine", "smooth between encoder steps"),
     QT_TRANSLATE_NOOP("trephine",
                       "the encoder tells the place in steps; the force is that of the estimated "
                       "place and speed between them.")},
    {kPartPrediction, QT_TRANSLATE_NOOP("trephine", "timed for the arm's delay"),
     QT_TRANSLATE_NOOP(
         "trephine",
         "a force acts a moment after it is computed, so it is that of the place where "
         "the arm will be then.")},
};
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

QString builtInName(const std::string& phantom) {
  return phantom == "cranium" ? tr("Cranium, built in") : tr("Abdomen, built in");
}

QString shownName(const std::string& utf8) {
  constexpr int kRun = 16;
  constexpr QChar kMayBreak(0x200b);
  QString shown;
  int run = 0;
  for (const QChar letter : toQt(utf8)) {
    if (letter.category() == QChar::Other_Format || letter.category() == QChar::Other_Control)
      continue;
    run = letter.isSpace() ? 0 : run + 1;
    const bool splits = letter.isLowSurrogate() || letter.isMark();
    if (run > kRun && !splits) {
      shown += kMayBreak;
      run = 1;
    }
    shown += letter;
  }
  return shown;
}

QString touchedName(const ArmRecord& arm, const TissueSet& tissues) {
  const auto which = std::size_t(arm.tissue_class);  // -1, nothing, is beyond all
  return which < tissues.tissues.size() ? toQt(tissues.tissues[which].name) : QString();
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

namespace {

// A needle's and a blade's length, a burr's diameter.
double sizeOf_mm(const ToolDescription& made) {
  return made.kind == ToolKind::burr ? 2.0 * made.radius_mm : made.length_mm;
}

}  // namespace

QString toolWord(const ExerciseTool& tool) {
  return tr("%1, %2 mm").arg(toQt(tool.id)).arg(sizeOf_mm(tool.tool.made_from));
}

QString toolKindWord(const ExerciseTool& tool) {
  const ToolDescription& made = tool.tool.made_from;
  const QString kind = made.kind == ToolKind::needle       ? tr("needle")
                       : made.kind == ToolKind::blade      ? tr("blade")
                       : made.shape == BurrShape::cylinder ? tr("rod burr")
                                                           : tr("burr");
  return tr("%1, %2 mm").arg(kind).arg(sizeOf_mm(made));
}

QString controllerWord(ControllerKind kind) {
  switch (kind) {
    case ControllerKind::off:
      return tr("Nothing (off)");
    case ControllerKind::seed:
      return tr("Energy (seed)");
    case ControllerKind::bounded:
      return tr("Limits (bounded)");
  }
  return {};
}

QString controllerMeaning(ControllerKind kind) {
  switch (kind) {
    case ControllerKind::off:
      return tr(
          "What the tissue demands goes to the arm as it is. On firm tissue the arm may shake.");
    case ControllerKind::seed:
      return tr(
          "Damps the arm when energy comes out of the tissue (passivity control), for comparison.");
    case ControllerKind::bounded:
      return tr("Keeps the arm calm on any tissue, and changes nothing where nothing is wrong.");
  }
  return {};
}

QString forceChangeWords(const ArmRecord& arm, bool paused) {
  if (paused) return tr("off: paused");
  if (arm.faults & ~kPassingFaults) return tr("off until asked for");
  if (arm.faults & kFaultDevice) return tr("off until the arm's error has passed");
  if (arm.faults != 0) return tr("off until the computer keeps up");
  if (arm.tool_state & kToolNoHand) return tr("off until a hand moves the arm");
  if (arm.tool_state & kToolWaits) return tr("off until the tool is drawn out");
  QStringList words;
  for (const PartWords& part : kPartWords) {
    if (arm.controller_parts & part.part) words << tr(part.words);
  }
  if (arm.tool_state & kToolArmWarm) words << tr("less, as the motors are warm");
  if (arm.tool_state & kToolOff) {
    words << (arm.buttons & kPedalLost ? tr("the tool's motor is off: the pedal does not answer")
                                       : tr("the tool's motor is off: the pedal is up"));
  }
  return words.isEmpty() ? tr("as the tissue demands") : words.join(", ");
}

QString forceChangeMeanings() {
  QStringList rows{tr("What is changed in the force that the tissue demands, before it is sent.")};
  for (const PartWords& part : kPartWords) {
    rows << QStringLiteral("%1: %2").arg(tr(part.words), tr(part.meaning));
  }
  rows << tr(
      "off: in a pause, a fault, and tissue that the tool did not come into, nothing is "
      "sent.");
  return rows.join("\n\n");
}

QString faultWords(std::uint32_t faults) {
  QStringList words;
  if (faults & kFaultDeviceLost)
    words << tr(
        "The arm does not answer: check its cable, and that no other program keeps "
        "this computer busy.");
  if (faults & kFaultStuck) words << tr("The arm's driver does not return: it was left behind.");
  if (faults & kFaultNonFinite) {
    words << tr("A pose or a force was not a number. The force stays off until you ask for it.");
  }
  if (faults & kFaultStalled) {
    words << tr(
        "The computer was too busy three times within 30 s, or once for over 2 s. The force "
        "stays off until you ask for it.");
  }
  if (faults & kFaultDeviceOften) {
    words << tr(
        "The arm reported an error three times within 10 s. The force stays off until you ask "
        "for it.");
  }
  if (faults & ~kPassingFaults) return words.join('\n');
  if (faults & kFaultDevice) {
    words << tr("The arm reports an error. The force comes back by itself a second after it.");
  }
  if (faults & kFaultLate) {
    words << tr(
        "The computer was too busy: a step came more than 20 ms late. The force comes back "
        "by itself.");
  }
  return words.join('\n');
}

QString findingWords(const SeriesReport& series) {
  QStringList lines;
  for (const Finding& finding : series.findings) {
    lines << toQt(sentencesOf(finding));
  }
  return lines.join('\n');
}

QString unlockWords(const Policy& policy) {
  if (const std::optional<Error>& why = policy.problem) {
    return toQt(why->what + " (" + why->where + "): " + why->next);
  }
  return policy.pin ? tr("An educator can unlock it with a PIN (menu File)")
                    : tr("Nothing at this workstation unlocks it");
}

QString lockedWords(const Policy& policy, bool by_policy) {
  return by_policy ? unlockWords(policy) : tr("What runs keeps it: stop the exercise first");
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
