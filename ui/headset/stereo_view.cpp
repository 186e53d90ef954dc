#include "ui/headset/stereo_view.h"

#include <QElapsedTimer>
#include <QGuiApplication>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QTimer>

#include "base/codes.h"
#include "base/tr.h"
#include "ui/codes.h"
#include "ui/common/actions.h"
#include "ui/common/preferences.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "ui/headset/stereo_window.h"
#include "ui/views/device_pixels.h"

namespace trephine {

namespace {

constexpr int kStereoWordsEvery_ms = 1000;

// A window manager may have moved the window without Qt's knowing, when a screen went and came.
QScreen* screenOf(const QWidget& window) {
  QScreen* under = QGuiApplication::screenAt(window.frameGeometry().center());
  return under ? under : window.screen();
}

// The one that a person chose, if it is there; else one that the window is not on.
QScreen* chosenScreen(const QWidget& window) {
  const QString name = read(settings::kStereoScreen);
  const QList<QScreen*> all = QGuiApplication::screens();
  for (QScreen* each : all) {
    if (!name.isEmpty() && each->name() == name) return each;
  }
  if (!name.isEmpty()) return nullptr;
  for (QScreen* each : all) {
    if (each != screenOf(window)) return each;
  }
  return nullptr;
}

}  // namespace

StereoView::StereoView(Messages& messages, ViewWidget& view)
    : QObject(messages.window()), messages_(messages), view_(view), window_(*messages.window()) {
  on_ = makeAction(window_, Symbol::view, "stereo", tr("&Two pictures on another screen"),
                   Qt::SHIFT | Qt::Key_F9,
                   tr("Side by side or above each other, for a 3-D monitor or a projector; a "
                      "double click there leaves it"));
  on_->setCheckable(true);
  connect(on_, &QAction::toggled, this, &StereoView::toggle);
  // What the window has drawn anew is drawn there, once an event's turn.
  connect(&view_, &ViewWidget::framePainted, this, [this] {
    if (!screen_window_ || std::exchange(due_, true)) return;
    QTimer::singleShot(0, this, &StereoView::draw);
  });
  connect(qGuiApp, &QGuiApplication::screenRemoved, this, &StereoView::screenGone);
  connect(qGuiApp, &QGuiApplication::screenAdded, this, &StereoView::cover);
  words_timer_.setInterval(kStereoWordsEvery_ms);
  connect(&words_timer_, &QTimer::timeout, this, &StereoView::changed);
}

StereoView::~StereoView() {
  release();
}

void StereoView::toggle(bool on) {
  if (!on) return stop();
  if (screen_window_) return;
  if (const Status started = start(); !started) {
    const QSignalBlocker quiet(on_);
    on_->setChecked(false);
    messages_.report(started.error());
  }
}

Status StereoView::start() {
  if (!view_.context() || !view_.canDraw()) {
    return Error{code::kNoOpengl, trephine::tr("The 3-D view has not drawn anything yet"), "",
                 trephine::tr("Open a case, and wait until it is shown")};
  }
  screen_ = chosenScreen(window_);
  if (!screen_) {
    const QString name = read(settings::kStereoScreen);
    return name.isEmpty()
               ? Error{code::kNoScreen, trephine::tr("This computer has one screen only"), "",
                       trephine::tr(
                           "Connect another, or choose this one under View, Headset and screens")}
               : Error{
                     code::kNoScreen, trephine::tr("The chosen screen is not connected"),
                     trephine::tr("screen {}", name.toStdString()),
                     trephine::tr("Connect it, or choose another under View, Headset and screens")};
  }
  if (Status read = readSettings(); !read) return read;
  screen_window_ = std::make_unique<StereoWindow>(&window_);
  connect(screen_window_.get(), &StereoWindow::leaveWanted, this, &StereoView::stop,
          Qt::QueuedConnection);
  cover();
  connect(screen_, &QScreen::geometryChanged, screen_window_.get(), [this] { cover(); });
  screen_window_->setWindowState(Qt::WindowFullScreen);
  screen_window_->show();  // and the keys stay where they are
  words_timer_.start();
  draw();
  emit changed();
  return {};
}

void StereoView::cover() {
  if (!screen_window_ || !screen_) return;
  screen_window_->setScreen(screen_);
  screen_window_->setGeometry(screen_->geometry());
}

Status StereoView::readSettings() {
  lens_ = {};
  if (const QString file = read(settings::kStereoLens); !file.isEmpty()) {
    Result<LensProfile> lens = readLensProfile(toPath(file));
    if (!lens) {
      Error error = lens.error();
      error.what = trephine::tr("The lens before each eye cannot be used: {}", error.what);
      return error;
    }
    lens_ = *lens;
  }
  const Preferences wanted = preferences();
  packing_ = wanted.packing;
  eyes_mm_ = wanted.eyes_mm;
  away_mm_ = wanted.screen_mm;
  return {};
}

void StereoView::settingsChanged() {
  if (!screen_window_) return;
  if (chosenScreen(window_) != screen_) {
    stop();
    on_->setChecked(true);
  } else if (const Status read = readSettings(); !read) {
    stop();
    messages_.report(read.error());
  } else {
    draw();
  }
}

void StereoView::stop() {
  if (!screen_window_) return;
  release();
  const QSignalBlocker quiet(on_);
  on_->setChecked(false);
  emit changed();
}

void StereoView::release() {
  words_timer_.stop();
  screen_window_.reset();
  view_.withGraphics([this](SceneRenderer& renderer, unsigned int, int, int) {
    pictures_.release();
    renderer.releaseEyes();
  });
}

void StereoView::draw() {
  due_ = false;
  if (!screen_window_) return;
  const int wide = pixelsOf(*screen_window_).width(), high = pixelsOf(*screen_window_).height();
  const ViewCamera& camera = view_.camera();
  const StereoScreen screen = screenThrough(camera.distance_mm(), camera.halfHeight_mm(),
                                            aspectOf(packing_, wide, high), eyes_mm_, away_mm_);
  const Eyes eyes_mm = eyesBefore(screen, camera.pose_mm());
  bool warmed = false;
  QElapsedTimer timer;
  timer.start();
  view_.withGraphics([&](SceneRenderer& renderer, unsigned int, int, int) {
    // What is drawn for the first time takes as long as several pictures: one thing an event.
    warmed = renderer.warmUp();
    if (warmed) return;
    for (std::size_t eye = 0; eye < 2; ++eye) {
      const EyeRect rect = rectOf(eye, packing_, wide, high);
      renderer.paintEye(eyes_mm[eye], pictures_.framebuffer(eye, rect.width, rect.height),
                        rect.width, rect.height);
    }
    QOpenGLContext::currentContext()->functions()->glFlush();
  });
  if (warmed) {
    due_ = true;
    return QTimer::singleShot(0, this, &StereoView::draw);
  }
  pair_ms_ = double(timer.nsecsElapsed()) * 1e-6;
  screen_window_->show(pictures_.textures(), packing_, lens_);
}

void StereoView::screenGone(QScreen* screen) {
  if (!screen_window_ || screen != screen_) return;
  stop();
  messages_.say(tr("The screen for both eyes is gone: the exercise goes on here."));
}

QString StereoView::words() const {
  if (!screen_window_) return {};
  return tr("Both eyes on %1: %2 ms")
      .arg(screen_ ? screen_->name() : QString())
      .arg(pair_ms_, 0, 'f', 1);
}

}  // namespace trephine
