#include "ui/prepare/structure_exports.h"

#include <QFileDialog>
#include <QMessageBox>

#include "imaging/dicom/seg_writer.h"
#include "imaging/source_uids.h"
#include "structures/surface.h"
#include "ui/common/question.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

// Letters that a file system could trip over become "_".
QString surfaceFileName(const std::string& structure) {
  QString name;
  for (const QChar c : toQt(structure))
    name += c.isLetterOrNumber() || c == QChar('-') ? c : QChar('_');
  return name + ".stl";
}

}  // namespace

StructureExports::StructureExports(Workstation& workstation, Messages& messages, WorkGuards& guards,
                                   const std::filesystem::path& storage, StructurePanel& structures,
                                   StructureEditor& editor)
    : workstation_(workstation),
      messages_(messages),
      guards_(guards),
      storage_(storage),
      structures_(structures),
      editor_(editor) {
  connect(&structures_, &StructurePanel::saveDicomWanted, this, [this] { askToSaveDicom(false); });
  connect(&structures_, &StructurePanel::saveForSourceWanted, this, [this] {
    ask(messages_.window(), "sourceUidsQuestion",
        tr("The file will name the UIDs of the patient's own CT, so that it finds the patient "
           "where "
           "the CT is kept."),
        tr("Give it only to whom the CT may be given. \"DICOM folder\" names nobody."),
        tr("&Choose a folder\u2026"), [this] { askToSaveDicom(true); });
  });
  connect(&structures_, &StructurePanel::saveSurfaceWanted, this,
          &StructureExports::askToSaveSurface);
}

bool StructureExports::sourceAtHand() const {
  const Case* of = workstation_.currentCase();
  const std::filesystem::path& source = guards_.caseSource();
  return of && of->provenance && !of->provenance->source_ids.series.empty() && !source.empty() &&
         source.parent_path() != storage_ / "cases";
}

void StructureExports::askToSaveDicom(bool for_source) {
  messages_.askForNewFolder(
      "dicomDialog", tr("Save the DICOM files as a new folder"), "structures-dicom",
      [this, for_source,
       volume = workstation_.currentCase()->volume](const std::filesystem::path& folder) {
        const Case* of = workstation_.currentCase();
        if (!of || of->volume != volume || !guards_.keepsTheCase(folder)) return;
        saveDicom(folder, for_source);
      });
}

void StructureExports::saveDicom(const std::filesystem::path& folder, bool for_source) {
  const Case* of = workstation_.currentCase();
  if (!of || !editor_.map() || (for_source && !sourceAtHand())) return;
  const std::shared_ptr<const LabelMap> map = editor_.finished();
  if (!map) return;
  auto notes = std::make_shared<std::vector<std::string>>();
  const std::optional<std::filesystem::path> source =
      for_source ? std::optional(guards_.caseSource()) : std::nullopt;
  workstation_.save(
      for_source ? tr("The structures are saved as DICOM that names the UIDs of the patient's CT.")
                 : tr("The structures are saved as DICOM, with the CT."),
      [map, notes, folder, source, ct = of->volume,
       provenance = of->provenance](const Progress& progress) -> Status {
        SegWriting writing;
        if (source) {
          auto uids = sourceUids(*source, *provenance, ct->geometry, Progress(progress, 0.0, 0.3));
          if (!uids) return uids.error();
          writing.source = *std::move(uids);
        }
        const auto written = writeStructuresAsDicom(*ct, *map, folder, writing,
                                                    Progress(progress, source ? 0.3 : 0.0, 1.0));
        if (!written) return written.error();
        *notes = written->notes;
        return {};
      },
      [this, notes] {
        QStringList words;
        for (const std::string& note : *notes) words << toQt(note);
        structures_.say(words.join('\n'));
      });
}

void StructureExports::askToSaveSurface() {
  const int label = editor_.current();
  const Structure* of = editor_.map() ? editor_.map()->find(label) : nullptr;
  if (!of) return;
  // As it is now: another case may come while the dialog stands.
  const std::shared_ptr<const LabelMap> copy = editor_.finished();
  if (!copy) return;
  QFileDialog* dialog = messages_.saveDialog(tr("Save the surface of \"%1\"").arg(toQt(of->name)),
                                             surfaceFileName(of->name), tr("Surface (*.stl)"));
  connect(dialog, &QFileDialog::fileSelected, this, [this, copy, label](const QString& file) {
    if (!guards_.keepsTheCase(toPath(file))) return;
    workstation_.save(tr("The surface is saved."),
                      [copy, label, path = toPath(file)](const Progress& progress) -> Status {
                        const auto written = writeSurface(*copy, label, path, progress);
                        if (!written) return written.error();
                        return {};
                      });
  });
  dialog->open();
}

}  // namespace trephine
