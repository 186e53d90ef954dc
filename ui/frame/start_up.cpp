#include "ui/frame/start_up.h"

#include <malloc.h>
#include <time.h>
#include <unistd.h>

#include <QByteArray>
#include <QCoreApplication>
#include <QSettings>
#include <QSurfaceFormat>
#include <fstream>
#include <sstream>

#include "render/display_probe.h"

namespace trephine {

void prepareMemory() {
  // Left alone the C library raises this limit to the largest block that was ever freed.
  constexpr int kOwnPages_bytes = 1 << 20;
  ::mallopt(M_MMAP_THRESHOLD, kOwnPages_bytes);
  // What a picture frees the next one needs: given back to the system each time, it comes as fresh
  // pages again. giveBackFreedMemory() gives back all of it.
  constexpr int kKept_bytes = 16 << 20;
  ::mallopt(M_TRIM_THRESHOLD, kKept_bytes);
}

Status prepareDisplay() {
  // The OpenGL that VTK was built for is X's, by GLX; a Wayland desktop has an X server beside it.
  // Whatever else the environment asks Qt for would end in a view that stays black, or in no
  // window.
  qputenv("QT_QPA_PLATFORM", QByteArray("xcb"));
  qputenv("QT_XCB_GL_INTEGRATION", QByteArray("xcb_glx"));
  QSurfaceFormat format;
  format.setRenderableType(QSurfaceFormat::OpenGL);
  format.setVersion(3, 2);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  format.setStencilBufferSize(8);
  format.setSamples(0);
  QSurfaceFormat::setDefaultFormat(format);
  // A view that gets another window keeps its context, whose textures a headset and a second screen
  // show.
  QCoreApplication::setAttribute(Qt::AA_ShareOpenGLContexts);
  // Qt's file dialogs keep where they have been for the next user to read, folders named for
  // patients among them. Nothing can be kept within a device, and our own settings have a file of
  // their own (windowSettings). A desktop's dialogs keep what they like.
  QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope, "/dev/null");
  QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
  return probeDisplay();
}

double msSinceProcessStart() {
  // Field 22 of stat, in clock ticks since boot; the name in field 2 may hold blanks.
  std::ifstream file("/proc/self/stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string skipped;
  for (int field = 3; field < 22; ++field) fields >> skipped;
  double start_ticks = 0.0;
  fields >> start_ticks;
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  const double now_s = double(now.tv_sec) + double(now.tv_nsec) * 1e-9;
  return 1000.0 * (now_s - start_ticks / double(::sysconf(_SC_CLK_TCK)));
}

}  // namespace trephine
