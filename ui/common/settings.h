// What the workstation remembers from one session to the next, as typed values with key and
// default: how the window is laid out and how a person likes to work, never what it shows. Nothing
// of a patient, no path of a source, no name.
#pragma once

#include <QByteArray>
#include <QFileInfo>
#include <QSettings>
#include <QStandardPaths>
#include <QString>
#include <QStringList>
#include <type_traits>

namespace trephine {

inline QSettings windowSettings() {
  const QString file =
      QStandardPaths::writableLocation(QStandardPaths::AppConfigLocation) + "/window.ini";
  // A pipe in its place would never be read to its end.
  const QFileInfo there(file);
  const bool usable = !there.exists() || there.isFile();
  return QSettings(usable ? file : file + ".new", QSettings::IniFormat);
}

template <class Value>
struct Setting {
  const char* key;
  Value fallback;
};

// What is not of the value's type is read as the fallback.
template <class Value>
Value read(const Setting<Value>& setting) {
  const QVariant found = windowSettings().value(setting.key);
  if (!found.isValid() || !found.canConvert<Value>()) return setting.fallback;
  if constexpr (std::is_same_v<Value, bool>) {  // to Qt any other word is yes
    const QString word = found.toString();
    if (word != "true" && word != "false") return setting.fallback;
  }
  return found.value<Value>();
}

// `value` that lies within, or the fallback.
template <class Value>
Value readWithin(const Setting<Value>& setting, Value least, Value most) {
  const Value value = read(setting);
  return value >= least && value <= most ? value : setting.fallback;
}

template <class Value>
void write(const Setting<Value>& setting, const Value& value) {
  QSettings settings = windowSettings();
  if (value == setting.fallback) {
    settings.remove(setting.key);
  } else {
    settings.setValue(setting.key, value);
  }
}

namespace settings {

// Chosen by a person, in the dialog of settings.
inline const Setting<QString> kStorage{"storage", {}};      // folder; empty: the user's own data
inline const Setting<QString> kLanguage{"language", "en"};  // "en", "zh_TW"
inline const Setting<QString> kTheme{"theme", "dark"};      // "dark", "light"
inline const Setting<int> kTextScale{"text_percent", 100};  // 80 to 200
inline const Setting<QString> kMainHand{"hands/main", "right"};      // that the mouse takes first
inline const Setting<double> kPushStep_N{"mouse/push_step_N", 0.2};  // a notch of the wheel
inline const Setting<double> kKeyStep_mm{"keys/step_mm", 1.0};       // an arrow key
// Device of the arm of that name: plugin, bus path, serial, model; empty: a simulated one.
inline const Setting<QStringList> kLeftArm{"arms/left", {}}, kRightArm{"arms/right", {}};
inline const Setting<QStringList> kFootPedal{"arms/pedal", {}};  // likewise; empty: none
inline constexpr double kArmsLeast_N = 0.5, kArmsMost_N = 40.0;
inline const Setting<double> kArmsLimit_N{"arms/most_N", kArmsMost_N};  // beside the exercise's own
// Where the patient stands before the eyes in a headset, and how large.
inline constexpr double kAheadLeast_m = 0.2, kAheadMost_m = 2.0, kBelowMost_m = 1.0;
inline constexpr double kLeastScale = 0.25, kMostScale = 8.0;
inline const Setting<double> kHeadsetAhead_m{"headset/ahead_m", 0.4};
inline const Setting<double> kHeadsetBelow_m{"headset/below_m", 0.2};
inline const Setting<double> kHeadsetScale{"headset/scale", 1.0};
inline const Setting<bool> kHeadsetMirror{"headset/mirror",
                                          false};                   // the window shows the left eye
inline const Setting<QStringList> kArmsInRoom{"headset/arms", {}};  // ui/work/arms_in_room
// Two pictures on one screen.
inline constexpr double kEyesLeast_mm = 40.0, kEyesMost_mm = 80.0;
inline constexpr double kScreenLeast_mm = 100.0, kScreenMost_mm = 20000.0;
inline const Setting<QString> kStereoScreen{"stereo/screen", {}};  // its name; empty: the second
inline const Setting<QString> kStereoPacking{"stereo/packing", "half"};  // full, half, top_bottom
inline const Setting<double> kStereoEyes_mm{"stereo/eyes_mm", 63.0};
inline const Setting<double> kStereoScreen_mm{"stereo/screen_mm", 600.0};
inline const Setting<QString> kStereoLens{"stereo/lens", {}};  // a file of lens.md; empty: none
// Of the window itself.
inline const Setting<QByteArray> kGeometry{"window/geometry", {}};
// Of the columns beside the views, for each workspace: its name follows.
inline constexpr const char* kColumns = "window/columns/";
inline const Setting<QString> kWorkspace{"window/workspace", "cases"};
inline const Setting<bool> kLeftPanel{"window/left_panel", true};
inline const Setting<bool> kRightPanel{"window/right_panel", true};
inline const Setting<QStringList> kRecentCases{"cases/recent", {}};  // ids, the newest first

}  // namespace settings

}  // namespace trephine
