// A headset through the real loader, with a runtime that is scripted to fail in every way that one
// can: what is shown, how it ends, and that nothing is left behind.
#include <gtest/gtest.h>

#include <QGuiApplication>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "headset/headset.h"
#include "headset/lens_profile.h"
#include "headset/packed_drawing.h"
#include "headset/picture_painter.h"
#include "headset/test_runtime.h"
#include "support.h"
//
#include "headset/openxr_functions.h"  // Xlib comes with it

namespace trephine {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

int entriesOf(const char* folder) {
  int count = 0;
  for ([[maybe_unused]] const auto& each : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

TestRuntime& runtime() {
  static TestRuntime* const loaded = [] {
    ::setenv("XR_RUNTIME_JSON", TREPHINE_XR_MANIFEST, 1);
    ::setenv("XR_LOADER_DEBUG", "none", 1);
    const auto found = loadTestRuntime(TREPHINE_XR_RUNTIME);
    return found ? *found : nullptr;
  }();
  return *loaded;
}

QGuiApplication& application() {
  static int count = 1;
  static char name[] = "test_openxr";
  static char* arguments[] = {name, nullptr};
  static QGuiApplication one(count, arguments);
  return one;
}

// A window's thread and context that draws each eye in a colour of its own, and whose panel is
// grey.
class OpenXr : public ::testing::Test {
 protected:
  OpenXr() {
    runtime().reset();
    runtime().setSize(96, 80);
    QSurfaceFormat format;
    format.setVersion(3, 2);
    format.setProfile(QSurfaceFormat::CoreProfile);
    context_.setFormat(format);
    EXPECT_TRUE(context_.create());
    surface_.setFormat(context_.format());
    surface_.create();
    EXPECT_TRUE(context_.makeCurrent(&surface_));
    QOpenGLExtraFunctions& f = gl();
    f.glGenTextures(1, &panel_texture_);
    f.glBindTexture(GL_TEXTURE_2D, panel_texture_);
    f.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 64, 40, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    f.glGenFramebuffers(1, &panel_.framebuffer);
    f.glBindFramebuffer(GL_FRAMEBUFFER, panel_.framebuffer);
    f.glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, panel_texture_,
                             0);
    fill(128, 128, 128);
    panel_.width = 64;
    panel_.height = 40;
    options_.patience_ms = 30;
  }
  ~OpenXr() override { finish(); }

  QOpenGLExtraFunctions& gl() { return *context_.extraFunctions(); }
  void fill(int red, int green, int blue) {
    gl().glClearColor(float(red) / 255.0F, float(green) / 255.0F, float(blue) / 255.0F, 1.0F);
    gl().glClear(GL_COLOR_BUFFER_BIT);
  }
  void start() {
    auto started = Headset::start(context_, options_, [this] { woken_ = true; });
    ASSERT_TRUE(started) << started.error().sentence();
    headset_ = *std::move(started);
    over_.reset();
  }
  void serve() {
    if (!headset_ || !woken_.exchange(false)) return;
    over_ = headset_->end();
    if (over_) return;
    const auto paint = [this](const EyeView& eye, unsigned int framebuffer, int, int) {
      gl().glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
      // How often pairs come is told by the true clock, so drawing takes its time of that.
      if (eye_takes_ > 0ms) std::this_thread::sleep_for(eye_takes_);
      const bool left = eye.sees.left < -0.9;
      left ? fill(200, 10, 30) : fill(20, 40, 250);
    };
    painter_.serve(headset_->pictures(), paint, panel_);
  }
  // The window does its part meanwhile.
  template <class Condition>
  bool until(const Condition& condition, std::chrono::seconds longest = 10s) {
    return test::waitUntil(
        [&] {
          serve();
          return condition();
        },
        longest);
  }
  // Of the headset's own, shown or not.
  bool passFrames(int count) {
    return until([last = runtime().frames() + count] { return runtime().frames() >= last; });
  }
  bool over() {
    serve();
    return over_.has_value();
  }
  // Until it is over and the window has let go of it.
  void finish() {
    if (!headset_) return;
    if (!over_) {
      headset_->stop();
      EXPECT_TRUE(until([this] { return over(); })) << "it does not end";
    }
    painter_.release(headset_->pictures());
    headset_.reset();
  }
  void expectNothingLeft(const std::string& after) {
    EXPECT_FALSE(runtime().alive().any()) << after;
    for (const std::string& what : runtime().violations()) ADD_FAILURE() << after << ": " << what;
  }
  int textures() {
    int count = 0;
    for (unsigned int name = 1; name < 2000; ++name) count += gl().glIsTexture(name) ? 1 : 0;
    return count;
  }

  QGuiApplication& application_ = application();  // before all of Qt's
  QOpenGLContext context_;
  QOffscreenSurface surface_;
  unsigned int panel_texture_ = 0;
  PicturePainter::Panel panel_;
  PicturePainter painter_;
  HeadsetOptions options_;
  std::chrono::milliseconds eye_takes_{0};
  std::unique_ptr<Headset> headset_;
  std::optional<HeadsetEnd> over_;
  std::atomic<bool> woken_{false};
};

TEST_F(OpenXr, EachEyeShowsItsPictureByteForByteWithThePoseThatItWasDrawnFor) {
  const Pose head{{0.1, 1.2, -0.3}, glm::angleAxis(0.3, glm::normalize(Vec3(1, 2, 0)))};
  const FieldOfView left{-1.0, 0.7, -0.8, 0.9}, right{-0.7, 1.0, -0.8, 0.9};
  runtime().setHead(head);
  runtime().setEyes(0.064, left, right);
  start();
  ASSERT_TRUE(until([] { return runtime().framesWithEyes() > 3; }));
  for (const int eye : {0, 1}) {
    const TestRuntime::Shown shown = runtime().shown(eye);
    ASSERT_EQ(shown.rgba.size(), 96u * 80u * 4u);
    const std::array<int, 3> colour =
        eye == 0 ? std::array<int, 3>{200, 10, 30} : std::array<int, 3>{20, 40, 250};
    for (const std::size_t pixel : {0u, 96u * 80u / 2u, 96u * 80u - 1u}) {
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(shown.rgba[4 * pixel + c], colour[c]);
    }
    const Vec3 at = head.position + head.orientation * Vec3(eye == 0 ? -0.032 : 0.032, 0, 0);
    EXPECT_LT(glm::distance(shown.view.pose.position, at), 1e-6);
    EXPECT_NEAR(shown.view.sees.left, (eye == 0 ? left : right).left, 1e-5);
    EXPECT_NEAR(shown.view.sees.up, 0.9, 1e-5);
  }
  const HeadsetState state = headset_->state();
  EXPECT_TRUE(state.seen);
  EXPECT_FALSE(state.flat);
  EXPECT_GT(state.fresh, 2u);
  finish();
  expectNothingLeft("the end");
}

TEST_F(OpenXr, FiftyTimesOnAndOffLeaveNothing) {
  start();
  ASSERT_TRUE(until([] { return runtime().framesWithEyes() > 1; }));
  finish();
  const int textures_before = textures(), threads = entriesOf("/proc/self/task"),
            descriptors = entriesOf("/proc/self/fd");
  for (int i = 0; i < 50; ++i) {
    runtime().reset();
    runtime().setSize(96, 80);
    start();
    ASSERT_TRUE(until([] { return runtime().framesWithEyes() > 1; })) << i;
    finish();
    ASSERT_TRUE(over_->why.ok()) << over_->why.error().sentence();
    expectNothingLeft("toggle " + std::to_string(i));
  }
  EXPECT_EQ(textures(), textures_before);
  EXPECT_LE(entriesOf("/proc/self/task"), threads);
  EXPECT_LE(entriesOf("/proc/self/fd"), descriptors);
}

TEST_F(OpenXr, ALossIsNoticedAndCleanedUpAndItCanBeTriedAgain) {
  using Loss = TestRuntime::Loss;
  for (const Loss loss :
       {Loss::instance, Loss::session, Loss::pending, Loss::event, Loss::event, Loss::event}) {
    start();
    const int before = runtime().framesWithEyes();
    ASSERT_TRUE(until([&] { return runtime().framesWithEyes() > before + 2; }));
    const auto at = Clock::now();
    runtime().lose(loss);
    ASSERT_TRUE(until([this] { return over(); })) << int(loss);
    EXPECT_LT(msSince(at), 5000.0) << int(loss);
    ASSERT_FALSE(over_->why.ok());
    EXPECT_TRUE(over_->again) << over_->why.error().sentence();
    EXPECT_NE(over_->why.error().next.find("goes on"), std::string::npos)
        << over_->why.error().sentence();
    finish();
    expectNothingLeft("loss " + std::to_string(int(loss)));
  }
}

TEST_F(OpenXr, AFailureInEachCallEndsInWordsOrGoesOnAndLeavesNothing) {
  options_.patience_ms = 5;
  for (const std::string& function : runtime().functions()) {
    for (const int result : {-1, -2, -13, -17}) {
      for (const int after : {0, 1, 5}) {
        runtime().reset();
        runtime().setSize(16, 16);
        runtime().setReadBack(false);
        runtime().setPeriod(2.0);
        runtime().fail(function, result, after, -1);
        start();
        until([&] { return over() || runtime().framesWithEyes() > 8; }, 4s);
        finish();
        const std::string what = function + " " + std::to_string(result);
        if (!over_->why.ok()) {
          EXPECT_FALSE(over_->why.error().next.empty()) << what;
        }
        runtime().fail("", 0, 0, 0);
        EXPECT_FALSE(runtime().alive().any()) << what << " after " << after;
        EXPECT_TRUE(runtime().violations().empty())
            << what << ": " << runtime().violations().front();
      }
    }
  }
}

TEST_F(OpenXr, OneThatHangsHoldsUpNobodyAndIsCleanedUpWhenItComesBack) {
  start();
  ASSERT_TRUE(until([] { return runtime().framesWithEyes() > 2; }));
  runtime().hang(2.0);
  const auto at = Clock::now();
  ASSERT_TRUE(until([this] { return headset_->stuck_s() > 0.5; }, 3s));
  headset_->stop();
  EXPECT_LT(msSince(at), 1900.0) << "nobody waits for it";
  EXPECT_FALSE(over());
  ASSERT_TRUE(until([this] { return over(); }));
  finish();
  expectNothingLeft("the hang");
}

TEST_F(OpenXr, PicturesThatComeTooSlowlyGiveWayToAScreenThatStandsStillAndComeBack) {
  eye_takes_ = 30ms;  // for each
  start();
  ASSERT_TRUE(until([this] { return headset_->state().flat; }, 15s));
  const auto screen = runtime().screen();
  ASSERT_TRUE(screen.has_value());
  EXPECT_NEAR(glm::length(screen->pose_m.position), 2.0, 1e-3) << "two metres off";
  EXPECT_EQ(int(screen->rgba[0]), 128) << "the panel's picture";
  EXPECT_NEAR(screen->height_m / screen->width_m, 40.0 / 64.0, 1e-6);
  // The head moves, the screen does not.
  for (int i = 0; i < 20; ++i) {
    runtime().setHead({{0.02 * i, 0.01 * i, 0.0}, glm::angleAxis(0.05 * i, Vec3(0, 1, 0))});
    ASSERT_TRUE(passFrames(2));
    const auto now = runtime().screen();
    ASSERT_TRUE(now.has_value());
    EXPECT_EQ(now->pose_m.position, screen->pose_m.position);
    EXPECT_EQ(now->pose_m.orientation, screen->pose_m.orientation);
  }
  runtime().setReadBack(false);
  const auto from = Clock::now();
  ASSERT_TRUE(passFrames(11));
  EXPECT_LT(msSince(from), 500.0) << "at the headset's own rate";
  eye_takes_ = 0ms;
  EXPECT_TRUE(until([this] { return !headset_->state().flat; }, 15s));
  EXPECT_FALSE(runtime().screen().has_value());
  // What the flat screen had keeps no pair from being drawn.
  eye_takes_ = 5ms;
  EXPECT_TRUE(until([this] { return headset_->state().pairs_hz > 50.0; }));
  EXPECT_FALSE(headset_->state().flat);
}

TEST_F(OpenXr, APairThatComesLateIsShownOnceMoreAndThenStandsInTheRoom) {
  options_.pace.least_hz = 0.0;
  options_.patience_ms = 4;
  start();
  std::atomic<bool> moving{true};
  std::thread head([&] {
    int i = 0;
    test::waitUntil([&] {
      runtime().setHead({{0.0003 * ++i, 0.0, 0.0}, Quat(1, 0, 0, 0)});
      return !moving;
    });
  });
  ASSERT_TRUE(until([] { return runtime().framesWithEyes() > 5; }));
  const int held = runtime().framesHeld();
  // The window does something else.
  EXPECT_TRUE(test::waitUntil([&] { return runtime().framesHeld() - held > 8; }, 2s));
  EXPECT_TRUE(until([&] { return headset_->state().held >= 8; }));
  const int fresh = runtime().framesWithEyes();
  EXPECT_TRUE(until([&] { return runtime().framesWithEyes() > fresh + 3; }));
  moving = false;
  head.join();
  EXPECT_LE(runtime().mostRepeats(), 1);
}

// Each pixel of a ramp says where it was taken from.
TEST_F(OpenXr, TwoPicturesOnOneScreenLieWhereTheLensPutsThem) {
  constexpr int kWide = 256, kHigh = 128;
  std::vector<std::uint8_t> ramp;
  for (int y = 0; y < kHigh; ++y) {
    for (int x = 0; x < kWide; ++x) {
      // Across in red and blue, upwards in green.
      for (const int value : {x, 2 * y, x, 255}) ramp.push_back(std::uint8_t(value));
    }
  }
  std::array<unsigned int, 3> textures{};
  gl().glGenTextures(3, textures.data());
  for (std::size_t i = 0; i < 3; ++i) {
    gl().glBindTexture(GL_TEXTURE_2D, textures[i]);
    gl().glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, i == 2 ? 2 * kWide : kWide, kHigh, 0, GL_RGBA,
                      GL_UNSIGNED_BYTE, i == 2 ? nullptr : ramp.data());
    gl().glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl().glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
  unsigned int framebuffer = 0;
  gl().glGenFramebuffers(1, &framebuffer);
  gl().glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl().glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[2], 0);
  LensProfile lens;
  lens.k = {0.15, 0.05, 0.0};
  lens.colour = {1.02, 1.0, 0.97};
  lens.axis = 0.1;
  PackedDrawing drawing;
  for (const LensProfile& each : {LensProfile{}, lens}) {
    ASSERT_TRUE(drawing.draw({textures[0], textures[1]}, Packing::full, each, 2 * kWide, kHigh));
    std::vector<std::uint8_t> seen(std::size_t(2 * kWide) * kHigh * 4);
    gl().glReadPixels(0, 0, 2 * kWide, kHigh, GL_RGBA, GL_UNSIGNED_BYTE, seen.data());
    int compared = 0, black = 0;
    for (std::size_t eye = 0; eye < 2; ++eye) {
      for (int y = 3; y < kHigh; y += 7) {
        for (int x = 3; x < kWide; x += 7) {
          const glm::dvec2 at((x + 0.5 - 0.5 * kWide) / (0.5 * kHigh),
                              (y + 0.5) / (0.5 * kHigh) - 1);
          for (const int colour : {0, 1, 2}) {
            const glm::dvec2 from = lensSource(each, eye, colour, at);
            const double across = (from.x * 0.5 * kHigh) + 0.5 * kWide - 0.5;
            const double up = (from.y + 1.0) * 0.5 * kHigh - 0.5;
            const std::size_t pixel = std::size_t(y) * 2 * kWide + eye * kWide + std::size_t(x);
            const double value = seen[4 * pixel + std::size_t(colour)];
            const bool inside =
                across > -0.4 && across < kWide - 0.6 && up > -0.4 && up < kHigh - 0.6;
            const bool outside =
                across < -0.6 || across > kWide - 0.4 || up < -0.6 || up > kHigh - 0.4;
            if (outside) {
              EXPECT_EQ(value, 0.0);
              ++black;
            }
            if (!inside) continue;
            const double expected = colour == 1 ? 2.0 * std::clamp(up, 0.0, kHigh - 1.0)
                                                : std::clamp(across, 0.0, kWide - 1.0);
            EXPECT_NEAR(value, expected, 1.6) << x << ' ' << y << ' ' << colour;
            ++compared;
          }
        }
      }
    }
    EXPECT_GT(compared, 2000);
    EXPECT_EQ(black > 0, each.k[0] > 0.0);
  }
  drawing.release();
  gl().glDeleteFramebuffers(1, &framebuffer);
  gl().glDeleteTextures(3, textures.data());
}

TEST_F(OpenXr, OneThatIsTakenOffSaysSoAndGoesOnWhenItIsPutOnAgain) {
  start();
  ASSERT_TRUE(until([this] { return headset_->state().seen; }));
  runtime().setWorn(false);
  ASSERT_TRUE(until([this] { return !headset_->state().seen; }));
  const int before = runtime().framesWithEyes();
  ASSERT_TRUE(passFrames(120));  // more than half of the time by which pairs are counted
  EXPECT_EQ(runtime().framesWithEyes(), before) << "nobody sees it";
  EXPECT_FALSE(over());
  runtime().setWorn(true);
  EXPECT_TRUE(until([&] { return runtime().framesWithEyes() > before + 100; }));
  EXPECT_FALSE(headset_->state().flat) << "that nobody looked was not slow";
}

// What a machine may lack, where the environment takes it away (CMakeLists.txt).
class Lacks : public ::testing::Test {
 protected:
  std::string refusal(const char* wanted) {
    const char* lacks = std::getenv("TREPHINE_LACKS");
    if (!lacks || lacks != std::string(wanted)) return "skip";
    application();
    QOpenGLContext context;
    EXPECT_TRUE(context.create());
    const auto started = Headset::start(context, {}, [] {});
    EXPECT_FALSE(started);
    return started ? "" : started.error().code.str() + ": " + started.error().sentence();
  }
};

TEST_F(Lacks, Glx) {
  const std::string said = refusal("glx");
  if (said == "skip") GTEST_SKIP();
  EXPECT_EQ(said.find("NO_GLX"), 0u) << said;
  EXPECT_NE(said.find("QT_QPA_PLATFORM=xcb"), std::string::npos) << said;
}

TEST_F(Lacks, Loader) {
  const std::string said = refusal("loader");
  if (said == "skip") GTEST_SKIP();
  EXPECT_EQ(said.find("NO_LOADER"), 0u) << said;
  EXPECT_NE(said.find("libopenxr-loader1"), std::string::npos) << said;
  // Installed, it is found the next time, without another start.
  const std::filesystem::path folder = std::getenv("LD_LIBRARY_PATH");
  std::filesystem::rename(folder / "libopenxr_loader.so.1", folder / "away");
  const Result<const trephine::OpenXr*> found = trephine::OpenXr::load();
  std::filesystem::rename(folder / "away", folder / "libopenxr_loader.so.1");
  EXPECT_TRUE(found);
}

TEST_F(OpenXr, WhatIsNotThereIsSaidInWords) {
  runtime().setPluggedIn(false);
  start();
  ASSERT_TRUE(until([this] { return over(); }));
  EXPECT_EQ(over_->why.error().code.str(), "NO_HEADSET");
  EXPECT_TRUE(over_->again);
  finish();
  runtime().reset();
  ::setenv("XR_RUNTIME_JSON", "/nowhere/runtime.json", 1);
  start();
  ASSERT_TRUE(until([this] { return over(); }));
  EXPECT_EQ(over_->why.error().code.str(), "NO_RUNTIME") << over_->why.error().sentence();
  EXPECT_EQ(over_->why.error().where, "/nowhere/runtime.json") << "it was named, and is broken";
  finish();
  ::unsetenv("XR_RUNTIME_JSON");
  start();
  ASSERT_TRUE(until([this] { return over(); }));
  EXPECT_EQ(over_->why.error().what.rfind("No OpenXR runtime is active", 0), 0u)
      << over_->why.error().sentence();
  finish();
  ::setenv("XR_RUNTIME_JSON", TREPHINE_XR_MANIFEST, 1);
  expectNothingLeft("nothing was there");
}

}  // namespace
}  // namespace trephine
