// Numbers that belong together, as trees: the lowest of a tree stands for all of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trephine {

class UnionFind {
 public:
  // Each of so many numbers a tree of its own.
  explicit UnionFind(std::size_t count) : parent_(count) {
    for (std::size_t n = 0; n < count; ++n) parent_[n] = std::uint32_t(n);
  }
  std::uint32_t root(std::uint32_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace trephine
