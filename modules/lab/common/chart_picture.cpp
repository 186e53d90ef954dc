#include "lab/common/chart_picture.h"

#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

// VTK finds its drivers and fonts through these.
#include <vtkAutoInit.h>
VTK_MODULE_INIT(vtkRenderingOpenGL2);
VTK_MODULE_INIT(vtkRenderingContextOpenGL2);
VTK_MODULE_INIT(vtkRenderingFreeType);

namespace trephine {

namespace {

constexpr int kFine = kChartFine;

Picture averaged(vtkUnsignedCharArray* pixels, int width, int height) {
  constexpr std::size_t kSamples = std::size_t(kFine) * kFine;
  const std::size_t row_bytes = std::size_t(width) * kFine * 3;
  if (pixels->GetNumberOfValues() != vtkIdType(row_bytes) * height * kFine) return {};
  Picture picture{width, height, {}};
  picture.rgb.reserve(std::size_t(width) * height * 3);
  for (int row = height - 1; row >= 0; --row) {  // VTK's rows go up
    const unsigned char* from = pixels->GetPointer(vtkIdType(row_bytes) * row * kFine);
    for (std::size_t x = 0; x < std::size_t(width); ++x) {
      for (std::size_t channel = 0; channel < 3; ++channel) {
        std::size_t sum = kSamples / 2;
        for (std::size_t i = 0; i < kSamples; ++i) {
          sum += from[(i / kFine) * row_bytes + (x * kFine + i % kFine) * 3 + channel];
        }
        picture.rgb.push_back(std::uint8_t(sum / kSamples));
      }
    }
  }
  return picture;
}

}  // namespace

Picture drawItems(std::initializer_list<vtkAbstractContextItem*> items, int width, int height) {
  vtkNew<vtkContextActor> actor;
  for (vtkAbstractContextItem* item : items) actor->GetScene()->AddItem(item);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->AddActor(actor);
  actor->GetScene()->SetRenderer(renderer);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetDPI(72);  // a point is a pixel
  window->SetSize(width * kFine, height * kFine);
  window->AddRenderer(renderer);
  window->Render();
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, width * kFine - 1, height * kFine - 1, 0, pixels);
  return averaged(pixels, width, height);
}

}  // namespace trephine
