// Pictures as files, and without a display: each in a process of its own, since an application
// object stays until its process ends.
#include <gtest/gtest.h>
#include <locale.h>

#include <QGuiApplication>
#include <QImage>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "plot/drawing.h"
#include "plot/fonts.h"
#include "support.h"

namespace trephine::plot {
namespace {

namespace fs = std::filesystem;

Plot plot() {
  Plot plot;
  plot.title = "A title";
  plot.x = {"Time", "s"};
  plot.y = {"Force", "N"};
  return plot;
}

TEST(PlotFiles, HoldThePictureThatWasDrawn) {
  const trephine::test::TemporaryFolder folder;
  const Result<Drawing> drawing = draw(plot());
  ASSERT_TRUE(drawing);
  ASSERT_TRUE(writePng(plot(), Theme::light, folder / "a.png"));
  EXPECT_EQ(QImage((folder / "a.png").c_str()).convertToFormat(QImage::Format_RGB32),
            drawing->image);
}

TEST(PlotFiles, ThatCannotBeWrittenAreAnErrorAndLeaveNothing) {
  const trephine::test::TemporaryFolder folder;
  fs::create_directories(folder / "a.png" / "in the way");
  EXPECT_FALSE(writePng(plot(), Theme::light, folder / "a.png"));
  EXPECT_FALSE(writePng(plot(), Theme::light, folder / "no" / "a.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

// Ends the child with 0 where the drawing did as `code` says; empty: it was drawn.
[[noreturn]] void drawAndExit(const std::string& code) {
  const Result<Drawing> drawing = draw(plot());
  const std::string got = drawing ? "" : drawing.error().code.str();
  if (!drawing) std::fprintf(stderr, "%s\n", drawing.error().sentence().c_str());
  std::exit(got == code ? 0 : 1);
}

class WithoutADisplay : public testing::Test {
 protected:
  WithoutADisplay() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(WithoutADisplay, PicturesAreDrawnWhateverQtsVariablesAskFor) {
  EXPECT_EXIT(
      {
        ::unsetenv("DISPLAY");
        ::setenv("QT_QPA_PLATFORM", "xcb", 1);
        ::setenv("QT_QPA_PLATFORMTHEME", "gtk3", 1);
        drawAndExit("");
      },
      testing::ExitedWithCode(0), "^$");
}

TEST_F(WithoutADisplay, AThreadOtherThanTheFirstDrawsToo) {
  EXPECT_EXIT(std::thread([] { drawAndExit(""); }).join(), testing::ExitedWithCode(0), "^$");
}

TEST_F(WithoutADisplay, NumbersKeepTheirPointAfterADrawing) {
  EXPECT_EXIT(
      {
        ::setenv("LC_ALL", "C.UTF-8", 1);  // one that every machine has
        if (!draw(plot())) std::exit(1);
        std::exit(std::string(setlocale(LC_ALL, nullptr)) == "C" ? 0 : 2);
      },
      testing::ExitedWithCode(0), "^$");
}

TEST_F(WithoutADisplay, AMissingPlatformIsAnErrorInWords) {
  EXPECT_EXIT(
      {
        QCoreApplication::setLibraryPaths({});
        drawAndExit("CANNOT_DRAW");
      },
      testing::ExitedWithCode(0), "libqt6gui6");
}

TEST_F(WithoutADisplay, MissingFontsAreAnErrorInWords) {
  const trephine::test::TemporaryFolder folder;
  std::ofstream(folder / "fonts.conf") << "<?xml version=\"1.0\"?><fontconfig><cachedir>"
                                       << folder.path().string() << "</cachedir></fontconfig>";
  const trephine::test::Environment fonts("FONTCONFIG_FILE", (folder / "fonts.conf").string());
  EXPECT_EXIT(drawAndExit("CANNOT_DRAW"), testing::ExitedWithCode(0), "fonts-dejavu-core");
}

[[noreturn]] void drawInAPlainApplication() {
  static int count = 1;
  static char name[] = "test";
  static char* arguments[] = {name, nullptr};
  const QCoreApplication application(count, arguments);
  drawAndExit("CANNOT_DRAW");
}

TEST_F(WithoutADisplay, AnApplicationThatDrawsNothingIsAnErrorInWords) {
  EXPECT_EXIT(drawInAPlainApplication(), testing::ExitedWithCode(0), "draws no pictures");
}

}  // namespace
}  // namespace trephine::plot
