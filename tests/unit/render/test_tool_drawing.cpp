#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkDataArray.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <cmath>

#include "base/system.h"
#include "render/tool_drawing.h"
#include "render/tool_view.h"
#include "scenes.h"
#include "stl_files.h"
#include "support.h"

using namespace trephine;
using namespace trephine::test;

namespace {

// What ToolDrawing puts into a renderer: low and high of x, y, z in the patient frame. No display.
std::array<Vec3, 2> boundsOf(ToolDrawing& drawing, const ToolView& tool, vtkRenderer* renderer) {
  drawing.show({tool}, *renderer);
  double b[6];
  renderer->ComputeVisiblePropBounds(b);
  return {Vec3(b[0], b[2], b[4]), Vec3(b[1], b[3], b[5])};
}

void expectBounds(const std::array<Vec3, 2>& seen, const Vec3& low, const Vec3& high) {
  EXPECT_LT(glm::distance(seen[0], low), 1e-3) << seen[0].x << " " << seen[0].y << " " << seen[0].z;
  EXPECT_LT(glm::distance(seen[1], high), 1e-3)
      << seen[1].x << " " << seen[1].y << " " << seen[1].z;
}

// A bar of 80 mm along +x of its mesh, 2 mm in y and 4 mm in z, its tip at (-30, 5, 7).
const std::vector<glm::vec3> kBar = boxCorners({-30, 4, 5}, {50, 6, 9});

ToolView barTool(const std::filesystem::path& file) {
  ToolView tool;
  tool.length_mm = 30.0;
  tool.mesh_file = file.string();
  tool.mesh_tip_mm = Vec3(-30, 5, 7);
  tool.mesh_axis = Vec3(1, 0, 0);
  return tool;
}

// What is drawn of a mesh without a handle: its corners, each with its normal.
vtkSmartPointer<vtkPolyData> shaded(const std::filesystem::path& file) {
  vtkNew<vtkRenderer> renderer;
  ToolDrawing drawing;
  ToolView tool;
  tool.length_mm = 100.0;
  tool.mesh_file = file.string();
  tool.mesh_axis = Vec3(0, 0, 1);
  drawing.show({tool}, *renderer);
  vtkActorCollection* actors = renderer->GetActors();
  actors->InitTraversal();
  return vtkPolyData::SafeDownCast(actors->GetNextActor()->GetMapper()->GetInput());
}

Vec3 normalAt(vtkPolyData* solid, vtkIdType corner) {
  Vec3 normal;
  solid->GetPointData()->GetNormals()->GetTuple(corner, &normal.x);
  return normal;
}

}  // namespace

TEST(ToolDrawing, AToolIsDrawnInFrontOfBoneAndHiddenBehindIt) {
  RENDERER_OR_SKIP(renderer);
  renderer.setTissues(tissues());
  renderer.setVolume(Grid(ball()));
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 250.0);
  const Picture none = renderer.picture();

  ToolView tool;
  tool.length_mm = 10.0;
  tool.shape = ToolShape::blade;
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
  for (const ToolShape shape : {ToolShape::needle, ToolShape::blade, ToolShape::burr}) {
    ToolView tool;
    tool.shape = shape;
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

TEST(ToolDrawing, AToolInContactKeepsItsArmsColour) {
  const TemporaryFolder folder;
  ToolView built_in;
  built_in.length_mm = 30.0;
  const ToolView meshed = barTool(put(folder / "bar.stl", binaryStl(kBar)));
  for (ToolView tool : {built_in, meshed}) {
    tool.colour = Vec3(0.33, 0.73, 0.84);
    const auto colours = [&](bool contact) {
      vtkNew<vtkRenderer> renderer;
      ToolDrawing drawing;
      tool.contact = contact;
      drawing.show({tool}, *renderer);
      std::vector<Vec3> seen;
      vtkActorCollection* actors = renderer->GetActors();
      actors->InitTraversal();
      while (vtkActor* actor = actors->GetNextActor()) {
        Vec3 colour;
        actor->GetProperty()->GetColor(&colour.x);
        seen.push_back(colour);
      }
      return seen;
    };
    EXPECT_EQ(colours(true), colours(false));
  }
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

TEST(ToolDrawing, ABuiltInToolHasTheRadiusThatIsAskedFor) {
  const double none = 0.0, bad = std::nan("");
  const struct {
    ToolShape shape;
    double asked, radius;
  } cases[] = {{ToolShape::burr, none, 3.0},  {ToolShape::burr, 5.0, 5.0},
               {ToolShape::burr, bad, 3.0},   {ToolShape::burr, -1.0, 3.0},
               {ToolShape::needle, 4.0, 4.0}, {ToolShape::blade, 4.5, 4.5}};
  for (const auto& [shape, asked, radius] : cases) {
    vtkNew<vtkRenderer> renderer;
    ToolDrawing drawing;
    ToolView tool;
    tool.length_mm = 30.0;
    tool.shape = shape;
    tool.radius_mm = asked;
    const std::array<Vec3, 2> seen = boundsOf(drawing, tool, renderer);
    EXPECT_NEAR(seen[0].z, 0.0, 1e-3);
    EXPECT_NEAR(seen[1].z, 100.0, 1e-3);
    // The working part is what begins at the tip; the handle is wider.
    vtkActorCollection* drawn = renderer->GetActors();
    drawn->InitTraversal();
    double widest = 0.0;
    while (vtkActor* part = drawn->GetNextActor()) {
      const double* b = part->GetBounds();
      if (b && part->GetVisibility() && std::abs(b[4]) < 1e-3) widest = b[1];
    }
    EXPECT_NEAR(widest, radius, 1e-3);
  }
}

TEST(ToolDrawing, ABurrIsDrawnAsTheRodWithRoundEndsThatItsDescriptionSays) {
  ExerciseTool tool;
  const ToolDescription cylinder{ToolKind::burr, 40.0, 100, 2.0, 0, BurrShape::cylinder, 12.0, 0.0};
  tool.tool = *makeTool(cylinder);
  // How far back from the tip the head is as thick as it cuts; the handle begins at 40 mm.
  const auto thickUpTo_mm = [](const ExerciseTool& drawn) {
    vtkNew<vtkRenderer> renderer;
    ToolDrawing drawing;
    drawing.show({toolView(drawn, {}, false, Vec3(0.8))}, *renderer);
    vtkActorCollection* actors = renderer->GetActors();
    actors->InitTraversal();
    auto* solid = vtkPolyData::SafeDownCast(actors->GetNextActor()->GetMapper()->GetInput());
    double last = 0.0;
    for (vtkIdType i = 0; i < solid->GetNumberOfPoints(); ++i) {
      double p[3];
      solid->GetPoint(i, p);
      if (p[2] < 40.0 && std::abs(std::hypot(p[0], p[1]) - 2.0) < 1e-4) last = std::max(last, p[2]);
    }
    return last;
  };
  EXPECT_NEAR(thickUpTo_mm(tool), 10.0, 1e-3) << "12 mm, the last 2 of them round";
  tool.tool.made_from.shape = BurrShape::sphere;
  EXPECT_NEAR(thickUpTo_mm(tool), 2.0, 1e-3) << "a ball is thickest at its middle";
}

TEST(ToolDrawing, AMeshLiesWithItsTipAtThePoseAndItsAxisAlongTheTool) {
  const TemporaryFolder folder;
  const Log log;
  vtkNew<vtkRenderer> renderer;
  ToolDrawing drawing;
  ToolView tool = barTool(put(folder / "bar.stl", binaryStl(kBar)));
  // x of the mesh is along the tool, y stays, so the mesh's z lies across.
  expectBounds(boundsOf(drawing, tool, renderer), Vec3(-2, -1, 0), Vec3(2, 1, 80));

  tool.pose_mm.position = Vec3(100, 200, 300);
  expectBounds(boundsOf(drawing, tool, renderer), Vec3(98, 199, 300), Vec3(102, 201, 380));
  tool.pose_mm.orientation = glm::angleAxis(glm::radians(90.0), Vec3(0, 1, 0));  // +z to the left
  expectBounds(boundsOf(drawing, tool, renderer), Vec3(100, 199, 298), Vec3(180, 201, 302));

  tool.pose_mm = {};
  tool.mesh_axis = Vec3(-2, 0, 0);  // other data files for the same mesh
  expectBounds(boundsOf(drawing, tool, renderer), Vec3(-2, -1, -80), Vec3(2, 1, 0));
  tool.mesh_tip_mm = Vec3(50, 5, 7);
  expectBounds(boundsOf(drawing, tool, renderer), Vec3(-2, -1, 0), Vec3(2, 1, 80));

  tool.pose_mm.position.x = std::nan("");
  drawing.show({tool}, *renderer);
  EXPECT_EQ(renderer->VisibleActorCount(), 0);
  EXPECT_TRUE(log.lines().empty());
}

TEST(ToolDrawing, AMeshIsSeenInThePicture) {
  RENDERER_OR_SKIP(renderer);
  const TemporaryFolder folder;
  renderer.lookAt(Vec3(0.0), Vec3(0, 1, 0), Vec3(0, 0, 1), 500.0);
  const Picture none = renderer.picture();
  ToolView tool = barTool(put(folder / "bar.stl", binaryStl(kBar)));
  tool.pose_mm.orientation = glm::angleAxis(glm::radians(90.0), Vec3(0, 1, 0));
  tool.colour = Vec3(0.1, 0.2, 0.9);
  renderer.setTools({tool});
  const Picture seen = renderer.picture();
  // A thin bar from the middle to the right: its middle is at the middle of its 80 mm.
  const double mm = renderer.mmPerPixelAt(Vec3(0.0));
  const Difference bar = difference(none, seen);
  EXPECT_NEAR(bar.centre.x, kWidth / 2.0 + 40.0 / mm, 1.5);
  EXPECT_NEAR(bar.centre.y, kHeight / 2.0, 1.5);
  EXPECT_NEAR(bar.pixels, 80.0 / mm * 4.0 / mm, 0.6 * bar.pixels);
}

TEST(ToolDrawing, EdgesOfAMeshStaySharp) {
  const TemporaryFolder folder;
  const auto box = shaded(put(folder / "box.stl", binaryStl(boxCorners({-1, -2, -3}, {1, 2, 3}))));
  EXPECT_EQ(box->GetNumberOfPolys(), 12);
  EXPECT_EQ(box->GetNumberOfPoints(), 24);  // three faces meet in each corner
  for (vtkIdType i = 0; i < box->GetNumberOfPoints(); ++i) {
    const Vec3 outward =
        glm::sign(Vec3(box->GetPoint(i)[0], box->GetPoint(i)[1], box->GetPoint(i)[2]));
    EXPECT_NEAR(glm::dot(normalAt(box, i), outward), 1.0, 1e-5);
  }
}

TEST(ToolDrawing, CurvesOfAMeshLookRound) {
  const TemporaryFolder folder;
  constexpr int kSides = 16;  // which meet at 22.5 degrees
  std::vector<glm::vec3> pipe;
  const auto corner = [](int side, float z) {
    const float angle = glm::radians(360.0f / kSides * float(side % kSides));
    return glm::vec3(10.0f * std::cos(angle), 10.0f * std::sin(angle), z);
  };
  for (int i = 0; i < kSides; ++i) {
    const glm::vec3 a = corner(i, 0), b = corner(i + 1, 0), c = corner(i + 1, 9), d = corner(i, 9);
    for (const glm::vec3& p : {a, b, c, a, c, d}) pipe.push_back(p);
  }
  const auto round = shaded(put(folder / "pipe.stl", binaryStl(pipe)));
  EXPECT_EQ(round->GetNumberOfPoints(), 2 * kSides);
  for (vtkIdType i = 0; i < round->GetNumberOfPoints(); ++i) {
    const Vec3 outward(round->GetPoint(i)[0] / 10.0, round->GetPoint(i)[1] / 10.0, 0.0);
    // A flat face would be 11 degrees off.
    EXPECT_GT(glm::dot(normalAt(round, i), outward), std::cos(glm::radians(5.0)));
  }
}

TEST(ToolDrawing, ADamagedMeshWithCountlessFacesAroundOneCornerIsDrawnAtOnce) {
  const TemporaryFolder folder;
  std::vector<glm::vec3> fan;
  for (int i = 0; i < 300'000; ++i) {
    const float x = 1e-4f * float(i);
    for (const glm::vec3& p :
         {glm::vec3(0, 0, 0), glm::vec3(x, 1, 0), glm::vec3(x + 1e-4f, 1, 0)}) {
      fan.push_back(p);
    }
  }
  const auto flat = shaded(put(folder / "fan.stl", binaryStl(fan)));
  EXPECT_GT(flat->GetNumberOfPolys(), 100'000);
  EXPECT_EQ(flat->GetPointData()->GetNormals(), nullptr);
}

TEST(ToolDrawing, BehindItsLengthAMeshHasTheToolsColour) {
  RENDERER_OR_SKIP(renderer);
  const TemporaryFolder folder;
  const std::vector<glm::vec3> front = boxCorners({-10, -10, 0}, {10, 10, 20});
  std::vector<glm::vec3> both = boxCorners({-10, -10, 30}, {10, 10, 50});
  both.insert(both.end(), front.begin(), front.end());
  ToolView tool;
  tool.length_mm = 25.0;
  tool.mesh_file = put(folder / "two.stl", binaryStl(both)).string();
  tool.colour = Vec3(0.9, 0.1, 0.1);
  renderer.lookAt(Vec3(0, 0, 25), Vec3(0, 1, 0), Vec3(0, 0, 1), 150.0);
  renderer.setTools({tool});
  const Picture seen = renderer.picture();
  const auto redness = [&](const Vec3& point) {
    const glm::ivec2 at = pixelOf(renderer, Vec3(0, 0, 25), point);
    const std::size_t first = (std::size_t(at.y) * kWidth + std::size_t(at.x)) * 3;
    return int(seen.rgb[first]) - int(seen.rgb[first + 2]);
  };
  EXPECT_LT(redness(Vec3(0, -10, 10)), 60);  // steel, with a tinge of it
  EXPECT_GT(redness(Vec3(0, -10, 40)), 100);
}

TEST(ToolDrawing, AMeshThatCannotBeDrawnGivesWayToTheBuiltInShapeWithOneWarning) {
  const TemporaryFolder folder;
  const std::string whole = binaryStl(kBar);
  const double nan = std::nan("");
  std::vector<ToolView> bad = {
      barTool(folder / "none.stl"), barTool(put(folder / "cut.stl", whole.substr(0, 300))),
      barTool(put(folder / "text.stl", "no mesh")), barTool(put(folder / "tip.stl", whole)),
      barTool(put(folder / "axis.stl", whole))};
  bad[3].mesh_tip_mm.x = nan;
  bad[4].mesh_axis = Vec3(0.0);
  for (const ToolView& tool : bad) {
    const std::string name = std::filesystem::path(tool.mesh_file).filename().string();
    const Log log;
    vtkNew<vtkRenderer> renderer;
    ToolDrawing drawing;
    for (int frame = 0; frame < 3; ++frame) {
      ToolView moved = tool;
      moved.pose_mm.position.x = frame;
      moved.shape = frame == 2 ? ToolShape::burr : ToolShape::needle;
      drawing.show({moved, moved}, *renderer);
      double b[6];
      renderer->ComputeVisiblePropBounds(b);
      EXPECT_NEAR(b[5], 100.0, 1e-3);  // 30 mm and the built-in handle of 70 mm
    }
    ASSERT_EQ(log.lines().size(), 1u) << name;
    const std::string line = log.lines()[0];
    EXPECT_TRUE(line.starts_with("warning: ")) << line;
    EXPECT_NE(line.find("(the mesh of a needle)"), std::string::npos) << line;
    EXPECT_EQ(line.find(name), std::string::npos) << "a log names no file: " << line;
    EXPECT_EQ(line.find(folder.path().filename().string()), std::string::npos) << line;
  }
}

TEST(ToolDrawing, AMeshIsReadOnce) {
  const TemporaryFolder folder;
  const Log log;
  vtkNew<vtkRenderer> renderer;
  ToolDrawing drawing;
  ToolView tool = barTool(put(folder / "bar.stl", binaryStl(kBar)));
  boundsOf(drawing, tool, renderer);
  std::filesystem::remove(tool.mesh_file);
  tool.length_mm = 40.0;  // cut anew into working part and handle
  expectBounds(boundsOf(drawing, tool, renderer), Vec3(-2, -1, 0), Vec3(2, 1, 80));

  const std::filesystem::path late = folder / "late.stl";
  tool.mesh_file = late.string();
  const std::array<Vec3, 2> built_in = boundsOf(drawing, tool, renderer);
  EXPECT_NEAR(built_in[1].z, 110.0, 1e-3);
  put(late, binaryStl(kBar));
  tool.length_mm = 30.0;
  EXPECT_NEAR(boundsOf(drawing, tool, renderer)[1].z, 100.0, 1e-3);
  EXPECT_EQ(log.lines().size(), 1u);

  tool.mesh_file.clear();  // and back to the built-in shape on purpose
  EXPECT_NEAR(boundsOf(drawing, tool, renderer)[1].z, 100.0, 1e-3);
  drawing.show({}, *renderer);
  EXPECT_EQ(renderer->VisibleActorCount(), 0);
}
