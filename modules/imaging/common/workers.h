// A loop over files on a few threads.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "base/progress.h"
#include "base/result.h"

namespace trephine {

// Files are read in pieces of this size, and between two of them it is asked whether the work was
// cancelled: a stick of 5 MB/s, read by eight threads, gives one to each in 0.2 s.
constexpr std::size_t kPieceBytes = std::size_t(128) << 10;

// The part of a whole job's progress bar that one loop fills.
struct ProgressPart {
  double from = 0.0;
  double to = 1.0;
  std::string step;
};

// Calls `work(i)` once for each i below `count`, on worker threads; the calling thread reports
// progress and returns when all are done. Errors: CANCELLED (some calls were not made),
// OUT_OF_MEMORY (a call threw, or no thread could start).
//
// The workers' stacks are far larger than usual: DCMTK descends into nested sequences by recursion,
// and a crafted file nests thousands deep (see dicom_stream.h).
Status forEachFile(std::size_t count, const Progress& progress, const ProgressPart& part,
                   const std::function<void(std::size_t)>& work);

}  // namespace trephine
