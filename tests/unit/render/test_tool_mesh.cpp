#include <gtest/gtest.h>
#include <locale.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/system.h"
#include "render/tool_mesh.h"
#include "stl_files.h"
#include "support.h"

using namespace trephine;
using namespace trephine::test;

namespace {

const std::vector<glm::vec3> kBox = boxCorners({-1, -2, -3}, {1, 2, 3});

std::string codeOf(const std::filesystem::path& file) {
  const Status status = checkToolMesh(file);
  if (status.ok()) return "";
  EXPECT_EQ(status.error().where, file.string());
  EXPECT_FALSE(status.error().next.empty());
  return status.error().code.str();
}

}  // namespace

TEST(ToolMesh, BinaryAndAsciiGiveTheSameTriangles) {
  const TemporaryFolder folder;
  const Result<ToolMesh> binary = readToolMesh(put(folder / "b.stl", binaryStl(kBox)));
  ASSERT_TRUE(binary.ok()) << binary.error().sentence();
  EXPECT_EQ(binary->corners, kBox);
  const Result<ToolMesh> ascii = readToolMesh(put(folder / "a.stl", asciiStl(kBox)));
  ASSERT_TRUE(ascii.ok()) << ascii.error().sentence();
  EXPECT_EQ(ascii->corners, kBox);
  // Many programs begin a binary file with this word.
  EXPECT_EQ(codeOf(put(folder / "s.stl", binaryStl(kBox, "solid made by a program"))), "");
  EXPECT_EQ(codeOf(put(folder / "two.stl", asciiStl(kBox) + asciiStl(kBox))), "");
  std::string loud = asciiStl(kBox);
  std::transform(loud.begin(), loud.end(), loud.begin(), [](char c) { return std::toupper(c); });
  EXPECT_EQ(codeOf(put(folder / "loud.stl", loud)), "");
}

TEST(ToolMesh, VtkPrintsNothingOfADamagedFile) {
  const TemporaryFolder folder;
  testing::internal::CaptureStderr();
  EXPECT_EQ(codeOf(put(folder / "m.stl", "a letter about a burr")), "NOT_STL");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ToolMesh, SaysInOneSentenceWhatIsWrongWithAFile) {
  const TemporaryFolder folder;
  const std::string whole = binaryStl(kBox), text = asciiStl(kBox);
  const auto code = [&](const std::string& bytes) { return codeOf(put(folder / "m.stl", bytes)); };

  EXPECT_EQ(codeOf(folder / "none.stl"), "MISSING_FILE");
  EXPECT_EQ(codeOf(folder.path()), "MISSING_FILE");
  EXPECT_EQ(code(""), "NOT_STL");
  EXPECT_EQ(code(binaryStl({})), "MESH_EMPTY");
  EXPECT_EQ(code(asciiStl({})), "MESH_EMPTY");
  EXPECT_EQ(code(binaryStl(std::vector<glm::vec3>(3, glm::vec3(1)))), "MESH_EMPTY");
  EXPECT_EQ(code("a letter about a burr"), "NOT_STL");
  EXPECT_EQ(code(std::string(500, 'x')), "NOT_STL");
  EXPECT_EQ(code(std::string("\x89PNG\r\n\x1a\n", 8) + std::string(300, '\xee')), "NOT_STL");
  EXPECT_EQ(code("solid as a rock\nfacet of a gem"), "NOT_STL");
  EXPECT_EQ(code(whole + "more"), "NOT_STL");
  EXPECT_EQ(code(std::string(whole).replace(80, 4, "\xff\xff\xff\x7f")), "NOT_STL");
  std::string word = text;
  EXPECT_EQ(code(word.replace(word.find("vertex -1"), 9, "vertex xx")), "NOT_STL");
}

TEST(ToolMesh, AFileCutShortAnywhereIsRefused) {
  const TemporaryFolder folder;
  for (const std::string& whole : {binaryStl(kBox), asciiStl(kBox)}) {
    // The last word of an ASCII file is the solid's name, which may be missing.
    const std::size_t end = std::min(whole.size(), whole.rfind("endsolid") + 8);
    for (std::size_t length = 0; length < end; length += length < 100 ? 1 : 13) {
      EXPECT_EQ(codeOf(put(folder / "m.stl", whole.substr(0, length))), "NOT_STL") << length;
    }
  }
}

TEST(ToolMesh, NumbersThatAreNoPlaceAreRefused) {
  const TemporaryFolder folder;
  const auto binary = [&](float value) {
    std::vector<glm::vec3> corners = kBox;
    corners[4].y = value;
    return codeOf(put(folder / "m.stl", binaryStl(corners)));
  };
  EXPECT_EQ(binary(std::nanf("")), "MESH_NOT_FINITE");
  EXPECT_EQ(binary(-std::numeric_limits<float>::infinity()), "MESH_NOT_FINITE");
  EXPECT_EQ(binary(3e38f), "MESH_TOO_FAR");
  EXPECT_EQ(binary(10001.0f), "MESH_TOO_FAR");
  EXPECT_EQ(binary(9999.0f), "");
  const auto ascii = [&](const std::string& value) {
    std::string text = asciiStl(kBox);
    return codeOf(
        put(folder / "m.stl", text.replace(text.find("vertex -1"), 9, "vertex " + value)));
  };
  EXPECT_EQ(ascii("nan"), "MESH_NOT_FINITE");
  EXPECT_EQ(ascii("inf"), "MESH_NOT_FINITE");
  EXPECT_EQ(ascii("1e999"), "MESH_NOT_FINITE");
  EXPECT_EQ(ascii("1e300"), "MESH_NOT_FINITE");  // beyond a float
  EXPECT_EQ(ascii("1e30"), "MESH_TOO_FAR");
  EXPECT_EQ(ascii("+1.5E-3"), "");
}

TEST(ToolMesh, ADecimalPointIsOneInEveryLocale) {
  const locale_t comma = newlocale(LC_NUMERIC_MASK, "de_DE.UTF-8", nullptr);
  if (!comma) GTEST_SKIP() << "This machine has no locale de_DE.UTF-8";
  const TemporaryFolder folder;
  const std::vector<glm::vec3> box = boxCorners({-1.5, -2.5, -3.5}, {1.5, 2.5, 3.5});
  const std::filesystem::path file = put(folder / "m.stl", asciiStl(box));
  const locale_t before = uselocale(comma);
  const Result<ToolMesh> mesh = readToolMesh(file);
  uselocale(before);
  freelocale(comma);
  ASSERT_TRUE(mesh.ok()) << mesh.error().sentence();
  EXPECT_EQ(mesh->corners, box);
}

TEST(ToolMesh, AFileOfMoreThan64MiBIsNotRead) {
  const TemporaryFolder folder;
  const std::filesystem::path file = put(folder / "m.stl", binaryStl(kBox));
  std::filesystem::resize_file(file, (std::uintmax_t(64) << 20) + 1);  // sparse
  EXPECT_EQ(codeOf(file), "MESH_TOO_LARGE");
}

TEST(ToolMesh, TheTipComesToTheOriginAndTheAxisToPlusZ) {
  const Vec3 tip(7, -8, 9);
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0, -2, 0),
                           Vec3(0.3, -0.4, 0.5), Vec3(1e-9, 0, -1)}) {
    const Vec3 along = glm::normalize(axis);
    const ToolMesh mesh{{tip, tip + 10.0 * along, tip + Vec3(1, 2, 3)}};
    const Result<ToolMesh> placed = inToolFrame(mesh, tip, axis);
    ASSERT_TRUE(placed.ok());
    EXPECT_NEAR(glm::length(placed->corners[0]), 0.0, 1e-5);
    EXPECT_NEAR(glm::distance(placed->corners[1], glm::vec3(0, 0, 10)), 0.0, 1e-5);
    EXPECT_NEAR(glm::length(placed->corners[2]), std::sqrt(14.0), 1e-5);  // nothing is scaled
  }
  const ToolMesh side{{Vec3(0, 5, 0), Vec3(0, 5, 0), Vec3(0, 5, 0)}};
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, -1)}) {
    const Result<ToolMesh> placed = inToolFrame(side, Vec3(0.0), axis);
    EXPECT_NEAR(glm::distance(placed->corners[0], glm::vec3(0, 5, 0)), 0.0, 1e-5);
  }
  const double nan = std::nan("");
  EXPECT_EQ(inToolFrame(side, Vec3(nan, 0, 0), Vec3(1, 0, 0)).error().where, "tip_mm");
  EXPECT_EQ(inToolFrame(side, Vec3(1e30, 0, 0), Vec3(1, 0, 0)).error().where, "tip_mm");
  EXPECT_EQ(inToolFrame(side, Vec3(0.0), Vec3(0.0)).error().where, "axis");
  EXPECT_EQ(inToolFrame(side, Vec3(0.0), Vec3(nan, 0, 1)).error().where, "axis");
}

TEST(ToolMesh, EveryToolThatShipsCanBeRead) {
  int meshes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(resourceFolder() / "tools")) {
    if (entry.path().extension() != ".stl") continue;
    ++meshes;
    const Status status = checkToolMesh(entry.path());
    EXPECT_TRUE(status.ok()) << status.error().sentence();
  }
  EXPECT_GE(meshes, 3);
}
