// Voxels of a test as a case that is placed in an exercise. Nothing is counted as failed here: a
// case that does not fit says so when it is used.
#pragma once

#include <memory>
#include <utility>

#include "case/placement.h"

namespace trephine::test {

inline Placement placed(const Exercise& exercise, Volume volume,
                        std::shared_ptr<const LabelMap> labels = nullptr) {
  Case of = caseOf(std::make_shared<const Volume>(std::move(volume)));
  of.structures = std::move(labels);
  return *place(exercise, std::move(of));
}

}  // namespace trephine::test
