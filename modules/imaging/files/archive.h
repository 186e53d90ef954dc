// What archives hold, unpacked for as long as it is read: ZIP, tar, 7z, and single files packed by
// gzip, bzip2, xz or Zstandard, by libarchive.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/locked_folder.h"
#include "base/progress.h"
#include "base/result.h"

namespace trephine {

struct UnpackedArchives {
  LockedFolder folder;  // of this account alone, in the temporary folder
  std::size_t files = 0;
  std::vector<std::string>
      not_whole;  // why what of some could not be unpacked, without a file's name
};

// Unpacks into one folder, which goes with the result. Nothing in an archive leads out of it: files
// get numbers for names, but those of volumes, whose headers name others; links and devices are
// left out, archives within stay packed. An archive that unpacks to over a hundred times its size
// (and over 256 MB), to more than the disk has room for, or to over 200,000 files is given up.
// Errors: CANCELLED, NO_TEMPORARY_FOLDER, CANNOT_WRITE.
Result<UnpackedArchives> unpack(const std::vector<std::filesystem::path>& archives,
                                const Progress& progress = Progress());

}  // namespace trephine
