// A widget that OpenGL draws, with other widgets over it. Window's thread.
//
// Which way its pictures take to the screen is decided once, where it is made (way_to_screen.h):
// composed, it holds a QOpenGLWidget; copied, it draws into a framebuffer object of its own, reads
// that back into memory that it keeps and paints it as a picture. What lies over it is painted by
// Qt either way.
#pragma once

#include <QImage>
#include <QWidget>
#include <memory>

#include "ui/views/way_to_screen.h"

class QOpenGLContext;
class QOffscreenSurface;
class QOpenGLFramebufferObject;

namespace trephine {

class OpenGlPane : public QWidget {
  Q_OBJECT
 public:
  OpenGlPane(WayToScreen way, QWidget* parent);
  ~OpenGlPane() override;

  WayToScreen way() const { return way_; }
  // Null until it could start to draw, and where it could not.
  QOpenGLContext* context() const;
  void makeCurrent();
  void doneCurrent();
  // What is shown; while the context is current.
  unsigned int defaultFramebufferObject() const;
  // Draws, and reads back what was drawn.
  QImage grabFramebuffer();
  // Another picture is drawn once all else that waits is done, also where other widgets cover all
  // of it. What changes over it alone needs none.
  void update();

 protected:
  // As QOpenGLWidget has them: the context is current, and in paintGL() the framebuffer is bound.
  virtual void initializeGL() = 0;
  virtual void resizeGL() = 0;  // of which the size in pixels is pixelsOf()
  virtual void paintGL() = 0;
  virtual void couldNotStart() = 0;  // there is no context to be had; said once

  bool event(QEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  class Composed;
  bool start();
  void fit();
  void draw();
  void drawWanted();

  const WayToScreen way_;
  Composed* composed_ = nullptr;
  // Where it is copied.
  std::unique_ptr<QOffscreenSurface> surface_;
  std::unique_ptr<QOpenGLContext> context_;
  std::unique_ptr<QOpenGLFramebufferObject> framebuffer_;
  QImage read_;           // rows go up, as OpenGL's do
  QImage picture_;        // null where there is no room for it
  bool refused_ = false;  // there is no context to be had
  bool wanted_ = true;    // another picture is to be drawn
  bool posted_ = false;   // and the event that asks for it is on its way
  bool unseen_ = false;   // it was drawn and not painted yet
};

}  // namespace trephine
