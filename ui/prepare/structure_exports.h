// Structures for other programs: DICOM, with the CT or for the one that they came from; a surface.
// Between the panel of structures, their editor and the workstation.
#pragma once

#include <QObject>
#include <filesystem>

#include "ui/structures/structure_panel.h"
#include "ui/work/app_context.h"

namespace trephine {

class StructureExports : public QObject {
  Q_OBJECT
 public:
  StructureExports(AppContext& app, StructurePanel& structures, StructureEditor& editor);

  // The case was read by this window from DICOM, in the folder that was opened last; one of the
  // library's lies in a folder without it.
  bool sourceAtHand() const;

 private:
  void askToSaveDicom(bool for_source);
  void saveDicom(const std::filesystem::path& folder, bool for_source);
  void askToSaveSurface();

  AppContext& app_;
  Workstation& workstation_;
  StructurePanel& structures_;
  StructureEditor& editor_;
};

}  // namespace trephine
