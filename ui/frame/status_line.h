// The line at the window's lower edge: what is said, else what mouse and keys do or whether the
// machine is fit; how far work in the background is, how fast pictures come, what is locked.
#pragma once

#include <QLabel>
#include <QProgressBar>
#include <QStatusBar>

#include "ui/work/app_context.h"

namespace trephine {

class FitnessLine;
class HeadsetView;
class StereoView;

class StatusLine : public QStatusBar {
  Q_OBJECT
 public:
  // All outlive what they say to it.
  StatusLine(AppContext& app, const HeadsetView& headset, const StereoView& stereo);

  FitnessLine& fitness() const { return *fitness_; }
  // What mouse and keys do is said where the views are.
  void setPlace(Place place, bool views);
  void showRates(const QString& words) { rates_->setText(words); }

 private:
  void showHint();
  void showEyes();
  void showLocks();
  void showProgress(double fraction, const QString& step);

  AppContext& app_;
  const HeadsetView& headset_;
  const StereoView& stereo_;
  QLabel *hint_, *eyes_, *rates_, *locked_, *opening_words_;
  FitnessLine* fitness_;
  QWidget* opening_box_;
  QProgressBar* opening_;
  QString hint_words_, help_words_;
  double panel_ms_ = 0.0;  // of the 3-D view's last picture
  Place place_ = Place::cases;
  bool views_ = false;
};

}  // namespace trephine
