// How long the window's event loop is held when labels change under the 3-D view, on a CT of
// 512 x 512 x 300: another map, a structure that was grown, a stroke of the brush, another look.
// The longest gap of a timer of 5 ms, and when the picture was whole again. Needs a display.
#include <QApplication>
#include <QElapsedTimer>
#include <QEventLoop>
#include <QStandardPaths>
#include <QTimer>
#include <cstdio>
#include <functional>

#include "bench/head_volume.h"
#include "ui/common/colours.h"
#include "ui/frame/start_up.h"
#include "ui/views/four_up.h"

using namespace trephine;

namespace {

Tissue tissue(const char* id, int low, int high, std::optional<int> label, double opacity) {
  Tissue t;
  t.id = t.name = id;
  t.hu_min = low;
  t.hu_max = high;
  t.label = label;
  t.colour = labelColour(label.value_or(1));
  t.opacity = opacity;
  return t;
}

TissueSet tissues(int structures) {
  TissueSet set{"bench", {tissue("bone", 300, 3071, {}, 0.9)}};
  const char* names[] = {"one", "two", "three"};
  for (int n = 0; n < structures; ++n) {
    set.tissues.push_back(tissue(names[n], -32768, 32767, n + 1, 0.9));
  }
  return set;
}

VoxelBox ball(LabelMap& map, const Index3& at, double radius, int label) {
  VoxelBox box;
  const int reach = int(radius) + 1;
  for (std::size_t a = 0; a < 3; ++a) {
    box.low[a] = std::max(0, at[a] - reach);
    box.high[a] = std::min(map.geometry.size[a], at[a] + reach + 1);
  }
  for (int k = box.low[2]; k < box.high[2]; ++k) {
    for (int j = box.low[1]; j < box.high[1]; ++j) {
      for (int i = box.low[0]; i < box.high[0]; ++i) {
        const Vec3 off(i - at[0], j - at[1], k - at[2]);
        if (glm::length(off) < radius) {
          map.labels[map.geometry.indexOf(i, j, k)] = std::uint8_t(label);
        }
      }
    }
  }
  return box;
}

void during(FourUp& views, const char* what, const std::function<void()>& step) {
  QEventLoop loop;
  QElapsedTimer since, all;
  double longest_ms = 0.0, whole_ms = 0.0, longest_paint_ms = 0.0;
  QTimer timer;
  timer.setTimerType(Qt::PreciseTimer);
  QObject::connect(&timer, &QTimer::timeout, [&] {
    longest_ms = std::max(longest_ms, double(since.nsecsElapsed()) * 1e-6);
    since.start();
    if (all.elapsed() > 200 && views.threeD().isComplete()) {
      if (whole_ms == 0.0) whole_ms = double(all.elapsed());
      if (double(all.elapsed()) > whole_ms + 300.0) loop.quit();
    } else {
      whole_ms = 0.0;
    }
    if (all.elapsed() > 30000) loop.quit();
  });
  const auto painted = QObject::connect(&views.threeD(), &ViewWidget::framePainted, [&](double ms) {
    longest_paint_ms = std::max(longest_paint_ms, ms);
  });
  since.start();
  all.start();
  timer.start(5);
  QTimer::singleShot(0, &views, step);
  loop.exec();
  QObject::disconnect(painted);
  std::printf("  %-36s longest %7.1f ms, of a frame %7.1f; whole after %7.0f ms\n", what,
              longest_ms, longest_paint_ms, whole_ms);
}

}  // namespace

int main(int argc, char** argv) {
  if (!prepareDisplay()) return 77;
  QApplication application(argc, argv);
  QApplication::setApplicationName("trephine-bench");
  QStandardPaths::setTestModeEnabled(true);
  colours::applyTheme(application);
  FourUp views;
  views.resize(1000, 700);
  views.setLayout({ViewLayout::Kind::four, 0});
  views.show();
  const Volume volume = bench::head({512, 512, 300}, Mat3(1.0));
  auto map = std::make_shared<LabelMap>(
      LabelMap{volume.geometry, std::vector<std::uint8_t>(volume.hu.size())});
  ball(*map, {150, 250, 150}, 60.0, 1);
  during(views, "opened", [&] {
    views.threeD().setTissues(tissues(2));
    views.setTissues(tissues(2));
    views.showVolume(copyOf(volume), map);
    views.threeD().lookFromFront();
  });
  auto other = std::make_shared<LabelMap>(*map);
  ball(*other, {350, 250, 150}, 60.0, 2);
  during(views, "another map", [&] { views.showLabels(other); });
  VoxelBox box = ball(*other, {250, 350, 150}, 90.0, 3);
  during(views, "a structure of its own", [&] {
    views.threeD().setTissues(tissues(3));
    views.labelsChanged(box);
  });
  box = ball(*other, {250, 250, 150}, 8.0, 1);
  during(views, "a dab of the brush", [&] { views.labelsChanged(box); });
  during(views, "a structure's look", [&] {
    views.threeD().setTissues(tissues(3), {{"three", TissueLook::ghosted}});
  });
}
