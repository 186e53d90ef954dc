// Whether voxels can be Hounsfield units at all, told from a sample of them that is taken while
// they are read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace trephine {

// Calls visit(index) for a sample of `count` voxels: all of a small block, about one in 128 of
// a large one. The steps are uneven, so that no width of a slice gives the same columns again.
template <class Visit>
void visitSample(std::size_t count, const Visit& visit) {
  constexpr std::size_t kSmall = 16384;
  constexpr std::uint32_t kFactor = 1664525, kTerm = 1013904223;  // of a common generator
  const bool all = count < kSmall;
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < count;) {
    visit(i);
    state = state * kFactor + kTerm;
    i += all ? 1 : 1 + (state >> 24);
  }
}

// How often each HU occurs. What a file itself calls padding is not added.
class HuSanityCheck {
 public:
  HuSanityCheck() : counts_(65536) {}

  void add(std::span<const std::int16_t> hu);
  // A sample of them. So many of those at kAirHu are no values: what stood there was no number.
  void addSampleOf(std::span<const std::int16_t> hu, std::uint64_t not_numbers);

  // A reason that was found elsewhere, in words for a sentence; the others are not looked for then.
  void doubt(std::string why) { found_elsewhere_.push_back(std::move(why)); }

  // Why these can hardly be HU, each for a sentence in words; empty where they can. `lowest` and
  // `highest` are of all voxels, padding as air among them.
  std::vector<std::string> doubts(int lowest, int highest) const;
  // Whether anything lies where air does.
  bool hasAir() const;

 private:
  std::uint64_t count(int from, int to) const;  // both ends among them

  std::vector<std::uint32_t> counts_;  // of HU + 32768
  std::vector<std::string> found_elsewhere_;
};

}  // namespace trephine
