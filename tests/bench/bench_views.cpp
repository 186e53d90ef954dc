// How long the window's event loop is held while a person looks at a case from all sides: the
// longest gap of a timer of 5 ms, and the event that took longest. Needs a display (xvfb-run).
//
//   bench_views [SCENE.json ...]     without one: a CT of 512 x 512 x 300
#include <QApplication>
#include <QElapsedTimer>
#include <QMetaEnum>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <QTimer>
#include <QWheelEvent>
#include <QtTest>
#include <cstdio>
#include <ctime>
#include <functional>

#include "bench/head_volume.h"
#include "ui/common/colours.h"
#include "ui/common/words.h"
#include "ui/frame/main_window.h"
#include "ui/frame/start_up.h"

using namespace trephine;

namespace {

// Of this thread or, with those that draw, of all: what a busy machine does not change.
double used_ms(clockid_t clock) {
  timespec at{};
  clock_gettime(clock, &at);
  return double(at.tv_sec) * 1e3 + double(at.tv_nsec) * 1e-6;
}

// Times each event that is not sent from within another.
class Application : public QApplication {
 public:
  using QApplication::QApplication;
  bool notify(QObject* receiver, QEvent* event) override {
    if (depth_ > 0) return QApplication::notify(receiver, event);
    const QString name = receiver->metaObject()->className() + QString(" ") +
                         QMetaEnum::fromType<QEvent::Type>().valueToKey(event->type());
    QElapsedTimer timer;
    timer.start();
    ++depth_;
    const bool taken = QApplication::notify(receiver, event);
    --depth_;
    const double ms = double(timer.nsecsElapsed()) * 1e-6;
    if (ms > longest_ms) {
      longest_ms = ms;
      longest = name;
    }
    return taken;
  }
  double longest_ms = 0.0;
  QString longest;

 private:
  int depth_ = 0;
};

class Stalls {
 public:
  explicit Stalls(Application& application) : application_(application) {
    timer_.setTimerType(Qt::PreciseTimer);
    timer_.setInterval(5);
    QObject::connect(&timer_, &QTimer::timeout, [this] { tick(); });
  }
  // Of the 3-D view.
  void painted(double ms) { painted_ms_ = std::max(painted_ms_, ms); }
  // Does the steps one by one, each by an event of its own, and prints what held the loop.
  void during(const char* what, int pause_ms, const std::vector<std::function<void()>>& steps) {
    longest_ = {};
    gaps_ms_.clear();
    application_.longest_ms = painted_ms_ = 0.0;
    since_.start();
    last_ = used();
    timer_.start();
    for (const auto& step : steps) {
      QTimer::singleShot(0, qApp, step);
      wait(pause_ms);
    }
    wait(300);
    timer_.stop();
    std::sort(gaps_ms_.begin(), gaps_ms_.end());
    std::printf(
        "  %-24s longest %6.1f ms (processor: %5.1f of its thread, %6.1f of all), p99 %6.1f; "
        "3-D picture %6.1f; event %6.1f %s\n",
        what, longest_.wall, longest_.thread, longest_.all, gaps_ms_[gaps_ms_.size() * 99 / 100],
        painted_ms_, application_.longest_ms, qPrintable(application_.longest));
  }
  static void wait(int ms) {
    QEventLoop loop;
    QTimer::singleShot(ms, &loop, &QEventLoop::quit);
    loop.exec();
  }

 private:
  struct Used {
    double wall = 0.0, thread = 0.0, all = 0.0;
  };
  Used used() const {
    return {double(since_.nsecsElapsed()) * 1e-6, used_ms(CLOCK_THREAD_CPUTIME_ID),
            used_ms(CLOCK_PROCESS_CPUTIME_ID)};
  }
  void tick() {
    const Used now = used();
    gaps_ms_.push_back(now.wall);
    if (now.wall > longest_.wall) {
      longest_ = {now.wall, now.thread - last_.thread, now.all - last_.all};
    }
    last_ = now;
    since_.start();
  }

  Application& application_;
  QTimer timer_;
  QElapsedTimer since_;
  Used last_, longest_;
  double painted_ms_ = 0.0;
  std::vector<double> gaps_ms_;
};

using Steps = std::vector<std::function<void()>>;
Steps times(int n, const std::function<void(int)>& step) {
  Steps steps;
  for (int i = 0; i < n; ++i) steps.push_back([=] { step(i); });
  return steps;
}

void wheel(QWidget& view, int eighths, Qt::KeyboardModifiers modifiers = {}) {
  const QPointF at = QRectF(view.rect()).center();
  QWheelEvent event(at, view.mapToGlobal(at), {}, {0, eighths}, Qt::NoButton, modifiers,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(&view, &event);
}
void mouse(QWidget& view, QEvent::Type type, const QPointF& at, Qt::MouseButton button) {
  const bool move = type == QEvent::MouseMove;
  QMouseEvent event(type, at, view.mapToGlobal(at), move ? Qt::NoButton : button,
                    type == QEvent::MouseButtonRelease ? Qt::NoButton : button, {});
  QApplication::sendEvent(&view, &event);
}
Steps drag(QWidget& view, const QPointF& from, const QPointF& by, Qt::MouseButton button) {
  Steps steps{[=, &view] { mouse(view, QEvent::MouseButtonPress, from, button); }};
  for (int i = 1; i <= 30; ++i) {
    steps.push_back([=, &view] { mouse(view, QEvent::MouseMove, from + by * i / 30.0, button); });
  }
  steps.push_back([=, &view] { mouse(view, QEvent::MouseButtonRelease, from + by, button); });
  return steps;
}

void look(MainWindow& window, Stalls& stalls) {
  FourUp& views = window.views();
  SliceView& axial = views.slice(SliceAxis::axial);
  const auto press = [](QWidget& view, Qt::Key key) {
    view.setFocus();
    QTest::keyClick(&view, key);
  };
  stalls.during("nothing", 100, times(5, [](int) {}));
  const auto actions = views.layoutActions();
  stalls.during("layouts by keys", 400, times(9, [&](int i) { actions[i % 3]->trigger(); }));
  views.setLayout({ViewLayout::Kind::four, 0});
  Stalls::wait(3000);
  for (SliceAxis axis : kSliceAxes) {
    SliceView& view = views.slice(axis);
    stalls.during(qPrintable("scrolling " + view.objectName()), 30,
                  times(60, [&](int i) { wheel(view, i < 30 ? -120 : 120); }));
  }
  for (int n = 0; n < FourUp::kViews; ++n) {
    QWidget& view = n == 0 ? static_cast<QWidget&>(views.threeD())
                           : views.slice(kSliceAxes[std::size_t(n - 1)]);
    stalls.during(qPrintable("double clicks in " + view.objectName()), 500, times(4, [&](int) {
                    mouse(view, QEvent::MouseButtonDblClick, {60, 90}, Qt::LeftButton);
                  }));
  }
  stalls.during("windows by keys", 100,
                times(10, [&](int i) { press(axial, Qt::Key(Qt::Key_1 + i % 5)); }));
  stalls.during("window by dragging", 20, drag(axial, {60, 90}, {60, 30}, Qt::LeftButton));
  const QPointF line = axial.fromPatient(views.point_mm()) + QPointF(0, 60);
  stalls.during("dragging a line", 20, drag(axial, line, {60, 0}, Qt::LeftButton));
  stalls.during("shifting a slice", 20, drag(axial, {60, 90}, {60, 30}, Qt::MiddleButton));
  stalls.during("zooming a slice", 30,
                times(30, [&](int i) { wheel(axial, i < 15 ? 120 : -120, Qt::ControlModifier); }));
  stalls.during("overlay by keys", 150, times(6, [&](int) { press(axial, Qt::Key_O); }));
  press(axial, Qt::Key_O);
  stalls.during("scrolling coloured", 30,
                times(60, [&](int i) { wheel(axial, i < 30 ? -120 : 120); }));
  auto* opacity = window.findChild<QSlider*>("sliceOpacity");
  stalls.during("opacity of the overlay", 30, times(20, [=](int i) { opacity->setValue(5 * i); }));
  for (const char* id : {"bone", "liver"}) {
    auto* box = window.findChild<QComboBox*>(QString("look:%1").arg(id));
    if (!box) continue;
    stalls.during(qPrintable(QString("looks of %1").arg(id)), 500, times(3, [=](int i) {
                    box->setCurrentIndex(i);
                    emit box->activated(i);
                  }));
  }
  for (int n = 0; n < 2; ++n) press(axial, Qt::Key_O);
  stalls.during("turning the 3-D view", 20,
                drag(views.threeD(), {60, 90}, {90, 20}, Qt::RightButton));
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  if (Status display = prepareDisplay(); !display) {
    std::printf("%s\n", display.error().sentence().c_str());
    return 77;
  }
  Application application(argc, argv);
  QApplication::setApplicationName("trephine-bench");
  QStandardPaths::setTestModeEnabled(true);
  colours::applyTheme(application);
  QTemporaryDir temporary;
  Stalls stalls(application);
  for (int n = 1; n < std::max(2, argc); ++n) {
    MainWindow window(toPath(temporary.path()));
    window.resize(1280, 800);
    window.show();
    Stalls::wait(1000);
    std::printf("%s\n", n < argc ? argv[n] : "512 x 512 x 300");
    if (n < argc) {
      window.workstation().openPath(toPath(argv[n]));
    } else {
      const auto volume = std::make_shared<const Volume>(bench::head({512, 512, 300}, Mat3(1.0)));
      window.workstation().openImported(caseOf(volume));
    }
    while (!window.workstation().currentCase()) Stalls::wait(100);
    QObject::connect(&window.view(), &ViewWidget::framePainted,
                     [&](double ms) { stalls.painted(ms); });
    Stalls::wait(4000);
    look(window, stalls);
  }
}
