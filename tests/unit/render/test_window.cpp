// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
#include <chrono>
#include <memory>
#include <vector>

#include "scenes.h"

using namespace trephine;
using namespace trephine::test;

namespace {

// What a window would show.
class Screen {
 public:
  Screen() {
    glGenFramebuffers(1, &framebuffer_);
    glGenRenderbuffers(1, &colour_);
    glBindRenderbuffer(GL_RENDERBUFFER, colour_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, kWidth, kHeight);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  }
  ~Screen() {
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteRenderbuffers(1, &colour_);
  }
  unsigned int id() const { return framebuffer_; }

  Picture read() const {
    std::vector<std::uint8_t> up(std::size_t(kWidth) * kHeight * 3);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, up.data());
    Picture picture{kWidth, kHeight, {}};
    for (int y = kHeight - 1; y >= 0; --y) {
      const auto row = up.begin() + std::ptrdiff_t(y) * kWidth * 3;
      picture.rgb.insert(picture.rgb.end(), row, row + kWidth * 3);
    }
    return picture;
  }

 private:
  unsigned int framebuffer_ = 0;
  unsigned int colour_ = 0;
};

// The ball in a renderer that draws in a context that is lent to it, as a window's is.
class Window : public testing::Test {
 protected:
  void SetUp() override {
    auto made = offscreenIfDisplay();
    if (!made) GTEST_SKIP() << "No display: this test draws and reads pixels";
    ASSERT_TRUE(made->ok()) << made->error().sentence();
    lender_ = std::move(**made);
    lender_->setTissues(tissues(0.1));
    lender_->setVolume(grid_);
    of_hidden_window_ = lender_->picture();  // leaves its context current
    hosted_.setTissues(tissues(0.1));
    hosted_.resize(kWidth, kHeight);
    hosted_.setVolume(grid_);
    attach();
    screen_ = std::make_unique<Screen>();
  }
  void attach() {
    const Status attached = hosted_.attach({[] { return true; }, [] {}});
    ASSERT_TRUE(attached.ok()) << attached.error().sentence();
  }
  void TearDown() override {
    screen_.reset();
    hosted_.detach();
  }

  std::unique_ptr<SceneRenderer> lender_;
  Grid grid_{ball()};
  Picture of_hidden_window_;
  SceneRenderer hosted_;
  std::unique_ptr<Screen> screen_;
};

constexpr double kTiny_ms = 1e-3;  // less than any picture takes

// How often it had to be asked until the picture was complete.
int finish(SceneRenderer& renderer, unsigned int screen) {
  int asked = 1;
  while (renderer.warmUp()) {
  }
  while (!renderer.paint(screen, kTiny_ms)) ++asked;
  return asked;
}

ToolView needle(const Vec3& tip) {
  ToolView tool;
  tool.length_mm = 20.0;
  tool.colour = Vec3(0, 0, 1);
  tool.pose_mm.position = tip;
  return tool;
}

}  // namespace

TEST_F(Window, AWindowsContextShowsWhatTheHiddenWindowShows) {
  EXPECT_NE(hosted_.openGlDescription(), "none");
  hosted_.paint(0);
  EXPECT_EQ(hosted_.picture(), of_hidden_window_);
  hosted_.detach();
  EXPECT_TRUE(hosted_.picture().rgb.empty());
  attach();
  EXPECT_EQ(hosted_.picture(), of_hidden_window_);
}

// Qt leaves rows padded to four bytes; a volume's are not.
TEST_F(Window, AnOddRowOfVoxelsIsSentAsItLies) {
  const Volume even = ball();
  Volume odd;
  odd.geometry = even.geometry;
  --odd.geometry.size[0];
  for (std::size_t n = 0; n < even.hu.size(); ++n) {
    if (n % 64 != 63) odd.hu.push_back(even.hu[n]);  // air at the ball's side
  }
  hosted_.setVolume(Grid(odd));
  hosted_.lookAt(Vec3(0), hosted_.viewForward(), hosted_.viewUp(), 150.0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  const Picture of_odd = hosted_.picture();
  hosted_.setVolume(grid_);
  hosted_.lookAt(Vec3(0), hosted_.viewForward(), hosted_.viewUp(), 150.0);
  EXPECT_GE(psnr_dB(of_odd, hosted_.picture()), 40.0);
}

TEST_F(Window, StripsAddUpToTheWholePictureAndStartAnewAfterAChange) {
  hosted_.setSampleDistance(0.03);  // so that a picture takes longer than a moving one may
  EXPECT_EQ(hosted_.shareOfRays(), 0.0);
  EXPECT_TRUE(hosted_.paint(screen_->id()));
  EXPECT_EQ(hosted_.shareOfRays(), 1.0);
  const Picture whole = screen_->read();
  EXPECT_EQ(whole, hosted_.picture());
  EXPECT_EQ(finish(hosted_, screen_->id()), 1);  // nothing changed: what is there is shown again
  EXPECT_EQ(screen_->read(), whole);

  hosted_.orbit(20, 0);
  EXPECT_FALSE(hosted_.paint(screen_->id(), kTiny_ms));
  EXPECT_LT(hosted_.shareOfRays(), 1.0);
  const Picture coarse = screen_->read();
  EXPECT_FALSE(hosted_.paint(screen_->id(), kTiny_ms));
  EXPECT_EQ(screen_->read(), coarse) << "a finer picture is shown when it is whole";
  hosted_.orbit(-20, 0);
  EXPECT_GT(finish(hosted_, screen_->id()), 5);
  EXPECT_GE(psnr_dB(screen_->read(), whole), 60.0);  // the camera came back but for rounding
}

TEST_F(Window, AToolMovesOverThePictureOfTheVolumeWithoutANewOne) {
  hosted_.setSampleDistance(0.03);  // so that a picture takes longer than a moving one may
  hosted_.paint(screen_->id());
  const Picture without = screen_->read();
  hosted_.setTools({needle(Vec3(0, -40, 0))});
  EXPECT_TRUE(hosted_.paint(screen_->id(), kTiny_ms)) << "no ray is cast";
  EXPECT_EQ(screen_->read(), without) << "its shader is not made amid a frame";
  EXPECT_TRUE(hosted_.cold());
  EXPECT_TRUE(hosted_.warmUp());
  EXPECT_FALSE(hosted_.warmUp());
  EXPECT_TRUE(hosted_.paint(screen_->id(), kTiny_ms)) << "no ray is cast";
  const Picture with = screen_->read();
  const Difference seen = difference(without, with);
  EXPECT_GT(seen.pixels, 50);
  EXPECT_EQ(with, hosted_.picture());

  // While a finer picture is made.
  hosted_.orbit(15, 0);
  hosted_.paint(screen_->id(), kTiny_ms);
  ASSERT_FALSE(hosted_.complete());
  const Picture before = screen_->read();
  hosted_.setTools({needle(Vec3(0, -40, 10))});
  EXPECT_FALSE(hosted_.paint(screen_->id(), kTiny_ms));
  EXPECT_GT(difference(before, screen_->read()).pixels, 50);
  hosted_.setTools({});
  hosted_.orbit(-15, 0);
  finish(hosted_, screen_->id());
  EXPECT_GE(psnr_dB(screen_->read(), without), 60.0);
}

TEST_F(Window, ACutIsSeenAtOnceWithFewerRaysAndAsFineAsTheRestWhenCutsPause) {
  hosted_.setSampleDistance(0.03);
  hosted_.paint(screen_->id());
  const Picture before = screen_->read();
  carve(grid_, Vec3(-5, -24, 0), 6.0);
  ASSERT_TRUE(hosted_.pullChanges(grid_));
  EXPECT_FALSE(hosted_.paint(screen_->id(), kTiny_ms));
  const Picture sketched = screen_->read();
  EXPECT_LT(hosted_.shareOfRays(), 1.0);
  // Beside it all is as it was.
  const Difference seen = difference(before, sketched);
  EXPECT_GT(seen.pixels, 50);
  EXPECT_LT(seen.pixels, kWidth * kHeight / 3);
  // While cuts may follow, a seventh of a second, it stays. On a machine that is busy otherwise one
  // cut may be that old by the next frame.
  for (int turn = 0, in_time = 0; turn < 20 && in_time == 0; ++turn) {
    const auto cut = std::chrono::steady_clock::now();
    carve(grid_, Vec3(-5, -24, 0.05 * (turn + 1)), 6.0);
    ASSERT_TRUE(hosted_.pullChanges(grid_));
    hosted_.paint(screen_->id(), kTiny_ms);
    const Picture first = screen_->read();
    hosted_.paint(screen_->id(), kTiny_ms);
    if (std::chrono::steady_clock::now() - cut > std::chrono::milliseconds(140)) continue;
    EXPECT_EQ(screen_->read(), first);
    ++in_time;
  }
  finish(hosted_, screen_->id());
  EXPECT_EQ(hosted_.shareOfRays(), 1.0);
  const Picture fine = screen_->read();
  const double near_dB = psnr_dB(sketched, fine), far_dB = psnr_dB(before, fine);
  EXPECT_GT(near_dB, far_dB + 3.0) << near_dB << " and " << far_dB;
}

TEST_F(Window, ACutDoesNotComeBackWithAFinerPictureThatWasBegunBeforeIt) {
  hosted_.setSampleDistance(0.03);
  hosted_.paint(screen_->id());
  hosted_.orbit(10, 0);
  for (int strip = 0; strip < 6; ++strip) hosted_.paint(screen_->id(), kTiny_ms);
  const double coarse = hosted_.shareOfRays();
  ASSERT_LT(coarse, 1.0);
  carve(grid_, Vec3(0, -24, 9), 6.0);  // where the rays of the finer picture are cast by now
  ASSERT_TRUE(hosted_.pullChanges(grid_));
  hosted_.paint(screen_->id(), kTiny_ms);
  ASSERT_LE(hosted_.shareOfRays(), coarse);
  Picture last = screen_->read();
  while (!hosted_.complete()) {
    const Picture now = (hosted_.paint(screen_->id(), kTiny_ms), screen_->read());
    EXPECT_GT(psnr_dB(last, now), 22.0);
    last = now;
  }
  hosted_.setShading({});
  hosted_.paint(screen_->id());
  EXPECT_EQ(screen_->read(), last);
}

TEST_F(Window, ACutMendsItsPartOfAPictureThatIsWhole) {
  hosted_.setSampleDistance(0.03);  // so that a picture takes longer than a moving one may
  hosted_.paint(screen_->id());
  carve(grid_, Vec3(-5, -24, 0), 6.0);
  ASSERT_TRUE(hosted_.pullChanges(grid_));
  finish(hosted_, screen_->id());
  EXPECT_EQ(hosted_.shareOfRays(), 1.0);
  const Picture mended = screen_->read();
  hosted_.setShading({});  // starts anew
  hosted_.paint(screen_->id());
  EXPECT_EQ(screen_->read(), mended);
  // A second one, while a picture is on its way, is in that one too.
  hosted_.orbit(10, 0);
  for (int strip = 0; strip < 3; ++strip) hosted_.paint(screen_->id(), kTiny_ms);
  ASSERT_FALSE(hosted_.complete());
  carve(grid_, Vec3(6, -24, 8), 6.0);
  ASSERT_TRUE(hosted_.pullChanges(grid_));
  finish(hosted_, screen_->id());
  const Picture late = screen_->read();
  hosted_.setShading({});
  hosted_.paint(screen_->id());
  EXPECT_EQ(screen_->read(), late);
}
