#include "base/state_archive.h"

#include <algorithm>
#include <string>

#include "base/codes.h"
#include "base/sha256.h"
#include "base/tr.h"

namespace trephine {

namespace {

constexpr std::size_t kStateKindBytes = 8, kStateHashBytes = 64;
constexpr std::size_t kStateHeadBytes =
    kStateKindBytes + sizeof(std::uint32_t) + sizeof(std::uint64_t) + kStateHashBytes;

std::array<char, kStateKindBytes> kindBytes(std::string_view kind) {
  std::array<char, kStateKindBytes> out{};
  std::copy_n(kind.begin(), std::min(kind.size(), kStateKindBytes), out.begin());
  return out;
}

Error badState(std::string_view kind, const std::string& what) {
  return {code::kBadState, what, tr("the state `{}`", kind),
          tr("Take it from the running exercise again, with the same release")};
}

}  // namespace

std::vector<std::byte> sealedState(std::string_view kind, std::uint32_t version,
                                   const StateWriter& state) {
  const std::string hash = sha256Hex(state.bytes().data(), state.bytes().size());
  StateWriter out;
  for (char c : kindBytes(kind)) out.scalar(c);
  out.scalar(version);
  out.scalar(std::uint64_t(state.bytes().size()));
  for (char c : hash) out.scalar(c);
  std::vector<std::byte> sealed = out.bytes();
  sealed.insert(sealed.end(), state.bytes().begin(), state.bytes().end());
  return sealed;
}

Result<std::span<const std::byte>> openedState(std::string_view kind, std::uint32_t version,
                                               std::span<const std::byte> sealed) {
  if (sealed.size() < kStateHeadBytes) {
    return badState(kind, tr("The bytes end within the state's head"));
  }
  StateReader head(sealed.first(kStateHeadBytes));
  std::array<char, kStateKindBytes> kind_read{};
  std::uint32_t version_read = 0;
  std::uint64_t length = 0;
  std::array<char, kStateHashBytes> hash{};
  head(kind_read, version_read, length, hash);
  if (kind_read != kindBytes(kind)) return badState(kind, tr("The bytes are no such state"));
  if (version_read != version) {
    return badState(kind, tr("The state is of version {}, this release reads version {}",
                             version_read, version));
  }
  const std::span<const std::byte> state = sealed.subspan(kStateHeadBytes);
  if (state.size() != length) {
    return badState(kind, tr("The state has {} bytes of {}", state.size(), length));
  }
  if (sha256Hex(state.data(), state.size()) != std::string_view(hash.data(), hash.size())) {
    return badState(kind, tr("The bytes are not those that were written"));
  }
  return state;
}

}  // namespace trephine
