#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "render/picture.h"
#include "support.h"

using namespace trephine;

namespace {

Picture gradient(int width, int height) {
  Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      picture.rgb.push_back(std::uint8_t(x));
      picture.rgb.push_back(std::uint8_t(y));
      picture.rgb.push_back(std::uint8_t(x + y));
    }
  }
  return picture;
}

}  // namespace

TEST(Picture, APngGivesBackEveryPixelWhereItWas) {
  const test::TemporaryFolder folder;
  const Picture picture = gradient(37, 21);
  ASSERT_TRUE(writePng(picture, folder / "a.png").ok());
  const auto read = readPng(folder / "a.png");
  ASSERT_TRUE(read.ok()) << read.error().sentence();
  EXPECT_EQ(*read, picture);
}

TEST(Picture, PsnrIsInfiniteForEqualPicturesAndFollowsItsFormula) {
  const Picture a = gradient(16, 16);
  EXPECT_EQ(psnr_dB(a, a), std::numeric_limits<double>::infinity());
  Picture b = a;
  for (std::uint8_t& v : b.rgb) v = std::uint8_t(v ^ 1);  // every value off by one
  EXPECT_NEAR(psnr_dB(a, b), 20.0 * std::log10(255.0), 1e-9);
}

TEST(Picture, PsnrOfPicturesOfOtherSizesIsZero) {
  EXPECT_EQ(psnr_dB(gradient(8, 4), gradient(4, 8)), 0.0);
}

TEST(Picture, AFileThatIsNoPngIsRefusedByName) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "no.png") << "this is text";
  const auto read = readPng(folder / "no.png");
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().code, "BAD_PICTURE");
  EXPECT_NE(read.error().sentence().find("no.png"), std::string::npos);
  EXPECT_EQ(readPng(folder / "absent.png").error().code, "MISSING_FILE");
}

TEST(Picture, APngCutShortAnywhereIsRefused) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writePng(gradient(200, 200), folder / "a.png").ok());
  for (auto size = std::filesystem::file_size(folder / "a.png"); size-- > 0;) {
    std::filesystem::resize_file(folder / "a.png", size);
    ASSERT_EQ(readPng(folder / "a.png").error().code, "BAD_PICTURE") << size;
    if (size > 100) size -= 61;
  }
}

TEST(Picture, ADamagedPngIsRefused) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(writePng(gradient(200, 200), folder / "a.png").ok());
  for (int at : {3, 14, 20, 60, 300}) {
    std::filesystem::copy_file(folder / "a.png", folder / "b.png",
                               std::filesystem::copy_options::overwrite_existing);
    std::fstream file(folder / "b.png", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(at);
    file.put(char(0x5a));
    file.put(char(0xa5));
    file.close();
    EXPECT_EQ(readPng(folder / "b.png").error().code, "BAD_PICTURE") << at;
  }
}

TEST(Picture, WritingIntoAMissingFolderFailsAndLeavesNothing) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(writePng(gradient(4, 4), folder / "no" / "a.png").ok());
  EXPECT_FALSE(writePng(Picture{}, folder / "empty.png").ok());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}
