// The cases that pictures are of: built in, no patient's.
#pragma once

#include "case/placement.h"
#include "golden_line.h"

namespace trephine::test {

struct GoldenCase {
  Exercise exercise;
  Placement of;
};

// Made once, and kept until another is asked for.
Result<GoldenCase> goldenCase(const GoldenLine& line);

}  // namespace trephine::test
