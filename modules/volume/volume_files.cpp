#include "volume/volume_files.h"

#include <exception>
#include <new>
#include <utility>

#include "base/codes.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/tr.h"
#include "volume/codes.h"
#include "volume/file_format.h"
#include "volume/voxel_reader.h"

namespace trephine {

namespace fs = std::filesystem;
using namespace file_format;

namespace {

using ReadHeader = Result<VolumeFileHeader> (*)(const fs::path&);

constexpr std::pair<const char*, ReadHeader> kEndings[] = {
    {".mha", readMetaImageHeader}, {".mhd", readMetaImageHeader}, {".nii", readNiftiHeader},
    {".nii.gz", readNiftiHeader},  {".nrrd", readNrrdHeader},     {".nhdr", readNrrdHeader},
    {".raw", readRawHeader},       {".json", readRawHeader}};

ReadHeader readerOf(const fs::path& file) {
  for (const auto& [ending, reader] : kEndings) {
    if (endsWith(file, ending)) return reader;
  }
  return nullptr;
}

Error tooLarge(const fs::path& file) {
  return Error{code::kTooLarge, tr("There is not enough memory for this volume"), file.string(),
               tr("Crop it or export it at a lower resolution")};
}

// What `work` returns, or an Error for what it throws.
template <class Work>
auto caught(const fs::path& file, Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return tooLarge(file);
  } catch (const std::exception&) {
    return unreadable(tr("The file cannot be read"), file);
  }
}

}  // namespace

bool isVolumeFile(const fs::path& file) {
  if (endsWith(file, ".json")) return sibling(file, ".raw").has_value();
  return readerOf(file) != nullptr;
}

std::optional<fs::path> fileItBelongsTo(const fs::path& file) {
  if (endsWith(file, ".json")) return sibling(file, ".raw");
  if (!endsWith(file, ".raw") || sibling(file, ".json")) return std::nullopt;
  const auto meta_image = sibling(file, ".mhd");
  return meta_image ? meta_image : sibling(file, ".nhdr");
}

Result<VolumeFileHeader> readVolumeFileHeader(const fs::path& file) {
  std::error_code ec;
  const fs::file_status status = fs::status(file, ec);
  if (!fs::exists(status)) {
    return Error{code::kMissingFile, tr("There is no such file"), file.string(),
                 tr("Check the path")};
  }
  if (!fs::is_regular_file(status)) {
    return unreadable(tr("This is a folder or a device, not a volume file"), file);
  }
  const ReadHeader reader = readerOf(file);
  if (!reader) {
    return unknownFormat(
        tr("Volumes are read from .mha, .mhd, .nii, .nii.gz, .nrrd, .nhdr and .raw files"), file,
        tr("Choose such a file, or import a DICOM folder"));
  }
  return caught(file, [&] { return reader(file); });
}

Result<VolumeFileHeader> inForm(VolumeFileHeader header, const std::string& form,
                                const fs::path& file) {
  if (header.forms.empty()) return header;
  for (const VolumeFileHeader::Form& one : header.forms) {
    if (one.name != form) continue;
    header.geometry = one.geometry;
    header.reversed_slices = one.reversed_slices;
    return header;
  }
  return Error{code::kFormsDiffer, header.contradiction, file.string(),
               tr("Import it with the answer FORMS_DIFFER={}{}, or export it again",
                  header.forms.front().name,
                  (header.forms.size() > 1 ? tr(" or {}", header.forms.back().name) : ""))};
}

Result<VolumeFileReading> readVolumeFile(const fs::path& file, const Progress& progress,
                                         const std::string& form) {
  auto header = readVolumeFileHeader(file);
  if (header) header = inForm(*std::move(header), form, file);
  if (!header) return header.error();
  if (header->layers > 1) {
    return notHu(tr("The image has several values a voxel: it is a segmentation in layers"), file);
  }
  return caught(file, [&] { return readVoxels(*std::move(header), file, progress); });
}

Result<Volume> readVolume(const fs::path& file, const Progress& progress,
                          const std::string& form) {
  auto reading = readVolumeFile(file, progress, form);
  if (!reading) return reading.error();
  return std::move(reading->volume);
}

Status checkVolumeFileName(const fs::path& file) {
  // Lower case only, whatever reads them later.
  const std::string name = file.filename().string();
  if (name.ends_with(".mha") || name.ends_with(".nii") || name.ends_with(".nii.gz")) return {};
  return unknownFormat(tr("Volumes are written as .mha, .nii or .nii.gz"), file,
                       tr("Give the file one of these endings"));
}

Status writeVolume(const VoxelSlabs& voxels, const fs::path& file, const Progress& progress,
                   const VolumeWriting& writing) {
  if (auto status = checkVolumeFileName(file); !status) return status;
  if (auto status = checkSize(voxels.geometry.size, file.string()); !status) return status;
  if (auto status = checkGeometry(voxels.geometry, file); !status) return status;
  if (leftHanded(voxels.geometry) != writing.reversed_slices) {
    return writeVolume(reversedSlices(voxels), file, progress, writing);
  }
  VoxelSlabs told = voxels;
  told.read = [&](std::size_t first, std::span<std::int16_t> into) {
    progress.at(double(first) / double(voxels.geometry.voxelCount()), tr("Saving the volume"));
    voxels.read(first, into);
  };
  Status saved = replaceFile(file, [&](const fs::path& temporary) -> Status {
    try {
      const Status written = endsWith(file, ".mha")
                                 ? writeMetaImage(told, writing.type, temporary, file, progress)
                                 : writeNifti(told, writing.type, temporary, file, progress);
      if (progress.cancelled()) return Error{code::kCancelled, tr("Saving was cancelled"), "", ""};
      return written;
    } catch (const std::bad_alloc&) {
      return outOfMemory(tr("to save the volume"), file.string());
    } catch (const std::exception&) {
      return cannotWrite(file);
    }
  });
  if (saved) progress.at(1.0, tr("Saving the volume"));
  return saved;
}

Status writeVolume(const Volume& volume, const fs::path& file) {
  return writeVolume(slabsOf(volume), file);
}

}  // namespace trephine
