// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkAutoInit.h>
#include <vtkOpenGLRenderWindow.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "base/codes.h"
#include "base/tr.h"
#include "render/codes.h"
#include "render/display_probe.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2);

namespace trephine {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kLimit(15);  // a busy machine needs a second or two

// What the child says. Smaller than what a pipe takes whole.
struct Answer {
  bool display = false;
  bool done = false;
  int version = 0;
  char driver[160] = {};  // empty: no context could be made
  char renderer[160] = {};
};

// An X server under xvfb-run starts afresh when its last client leaves, and refuses newcomers while
// it does. So a refusal is tried again for a moment, and what was opened stays open until the
// process ends. Found by name: VTK has the library loaded anyway.
bool holdDisplay() {
  void* x11 = ::dlopen("libX11.so.6", RTLD_NOW | RTLD_LOCAL);
  if (!x11) return false;
  auto* open = reinterpret_cast<void* (*)(const char*)>(::dlsym(x11, "XOpenDisplay"));
  for (int attempt = 0; open && attempt < 10; ++attempt) {
    if (open(nullptr)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  return false;
}

// As SceneRenderer::offscreen does it.
void tryOpenGl(Answer& answer) {
  // Never deleted: the child ends with it.
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(vtkRenderWindow::New());
  if (!window) return;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(16, 16);
  window->Initialize();
  window->MakeCurrent();
  answer.version = openGlVersion();
  const auto* driver = reinterpret_cast<const char*>(glGetString(GL_VERSION));
  std::snprintf(answer.driver, sizeof answer.driver, "%s", driver ? driver : "");
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  std::snprintf(answer.renderer, sizeof answer.renderer, "%s", renderer ? renderer : "");
}

std::string probed_renderer;

[[noreturn]] void becomeProbe(int answers) noexcept {
  // Xlib and drivers call exit(): what this copy has inherited, open files above all, is not its to
  // close.
  std::atexit([] { ::_exit(1); });
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int number : {SIGINT, SIGTERM}) ::signal(number, SIG_DFL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(nothing, STDERR_FILENO);
  const auto say = [&](const Answer& answer) {
    if (::write(answers, &answer, sizeof answer) != sizeof answer) ::_exit(1);
  };
  Answer answer;
  answer.display = holdDisplay();
  say(answer);
  if (answer.display) tryOpenGl(answer);
  answer.done = true;
  say(answer);
  while (true) ::pause();  // keeps the display's server until the parent has opened it
}

// What the child said until it was done, died or hung.
Result<Answer> askChild() {
  int ends[2] = {-1, -1};
  const bool piped = ::pipe2(ends, O_CLOEXEC) == 0;
  const pid_t child = piped ? ::fork() : -1;
  if (child < 0) {
    const Error refused{code::kNoOpengl, tr("OpenGL cannot be tried: {}", std::strerror(errno)),
                        tr("graphics driver"), tr("Close other programs and start again")};
    for (const int descriptor : ends) ::close(descriptor);
    return refused;
  }
  if (child == 0) becomeProbe(ends[1]);
  ::close(ends[1]);
  Answer answer;
  const Clock::time_point end = Clock::now() + kLimit;
  while (!answer.done && Clock::now() < end) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
    pollfd said{ends[0], POLLIN, 0};
    if (::poll(&said, 1, int(left.count()) + 1) <= 0) continue;  // a signal, or the time is up
    Answer next;
    if (::read(ends[0], &next, sizeof next) != sizeof next) break;
    answer = next;
  }
  ::close(ends[0]);
  if (answer.display) holdDisplay();
  ::kill(child, SIGKILL);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  return answer;
}

}  // namespace

int openGlVersion() {
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  return major * 10 + minor;
}

Error openGlTooOld(const std::string& driver) {
  return {code::kNoOpengl, tr("OpenGL 3.2 is needed, the driver offers {}", driver),
          tr("graphics driver"), tr("Update the driver, or start with LIBGL_ALWAYS_SOFTWARE=1")};
}

Status probeDisplay() {
  const Error no_display{code::kNoDisplay, tr("There is no display to draw on"), "DISPLAY",
                         tr("Start inside a desktop session, or under xvfb-run")};
  const char* name = std::getenv("DISPLAY");
  if (!name || !*name) return no_display;
  static bool usable = false;
  if (usable) return {};
  const Result<Answer> answer = askChild();
  if (!answer) return answer.error();
  if (!answer->display) return no_display;
  if (!answer->done || !*answer->driver) {
    return Error{code::kNoOpengl, tr("The display offers no OpenGL that works"),
                 tr("graphics driver"),
                 tr("Install the graphics driver, or libgl1-mesa-dri for drawing in software")};
  }
  if (answer->version < kOpenGlNeeded) return openGlTooOld(answer->driver);
  usable = true;
  probed_renderer = answer->renderer;
  return {};
}

std::string probedRenderer() {
  return probed_renderer;
}

}  // namespace trephine
