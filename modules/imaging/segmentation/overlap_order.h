// An order of structures that share voxels, as a person gives it. Pure.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "volume/segmentation.h"

namespace trephine {

// How such an answer to OVERLAP begins: "order:vessel,liver".
constexpr const char* kOrderAnswer = "order:";

// "order:" and the names; the first has the voxels that it shares.
std::string orderAnswer(const std::vector<std::string>& names);

// Places in `segments`, for merged(): those that are named first, in that order, then the others,
// the smaller before the larger. Names are compared as sameName() does; a name may hold commas, and
// one that stands twice in the file is the first of the two, named again the second. Error:
// BAD_CHOICE where a name is of none of them, or there is none.
Result<std::vector<std::size_t>> orderFrom(const std::string& answer, const Segmentation& of);

// The names of those that share voxels with another, in `order`.
std::vector<std::string> overlapping(const Segmentation& of, const std::vector<Overlap>& shared,
                                     const std::vector<std::size_t>& order);

}  // namespace trephine
