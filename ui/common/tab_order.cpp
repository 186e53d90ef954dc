#include "ui/common/tab_order.h"

#include <QLayout>
#include <QWidget>
#include <vector>

namespace trephine {

namespace {

void gather(QLayout& layout, std::vector<QWidget*>& widgets) {
  for (int n = 0; n < layout.count(); ++n) {
    QLayoutItem& item = *layout.itemAt(n);
    if (item.layout()) gather(*item.layout(), widgets);
    QWidget* widget = item.widget();
    if (!widget) continue;
    if (widget->focusPolicy() & Qt::TabFocus) widgets.push_back(widget);
    // A field that is made of several widgets, or a panel.
    if (widget->layout()) gather(*widget->layout(), widgets);
  }
}

}  // namespace

void tabInOrder(QLayout& layout) {
  std::vector<QWidget*> widgets;
  gather(layout, widgets);
  for (std::size_t n = 1; n < widgets.size(); ++n) {
    QWidget::setTabOrder(widgets[n - 1], widgets[n]);
  }
}

}  // namespace trephine
