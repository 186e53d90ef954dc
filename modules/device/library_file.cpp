#include "device/library_file.h"

#include <elf.h>

#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "base/tr.h"
#include "device/codes.h"

namespace trephine {

namespace {

// Whether [offset, offset + size) lies in the first `all` bytes.
bool inside(std::uint64_t offset, std::uint64_t size, std::uint64_t all) {
  return offset <= all && size <= all - offset;
}

// Whether the file holds all that its tables name.
bool isWhole(std::ifstream& in, std::uint64_t bytes) {
  Elf64_Ehdr head{};
  if (!in.read(reinterpret_cast<char*>(&head), sizeof(head))) return false;
  if (std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_ident[EI_CLASS] != ELFCLASS64 ||
      head.e_phentsize != sizeof(Elf64_Phdr)) {
    return false;
  }
  if (!inside(head.e_phoff, std::uint64_t(head.e_phnum) * sizeof(Elf64_Phdr), bytes) ||
      !inside(head.e_shoff, std::uint64_t(head.e_shnum) * head.e_shentsize, bytes)) {
    return false;
  }
  std::vector<Elf64_Phdr> segments(head.e_phnum);
  in.seekg(std::streamoff(head.e_phoff));
  in.read(reinterpret_cast<char*>(segments.data()),
          std::streamsize(segments.size() * sizeof(Elf64_Phdr)));
  if (!in) return false;
  for (const Elf64_Phdr& segment : segments) {
    if (!inside(segment.p_offset, segment.p_filesz, bytes)) return false;
  }
  return true;
}

}  // namespace

Status checkLibraryFile(const std::filesystem::path& file) {
  std::error_code ec;
  const bool regular = std::filesystem::is_regular_file(file, ec);
  const std::uint64_t bytes = regular ? std::filesystem::file_size(file, ec) : 0;
  if (regular && !ec) {
    std::ifstream in(file, std::ios::binary);
    if (isWhole(in, bytes)) return {};
  }
  return Error{code::kNoPlugin,
               tr("The device plugin cannot be loaded: its file is no library, or is cut short"),
               file.string(), tr("Install it again")};
}

}  // namespace trephine
