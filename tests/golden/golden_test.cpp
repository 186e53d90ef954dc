// Pictures as the product drew them when someone last looked at them: README.md of tests.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "golden_view.h"
#include "unit/ui/qt_support.h"

using namespace trephine;
using namespace trephine::test;

namespace {

const std::filesystem::path kFolder = TREPHINE_GOLDEN;
const std::filesystem::path kArtefacts = TREPHINE_ARTEFACTS;

const std::vector<GoldenLine>& lines() {
  static const Result<std::vector<GoldenLine>> read = readGoldenLines(kFolder / "pictures.json");
  if (!read) {
    std::fprintf(stderr, "%s\n", read.error().sentence().c_str());
    std::exit(1);
  }
  return *read;
}

std::filesystem::path fileOf(const GoldenLine& line) {
  return kFolder / "pictures" / (line.name + ".png");
}

class Golden : public testing::TestWithParam<GoldenLine> {
 protected:
  void SetUp() override {
    const char* display = std::getenv("DISPLAY");
    if (!display || !*display) GTEST_SKIP() << "No display: this test draws and reads pixels";
    test::application();
  }
};

TEST_P(Golden, IsDrawnAsItWasAndNoWrongPicturePassesForIt) {
  const GoldenLine& line = GetParam();
  const Result<Picture> now = drawn(line);
  ASSERT_TRUE(now) << now.error().sentence();
  if (std::getenv("TREPHINE_RENEW_GOLDEN")) {
    ASSERT_TRUE(writePng(*now, fileOf(line)));
  }
  const Picture golden = pictureOf(QImage(QString::fromStdString(fileOf(line).string())));

  const double alike = likeness(golden, *now);
  if (alike < line.ssim) {
    const std::filesystem::path file = kArtefacts / ("golden_" + line.name + ".png");
    std::filesystem::create_directories(kArtefacts);
    ASSERT_TRUE(writePng(*now, file));
    ADD_FAILURE() << "SSIM " << alike << " < " << line.ssim << "\nis now " << file << "\nwas    "
                  << fileOf(line) << "\nRun this test with TREPHINE_RENEW_GOLDEN=1 if what is now "
                  << "is right";
  }
  std::printf("%-14s %.3f", line.name.c_str(), alike);
  const auto likenessOf = [&](const char* what, const Result<Picture>& picture) {
    const double of = picture ? likeness(golden, *picture) : 0.0;
    EXPECT_TRUE(picture) << picture.error().sentence();
    std::printf("; %s %.3f", what, of);
    return of;
  };
  EXPECT_GE(likenessOf("another driver", drawn(line, Change::driver)), line.ssim)
      << "the same picture must pass elsewhere, too";
  EXPECT_LT(likenessOf("mirrored", mirrored(*now)), line.ssim);
  EXPECT_LT(likenessOf("from beside", drawn(line, Change::view)), line.ssim);
  EXPECT_LT(likenessOf("without its tissue", drawn(line, Change::tissue)), line.ssim);
  if (line.slice) {
    EXPECT_LT(likenessOf("another window", drawn(line, Change::window)), line.ssim);
  }
  if (line.overlay != Overlay::none || line.outline) {
    EXPECT_LT(likenessOf("without colours", drawn(line, Change::colours)), line.ssim);
  }
  std::printf("\n");
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(lines()),
                         [](const auto& of) { return of.param.name; });

TEST(GoldenPictures, HaveEachALineOfTheirOwn) {
  std::set<std::string> named, found;
  for (const GoldenLine& line : lines()) {
    EXPECT_TRUE(named.insert(line.name + ".png").second) << line.name << " is there twice";
  }
  for (const auto& file : std::filesystem::directory_iterator(kFolder / "pictures")) {
    found.insert(file.path().filename().string());
  }
  EXPECT_EQ(found, named);
}

}  // namespace
