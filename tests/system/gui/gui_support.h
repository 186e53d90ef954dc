// What the tests of the real window share: the case that they open and how they start.
#pragma once

#include <QApplication>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <QtTest>
#include <cstdio>

#include "base/file.h"
#include "base/system.h"
#include "ui/common/colours.h"
#include "ui/frame/main_window.h"
#include "ui/frame/start_up.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine::test {

// The cranium on a grid so many times coarser: the tests are about the window.
inline Volume coarseCranium(int factor) {
  GridGeometry geometry = *phantomGeometry("cranium");
  for (int axis = 0; axis < 3; ++axis) {
    geometry.size[std::size_t(axis)] /= factor;
    geometry.spacing_mm[axis] *= double(factor);
  }
  return makePhantomOn(*phantomTruth("cranium"), geometry, kPhantomNoiseHu);
}

// A scene of the built-in cranium's kind on that case; both are written into the folder.
inline std::filesystem::path sceneOn(const Volume& volume, const std::filesystem::path& folder,
                                     const std::string& name) {
  const std::filesystem::path scenes = resourceFolder() / "scenes", of = folder / (name + ".mha");
  Json scene = *readJsonFile(scenes / "cranium.json");
  const auto makeAbsolute = [&](Json& path) {
    path = (scenes / path.get<std::string>()).lexically_normal().string();
  };
  scene["case"] = of.string();
  makeAbsolute(scene["tissues"]);
  makeAbsolute(scene["operator"]);
  for (Json& tool : scene["tools"]) makeAbsolute(tool["file"]);
  for (Json& arm : scene["arms"]) makeAbsolute(arm["device"]["config"]);
  const std::filesystem::path file = folder / (name + ".json");
  if (!writeVolume(volume, of) || !writeTextFile(file, scene.dump())) {
    qFatal("%s cannot be written", file.c_str());
  }
  return file;
}

// A test of one window, with a folder of its own.
class WindowTest : public QObject {
 protected:
  Workstation& workstation() { return window_->workstation(); }
  template <class Widget>
  Widget* find(const QString& name) {
    auto* widget = window_->findChild<Widget*>(name);
    if (!widget) qFatal("the window has no %s", qPrintable(name));
    return widget;
  }

  QTemporaryDir temporary_;
  std::unique_ptr<MainWindow> window_;
};

// A test program's main(): skipped, with exit code 77, where nothing can be drawn.
template <class Test>
int runInWindow(int argc, char** argv) {
  if (Status display = prepareDisplay(); !display) {
    std::printf("SKIP: %s\n", display.error().sentence().c_str());
    return 77;
  }
  QApplication application(argc, argv);
  QApplication::setApplicationName("trephine-test");
  QStandardPaths::setTestModeEnabled(true);
  colours::applyTheme(application);
  Test test;
  return QTest::qExec(&test, argc, argv);
}

}  // namespace trephine::test
