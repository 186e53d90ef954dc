// VTK renamed its loader of OpenGL in 9.4. Before any other header that knows OpenGL.
#if __has_include(<vtk_glad.h>)
#include <vtk_glad.h>
#else
#include <vtk_glew.h>
#endif
//
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

}  // namespace

TEST(Window, AWindowsContextShowsWhatTheHiddenWindowShows) {
  RENDERER_OR_SKIP(lender);
  lender.setTissues(tissues(0.1));
  lender.setVolume(Grid(ball()));
  const Picture expected = lender.picture();  // leaves the lender's context current

  SceneRenderer hosted;
  hosted.setTissues(tissues(0.1));
  hosted.resize(kWidth, kHeight);
  hosted.setVolume(Grid(ball()));
  const Status attached = hosted.attach({[] { return true; }, [] {}});
  ASSERT_TRUE(attached.ok()) << attached.error().sentence();
  EXPECT_NE(hosted.openGlDescription(), "none");
  hosted.paint(0);
  EXPECT_EQ(hosted.picture(), expected);
  hosted.detach();
  EXPECT_TRUE(hosted.picture().rgb.empty());
  ASSERT_TRUE(hosted.attach({[] { return true; }, [] {}}).ok());
  EXPECT_EQ(hosted.picture(), expected);
  hosted.detach();
}

namespace {

constexpr double kTiny_ms = 1e-3;  // less than any picture takes

// How often it had to be asked until the picture was complete.
int finish(SceneRenderer& renderer, unsigned int screen) {
  int asked = 1;
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

TEST(Window, StripsAddUpToTheWholePictureAndStartAnewAfterAChange) {
  RENDERER_OR_SKIP(lender);
  lender.picture();  // leaves the lender's context current
  SceneRenderer hosted;
  hosted.resize(kWidth, kHeight);
  hosted.setSampleDistance(0.05);  // so that a picture takes longer than a moving one may
  hosted.setTissues(tissues(0.1));
  hosted.setVolume(Grid(ball()));
  ASSERT_TRUE(hosted.attach({[] { return true; }, [] {}}).ok());
  {
    const Screen screen;
    EXPECT_EQ(hosted.shareOfRays(), 0.0);
    EXPECT_TRUE(hosted.paint(screen.id()));
    EXPECT_EQ(hosted.shareOfRays(), 1.0);
    const Picture whole = screen.read();
    EXPECT_EQ(whole, hosted.picture());
    EXPECT_EQ(finish(hosted, screen.id()), 1);  // nothing changed: what is there is shown again
    EXPECT_EQ(screen.read(), whole);

    hosted.orbit(20, 0);
    EXPECT_FALSE(hosted.paint(screen.id(), kTiny_ms));
    EXPECT_LT(hosted.shareOfRays(), 1.0);
    const Picture coarse = screen.read();
    EXPECT_FALSE(hosted.paint(screen.id(), kTiny_ms));
    EXPECT_EQ(screen.read(), coarse) << "a finer picture is shown when it is whole";
    hosted.orbit(-20, 0);
    EXPECT_GT(finish(hosted, screen.id()), 5);
    EXPECT_GE(psnr_dB(screen.read(), whole), 60.0);  // the camera came back but for rounding
  }
  hosted.detach();
}

TEST(Window, AToolMovesOverThePictureOfTheVolumeWithoutANewOne) {
  RENDERER_OR_SKIP(lender);
  lender.picture();
  SceneRenderer hosted;
  hosted.resize(kWidth, kHeight);
  hosted.setTissues(tissues(0.1));
  hosted.setVolume(Grid(ball()));
  ASSERT_TRUE(hosted.attach({[] { return true; }, [] {}}).ok());
  {
    const Screen screen;
    hosted.paint(screen.id());
    const Picture without = screen.read();
    hosted.setTools({needle(Vec3(0, -40, 0))});
    EXPECT_TRUE(hosted.paint(screen.id(), kTiny_ms)) << "no ray is cast";
    const Picture with = screen.read();
    const Difference seen = difference(without, with);
    EXPECT_GT(seen.pixels, 50);
    EXPECT_EQ(with, hosted.picture());

    // While a finer picture is made.
    hosted.orbit(15, 0);
    hosted.paint(screen.id(), kTiny_ms);
    ASSERT_FALSE(hosted.complete());
    const Picture before = screen.read();
    hosted.setTools({needle(Vec3(0, -40, 10))});
    EXPECT_FALSE(hosted.paint(screen.id(), kTiny_ms));
    EXPECT_GT(difference(before, screen.read()).pixels, 50);
    hosted.setTools({});
    hosted.orbit(-15, 0);
    finish(hosted, screen.id());
    EXPECT_GE(psnr_dB(screen.read(), without), 60.0);
  }
  hosted.detach();
}

TEST(Window, ACutMendsItsPartOfAPictureThatIsWhole) {
  RENDERER_OR_SKIP(lender);
  lender.picture();
  SceneRenderer hosted;
  hosted.resize(kWidth, kHeight);
  hosted.setSampleDistance(0.05);  // so that a picture takes longer than a moving one may
  hosted.setTissues(tissues(0.1));
  Grid grid(ball());
  hosted.setVolume(grid);
  ASSERT_TRUE(hosted.attach({[] { return true; }, [] {}}).ok());
  {
    const Screen screen;
    hosted.paint(screen.id());
    carve(grid, Vec3(-5, -24, 0), 6.0);
    ASSERT_TRUE(hosted.pullChanges(grid));
    finish(hosted, screen.id());
    EXPECT_EQ(hosted.shareOfRays(), 1.0);
    const Picture mended = screen.read();
    hosted.setTruth({});  // starts anew
    hosted.paint(screen.id());
    EXPECT_EQ(screen.read(), mended);
    // A second one, while a picture is on its way, is in that one too.
    hosted.orbit(10, 0);
    for (int strip = 0; strip < 3; ++strip) hosted.paint(screen.id(), kTiny_ms);
    ASSERT_FALSE(hosted.complete());
    carve(grid, Vec3(6, -24, 8), 6.0);
    ASSERT_TRUE(hosted.pullChanges(grid));
    finish(hosted, screen.id());
    const Picture late = screen.read();
    hosted.setTruth({});
    hosted.paint(screen.id());
    EXPECT_EQ(screen.read(), late);
  }
  hosted.detach();
}
