#include "headset/headset.h"

#include <QGuiApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QThread>

#include "base/rt/thread.h"
#include "headset/openxr_session.h"
// Xlib comes with it.
#include "base/codes.h"
#include "base/tr.h"
#include "headset/codes.h"
#include "headset/openxr_functions.h"

namespace trephine {

namespace {

constexpr std::chrono::milliseconds kEndPatience{500};

}  // namespace

// Owned by the headset and its thread together: a call of OpenXR may never return.
struct Headset::Engine : HeadsetShared {
  std::unique_ptr<QOpenGLContext> context;
  std::unique_ptr<QOffscreenSurface> surface;
  QThread* home = nullptr;

  void run() {
    rt::nameThread("headset");
    context->moveToThread(QThread::currentThread());
    HeadsetEnd how;
    if (context->makeCurrent(surface.get())) {
      how = runOpenXr(*this, *context->extraFunctions());
      context->doneCurrent();
    } else {
      how.why = Error{code::kNoOpengl, tr("The headset's thread got no OpenGL"), "",
                      tr("Update the graphics driver")};
    }
    context->moveToThread(home);
    {
      std::lock_guard lock(mutex);
      over = std::move(how);
    }
    wake();
  }
};

Result<std::unique_ptr<Headset>> Headset::start(QOpenGLContext& share,
                                                const HeadsetOptions& options,
                                                std::function<void()> wake) {
  if (!share.nativeInterface<QNativeInterface::QGLXContext>()) {
    return Error{code::kNoGlx,
                 tr("A headset needs the window to draw through GLX, and this one does not"), "",
                 tr("Start Trephine with QT_QPA_PLATFORM=xcb and QT_XCB_GL_INTEGRATION=xcb_glx")};
  }
  const Result<const OpenXr*> loader = OpenXr::load();
  if (!loader) return loader.error();
  auto engine = std::make_shared<Engine>();
  engine->options = options;
  engine->wake = std::move(wake);
  engine->context = std::make_unique<QOpenGLContext>();
  engine->context->setFormat(share.format());
  engine->context->setShareContext(&share);
  if (!engine->context->create() || !QOpenGLContext::areSharing(engine->context.get(), &share)) {
    return Error{code::kNoOpengl,
                 tr("The graphics driver shares no textures with a second context"), "",
                 tr("Update the graphics driver")};
  }
  engine->surface = std::make_unique<QOffscreenSurface>();
  engine->surface->setFormat(engine->context->format());
  engine->surface->create();
  engine->home = QThread::currentThread();
  std::unique_ptr<Headset> headset(new Headset);
  headset->engine_ = engine;
  engine->context->moveToThread(nullptr);  // its own takes it
  headset->thread_ = rt::AbandonableThread([engine] { engine->run(); });
  return headset;
}

bool openXrInstalled() {
  return OpenXr::load().ok();
}

Headset::~Headset() {
  stop();
  thread_.end(kEndPatience, [this] {
    // It ends with the process, and so do its context and surface, which are not its to destroy.
    static_cast<void>(new std::shared_ptr<Engine>(engine_));
    return engine_->abandoned = true;
  });
}

void Headset::stop() {
  engine_->stop = true;
  engine_->pictures.cancelWaiting();
}

std::optional<HeadsetEnd> Headset::end() const {
  std::lock_guard lock(engine_->mutex);
  return engine_->over;
}

HeadsetState Headset::state() const {
  std::lock_guard lock(engine_->mutex);
  return engine_->now;
}

double Headset::stuck_s() const {
  const std::int64_t since_ns = engine_->in_call_since_ns;
  return since_ns == 0 ? 0.0 : 1e-9 * double(monotonic_ns() - since_ns);
}

PictureExchange& Headset::pictures() {
  return engine_->pictures;
}

}  // namespace trephine
