// What the tests of the real window share: the case that they open and how they start.
#pragma once

#include <QApplication>
#include <QStandardPaths>
#include <QtTest>
#include <cstdio>

#include "ui/common/colours.h"
#include "ui/frame/start_up.h"
#include "volume/phantom.h"

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
