// Structures to and from other programs in the real window: what a person is asked of a file, and
// what "Export" offers. On the built-in abdomen, opened from DICOM. In order.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <QApplication>
#include <QComboBox>
#include <QFile>
#include <QFileDialog>
#include <QInputDialog>
#include <QListWidget>
#include <QMenu>
#include <QMessageBox>
#include <QPushButton>
#include <QRadioButton>
#include <QStatusBar>
#include <QTabWidget>
#include <QTimer>
#include <QTreeWidget>
#include <QtTest>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>

#include "gui_support.h"
#include "imaging/codes.h"
#include "imaging/dicom/seg_reader.h"
#include "imaging/dicom/seg_writer.h"
#include "ui/common/settings.h"
#include "ui/common/words.h"
#include "ui/structures/overlap_dialog.h"

using namespace trephine;

namespace {

// As 3D Slicer writes one: two layers, of which the second lies in the first.
void writeOverlapping(const GridGeometry& g, const LabelMap& liver,
                      const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  const auto vector = [](const Vec3& v) {
    return "(" + std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z) + ")";
  };
  out << "NRRD0004\ntype: unsigned char\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 "
      << g.size[0] << ' ' << g.size[1] << ' ' << g.size[2] << "\nspace directions: none";
  for (int axis = 0; axis < 3; ++axis) out << ' ' << vector(g.direction[axis] * g.spacing_mm[axis]);
  out << "\nkinds: list domain domain domain\nencoding: raw\nspace origin: " << vector(g.origin_mm)
      << '\n';
  for (int n = 0; n < 2; ++n) {
    const std::string segment = "Segment" + std::to_string(n);
    out << segment << "_ID:=S" << n << '\n'
        << segment << "_LabelValue:=1\n"
        << segment << "_Layer:=" << n << '\n'
        << segment << "_Name:=" << (n == 0 ? "liver" : "segment 4") << '\n';
  }
  out << '\n';
  std::string voxels;
  for (std::size_t v = 0; v < liver.labels.size(); ++v) {
    voxels += char(liver.labels[v] != 0);
    voxels += char(liver.labels[v] != 0 && v % 4 == 0);
  }
  out << voxels;
}

constexpr std::size_t kPixdim = 80, kSform = 280;  // of a NIfTI

void overwrite(const std::filesystem::path& file, std::size_t at, const auto& values) {
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(std::streamoff(at));
  bytes.write(reinterpret_cast<const char*>(values.data()), std::streamsize(sizeof values));
  QVERIFY(bytes.good());
}

// A NIfTI whose sform and qform put the structure so many slices above its place.
void writeNifti(const LabelMap& liver, std::optional<int> sform, std::optional<int> qform,
                const std::filesystem::path& file) {
  const GridGeometry& g = liver.geometry;
  QCOMPARE(g.direction, Mat3(1.0));
  std::string bytes(352, '\0');
  const auto put = [&bytes](std::size_t at, auto value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  };
  put(0, std::int32_t(348));
  put(40, std::int16_t(3));
  put(70, std::int16_t(2));  // 8 bits
  put(72, std::int16_t(8));
  put(76, 1.0f);
  for (int axis = 0; axis < 3; ++axis) {
    put(42 + 2 * std::size_t(axis), std::int16_t(g.size[std::size_t(axis)]));
    put(kPixdim + 4 * std::size_t(axis), float(g.spacing_mm[axis]));
  }
  put(108, 352.0f);
  put(252, std::int16_t(qform ? 1 : 0));
  put(254, std::int16_t(sform ? 1 : 0));
  put(264, 1.0f);  // turned about z by 180 degrees: from our axes to NIfTI's
  for (int axis = 0; axis < 3; ++axis) {
    const double sign = axis < 2 ? -1.0 : 1.0;
    const auto from = [&](int slices) {
      return float(sign * g.origin_mm[axis] + (axis == 2 ? slices * g.spacing_mm.z : 0.0));
    };
    put(268 + 4 * std::size_t(axis), from(qform.value_or(0)));
    put(kSform + 20 * std::size_t(axis), float(sign * g.spacing_mm[axis]));
    put(kSform + 12 + 16 * std::size_t(axis), from(sform.value_or(0)));
  }
  bytes.replace(344, 3, "n+1");
  bytes.append(liver.labels.begin(), liver.labels.end());
  std::ofstream(file, std::ios::binary) << bytes;
}

// The same file with shares instead of yes and no: every other frame has 0.4 of each voxel.
void makeFractional(const std::filesystem::path& from, const std::filesystem::path& to) {
  DcmFileFormat file;
  QVERIFY(file.loadFile(from.c_str()).good());
  DcmDataset& data = *file.getDataset();
  const Uint8* bits = nullptr;
  Sint32 frames = 0;
  Uint16 rows = 0, columns = 0;
  QVERIFY(data.findAndGetUint8Array(DCM_PixelData, bits).good());
  QVERIFY(data.findAndGetSint32(DCM_NumberOfFrames, frames).good());
  QVERIFY(data.findAndGetUint16(DCM_Rows, rows).good());
  QVERIFY(data.findAndGetUint16(DCM_Columns, columns).good());
  const std::size_t of_frame = std::size_t(rows) * columns;
  std::vector<Uint8> shares(of_frame * std::size_t(frames));
  for (std::size_t n = 0; n < shares.size(); ++n) {
    const bool set = bits[n / 8] >> n % 8 & 1;
    shares[n] = Uint8(!set ? 0 : n / of_frame % 2 ? 40 : 100);
  }
  if (shares.size() % 2) shares.push_back(0);
  data.putAndInsertString(DCM_SegmentationType, "FRACTIONAL");
  data.putAndInsertString(DCM_SegmentationFractionalType, "OCCUPANCY");
  data.putAndInsertUint16(DCM_MaximumFractionalValue, 100);
  data.putAndInsertUint16(DCM_BitsAllocated, 8);
  data.putAndInsertUint16(DCM_BitsStored, 8);
  data.putAndInsertUint16(DCM_HighBit, 7);
  data.putAndInsertUint8Array(DCM_PixelData, shares.data(), shares.size());
  QVERIFY(file.saveFile(to.c_str(), EXS_LittleEndianExplicit).good());
}

}  // namespace

class StructureFilesGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  std::filesystem::path source_;  // CT and structures.dcm
  LabelMap liver_;

  QTreeWidget* list() { return find<QTreeWidget>("structureList"); }
  double ml(const char* name) {
    for (int i = 0; i < list()->topLevelItemCount(); ++i) {
      if (list()->topLevelItem(i)->text(0) == name)
        return list()->topLevelItem(i)->text(1).toDouble();
    }
    return -1.0;
  }
  // Whether the case's structures are the liver alone, so many slices above its place.
  bool liesAbove(int slices) {
    const LabelMap& now = *workstation().currentCase()->structures;
    const std::size_t slice = std::size_t(liver_.geometry.size[0]) * std::size_t(liver_.geometry.size[1]);
    const std::size_t moved = slice * std::size_t(std::abs(slices));
    const std::size_t rest = liver_.labels.size() - moved;
    const std::size_t from = slices < 0 ? moved : 0, to = slices > 0 ? moved : 0;
    std::size_t other = 0;
    for (std::size_t v = 0; v < rest; ++v) {
      other += (now.labels[to + v] != 0) != (liver_.labels[from + v] != 0);
    }
    return other == 0 && std::ranges::count(liver_.labels, 1) > 1000;
  }
  template <class Dialog>
  Dialog* wait(const char* name) {
    (void)QTest::qWaitFor([&] { return window_->findChild<Dialog*>(name) != nullptr; }, kLong_ms);
    auto* dialog = window_->findChild<Dialog*>(name);
    if (!dialog) qFatal("no %s comes", name);
    return dialog;
  }
  // Chooses an entry of "Export" and a file or folder for it; the outcome in saved() or
  // failed().
  void choose(const char* entry) { find<QAction>(entry)->trigger(); }
  void give(const char* name, const QString& path) {
    auto* dialog = wait<QFileDialog>(name);
    emit dialog->fileSelected(path);
    dialog->close();
    rest();  // it goes away
  }
  bool saved(const char* dialog, const QString& path) {
    QSignalSpy done(&workstation(), &Workstation::saved);
    give(dialog, path);
    return done.count() == 1 || done.wait(kLong_ms);
  }

 private slots:
  void initTestCase() {
    GridGeometry g = *phantomGeometry("abdomen");
    for (std::size_t a = 0; a < 3; ++a) {
      g.size[a] /= 2;
      g.spacing_mm[int(a)] *= 2.0;
    }
    const Volume ct = makePhantomOn(*phantomTruth("abdomen"), g, kPhantomNoiseHu);
    liver_ = phantomLabelsOn(*phantomTruth("abdomen"), g);
    for (std::uint8_t& label : liver_.labels) label = label == 1;
    liver_.structures = {{1, "liver", Vec3(0.5, 0.2, 0.2)}};
    source_ = toPath(temporary_.filePath("source"));
    SegWriting scanner;  // UIDs come of what is written: the window's must be others
    scanner.text.series_description = "scanned";
    const auto written = writeStructuresAsDicom(ct, liver_, source_, scanner);
    QVERIFY2(written.ok(), written ? "" : written.error().sentence().c_str());
    openWindow("trephine-test-structure-files");
  }
  void cleanupTestCase() { closeWindow(); }

  void aCaseFromDicomHasItsSourceAtHand() {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPath(source_ / "CT");
    auto* import = find<QPushButton>("import");
    QTRY_VERIFY_WITH_TIMEOUT(import->isEnabled(), kLong_ms);
    import->click();
    QTRY_VERIFY_WITH_TIMEOUT(opened.count() == 1 || find<QPushButton>("openCase")->isVisible(),
                             kLong_ms);
    if (opened.isEmpty()) {
      for (QRadioButton* keep : window_->findChildren<QRadioButton*>()) {
        if (keep->objectName().endsWith("_keep") && keep->isVisible()) keep->click();
      }
      find<QPushButton>("openCase")->click();
      QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    }
    QVERIFY(find<QAction>("saveForSource")->isEnabled());
    showStructures();
    QVERIFY(!find<QPushButton>("saveStructures")->isEnabled());
  }

  void sharesOfVoxelsAskForTheirThresholdOnce() {
    const std::filesystem::path file = toPath(temporary_.filePath("shares.dcm"));
    makeFractional(source_ / "structures.dcm", file);
    QSignalSpy changed(&workstation(), &Workstation::structuresChanged);
    workstation().useLabels(file);
    auto* question = wait<QInputDialog>("thresholdQuestion");
    QCOMPARE(changed.count(), 0);
    QCOMPARE(question->doubleValue(), 0.5);
    question->accept();
    QVERIFY(changed.count() == 1 || changed.wait(kLong_ms));
    const double half = ml("liver");
    workstation().useLabels(file, {{code::kThreshold, "0.4"}});
    QVERIFY(changed.wait(kLong_ms));
    QVERIFY2(half > 0.4 * ml("liver") && half < 0.6 * ml("liver"),
             qPrintable(QString::number(half)));
  }

  void structuresThatOverlapAreAskedForTheirOrderOnce() {
    const std::filesystem::path file = toPath(temporary_.filePath("two.seg.nrrd"));
    writeOverlapping(liver_.geometry, liver_, file);
    QSignalSpy changed(&workstation(), &Workstation::structuresChanged);
    workstation().useLabels(file);
    auto* question = wait<OverlapDialog>("overlapQuestion");
    QCOMPARE(changed.count(), 0);
    QCOMPARE(question->order(), (std::vector<std::string>{"segment 4", "liver"}));
    QVERIFY(question->grab().save(QString(TREPHINE_ARTEFACTS "/overlap-order.png")));
    // By keys: down, up again by its button, and down.
    auto* order = question->findChild<QListWidget*>("overlapOrder");
    QVERIFY(QTest::qWaitForWindowActive(question));
    QTest::keyClick(order, Qt::Key_Down, Qt::ControlModifier);
    QCOMPARE(question->order(), (std::vector<std::string>{"liver", "segment 4"}));
    QVERIFY(!question->findChild<QPushButton*>("overlapDown")->isEnabled());
    question->findChild<QPushButton*>("overlapUp")->click();
    QCOMPARE(question->order(), (std::vector<std::string>{"segment 4", "liver"}));
    QTest::keyClick(order, Qt::Key_Down, Qt::ControlModifier);
    question->accept();
    QVERIFY(changed.count() == 1 || changed.wait(kLong_ms));
    QCOMPARE(workstation().currentCase()->structures->find("liver")->label,
             workstation().currentCase()->structures->labels[std::size_t(
                 std::ranges::find(liver_.labels, 1) - liver_.labels.begin())]);
    const double all = ml("liver");
    // The other way round the part has a quarter of it.
    workstation().useLabels(file, {{code::kOverlap, "order:segment 4"}});
    QVERIFY(changed.wait(kLong_ms));
    QVERIFY(std::abs(ml("segment 4") / all - 0.25) < 0.02);
    QTRY_VERIFY(!window_->findChild<OverlapDialog*>());
  }

  void savingIsReachedByKeys() {
    auto* save = find<QPushButton>("exportStructures");
    QTRY_VERIFY(save->isEnabled());
    QApplication::setActiveWindow(window_.get());
    save->setFocus();
    // The menu keeps the program until it is closed: its key comes once it is there.
    bool open = false;
    const auto press = [&] {
      auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
      if (!menu) return;
      open = true;
      QTest::keyClick(menu, Qt::Key_D);
    };
    connect(save->menu(), &QMenu::aboutToShow, this, [&] { QTimer::singleShot(0, this, press); });
    QTest::keyClick(save, Qt::Key_Space);
    disconnect(save->menu(), &QMenu::aboutToShow, this, nullptr);
    QVERIFY(open);
    wait<QFileDialog>("dicomDialog")->close();
    QTRY_VERIFY(!window_->findChild<QFileDialog*>("dicomDialog"));
  }

  void aDicomFolderHoldsTheCtAndTheStructuresUnderNewUids() {
    const QString folder = temporary_.filePath("dicom");
    choose("saveDicom");
    QVERIFY(saved("dicomDialog", folder));
    const auto seg = readDicomSegmentation(toPath(folder) / "structures.dcm");
    QVERIFY(seg.ok());
    QCOMPARE(seg->segmentation.segments.size(), std::size_t(2));
    QVERIFY(std::filesystem::is_directory(toPath(folder) / "CT"));
    QVERIFY(seg->of.study != workstation().currentCase()->provenance->source_ids.study);
    // Where something lies already nothing is written, and that is said.
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    choose("saveDicom");
    give("dicomDialog", folder);
    QVERIFY(failed.count() == 1 || failed.wait(kLong_ms));
    const auto error = failed.front().front().value<Error>();
    QCOMPARE(error.code.str(), std::string("CANNOT_WRITE"));
    QVERIFY2(error.what.find("already holds") != error.what.npos, error.what.c_str());
    for (QMessageBox* box : window_->findChildren<QMessageBox*>()) box->close();
  }

  void anExportIsACopyAndWhatTheCaseDoesNotHoldIsNamedBeforeItGoes() {
    QVERIFY(!workstation().currentCase()->stored.empty());
    window_->close();
    auto* question = wait<QMessageBox>("structuresUnsaved");
    QVERIFY2(question->text().contains("liver") && question->text().contains("segment 4"),
             qPrintable(question->text()));
    QVERIFY(question->findChild<QPushButton*>("saveInCaseFirst"));
    question->reject();
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("structuresUnsaved"));
    QVERIFY(window_->isVisible());
    // Another case is no way around it.
    prepareBuiltIn("cranium");
    wait<QMessageBox>("structuresUnsaved")->reject();
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("structuresUnsaved"));
    QVERIFY(!workstation().currentCase()->stored.empty());
    showStructures();
  }

  void forTheOriginalCtItNamesItsUidsOnceThatIsAgreed() {
    const QString folder = temporary_.filePath("original");
    choose("saveForSource");
    auto* question = wait<QMessageBox>("sourceUidsQuestion");
    QVERIFY2(question->text().contains("UIDs"), qPrintable(question->text()));
    for (QAbstractButton* button : question->buttons()) {
      if (question->buttonRole(button) == QMessageBox::DestructiveRole) button->click();
    }
    QVERIFY(saved("dicomDialog", folder));
    const auto seg = readDicomSegmentation(toPath(folder) / "structures.dcm");
    QVERIFY(seg.ok());
    QVERIFY(seg->of == workstation().currentCase()->provenance->source_ids);
    QVERIFY(!std::filesystem::exists(toPath(folder) / "CT"));
  }

  void aSurfaceIsThatOfTheChosenStructure() {
    list()->setCurrentItem(list()->topLevelItem(0));
    QVERIFY(find<QAction>("saveSurface")->isEnabled());
    const QString file = temporary_.filePath("liver.stl");
    choose("saveSurface");
    QVERIFY(saved("saveDialog", file));
    QFile stl(file);
    QVERIFY(stl.open(QIODevice::ReadOnly) && stl.size() > 84 + 50 * 1000);
    QCOMPARE((stl.size() - 84) % 50, qint64(0));
  }

  void aNiftiThatContradictsItselfIsTakenByTheFormThatIsChosen() {
    const std::filesystem::path file = toPath(temporary_.filePath("contradicts.nii"));
    writeNifti(liver_, 3, -3, file);
    QSignalSpy changed(&workstation(), &Workstation::structuresChanged);
    workstation().useLabels(file);
    auto* question = wait<QMessageBox>("structuresQuestion");
    QVERIFY2(question->text().contains("sform and qform"), qPrintable(question->text()));
    QVERIFY(question->grab().save(QString(TREPHINE_ARTEFACTS "/forms-differ.png")));
    QCOMPARE(changed.count(), 0);
    question->findChild<QPushButton*>("otherForm")->click();
    QVERIFY(changed.count() == 1 || changed.wait(kLong_ms));
    QVERIFY(liesAbove(-3));
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("structuresQuestion"));
    workstation().useLabels(file);
    wait<QMessageBox>("structuresQuestion")->findChild<QPushButton*>("goOnAnyway")->click();
    QVERIFY(changed.count() == 2 || changed.wait(kLong_ms));
    QVERIFY(liesAbove(3));
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("structuresQuestion"));
  }

  void aFormThatSaysNothingIsNoQuestion() {
    const std::filesystem::path file = toPath(temporary_.filePath("no-sform.nii"));
    writeNifti(liver_, 3, -3, file);
    overwrite(file, kSform, std::array<float, 12>{});
    QSignalSpy changed(&workstation(), &Workstation::structuresChanged);
    workstation().useLabels(file);
    QVERIFY(changed.count() == 1 || changed.wait(kLong_ms));
    QVERIFY(!window_->findChild<QMessageBox*>("structuresQuestion"));
    QVERIFY(liesAbove(-3));
  }

  void aFileThatSaysNoPlaceIsPutOnTheCtOnceThatIsAgreed() {
    const std::filesystem::path file = toPath(temporary_.filePath("no-place.nii"));
    writeNifti(liver_, 0, {}, file);
    overwrite(file, kPixdim, std::array{1.0f, 1.0f, 1.0f});
    overwrite(file, kSform, std::array{1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f,
                                       1.0f, 0.0f});
    QSignalSpy changed(&workstation(), &Workstation::structuresChanged);
    workstation().useLabels(file);
    auto* question = wait<QMessageBox>("structuresQuestion");
    QVERIFY2(question->text().contains("says nothing of where it lies: voxels of 1 mm"),
             qPrintable(question->text()));
    QVERIFY(question->grab().save(QString(TREPHINE_ARTEFACTS "/no-place.png")));
    question->button(QMessageBox::Cancel)->click();
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("structuresQuestion"));
    QCOMPARE(changed.count(), 0);
    workstation().useLabels(file);
    wait<QMessageBox>("structuresQuestion")->findChild<QPushButton*>("goOnAnyway")->click();
    QVERIFY(changed.count() == 1 || changed.wait(kLong_ms));
    QVERIFY(liesAbove(0));
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("structuresQuestion"));
  }

  void ourOwnExportIsListedAsStructuresAndComesWithItsCt() {
    workstation().openPath(source_);
    auto* series = find<QListWidget>("seriesList");
    QTRY_COMPARE_WITH_TIMEOUT(series->count(), 2, kLong_ms);
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("import")->isEnabled(), kLong_ms);
    bool listed = false;
    for (int row = 0; row < series->count(); ++row) {
      const QString said = series->item(row)->data(Qt::AccessibleTextRole).toString();
      QVERIFY2(!said.contains("Refused"), qPrintable(said));
      listed |= said.endsWith("Structures");
    }
    QVERIFY(listed);
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/own-export-listed.png")));
    QVERIFY2(find<QComboBox>("labelFile")->currentIndex() > 0, "of this CT alone: it comes along");
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    find<QPushButton>("import")->click();
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("openCase")->isVisible() ||
                                 window_->findChild<QMessageBox*>("structuresUnsaved") ||
                                 opened.count() == 1,
                             kLong_ms);
    if (find<QPushButton>("openCase")->isVisible()) {
      for (QRadioButton* keep : window_->findChildren<QRadioButton*>()) {
        if (keep->objectName().endsWith("_keep") && keep->isVisible()) keep->click();
      }
      find<QPushButton>("openCase")->click();
    }
    if (opened.isEmpty()) {  // what the case before lacks
      wait<QMessageBox>("structuresUnsaved")->findChild<QPushButton*>("goOnAnyway")->click();
      QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    }
    const Case& of = *workstation().currentCase();
    QVERIFY(of.structures && of.structures->find("liver"));
    QVERIFY2(of.structure_warnings.empty(),
             of.structure_warnings.empty() ? "" : of.structure_warnings[0].text.c_str());
  }

  void aBuiltInCaseHasNoSourceThatCouldBeNamed() {
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPhantom("abdomen");
    QVERIFY(opened.wait(kLong_ms));
    QVERIFY(!find<QAction>("saveForSource")->isEnabled());
  }

  void whatAnExerciseCutOfEachStructureIsSaidAtItsEnd() {
    const Exercise& exercise = *workstation().exercise();
    const auto script = readOperatorScript(exercise.operator_file, exercise);
    QVERIFY(script.ok());
    std::optional<std::vector<CutStructure>> ended;
    connect(&workstation(), &Workstation::sessionEnded, window_.get(),
            [&](Session& session) { ended = session.report().structures_cut; });
    constexpr double kWhole_s = 12.0;
    window_->startExercise(*script, kWhole_s);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().session(), kLong_ms);
    pass(kWhole_s);
    QTRY_VERIFY_WITH_TIMEOUT(ended, kLong_ms);
    const std::vector<CutStructure>& cut = *ended;
    QVERIFY(!linesOf(cut).empty());
    const QString line = toQt(linesOf(cut).front());
    QVERIFY2(find<QLabel>("structureSaid")->text().contains(line), qPrintable(line));
    QTRY_VERIFY(find<QWidget>("resultPage")->isVisible());
    const QString rows = find<QLabel>("resultRows")->text();
    QVERIFY2(rows.contains(toQt(cut.front().name), Qt::CaseInsensitive), qPrintable(rows));
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<StructureFilesGuiTest>(argc, argv);
}

#include "structure_files_gui_test.moc"
