// A threshold that is dragged over a CT of 512 x 512 x 300 in the window's Prepare: what a step
// takes until histogram, shares and slices show it, and until the 3-D view does, beside what a
// frame of that view takes when the camera turns. Needs a display (xvfb-run).
//
//   bench_thresholds [COLUMNS ROWS SLICES]
#include <QElapsedTimer>
#include <QStandardPaths>
#include <QTabWidget>
#include <QTest>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "bench/head_volume.h"
#include "case/placement.h"
#include "ui/common/colours.h"
#include "ui/frame/main_window.h"
#include "ui/frame/start_up.h"

using namespace trephine;

namespace {

void settle(int ms) {
  QElapsedTimer timer;
  timer.start();
  while (timer.elapsed() < ms) QApplication::processEvents(QEventLoop::WaitForMoreEvents, 20);
}

void print(const char* what, std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  std::printf("%-44s median %6.1f ms, p90 %6.1f, longest %6.1f, of %zu\n", what,
              ms[ms.size() / 2], ms[ms.size() * 9 / 10], ms.back(), ms.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  Index3 size{512, 512, 300};
  for (int a = 0; a < 3 && a + 1 < argc; ++a) size[std::size_t(a)] = std::atoi(argv[a + 1]);
  if (Status display = prepareDisplay(); !display) {
    std::printf("%s\n", display.error().sentence().c_str());
    return 77;
  }
  QApplication application(argc, argv);
  QApplication::setApplicationName("trephine-bench");
  QStandardPaths::setTestModeEnabled(true);
  colours::applyTheme(application);
  MainWindow window("bench-sessions");
  window.resize(1280, 800);
  window.QMainWindow::show();
  window.show(Place::prepare);
  window.workstation().openImported(caseOf(std::make_shared<const Volume>(bench::head(size, Mat3(1.0)))));
  QElapsedTimer opening;
  opening.start();
  auto& histogram = *window.findChild<HistogramView*>("histogram");
  while (histogram.shares().all == 0 && opening.elapsed() < 120'000) settle(50);
  window.views().setLayout({ViewLayout::Kind::four, 0});
  settle(4000);
  std::printf("%d x %d x %d, four views in a window of 1280 x 800\n", size[0], size[1], size[2]);

  int frames = 0;
  double paint_ms = 0.0;
  QObject::connect(&window.view(), &ViewWidget::framePainted, &window.view(),
                   [&](double ms, bool) { ++frames, paint_ms = ms; });
  const auto untilFrame = [&](int before) {
    QElapsedTimer timer;
    timer.start();
    while (frames == before && timer.elapsed() < 5000) QApplication::processEvents();
    QApplication::processEvents();
  };
  std::vector<double> turns;
  const QPoint middle = window.view().rect().center();
  QTest::mousePress(&window.view(), Qt::RightButton, {}, middle);
  for (int n = 0; n < 40; ++n) {
    QElapsedTimer timer;
    timer.start();
    const int before = frames;
    QTest::mouseMove(&window.view(), middle + QPoint(n % 2 ? 3 : -3, n));
    untilFrame(before);
    turns.push_back(double(timer.nsecsElapsed()) * 1e-6);
  }
  QTest::mouseRelease(&window.view(), Qt::RightButton, {}, middle);
  print("a frame of the 3-D view while it is turned", turns);
  settle(2000);

  const TissueSet& set = window.workstation().exercise()->tissues;
  std::size_t bone = 0;
  for (std::size_t i = 0; i < set.tissues.size(); ++i) {
    if (set.tissues[i].id == "bone") bone = i;
  }
  const auto y = int(histogram.plot().center().y());
  const auto at = [&](double hu) { return QPoint(int(histogram.xOf(hu)), y); };
  const double from = set.tissues[bone].hu_min - 0.5;
  std::vector<double> steps, threeD;
  QTest::mousePress(&histogram, Qt::LeftButton, {}, at(from));
  SliceView& axial = window.views().slice(SliceAxis::axial);
  for (int n = 1; n <= 60; ++n) {
    QElapsedTimer timer;
    timer.start();
    const int frame = frames, drawn = axial.drawn();
    QTest::mouseMove(&histogram, at(from) + QPoint(n, 0));
    while (axial.drawn() == drawn && timer.elapsed() < 2000) QApplication::processEvents();
    steps.push_back(double(timer.nsecsElapsed()) * 1e-6);
    untilFrame(frame);
    threeD.push_back(double(timer.nsecsElapsed()) * 1e-6);
  }
  QTest::mouseRelease(&histogram, Qt::LeftButton, {}, at(from) + QPoint(60, 0));
  std::printf("bone from %d to %d HU\n", int(from + 0.5),
              window.workstation().exercise()->tissues.tissues[bone].hu_min);
  print("a step of a threshold: histogram and slices", steps);
  print("a step of a threshold: the 3-D view too", threeD);
  return 0;
}
