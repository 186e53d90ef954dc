// The most that a session holds, for rooms that do not know each other and must agree on it. Tables,
// tags and recordings follow from these numbers.
#pragma once

namespace trephine {

constexpr int kMaxTissues = 16;  // of a set; their classes count from 0
constexpr int kMaxArms = 4;

}  // namespace trephine
