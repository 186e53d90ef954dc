#include "exchange/exercise_parts.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "base/codes.h"
#include "base/file.h"
#include "base/json.h"
#include "base/sha256.h"
#include "base/shared_folder.h"
#include "base/sync_folder.h"
#include "base/tr.h"
#include "exchange/codes.h"
#include "volume/codes.h"

namespace trephine {

namespace fs = std::filesystem;

// Of folders that are being written.
constexpr const char* kPart = ".trephine-part-";
constexpr int kMostNames = 1000;

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
  return Error{code::kCannotWrite, tr("Something is there already"), folder.string(),
               tr("Give a folder that is not there yet, or an empty one")};
}

Json toJson(const ExercisePart& part) {
  return {{"file", part.file}, {"sha256", part.sha256}, {"bytes", part.bytes}};
}

Result<ExercisePart> partOf(const fs::path& folder, const std::string& file,
                            const Progress& progress, std::optional<std::uint64_t> expected_bytes) {
  const fs::path path = folder / file;
  std::error_code ec;
  bool linked = false;  // a folder of it, out of here
  for (fs::path up = fs::path(file).parent_path(); !up.empty(); up = up.parent_path()) {
    const fs::path part_of = folder / up;
    linked = linked || fs::symlink_status(part_of, ec).type() == fs::file_type::symlink;
  }
  if (linked || fs::symlink_status(path, ec).type() != fs::file_type::regular) {
    return Error{code::kMissingFile, tr("It is not there, or is no file"), file, ""};
  }
  // Of another size it is another file, whatever it holds.
  if (expected_bytes && fs::file_size(path, ec) != *expected_bytes) {
    return Error{code::kOtherSize, tr("It has another size"), file, ""};
  }
  std::ifstream in(path, std::ios::binary);
  Sha256 sha256;
  ExercisePart part{file, "", 0};
  std::vector<char> bytes(1 << 20);
  while (in) {
    if (progress.cancelled()) return Error{code::kCancelled, tr("It was cancelled"), "", ""};
    in.read(bytes.data(), std::streamsize(bytes.size()));
    sha256.add(bytes.data(), std::size_t(in.gcount()));
    part.bytes += std::uint64_t(in.gcount());
    if (expected_bytes && part.bytes > *expected_bytes) break;  // it grows meanwhile
  }
  if (expected_bytes && part.bytes != *expected_bytes) {
    return Error{code::kOtherSize, tr("It has another size"), file, ""};
  }
  if (!in.eof()) return Error{code::kUnreadable, tr("It cannot be read"), file, ""};
  part.sha256 = sha256.hex();
  return part;
}

void PartFolder::removeLeft(const fs::path& folder) {
  LockedFolder::removeLeft(folder, kPart);
}

Result<PartFolder> PartFolder::make(const fs::path& target) {
  std::error_code ec;
  fs::path to = fs::absolute(target, ec).lexically_normal();
  if (!to.has_filename()) to = to.parent_path();  // it ended with a slash
  if (Status made = makeFolder(to.parent_path()); !made) return made.error();
  removeLeft(to.parent_path());
  auto folder =
      LockedFolder::make(to.parent_path(), "." + to.filename().string() + kPart, target);
  if (!folder) return folder.error();
  // It is for its owner alone so far.
  fs::permissions(folder->path(), fs::perms(0755), ec);
  giveToGroup(folder->path());
  return PartFolder(*std::move(folder), to);
}

Status PartFolder::write(const std::string& file,
                         const std::function<Status(const fs::path&)>& write) {
  const fs::path whole = path() / file;
  if (Status made = makeFolder(whole.parent_path()); !made) return made;
  return write(whole);
}

Status PartFolder::writeText(const std::string& file, std::string_view text) {
  return write(file, [&](const fs::path& path) { return writeTextFile(path, text); });
}

Status PartFolder::copy(const fs::path& from, const std::string& file) {
  std::error_code ec;
  if (!fs::is_regular_file(from, ec)) {
    return Error{code::kMissingFile, tr("A file that the exercise names is not there"),
                 from.string(), tr("Check the name")};
  }
  return write(file, [&](const fs::path& path) {
    return replaceFile(path, [&](const fs::path& temporary) {
      std::error_code failed, none;
      fs::copy_file(from, temporary, failed);
      if (!failed) return Status();
      // A full disk comes as an error of the device from the copying of the system.
      const fs::path beside = temporary.parent_path();
      const fs::space_info room = fs::space(beside, none);
      const bool full = !none && room.available < fs::file_size(from, none);
      return Status(writeError(target_ / file, full ? ENOSPC : failed.value()));
    });
  });
}

namespace {

// Of an STL file, binary (80 bytes, a count, 50 bytes a triangle) or text ("solid NAME" to
// "endsolid NAME").
std::optional<std::string> withoutHeader(std::string stl) {
  constexpr std::size_t kHeader = 80, kFirst = 84, kTriangle = 50;
  std::uint32_t count = 0;
  if (stl.size() >= kFirst) std::memcpy(&count, stl.data() + kHeader, sizeof count);
  if (stl.size() == kFirst + kTriangle * std::size_t(count)) {
    std::fill_n(stl.begin(), kHeader, '\0');
    return stl;
  }
  const std::size_t begin = stl.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos || stl.compare(begin, 5, "solid") != 0) return {};
  std::string text;
  std::istringstream lines(stl);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(" \t");
    const auto is = [&](const char* word) {
      return first != std::string::npos && line.compare(first, std::strlen(word), word) == 0;
    };
    text += (is("solid") ? "solid" : is("endsolid") ? "endsolid" : line) + '\n';
  }
  return text;
}

}  // namespace

Status PartFolder::copyMesh(const fs::path& from, const std::string& file) {
  constexpr std::size_t kMost = std::size_t{256} << 20;
  Result<std::string> stl = readWholeFile(from, kMost);
  if (!stl) return copy(from, file);  // which says what is wrong with it
  const std::optional<std::string> plain = withoutHeader(*std::move(stl));
  if (plain) return writeText(file, *plain);
  return Error{code::kNotStl, tr("A mesh of the exercise is not an STL file, or a damaged one"),
               from.string(), tr("Choose another mesh, or none")};
}

Result<std::vector<ExercisePart>> PartFolder::writeList(const std::string& exercise,
                                                        const Progress& progress) {
  std::vector<std::string> files;
  std::error_code ec;
  for (auto it = fs::recursive_directory_iterator(path(), ec); !ec && it != fs::end(it);
       it.increment(ec)) {
    if (it->is_regular_file(ec)) files.push_back(fs::relative(it->path(), path(), ec).string());
  }
  if (ec) return writeError(path(), ec.value());
  std::ranges::sort(files, {}, [&](const std::string& f) { return std::pair(f != exercise, f); });
  std::vector<ExercisePart> parts;
  Json list = Json::array();
  for (const std::string& file : files) {
    progress.at(double(parts.size()) / double(files.size()), tr("Checking what was written"));
    Result<ExercisePart> part = partOf(path(), file, progress);
    if (!part) return part.error();
    list.push_back(toJson(*part));
    parts.push_back(*std::move(part));
  }
  const Json json = {
      {"format", "trephine.exercise"}, {"version", 1}, {"scene", exercise}, {"parts", list}};
  if (Status written = writeText(kListFile, json.dump(1) + '\n'); !written) return written.error();
  return parts;
}

// As they are, links and empty folders too: the same file under a second name where the disk knows
// that, so that a large one costs nothing. What has a name that the exercise needs now gets
// another.
Status PartFolder::keepOthers(const std::set<fs::path>& own) {
  std::error_code ec;
  for (auto it = fs::recursive_directory_iterator(target_, ec); !ec && it != fs::end(it);
       it.increment(ec)) {
    const fs::path file = it->path().lexically_relative(target_);
    if (own.contains(file)) continue;
    fs::path to = path() / file;
    std::error_code none;
    if (it->is_directory(none) && !it->is_symlink(none)) {
      if (Status made = makeFolder(to); !made) return made;
      continue;
    }
    const fs::path stem = to.parent_path() / to.stem(), extension = to.extension();
    for (int n = 1; fs::symlink_status(to, none).type() != fs::file_type::not_found; ++n) {
      if (n > kMostNames) return writeError(it->path(), 0);
      to = stem.string() + "-kept" + (n > 1 ? std::to_string(n) : "") + extension.string();
    }
    fs::create_hard_link(it->path(), to, none);
    if (!none) continue;
    none.clear();
    fs::copy(it->path(), to, fs::copy_options::copy_symlinks, none);
    if (none) return writeError(it->path(), none.value());
  }
  return ec ? Status(writeError(target_, ec.value())) : Status();
}

Status PartFolder::becomeInstead(const std::set<fs::path>& own) {
  std::error_code ec;
  if (fs::symlink_status(target_, ec).type() == fs::file_type::not_found) return become();
  if (Status kept = keepOthers(own); !kept) return kept;
  if (Status synced = syncFolder(path()); !synced) return synced;
  if (::renameat2(AT_FDCWD, path().c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0) {
    // A file system without exchange: the one that was there stays beside it until it is done.
    if (errno != EINVAL && errno != ENOSYS) return writeError(target_, errno);
    const fs::path aside = path().string() + ".old";
    if (::rename(target_.c_str(), aside.c_str()) != 0) return writeError(target_, errno);
    giveToGroup(path());
    if (::rename(path().c_str(), target_.c_str()) != 0) {
      const int why = errno;
      (void)::rename(aside.c_str(), target_.c_str());
      return writeError(target_, why);
    }
    folder_.moveTo(aside);
  }
  // What was there lies in this part's place now, and goes with it.
  return syncFolder(target_.parent_path());
}

Status PartFolder::becomeAt(const fs::path& target) {
  target_ = target;
  return become();
}

Status PartFolder::become() {
  if (Status synced = syncFolder(path()); !synced) return synced;
  giveToGroup(path());
  if (::rename(path().c_str(), target_.c_str()) != 0) return writeError(target_, errno);
  folder_.keep();
  return syncFolder(target_.parent_path());
}

}  // namespace trephine
