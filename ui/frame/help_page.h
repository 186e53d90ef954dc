// The pages of help (resources/help/LANGUAGE), in a window of their own beside the one that they are
// of.
#pragma once

#include <QDialog>
#include <QTextBrowser>
#include <QWidget>

namespace trephine {

// Text whose pictures are no wider than it is.
class HelpText : public QTextBrowser {
  Q_OBJECT
 public:
  using QTextBrowser::QTextBrowser;

 protected:
  QVariant loadResource(int type, const QUrl& name) override;
  void resizeEvent(QResizeEvent* event) override;
};

class HelpPage : public QWidget {
  Q_OBJECT
 public:
  explicit HelpPage(QWidget* parent);

  // "first-cut"; in English where the language chosen has no such page.
  void open(const QString& page);

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  HelpText* text_;
};

// The one of `parent`, in front.
void showHelp(QWidget* parent, const QString& page);
// A dialog keeps the keys from the window that it is over: F1 in it opens this page.
void helpByF1(QDialog* dialog, const QString& page);

}  // namespace trephine
