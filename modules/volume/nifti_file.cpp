// NIfTI (.nii, .nii.gz), versions 1 and 2: VTK reads the header and writes the file; the voxels are
// read as every format's. What the header means: nifti1.h.
//
// NIfTI is RAS, we are LPS: x and y change sign here and nowhere else. The sform counts where there
// is one, else the qform; its unit of length, slope and intercept are honoured.
#include <vtkCommand.h>
#include <vtkExecutive.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageHeader.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNIFTIImageWriter.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkShortArray.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "volume/file_format.h"

namespace trephine::file_format {

namespace fs = std::filesystem;

namespace {

const Mat4 kFlipXy{{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

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

// A number from a NIfTI matrix row or quaternion is a float.
Result<Mat4> voxelToRas(vtkNIFTIImageHeader& h, const fs::path& file) {
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

std::optional<VoxelType> typeFrom(int type) {
  switch (type) {
    case vtkNIFTIImageHeader::TypeInt8:
      return VoxelType::int8;
    case vtkNIFTIImageHeader::TypeUInt8:
      return VoxelType::uint8;
    case vtkNIFTIImageHeader::TypeInt16:
      return VoxelType::int16;
    case vtkNIFTIImageHeader::TypeUInt16:
      return VoxelType::uint16;
    case vtkNIFTIImageHeader::TypeInt32:
      return VoxelType::int32;
    case vtkNIFTIImageHeader::TypeUInt32:
      return VoxelType::uint32;
    case vtkNIFTIImageHeader::TypeInt64:
      return VoxelType::int64;
    case vtkNIFTIImageHeader::TypeUInt64:
      return VoxelType::uint64;
    case vtkNIFTIImageHeader::TypeFloat32:
      return VoxelType::float32;
    case vtkNIFTIImageHeader::TypeFloat64:
      return VoxelType::float64;
    default:
      return std::nullopt;
  }
}

Result<Index3> sizeOf(vtkNIFTIImageHeader& h, const fs::path& file) {
  if (h.GetDim(0) < 3 || h.GetDim(0) > 7) {
    return unreadable("The image is not three-dimensional", file);
  }
  for (int d = 4; d <= int(h.GetDim(0)); ++d) {
    if (h.GetDim(d) > 1) return notHu("The image has several values a voxel or a time axis", file);
  }
  return sizeFrom({double(h.GetDim(1)), double(h.GetDim(2)), double(h.GetDim(3))}, file);
}

// VTK 9.1 does not notice when the disk is full while gzip writes its last buffers, so the length
// is checked: the file's own, or the one that ends a gzip file (modulo 2^32).
bool isComplete(const fs::path& nifti, const Volume& volume) {
  const std::uint64_t expected = 352 + volume.hu.size() * sizeof(std::int16_t);
  std::error_code ec;
  if (!endsWith(nifti, ".gz")) return fs::file_size(nifti, ec) == expected;
  std::ifstream in(nifti, std::ios::binary);
  std::uint32_t length = 0;
  in.seekg(-4, std::ios::end);
  in.read(reinterpret_cast<char*>(&length), sizeof length);
  return in && length == std::uint32_t(expected);
}

}  // namespace

Result<VolumeFileHeader> readNiftiHeader(const fs::path& file) {
  vtkNew<VtkErrors> errors;
  vtkNew<vtkNIFTIImageReader> reader;
  listen(*reader, *errors);
  reader->SetFileName(file.c_str());
  reader->UpdateInformation();
  vtkNIFTIImageHeader* h = reader->GetNIFTIHeader();
  const std::string magic = h ? h->GetMagic() : "";
  if (magic != "n+1" && magic != "n+2") return unreadable("The file is not a NIfTI image", file);

  VolumeFileHeader header;
  header.format = "NIfTI";
  const auto size = sizeOf(*h, file);
  if (!size) return size.error();
  const auto type = typeFrom(h->GetDataType());
  if (!type) return notHu("The voxels are not one number each", file);
  header.type = *type;
  const auto affine = voxelToRas(*h, file);
  if (!affine) return affine.error();
  header.geometry = geometryFrom(kFlipXy * *affine, *size);
  if (auto status = settle(header, file); !status) return status.error();
  if (h->GetSclSlope() != 0.0) {  // 0: values are as they are
    header.slope = h->GetSclSlope();
    header.intercept = h->GetSclInter();
  }
  if (!std::isfinite(header.slope) || !std::isfinite(header.intercept)) {
    return notHu("The rescale slope or intercept is no number", file);
  }
  if (errors->seen) return unreadable("The file's header cannot be read", file);
  header.big_endian = reader->GetDataByteOrder() == VTK_FILE_BYTE_ORDER_BIG_ENDIAN;

  // 0: right behind the header and the four bytes that follow it.
  const std::uint64_t header_bytes = magic == "n+1" ? 348 : 540;
  const auto start = std::uint64_t(h->GetVoxOffset() == 0 ? header_bytes + 4 : h->GetVoxOffset());
  if (start < header_bytes) return unreadable("The header's voxels start inside of it", file);
  const auto first = readStart(file, 2);
  header.data.file = file;
  header.data.packed = first && *first == "\x1f\x8b";
  if (header.data.packed) header.data.skip = start;
  const std::uint64_t offset = header.data.packed ? 0 : start;
  if (auto status = placeVoxels(header, offset, file); !status) return status.error();
  return header;
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
  for (int row = 0; row < 3; ++row) {
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

}  // namespace trephine::file_format
