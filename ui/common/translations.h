// The language of the window and of the rooms below it.
#pragma once

#include <QCoreApplication>
#include <QLocale>
#include <filesystem>

namespace trephine {

// Installs what `folder` holds for the locale (trephine_de.qm for German) and Qt's own texts of
// that language; English holds where the folder has none. Returns whether it had one. To be called
// once, after the application exists and before other threads do. Window thread.
bool installTranslations(QCoreApplication& application, const std::filesystem::path& folder,
                         const QLocale& locale);

// A text of a table of a room (base/tr.h, trLater), in the language of the window.
QString fromRoom(const char* source);

}  // namespace trephine
