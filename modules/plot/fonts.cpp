#include "plot/fonts.h"

#include <QFont>
#include <QFontInfo>
#include <QGuiApplication>
#include <QPluginLoader>
#include <clocale>
#include <mutex>
#include <string>

#include "base/tr.h"
#include "plot/codes.h"

namespace trephine::plot {

namespace {

// Qt ends a process whose platform it does not find, so it is asked for first.
Status makeApplication() {
  QPluginLoader platform("platforms/libqoffscreen");
  if (!platform.load()) {
    return Error{code::kCannotDraw,
                 tr("Qt's offscreen platform, which pictures are drawn on, is missing"),
                 "platforms/libqoffscreen", tr("Install the package libqt6gui6 again")};
  }
  static char name[] = "trephine", option[] = "-platform", value[] = "offscreen";
  static char* arguments[] = {name, option, value, nullptr};
  static int count = 3;
  // Qt takes over the environment's locale, decimal commas included, and complains of some.
  const std::string locale = std::setlocale(LC_ALL, nullptr);
  const QtMessageHandler before =
      qInstallMessageHandler([](QtMsgType, const QMessageLogContext&, const QString&) {});
  new QGuiApplication(count, arguments);  // Qt keeps it; never deleted
  qInstallMessageHandler(before);
  std::setlocale(LC_ALL, locale.c_str());
  return {};
}

}  // namespace

Status readyFonts() {
  static std::mutex mutex;
  static bool ready = false;
  const std::lock_guard lock(mutex);
  if (ready) return {};
  if (!QCoreApplication::instance()) {
    if (Status made = makeApplication(); !made) return made;
  }
  if (!qobject_cast<QGuiApplication*>(QCoreApplication::instance())) {
    return Error{code::kCannotDraw, tr("This program draws no pictures"),
                 tr("its application object"), ""};
  }
  // Without any, Qt lists families all the same and draws boxes of a family without a name.
  if (QFontInfo(QFont()).family().isEmpty()) {
    return Error{code::kCannotDraw, tr("There is no font to write with"), "fontconfig",
                 tr("Install the package fonts-dejavu-core")};
  }
  ready = true;
  return {};
}

}  // namespace trephine::plot
