#include "render/display_probe.h"

#include <dlfcn.h>

#include <chrono>
#include <cstdlib>
#include <thread>

namespace trephine {

namespace {

// From the GLX 1.4 specification; its header's macros clash with ours (Status, None).
constexpr int kGlxDoubleBuffer = 5;
constexpr int kGlxDepthSize = 12;
constexpr int kGlxDrawableType = 0x8010, kGlxWindowBit = 0x1;
constexpr int kGlxRenderType = 0x8011, kGlxRgbaBit = 0x1;

// Opened by name, as VTK has them loaded anyway: no dependency of our own on X.
class Library {
 public:
  explicit Library(const char* name) : handle_(::dlopen(name, RTLD_NOW | RTLD_LOCAL)) {}
  template <class Function>
  Function* find(const char* name) const {
    return handle_ ? reinterpret_cast<Function*>(::dlsym(handle_, name)) : nullptr;
  }

 private:
  void* handle_;  // never closed: X libraries do not survive it
};

// An X server under xvfb-run starts afresh when its last client leaves, and refuses newcomers while
// it does. So a refusal is tried again for a moment.
void* openDisplay(void* (*open)(const char*)) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    if (void* display = open(nullptr)) return display;
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  return nullptr;
}

}  // namespace

Status probeDisplay() {
  const Error no_display{"NO_DISPLAY", "There is no display to draw on", "DISPLAY",
                         "Start inside a desktop session, or under xvfb-run"};
  const Error no_opengl{"NO_OPENGL", "The display offers no OpenGL", "GLX",
                        "Install the graphics driver, or libgl1-mesa-dri for drawing in software"};
  const char* name = std::getenv("DISPLAY");
  if (!name || !*name) return no_display;
  const Library x11("libX11.so.6"), gl("libGL.so.1");
  auto* open = x11.find<void*(const char*)>("XOpenDisplay");
  auto* default_screen = x11.find<int(void*)>("XDefaultScreen");
  auto* free_list = x11.find<int(void*)>("XFree");
  auto* query = gl.find<int(void*, int*, int*)>("glXQueryExtension");
  auto* choose = gl.find<void*(void*, int, const int*, int*)>("glXChooseFBConfig");
  if (!open || !default_screen || !free_list) return no_display;
  if (!query || !choose) return no_opengl;

  // Stays open until the process ends, or closing it could be that last leave, just before VTK
  // comes.
  static void* const display = openDisplay(open);
  if (!display) return no_display;
  int error_base = 0, event_base = 0, count = 0;
  if (!query(display, &error_base, &event_base)) return no_opengl;
  const int wanted[] = {kGlxDrawableType,
                        kGlxWindowBit,
                        kGlxRenderType,
                        kGlxRgbaBit,
                        kGlxDepthSize,
                        1,
                        kGlxDoubleBuffer,
                        1,
                        0};
  void* configs = choose(display, default_screen(display), wanted, &count);
  if (configs) free_list(configs);
  if (count < 1) return no_opengl;
  return {};
}

}  // namespace trephine
