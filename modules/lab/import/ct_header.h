// The header of a CT slice as a scanner writes it: about 110 elements, with private ones and
// sequences. For series to measure and test on; who a patient might be is not in it.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/ofstd/ofcond.h>

#include <cstdint>

#include "volume/volume.h"

class DcmDataset;

namespace trephine {

struct CtSliceHeader {
  const GridGeometry& geometry;  // of the whole stack; axes along the patient's
  std::uint64_t series;          // tells its UIDs from others'; all belong to one study
  int number;                    // of the series
  int k;                         // of the slice
  int bits;                      // stored, of 16
  bool is_signed;
  int intercept;  // the slope is 1
};

// UIDs are numbers under 2.25 (PS3.5 B.2). Any thread.
OFCondition putCtHeader(DcmDataset& data, const CtSliceHeader& slice);

// A number that looks random and is the same everywhere.
std::uint64_t hashedNumber(std::uint64_t n);

}  // namespace trephine
