#include <cmath>

#include "scenes.h"

using namespace trephine;
using namespace trephine::test;

TEST(ToolDrawing, AToolIsDrawnInFrontOfBoneAndHiddenBehindIt) {
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

TEST(ToolDrawing, AToolExtendsFromItsTipAlongPlusZOfItsPose) {
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

TEST(ToolDrawing, ContactIsMarkedAtTheTip) {
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

TEST(ToolDrawing, AToolWithAPoseThatIsNotANumberIsLeftOut) {
  RENDERER_OR_SKIP(renderer);
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 120.0);
  const Picture none = renderer.picture();
  ToolView tool;
  tool.length_mm = 30.0;
  tool.pose_mm.position.x = std::nan("");
  renderer.setTools({tool});
  EXPECT_EQ(renderer.picture(), none);
}
