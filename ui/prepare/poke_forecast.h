// What the exercise's tools would meet in each of its tissues, computed beside the window whenever
// tissues, tools or arms change and no exercise runs.
#pragma once

#include <QObject>
#include <QString>
#include <QTimer>
#include <vector>

#include "session/tissue_poke.h"
#include "ui/common/background_task.h"
#include "ui/tissue/poke_plot.h"
#include "ui/work/workstation.h"

namespace trephine {

class PokeForecast : public QObject {
  Q_OBJECT
 public:
  PokeForecast(Workstation& workstation, QObject* parent);

  // Anew, a moment after the last change; only while somebody looks.
  void setShown(bool shown);
  void renew();
  // Of the exercise as it was when they were computed; empty where there are none for this tissue.
  // Arms that meet the same are there once.
  std::vector<ForeseenPoke> of(std::size_t tissue) const;
  double friction_N() const;  // the greatest of the arms'
  // What the arms' own friction hides of it, in lines.
  QString hiddenWords(std::size_t tissue) const;

 signals:
  void changed();

 private:
  void compute();
  bool isLikeAnother(std::size_t arm) const;

  Workstation& workstation_;
  BackgroundTask task_;
  QTimer soon_;
  bool shown_ = false, stale_ = true;
  std::optional<Exercise> exercise_;  // of pokes_
  std::vector<ArmPokes> pokes_;
};

}  // namespace trephine
