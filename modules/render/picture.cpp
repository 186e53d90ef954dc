#include "render/picture.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/file.h"

namespace trephine {

namespace {

constexpr int kMaxEdge = 32768;

// With an observer VTK reports to it instead of printing.
class ErrorFlag {
 public:
  explicit ErrorFlag(vtkObject* object) {
    command_->SetClientData(&raised_);
    command_->SetCallback(
        [](vtkObject*, unsigned long, void* raised, void*) { *static_cast<bool*>(raised) = true; });
    object->AddObserver(vtkCommand::ErrorEvent, command_);
    object->AddObserver(vtkCommand::WarningEvent, command_);
  }
  bool raised() const { return raised_; }

 private:
  bool raised_ = false;
  vtkNew<vtkCallbackCommand> command_;
};

bool complete(const Picture& picture) {
  return picture.width > 0 && picture.height > 0 && picture.width <= kMaxEdge &&
         picture.height <= kMaxEdge &&
         picture.rgb.size() == std::size_t(picture.width) * std::size_t(picture.height) * 3;
}

}  // namespace

double psnr_dB(const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height || a.rgb.size() != b.rgb.size()) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double difference = double(a.rgb[i]) - double(b.rgb[i]);
    sum += difference * difference;
  }
  if (sum == 0.0) return std::numeric_limits<double>::infinity();
  return 10.0 * std::log10(255.0 * 255.0 * double(a.rgb.size()) / sum);
}

Status writePng(const Picture& picture, const std::filesystem::path& file) {
  if (!complete(picture)) {
    return Error{"BAD_PICTURE", "There is no picture to write", file.string(), ""};
  }
  vtkNew<vtkImageData> image;
  image->SetDimensions(picture.width, picture.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const std::size_t row = std::size_t(picture.width) * 3;
  auto* pixels = static_cast<std::uint8_t*>(image->GetScalarPointer());
  for (int y = 0; y < picture.height; ++y) {  // VTK's rows go up
    std::copy_n(picture.rgb.data() + std::size_t(picture.height - 1 - y) * row, row,
                pixels + std::size_t(y) * row);
  }
  return replaceFile(file, [&](const std::filesystem::path& target) -> Status {
    vtkNew<vtkPNGWriter> writer;
    const ErrorFlag error(writer);
    writer->SetFileName(target.c_str());
    writer->SetInputData(image);
    writer->Write();
    if (error.raised() || writer->GetErrorCode() != 0) {
      return Error{"WRITE_FAILED", "The picture could not be written", file.string(),
                   "Check the folder's rights and the space left on the disk"};
    }
    return {};
  });
}

}  // namespace trephine
