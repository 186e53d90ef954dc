// An exercise is made in Prepare: tools, arms, what is felt, its card, its outline; it is saved,
// tried, exported and imported elsewhere. By the effect on exercise, disk and picture.
#include <QComboBox>
#include <QFileDialog>
#include <QListWidget>
#include <QMenu>
#include <QMessageBox>
#include <QPlainTextEdit>
#include <QRegularExpression>
#include <QScrollArea>
#include <QScrollBar>

#include "case/placement.h"
#include "exchange/exercise_folder.h"
#include "gui_support.h"
#include "library/case_library.h"
#include "session/arm_devices.h"
#include "tissue/tissue_edits.h"

namespace trephine {

namespace {
bool names(const std::vector<std::string>& list, const char* name) {
  return std::ranges::find(list, name) != list.end();
}
}  // namespace

class ExerciseGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  const Exercise& exercise() { return *workstation().exercise(); }
  void key(QWidget* widget, Qt::Key of, Qt::KeyboardModifiers with = {}) {
    QTest::keyClick(widget, of, with);
  }
  void showTab(int tab) {
    window_->show(Place::prepare);
    QApplication::setActiveWindow(window_.get());  // without a window manager it may not be
    find<QTabWidget>("prepareTabs")->setCurrentIndex(tab);
    rest();
  }
  // In the place of what a field has, and taken by Return.
  template <class Field>
  void typeInto(const char* name, const QString& text) {
    auto* field = find<Field>(name);
    field->setFocus();
    field->selectAll();
    QTest::keyClicks(field, text);
    key(field, Qt::Key_Return);
    rest();
  }
  void enter(const char* name, const QString& text) { typeInto<QAbstractSpinBox>(name, text); }
  void type(const char* name, const QString& text) { typeInto<QLineEdit>(name, text); }
  void typeText(const char* name, const QString& text) { typeInto<QPlainTextEdit>(name, text); }
  void write(const char* name, const QString& text) {
    auto* edit = find<QPlainTextEdit>(name);
    edit->setFocus();
    edit->selectAll();
    for (const QString& line : text.split('\n')) {
      QTest::keyClicks(edit, line);
      if (line != text.split('\n').back()) key(edit, Qt::Key_Return);
    }
    find<QPlainTextEdit>("card:goal")->setFocus();
  }
  // As a click in the opened list does.
  void choose(const char* name, const QVariant& data) {
    auto* box = find<QComboBox>(name);
    const int index = data.typeId() == QMetaType::QString && box->findData(data) < 0
                          ? box->findText(data.toString())
                          : box->findData(data);
    QVERIFY2(index >= 0, name);
    box->setCurrentIndex(index);
    QMetaObject::invokeMethod(box, "activated", Q_ARG(int, index));
    rest();
  }
  void tick(const char* list, const QString& text, bool on) {
    auto* items = find<QListWidget>(list);
    for (int i = 0; i < items->count(); ++i) {
      if (items->item(i)->text() != text) continue;
      return items->item(i)->setCheckState(on ? Qt::Checked : Qt::Unchecked);
    }
    QFAIL(list);
  }
  void undoAll() {
    for (int n = 0; n < 300 && workstation().edits().canUndo(); ++n) {
      workstation().undoEdit();
      rest();
    }
    untilPlaced();
  }
  void untilPlaced() {
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    rest();
  }
  void untilSaved() {
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isSaving(), kLong_ms);
    rest();
  }
  void closeDialogs() {
    for (QMessageBox* box : window_->findChildren<QMessageBox*>()) box->close();
  }
  // What a file dialog would have given.
  void give(const char* dialog, const QString& file) {
    auto* open = find<QFileDialog>(dialog);
    emit open->fileSelected(file);
    open->close();
  }
  void chooseElsewhere(const QString& entry) {
    auto* menu = find<QToolButton>("chooseElsewhere")->menu();
    emit menu->aboutToShow();
    for (QAction* action : menu->actions()) {
      if (action->text() == entry) return action->trigger();
    }
    QFAIL(qPrintable(entry));
  }
  SliceView& slice(SliceAxis axis) { return window_->views().slice(axis); }
  std::filesystem::path storage() { return toPath(temporary_.path()); }
  void keepGrab(const char* name) {
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/") + name));
  }

 private slots:
  void initTestCase() {
    openWindow("trephine-exercise-test");
    QApplication::setActiveWindow(window_.get());
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    // A case of the library.
    CaseLibrary library(storage());
    NewCase made;
    made.volume = std::make_shared<const Volume>(test::coarseCranium(4));
    made.region = BodyRegion::head;
    QVERIFY(library.save(made).ok());
    window_->show(Place::prepare);
    window_->show(Place::cases);
    auto* cards = find<QListWidget>("cases");
    QTRY_VERIFY_WITH_TIMEOUT(cards->count() >= 3, kLong_ms);
    for (int i = 0; i < cards->count(); ++i) {
      const QString id = cards->item(i)->data(Qt::UserRole).toString();
      if (id != "cranium" && id != "abdomen") cards->setCurrentRow(i);
    }
    QTest::mouseClick(find<QPushButton>("prepareCase"), Qt::LeftButton);
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QVERIFY(!workstation().currentCase()->stored.empty());
    window_->views().setLayout({ViewLayout::Kind::four, 0});
  }
  void cleanupTestCase() { closeWindow(); }
  void cleanup() {
    closeDialogs();
    if (workstation().phase() == Workstation::Phase::running) {
      workstation().stop();
      QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    }
    undoAll();
  }

  void aToolIsAddedDescribedAndTakenAway() {
    showTab(PrepareWorkspace::kToolTab);
    auto* menu = find<QToolButton>("addTool")->menu();
    emit menu->aboutToShow();
    for (QAction* action : menu->actions()) {
      if (action->text() == "needle") action->trigger();
    }
    const ExerciseTool* needle = exercise().findTool("needle");
    QVERIFY(needle);
    QCOMPARE(needle->tool.made_from.kind, ToolKind::needle);
    type("tool:id", "probe");
    QVERIFY(exercise().findTool("probe"));
    const auto made = [&] { return exercise().findTool("probe")->tool.made_from; };
    enter("tool:length_mm", "33");
    QCOMPARE(made().length_mm, 33.0);
    enter("tool:points", "5");
    QCOMPARE(made().points, 5);
    QCOMPARE(exercise().findTool("probe")->tool.points_m.size(), std::size_t(5));
    enter("tool:radius_mm", "0.8");
    QCOMPARE(made().radius_mm, 0.8);
    enter("tool:motor_W", "2");
    QCOMPARE(made().motor_W, 2.0);
    choose("tool:kind", QString("burr"));
    QCOMPARE(made().kind, ToolKind::burr);
    enter("tool:shaft_points", "3");
    QCOMPARE(made().shaft_points, 3);
    choose("tool:shape", QString("cylinder"));
    QCOMPARE(made().shape, BurrShape::cylinder);
    enter("tool:head_mm", "6");
    QCOMPARE(made().head_mm, 6.0);
    // A burr is at least its head: beside the field, and it stays as it was.
    enter("tool:length_mm", "2");
    QVERIFY(find<QLabel>("toolProblem")->isVisible());
    QCOMPARE(made().length_mm, 33.0);
    find<QToolButton>("chooseMesh")->click();
    const std::filesystem::path mesh = resourceFolder() / "tools" / "burr4.stl";
    give("meshDialog", toQt(mesh));
    QVERIFY(exercise().findTool("probe")->look.mesh == mesh);
    enter("tool:tip_mmX", "-2");
    QCOMPARE(exercise().findTool("probe")->look.tip_mm.x, -2.0);
    find<QToolButton>("noMesh")->click();
    QVERIFY(exercise().findTool("probe")->look.mesh.empty());
    find<QToolButton>("removeTool")->click();
    QVERIFY(!exercise().findTool("probe"));
    // One that an arm holds stays, and it is said.
    find<QListWidget>("toolList")->setCurrentRow(0);
    const std::size_t count = exercise().tools.size();
    find<QToolButton>("removeTool")->click();
    QCOMPARE(exercise().tools.size(), count);
    QVERIFY(find<QLabel>("toolProblem")->text().contains("arm has it"));
  }

  void anArmsToolsScalesAndForceReachTheExercise() {
    showTab(PrepareWorkspace::kToolTab);
    choose("arm:tool", QString("burr"));
    QCOMPARE(exercise().arms[0].tool, std::string("burr"));
    QVERIFY(names(exercise().arms[0].other_tools, "blade"));  // it stays at hand
    tick("arm:other_tools", "craniotome", false);
    QVERIFY(!names(exercise().arms[0].other_tools, "craniotome"));
    tick("arm:other_tools", "blade", false);
    QVERIFY(!names(exercise().arms[0].other_tools, "blade"));
    tick("arm:other_tools", "blade", true);
    QVERIFY(names(exercise().arms[0].other_tools, "blade"));
    enter("arm:motion_scale", "0.5");
    QCOMPARE(exercise().arms[0].map.motion_scale, 0.5);
    enter("arm:force_scale", "2");
    QCOMPARE(exercise().arms[0].map.force_scale, 2.0);
    enter("arm:offset_mmZ", "30");
    QCOMPARE(exercise().arms[0].map.offset_mm.z, 30.0);
    enter("arm:max_force_N", "1.5");
    QCOMPARE(exercise().arms[0].max_force_N, 1.5);
    // What the arms show of the tissues follows.
    QCOMPARE(*find<LimitBar>("frictionLimit")->limit(), 0.75);
    // What is asked for stays as it is asked for; what the device gives is said.
    enter("arm:max_force_N", "50");
    QCOMPARE(exercise().arms[0].max_force_N, 50.0);
    QCOMPARE(*find<LimitBar>("frictionLimit")->limit(), 1.65);
    const Json before = exerciseFile(exercise());
    find<QToolButton>("removeArm")->click();
    QCOMPARE(exercise().arms.size(), std::size_t(1));
    workstation().undoEdit();
    QCOMPARE(toQt(exerciseFile(exercise()).dump()), toQt(before.dump()));
    choose("armChoice", QString("right"));
    enter("arm:motion_scale", "0.8");
    QCOMPARE(exercise().arms[1].map.motion_scale, 0.8);
    QCOMPARE(exercise().arms[0].map.motion_scale, 0.5);
    choose("arm:landmark", QString("vault"));
    QCOMPARE(exercise().arms[1].map.landmark, std::string("vault"));
    enter("arm:force_scale", "500");
    QCOMPARE(exercise().arms[1].map.force_scale, 1.0);
    QVERIFY(find<QLabel>("arm:force_scaleRefused")->isVisible());
  }

  void armsAndLandmarksAreAddedNamedAndTakenAway() {
    showTab(PrepareWorkspace::kToolTab);
    choose("armChoice", QString("left"));
    type("arm:name", "first");
    QCOMPARE(exercise().arms[0].name, std::string("first"));
    find<QToolButton>("addArm")->click();
    QCOMPARE(exercise().arms.size(), std::size_t(3));
    QCOMPARE(exercise().arms[2].name, std::string("left"));
    QCOMPARE(workstation().rig().arms.size(), std::size_t(3));
    QCOMPARE(workstation().rig().arms[2].device.place, 2u);
    QVERIFY2(!find<QLabel>("armProblem")->isVisible(),
             qPrintable(find<QLabel>("armProblem")->text()));
    find<QToolButton>("removeArm")->click();
    QCOMPARE(exercise().arms.size(), std::size_t(2));

    showTab(PrepareWorkspace::kExerciseTab);
    find<QToolButton>("addLandmark")->click();
    QCOMPARE(exercise().landmarks.size(), std::size_t(2));
    untilPlaced();
    type("landmark:id", "side");
    QCOMPARE(exercise().landmarks[1].id, std::string("side"));
    untilPlaced();
    enter("landmark:towardsX", "0.3");
    QCOMPARE(exercise().landmarks[1].towards.x, 0.3);
    untilPlaced();
    choose("landmark", QString("vault"));
    find<QToolButton>("removeLandmark")->click();
    QCOMPARE(exercise().landmarks.size(), std::size_t(2));
    QVERIFY(find<QLabel>("placeProblem")->text().contains("vault"));  // arms are at it
    choose("landmark", QString("side"));
    find<QToolButton>("removeLandmark")->click();
    QCOMPARE(exercise().landmarks.size(), std::size_t(1));
    untilPlaced();
  }

  void theBoxOfAnArmIsDraggedInASliceAndIsOneStepBack() {
    showTab(PrepareWorkspace::kToolTab);
    choose("armChoice", QString("left"));
    const Vec3 before = exercise().arms[0].map.offset_mm;
    const auto centre = [&] {
      return withFixedMaps(exercise(), workstation().placed()->landmarks)
          .arms[0]
          .map.fixed->centre_mm;
    };
    SliceView& coronal = slice(SliceAxis::coronal);
    const Vec3 from_mm = centre();
    const QPointF from = coronal.fromPatient(from_mm);
    const QPoint by(25, 0);
    QTest::mousePress(&coronal, Qt::LeftButton, {}, from.toPoint());
    for (int n = 1; n <= 5; ++n) {
      moveTo(coronal, from.toPoint() + by * n / 5, Qt::LeftButton);
    }
    QTest::mouseRelease(&coronal, Qt::LeftButton, {}, from.toPoint() + by);
    const Vec3 moved = centre() - from_mm;
    const Vec3 expected = coronal.toPatient_mm(from + by) - coronal.toPatient_mm(from);
    QVERIFY2(glm::length(moved - expected) < 1.0, qPrintable(QString::number(moved.x)));
    QVERIFY(glm::length(exercise().arms[0].map.offset_mm - before) > 5.0);
    keepGrab("prepare-arms.png");
    // In a slice before the box its edges are dotted.
    const QColor colour = colours::ofArm(exercise().arms[0], 0);
    const auto solid = [&] {
      const QImage image = coronal.grab().toImage();
      int of_the_arm = 0;
      for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
          const QColor at = image.pixelColor(x, y);
          of_the_arm += std::abs(at.red() - colour.red()) < 30 &&
                        std::abs(at.green() - colour.green()) < 30 &&
                        std::abs(at.blue() - colour.blue()) < 30;
        }
      }
      return of_the_arm;
    };
    const int through = coronal.slice(), cut = solid();
    coronal.setSlice(0);
    const int beyond = solid();
    coronal.setSlice(through);
    QVERIFY2(cut > 100 && beyond < cut / 2,
             qPrintable(QString("%1 and %2 pixels").arg(cut).arg(beyond)));
    workstation().undoEdit();
    QVERIFY(exercise().arms[0].map.offset_mm == before);
    // By an edge of it as well.
    const WorkspaceMap map =
        *withFixedMaps(exercise(), workstation().placed()->landmarks).arms[0].map.fixed;
    const double half_mm = 500.0 * workstation().workspaces_mm()[0].z * 1e-3;
    const Vec3 edge_mm = map.centre_mm - map.rotation * Vec3(0.0, 0.0, half_mm);
    const QPoint at = coronal.fromPatient(edge_mm).toPoint();
    QTest::mousePress(&coronal, Qt::LeftButton, {}, at);
    moveTo(coronal, at + QPoint(12, 0), Qt::LeftButton);
    QTest::mouseRelease(&coronal, Qt::LeftButton, {}, at + QPoint(12, 0));
    QVERIFY(glm::length(exercise().arms[0].map.offset_mm - before) > 2.0);
  }

  void whatIsFeltIsChosenLawByLaw() {
    showTab(PrepareWorkspace::kToolTab);
    auto* rupture = find<QCheckBox>("scene:laws:rupture");
    QVERIFY(!rupture->isChecked());
    rupture->click();
    QVERIFY(names(exercise().laws, LawKind::rupture));
    for (const char* law : {"viscous", "coulomb", "elastic"}) {
      find<QCheckBox>(QString("scene:laws:") + law)->click();
    }
    QCOMPARE(exercise().laws, std::vector<LawKind>{LawKind::rupture});
    choose("scene:controller", QString("off"));
    QCOMPARE(exercise().controller, ControllerKind::off);
    QCOMPARE(workstation().controllerInForce(), ControllerKind::off);
    choose("scene:force_at", QString("tip"));
    QCOMPARE(exercise().force_at, ForceAt::tip);
    choose("scene:removal", QString("instant"));
    QCOMPARE(exercise().removal, RemovalKind::instant);
    enter("scene:rate_hz", "2000");
    QCOMPARE(exercise().rate_hz, 2000.0);
  }

  void whatIsTouchedByPointsIsShownOnlyWhereAnExerciseNamesIt() {
    showTab(PrepareWorkspace::kToolTab);
    auto* tissues = find<QListWidget>("scene:touch_by_points");
    QVERIFY(!tissues->isVisible());
    const Status named = workstation().edit("touch_by_points", [](Exercise& of) {
      of.laws = {LawKind::viscous};
      of.force_at = ForceAt::tip;
      of.removal = RemovalKind::instant;
      of.touch_by_points = {"bone"};
    });
    QVERIFY2(named.ok(), named ? "" : named.error().sentence().c_str());
    rest();
    QVERIFY(tissues->isVisible());
    tick("scene:touch_by_points", "Scalp", true);
    QVERIFY(names(exercise().touch_by_points, "scalp"));
    find<QCheckBox>("scene:laws:elastic")->click();
    QCOMPARE(exercise().laws, std::vector<LawKind>{LawKind::viscous});
    QVERIFY(find<QLabel>("lawProblem")->text().contains("touch_by_points"));
    tick("scene:touch_by_points", "Bone", false);
    tick("scene:touch_by_points", "Scalp", false);
    rest();
    QVERIFY(exercise().touch_by_points.empty());
    QVERIFY(!tissues->isVisible());
  }

  void anArmIsFixedInThePatientAndGoesBackToItsLandmark() {
    showTab(PrepareWorkspace::kToolTab);
    choose("armChoice", QString("left"));
    const auto& landmarks = workstation().placed()->landmarks;
    const auto centre = [&] {
      return withFixedMaps(exercise(), landmarks).arms[0].map.fixed->centre_mm;
    };
    const Vec3 before = centre();
    choose("arm:landmark", QString(""));
    QVERIFY(exercise().arms[0].map.fixed && exercise().arms[0].map.landmark.empty());
    QCOMPARE(glm::length(centre() - before) < 1e-9, true);
    enter("fixed:centre_mmX", "5");
    QCOMPARE(exercise().arms[0].map.fixed->centre_mm.x, 5.0);
    enter("fixed:motion_scale", "0.5");
    QCOMPARE(exercise().arms[0].map.fixed->motion_scale, 0.5);
    enter("fixed:force_scale", "2");
    QCOMPARE(exercise().arms[0].map.force_scale, 2.0);
    const Pose ahead{Vec3(0.0, 0.0, 0.01), Quat(1, 0, 0, 0)};
    const auto points = [&] {
      const WorkspaceMap& map = *exercise().arms[0].map.fixed;
      return glm::normalize(map.toPatient_mm(ahead).position - map.centre_mm);
    };
    for (const char* axis : {"X", "Y", "Z"}) {
      enter(("fixed:turned_deg" + std::string(axis)).c_str(), "0");
    }
    QVERIFY(glm::length(points() - Vec3(0, 0, 1)) < 1e-6);
    enter("fixed:turned_degX", "90");  // what was up is in front
    QVERIFY(glm::length(points() - Vec3(0, -1, 0)) < 1e-6);
    enter("fixed:turned_degZ", "90");
    QVERIFY(glm::length(points() - Vec3(1, 0, 0)) < 1e-6);
    const Vec3 moved = centre();
    choose("arm:landmark", QString("vault"));
    QVERIFY(!exercise().arms[0].map.fixed);
    QVERIFY(glm::length(centre() - moved) < 1e-6);
    QCOMPARE(exercise().arms[0].map.motion_scale, 0.5);
  }

  // What another part of the window has changed meanwhile stays.
  void aFormSendsItsOwnChangeAlone() {
    showTab(PrepareWorkspace::kToolTab);
    workstation().setController(ControllerKind::off);
    enter("arm:motion_scale", "0.5");
    QCOMPARE(exercise().arms[0].map.motion_scale, 0.5);
    QCOMPARE(exercise().controller, ControllerKind::off);
  }

  void whatIsNoScriptSetOrMeshIsSaidAndNotTaken() {
    const QString text = temporary_.filePath("shopping.json");
    QVERIFY(writeTextFile(toPath(text), "{\"milk\": 2}").ok());
    const Exercise before = exercise();
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    const auto refused = [&](int tab, const char* button, const char* dialog, const QString& file) {
      showTab(tab);
      if (std::string_view(button) == "chooseElsewhere") {
        chooseElsewhere("From a &file\u2026");
      } else {
        find<QToolButton>(button)->click();
      }
      give(dialog, file);
      QTRY_COMPARE(failed.count(), 1);
      failed.clear();
      closeDialogs();
    };
    refused(PrepareWorkspace::kExerciseTab, "chooseOperator", "operatorDialog", text);
    refused(PrepareWorkspace::kExerciseTab, "chooseElsewhere", "elsewhereDialog", text);
    find<QListWidget>("toolList")->setCurrentRow(0);
    refused(PrepareWorkspace::kToolTab, "chooseMesh", "meshDialog", text);
    QVERIFY(exercise() == before);
    // Each kind of file is asked for where it was last.
    const auto opensIn = [&](const char* button, const char* dialog) {
      find<QToolButton>(button)->click();
      auto* open = find<QFileDialog>(dialog);
      const QString folder = open->directory().absolutePath();
      open->close();
      rest();
      return folder;
    };
    find<QToolButton>("chooseMesh")->click();
    give("meshDialog", toQt(resourceFolder() / "tools" / "burr4.stl"));
    QCOMPARE(opensIn("chooseMesh", "meshDialog"), toQt(resourceFolder() / "tools"));
    showTab(PrepareWorkspace::kExerciseTab);
    QCOMPARE(opensIn("chooseOperator", "operatorDialog"), QFileInfo(text).absolutePath());
    showTab(PrepareWorkspace::kToolTab);
  }

  void costsAreMeasuredHereAndTradesStandBesideTheirSettings() {
    showTab(PrepareWorkspace::kToolTab);
    QVERIFY(find<QLabel>("scene:laws:elastic:note")->text().isEmpty());
    find<QToolButton>("measureCosts")->click();
    // A law that costs less than the machine scatters costs "under" that.
    const QRegularExpression figure("^(\\d+\\.\\d\\d \u00b5s a tick|under \\d+\\.\\d\\d \u00b5s)$");
    QTRY_VERIFY2_WITH_TIMEOUT(figure.match(find<QLabel>("scene:laws:elastic:note")->text()).hasMatch(),
                              qPrintable(find<QLabel>("scene:laws:elastic:note")->text()), kLong_ms);
    QVERIFY(find<QLabel>("scene:controller:note")->text().contains("\u00b5s a tick"));
    find<QListWidget>("toolList")->setCurrentRow(0);
    for (const char* trade : {"pointsTrade", "forceTrade", "rateTrade", "raysTrade"}) {
      QVERIFY2(find<QLabel>(trade)->text().contains("recommended"), trade);
    }
    QVERIFY(find<QLabel>("rateTrade")->text().contains("<b>1000</b>"));
    // As measured on this machine, once it is.
    TradesMeasurement here;
    here.rows = {{"rate_hz", "500", 7.0, "% of force", 0.1, "% of a CPU", "80 kHz", false, {}},
                 {"rate_hz", "1000", 3.0, "% of force", 0.2, "% of a CPU", "80 kHz", true, {}}};
    find<ToolsPanel>("toolsPanel")->setTrades(here.rows, "Measured on this machine.");
    QVERIFY(find<QLabel>("rateTrade")->text().contains("500"));
    enter("scene:rate_hz", "500");
    QVERIFY(find<QLabel>("rateTrade")->text().contains("<b>500</b>"));
  }

  void whatItIsWhereItEntersAndWhatStaysReachTheExercise() {
    showTab(PrepareWorkspace::kExerciseTab);
    type("scene:name", "A window of mine");
    QCOMPARE(exercise().name, std::string("A window of mine"));
    choose("scene:anatomy", QString("abdomen"));
    QCOMPARE(exercise().anatomy, std::string("abdomen"));
    choose("landmark:tissue", QString("scalp"));
    QCOMPARE(exercise().landmarks[0].tissue, std::string("scalp"));
    untilPlaced();
    enter("landmark:run_mm", "2");
    QCOMPARE(exercise().landmarks[0].run_mm, 2.0);
    untilPlaced();
    enter("landmark:fromX", "0.6");
    QCOMPARE(exercise().landmarks[0].from.x, 0.6);
    untilPlaced();
    choose("landmarkFound", QString("At the most of its tissue"));
    QCOMPARE(exercise().landmarks[0].bulk_radius_mm, 20.0);
    untilPlaced();
    enter("landmark:bulk_radius_mm", "12");
    QCOMPARE(exercise().landmarks[0].bulk_radius_mm, 12.0);
    untilPlaced();
    choose("landmarkFound", QString("By a ray"));
    QCOMPARE(exercise().landmarks[0].bulk_radius_mm, 0.0);
    QCOMPARE(exercise().landmarks[0].from.x, 0.6);
    untilPlaced();
    choose("view:landmark", QString(""));
    QVERIFY(exercise().view.landmark.empty());
    enter("view:distance_mm", "200");
    QCOMPARE(exercise().view.distance_mm, 200.0);
    workstation().setLooks({{"bone", TissueLook::ghosted}});
    find<QToolButton>("keepLooks")->click();
    QCOMPARE(exercise().view.looks.at("bone"), TissueLook::ghosted);
    find<QToolButton>("noOperator")->click();
    QVERIFY(exercise().operator_file.empty());
    find<QToolButton>("chooseOperator")->click();
    const auto script = resourceFolder() / "operators" / "burr-hole.json";
    give("operatorDialog", toQt(script));
    QCOMPARE(exercise().operator_file, script.string());
    find<QToolButton>("placeEntry")->click();
    QVERIFY(inHand("sliceEntryTool"));
    window_->show(Place::train);
    QVERIFY(!inHand("sliceEntryTool"));  // the next Esc is of the exercise
    window_->show(Place::prepare);
    find<QToolButton>("placeEntry")->click();
    QTest::mouseClick(&window_->view(), Qt::LeftButton, {}, window_->view().rect().center());
    untilPlaced();
    QVERIFY(workstation().entry());
    QVERIFY(inHand("sliceWindowTool"));  // the next click turns the view
    undoAll();
    // A second landmark gets the place that is clicked for it, and the first keeps its own.
    find<QToolButton>("addLandmark")->click();
    untilPlaced();
    QCOMPARE(exercise().landmarks.size(), std::size_t(2));
    find<QToolButton>("placeEntry")->click();
    QTest::mouseClick(&window_->view(), Qt::LeftButton, {}, window_->view().rect().center());
    untilPlaced();
    QVERIFY(exercise().landmarks[1].is_place);
    QVERIFY(!exercise().landmarks[0].is_place);
    undoAll();
    // Locks hold at once, so the last.
    for (const char* lock : {"controller", "rate"}) {
      QVERIFY(!find<QCheckBox>(QString("scene:locks:") + lock)->isChecked());
    }
  }

  void theCaseAndTheSetForOtherCasesStandInTheForm() {
    showTab(PrepareWorkspace::kExerciseTab);
    QVERIFY(find<QLabel>("exerciseCase")->text().contains("no structures"));
    QVERIFY(!exercise().tissues_elsewhere);
    const auto sets = resourceFolder() / "tissues";
    const QString cranium = shownName(readTissueSet(sets / "cranium.json")->name);
    chooseElsewhere(cranium);
    QVERIFY(exercise().tissues_elsewhere);
    QVERIFY(workstation().exerciseEdited());
    QCOMPARE(find<QLabel>("elsewhereSet")->text(), toQt(exercise().tissues_elsewhere->name));
    // It lacks the tissue of the landmark: beside the field, and what was there stays.
    TissueSet without = *readTissueSet(sets / "cranium.json");
    const std::string lacking = exercise().landmarks[0].tissue;
    for (Tissue& tissue : without.tissues) {
      if (tissue.id == lacking) tissue.id = "stone";
      if (tissue.within == lacking) tissue.within = "stone";
    }
    const QString file = temporary_.filePath("without.json");
    QVERIFY(writeTextFile(toPath(file), toJson(without).dump()).ok());
    chooseElsewhere("From a &file\u2026");
    give("elsewhereDialog", file);
    QVERIFY(find<QLabel>("whatProblem")->text().contains("set for other cases"));
    QCOMPARE(exercise().tissues_elsewhere->name, readTissueSet(sets / "cranium.json")->name);
    // It is still there once the case has been placed anew, and after a save.
    enter("landmark:run_mm", "2");
    untilPlaced();
    QVERIFY(exercise().tissues_elsewhere);
    find<QToolButton>("noElsewhere")->click();
    QVERIFY(!exercise().tissues_elsewhere);
    // Structures of a file.
    find<QToolButton>("chooseLabels")->click();
    QVERIFY(find<QFileDialog>("labelsDialog")->isVisible());
    find<QFileDialog>("labelsDialog")->close();
  }

  // Faster than the case can be placed, but for a rest now and then.
  void aStormOfEditsOfAPlaceIsNeverRefused() {
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    for (int n = 1; n <= 30; ++n) {
      Exercise moved = exercise();
      moved.landmarks[0].from.x = 0.4 + 0.005 * n;
      QVERIFY(workstation().edit(moved, "landmark").ok());
      workstation().closeEdit();
      turns(n % 5);
      if (n % 10 == 0) untilPlaced();
    }
    for (int n = 1; n <= 30; ++n) {
      workstation().undoEdit();
      turns(n % 7);
    }
    untilPlaced();
    QCOMPARE(failed.count(), 0);
    QVERIFY(!workstation().edits().canUndo());
  }

  void whatIsTypedIsNotLostWhenTheWindowCloses() {
    showTab(PrepareWorkspace::kExerciseTab);
    auto* goal = find<QPlainTextEdit>("card:goal");
    goal->setFocus();
    goal->selectAll();
    QTest::keyClicks(goal, "Half a sentence");
    QVERIFY(exercise().card->en.goal != "Half a sentence");
    window_->close();
    QCOMPARE(exercise().card->en.goal, std::string("Half a sentence"));
    QTRY_VERIFY(window_->findChild<QMessageBox*>("unsavedTissues"));
    find<QMessageBox>("unsavedTissues")->button(QMessageBox::Cancel)->click();
    QVERIFY(window_->isVisible());
    QVERIFY(find<QAction>("undo")->toolTip().contains("the card"));
  }

  void nothingOfTheFormLiesBesideItsPanel() {
    showTab(PrepareWorkspace::kExerciseTab);
    const auto* area = find<QScrollArea>("exercisePage");
    QString widest;
    for (const QWidget* of : area->widget()->findChildren<QWidget*>()) {
      const int right = of->mapTo(area->widget(), QPoint(of->width(), 0)).x();
      if (of->isVisible() && right > area->viewport()->width()) {
        widest += of->objectName() + ' ' + of->metaObject()->className() + ' ' +
                  QString::number(of->minimumSizeHint().width()) + '\n';
      }
    }
    QVERIFY2(area->horizontalScrollBar()->maximum() == 0, qPrintable(widest));
  }

  void theCardIsWrittenInBothLanguagesAndKeepsItsLimits() {
    showTab(PrepareWorkspace::kExerciseTab);
    typeText("card:goal", "Cut it out");
    QVERIFY(find<QLabel>("chineseOld")->isVisible());
    QCOMPARE(exercise().card->en.goal, std::string("Cut it out"));
    write("card:steps", "Do this\nThen that");
    QCOMPARE(exercise().card->en.steps, (std::vector<std::string>{"Do this", "Then that"}));
    typeText("card:hands", "Both");
    QCOMPARE(exercise().card->en.hands, std::string("Both"));
    auto* chinese = find<QPlainTextEdit>("cardChinese:goal");
    chinese->setFocus();
    chinese->selectAll();
    chinese->insertPlainText(QString::fromUtf8("切開"));
    key(chinese, Qt::Key_Return);
    QCOMPARE(exercise().card->zh_TW->goal, std::string("切開"));
    QVERIFY(!find<QLabel>("chineseOld")->isVisible());
    auto* goal = find<QPlainTextEdit>("card:goal");
    goal->setFocus();
    goal->selectAll();
    goal->insertPlainText(QString(500, 'x'));
    key(goal, Qt::Key_Return);
    QVERIFY(find<QLabel>("cardProblem")->text().contains("500"));
    QCOMPARE(exercise().card->en.goal, std::string("Cut it out"));
    // It stays to be mended, whatever else is edited meanwhile, and says so.
    typeText("card:hands", "One");
    QCOMPARE(exercise().card->en.hands, std::string("One"));
    QCOMPARE(goal->toPlainText().size(), 500);
    QVERIFY(find<QLabel>("card:goalNotApplied")->isVisible());
    window_->close();  // and is asked about before it goes
    QTRY_VERIFY(window_->findChild<QMessageBox*>("textNotApplied"));
    find<QMessageBox>("textNotApplied")->button(QMessageBox::Cancel)->click();
    QVERIFY(window_->isVisible());
    QCOMPARE(goal->toPlainText().size(), 500);
    window_->close();  // who stays after all has lost nothing
    QTRY_VERIFY(window_->findChild<QMessageBox*>("textNotApplied"));
    find<QMessageBox>("textNotApplied")->findChild<QPushButton*>("goOnAnyway")->click();
    QTRY_VERIFY(window_->findChild<QMessageBox*>("unsavedTissues"));
    find<QMessageBox>("unsavedTissues")->button(QMessageBox::Cancel)->click();
    QTRY_VERIFY(!window_->findChild<QMessageBox*>("unsavedTissues"));
    QCOMPARE(goal->toPlainText().size(), 500);
    // What it was before is no refused text.
    goal->setFocus();
    goal->selectAll();
    goal->insertPlainText("Cut it out");
    key(goal, Qt::Key_Return);
    QVERIFY(!find<QLabel>("card:goalNotApplied")->isVisible());
    typeText("card:goal", "Cut it out at once");
    QCOMPARE(exercise().card->en.goal, std::string("Cut it out at once"));
    QVERIFY(!find<QLabel>("card:goalNotApplied")->isVisible());
    // A text that is being typed is taken where one goes elsewhere by keys.
    QApplication::setActiveWindow(window_.get());
    goal->setFocus();
    QTRY_VERIFY(goal->hasFocus());
    goal->selectAll();
    goal->insertPlainText("Cut it out");
    window_->show(Place::train);
    QCOMPARE(exercise().card->en.goal, std::string("Cut it out"));
    window_->show(Place::prepare);
    QVERIFY(!find<QLabel>("card:goalNotApplied")->isVisible());
    find<QCheckBox>("cardChineseOn")->click();
    QVERIFY(!exercise().card->zh_TW);
    find<QCheckBox>("cardChineseOn")->click();  // nothing of it was lost
    QCOMPARE(exercise().card->zh_TW->goal, std::string("切開"));
    find<QCheckBox>("cardChineseOn")->click();
    find<QCheckBox>("cardOn")->click();
    QVERIFY(!exercise().card);
  }

  void anOutlineIsDrawnByClicksOnTheSurface() {
    showTab(PrepareWorkspace::kExerciseTab);
    find<QToolButton>("clearOutline")->click();
    QVERIFY(!exercise().outline);
    ViewWidget& view = window_->view();
    restRefined();
    const QImage before = view.grabFramebuffer();
    find<QToolButton>("drawOutline")->click();
    QVERIFY(inHand("outlineTool"));
    const QPoint middle = view.rect().center();
    for (const QPoint& by : {QPoint(-30, -20), QPoint(30, -20), QPoint(30, 20), QPoint(-30, 20)}) {
      QTest::mouseClick(&view, Qt::LeftButton, {}, middle + by);
      rest();
    }
    QVERIFY(exercise().outline);
    QCOMPARE(exercise().outline->points_mm.size(), std::size_t(4));
    QCOMPARE(exercise().outline->frame->landmark, std::string("vault"));
    const auto seen = view.pickAt(middle + QPoint(30, 20));
    QVERIFY(seen && glm::length(seen->at_mm - exercise().outline->points_mm[2]) < 3.0);
    // What was cleared was closed, and so is what is drawn anew.
    QVERIFY(exercise().outline->closed);
    QVERIFY(find<QCheckBox>("outline:closed")->isChecked());
    enter("outline:width_mm", "2.5");
    QCOMPARE(exercise().outline->width_mm, 2.5);
    restRefined();
    keepGrab("prepare-outline.png");
    const QImage with = view.grabFramebuffer();
    QCOMPARE(with.size(), before.size());
    int changed = 0;
    for (int y = 0; y < with.height(); ++y) {
      for (int x = 0; x < with.width(); ++x) {
        changed += qAbs(qGray(with.pixel(x, y)) - qGray(before.pixel(x, y))) > 24;
      }
    }
    QVERIFY2(changed > 150, qPrintable(QString::number(changed)));
    // A point by itself, and the landmark that all go with.
    find<QSpinBox>("outlinePoint")->setValue(2);
    const auto points = exercise().outline->points_mm;
    auto* z = find<QDoubleSpinBox>("outlinePoint:at_mmZ");
    QVERIFY(std::abs(z->value() - points[1].z) < 0.06);
    z->setValue(points[1].z + 4.0);
    QVERIFY(std::abs(exercise().outline->points_mm[1].z - points[1].z - 4.0) < 0.06);
    QCOMPARE(exercise().outline->points_mm[0], points[0]);
    choose("outlineLandmark", QString(""));
    QVERIFY(exercise().outline && !exercise().outline->frame);
    choose("outlineLandmark", QString("vault"));
    QCOMPARE(exercise().outline->frame->landmark, std::string("vault"));
    const Vec3 at_mm = exercise().outline->frame->at.position_mm;
    choose("outlineLandmark", QString("vault"));  // once more: nothing changes
    QCOMPARE(exercise().outline->frame->landmark, std::string("vault"));
    QCOMPARE(exercise().outline->frame->at.position_mm, at_mm);
    find<QSpinBox>("outlinePoint")->setValue(1);
    auto* number = find<QSpinBox>("outlinePoint");
    number->setFocus();
    number->selectAll();
    QTest::keyClicks(number, "2");  // as a click leaves it
    find<QToolButton>("outlinePointOff")->click();
    QCOMPARE(exercise().outline->points_mm.size(), std::size_t(3));
    QVERIFY(glm::length(exercise().outline->points_mm[1] - points[2]) < 1e-6);
    find<QToolButton>("outlineBack")->click();
    QCOMPARE(exercise().outline->points_mm.size(), std::size_t(2));
    key(&slice(SliceAxis::axial), Qt::Key_Escape);
    QVERIFY(inHand("sliceWindowTool"));
    QVERIFY(!find<QToolButton>("drawOutline")->isChecked());
  }

  // Saved, tried, started again, exported, imported into another storage folder.
  void anExerciseIsSavedTriedExportedAndImportedElsewhere() {
    showTissues();
    window_->findChild<TissuePanel*>()->select("bone");
    enter("stiffness", "555");
    showTab(PrepareWorkspace::kToolTab);
    enter("arm:motion_scale", "0.5");
    showTab(PrepareWorkspace::kExerciseTab);
    type("scene:name", "Mine");
    find<QPushButton>("saveExercise")->click();
    untilSaved();
    const std::filesystem::path file = storage() / "exercises" / "mine" / "scene.json";
    QVERIFY(workstation().exerciseFile() == file);
    QVERIFY(!workstation().exerciseEdited() && !workstation().tissuesEdited());
    QVERIFY(find<QLabel>("exerciseSaved")->text().contains("Saved"));
    QVERIFY(find<QComboBox>("scenes")->findText("Mine") >= 0);
    const Exercise saved = *readExercise(file);
    QCOMPARE(saved.tissues.find("bone")->stiffness_N_per_m.value, 555.0);
    QCOMPARE(saved.arms[0].map.motion_scale, 0.5);
    QVERIFY(saved.case_source.find(workstation().currentCase()->stored) != std::string::npos);
    // Changed, it is said, and asked before it is lost.
    enter("view:distance_mm", "222");
    QVERIFY(find<QLabel>("exerciseSaved")->text().contains("Changed"));
    find<QPushButton>("saveExercise")->click();
    untilSaved();
    QCOMPARE(readExercise(file)->view.distance_mm, 222.0);
    QCOMPARE(exercisesIn(storage()).size(), std::size_t(1));
    // Tried, and back.
    find<QPushButton>("tryExercise")->click();
    QCOMPARE(window_->place(), Place::train);
    find<QAction>("start")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::running, kLong_ms);
    QCOMPARE(workstation().session()->exercise().arms[0].map.motion_scale, 0.5);
    QTest::mouseClick(find<QPushButton>("backToPrepare"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    QCOMPARE(window_->place(), Place::prepare);
    // Of a trial no cut stays in the view.
    QVERIFY(!window_->findChild<CaseViews*>()->carved());
    QVERIFY(!workstation().carved());
    // Out, and in again elsewhere.
    find<QPushButton>("exportExercise")->click();
    const QString folder = temporary_.filePath("stick/mine");
    give("exportExerciseDialog", folder);
    untilSaved();
    QVERIFY(QFile::exists(folder + "/exercise.json"));
    const auto check = checkExercise(toPath(folder));
    QVERIFY(check.ok() && check->verified());
    QTemporaryDir other;
    const auto elsewhere = newWindow(toPath(other.path()) / "recordings");
    MainWindow& another = *elsewhere;
    another.resize(1280, 800);
    another.QMainWindow::show();
    another.show(Place::prepare);
    another.findChild<QTabWidget*>("prepareTabs")->setCurrentIndex(PrepareWorkspace::kExerciseTab);
    QSignalSpy opened(&another.workstation(), &Workstation::caseOpened);
    another.findChild<QPushButton*>("importExercise")->click();
    auto* dialog = another.findChild<QFileDialog*>("importExerciseDialog");
    QVERIFY(dialog);
    emit dialog->fileSelected(folder);
    dialog->close();
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QVERIFY(another.workstation().exercise()->name == "Mine");
    QCOMPARE(another.workstation().currentCase()->sha256, workstation().currentCase()->sha256);
    Exercise here = exercise(), there = *another.workstation().exercise();
    QCOMPARE(QString::fromStdString(toJson(there).dump()),
             QString::fromStdString(toJson(here).dump()));
    // It is one of the cases there, from which it is opened again.
    another.show(Place::cases);
    auto* cards = another.findChild<QListWidget*>("cases");
    const auto cardOfMine = [&] {
      const auto found = cards->findItems("Mine", Qt::MatchStartsWith);
      return found.isEmpty() ? nullptr : found.front();
    };
    QTRY_VERIFY_WITH_TIMEOUT(cardOfMine(), kLong_ms);
    cards->setCurrentItem(cardOfMine());
    QVERIFY(!another.findChild<QPushButton*>("deleteCase")->isVisible());
    QVERIFY(another.grab().save(QString(TREPHINE_ARTEFACTS "/received-exercise.png")));
    another.findChild<QPushButton*>("trainOnCase")->click();
    QVERIFY2(another.place() == Place::train, "at once, and not once it is open");
    QVERIFY(opened.count() == 2 || opened.wait(kLong_ms));
    QVERIFY(another.workstation().exercise()->name == "Mine");
    QCOMPARE(another.place(), Place::train);
    // It is changed and saved there, with the case that it came with.
    another.show(Place::prepare);
    another.findChild<QTabWidget*>("prepareTabs")->setCurrentIndex(PrepareWorkspace::kExerciseTab);
    const std::filesystem::path received = another.workstation().exerciseFile();
    QVERIFY(another.workstation().edit("name", [](Exercise& of) { of.name = "Mine too"; }).ok());
    another.findChild<QPushButton*>("saveExercise")->click();
    QTRY_VERIFY_WITH_TIMEOUT(!another.workstation().exerciseEdited(), kLong_ms);
    const auto as_saved = readExercise(received);
    QVERIFY(as_saved.ok());
    QCOMPARE(as_saved->name, std::string("Mine too"));
    QVERIFY(readCase(as_saved->case_source).ok());
  }

  void openExerciseTakesWhatWasExported() {
    const QString folder = temporary_.filePath("stick/mine");
    for (const char* chosen : {"exercise.json", "scene.json", ""}) {
      QTemporaryDir other;
      const auto elsewhere = newWindow(toPath(other.path()) / "recordings");
      elsewhere->resize(1280, 800);
      elsewhere->QMainWindow::show();
      QSignalSpy opened(&elsewhere->workstation(), &Workstation::caseOpened);
      elsewhere->open(toPath(folder) / chosen);
      QVERIFY2(opened.count() == 1 || opened.wait(kLong_ms), chosen);
      QCOMPARE(elsewhere->workstation().exercise()->name, std::string("Mine"));
      QCOMPARE(exercisesIn(toPath(other.path())).size(), std::size_t(1));
      QCOMPARE(elsewhere->place(), Place::train);
    }
  }

  void anExerciseThatWasChangedOnItsWayIsNamedPartByPart() {
    showTab(PrepareWorkspace::kExerciseTab);
    type("scene:name", "Changed");
    find<QPushButton>("saveExercise")->click();
    untilSaved();
    find<QPushButton>("exportExercise")->click();
    const QString folder = temporary_.filePath("stick/changed");
    give("exportExerciseDialog", folder);
    untilSaved();
    QVERIFY(QFile::remove(folder + "/operator.json"));
    QFile script(folder + "/scene.json");
    QVERIFY(script.open(QIODevice::Append));
    script.write(" ");
    script.close();
    const std::size_t before = exercisesIn(storage()).size();
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    find<QPushButton>("importExercise")->click();
    give("importExerciseDialog", folder);
    QTRY_COMPARE_WITH_TIMEOUT(failed.count(), 1, kLong_ms);
    const Error error = failed[0][0].value<Error>();
    QVERIFY2(error.what.find("missing: operator.json") != std::string::npos, error.what.c_str());
    QVERIFY2(error.what.find("changed: scene.json") != std::string::npos, error.what.c_str());
    QCOMPARE(exercisesIn(storage()).size(), before);
  }

  void anExerciseThatAnotherProgramHasChangedIsAskedAboutBeforeItIsReplaced() {
    showTab(PrepareWorkspace::kExerciseTab);
    const std::filesystem::path file = workstation().exerciseFile();
    Json other = *readJsonFile(file);
    other["name"] = "Of somebody else";
    QVERIFY(writeTextFile(file, other.dump(1) + '\n').ok());
    const std::size_t before = exercisesIn(storage()).size();
    enter("view:distance_mm", "244");
    find<QPushButton>("saveExercise")->click();
    QTRY_VERIFY(window_->findChild<QMessageBox*>("changedOnDisk"));
    QCOMPARE(readExercise(file)->name, std::string("Of somebody else"));
    QTest::mouseClick(find<QPushButton>("saveBeside"), Qt::LeftButton);
    QTRY_COMPARE(exercisesIn(storage()).size(), before + 1);
    untilSaved();
    QVERIFY(workstation().exerciseFile() != file);
    QCOMPARE(readExercise(file)->name, std::string("Of somebody else"));
    QCOMPARE(readExercise(workstation().exerciseFile())->view.distance_mm, 244.0);
  }

  void ofTwoOfOneNameEachCanBeToldAndOneThatCannotBeReadIsListed() {
    const std::filesystem::path exercises = storage() / "exercises";
    const auto all = std::filesystem::copy_options::recursive;
    std::filesystem::copy(exercises / "mine", exercises / "mine-77", all);
    std::filesystem::create_directories(exercises / "torn");
    QVERIFY(writeTextFile(exercises / "torn" / "scene.json", "{\"format\"").ok());
    window_->findChild<AppContext*>()->tellExercises();
    auto* list = find<QComboBox>("scenes");
    const auto rowOf = [&](const char* folder) {
      return list->findData(toQt(exercises / folder / "scene.json"));
    };
    QVERIFY(rowOf("mine") >= 0 && rowOf("mine-77") >= 0);
    QVERIFY(list->itemText(rowOf("mine")) != list->itemText(rowOf("mine-77")));
    const int torn = rowOf("torn");
    QVERIFY(torn >= 0);
    QVERIFY(list->itemText(torn).contains("cannot be read"));
    QVERIFY(!(list->model()->flags(list->model()->index(torn, 0)) & Qt::ItemIsEnabled));
    QVERIFY(!list->itemData(torn, Qt::ToolTipRole).toString().isEmpty());
    std::filesystem::remove_all(exercises / "mine-77");
    std::filesystem::remove_all(exercises / "torn");
    window_->findChild<AppContext*>()->tellExercises();
  }

  void changedStructuresAreAskedAboutBeforeAnExport() {
    showStructures();
    take("structureBrush");
    SliceView& axial = slice(SliceAxis::axial);
    QTest::mouseClick(&axial, Qt::LeftButton, {}, axial.rect().center());
    QTRY_VERIFY(window_->findChild<PrepareWorkspace*>()->structuresUnsaved());
    take("sliceWindowTool");
    untilStructuresAreTaken();
    untilPlaced();
    showTab(PrepareWorkspace::kExerciseTab);
    find<QPushButton>("exportExercise")->click();
    QTRY_VERIFY(window_->findChild<QMessageBox*>("exportQuestion"));
    QVERIFY(find<QPushButton>("saveInCaseFirst"));
    find<QMessageBox>("exportQuestion")->close();
    QVERIFY(!window_->findChild<QFileDialog*>("exportExerciseDialog"));
    // A name without an ending is of the kind that is chosen.
    showStructures();
    find<QAction>("saveLabelMap")->trigger();
    auto* dialog = find<QFileDialog>("saveDialog");
    QCOMPARE(dialog->defaultSuffix(), QString("nii.gz"));
    emit dialog->filterSelected("3D Slicer (*.seg.nrrd *.nrrd)");
    QCOMPARE(dialog->defaultSuffix(), QString("seg.nrrd"));
    dialog->close();
    find<QAbstractButton>("saveStructures")->click();
    untilSaved();
    QVERIFY(!window_->findChild<PrepareWorkspace*>()->structuresUnsaved());
  }

  void aCaseThatIsGoneIsSaidAndWhatIsOpenStays() {
    showTab(PrepareWorkspace::kExerciseTab);
    const std::filesystem::path file = workstation().exerciseFile();
    const std::string id = workstation().currentCase()->stored;
    const std::filesystem::path folder = storage() / "cases" / id;
    std::filesystem::rename(folder, storage() / "away");
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    window_->findChild<AppContext*>()->openExercise(file, Place::prepare);
    QTRY_COMPARE_WITH_TIMEOUT(failed.count(), 1, kLong_ms);
    const Error error = failed[0][0].value<Error>();
    QVERIFY2(error.what.find("not on this workstation") != std::string::npos, error.what.c_str());
    QCOMPARE(workstation().currentCase()->stored, id);
    std::filesystem::rename(storage() / "away", folder);
  }

  void aDiskThatCannotBeWrittenLosesNothing() {
    showTab(PrepareWorkspace::kExerciseTab);
    enter("view:distance_mm", "333");
    const std::filesystem::path folder = storage() / "exercises";
    const std::filesystem::path file = workstation().exerciseFile();
    std::filesystem::rename(folder, storage() / "kept");
    QVERIFY(writeTextFile(folder, "no folder").ok());
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    find<QPushButton>("saveExercise")->click();
    QTRY_COMPARE_WITH_TIMEOUT(failed.count(), 1, kLong_ms);
    QVERIFY(workstation().exerciseEdited());
    QCOMPARE(exercise().view.distance_mm, 333.0);
    std::filesystem::remove(folder);
    std::filesystem::rename(storage() / "kept", folder);
    closeDialogs();
    find<QPushButton>("saveExercise")->click();
    untilSaved();
    QCOMPARE(readExercise(file)->view.distance_mm, 333.0);
  }

  void onAnotherCaseItIsAskedWhetherItIsReplacedAndAFixedArmIsNotTakenAlong() {
    showTab(PrepareWorkspace::kToolTab);
    choose("armChoice", QString("left"));
    choose("arm:landmark", QString(""));
    showTab(PrepareWorkspace::kExerciseTab);
    find<QPushButton>("saveExercise")->click();
    untilSaved();
    choose("view:landmark", QString(""));
    const std::filesystem::path file = workstation().exerciseFile();
    const std::string before = readExercise(file)->case_source;
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openPhantom("cranium");
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QVERIFY(workstation().exerciseFile() == file);
    showTab(PrepareWorkspace::kExerciseTab);
    find<QPushButton>("saveExercise")->click();
    QTRY_VERIFY(window_->findChild<QMessageBox*>("madeOnAnotherCase"));
    QCOMPARE(readExercise(file)->case_source, before);
    QTest::mouseClick(find<QPushButton>("saveBeside"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().exerciseFile() != file, kLong_ms);
    untilSaved();
    QCOMPARE(readExercise(file)->case_source, before);
    QCOMPARE(readExercise(workstation().exerciseFile())->case_source,
             std::string("phantom:cranium"));
  }

  void whatAnExerciseKeepsBindsWhoPractisesFromSavingOnAndNotItsAuthor() {
    showTab(PrepareWorkspace::kExerciseTab);
    find<QCheckBox>("scene:locks:tissues")->click();
    find<QCheckBox>("scene:locks:controller")->click();
    QCOMPARE(exercise().locks, (Locks{Lock::tissues, Lock::controller}));
    const auto isOpenToItsAuthor = [this] {
      return !find<QLabel>("formLocked")->isVisible() &&
             find<QLineEdit>("scene:name")->isEnabled() &&
             find<QPushButton>("saveExercise")->isEnabled() &&
             find<QPushButton>("saveExerciseCopy")->isEnabled() && !workstation().anyLocked();
    };
    QVERIFY(isOpenToItsAuthor());
    // Not saved, it binds nobody.
    window_->show(Place::train);
    QVERIFY(find<QComboBox>("controller")->isEnabled());
    window_->show(Place::prepare);
    find<QPushButton>("saveExercise")->click();
    untilSaved();
    QVERIFY(isOpenToItsAuthor());
    window_->show(Place::train);
    QVERIFY(!find<QComboBox>("controller")->isEnabled());
    QVERIFY(find<QLabel>("locked")->isVisible());
    TissueSet others = exercise().tissues;
    others.tissues.back().hu_max += 10;
    Exercise other = exercise();
    other.tissues = others;
    QCOMPARE(workstation().edit(other, "hu").error().code.str(), std::string("LOCKED"));
    // Changed in Prepare and not saved, it is tried from there and not practised.
    window_->show(Place::prepare);
    QVERIFY(workstation().edit(other, "hu").ok());
    window_->show(Place::train);
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    window_->startExercise();
    QTRY_COMPARE(failed.count(), 1);
    QVERIFY(failed[0][0].value<Error>().what.find("keeps its tissues") != std::string::npos);
    QVERIFY(workstation().tissuesEdited());
    for (auto* box : window_->findChildren<QMessageBox*>("errorDialog")) box->close();
    window_->show(Place::prepare);
    showTab(PrepareWorkspace::kExerciseTab);
    find<QPushButton>("tryExercise")->click();
    QVERIFY(find<QComboBox>("controller")->isEnabled());
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    window_->startExercise();
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    find<QPushButton>("backToPrepare")->click();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    workstation().undoEdit();
    find<QCheckBox>("scene:locks:tissues")->click();
    find<QCheckBox>("scene:locks:controller")->click();
    QVERIFY(exercise().locks.empty());
  }
};

}  // namespace trephine

int main(int argc, char** argv) {
  return trephine::test::runInWindow<trephine::ExerciseGuiTest>(argc, argv);
}

#include "exercise_gui_test.moc"
