// What a test program has in memory, and how much of it was hashed. Include it in one file of a
// program: it stands between the program and OpenSSL.
#pragma once

#include <dlfcn.h>
#include <openssl/evp.h>

#include <atomic>
#include <cstdint>
#include <fstream>
#include <string>

namespace trephine::test {

// Of voxels: texts are hashed as well, but they are short.
inline std::atomic<std::uint64_t> hashed_bytes{0};
constexpr std::size_t kLongestText = std::size_t(1) << 16;

// Pages that are this process's own and were written [MB of 2^20 bytes].
inline double privateDirtyMb() {
  std::ifstream in("/proc/self/smaps_rollup");
  std::string name, rest;
  while (in >> name) {
    double kilobytes = 0.0;
    if (name == "Private_Dirty:" && in >> kilobytes) return kilobytes / 1024.0;
    std::getline(in, rest);
  }
  return 0.0;
}

}  // namespace trephine::test

extern "C" inline __attribute__((used)) int EVP_DigestUpdate(EVP_MD_CTX* context, const void* bytes,
                                                             std::size_t count) {
  using Update = int (*)(EVP_MD_CTX*, const void*, std::size_t);
  static const auto update = reinterpret_cast<Update>(::dlsym(RTLD_NEXT, "EVP_DigestUpdate"));
  if (count > trephine::test::kLongestText) trephine::test::hashed_bytes += count;
  return update(context, bytes, count);
}
