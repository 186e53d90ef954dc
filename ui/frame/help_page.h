// The pages of help (resources/help/LANGUAGE), in a window of their own beside the one that they are
// of.
#pragma once

#include <QTextBrowser>
#include <QWidget>

namespace trephine {

class HelpPage : public QWidget {
  Q_OBJECT
 public:
  explicit HelpPage(QWidget* parent);

  // "first-cut"; in English where the language chosen has no such page.
  void open(const QString& page);

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  QTextBrowser* text_;
};

}  // namespace trephine
