// What comes and goes while structures are made: what is said, how far the work is, what was grown
// and is to be taken or left, and the box that growing keeps to. It has room of its own, so that no
// button moves under the pointer.
#pragma once

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QWidget>

#include "ui/structures/structure_editor.h"

namespace trephine {

class StructureNotices : public QWidget {
  Q_OBJECT
 public:
  // The editor outlives it.
  explicit StructureNotices(StructureEditor& editor, QWidget* parent = nullptr);

  // What was said last; nothing: what the tool in hand does.
  void say(const QString& words);
  void setHint(const QString& hint);

 signals:
  void decided();  // about a preview: the keys go back to the views

 private:
  QWidget* buildPreview();
  QWidget* buildProgress();
  QWidget* buildBoxLine();
  void showBox();
  void showState();

  StructureEditor& editor_;
  QLabel *said_, *preview_, *box_;
  QPushButton* take_;
  QProgressBar* progress_;
  QWidget *preview_box_, *progress_box_, *box_line_;
  QString hint_;
};

}  // namespace trephine
