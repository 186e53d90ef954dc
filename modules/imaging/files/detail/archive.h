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
  // Archives of which something could not be unpacked, in the order in which they were given: the
  // folder of what was, and why, without a file's name.
  struct NotWhole {
    std::filesystem::path folder;
    std::string why;
    bool damaged;  // rather than locked, or more than may be unpacked
  };
  std::vector<NotWhole> not_whole;
};

// Unpacks each into a folder of its own in one that goes with the result. Nothing in an archive
// leads out of it: files get numbers for names, but those of volumes, whose headers name others;
// links and devices are left out, archives within stay packed. A file that is damaged or locked is
// left out, and the rest unpacked. An archive that unpacks to over a hundred times its size (and
// over 256 MB), all of them to more than half of what the disk has free, or to over 200,000 files
// are given up. Errors: CANCELLED, NO_TEMPORARY_FOLDER, CANNOT_WRITE.
Result<UnpackedArchives> unpack(const std::vector<std::filesystem::path>& archives,
                                const Progress& progress = Progress());

}  // namespace trephine
