// Files that are complete or not there: written beside the target, then renamed over it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace trephine {

// Calls `write` with a temporary path in the target's folder, then flushes and renames. Any failure
// (a full disk too) removes the temporary file and leaves what was at `target` untouched. The
// temporary name keeps the target's extension, since writers choose the format by it.
Status replaceFile(const std::filesystem::path& target,
                   const std::function<Status(const std::filesystem::path&)>& write);

// Whether a file can be made there that is not there yet: nothing has its name, be it a folder, a
// device or a broken link, and the folder takes it. `option` is what a person gave it with. Errors:
// CANNOT_WRITE, MISSING_FOLDER.
Status checkNewFile(const std::filesystem::path& file, const std::string& option);
// The folder alone: for files whose names come of what is read. Error: MISSING_FOLDER.
Status checkFolderOf(const std::filesystem::path& file, const std::string& option);

// CANNOT_WRITE with the reason of this errno, 0 where it is not known; nothing that was there is
// lost.
Error writeError(const std::filesystem::path& target, int error);

// What a person can do about a write that failed with this errno: space is named only where it is
// short.
std::string afterFailedWrite(int error);

// All bytes of a regular file; a link to one counts. A pipe or a device is not opened: it could
// keep its reader waiting for ever, or have no end. Errors: MISSING_FILE, NO_FILE (a folder, a pipe
// or a device), TOO_LARGE (more than `most_bytes`), CANNOT_READ.
Result<std::string> readWholeFile(const std::filesystem::path& file, std::size_t most_bytes);

Status writeTextFile(const std::filesystem::path& target, std::string_view text);

// Whether `bytes` can be written into this folder now: so many are written, and taken away again.
// For some 100 kB; base/disk_room.h tells of more. One thread at a time in a folder. Error:
// CANNOT_WRITE, of the folder.
Status tryRoom(const std::filesystem::path& folder, std::size_t bytes);

// Makes the folder and its parents.
Status makeFolder(const std::filesystem::path& folder);

// Where files go that nobody keeps: the environment's TMPDIR, or /tmp without one. Errors:
// NO_TEMPORARY_FOLDER.
Result<std::filesystem::path> temporaryFolder();

}  // namespace trephine
