#include "render/opengl.h"
//
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>

#include "render/scene_renderer.h"

using namespace trephine;

namespace {

constexpr int kWidth = 200, kHeight = 160;  // below the size at which the orientation cue is drawn

#define RENDERER_OR_SKIP(name)                                                      \
  auto name##_made = offscreenIfDisplay();                                          \
  if (!name##_made) GTEST_SKIP() << "No display: this test draws and reads pixels"; \
  ASSERT_TRUE(name##_made->ok()) << name##_made->error().sentence();                \
  SceneRenderer& name = ***name##_made

std::optional<Result<std::unique_ptr<SceneRenderer>>> offscreenIfDisplay() {
  const char* display = std::getenv("DISPLAY");
  if (!display || !*display) return std::nullopt;
  return SceneRenderer::offscreen(kWidth, kHeight);
}

Tissue tissue(const char* id, int low, int high, Vec3 colour, double opacity) {
  Tissue t;
  t.id = id;
  t.hu_min = low;
  t.hu_max = high;
  t.colour = colour;
  t.opacity = opacity;
  return t;
}

TissueSet tissues(double soft_opacity = 0.0, double bone_opacity = 0.9) {
  return {"test",
          {tissue("soft", -100, 199, Vec3(0.8, 0.5, 0.4), soft_opacity),
           tissue("bone", 300, 3000, Vec3(0.9, 0.9, 0.8), bone_opacity)}};
}

// A soft ball with a shell of bone inside, partial volumes at their edges, centred on 0.
Volume ball() {
  Volume volume;
  GridGeometry& g = volume.geometry;
  g.size = {64, 60, 48};
  g.spacing_mm = Vec3(1.0, 1.0, 1.25);
  g.origin_mm = -0.5 * Vec3(63, 59, 47) * g.spacing_mm;
  for (int k = 0; k < g.size[2]; ++k) {
    for (int j = 0; j < g.size[1]; ++j) {
      for (int i = 0; i < g.size[0]; ++i) {
        const double depth = 28.0 - glm::length(g.toPatient_mm(Vec3(i, j, k)));
        const auto in = [&](double from) { return std::clamp(depth - from + 0.5, 0.0, 1.0); };
        volume.hu.push_back(std::int16_t(-1000 + 1040 * in(0) + 1000 * in(5) - 1000 * in(10)));
      }
    }
  }
  return volume;
}

// Where pixels differ: how many, and their centre of mass, x right and y down.
struct Difference {
  int pixels = 0;
  glm::dvec2 centre{0.0};
};
Difference difference(const Picture& a, const Picture& b, int threshold = 8) {
  Difference d;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      int most = 0;
      for (int c = 0; c < 3; ++c) {
        const std::size_t at = (std::size_t(y) * std::size_t(a.width) + std::size_t(x)) * 3 + c;
        most = std::max(most, std::abs(int(a.rgb[at]) - int(b.rgb[at])));
      }
      if (most < threshold) continue;
      ++d.pixels;
      d.centre += glm::dvec2(x, y);
    }
  }
  if (d.pixels) d.centre /= d.pixels;
  return d;
}

// The pixel on which a point falls, from the public camera alone.
glm::dvec2 pixelOf(const SceneRenderer& renderer, const Vec3& focus, const Vec3& point) {
  const Vec3 d = point - focus;
  const double mm = renderer.mmPerPixelAt(point);
  return {(kWidth - 1) / 2.0 + glm::dot(d, renderer.viewRight()) / mm,
          (kHeight - 1) / 2.0 - glm::dot(d, renderer.viewUp()) / mm};
}

void carve(Grid& grid, Vec3 centre, double radius, std::int16_t hu = kAirHu) {
  auto writer = grid.takeWriter();
  ASSERT_TRUE(writer.has_value());
  const GridGeometry& g = grid.geometry();
  for (std::size_t index = 0; index < g.voxelCount(); ++index) {
    const Index3 v = g.indicesOf(index);
    if (glm::distance(g.toPatient_mm(Vec3(v[0], v[1], v[2])), centre) < radius) {
      writer->store(index, hu);
    }
  }
}

}  // namespace

TEST(SceneRenderer, WithoutADisplayItSaysSo) {
  const char* kept = std::getenv("DISPLAY");
  const std::string display = kept ? kept : "";
  ::unsetenv("DISPLAY");
  const auto made = SceneRenderer::offscreen(64, 64);
  if (kept) ::setenv("DISPLAY", display.c_str(), 1);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, "NO_DISPLAY");
}

TEST(SceneRenderer, BeforeItIsAttachedItDrawsNothingAndDoesNotCrash) {
  SceneRenderer renderer;
  renderer.setVolume(Grid(ball()));
  renderer.setTissues(tissues());
  renderer.paint(0);
  EXPECT_TRUE(renderer.picture().rgb.empty());
  EXPECT_EQ(renderer.copy().hu, ball().hu);
}

TEST(SceneRenderer, TheSameStateGivesTheSamePicture) {
  RENDERER_OR_SKIP(renderer);
  const Picture empty = renderer.picture();
  renderer.setVolume(Grid(ball()));
  renderer.setTissues(tissues());
  const Picture first = renderer.picture();
  EXPECT_GT(difference(first, empty).pixels, kWidth * kHeight / 10);
  EXPECT_EQ(renderer.picture(), first);
  renderer.orbit(30, 10);
  EXPECT_NE(renderer.picture(), first);
  renderer.setTissues(tissues(0.5));
  renderer.resetCamera(Vec3(0, 1, 0), Vec3(0, 0, 1));
  EXPECT_NE(renderer.picture(), first);
  renderer.setTissues(tissues());
  EXPECT_EQ(renderer.picture(), first);
}

TEST(SceneRenderer, LeapingOverEmptySpaceChangesNothingVisible) {
  RENDERER_OR_SKIP(renderer);
  renderer.setVolume(Grid(ball()));
  for (double soft : {0.0, 0.03, 0.4}) {
    renderer.setTissues(tissues(soft));
    for (const Vec3& direction : {Vec3(0, 1, 0), Vec3(-0.4, 0.7, -0.5), Vec3(0, 0, -1)}) {
      renderer.resetCamera(direction, Vec3(0, -0.3, 1));
      UploadProbe::setLeaping(renderer, false);
      const Picture stock = renderer.picture();
      UploadProbe::setLeaping(renderer, true);
      EXPECT_GE(psnr_dB(stock, renderer.picture()), 60.0) << soft;
    }
  }
}

TEST(SceneRenderer, LeapingHoldsWithTheEyeInsideTheVolumeToo) {
  RENDERER_OR_SKIP(renderer);
  renderer.setVolume(Grid(ball()));
  renderer.setTissues(tissues());
  renderer.lookAt(Vec3(0, 10, 0), Vec3(0.2, 1, 0), Vec3(0, 0, 1), 12.0);
  UploadProbe::setLeaping(renderer, false);
  const Picture stock = renderer.picture();
  UploadProbe::setLeaping(renderer, true);
  EXPECT_GE(psnr_dB(stock, renderer.picture()), 60.0);
}

TEST(SceneRenderer, AVoxelIsDrawnWhereTheAffineSaysAlsoInAnObliqueOrMirroredVolume) {
  RENDERER_OR_SKIP(renderer);
  const Mat3 oblique = Mat3(glm::rotate(Mat4(1.0), 0.7, glm::normalize(Vec3(1, 2, -0.5))));
  Mat3 mirrored = oblique;
  mirrored[1] = -mirrored[1];
  for (const Mat3& direction : {Mat3(1.0), oblique, mirrored}) {
    for (const Index3& marker : {Index3{8, 30, 9}, Index3{33, 6, 20}}) {
      Volume volume;
      GridGeometry& g = volume.geometry;
      g.size = {40, 36, 28};
      g.spacing_mm = Vec3(0.8, 1.1, 1.7);
      g.origin_mm = Vec3(-120, 45, 300);
      g.direction = direction;
      volume.hu.assign(g.voxelCount(), kAirHu);
      for (int k = -1; k <= 1; ++k) {
        for (int j = -1; j <= 1; ++j) {
          for (int i = -1; i <= 1; ++i) {
            volume.hu[g.indexOf(marker[0] + i, marker[1] + j, marker[2] + k)] = 1500;
          }
        }
      }
      const Vec3 focus = g.centre_mm();
      const Vec3 place = g.toPatient_mm(Vec3(marker[0], marker[1], marker[2]));
      renderer.setVolume(Grid(std::move(volume)));
      for (const Vec3& way : {Vec3(0, 1, 0), Vec3(0.5, -0.6, 0.4)}) {
        renderer.lookAt(focus, way, Vec3(0, 0, 1), 150.0);
        renderer.setTissues(tissues(0.0, 0.0));
        const Picture hidden = renderer.picture();
        renderer.setTissues(tissues());
        const Difference seen = difference(hidden, renderer.picture());
        ASSERT_GT(seen.pixels, 4);
        EXPECT_LT(glm::distance(seen.centre, pixelOf(renderer, focus, place)), 1.5);
      }
    }
  }
}

TEST(SceneRenderer, AHiddenTissueDoesNotOcclude) {
  RENDERER_OR_SKIP(renderer);
  Volume bare = ball();
  for (std::int16_t& hu : bare.hu) {
    if (hu < 300) hu = kAirHu;
  }
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(ball()));
  const Picture covered = renderer.picture();
  renderer.setVolume(Grid(std::move(bare)));
  EXPECT_GE(psnr_dB(covered, renderer.picture()), 30.0);  // the shell's edge is shaded otherwise
}

TEST(SceneRenderer, ACutIsSeenWhereItIsMadeAndGoneAfterItsUndo) {
  RENDERER_OR_SKIP(renderer);
  Grid grid(ball());
  renderer.setTissues(tissues(0.4));
  renderer.setVolume(grid);
  const Picture whole = renderer.picture();
  EXPECT_FALSE(renderer.pullChanges(grid));

  const Vec3 place(10, -22, 6);  // on the side that is seen
  carve(grid, place, 9.0);
  ASSERT_TRUE(renderer.pullChanges(grid));
  const Picture cut = renderer.picture();
  const Difference seen = difference(whole, cut);
  EXPECT_GT(seen.pixels, 100);
  EXPECT_LT(glm::distance(seen.centre, pixelOf(renderer, Vec3(0.0), place)), 8.0);
  EXPECT_EQ(renderer.copy().hu, grid.snapshot().hu);

  const Volume before = ball();
  {
    auto writer = grid.takeWriter();
    for (std::size_t i = 0; i < before.hu.size(); ++i) {
      if (grid.hu(i) != before.hu[i]) writer->store(i, before.hu[i]);
    }
  }
  ASSERT_TRUE(renderer.pullChanges(grid));
  EXPECT_EQ(renderer.picture(), whole);
}

TEST(SceneRenderer, MatterThatAppearsInEmptySpaceIsDrawn) {
  RENDERER_OR_SKIP(renderer);
  Grid grid(ball());
  renderer.setTissues(tissues());
  renderer.setVolume(grid);
  const Picture whole = renderer.picture();
  const Vec3 place(0, 0, 26);
  carve(grid, place, 3.0, 1500);
  renderer.pullChanges(grid);
  const Difference seen = difference(whole, renderer.picture());
  EXPECT_GT(seen.pixels, 20);
  EXPECT_LT(glm::distance(seen.centre, pixelOf(renderer, Vec3(0.0), place)), 4.0);
}

TEST(SceneRenderer, ABoxSentAloneGivesThePictureOfAFullUpload) {
  RENDERER_OR_SKIP(renderer);
  Grid grid(ball());
  renderer.setTissues(tissues(0.1));
  renderer.setVolume(grid);
  const Picture whole = renderer.picture();
  carve(grid, Vec3(-5, -24, 0), 12.0);
  carve(grid, Vec3(0, 0, 20), 30.0);  // the brightest voxels go: VTK's range must not follow
  renderer.pullChanges(grid);
  const Picture by_box = renderer.picture();
  ASSERT_NE(by_box, whole);
  UploadProbe::fullUpload_ms(renderer);
  EXPECT_EQ(renderer.picture(), by_box);
  RENDERER_OR_SKIP(fresh);
  fresh.setTissues(tissues(0.1));
  fresh.setVolume(grid);
  EXPECT_GE(psnr_dB(fresh.picture(), by_box), 60.0);
}

TEST(SceneRenderer, ChangesOfAnotherGridAreNotTaken) {
  RENDERER_OR_SKIP(renderer);
  renderer.setVolume(Grid(ball()));
  Volume other = ball();
  other.geometry.origin_mm.x += 1.0;
  Grid moved(std::move(other));
  carve(moved, Vec3(0.0), 5.0);
  EXPECT_FALSE(renderer.pullChanges(moved));
  EXPECT_EQ(renderer.copy().hu, ball().hu);
}

TEST(SceneRenderer, MovingFramesLeaveTheStillPictureAsItWas) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(ball()));
  const Picture still = renderer.picture();
  renderer.setMoving(true);
  for (int frame = 0; frame < 4; ++frame) renderer.paint(0);
  EXPECT_EQ(renderer.picture(), still);
  renderer.setMoving(false);
  renderer.paint(0);
  EXPECT_EQ(renderer.picture(), still);
}

TEST(SceneRenderer, AToolIsDrawnInFrontOfBoneAndHiddenBehindIt) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(ball()));
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 250.0);
  const Picture none = renderer.picture();

  ToolView tool;
  tool.length_mm = 10.0;
  tool.blade = true;
  tool.colour = Vec3(0.1, 0.2, 0.9);
  tool.pose_mm.position = Vec3(0, -40, 0);
  renderer.setTools({tool});
  const Difference front = difference(none, renderer.picture());
  EXPECT_GT(front.pixels, 100);

  tool.pose_mm.position =
      Vec3(0, 0, -10);  // its blade lies inside the shell, the handle sticks out
  renderer.setTools({tool});
  const Difference inside = difference(none, renderer.picture());
  EXPECT_LT(inside.pixels, front.pixels);

  renderer.setTools({});
  EXPECT_EQ(renderer.picture(), none);
}

TEST(SceneRenderer, AToolExtendsFromItsTipAlongPlusZOfItsPose) {
  RENDERER_OR_SKIP(renderer);
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 500.0);
  const Picture none = renderer.picture();
  for (bool blade : {true, false}) {
    ToolView tool;
    tool.blade = blade;
    tool.length_mm = 30.0;
    tool.pose_mm.orientation =
        glm::angleAxis(1.5707963, Vec3(0, 1, 0));  // +z to the patient's left
    renderer.setTools({tool});
    const Difference seen = difference(none, renderer.picture());
    ASSERT_GT(seen.pixels, 50);
    // Seen from the front, the patient's left is at the right; the tool is 100 mm long with handle.
    EXPECT_GT(seen.centre.x, kWidth / 2.0 + 15.0);
    EXPECT_NEAR(seen.centre.y, kHeight / 2.0, 2.0);
  }
}

TEST(SceneRenderer, ContactIsMarkedAtTheTip) {
  RENDERER_OR_SKIP(renderer);
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 120.0);
  ToolView tool;
  tool.length_mm = 30.0;
  tool.colour = Vec3(0.2, 0.8, 0.3);
  renderer.setTools({tool});
  const Picture free = renderer.picture();
  tool.contact = true;
  renderer.setTools({tool});
  const Picture touching = renderer.picture();
  const std::size_t middle = (std::size_t(kHeight / 2) * kWidth + kWidth / 2) * 3;
  EXPECT_NE(touching, free);
  EXPECT_GT(int(touching.rgb[middle]), int(free.rgb[middle]) + 40);  // the mark is orange
}

TEST(SceneRenderer, AToolWithAPoseThatIsNotANumberIsLeftOut) {
  RENDERER_OR_SKIP(renderer);
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 120.0);
  const Picture none = renderer.picture();
  ToolView tool;
  tool.length_mm = 30.0;
  tool.pose_mm.position.x = std::nan("");
  renderer.setTools({tool});
  EXPECT_EQ(renderer.picture(), none);
}

TEST(SceneRenderer, AWindowsContextShowsWhatTheHiddenWindowShows) {
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

TEST(SceneRenderer, StripsAddUpToTheWholePictureAndStartAnewAfterAChange) {
  RENDERER_OR_SKIP(lender);
  lender.picture();  // leaves the lender's context current
  SceneRenderer hosted;
  hosted.resize(kWidth, kHeight);
  hosted.setTissues(tissues(0.1));
  hosted.setVolume(Grid(ball()));
  ASSERT_TRUE(hosted.attach({[] { return true; }, [] {}}).ok());
  {
    const Screen screen;
    EXPECT_TRUE(hosted.paint(screen.id()));
    const Picture whole = screen.read();
    EXPECT_EQ(whole, hosted.picture());

    constexpr double kTiny_ms = 1e-3;  // less than any picture takes
    const auto finish = [&] {
      int paints = 1;
      while (!hosted.paint(screen.id(), kTiny_ms)) ++paints;
      return paints;
    };
    EXPECT_GT(finish(), 5);
    EXPECT_EQ(screen.read(), whole);
    EXPECT_EQ(finish(), 1);  // nothing changed: what is there is shown again
    EXPECT_EQ(screen.read(), whole);

    hosted.orbit(20, 0);
    EXPECT_FALSE(hosted.paint(screen.id(), kTiny_ms));
    hosted.orbit(-20, 0);
    EXPECT_GT(finish(), 5);
    EXPECT_GE(psnr_dB(screen.read(), whole), 60.0);  // the camera came back but for rounding

    ToolView tool;
    tool.length_mm = 20.0;
    tool.pose_mm.position = Vec3(0, -40, 0);
    hosted.setTools({tool});
    EXPECT_GT(finish(), 5);
    EXPECT_EQ(screen.read(), hosted.picture());
  }
  hosted.detach();
}

TEST(Camera, OnePixelSpansWhatPerspectiveGives) {
  SceneRenderer renderer;
  renderer.resize(400, 300);
  renderer.lookAt(Vec3(10, 20, 30), Vec3(0, 2, 0), Vec3(0, 0, 5), 200.0);
  const double expected = 2.0 * 200.0 * std::tan(glm::radians(15.0)) / 300.0;
  EXPECT_NEAR(renderer.mmPerPixelAt(Vec3(10, 20, 30)), expected, 1e-9);
  EXPECT_NEAR(renderer.mmPerPixelAt(Vec3(40, -80, 3)), expected / 2.0, 1e-9);
  renderer.zoom(2.0);
  EXPECT_NEAR(renderer.mmPerPixelAt(Vec3(10, 20, 30)), expected / 2.0, 1e-9);
}

TEST(Camera, SeenFromTheFrontThePatientsLeftIsAtTheRight) {
  SceneRenderer renderer;
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 200.0);
  EXPECT_NEAR(glm::distance(renderer.viewRight(), Vec3(1, 0, 0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(renderer.viewUp(), Vec3(0, 0, 1)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(renderer.viewForward(), Vec3(0, 1, 0)), 0.0, 1e-12);
}

TEST(Camera, PanningMovesThePictureWithTheMouse) {
  SceneRenderer renderer;
  renderer.resize(400, 300);
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 200.0);
  const double mm = renderer.mmPerPixelAt(Vec3(0.0));
  renderer.pan(10.0, 0.0);
  // What lay at the middle is now 10 pixels right of it: the eye went left by as much.
  renderer.zoom(1.0);
  EXPECT_NEAR(renderer.mmPerPixelAt(Vec3(-10.0 * mm, 0, 0)), mm, 1e-9);
  EXPECT_NEAR(glm::distance(renderer.viewForward(), Vec3(0, 1, 0)), 0.0, 1e-12);
}

TEST(Camera, AFullTurnComesBack) {
  SceneRenderer renderer;
  renderer.lookAt(Vec3(1, 2, 3), Vec3(0.3, 1, -0.2), Vec3(0, 0, 1), 200.0);
  const Vec3 forward = renderer.viewForward(), up = renderer.viewUp();
  for (int i = 0; i < 36; ++i) renderer.orbit(10.0, 0.0);
  EXPECT_NEAR(glm::distance(renderer.viewForward(), forward), 0.0, 1e-9);
  EXPECT_NEAR(glm::distance(renderer.viewUp(), up), 0.0, 1e-9);
  renderer.orbit(std::nan(""), 0.0);
  EXPECT_NEAR(glm::distance(renderer.viewForward(), forward), 0.0, 1e-9);
}

TEST(Camera, LookingAlongTheUpDirectionStillGivesARightHandedView) {
  SceneRenderer renderer;
  renderer.lookAt(Vec3(0.0), Vec3(0, 0, -1), Vec3(0, 0, 1), 200.0);
  EXPECT_NEAR(glm::length(renderer.viewUp()), 1.0, 1e-12);
  EXPECT_NEAR(
      glm::distance(glm::cross(renderer.viewForward(), renderer.viewUp()), renderer.viewRight()),
      0.0, 1e-12);
}
