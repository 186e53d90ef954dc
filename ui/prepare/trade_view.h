// What a setting costs and what it gets wrong, beside the setting itself: the rows of a knob of
// `trephine-lab trades`, with the recommended one marked and the one in use in bold.
#pragma once

#include <QLabel>
#include <string>
#include <vector>

#include "machine/trades/trades_measurement.h"

namespace trephine {

class TradeView : public QLabel {
  Q_OBJECT
 public:
  TradeView(const char* name, QWidget* parent);

  // The knob's rows among these; none: nothing is shown.
  void show(const std::vector<TradeRow>& rows, const std::string& knob, const std::string& in_use);
};

}  // namespace trephine
