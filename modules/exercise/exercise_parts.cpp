#include "exercise/exercise_parts.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>

#include "base/file.h"
#include "base/json.h"
#include "base/sha256.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

// On the disk, and not only promised to be.
Status sync(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  return synced ? Status() : Status(writeError(path, error));
}

}  // namespace

std::string plainName(const std::string& text, const std::string& otherwise) {
  constexpr std::size_t kMost = 40;
  std::string name;
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (letter) {
      name += char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
    if (name.size() == kMost) break;
  }
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name.empty() ? otherwise : name;
}

Status checkFreeFolder(const fs::path& folder) {
  std::error_code ec;
  const fs::file_status status = fs::symlink_status(folder, ec);
  if (!fs::exists(status)) return {};
  if (fs::is_directory(status) && fs::is_empty(folder, ec) && !ec) return {};
  return Error{"CANNOT_WRITE", "Something is there already", folder.string(),
               "Give a folder that is not there yet, or an empty one"};
}

Result<ExercisePart> partOf(const fs::path& folder, const std::string& file,
                            const Progress& progress) {
  const fs::path path = folder / file;
  std::error_code ec;
  if (fs::symlink_status(path, ec).type() != fs::file_type::regular) {
    return Error{"MISSING_FILE", "It is not there, or is no file", file, ""};
  }
  std::ifstream in(path, std::ios::binary);
  Sha256 sha256;
  ExercisePart part{file, "", 0};
  std::vector<char> bytes(1 << 20);
  while (in) {
    if (progress.cancelled()) return Error{"CANCELLED", "It was cancelled", "", ""};
    in.read(bytes.data(), std::streamsize(bytes.size()));
    sha256.add(bytes.data(), std::size_t(in.gcount()));
    part.bytes += std::uint64_t(in.gcount());
  }
  if (!in.eof()) return Error{"UNREADABLE", "It cannot be read", file, ""};
  part.sha256 = sha256.hex();
  return part;
}

Result<PartFolder> PartFolder::make(const fs::path& target) {
  std::error_code ec;
  const fs::path whole = fs::absolute(target, ec).lexically_normal();
  const fs::path name = whole.has_filename() ? whole.filename() : whole.parent_path().filename();
  const fs::path parent =
      whole.has_filename() ? whole.parent_path() : whole.parent_path().parent_path();
  if (Status made = makeFolder(parent); !made) return made.error();
  std::string path = (parent / ("." + name.string() + ".part-XXXXXX")).string();
  if (!::mkdtemp(path.data())) return writeError(target, errno);
  // mkdtemp's are for their owner alone.
  fs::permissions(path, fs::perms(0755), ec);
  return PartFolder(path);
}

PartFolder::~PartFolder() {
  std::error_code ec;
  if (!path_.empty()) fs::remove_all(path_, ec);
}

Status PartFolder::write(const std::string& file,
                         const std::function<Status(const fs::path&)>& write) {
  const fs::path path = path_ / file;
  if (Status made = makeFolder(path.parent_path()); !made) return made;
  if (Status written = write(path); !written) return written;
  return sync(path);
}

Status PartFolder::writeText(const std::string& file, std::string_view text) {
  return write(file, [&](const fs::path& path) { return writeTextFile(path, text); });
}

Status PartFolder::copy(const fs::path& from, const std::string& file) {
  std::error_code ec;
  if (!fs::is_regular_file(from, ec)) {
    return Error{"MISSING_FILE", "A file that the exercise names is not there", from.string(),
                 "Check the name"};
  }
  return write(file, [&](const fs::path& path) {
    std::error_code failed;
    fs::copy_file(from, path, failed);
    return failed ? Status(writeError(path, failed.value())) : Status();
  });
}

Result<std::vector<ExercisePart>> PartFolder::writeList(const std::string& scene,
                                                        const Progress& progress) {
  std::vector<std::string> files;
  std::error_code ec;
  for (auto it = fs::recursive_directory_iterator(path_, ec); !ec && it != fs::end(it);
       it.increment(ec)) {
    if (it->is_regular_file(ec)) files.push_back(fs::relative(it->path(), path_, ec).string());
  }
  if (ec) return writeError(path_, ec.value());
  std::ranges::sort(files, {}, [&](const std::string& f) { return std::pair(f != scene, f); });
  std::vector<ExercisePart> parts;
  Json list = Json::array();
  for (const std::string& file : files) {
    progress.at(double(parts.size()) / double(files.size()), "Checking what was written");
    Result<ExercisePart> part = partOf(path_, file, progress);
    if (!part) return part.error();
    list.push_back({{"file", file}, {"sha256", part->sha256}, {"bytes", part->bytes}});
    parts.push_back(*std::move(part));
  }
  const Json json = {
      {"format", "trephine.exercise"}, {"version", 1}, {"scene", scene}, {"parts", list}};
  if (Status written = writeText(kListFile, json.dump(1) + '\n'); !written) return written.error();
  return parts;
}

Status PartFolder::become(const fs::path& target) {
  std::error_code ec;
  const fs::path whole = fs::absolute(target, ec).lexically_normal();
  const fs::path to = whole.has_filename() ? whole : whole.parent_path();
  if (Status synced = sync(path_); !synced) return synced;
  if (::rename(path_.c_str(), to.c_str()) != 0) return writeError(target, errno);
  path_.clear();
  return sync(to.parent_path());
}

}  // namespace trephine
