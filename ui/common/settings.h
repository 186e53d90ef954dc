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
// Device of the arm of that name: plugin, bus path, serial, model; empty: a simulated one.
inline const Setting<QStringList> kLeftArm{"arms/left", {}}, kRightArm{"arms/right", {}};
inline const Setting<QStringList> kFootPedal{"arms/pedal", {}};  // likewise; empty: none
inline const Setting<QStringList> kArmsInRoom{"headset/arms", {}};  // ui/work/arms_in_room
// Two pictures on one screen.
inline const Setting<QString> kStereoScreen{"stereo/screen", {}};  // its name; empty: the second
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
