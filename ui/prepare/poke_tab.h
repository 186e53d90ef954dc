// Poking: a session in which nothing is cut, beside the tissues; edits of them are felt at once.
#pragma once

#include <QAction>
#include <QObject>
#include <QTimer>
#include <optional>

#include "ui/tissue/poke_plot.h"
#include "ui/tissue/tissue_panel.h"
#include "ui/work/app_context.h"

namespace trephine {

class PokeTab : public QObject {
  Q_OBJECT
 public:
  PokeTab(AppContext& app, TissuePanel& tissues, PokePlot& plot);

  QAction* action() const { return action_; }
  // `here`: its workspace is shown; `in_front`: so are the tissues.
  void show(bool here, bool in_front);

 signals:
  void frontWanted();  // the tissues

 private:
  void refresh();
  void toggle();
  void showPokes(Session& session);

  AppContext& app_;
  Workstation& workstation_;
  FourUp* views_;
  ViewWidget* view_;
  TissuePanel& tissues_;
  PokePlot& plot_;
  QAction* action_;
  QTimer timer_;
  std::optional<ViewLayout> layout_before_;  // the poke
  bool here_ = false, in_front_ = false;
};

}  // namespace trephine
