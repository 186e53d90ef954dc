// What the window remembers of itself from one session to the next: how it is laid out, never what
// it shows. Nothing of a patient, no path, no name.
#pragma once

#include <QSettings>
#include <QStandardPaths>

namespace trephine {

inline QSettings windowSettings() {
  return QSettings(
      QStandardPaths::writableLocation(QStandardPaths::AppConfigLocation) + "/window.ini",
      QSettings::IniFormat);
}

}  // namespace trephine
