#include "ui/common/translations.h"

#include <QLibraryInfo>
#include <QTranslator>

#include "base/tr.h"
#include "ui/common/words.h"

namespace trephine {

QString fromRoom(const char* source) {
  return QCoreApplication::translate("trephine", source);
}

bool installTranslations(QCoreApplication& application, const std::filesystem::path& folder,
                         const QLocale& locale) {
  auto* own = new QTranslator(&application);
  if (!own->load(locale, "trephine", "_", toQt(folder.string()), ".qm")) {
    delete own;
    return false;
  }
  auto* qt = new QTranslator(&application);
  if (qt->load(locale, "qtbase", "_", QLibraryInfo::path(QLibraryInfo::TranslationsPath))) {
    QCoreApplication::installTranslator(qt);
  }
  QCoreApplication::installTranslator(own);
  setTranslator([](const char* source, std::optional<int> count) {
    return QCoreApplication::translate("trephine", source, nullptr, count.value_or(-1))
        .toStdString();
  });
  return true;
}

}  // namespace trephine
