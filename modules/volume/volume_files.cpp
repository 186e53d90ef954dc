// Both formats in one file, over 400 lines: the only one of this room that includes VTK.
#include "volume/volume_files.h"

#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkMetaImageReader.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNIFTIImageWriter.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkShortArray.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <limits>
#include <new>

#include "base/file.h"
#include "volume/meta_image_header.h"

namespace trephine {

namespace fs = std::filesystem;

namespace {

// zlib and gzip cannot shrink data further than this, so a small file with a huge size is a lie.
constexpr double kMostCompression = 1040.0;

// NIfTI is RAS, we are LPS: x and y change sign.
const Mat4 kFlipXy{{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

Error unreadable(const std::string& what, const fs::path& file) {
  return Error{"UNREADABLE", what, file.string(), "Copy or export the file again"};
}
Error badGeometry(const std::string& what, const fs::path& file) {
  return Error{"BAD_GEOMETRY", what, file.string(),
               "Export it again with its orientation and voxel size"};
}
Error notHu(const std::string& what, const fs::path& file) {
  return Error{"NOT_HU", what, file.string(), "Export the CT as 16-bit whole numbers in HU"};
}
Error tooLarge(const fs::path& file) {
  return Error{"TOO_LARGE", "There is not enough memory for this volume", file.string(),
               "Crop it or export it at a lower resolution"};
}

bool endsWith(const std::string& name, const std::string& ending) {
  if (name.size() < ending.size()) return false;
  return std::equal(ending.rbegin(), ending.rend(), name.rbegin(), [](char a, char b) {
    return a == (b >= 'A' && b <= 'Z' ? char(b - 'A' + 'a') : b);
  });
}

// Keeps what VTK would print.
class VtkErrors : public vtkCommand {
 public:
  static VtkErrors* New() { return new VtkErrors; }
  void Execute(vtkObject*, unsigned long event, void*) override {
    seen = seen || event == vtkCommand::ErrorEvent;
  }
  bool seen = false;
};

template <class Algorithm>
void listen(Algorithm& algorithm, VtkErrors& errors) {
  for (unsigned long event : {vtkCommand::ErrorEvent, vtkCommand::WarningEvent}) {
    algorithm.AddObserver(event, &errors);
    algorithm.GetExecutive()->AddObserver(event, &errors);
  }
}

Status checkGeometry(const GridGeometry& geometry, const fs::path& file) {
  const Mat3& d = geometry.direction;
  for (int axis = 0; axis < 3; ++axis) {
    const double spacing = geometry.spacing_mm[axis];
    if (!std::isfinite(spacing) || spacing <= 0.0) {
      return badGeometry("A voxel size of " + std::to_string(spacing) + " mm is not possible",
                         file);
    }
    const double length = glm::length(d[axis]), dot = glm::dot(d[axis], d[(axis + 1) % 3]);
    // Also false for anything not finite.
    if (!(std::abs(length - 1.0) < 1e-3 && std::abs(dot) < 1e-3)) {
      return badGeometry("The image's axes are not at right angles or not of unit length", file);
    }
  }
  if (!isFinite(geometry.origin_mm)) return badGeometry("The image's position is no number", file);
  return {};
}

// Splits a voxel-to-patient matrix into spacing, direction and origin.
GridGeometry geometryFrom(const Mat4& affine, const Index3& size) {
  GridGeometry geometry;
  geometry.size = size;
  geometry.origin_mm = Vec3(affine[3]);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 column(affine[axis]);
    geometry.spacing_mm[axis] = glm::length(column);
    geometry.direction[axis] = column / geometry.spacing_mm[axis];
  }
  return geometry;
}

bool leftHanded(const GridGeometry& g) {
  return glm::determinant(g.direction) < 0.0;
}

// The same image with its slices in the opposite order.
void reverseSlices(Volume& volume) {
  GridGeometry& g = volume.geometry;
  g.origin_mm = g.toPatient_mm({0, 0, g.size[2] - 1});
  g.direction[2] = -g.direction[2];
  const auto slice = std::ptrdiff_t(g.size[0]) * g.size[1];
  for (int low = 0, high = g.size[2] - 1; low < high; ++low, --high) {
    std::swap_ranges(volume.hu.begin() + low * slice, volume.hu.begin() + (low + 1) * slice,
                     volume.hu.begin() + high * slice);
  }
}

// Value in the file -> HU.
struct Rescale {
  double slope = 1.0;
  double intercept = 0.0;
};

// Every value as int16, or false where one does not fit.
template <class Stored>
bool convert(const Stored* from, const Rescale& rescale, std::vector<std::int16_t>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    const double hu = std::floor(double(from[i]) * rescale.slope + rescale.intercept + 0.5);
    if (!(hu >= -32768.0 && hu <= 32767.0)) return false;
    to[i] = std::int16_t(hu);
  }
  return true;
}

Result<Volume> volumeFrom(vtkImageData& image, const GridGeometry& geometry, const Rescale& rescale,
                          const fs::path& file) {
  int size[3];
  image.GetDimensions(size);
  vtkDataArray* data = image.GetPointData()->GetScalars();
  if (!data || Index3{size[0], size[1], size[2]} != geometry.size ||
      data->GetNumberOfComponents() != 1 ||
      std::size_t(data->GetNumberOfTuples()) != geometry.voxelCount()) {
    return unreadable("The file's header does not fit its voxels", file);
  }
  Volume volume{geometry, std::vector<std::int16_t>(geometry.voxelCount())};
  bool fits = false;
  switch (data->GetDataType()) {
    vtkTemplateMacro(
        fits = convert(static_cast<const VTK_TT*>(data->GetVoidPointer(0)), rescale, volume.hu));
  }
  if (!fits) return notHu("The image holds values that are not HU: they need over 16 bits", file);
  if (leftHanded(volume.geometry)) reverseSlices(volume);
  return volume;
}

// The checksum of the voxels as they were packed: in the byte order of the file.
std::uint32_t adler32Of(vtkImageData& image, const MetaImageHeader& header) {
  std::size_t bytes = 0;
  vtkDataArray* data = image.GetPointData()->GetScalars();
  if (data) bytes = std::size_t(data->GetDataSize()) * std::size_t(data->GetDataTypeSize());
  const auto* memory = data ? static_cast<const std::uint8_t*>(data->GetVoidPointer(0)) : nullptr;
  const std::size_t swap = header.big_endian ? std::size_t(header.bytes_per_voxel) - 1 : 0;
  std::uint32_t a = 1, b = 0;
  for (std::size_t i = 0; i < bytes; ++i) {
    a = (a + memory[i ^ swap]) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

Result<Volume> readMetaImage(const fs::path& file) {
  const auto header = readMetaImageHeader(file);
  if (!header) return header.error();
  if (auto status = checkGeometry(header->geometry, file); !status) return status.error();
  const double bytes = double(header->geometry.voxelCount()) * header->bytes_per_voxel;
  if (double(header->data_bytes) * (header->compressed ? kMostCompression : 1.0) < bytes) {
    return unreadable("The file is cut short: its header promises more voxels than it holds", file);
  }
  const auto checksum = header->compressed ? readAdler32(*header) : std::nullopt;
  if (header->compressed && !checksum) {
    return unreadable("The file's compressed voxels are not in zlib's format", file);
  }
  vtkNew<VtkErrors> errors;
  vtkNew<vtkMetaImageReader> reader;
  listen(*reader, *errors);
  reader->SetFileName(file.c_str());
  reader->Update();
  if (errors->seen || reader->GetErrorCode() != 0) {
    return unreadable("The file's voxels cannot be read", file);
  }
  // VTK says nothing when voxels do not unpack, and hands out whatever was in memory.
  if (checksum && *checksum != adler32Of(*reader->GetOutput(), *header)) {
    return unreadable("The file's compressed voxels are damaged", file);
  }
  return volumeFrom(*reader->GetOutput(), header->geometry, {header->slope, header->intercept},
                    file);
}

// A number from a NIfTI matrix row or quaternion is a float; what it means: nifti1.h.
Result<Mat4> niftiVoxelToRas(vtkNIFTIImageHeader& h, const fs::path& file) {
  double unit_mm = 1.0;
  switch (h.GetXYZTUnits() & 7) {
    case 0:  // unknown: by custom mm
    case 2:
      break;
    case 1:
      unit_mm = 1000.0;
      break;
    case 3:
      unit_mm = 0.001;
      break;
    default:
      return badGeometry("The unit of length is unknown", file);
  }
  Mat4 affine(1.0);
  if (h.GetSFormCode() > 0) {
    const double* rows[3] = {h.GetSRowX(), h.GetSRowY(), h.GetSRowZ()};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) affine[column][row] = rows[row][column] * unit_mm;
    }
    return affine;
  }
  if (h.GetQFormCode() > 0) {
    const double b = h.GetQuaternB(), c = h.GetQuaternC(), d = h.GetQuaternD();
    const Quat q(std::sqrt(std::max(0.0, 1.0 - b * b - c * c - d * d)), b, c, d);
    const Mat3 rotation = glm::mat3_cast(glm::normalize(q));
    for (int axis = 0; axis < 3; ++axis) {
      const double sign = axis == 2 && h.GetPixDim(0) < 0.0 ? -1.0 : 1.0;
      affine[axis] = glm::dvec4(rotation[axis] * (sign * h.GetPixDim(axis + 1) * unit_mm), 0.0);
    }
    affine[3] = glm::dvec4(Vec3(h.GetQOffsetX(), h.GetQOffsetY(), h.GetQOffsetZ()) * unit_mm, 1.0);
    return affine;
  }
  return badGeometry("The file does not say how the image lies in the patient (no sform, no qform)",
                     file);
}

// Bytes of one voxel, or 0 for a type that is no whole number of one component.
int niftiIntegerBytes(int type) {
  switch (type) {
    case vtkNIFTIImageHeader::TypeUInt8:
    case vtkNIFTIImageHeader::TypeInt8:
      return 1;
    case vtkNIFTIImageHeader::TypeInt16:
    case vtkNIFTIImageHeader::TypeUInt16:
      return 2;
    case vtkNIFTIImageHeader::TypeInt32:
    case vtkNIFTIImageHeader::TypeUInt32:
      return 4;
    default:
      return 0;
  }
}

Result<Index3> niftiSize(vtkNIFTIImageHeader& h, const fs::path& file) {
  if (h.GetDim(0) < 3 || h.GetDim(0) > 7) {
    return unreadable("The image is not three-dimensional", file);
  }
  Index3 size;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = h.GetDim(axis + 1);
    size[axis] = int(std::clamp<long long>(n, -1, std::numeric_limits<int>::max()));
  }
  for (int d = 4; d <= int(h.GetDim(0)); ++d) {
    if (h.GetDim(d) > 1) return notHu("The image has several values a voxel or a time axis", file);
  }
  if (auto status = checkSize(size, file.string()); !status) return status.error();
  return size;
}

Result<Volume> readNifti(const fs::path& file) {
  vtkNew<VtkErrors> errors;
  vtkNew<vtkNIFTIImageReader> reader;
  listen(*reader, *errors);
  reader->SetFileName(file.c_str());
  reader->UpdateInformation();
  vtkNIFTIImageHeader* h = reader->GetNIFTIHeader();
  const std::string magic = h ? h->GetMagic() : "";
  if (magic != "n+1" && magic != "n+2") {
    return unreadable("The file is not a NIfTI image", file);
  }
  const auto size = niftiSize(*h, file);
  if (!size) {
    return size.error().code == "BAD_SIZE" ? unreadable(size.error().what, file) : size.error();
  }
  const int voxel_bytes = niftiIntegerBytes(h->GetDataType());
  if (voxel_bytes == 0) return notHu("The voxels are not whole numbers", file);
  const auto affine = niftiVoxelToRas(*h, file);
  if (!affine) return affine.error();
  GridGeometry geometry = geometryFrom(kFlipXy * *affine, *size);
  if (auto status = checkGeometry(geometry, file); !status) return status.error();
  Rescale rescale;
  if (h->GetSclSlope() != 0.0) rescale = {h->GetSclSlope(), h->GetSclInter()};
  if (!std::isfinite(rescale.slope) || !std::isfinite(rescale.intercept)) {
    return notHu("The rescale slope or intercept is no number", file);
  }
  const double bytes = double(geometry.voxelCount()) * voxel_bytes;
  std::error_code ec;
  const double stored = double(fs::file_size(file, ec));
  const bool zipped = endsWith(file.filename().string(), ".gz");
  if (ec || stored * (zipped ? kMostCompression : 1.0) < bytes + (zipped ? 0 : 348)) {
    return unreadable("The file is cut short: its header promises more voxels than it holds", file);
  }
  if (errors->seen) return unreadable("The file's header cannot be read", file);
  reader->Update();
  if (errors->seen || reader->GetErrorCode() != 0) {
    return unreadable("The file's voxels cannot be read, or it is cut short", file);
  }
  // VTK hands out the slices in the opposite order where the header's first pixdim is negative.
  if (reader->GetQFac() < 0.0) {
    geometry.origin_mm = geometry.toPatient_mm({0, 0, geometry.size[2] - 1});
    geometry.direction[2] = -geometry.direction[2];
  }
  return volumeFrom(*reader->GetOutput(), geometry, rescale, file);
}

Error cannotWrite(const fs::path& file) {
  return Error{"CANNOT_WRITE", "The volume could not be written", file.string(),
               "Check free space and that you may write there; nothing that was there is lost"};
}

Status writeMetaImage(const Volume& volume, const fs::path& temporary, const fs::path& target) {
  std::ofstream out(temporary, std::ios::binary);
  out << metaImageHeaderText(volume.geometry);
  out.write(reinterpret_cast<const char*>(volume.hu.data()),
            std::streamsize(volume.hu.size() * sizeof(std::int16_t)));
  out.close();
  if (!out) return cannotWrite(target);
  return {};
}

// VTK 9.1 does not notice when the disk is full while gzip writes its last buffers, so the length
// is checked: the file's own, or the one that ends a gzip file (modulo 2^32).
bool isComplete(const fs::path& nifti, const Volume& volume) {
  const std::uint64_t expected = 352 + volume.hu.size() * sizeof(std::int16_t);
  std::error_code ec;
  if (!endsWith(nifti.filename().string(), ".gz")) return fs::file_size(nifti, ec) == expected;
  std::ifstream in(nifti, std::ios::binary);
  std::uint32_t length = 0;
  in.seekg(-4, std::ios::end);
  in.read(reinterpret_cast<char*>(&length), sizeof length);
  return in && length == std::uint32_t(expected);
}

Status writeNifti(const Volume& volume, const fs::path& temporary, const fs::path& target) {
  const GridGeometry& g = volume.geometry;
  vtkNew<vtkShortArray> voxels;
  // VTK only reads them; the 1 leaves them ours.
  voxels->SetArray(const_cast<short*>(volume.hu.data()), vtkIdType(volume.hu.size()), 1);
  vtkNew<vtkImageData> image;
  image->SetDimensions(g.size[0], g.size[1], g.size[2]);
  image->SetSpacing(g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z);
  image->GetPointData()->SetScalars(voxels);

  Mat4 directions(g.direction);
  directions[3] = glm::dvec4(g.origin_mm, 1.0);
  const Mat4 ras = kFlipXy * directions;
  vtkNew<vtkMatrix4x4> form;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) form->SetElement(row, column, ras[column][row]);
  }
  vtkNew<VtkErrors> errors;
  vtkNew<vtkNIFTIImageWriter> writer;
  listen(*writer, *errors);
  writer->SetInputData(image);
  writer->SetFileName(temporary.c_str());
  writer->SetDescription("Trephine");
  vtkNew<vtkNIFTIImageHeader> header;
  header->SetXYZTUnits(vtkNIFTIImageHeader::UnitsMM);
  writer->SetNIFTIHeader(header);
  writer->SetQFormMatrix(form);
  writer->SetSFormMatrix(form);
  writer->Write();
  if (errors->seen || writer->GetErrorCode() != 0 || !isComplete(temporary, volume)) {
    return cannotWrite(target);
  }
  return {};
}

enum class Format { unknown, metaImage, nifti };

Format formatOf(const fs::path& file) {
  const std::string name = file.filename().string();
  if (endsWith(name, ".mha") || endsWith(name, ".mhd")) return Format::metaImage;
  return endsWith(name, ".nii") || endsWith(name, ".nii.gz") ? Format::nifti : Format::unknown;
}

}  // namespace

Result<Volume> readVolume(const fs::path& file) {
  std::error_code ec;
  const fs::file_status status = fs::status(file, ec);
  if (!fs::exists(status)) {
    return Error{"MISSING_FILE", "There is no such file", file.string(), "Check the path"};
  }
  if (!fs::is_regular_file(status)) {
    return unreadable("This is a folder or a device, not a volume file", file);
  }
  try {
    switch (formatOf(file)) {
      case Format::metaImage:
        return readMetaImage(file);
      case Format::nifti:
        return readNifti(file);
      case Format::unknown:
        break;
    }
  } catch (const std::bad_alloc&) {
    return tooLarge(file);
  } catch (const std::exception&) {
    return unreadable("The file cannot be read", file);
  }
  return Error{"UNKNOWN_FORMAT", "Volumes are read from .mha, .mhd, .nii and .nii.gz files",
               file.string(), "Choose such a file, or import a DICOM folder"};
}

Status checkVolumeFileName(const fs::path& file) {
  // Lower case only: VTK's writer and replaceFile() go by the ending as it is.
  const std::string ending = file.extension().string();
  if (formatOf(file) == Format::unknown || (ending != ".mha" && ending != ".nii" && ending != ".gz")) {
    return Error{"UNKNOWN_FORMAT", "Volumes are written as .mha, .nii or .nii.gz", file.string(),
                 "Give the file one of these endings"};
  }
  return {};
}

Status writeVolume(const Volume& volume, const fs::path& file) {
  if (auto status = checkVolumeFileName(file); !status) return status;
  const Format format = formatOf(file);
  if (auto status = checkSize(volume.geometry.size, file.string()); !status) return status;
  if (auto status = checkGeometry(volume.geometry, file); !status) return status;
  if (leftHanded(volume.geometry)) {
    Volume turned = volume;
    reverseSlices(turned);
    return writeVolume(turned, file);
  }
  return replaceFile(file, [&](const fs::path& temporary) -> Status {
    try {
      return format == Format::metaImage ? writeMetaImage(volume, temporary, file)
                                         : writeNifti(volume, temporary, file);
    } catch (const std::exception&) {
      return cannotWrite(file);
    }
  });
}

}  // namespace trephine
