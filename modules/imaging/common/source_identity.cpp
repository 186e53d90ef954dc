#include "imaging/common/source_identity.h"

#include <system_error>

#include "base/utf8.h"

namespace trephine {

void SourceIdentity::add(IdentityKind kind, const std::string& text) {
  if (std::string clean = cleanUtf8(text); !clean.empty()) texts[kind].insert(std::move(clean));
}

void SourceIdentity::add(const SourceIdentity& other) {
  for (const auto& [kind, more] : other.texts) texts[kind].insert(more.begin(), more.end());
}

void SourceIdentity::addFile(const std::filesystem::path& file) {
  std::error_code ec;
  std::filesystem::path whole = std::filesystem::absolute(file, ec);
  if (ec) whole = file;
  add(IdentityKind::file, whole.filename().string());
  for (const std::filesystem::path& folder : whole.parent_path().relative_path()) {
    if (folder != "." && folder != "..") add(IdentityKind::folder, folder.string());
  }
}

}  // namespace trephine
