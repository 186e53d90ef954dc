#include "ui/headset/stereo_window.h"

#include <QCloseEvent>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>

#include "ui/views/device_pixels.h"

namespace trephine {

StereoWindow::StereoWindow(QWidget* main_window)
    : QOpenGLWidget(main_window,
                    Qt::Window | Qt::FramelessWindowHint | Qt::WindowDoesNotAcceptFocus) {
  setObjectName("stereoWindow");
  setWindowTitle(tr("Trephine, for both eyes"));
  setAttribute(Qt::WA_ShowWithoutActivating);
  setCursor(Qt::BlankCursor);
}

StereoWindow::~StereoWindow() {
  if (!context()) return;
  makeCurrent();
  drawing_.release();
  doneCurrent();
}

void StereoWindow::show(const std::array<unsigned int, 2>& textures, Packing packing,
                        const LensProfile& lens) {
  textures_ = textures;
  packing_ = packing;
  lens_ = lens;
  update();
}

void StereoWindow::paintGL() {
  if (textures_[0] == 0) {
    QOpenGLExtraFunctions& gl = *context()->extraFunctions();
    gl.glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
    gl.glClear(GL_COLOR_BUFFER_BIT);
    return;
  }
  drawing_.draw(textures_, packing_, lens_, pixelsOf(*this).width(), pixelsOf(*this).height());
}

}  // namespace trephine
