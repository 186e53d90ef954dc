// Prepare in the real window: what an educator sets of tissues, by its effect on exercise, force
// and picture.
#include <QFileDialog>
#include <QMenu>
#include <QMessageBox>
#include <QSpinBox>
#include <QToolButton>

#include "case/placement.h"
#include "gui_support.h"
#include "imaging/importer.h"
#include "tissue/tissue_edits.h"

namespace trephine {

class PrepareGuiTest : public test::WindowTest {
  Q_OBJECT

 private:
  HistogramView& histogram() { return *find<HistogramView>("histogram"); }
  TissuePanel& panel() { return *window_->findChild<TissuePanel*>(); }
  const TissueSet& tissues() { return workstation().exercise()->tissues; }
  const Tissue& tissue(const char* id) { return *tissues().find(id); }
  std::size_t placeOf(const char* id) {
    return std::size_t(tissues().find(id) - tissues().tissues.data());
  }
  void keepGrab(const char* name) {
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/") + name));
  }
  QPoint at(double hu) {
    return {int(std::lround(histogram().xOf(hu))), int(histogram().plot().center().y())};
  }
  QPoint seenAt(double hu, QWidget* widget) { return widget->mapTo(window_.get(), at(hu)); }
  void key(QWidget* widget, Qt::Key of, Qt::KeyboardModifiers with = {}) {
    QTest::keyClick(widget, of, with);
  }
  // As a person: the field, its text, Return.
  void enter(const char* name, const QString& text) {
    auto* box = find<QAbstractSpinBox>(name);
    box->setFocus();
    box->selectAll();
    QTest::keyClicks(box, text);
    key(box, Qt::Key_Return);
  }
  void choose(const char* action) { find<QAction>(action)->trigger(); }
  static int pixelsOf(const QImage& image, const QColor& wanted, int most_apart) {
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const QColor c = image.pixelColor(x, y);
        count += std::abs(c.red() - wanted.red()) <= most_apart &&
                 std::abs(c.green() - wanted.green()) <= most_apart &&
                 std::abs(c.blue() - wanted.blue()) <= most_apart;
      }
    }
    return count;
  }
  // The share of pixels that are clearly others.
  static double differing(const QImage& a, const QImage& b) {
    if (a.size() != b.size()) return 1.0;
    int count = 0;
    for (int y = 0; y < a.height(); ++y) {
      for (int x = 0; x < a.width(); ++x) {
        const QColor c = a.pixelColor(x, y), d = b.pixelColor(x, y);
        count += std::abs(c.red() - d.red()) + std::abs(c.green() - d.green()) +
                     std::abs(c.blue() - d.blue()) >
                 60;
      }
    }
    return double(count) / double(a.width() * a.height());
  }
  // Yellow is no grey and no tissue's colour.
  int yellow() {
    const QImage image = window_->views().slice(SliceAxis::coronal).grab().toImage();
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const QColor c = image.pixelColor(x, y);
        count += c.red() > 150 && c.green() > 120 && c.blue() < c.green() - 60;
      }
    }
    return count;
  }
  void untilCounted() { QTRY_VERIFY_WITH_TIMEOUT(histogram().shares().all > 0, kLong_ms); }
  // All edits go.
  void undoAll() {
    for (int n = 0; n < 300 && workstation().edits().canUndo(); ++n) workstation().undoEdit();
  }
  QString listText(const char* id) {
    return find<QListWidget>("tissueList")->item(int(placeOf(id)))->text();
  }

 private slots:
  void initTestCase() {
    openWindow("trephine-prepare-test");
    // Without a case there is nothing to edit, whatever is clicked.
    showTissues();
    find<QToolButton>("addTissue")->click();
    QVERIFY(!find<QToolButton>("addTissue")->isEnabled() &&
            !find<QToolButton>("setMenu")->isEnabled());
    emit panel().tissuesChanged(startingSet("none"), "set");
    QVERIFY(!workstation().exercise());
    QApplication::setActiveWindow(window_.get());
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    workstation().openImported(caseOf(std::make_shared<const Volume>(test::coarseCranium(2))));
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    showTissues();
    window_->views().setLayout({ViewLayout::Kind::four, 0});
    untilCounted();
  }
  void cleanupTestCase() { closeWindow(); }
  void cleanup() {
    if (workstation().phase() == Workstation::Phase::running) {
      workstation().stop();
      QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    }
    undoAll();
    rest();
  }

  void sharesOfTheTissuesAreThoseOfTheVoxels() {
    const Volume& volume = *workstation().currentCase()->volume;
    const TissueTable table = tissueTable(tissues());
    std::uint64_t bone = 0;
    for (const std::int16_t hu : volume.hu) bone += classify(table, hu) == int(placeOf("bone"));
    QCOMPARE(histogram().shares().voxels[placeOf("bone")], bone);
    const double ml = double(bone) * volume.geometry.voxelVolume_mm3() / 1000.0;
    QVERIFY2(listText("bone").contains(QString("%1 mL").arg(ml, 0, 'f', 0)),
             qPrintable(listText("bone")));
  }

  void aDraggedThresholdIsSeenInSlicesAndIn3DAtOnceAndIsOneStepBack() {
    const TissueSet before = tissues();
    const QString share = listText("bone");
    restRefined();
    const QImage head = window_->view().grab().toImage();
    panel().select("bone");
    rest();
    const double edge = tissue("bone").hu_min - 0.5;
    const int lines = yellow();  // of the other views
    QTest::mousePress(&histogram(), Qt::LeftButton, {}, at(edge));
    for (int n = 1; n <= 10; ++n) {
      moveTo(histogram(), at(edge) - QPoint(4 * n, 0), Qt::LeftButton);
      rest();
    }
    QVERIFY(tissue("bone").hu_min < 180);
    QCOMPARE(tissue("dura").hu_max, tissue("bone").hu_min - 1);  // it goes along
    QTRY_VERIFY2(yellow() > lines + 100, qPrintable(QString::number(yellow())));
    QVERIFY(listText("bone") != share);
    keepGrab("prepare-threshold.png");
    QTest::mouseRelease(&histogram(), Qt::LeftButton, {}, at(edge) - QPoint(40, 0));
    QTRY_VERIFY(yellow() <= lines);
    QCOMPARE(find<QSpinBox>("huLow")->value(), tissue("bone").hu_min);
    QCOMPARE(QString::fromStdString(tissue("bone").hu_source), QString(kOwnSource));
    find<QAction>("undo")->trigger();
    QVERIFY(tissues() == before);
    QCOMPARE(listText("bone"), share);
    QTRY_VERIFY(differing(window_->view().grab().toImage(), head) < 0.01);
    find<QAction>("redo")->trigger();
    QVERIFY(tissue("bone").hu_min < 180);
  }

  void whileAThresholdIsMovedItsTissueStandsAloneIn3D() {
    restRefined();
    const QImage head = window_->view().grab().toImage();
    panel().select("dura");  // which lies within the bone
    histogram().setFocus();
    QTest::keyPress(&histogram(), Qt::Key_Left);
    QTRY_VERIFY(differing(window_->view().grab().toImage(), head) > 0.1);
    QTest::keyRelease(&histogram(), Qt::Key_Left);
    QTRY_VERIFY(differing(window_->view().grab().toImage(), head) < 0.01);
    QVERIFY(workstation().edits().canUndo());
  }

  void withCtrlTheNeighbourStaysAndTheGapIsSaid() {
    panel().select("bone");
    const int dura = tissue("dura").hu_max;
    const double edge = tissue("bone").hu_min - 0.5;
    QTest::mousePress(&histogram(), Qt::LeftButton, {}, at(edge));
    for (int n = 1; n <= 5; ++n) {
      QMouseEvent move(QEvent::MouseMove, QPointF(at(edge) + QPoint(8 * n, 0)),
                       histogram().mapToGlobal(QPointF(at(edge) + QPoint(8 * n, 0))), Qt::NoButton,
                       Qt::LeftButton, Qt::ControlModifier);
      QCoreApplication::sendEvent(&histogram(), &move);
    }
    QTest::mouseRelease(&histogram(), Qt::LeftButton, {}, at(edge) + QPoint(40, 0));
    QCOMPARE(tissue("dura").hu_max, dura);
    QVERIFY(tissue("bone").hu_min > dura + 20);
    QVERIFY(find<QLabel>("tissueGaps")->text().contains(QString("%1 to").arg(dura + 1)));
  }

  void arrowKeysMoveTheChosenThresholdByOneHuAndChooseOthers() {
    const TissueSet before = tissues();
    panel().select("bone");
    histogram().setFocus();
    const int low = tissue("bone").hu_min;
    for (int n = 0; n < 3; ++n) key(&histogram(), Qt::Key_Right);
    QCOMPARE(tissue("bone").hu_min, low + 3);
    key(&histogram(), Qt::Key_Left, Qt::ShiftModifier);
    QCOMPARE(tissue("bone").hu_min, low - 7);
    key(&histogram(), Qt::Key_Up);  // the dura's upper end
    QCOMPARE(panel().chosen(), placeOf("dura"));
    key(&histogram(), Qt::Key_Left);
    QCOMPARE(tissue("bone").hu_min, low - 8);
    const double shown = histogram().xOf(low);
    key(&histogram(), Qt::Key_Plus);
    QVERIFY(histogram().huAt(histogram().plot().right()) -
                histogram().huAt(histogram().plot().left()) <
            2800.0);
    key(&histogram(), Qt::Key_0);
    QCOMPARE(histogram().xOf(low), shown);
    undoAll();
    QVERIFY(tissues() == before);
  }

  void aRangeThatAnotherHoldsIsRefusedBesideItsFieldAndHatched() {
    const TissueSet before = tissues();
    panel().select("bone");
    enter("huLow", "100");
    auto* problem = find<QLabel>("tissueProblem");
    QVERIFY(problem->isVisible());
    QVERIFY(problem->text().contains("overlap"));
    QVERIFY2(problem->text().contains("\"Bone\""), qPrintable(problem->text()));
    QVERIFY(tissues() == before);
    const QImage band = histogram().grab().toImage();
    QVERIFY(pixelsOf(band, colours::kBad, 40) > 20);
    keepGrab("prepare-overlap.png");
    enter("huLow", "226");
    QVERIFY(!problem->isVisible());
    QCOMPARE(pixelsOf(histogram().grab().toImage(), colours::kBad, 40), 0);
  }

  void aTissueIsAddedNamedAndTakenAwayAgain() {
    const TissueSet before = tissues();
    QTest::mouseClick(find<QToolButton>("addTissue"), Qt::LeftButton);
    QCOMPARE(tissues().tissues.size(), before.tissues.size() + 1);
    QCOMPARE(panel().chosen(), std::size_t(0));
    auto* name = find<QLineEdit>("tissue:name");
    QVERIFY(name->hasFocus());
    QTest::keyClicks(name, "Air of sinuses");
    key(name, Qt::Key_Return);
    QCOMPARE(tissues().tissues[0].name, std::string("Air of sinuses"));
    QVERIFY(listText(tissues().tissues[0].id.c_str()).startsWith("Air of sinuses"));
    QTest::mouseClick(find<QToolButton>("removeTissue"), Qt::LeftButton);
    QVERIFY(tissues() == before);
    // What a landmark of the exercise is on goes, and it is said where it is on now.
    QString said;
    const auto listening = connect(window_->findChild<Messages*>(), &Messages::said, this,
                                   [&](const QString& words) { said = words; });
    panel().select("bone");
    QTest::mouseClick(find<QToolButton>("removeTissue"), Qt::LeftButton);
    disconnect(listening);
    QVERIFY(!tissues().find("bone"));
    QVERIFY2(said.contains("was on Bone"), qPrintable(said));
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    undoAll();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    QVERIFY(tissues() == before);
  }

  void everyNumberOfTheMechanicsReachesTheExercise() {
    panel().select("dura");
    enter("damping", "7.5");
    QCOMPARE(tissue("dura").damping_Ns_per_m.value, 7.5);
    enter("stiffness", "333");
    QCOMPARE(tissue("dura").stiffness_N_per_m.value, 333.0);
    enter("friction", "0.7");
    QCOMPARE(tissue("dura").friction_N.value, 0.7);
    enter("rupture", "1.25");
    QCOMPARE(tissue("dura").rupture_N->value, 1.25);
    enter("cutting", "0.25");
    QCOMPARE(tissue("dura").cutting_J_per_mm3->value, 0.00025);
    QCOMPARE(QString::fromStdString(tissue("dura").cutting_J_per_mm3->source), QString(kOwnSource));
    auto* source = find<QLineEdit>("ruptureSource");
    source->setFocus();
    source->selectAll();
    QTest::keyClicks(source, "a book, page 3");
    key(source, Qt::Key_Return);
    QCOMPARE(tissue("dura").rupture_N->source, std::string("a book, page 3"));
    QVERIFY(tissue("dura").cuttable);
    find<QCheckBox>("tissue:cuttable")->click();
    QVERIFY(!tissue("dura").cuttable);
    auto* solid = find<QComboBox>("solid");
    const std::optional<bool> before = tissue("dura").solid;
    const auto stops = [&](int chosen) {
      solid->setCurrentIndex(chosen);
      emit solid->activated(chosen);
      return tissue("dura").solid;
    };
    QCOMPARE(stops(1), std::optional<bool>(true));
    QCOMPARE(stops(0), std::optional<bool>());
    QCOMPARE(stops(2), std::optional<bool>(false));
    auto* hu_source = find<QLineEdit>("tissue:hu_source");
    hu_source->setFocus();
    hu_source->selectAll();
    QTest::keyClicks(hu_source, "an atlas, plate 4");
    key(hu_source, Qt::Key_Return);
    QCOMPARE(tissue("dura").hu_source, std::string("an atlas, plate 4"));
    key(hu_source, Qt::Key_Z, Qt::ControlModifier);
    // From a field in which nothing was typed Ctrl+Z takes back edits.
    QApplication::setActiveWindow(window_.get());
    find<QLineEdit>("dampingSource")->setFocus();
    key(find<QLineEdit>("dampingSource"), Qt::Key_Z, Qt::ControlModifier);
    QCOMPARE(tissue("dura").solid, std::optional<bool>());
    QVERIFY(before != std::optional<bool>(false));
  }

  void whatTheArmsShowStandsBesideEveryNumberAndFollowsTheController() {
    panel().select("bone");
    auto* stiffness = find<LimitBar>("stiffnessLimit");
    QVERIFY(stiffness->limit() && *stiffness->limit() > 100.0);
    QVERIFY(find<LimitBar>("dampingLimit")->words().startsWith("arm"));
    QCOMPARE(*find<LimitBar>("frictionLimit")->limit(), 3.3);
    QVERIFY(!find<LimitBar>("cuttingLimit")->limit());
    for (const char* name : {"damping", "stiffness", "friction", "rupture", "cutting"}) {
      QVERIFY(find<LimitBar>(QString(name) + "Limit")->isVisibleTo(&panel()));
    }
    QVERIFY(stiffness->toolTip().contains("is felt as that"));
    workstation().setController(ControllerKind::off);
    QVERIFY(stiffness->toolTip().contains("may shake"));
    workstation().setController(ControllerKind::bounded);
    QVERIFY(stiffness->toolTip().contains("is felt as that"));
  }

  void setsAreNewDuplicatedExportedImportedAndReverted() {
    const TissueSet before = tissues();
    choose("duplicateSet");
    QCOMPARE(tissues().name, "Copy of " + before.name);
    choose("newSet");
    QVERIFY(!tissues().find("brain"));
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    auto* name = find<QLineEdit>("setName");
    name->setFocus();
    name->selectAll();
    QTest::keyClicks(name, "Two kinds");
    key(name, Qt::Key_Return);
    QCOMPARE(tissues().name, std::string("Two kinds"));
    panel().select("soft");
    enter("stiffness", "77");
    const TissueSet mine = tissues();
    choose("exportSet");
    auto* dialog = find<QFileDialog>("saveDialog");
    const QString file = temporary_.filePath("two.json");
    emit dialog->fileSelected(file);
    dialog->close();
    QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(file), kLong_ms);
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isSaving(), kLong_ms);
    undoAll();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    QVERIFY(tissues() == before);
    choose("importSet");
    auto* import = find<QFileDialog>("importSetDialog");
    emit import->fileSelected(file);
    import->close();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    QVERIFY(tissues() == mine);
    undoAll();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
  }

  void aSetOfANewerVersionIsSaidAndNothingIsLost() {
    const TissueSet before = tissues();
    Json newer = toJson(before);
    newer["version"] = 2;
    const QString file = temporary_.filePath("newer.json");
    QVERIFY(writeTextFile(toPath(file), newer.dump()).ok());
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    choose("importSet");
    auto* import = find<QFileDialog>("importSetDialog");
    emit import->fileSelected(file);
    import->close();
    QCOMPARE(failed.count(), 1);
    const Error error = failed[0][0].value<Error>();
    QVERIFY2(error.what.find('2') != std::string::npos, error.what.c_str());
    for (QMessageBox* box : window_->findChildren<QMessageBox*>()) box->close();
    QVERIFY(tissues() == before);
  }

  // Before anybody has touched it: what each tool would meet in the chosen tissue, and what the
  // arms' own friction hides of it.
  void theForceOfTheChosenTissueIsForeseenAndFollowsAnEdit() {
    auto* plot = find<PokePlot>("pokePlot");
    auto* hidden = find<QLabel>("tissueHidden");
    const auto most = [&](const char* id) {
      return !plot->foreseen().empty() &&
                     plot->foreseen()[0].curve.tissue == std::int32_t(placeOf(id))
                 ? plot->foreseen()[0].curve.most_N
                 : -1.0;
    };
    panel().select("bone");
    QTRY_VERIFY_WITH_TIMEOUT(plot->isVisible() && most("bone") > 0.5, kLong_ms);
    QVERIFY(!hidden->isVisible());
    keepGrab("prepare-foreseen-bone.png");
    panel().select("brain");
    const double soft_N = most("brain");
    QVERIFY(soft_N > 0.0 && soft_N < 0.26);
    QVERIFY(hidden->isVisible());
    QVERIFY2(hidden->text().contains("is lost in that arm's own friction"),
             qPrintable(hidden->text()));
    QVERIFY(plot->accessibleDescription().contains("computed"));
    keepGrab("prepare-foreseen-brain.png");
    enter("stiffness", "250");
    QTRY_VERIFY_WITH_TIMEOUT(most("brain") > 2.0 * soft_N, kLong_ms);
    workstation().undoEdit();
    QTRY_VERIFY_WITH_TIMEOUT(most("brain") == soft_N, kLong_ms);
  }

  // The force that a poke meets is the tissue's, an edit is felt while it goes on, and nothing is
  // cut.
  void aPokeTellsForceAgainstDepthAndAnEditIsFeltInIt() {
    const std::string whole = workstation().currentCase()->sha256;
    QTest::mouseClick(find<QPushButton>("pokeButton"), Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::running, kLong_ms);
    QVERIFY(workstation().isPoke());
    QVERIFY(find<QAction>("poke")->isChecked());
    auto* plot = find<PokePlot>("pokePlot");
    QVERIFY(plot->isVisible());
    takeHand(Hand::right);
    const auto pokeOnce = [&] {
      pushHand(12);
      pass(0.7);
      pushHand(-12);
      pass(0.9);
    };
    const auto most = [&] {
      double most_N = 0.0;
      if (plot->pokes().empty()) return 0.0;
      for (const PokePoint& p : plot->pokes().back().points) most_N = std::max(most_N, p.sent_N);
      return most_N;
    };
    pokeOnce();
    // The plot follows by a timer of its own.
    QTRY_VERIFY(most() > 0.8 && plot->pokes().back().ended);
    keepGrab("prepare-poke.png");
    QVERIFY(removedVoxels(*workstation().session()) == 0);
    // An edit, while it goes on.
    panel().select("bone");
    const std::size_t bone = placeOf("bone");
    pushHand(12);
    pass(0.5);
    const auto depth = [&] {
      const auto& pokes = plot->pokes();
      return pokes.empty() || pokes.back().points.empty() ? 0.0
                                                          : pokes.back().points.back().depth_mm;
    };
    QTRY_VERIFY(!plot->pokes().back().ended && depth() > 0.0);
    const double firm_mm = depth();
    enter("stiffness", "250");
    pass(0.8);
    QTRY_VERIFY2(depth() > firm_mm + 1.0, qPrintable(QString("%1 %2").arg(firm_mm).arg(depth())));
    QCOMPARE(workstation().session()->exercise().tissues.tissues[bone].stiffness_N_per_m.value,
             250.0);
    pushHand(-12);
    pass(0.9);
    for (int n = 0; n < 5; ++n) pokeOnce();
    QVERIFY(plot->pokes().size() <= PokeCurves::kKept + 1);
    // A tissue more waits for its end.
    QSignalSpy failed(window_.get(), &MainWindow::failed);
    const std::size_t count = tissues().tissues.size();
    find<QToolButton>("addTissue")->click();
    QCOMPARE(tissues().tissues.size(), count);
    QCOMPARE(failed.count(), 1);
    for (QMessageBox* box : window_->findChildren<QMessageBox*>()) box->close();
    find<QAction>("poke")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    QVERIFY(!find<QAction>("poke")->isChecked());
    QVERIFY(plot->isVisible());  // the last ones stay
    QVERIFY(!window_->findChild<ResultPage*>()->isVisible());
    QCOMPARE(workstation().currentCase()->sha256, whole);
    QVERIFY(!workstation().carved());
    QVERIFY(QDir(temporary_.filePath("recordings")).isEmpty());
  }

  void leavingPrepareEndsThePoke() {
    find<QAction>("poke")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().isPoke(), kLong_ms);
    window_->show(Place::cases);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    showTissues();
  }
};

}  // namespace trephine

int main(int argc, char** argv) {
  return trephine::test::runInWindow<trephine::PrepareGuiTest>(argc, argv);
}

#include "prepare_gui_test.moc"
