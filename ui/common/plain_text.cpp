#include "ui/common/plain_text.h"

#include <QCoreApplication>
#include <QEvent>
#include <QLabel>
#include <QStringList>

namespace trephine {

void PlainText::rule() {
  QCoreApplication* application = QCoreApplication::instance();
  constexpr const char* kName = "plainText";
  if (application->findChild<QObject*>(kName, Qt::FindDirectChildrenOnly)) return;
  auto* rule = new PlainText(application);
  rule->setObjectName(kName);
  application->installEventFilter(rule);
}

bool PlainText::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::Polish) return false;
  if (auto* label = qobject_cast<QLabel*>(watched)) {
    if (label->textFormat() == Qt::AutoText) label->setTextFormat(Qt::PlainText);
    label->setOpenExternalLinks(false);
  }
  return false;
}

QString inLines(const QString& text, int most) {
  QStringList lines;
  for (const QString& paragraph : text.split('\n')) {
    QString line;
    for (const QString& word : paragraph.split(' ')) {
      if (!line.isEmpty() && line.size() + 1 + word.size() > most) {
        lines << line;
        line = word;
      } else {
        line += (line.isEmpty() ? "" : " ") + word;
      }
    }
    lines << line;
  }
  return lines.join('\n');
}

}  // namespace trephine
