// The window on small screens: nothing lies outside, and every control can be reached. Run once
// more at scale 2 (QT_SCALE_FACTOR), where the screen has half as many units each way.
#include <QAbstractButton>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QDir>
#include <QMessageBox>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QSignalSpy>
#include <QStandardPaths>
#include <QStatusBar>
#include <QToolBar>
#include <QToolButton>
#include <QtTest>
#include <cstdio>

#include "gui_support.h"
#include "imaging/dicom/ct_writer.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"

using namespace trephine;

namespace {

// A block of bone in air, which asks no question.
Volume block() {
  Volume volume;
  volume.geometry.size = {64, 48, 20};
  volume.geometry.spacing_mm = {2.0, 2.0, 3.0};
  volume.hu.assign(volume.geometry.voxelCount(), kAirHu);
  for (int k = 5; k < 15; ++k) {
    for (int i = 16; i < 48; ++i) volume.hu[volume.geometry.indexOf(i, 24, k)] = 700;
  }
  return volume;
}

QString nameOf(const QWidget* widget) {
  QString name = widget->objectName();
  if (auto* button = qobject_cast<const QAbstractButton*>(widget); name.isEmpty() && button) {
    name = button->text();
  }
  return name.isEmpty() ? QString(widget->metaObject()->className()) : name;
}

bool isControl(QWidget* widget) {
  return qobject_cast<QAbstractButton*>(widget) || qobject_cast<QAbstractSpinBox*>(widget) ||
         qobject_cast<QComboBox*>(widget) ||
         (qobject_cast<QAbstractSlider*>(widget) && !qobject_cast<QScrollBar*>(widget));
}

// The controls of which a part lies outside of the window, even after its column was scrolled.
QStringList outOfReach(QWidget& window) {
  QStringList names;
  for (QWidget* widget : window.findChildren<QWidget*>()) {
    if (!isControl(widget) || !widget->isVisible() || widget->window() != &window) continue;
    for (QWidget* above = widget->parentWidget(); above; above = above->parentWidget()) {
      auto* area = qobject_cast<QScrollArea*>(above);
      if (!area || !area->widget()) continue;
      // Not ensureWidgetVisible(): of a field it shows the cursor alone.
      const QRect place(widget->mapTo(area->widget(), QPoint(0, 0)), widget->size());
      const QPoint middle = place.center();
      area->ensureVisible(middle.x(), middle.y(), place.width() / 2 + 1, place.height() / 2 + 1);
    }
    QRect seen = widget->visibleRegion().boundingRect();
    if (seen.size() != widget->size()) names << nameOf(widget);
  }
  return names;
}

}  // namespace

class WindowSizeTest : public test::WindowTest {
  Q_OBJECT

 private:
  QString folder() { return temporary_.filePath("ct"); }

  void verifyPage(const QString& name) {
    const QStringList lost = outOfReach(*window_);
    QVERIFY(window_->grab().save(QString(TREPHINE_ARTEFACTS "/size-%1x%2-%3.png")
                                     .arg(window_->width())
                                     .arg(window_->height())
                                     .arg(name)));
    QVERIFY2(lost.isEmpty(), qPrintable(name + ": " + lost.join(", ")));
  }

  // What needs most of the column, and how much.
  static QString widest(const QScrollArea& area) {
    QString words;
    for (const QWidget* of : area.widget()->findChildren<QWidget*>()) {
      const int left = of->mapTo(area.widget(), QPoint(0, 0)).x();
      const int needs = left + std::max(of->minimumSizeHint().width(), of->minimumWidth());
      if (!of->isVisible() || needs <= area.viewport()->width() - 12) continue;
      words += QStringLiteral("\n  %1 %2 from %3, %4 wide")
                   .arg(of->objectName(), of->metaObject()->className())
                   .arg(left)
                   .arg(needs - left);
    }
    return words;
  }

  void verifyAllIsThere(const QSize& size) {
    window_->resize(size);
    rest();
    QCOMPARE(window_->size(), size);  // it is no larger than it was asked to be
    for (Place place : {Place::cases, Place::prepare, Place::train, Place::review}) {
      window_->show(place);
      rest();
      verifyPage(QString::number(int(place)));
    }
    window_->show(Place::prepare);
    auto* tabs = find<QTabWidget>("prepareTabs");
    for (int tab = 0; tab < tabs->count(); ++tab) {
      tabs->setCurrentIndex(tab);
      rest();
      // A column is read without being moved to and fro.
      const int beyond =
          qobject_cast<QScrollArea*>(tabs->widget(tab))->horizontalScrollBar()->maximum();
      QVERIFY2(beyond == 0, qPrintable(tabs->tabText(tab) + ' ' + QString::number(beyond) +
                                       widest(*qobject_cast<QScrollArea*>(tabs->widget(tab)))));
      verifyPage("1" + tabs->tabText(tab));
    }
    for (const char* name : {"start", "stop", "pause", "undo", "redo", "reset"}) {
      QWidget* button = find<QToolBar>("toolBar")->widgetForAction(find<QAction>(name));
      QVERIFY2(button && button->isVisible(), name);
    }
    // What found no room in the bar is behind a button that can be seen.
    const bool all =
        find<QToolBar>("toolBar")->widgetForAction(find<QAction>("saveVolume"))->isVisible();
    auto* more = find<QToolButton>("qt_toolbar_ext_button");
    QVERIFY(all || more->isVisible());
    QVERIFY(all || more->width() >= more->fontMetrics().horizontalAdvance(more->text()));
    QVERIFY(!more->text().isEmpty());
    auto* purpose = find<QLabel>("purpose");
    QCOMPARE(purpose->visibleRegion().boundingRect(), purpose->rect());
    QVERIFY(purpose->width() >= purpose->sizeHint().width());
  }

  void sizes() {
    QTest::addColumn<QSize>("size");
    QTest::newRow("1280x800") << QSize(1272, 764);
    QTest::newRow("1366x768") << QSize(1358, 732);
    QTest::newRow("1024x768") << QSize(1016, 732);
    QTest::newRow("1920x1080 at scale 2") << QSize(952, 504);
    QTest::newRow("1280x720 at scale 1.5") << QSize(845, 444);
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    const Status written = writeCtSeries(block(), {"Block", "HEAD"}, toPath(folder()));
    QVERIFY2(written.ok(), written.ok() ? "" : written.error().sentence().c_str());
  }
  void init() { window_ = newWindow(toPath(temporary_.filePath("sessions"))); }
  void cleanup() { window_.reset(); }

  void aNewWindowLeavesRoomForItsFrameOnTheScreen() {
    const QSize screen = window_->screen()->availableSize();
    QVERIFY(window_->width() < screen.width());
    QVERIFY(window_->height() <= screen.height() - 30);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QVERIFY(window_->width() < screen.width());
    QVERIFY(window_->height() <= screen.height() - 30);
  }

  void aSmallScreenShowsEveryControl_data() { sizes(); }
  void aSmallScreenShowsEveryControl() {
    QFETCH(QSize, size);
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    verifyAllIsThere(size);
  }

  void aSmallScreenShowsEveryControlOfFourViewsToo() {
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    window_->views().setLayout({ViewLayout::Kind::four, 0});
    verifyAllIsThere(QSize(845, 444));
    window_->views().setLayout({ViewLayout::Kind::one_large, 1});
    verifyAllIsThere(QSize(845, 444));
  }

  void aSmallScreenShowsEveryControlOfAnExerciseToo() {
    window_->show();
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QSignalSpy opened(&window_->workstation(), &Workstation::caseOpened);
    window_->workstation().openPath(defaultExercise("cranium"));
    QVERIFY(opened.wait(kLong_ms));
    QSignalSpy started(&window_->workstation(), &Workstation::sessionStarted);
    window_->startExercise();
    QVERIFY(started.wait(kLong_ms));
    QTRY_VERIFY_WITH_TIMEOUT(!find<QLabel>("rates")->text().isEmpty(), kLong_ms);
    // With all that the panels may have to say.
    window_->findChild<TissuePanel*>()->select("bone");
    for (const char* name : {"damping", "stiffness"}) find<QDoubleSpinBox>(name)->setValue(1e5);
    QTRY_VERIFY(!find<QLabel>("tissueFelt")->text().isEmpty());
    verifyAllIsThere(QSize(845, 444));
    window_->workstation().stop();
    QTRY_VERIFY_WITH_TIMEOUT(window_->workstation().phase() == Workstation::Phase::ready, kLong_ms);
  }

  void aSmallScreenShowsEveryControlOfTheImportPage_data() { sizes(); }
  void aSmallScreenShowsEveryControlOfTheImportPage() {
    QFETCH(QSize, size);
    window_->show();
    window_->workstation().openPath(toPath(folder()));
    QTRY_VERIFY_WITH_TIMEOUT(find<QPushButton>("import")->isEnabled(), kLong_ms);
    window_->resize(size);
    rest();
    QCOMPARE(window_->size(), size);
    verifyPage("import");
    find<ImportPage>("importPage")->reject();
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<WindowSizeTest>(argc, argv);
}

#include "window_size_test.moc"
