// Tools and arms: their panel, where the arms reach in the views, and what settings cost on this
// machine. Between the panel, the views and the workstation.
#pragma once

#include <QObject>
#include <filesystem>
#include <string>
#include <vector>

#include "ui/common/background_task.h"
#include "ui/prepare/tools_panel.h"
#include "ui/views/four_up.h"
#include "ui/work/messages.h"
#include "ui/work/workstation.h"

namespace trephine {

class ArmsTab : public QObject {
  Q_OBJECT
 public:
  ArmsTab(Workstation& workstation, FourUp& views, Messages& messages, ToolsPanel& tools,
          QObject* parent);

  // Whether it is seen; the panel is filled, and boxes and tools are drawn, while it is.
  void show(bool in_front);

 private:
  void refresh();
  void showBoxes();
  void measureCosts();
  void showTrades();
  void measureTrades();
  void workspaceMoved(const Vec3& centre_mm, bool done);

  Workstation& workstation_;
  Messages& messages_;
  FourUp* views_;
  ToolsPanel* tools_;
  BackgroundTask costing_;
  bool in_front_ = false;
};

}  // namespace trephine
