// The dialogs over the window that are of no workspace, with the actions that open them: settings,
// arms, headset, commissioning, the educator's PIN, all keys, what this program is. Window's
// thread.
#pragma once

#include <QAction>
#include <QMainWindow>
#include <filesystem>
#include <functional>

#include "ui/work/app_context.h"

namespace trephine {

class FitnessLine;
class HeadsetView;
struct LeftBehind;
class StereoView;

class WindowDialogs : public QObject {
  Q_OBJECT
 public:
  // All of them outlive it; `fitness` looks again after a commissioning.
  WindowDialogs(QMainWindow& window, AppContext& app, HeadsetView& headset, StereoView& stereo,
                FitnessLine& fitness);

  QList<QAction*> actions() const { return {settings_, devices_, commission_, unlock_}; }
  QAction* headsetAction() const { return headset_settings_; }

  void showKeys();
  void showAbout();
  // What a program that crashed has left: said, with its report, and its recording offered.
  void offerLeftBehind(const LeftBehind& left,
                       std::function<void(const std::filesystem::path&)> open);

 private:
  void showSettings();
  void showDevices();
  void showHeadset();
  void showCommission();
  void askForPin();
  bool armsAreFree() const;
  void showPhase();
  void showLocks();

  QMainWindow& window_;
  AppContext& app_;
  Workstation& workstation_;
  HeadsetView& headset_;
  StereoView& stereo_;
  FitnessLine& fitness_;
  QAction *settings_, *devices_, *headset_settings_, *commission_, *unlock_;
};

}  // namespace trephine
