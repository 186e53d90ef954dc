#include "ui/prepare/trade_view.h"

#include "ui/common/colours.h"
#include "ui/common/words.h"

namespace trephine {

TradeView::TradeView(const char* name, QWidget* parent) : QLabel(parent) {
  setObjectName(name);
  setTextFormat(Qt::RichText);
  setWordWrap(true);
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() * 0.88);
  setFont(small);
  hide();
}

void TradeView::show(const std::vector<TradeRow>& rows, const std::string& knob,
                     const std::string& in_use) {
  QString html, error_unit, cost_unit;
  for (const TradeRow& row : rows) {
    if (row.knob != knob) continue;
    error_unit = toQt(row.error_unit).toHtmlEscaped();
    cost_unit = toQt(row.cost_unit).toHtmlEscaped();
    QString setting = toQt(row.setting).toHtmlEscaped();
    if (row.setting == in_use) setting = QStringLiteral("<b>%1</b>").arg(setting);
    html += QStringLiteral("<tr><td>%1&nbsp;</td><td align='right'>%2&nbsp;</td>"
                           "<td align='right'>%3&nbsp;</td><td style='color:%4'>%5</td></tr>")
                .arg(setting)
                .arg(row.error, 0, 'f', row.error < 10.0 ? 1 : 0)
                .arg(row.cost, 0, 'f', row.cost < 1.0 ? 2 : row.cost < 100.0 ? 1 : 0)
                .arg(colours::kGood.name(), row.recommended ? tr("recommended") : QString());
  }
  setVisible(!html.isEmpty());
  if (html.isEmpty()) return clear();
  setText(tr("Setting, its error in %1, its cost in %2:").arg(error_unit, cost_unit) +
          QStringLiteral("<table>%1</table>").arg(html));
}

}  // namespace trephine
