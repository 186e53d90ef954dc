// Poking: a session in which nothing is cut, beside the tissues; edits of them are felt at once.
#pragma once

#include <QAction>
#include <QObject>
#include <QTimer>
#include <optional>

#include "ui/prepare/poke_forecast.h"
#include "ui/tissue/poke_plot.h"
#include "ui/tissue/tissue_panel.h"
#include "ui/work/case_views.h"

namespace trephine {

class PokeTab : public QObject {
  Q_OBJECT
 public:
  PokeTab(Workstation& workstation, Messages& messages, WorkGuards& guards, CaseViews& case_views,
          TissuePanel& tissues, PokePlot& plot, QObject* parent);

  QAction* action() const { return action_; }
  // `here`: its workspace is shown; `in_front`: so are the tissues.
  void show(bool here, bool in_front);
  // Tissues, tools or arms have changed.
  void renewForecast() { forecast_.renew(); }

 signals:
  void frontWanted();  // Prepare with the tissues

 private:
  void refresh();
  void toggle();
  void showPokes(Session& session);
  void showForecast();

  Workstation& workstation_;
  Messages& messages_;
  WorkGuards& guards_;
  CaseViews& case_views_;
  FourUp* views_;
  ViewWidget* view_;
  TissuePanel& tissues_;
  PokePlot& plot_;
  QAction* action_;
  QTimer timer_;
  PokeForecast forecast_;
  std::optional<ViewLayout> layout_before_;  // the poke
  bool here_ = false, in_front_ = false;
};

}  // namespace trephine
