// The tissues of a set, one below the other: eye, colour, name, HU, opacity and how much of the
// case each has; presets of looks above it, one more or one less below it.
#pragma once

#include <QLabel>
#include <QListWidget>
#include <QToolButton>
#include <QWidget>
#include <vector>

#include "exercise/tissue_shares.h"
#include "tissue/tissue_look.h"
#include "ui/tissue/look_box.h"

namespace trephine {

class TissueList : public QWidget {
  Q_OBJECT
 public:
  explicit TissueList(QWidget* parent = nullptr);

  // Nothing is chosen by it but the row that was, or the nearest.
  void show(const TissueSet& tissues, const TissueLooks& looks);
  void setShares(const TissueShares& shares);
  void setLocked(bool locked);
  int current() const { return list_->currentRow(); }
  void select(int row) { list_->setCurrentRow(row); }
  const TissueLooks& looks() const { return looks_; }

 signals:
  void chosen();  // another row
  void looksChosen(const trephine::TissueLooks& looks);
  void addWanted();
  void removeWanted();

 private:
  QLayout* buildPresets();
  void addItem();
  void lookChosen(const TissueLooks& looks);
  void showItems();
  QString wordsOf(std::size_t tissue) const;

  TissueSet tissues_;
  TissueLooks looks_;
  TissueShares shares_;
  bool listing_ = false;
  QListWidget* list_;
  std::vector<LookBox*> look_boxes_;  // by row of the list
  QToolButton *add_, *remove_;
  QLabel* presets_title_;
  std::vector<std::pair<ViewPreset, QToolButton*>> presets_;
};

// A square of a tissue's colour, filled as far as it is opaque: 0 to 1, its frame alone where it is
// not drawn.
QIcon tissueSwatch(const QColor& colour, double share);

}  // namespace trephine
