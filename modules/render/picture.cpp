#include "render/picture.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/codes.h"
#include "base/file.h"
#include "base/purpose.h"
#include "base/tr.h"
#include "render/codes.h"

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

// Values of each pixel, rows from the top.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;
};

Plane luminance(const Picture& picture) {
  Plane plane{picture.width, picture.height, {}};
  plane.values.reserve(picture.rgb.size() / 3);
  for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {  // Rec. 601
    plane.values.push_back(0.299 * picture.rgb[i] + 0.587 * picture.rgb[i + 1] +
                           0.114 * picture.rgb[i + 2]);
  }
  return plane;
}

constexpr int kWindow = 11;

// Means over the windows that lie in the plane.
Plane windowMeans(const Plane& of) {
  constexpr double sigma = 1.5;
  double weights[kWindow], sum = 0.0;
  for (int i = 0; i < kWindow; ++i) {
    const double x = i - kWindow / 2;
    sum += weights[i] = std::exp(-x * x / (2.0 * sigma * sigma));
  }
  for (double& weight : weights) weight /= sum;
  const int width = of.width - kWindow + 1, height = of.height - kWindow + 1;
  std::vector<double> rows;
  rows.reserve(std::size_t(width) * std::size_t(of.height));
  for (int y = 0; y < of.height; ++y) {
    const double* row = of.values.data() + std::size_t(y) * std::size_t(of.width);
    for (int x = 0; x < width; ++x) {
      double mean = 0.0;
      for (int i = 0; i < kWindow; ++i) mean += weights[i] * row[x + i];
      rows.push_back(mean);
    }
  }
  Plane means{width, height, {}};
  means.values.reserve(std::size_t(width) * std::size_t(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double mean = 0.0;
      for (int i = 0; i < kWindow; ++i) {
        mean += weights[i] * rows[std::size_t(y + i) * std::size_t(width) + std::size_t(x)];
      }
      means.values.push_back(mean);
    }
  }
  return means;
}

Plane product(const Plane& a, const Plane& b) {
  Plane out = a;
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] *= b.values[i];
  return out;
}

}  // namespace

double ssim(const Picture& a, const Picture& b) {
  if (!complete(a) || !complete(b) || a.width != b.width || a.height != b.height) return 0.0;
  if (std::min(a.width, a.height) < kWindow) return 0.0;
  constexpr double c1 = 0.01 * 255.0 * 0.01 * 255.0, c2 = 0.03 * 255.0 * 0.03 * 255.0;
  const Plane of_a = luminance(a), of_b = luminance(b);
  const Plane mean_a = windowMeans(of_a), mean_b = windowMeans(of_b);
  const Plane aa = windowMeans(product(of_a, of_a)), bb = windowMeans(product(of_b, of_b));
  const Plane ab = windowMeans(product(of_a, of_b));
  double sum = 0.0;
  for (std::size_t i = 0; i < aa.values.size(); ++i) {
    const double ma = mean_a.values[i], mb = mean_b.values[i];
    const double var_a = aa.values[i] - ma * ma, var_b = bb.values[i] - mb * mb;
    const double covariance = ab.values[i] - ma * mb;
    sum += (2.0 * ma * mb + c1) * (2.0 * covariance + c2) /
           ((ma * ma + mb * mb + c1) * (var_a + var_b + c2));
  }
  return sum / double(aa.values.size());
}

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
    return Error{code::kBadPicture, tr("There is no picture to write"), file.string(), ""};
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
    writer->AddText("Description", kPurpose);
    writer->SetFileName(target.c_str());
    writer->SetInputData(image);
    writer->Write();
    if (error.raised() || writer->GetErrorCode() != 0) {
      return Error{code::kWriteFailed, tr("The picture could not be written"), file.string(),
                   tr("Check the folder's rights and the space left on the disk")};
    }
    return {};
  });
}

}  // namespace trephine
