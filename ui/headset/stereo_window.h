// A screen that two pictures cover, without a frame. It takes no keys: those are the main window's.
#pragma once

#include <QOpenGLWidget>
#include <array>

#include "headset/lens_profile.h"
#include "headset/packed_drawing.h"
#include "headset/stereo_screen.h"

namespace trephine {

class StereoWindow : public QOpenGLWidget {
  Q_OBJECT
 public:
  explicit StereoWindow(QWidget* main_window);
  ~StereoWindow() override;

  // Textures of the main window's share group, drawn and flushed.
  void show(const std::array<unsigned int, 2>& textures, Packing packing, const LensProfile& lens);
  using QOpenGLWidget::show;

 signals:
  void leaveWanted();  // by a double click, or because it was closed

 protected:
  void paintGL() override;
  void closeEvent(QCloseEvent*) override { emit leaveWanted(); }
  void mouseDoubleClickEvent(QMouseEvent*) override { emit leaveWanted(); }

 private:
  PackedDrawing drawing_;
  std::array<unsigned int, 2> textures_{};
  Packing packing_ = Packing::half;
  LensProfile lens_;
};

}  // namespace trephine
