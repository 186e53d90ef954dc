// Scrolling through a CT of 512 x 512 x 300 in four views of one size: pictures a second of the
// view that is scrolled, and the longest that the event loop was held. Needs a display (xvfb-run).
//
//   bench_slices [COLUMNS ROWS SLICES]
#include <sys/resource.h>

#include <QApplication>
#include <QElapsedTimer>
#include <QStandardPaths>
#include <QWheelEvent>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "bench/head_volume.h"
#include "ui/common/colours.h"
#include "ui/frame/start_up.h"
#include "ui/views/four_up.h"

using namespace trephine;

namespace {

// Of all threads of this process: what a busy machine does not change.
double processor_ms() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto ms = [](const timeval& t) {
    return double(t.tv_sec) * 1e3 + double(t.tv_usec) * 1e-3;
  };
  return ms(used.ru_utime) + ms(used.ru_stime);
}

// What one slice after another takes, from the turn of the wheel to the end of the window's frame.
void scroll(FourUp& views, SliceAxis axis, const char* what) {
  SliceView& view = views.slice(axis);
  view.setFocus();
  view.setSlice(0);
  for (int i = 0; i < 5; ++i) QApplication::processEvents();
  std::vector<double> ms;
  const int drawn = view.drawn();
  const double processor_before_ms = processor_ms();
  QElapsedTimer all;
  all.start();
  for (int k = 1; k < std::min(view.slices(), 200); ++k) {
    QElapsedTimer timer;
    timer.start();
    const QPointF at = QRectF(view.rect()).center();
    QWheelEvent event(at, view.mapToGlobal(at), {}, {0, -120}, Qt::NoButton, Qt::NoModifier,
                      Qt::NoScrollPhase, false);
    QApplication::sendEvent(&view, &event);
    const int before = view.drawn();
    while (view.drawn() == before && timer.elapsed() < 1000) QApplication::processEvents();
    QApplication::processEvents();  // the window's buffer to the screen
    ms.push_back(double(timer.nsecsElapsed()) * 1e-6);
  }
  const double seconds = double(all.nsecsElapsed()) * 1e-9;
  const int pictures = view.drawn() - drawn;
  std::sort(ms.begin(), ms.end());
  std::printf(
      "%-24s %4d x %4d pixels: %6.1f pictures/s, median %5.1f ms, p99 %5.1f, longest %5.1f; "
      "%5.1f ms of processor a picture\n",
      what, view.width(), view.height(), pictures / seconds, ms[ms.size() / 2],
      ms[ms.size() * 99 / 100], ms.back(), (processor_ms() - processor_before_ms) / pictures);
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
  FourUp views;
  views.resize(1280, 800);
  views.setLayout({ViewLayout::Kind::four, 0});
  views.show();
  Tissue bone;
  bone.id = "bone";
  bone.hu_min = 300;
  bone.hu_max = 3000;
  bone.opacity = 0.8;
  const TissueSet tissues{"bench", {bone}};
  views.setTissues(tissues);
  views.threeD().setTissues(tissues);
  const Mat3 oblique(glm::rotate(Mat4(1.0), 0.3, glm::normalize(Vec3(1, 0.4, -0.2))));
  for (const auto& [direction, name] :
       {std::pair{Mat3(1.0), "along the patient"}, {oblique, "oblique"}}) {
    views.showVolume(bench::head(size, direction), nullptr);
    QElapsedTimer settle;
    settle.start();
    while (settle.elapsed() < 4000) QApplication::processEvents(QEventLoop::WaitForMoreEvents, 50);
    std::printf("%d x %d x %d, %s\n", size[0], size[1], size[2], name);
    scroll(views, SliceAxis::axial, "axial");
    scroll(views, SliceAxis::coronal, "coronal");
    scroll(views, SliceAxis::sagittal, "sagittal");
    QKeyEvent overlay(QEvent::KeyPress, Qt::Key_O, Qt::NoModifier);
    QApplication::sendEvent(&views.slice(SliceAxis::axial), &overlay);
    scroll(views, SliceAxis::axial, "axial, tissues coloured");
    for (int i = 0; i < 2; ++i) {
      QKeyEvent again(QEvent::KeyPress, Qt::Key_O, Qt::NoModifier);
      QApplication::sendEvent(&views.slice(SliceAxis::axial), &again);
    }
  }
}
