#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace trephine {

// SHA-256, fed in pieces; `hex()` returns 64 lower-case digits and ends it: no call comes after it.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(const void* bytes, std::size_t count);
  std::string hex();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

std::string sha256Hex(const void* bytes, std::size_t count);

}  // namespace trephine
