// How the chosen structure looks in the 3-D view: shown, ghosted or hidden, and how opaque.
#pragma once

#include <QLabel>
#include <QSlider>
#include <QWidget>
#include <optional>

#include "exercise/structure_view.h"
#include "ui/tissue/look_box.h"

namespace trephine {

class StructureLookRow : public QWidget {
  Q_OBJECT
 public:
  explicit StructureLookRow(QWidget* parent = nullptr);
  // None: no structure is chosen.
  void show(const QString& name, const std::optional<SeenStructure>& seen);
  // One word.
  static QString wordOf(const SeenStructure& seen);
  static TissueLook after(TissueLook look);  // shown, ghosted, hidden, shown

 signals:
  // By a person.
  void lookChosen(trephine::TissueLook look);
  void opacityChosen(double per_mm);

 private:
  LookBox* look_;
  QSlider* opacity_;
  QLabel* number_;
};

}  // namespace trephine
