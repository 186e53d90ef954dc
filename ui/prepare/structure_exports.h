// Structures for other programs: DICOM, with the CT or for the one that they came from; a surface.
// Between the panel of structures, their editor and the workstation.
#pragma once

#include <QObject>
#include <filesystem>

#include "ui/structures/structure_panel.h"
#include "ui/work/work_guards.h"

namespace trephine {

class StructureExports : public QObject {
  Q_OBJECT
 public:
  // `storage`: the folder with the library's cases.
  StructureExports(Workstation& workstation, Messages& messages, WorkGuards& guards,
                   const std::filesystem::path& storage, StructurePanel& structures,
                   StructureEditor& editor);

  // The case was read by this window from DICOM, in the folder that was opened last; one of the
  // library's lies in a folder without it.
  bool sourceAtHand() const;

 private:
  void askToSaveDicom(bool for_source);
  void saveDicom(const std::filesystem::path& folder, bool for_source);
  void askToSaveSurface();

  Workstation& workstation_;
  Messages& messages_;
  WorkGuards& guards_;
  std::filesystem::path storage_;
  StructurePanel& structures_;
  StructureEditor& editor_;
};

}  // namespace trephine
