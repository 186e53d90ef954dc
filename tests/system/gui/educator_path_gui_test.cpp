// The educator's whole path in the real window: a case of the library becomes an exercise that is
// felt, saved, tried, exported, imported elsewhere and run there. Once with the mouse, once by keys
// alone.
#include <QComboBox>
#include <QFileDialog>
#include <QListWidget>
#include <QMenu>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QTabBar>
#include <QToolButton>
#include <utility>

#include "exchange/exercise_folder.h"
#include "gui_support.h"
#include "library/case_library.h"

namespace trephine {

namespace {
constexpr int kMostTabs = 400;
}  // namespace

class EducatorPathTest : public test::WindowTest {
  Q_OBJECT

 private:
  enum class Way { mouse, keys };

  // --- As a person does it ---

  void press(int key, Qt::KeyboardModifiers with = {}, int times = 1) {
    for (int n = 0; n < times; ++n) {
      QWidget* to = QApplication::focusWidget();
      QTest::keyClick(to ? to : at_, Qt::Key(key), with);
      rest();
    }
  }
  bool hasFocus(const QString& name) {
    const QWidget* now = QApplication::focusWidget();
    return now && now->objectName() == name;
  }
  // The widget has the keys: clicked, or reached by Tab.
  bool reach(const QString& name) {
    if (way_ == Way::mouse) {
      auto* widget = at_->findChild<QWidget*>(name);
      if (!widget || !widget->isVisible()) return false;
      for (QWidget* up = widget->parentWidget(); up; up = up->parentWidget()) {
        if (auto* area = qobject_cast<QScrollArea*>(up)) area->ensureWidgetVisible(widget);
      }
      QTest::mouseClick(widget, Qt::LeftButton);
      return true;
    }
    for (int n = 0; n < kMostTabs && !hasFocus(name); ++n) press(Qt::Key_Tab);
    return hasFocus(name);
  }
  bool use(const QString& name) {
    if (!reach(name)) return false;
    if (way_ == Way::keys) press(Qt::Key_Space);
    return true;
  }
  // A field is left by Tab, which takes what was typed.
  bool fill(const QString& name, const QString& text) {
    if (!reach(name)) return false;
    press(Qt::Key_A, Qt::ControlModifier);
    for (const QString& line : text.split('\n')) {
      if (line != text.split('\n').front()) press(Qt::Key_Return);
      QTest::keyClicks(QApplication::focusWidget(), line);
    }
    press(Qt::Key_Tab);
    return true;
  }
  // The menu runs an event loop of its own until it has its key: in the first turn of that.
  bool choose(const QString& name, Qt::Key mnemonic) {
    auto* button = at_->findChild<QToolButton*>(name);
    if (!button || !button->menu() || (way_ == Way::keys && !reach(name))) return false;
    const auto answer = [mnemonic] {
      if (QWidget* menu = QApplication::activePopupWidget()) QTest::keyClick(menu, mnemonic);
    };
    connect(button->menu(), &QMenu::aboutToShow, this, answer,
            Qt::ConnectionType(Qt::QueuedConnection | Qt::SingleShotConnection));
    return use(name);
  }
  bool showTab(int tab) {
    auto* bar = at_->findChild<QTabWidget*>("prepareTabs")->tabBar();
    if (way_ == Way::mouse) {
      QTest::mouseClick(bar, Qt::LeftButton, {}, bar->tabRect(tab).center());
    } else {
      if (!reach(bar->objectName())) return false;
      press(Qt::Key_Home);
      while (bar->currentIndex() < tab) press(Qt::Key_Right);
    }
    return bar->currentIndex() == tab;
  }
  // Into the file dialog that is open.
  bool give(const char* name, const QString& path) {
    const auto dialogOf = [&] { return at_->findChild<QFileDialog*>(name); };
    if (!QTest::qWaitFor([&] { return dialogOf() && dialogOf()->isVisible(); }, kLong_ms)) {
      return false;
    }
    QFileDialog* dialog = dialogOf();
    auto* edit = dialog->findChild<QLineEdit*>("fileNameEdit");
    QApplication::setActiveWindow(dialog);
    edit->selectAll();
    QTest::keyClicks(edit, path);
    QTest::keyClick(edit, Qt::Key_Return);
    rest();
    QApplication::setActiveWindow(at_);
    return true;
  }

  // --- The path ---

  void walk(Way way) {
    way_ = way;
    QTemporaryDir home;
    CaseLibrary library(toPath(home.path()));
    NewCase made;
    made.volume = std::make_shared<const Volume>(test::coarseCranium(4));
    made.region = BodyRegion::head;
    made.tissues = toJson(*readTissueSet(resourceFolder() / "tissues" / "cranium.json"));
    QVERIFY(library.save(made).ok());
    window_ = newWindow(toPath(home.path()) / "recordings");
    MainWindow& window = *window_;
    open(window);
    const Workstation& work = window.workstation();

    // Its card.
    QSignalSpy opened(&window.workstation(), &Workstation::caseOpened);
    auto* cards = window.findChild<QListWidget*>("cases");
    QTRY_VERIFY_WITH_TIMEOUT(cards->count() >= 3, kLong_ms);
    QVERIFY(reach("cases"));
    press(Qt::Key_Home);
    const auto isOwn = [&] {
      const QString id = cards->currentItem()->data(Qt::UserRole).toString();
      return id != "cranium" && id != "abdomen";
    };
    for (int n = 0; n < cards->count() && !isOwn(); ++n) press(Qt::Key_Right);
    QVERIFY(isOwn());
    QVERIFY(use("prepareCase"));
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QCOMPARE(window.place(), Place::prepare);

    // A set of its own, and three edits.
    QVERIFY(choose("setMenu", Qt::Key_N));
    QTRY_COMPARE(work.exercise()->tissues.name, std::string("My tissues"));
    QTRY_VERIFY_WITH_TIMEOUT(!work.isOpening(), kLong_ms);
    QVERIFY(fill("setName", "Lesson one"));
    QCOMPARE(work.exercise()->tissues.name, std::string("Lesson one"));
    const std::string first = work.exercise()->tissues.tissues[0].id;
    QVERIFY(fill("stiffness", "444"));
    QCOMPARE(work.exercise()->tissues.find(first)->stiffness_N_per_m.value, 444.0);
    QVERIFY(fill("damping", "2.5"));
    QCOMPARE(work.exercise()->tissues.find(first)->damping_Ns_per_m.value, 2.5);
    const int low = work.exercise()->tissues.find(first)->hu_min;
    QVERIFY(fill("huLow", QString::number(low + 10)));
    QCOMPARE(work.exercise()->tissues.find(first)->hu_min, low + 10);
    QTRY_VERIFY_WITH_TIMEOUT(!work.isOpening(), kLong_ms);

    // Felt at once.
    auto* plot = window.findChild<PokePlot*>();
    press(Qt::Key_E, Qt::ControlModifier);
    QTRY_VERIFY_WITH_TIMEOUT(work.phase() == Workstation::Phase::running, kLong_ms);
    QVERIFY(work.isPoke());
    const auto pushed = [&] {
      for (const PokeCurve& poke : plot->pokes()) {
        if (poke.points.size() > 5) return true;
      }
      return false;
    };
    if (way == Way::mouse) {
      pokeWithMouse();
    } else {
      press(Qt::Key_Right);
      press(Qt::Key_PageDown, {}, 15);
      pass(2.5);
      press(Qt::Key_PageUp, {}, 15);
      pass(1.5);
    }
    QVERIFY(pushed());
    press(Qt::Key_E, Qt::ControlModifier);
    QTRY_VERIFY_WITH_TIMEOUT(work.phase() == Workstation::Phase::ready, kLong_ms);
    QVERIFY(!work.carved());

    // What it is, where to work, what is said before it.
    QVERIFY(showTab(PrepareWorkspace::kExerciseTab));
    const QString name = way == Way::mouse ? "By mouse" : "By keys";
    QVERIFY(fill("scene:name", name));
    QCOMPARE(toQt(work.exercise()->name), name);
    const std::size_t points =
        work.exercise()->outline ? work.exercise()->outline->points_mm.size() : 0;
    QVERIFY(use("drawOutline"));
    for (int n = 0; n < 3; ++n) {
      if (way == Way::mouse) {
        ViewWidget& view = window.view();
        QTest::mouseClick(&view, Qt::LeftButton, {}, view.rect().center() + QPoint(10 * n, 6 * n));
      } else {
        QVERIFY(reach("axial"));
        press(Qt::Key_Up, {}, 2);
        press(Qt::Key_Return);
      }
      rest();
    }
    QVERIFY(work.exercise()->outline);
    QVERIFY(work.exercise()->outline->points_mm.size() >= points + 3);
    press(Qt::Key_Escape);
    if (!work.exercise()->card) QVERIFY(use("cardOn"));
    QVERIFY(fill("card:goal", "Open the window"));
    QVERIFY(fill("card:steps", "Look\nCut"));
    QCOMPARE(work.exercise()->card->en.goal, std::string("Open the window"));
    QCOMPARE(work.exercise()->card->en.steps, (std::vector<std::string>{"Look", "Cut"}));

    // Kept, tried, and back.
    QVERIFY(use("saveExercise"));
    QTRY_VERIFY_WITH_TIMEOUT(!work.isSaving() && !work.exerciseEdited(), kLong_ms);
    QCOMPARE(exercisesIn(toPath(home.path())).size(), std::size_t(1));
    QVERIFY(use("tryExercise"));
    QCOMPARE(window.place(), Place::train);
    run(window);
    QVERIFY(use("backToPrepare"));
    QCOMPARE(window.place(), Place::prepare);

    // Out, and in elsewhere.
    QVERIFY(use("exportExercise"));
    const QString stick = home.filePath("stick");
    QVERIFY(give("exportExerciseDialog", stick));
    QTRY_VERIFY_WITH_TIMEOUT(QFile::exists(stick + "/exercise.json"), kLong_ms);
    QTRY_VERIFY_WITH_TIMEOUT(!work.isSaving(), kLong_ms);
    QVERIFY(window.grab().save(
        QString(TREPHINE_ARTEFACTS "/educator-%1.png").arg(way == Way::mouse ? "mouse" : "keys")));
    QTemporaryDir there;
    const auto here = std::exchange(window_, newWindow(toPath(there.path()) / "recordings"));
    MainWindow& elsewhere = *window_;
    window.hide();
    open(elsewhere);
    if (way == Way::mouse) {
      QTest::mouseClick(elsewhere.findChild<QToolButton*>("rail2"), Qt::LeftButton);
    } else {
      press(Qt::Key_2, Qt::ControlModifier);
    }
    QTRY_COMPARE(elsewhere.place(), Place::prepare);
    QSignalSpy arrived(&elsewhere.workstation(), &Workstation::caseOpened);
    QVERIFY(showTab(PrepareWorkspace::kExerciseTab));
    QVERIFY(use("importExercise"));
    QVERIFY(give("importExerciseDialog", stick));
    QVERIFY(arrived.count() == 1 || arrived.wait(kLong_ms));
    QCOMPARE(toQt(elsewhere.workstation().exercise()->name), name);
    QCOMPARE(elsewhere.workstation().currentCase()->sha256, work.currentCase()->sha256);
    QCOMPARE(toQt(toJson(*elsewhere.workstation().exercise()).dump()),
             toQt(toJson(*work.exercise()).dump()));
    run(elsewhere);
    at_ = nullptr;
    window_.reset();
  }
  void open(MainWindow& window) {
    at_ = &window;
    window.resize(1280, 800);
    window.QMainWindow::show();
    QVERIFY(QTest::qWaitForWindowExposed(&window));
    QApplication::setActiveWindow(&window);
  }
  void run(MainWindow& window) {
    const Workstation& work = window.workstation();
    QTRY_VERIFY_WITH_TIMEOUT(window.view().canDraw().ok(), kLong_ms);
    press(Qt::Key_F5);
    QTRY_VERIFY_WITH_TIMEOUT(work.phase() == Workstation::Phase::running, kLong_ms);
    QVERIFY(!work.isPoke());
    pass(0.6);
    QVERIFY(work.session()->state().ticks > 500);
    press(Qt::Key_Period, Qt::ControlModifier);
    QTRY_VERIFY_WITH_TIMEOUT(work.phase() == Workstation::Phase::ready, kLong_ms);
  }
  void pokeWithMouse() {
    pointAt(window_->view().rect().center());
    pushHand(15);
    pass(2.5);
    pushHand(-15);
    pass(1.5);
  }

  Way way_ = Way::mouse;
  MainWindow* at_ = nullptr;

 private slots:
  void initTestCase() {
    QApplication::setApplicationName("trephine-educator-test");
    QFile::remove(windowSettings().fileName());
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
  }
  void cleanup() { QFile::remove(windowSettings().fileName()); }

  void fromACaseToTheOtherWorkstationWithTheMouse() { walk(Way::mouse); }
  void fromACaseToTheOtherWorkstationByKeysAlone() { walk(Way::keys); }
};

}  // namespace trephine

int main(int argc, char** argv) {
  return trephine::test::runInWindow<trephine::EducatorPathTest>(argc, argv);
}

#include "educator_path_gui_test.moc"
