// Text that comes from a file, a device or a person is shown as it is, never as markup: a label
// that took it for HTML would open files and forge headings.
#pragma once

#include <QObject>

namespace trephine {

// One rule for all labels of the program, those within Qt's own dialogs and tooltips as well: a
// label whose format nobody chose shows plain text, and none opens a link. A label that is to show
// markup says so with Qt::RichText, and whoever fills it escapes what is not its own
// (tests/system/check_outlets.py knows those places). Acts on every label as it is polished, which
// comes before it is measured or painted.
class PlainText : public QObject {
 public:
  // Once for the application, before its first widget is shown; again does nothing.
  static void rule();

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  using QObject::QObject;
};

// Broken into lines of at most so many characters where there are blanks: plain tooltips do not
// break by themselves.
QString inLines(const QString& text, int most = 80);

}  // namespace trephine
