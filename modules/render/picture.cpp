#include "render/picture.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPNGWriter.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>

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

// CRC-32 of ISO 3309, as PNG uses it.
std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

// Every chunk is whole up to the end mark. Asked first, since VTK's reader ends the process on a
// file that was cut short or damaged.
bool pngIsWhole(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  const std::string_view bytes = text;
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::uint8_t(bytes[at + i]);
    return value;
  };
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n")) return false;
  for (std::size_t at = 8; bytes.size() - at >= 12;) {
    const std::size_t length = number(at);
    if (length > bytes.size() - at - 12) return false;
    const std::string_view chunk = bytes.substr(at + 4, 4 + length);
    if (crc32(chunk) != number(at + 8 + length)) return false;
    if (chunk.starts_with("IEND")) return true;
    at += 12 + length;
  }
  return false;
}

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

Result<Picture> readPng(const std::filesystem::path& file) {
  const Error bad{"BAD_PICTURE", "The file is not a PNG picture that can be read", file.string(),
                  "Give an 8-bit PNG file"};
  std::error_code ec;
  if (!std::filesystem::is_regular_file(file, ec)) {
    return Error{"MISSING_FILE", "There is no such file", file.string(), "Check the path"};
  }
  constexpr std::uintmax_t kLargest = std::uintmax_t(1) << 28;
  if (std::filesystem::file_size(file, ec) > kLargest || ec || !pngIsWhole(file)) return bad;
  vtkNew<vtkPNGReader> reader;
  const ErrorFlag error(reader);
  if (!reader->CanReadFile(file.c_str())) return bad;
  reader->SetFileName(file.c_str());
  reader->UpdateInformation();
  int extent[6];
  reader->GetDataExtent(extent);
  Picture picture;
  picture.width = extent[1] + 1;
  picture.height = extent[3] + 1;
  if (error.raised() || picture.width < 1 || picture.height < 1 || picture.width > kMaxEdge ||
      picture.height > kMaxEdge) {
    return bad;
  }
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  const int channels = image->GetNumberOfScalarComponents();
  if (error.raised() || reader->GetErrorCode() != 0 || !image->GetScalarPointer() ||
      image->GetScalarType() != VTK_UNSIGNED_CHAR ||
      image->GetNumberOfPoints() != vtkIdType(picture.width) * picture.height) {
    return bad;
  }
  picture.rgb.resize(std::size_t(picture.width) * std::size_t(picture.height) * 3);
  const bool grey = channels < 3;
  std::size_t to = 0;
  for (int y = 0; y < picture.height; ++y) {
    const auto* from =
        static_cast<const std::uint8_t*>(image->GetScalarPointer(0, picture.height - 1 - y, 0));
    for (int x = 0; x < picture.width; ++x, from += channels) {
      for (int c = 0; c < 3; ++c) picture.rgb[to++] = from[grey ? 0 : c];
    }
  }
  return picture;
}

}  // namespace trephine
