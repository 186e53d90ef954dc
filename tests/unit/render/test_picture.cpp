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

TEST(Picture, SsimIsOneForEqualPicturesAndFallsWithWhatTheEyeMisses) {
  Picture a{64, 48, {}};
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      for (int c = 0; c < 3; ++c) a.rgb.push_back(std::uint8_t((x / 4 + y / 4) % 2 ? 200 : 60));
    }
  }
  EXPECT_NEAR(ssim(a, a), 1.0, 1e-12);
  // The same error, once as a shift of all values and once as a pattern of its own.
  Picture brighter = a, noisy = a;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    brighter.rgb[i] = std::uint8_t(a.rgb[i] + 20);
    noisy.rgb[i] = std::uint8_t(a.rgb[i] + ((i / 3) * 7919 % 13 < 6 ? 20 : -20));
  }
  EXPECT_NEAR(psnr_dB(a, brighter), psnr_dB(a, noisy), 0.01);
  EXPECT_GT(ssim(a, brighter), 0.97);
  EXPECT_LT(ssim(a, noisy), 0.97);
  Picture flat = a;
  std::fill(flat.rgb.begin(), flat.rgb.end(), std::uint8_t(130));
  EXPECT_LT(ssim(a, flat), 0.1);
}

// Two flat pictures: only the term of the means is not 1.
TEST(Picture, SsimFollowsItsFormula) {
  const auto flat = [](std::uint8_t value) {
    return Picture{20, 16, std::vector<std::uint8_t>(20 * 16 * 3, value)};
  };
  const double c1 = 0.01 * 255 * 0.01 * 255;
  EXPECT_NEAR(ssim(flat(100), flat(150)), (2 * 100 * 150 + c1) / (100 * 100 + 150 * 150 + c1),
              1e-6);
}

TEST(Picture, SsimOfOtherSizesOrOfNextToNothingIsZero) {
  EXPECT_EQ(ssim(gradient(32, 16), gradient(16, 32)), 0.0);
  EXPECT_EQ(ssim(gradient(10, 40), gradient(10, 40)), 0.0);
  EXPECT_EQ(ssim(Picture{}, Picture{}), 0.0);
}

TEST(Picture, WritingIntoAMissingFolderFailsAndLeavesNothing) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(writePng(gradient(4, 4), folder / "no" / "a.png").ok());
  EXPECT_FALSE(writePng(Picture{}, folder / "empty.png").ok());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}
