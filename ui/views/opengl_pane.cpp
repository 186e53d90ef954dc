#include "ui/views/opengl_pane.h"

#include <QCoreApplication>
#include <QEvent>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QOpenGLFramebufferObject>
#include <QOpenGLWidget>
#include <QPaintEvent>
#include <QPainter>
#include <QTimer>
#include <QWindow>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "ui/views/device_pixels.h"

namespace trephine {

namespace {

const QEvent::Type kDraw = QEvent::Type(QEvent::registerEventType());

// OpenGL's bytes are red, green, blue and opacity from the lowest row up; Qt's are one number, blue
// lowest, from the highest row down.
void turnOver(const unsigned char* from, QImage& into) {
  const int wide = into.width(), high = into.height();
  for (int row = 0; row < high; ++row) {
    const unsigned char* source = from + std::size_t(high - 1 - row) * std::size_t(wide) * 4;
    auto* target = reinterpret_cast<std::uint32_t*>(into.scanLine(row));
    for (int x = 0; x < wide; ++x) {
      std::uint32_t pixel;
      std::memcpy(&pixel, source + std::size_t(x) * 4, sizeof pixel);
      target[x] = 0xff000000U | (pixel & 0xffU) << 16 | (pixel & 0xff00U) | (pixel >> 16 & 0xffU);
    }
  }
}

}  // namespace

// Under all else that lies in the pane, which gets its mouse and keys.
class OpenGlPane::Composed : public QOpenGLWidget {
 public:
  explicit Composed(OpenGlPane& pane) : QOpenGLWidget(&pane), pane_(pane) {
    setObjectName("composedView");
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setFocusPolicy(Qt::NoFocus);
  }

 protected:
  void initializeGL() override { pane_.initializeGL(); }
  // Qt paints within it, for a layout more than once, and once more when all is in its place.
  void resizeEvent(QResizeEvent* event) override {
    resizing_ = true;
    QOpenGLWidget::resizeEvent(event);
    resizing_ = false;
  }
  void resizeGL(int, int) override { pane_.resizeGL(); }
  void paintGL() override {
    if (!resizing_) pane_.paintGL();
  }

 private:
  OpenGlPane& pane_;
  bool resizing_ = false;
};

OpenGlPane::OpenGlPane(WayToScreen way, QWidget* parent) : QWidget(parent), way_(way) {
  if (way == WayToScreen::composed) {
    composed_ = new Composed(*this);
  } else {
    setAttribute(Qt::WA_OpaquePaintEvent);
  }
}

OpenGlPane::~OpenGlPane() {
  delete composed_;
  if (!context_) return;
  makeCurrent();
  framebuffer_.reset();
  doneCurrent();
}

QOpenGLContext* OpenGlPane::context() const {
  return composed_ ? composed_->context() : context_.get();
}

void OpenGlPane::makeCurrent() {
  if (composed_) return composed_->makeCurrent();
  if (!context_) return;
  context_->makeCurrent(surface_.get());
  if (!size().isEmpty()) fit();
  if (framebuffer_) framebuffer_->bind();
}

// What is drawn into and read back to has the size that the pane has now.
void OpenGlPane::fit() {
  const QSize size = pixelsOf(*this);
  if (framebuffer_ && framebuffer_->size() == size) return;
  framebuffer_.reset();
  framebuffer_ = std::make_unique<QOpenGLFramebufferObject>(
      size, QOpenGLFramebufferObject::CombinedDepthStencil);
  QImage picture(size, QImage::Format_RGB32);
  QImage read(size, QImage::Format_RGBX8888);
  picture.fill(Qt::black);
  const bool fits = framebuffer_->isValid() && !picture.isNull() && !read.isNull();
  picture_ = fits ? picture : QImage();
  read_ = fits ? read : QImage();
}

void OpenGlPane::doneCurrent() {
  if (composed_) return composed_->doneCurrent();
  if (context_) context_->doneCurrent();
}

unsigned int OpenGlPane::defaultFramebufferObject() const {
  if (composed_) return composed_->defaultFramebufferObject();
  return framebuffer_ ? framebuffer_->handle() : 0;
}

void OpenGlPane::update() {
  if (composed_) return composed_->update();
  wanted_ = true;
  if (std::exchange(posted_, true)) return;
  QCoreApplication::postEvent(this, new QEvent(kDraw), Qt::LowEventPriority);
}

// The context, where there is none yet.
bool OpenGlPane::start() {
  if (context_) return true;
  if (refused_) return false;
  auto context = std::make_unique<QOpenGLContext>();
  context->setShareContext(QOpenGLContext::globalShareContext());
  auto surface = std::make_unique<QOffscreenSurface>();
  surface->create();
  if (!context->create() || !context->makeCurrent(surface.get())) {
    refused_ = true;
    couldNotStart();
    return false;
  }
  context_ = std::move(context);
  surface_ = std::move(surface);
  initializeGL();
  doneCurrent();
  return true;
}

// Into our own framebuffer, and from there into the picture.
void OpenGlPane::draw() {
  makeCurrent();
  QOpenGLExtraFunctions& gl = *context_->extraFunctions();
  gl.glViewport(0, 0, framebuffer_->width(), framebuffer_->height());
  wanted_ = false;  // paintGL() may want another
  paintGL();
  makeCurrent();  // who heard of the picture may have worked with the context
  if (!picture_.isNull()) {
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_->handle());
    gl.glReadBuffer(GL_COLOR_ATTACHMENT0);
    gl.glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    gl.glPixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    gl.glReadPixels(0, 0, read_.width(), read_.height(), GL_RGBA, GL_UNSIGNED_BYTE, read_.bits());
    turnOver(read_.constBits(), picture_);
    picture_.setDevicePixelRatio(devicePixelRatioF());
  }
  doneCurrent();
}

// Before what is seen of it is painted: Qt paints nothing that is covered, and others wait for a
// picture all the same. What nobody can see waits until it is shown.
void OpenGlPane::drawWanted() {
  if (!wanted_ || !isVisible() || size().isEmpty()) return;
  const QWindow* window = this->window()->windowHandle();
  if (!window || !window->isExposed()) return QWidget::update();  // which Qt keeps until it is
  if (!start()) return;
  if (!updatesEnabled()) return QTimer::singleShot(0, this, &OpenGlPane::update);
  draw();
  unseen_ = true;
  repaint();  // at once: what was drawn may have asked for another already
  unseen_ = false;
}

bool OpenGlPane::event(QEvent* event) {
  if (event->type() != kDraw) return QWidget::event(event);
  posted_ = false;
  drawWanted();
  return true;
}

void OpenGlPane::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  update();
}

QImage OpenGlPane::grabFramebuffer() {
  if (composed_) return composed_->grabFramebuffer();
  if (size().isEmpty() || !start()) return {};
  draw();
  QWidget::update();
  return picture_.copy();
}

void OpenGlPane::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  if (composed_) return composed_->setGeometry(rect());
  if (size().isEmpty() || !start()) return;
  makeCurrent();
  resizeGL();
  doneCurrent();
  update();
}

// A picture that was just drawn is shown, even where another is wanted by now.
void OpenGlPane::paintEvent(QPaintEvent* event) {
  if (composed_) return;
  const bool fits =
      picture_.size() == pixelsOf(*this) && picture_.devicePixelRatio() == devicePixelRatioF();
  const bool fresh = unseen_ && fits;
  if ((wanted_ || !fits) && !fresh && !size().isEmpty() && start()) draw();
  QPainter painter(this);
  // At a scale that is no whole number an edge may be left.
  const bool whole = devicePixelRatioF() == std::floor(devicePixelRatioF());
  if (picture_.isNull() || !whole) painter.fillRect(event->rect(), Qt::black);
  if (!picture_.isNull()) painter.drawImage(0, 0, picture_);
}

}  // namespace trephine
