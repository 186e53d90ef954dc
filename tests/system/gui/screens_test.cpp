// A picture of every workspace at every size, with a real case and a cut in progress, for whoever
// looks at the window as a designer does. What a program can see of that is checked: no label is
// cut off, none shows a dash alone, and what the page is for is said on it.
#include <QComboBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QRadioButton>
#include <QScreen>
#include <QScrollArea>
#include <QSignalSpy>
#include <QTabWidget>
#include <QTemporaryDir>
#include <QtTest>
#include <cstdlib>

#include "gui_support.h"
#include "imaging/dicom/ct_writer.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"
#include "volume/phantom_file.h"

using namespace trephine;

namespace {
const char* const kOfHelp = "1280x800";  // its pictures are those of help, and whole
}  // namespace

class ScreensTest : public test::WindowTest {
  Q_OBJECT

 private:
  QSize size_;
  QString prefix_;

  void take(const QString& name) {
    if (prefix_ == kOfHelp) {
      restRefined();
    } else {
      rest();
    }
    const QString file = QString(TREPHINE_ARTEFACTS "/screen-%1-%2.png").arg(prefix_, name);
    QVERIFY(window_->grab().save(file));
    QStringList wrong;
    for (const QLabel* label : window_->findChildren<QLabel*>()) {
      if (!label->isVisible() || label->text().isEmpty() || !label->pixmap().isNull() ||
          dynamic_cast<const ElidedLabel*>(label) || label->textFormat() == Qt::RichText) {
        continue;
      }
      const QString what = label->objectName() + " \"" + label->text() + '"';
      const int needed = label->wordWrap()
                             ? label->heightForWidth(label->width())
                             : label->fontMetrics()
                                   .boundingRect(QRect(0, 0, 4000, 4000), 0, label->text())
                                   .width();
      const bool cut_off =
          label->wordWrap() ? needed > label->height() + 2 : needed > label->width() + 2;
      if (cut_off) wrong << "cut off: " + what;
    }
    QVERIFY2(wrong.isEmpty(), qPrintable(name + ": " + wrong.join("; ")));
    auto* purpose = find<QLabel>("purpose");
    QCOMPARE(purpose->visibleRegion().boundingRect(), purpose->rect());
  }

  // Written once for all sizes.
  std::filesystem::path phantomSeries() {
    static QTemporaryDir folder;
    const std::filesystem::path path = toPath(folder.path()) / "ct";
    if (std::filesystem::exists(path)) return path;
    const Result<Phantom> head = openPhantom("cranium");
    if (!head || !writeCtSeries(head->volume, {"Head, built in", "HEAD"}, path)) {
      qFatal("no series");
    }
    return path;
  }

  // A long form, once from its top and once for each of these of its fields.
  void showTab(int tab, const QString& name, const QStringList& fields) {
    find<QTabWidget>("prepareTabs")->setCurrentIndex(tab);
    take("prepare-" + name);
    for (const QString& field : fields) {
      auto* widget = window_->findChild<QWidget*>(field);
      QVERIFY2(widget, qPrintable(field));
      for (QWidget* up = widget; up; up = up->parentWidget()) {
        if (auto* area = qobject_cast<QScrollArea*>(up)) area->ensureWidgetVisible(widget, 0, 200);
      }
      take("prepare-" + name + "-" + field);
    }
  }

 private slots:
  void initTestCase() { QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS)); }

  void everyWorkspace_data() {
    QTest::addColumn<QSize>("size");
    const bool scaled = qEnvironmentVariableIsSet("QT_SCALE_FACTOR");
    if (scaled) {
      QTest::newRow("1920x1080-at-2") << QSize(952, 504);
      return;
    }
    QTest::newRow("1024x700") << QSize(1024, 700);
    QTest::newRow("1280x800") << QSize(1280, 800);
    QTest::newRow("1920x1080") << QSize(1920, 1050);
  }
  void everyWorkspace() {
    QFETCH(QSize, size);
    prefix_ = QTest::currentDataTag();
    QFile::remove(windowSettings().fileName());
    window_ = newWindow(toPath(temporary_.filePath(prefix_ + "/sessions")));
    window_->resize(size);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QApplication::setActiveWindow(window_.get());
    QTRY_VERIFY_WITH_TIMEOUT(find<QListWidget>("cases")->count() >= 2, kLong_ms);
    take("cases-first");
    window_->show(Place::train);
    take("train-no-case");

    // The real head, where it is at hand; else one that is built in, as a scanner would send it.
    // The pictures of help are of that one.
    const char* data = std::getenv("TREPHINE_TEST_DATA");
    const std::filesystem::path series =
        data ? std::filesystem::path(data) / "head-ct-gantry-tilt" : phantomSeries();
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    window_->open(series);
    auto* import = find<QPushButton>("import");
    QTRY_VERIFY_WITH_TIMEOUT(import->isEnabled(), kLong_ms);
    take("import");
    QTest::mouseClick(import, Qt::LeftButton);
    auto* open_case = find<QPushButton>("openCase");
    QTRY_VERIFY_WITH_TIMEOUT(open_case->isVisible() || opened.count() > 0, kLong_ms);
    if (open_case->isVisible()) {
      take("import-asking");
      for (const char* keep : {"choice_FACE_keep", "choice_COUCH_keep"}) {
        if (auto* choice = window_->findChild<QRadioButton*>(keep)) choice->click();
      }
      QTest::mouseClick(open_case, Qt::LeftButton);
    }
    QTRY_VERIFY_WITH_TIMEOUT(opened.count() > 0, kLong_ms);
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().currentCase()->stored.empty(), kLong_ms);
    showTissues();
    window_->findChild<TissuePanel*>()->select("bone");
    take("prepare-tissues");
    showStructures();
    take("prepare-structures");
    showTab(PrepareWorkspace::kToolTab, "tools", {"arm:landmark", "measureCosts"});
    showTab(PrepareWorkspace::kExerciseTab, "exercise", {"landmark", "card:goal", "outlinePoint"});
    window_->show(Place::train);
    take("train-card");
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().isOpening(), kLong_ms);
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    window_->startExercise();
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    take("train-ready");
    cut({60, 0});
    takeHand(Hand::right);
    pushHand(8);
    pass(2.0);
    take("train-cutting");
    find<QAction>("pause")->trigger();
    take("train-paused");
    find<QAction>("stop")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(find<QWidget>("resultPage")->isVisible(), kLong_ms);
    take("train-result");
    window_->show(Place::review);
    QTRY_VERIFY(find<QTreeWidget>("recordings")->topLevelItemCount() > 0);
    QTRY_VERIFY(!find<QLabel>("readingRecordings")->isVisible());
    take("review");
    window_->show(Place::cases);
    take("cases");
    window_.reset();
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<ScreensTest>(argc, argv);
}

#include "screens_test.moc"
