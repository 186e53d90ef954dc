// The structures of the case: what there is (structure_list.h); the tools that make and mend them,
// and what they say (structure_notices.h); the way in and out for those from elsewhere. The slices
// hold the tool that is chosen here.
#pragma once

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>
#include <algorithm>
#include <array>

#include "ui/common/number_field.h"
#include "ui/structures/structure_editor.h"
#include "ui/structures/structure_list.h"
#include "ui/structures/structure_notices.h"
#include "ui/views/view_tool.h"

namespace trephine {

class StructurePanel : public QWidget {
  Q_OBJECT
 public:
  // The editor outlives it.
  explicit StructurePanel(StructureEditor& editor, QWidget* parent = nullptr);

  // Whether the DICOM that the case came from is at hand, for a segmentation that refers to it.
  void setSourceAtHand(bool at_hand) { for_source_->setEnabled(at_hand); }
  // Names that the exercise needs and the case lacks come first among those that are offered.
  void setWanted(const std::vector<std::string>& names);
  // Those that are chosen here; and the one that the views have in hand, of these or another.
  const std::array<ViewTool*, 5>& tools() const { return tools_; }
  bool holds(const ViewTool& tool) const { return std::ranges::count(tools_, &tool) > 0; }
  void showTool(const ViewTool& tool);
  StructureList& list() { return *list_; }
  StructureNotices& notices() { return *notices_; }
  // What a click or a stroke of the chosen tool does.
  Brush brush(bool erase, int across) const;
  GrowOptions growing() const;
  QString name() const;  // of what is made next
  double brushRadius_mm() const { return radius_->wanted(); }
  void stepRadius(int steps);
  void makeSkin();  // as thick as is set
  void say(const QString& words) { notices_->say(words); }
  void suitVoxels(const Vec3& spacing_mm);  // what a step does nothing without
  void offerWanted();  // the first that the exercise lacks, as the next one's name

 signals:
  void toolChosen(trephine::ViewTool* tool);  // null: put down
  void brushChanged();
  void openWanted();
  void keepWanted();           // in the case, where that can be
  void saveWanted();           // as a label map
  void saveDicomWanted();      // with the CT, under new UIDs
  void saveForSourceWanted();  // as DICOM that refers to the CT's own files
  void saveSurfaceWanted();    // of the current one

 private:
  void build();
  QLayout* buildTools();
  QLayout* buildShaping();
  QMenu* buildSaving();
  void showOffered();
  void showState();
  void regrow();
  std::optional<HuSpan> onlyHu() const;
  QToolButton* button(const char* name, const QString& text, const QString& tip);

  StructureEditor& editor_;
  StructureList* list_;
  StructureNotices* notices_;
  QComboBox* name_;
  std::array<ViewTool*, 5> tools_;
  std::array<QToolButton*, 5> tool_buttons_;
  DecimalField *open_, *radius_, *smooth_, *shell_, *skin_;
  WholeNumberField *hu_low_, *hu_high_;
  QComboBox* shape_;
  QCheckBox* only_hu_;
  QToolButton *skull_button_, *skin_button_, *fill_, *smooth_button_, *shell_button_, *delete_,
      *undo_, *redo_;
  QPushButton *open_file_, *save_, *export_;
  QAction *surface_, *for_source_;
  std::vector<std::string> wanted_;
};

}  // namespace trephine
