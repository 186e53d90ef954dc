#include "ui/views/way_to_screen.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

TEST(WayToScreen, IsCopiedWhereAProcessorDraws) {
  for (const char* renderer :
       {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "Software Rasterizer", "SWR (LLVM 9.0)",
        "virgl (LLVMPIPE (LLVM 15.0.7 256 bits))", "D3D12 (Microsoft Basic Render Driver)",
        "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (LLVM 10.0.0)), SwiftShader driver)"}) {
    EXPECT_EQ(wayToScreen(renderer, ""), WayToScreen::copied) << renderer;
  }
}

TEST(WayToScreen, IsComposedWhereAGraphicsCardDraws) {
  for (const char* renderer :
       {"Mesa Intel(R) UHD Graphics 620 (KBL GT2)", "NVIDIA GeForce RTX 3060/PCIe/SSE2",
        "AMD Radeon RX 6600 (navi23, LLVM 15.0.6, DRM 3.49, 6.1.0-18-amd64)", "virgl", "V3D 4.2",
        "zink (NVIDIA)", ""}) {
    EXPECT_EQ(wayToScreen(renderer, ""), WayToScreen::composed) << renderer;
  }
}

TEST(WayToScreen, IsWhatSomebodyDecidesForThemselves) {
  EXPECT_EQ(wayToScreen("llvmpipe", "composed"), WayToScreen::composed);
  EXPECT_EQ(wayToScreen("NVIDIA GeForce RTX 3060/PCIe/SSE2", "copied"), WayToScreen::copied);
  EXPECT_EQ(wayToScreen("llvmpipe", "fast"), WayToScreen::copied);
}

}  // namespace
}  // namespace trephine
