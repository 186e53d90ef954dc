// Pictures that leave the window.
#include "ui/views/saved_picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "qt_support.h"

namespace trephine {
namespace {

Picture grey(int width, int height) {
  Picture picture{width, height, {}};
  for (int n = 0; n < width * height * 3; ++n) picture.rgb.push_back(std::uint8_t(n % 251));
  return picture;
}

// Light pixels of the strip by column: where letters are.
std::vector<int> lettersOf(const Picture& saved, int from_row) {
  std::vector<int> light(std::size_t(saved.width), 0);
  for (int y = from_row; y < saved.height; ++y) {
    for (int x = 0; x < saved.width; ++x) {
      light[std::size_t(x)] += saved.rgb[std::size_t(y * saved.width + x) * 3] > 150;
    }
  }
  return light;
}

class SavedPicture : public testing::Test {
 private:
  QApplication& application_ = test::application();  // fonts
};

TEST_F(SavedPicture, SaysBelowItselfWhatItIsForAndHidesNothing) {
  for (const auto& [width, height] :
       {std::pair{1280, 720}, {3840, 2160}, {640, 480}, {401, 300}, {250, 250}}) {
    const Picture seen = grey(width, height);
    const Picture saved = withPurpose(seen);
    ASSERT_EQ(saved.width, width);
    ASSERT_EQ(saved.rgb.size(), std::size_t(3 * width * saved.height));
    EXPECT_TRUE(std::equal(seen.rgb.begin(), seen.rgb.end(), saved.rgb.begin()))
        << "all of the picture is there";
    const int strip = saved.height - height;
    EXPECT_GE(strip, 10) << width;
    EXPECT_LE(strip, std::max(24, height / 20)) << width << ": small";
    const std::vector<int> light = lettersOf(saved, height);
    const auto letters = std::ranges::count_if(light, [](int n) { return n > 0; });
    EXPECT_GT(letters, 100) << width << ": some fifty letters";
    // All of it: nothing is cut off at the edges.
    EXPECT_EQ(light.front() + light.back(), 0) << width;
  }
}

TEST_F(SavedPicture, OfNothingStaysNothing) {
  EXPECT_EQ(withPurpose({}), Picture{});
  const Picture torn{10, 10, {1, 2, 3}};
  EXPECT_EQ(withPurpose(torn), torn);
}

}  // namespace
}  // namespace trephine
