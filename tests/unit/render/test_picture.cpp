#include <gtest/gtest.h>

#include <QImage>
#include <cmath>
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
  const QImage read = QImage((folder / "a.png").c_str()).convertToFormat(QImage::Format_RGB888);
  ASSERT_EQ(read.size(), QSize(37, 21));
  for (int y = 0; y < 21; ++y) {
    for (int x = 0; x < 37; ++x) {
      EXPECT_EQ(read.pixel(x, y), qRgb(x, y, x + y)) << x << " " << y;
    }
  }
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

TEST(Picture, WritingIntoAMissingFolderFailsAndLeavesNothing) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(writePng(gradient(4, 4), folder / "no" / "a.png").ok());
  EXPECT_FALSE(writePng(Picture{}, folder / "empty.png").ok());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}
