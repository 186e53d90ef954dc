// The 3-D view as two pictures on another screen: a 3-D monitor, a projector, a headset that is a
// second screen. What is looked at lies in the screen's plane. Between the 3-D view
// and the room `headset`; the window's thread.
#pragma once

#include <QAction>
#include <QObject>
#include <QPointer>
#include <QScreen>
#include <QTimer>
#include <memory>

#include "headset/eye_pictures.h"
#include "headset/lens_profile.h"
#include "headset/packed_drawing.h"
#include "headset/stereo_screen.h"
#include "ui/views/view_widget.h"
#include "ui/work/messages.h"

namespace trephine {

class StereoWindow;

class StereoView : public QObject {
  Q_OBJECT
 public:
  StereoView(Messages& messages, ViewWidget& view);
  ~StereoView() override;

  QAction* onAction() const { return on_; }
  bool isOn() const { return screen_window_ != nullptr; }
  void stop();
  void settingsChanged();
  QString words() const;  // empty while it is off
  double pair_ms() const { return pair_ms_; }

 signals:
  void changed();

 private:
  void toggle(bool on);
  Status start();
  void cover();  // the screen, wherever it has gone
  Status readSettings();
  void draw();
  void screenGone(QScreen* screen);
  void release();

  Messages& messages_;
  ViewWidget& view_;
  QWidget& window_;
  QAction* on_;
  std::unique_ptr<StereoWindow> screen_window_;
  QPointer<QScreen> screen_;
  // As the settings had them when they were read last.
  LensProfile lens_;
  Packing packing_ = Packing::half;
  double eyes_mm_ = 0.0, away_mm_ = 0.0;
  EyePictures pictures_;
  double pair_ms_ = 0.0;
  bool due_ = false;
  QTimer words_timer_;
};

}  // namespace trephine
