// What a scanner says in a slice's header besides what imaging's writer says: with it there are
// over 100 elements, with private ones and sequences. Who a patient might be is not in it.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/ofstd/ofcond.h>

class DcmDataset;

namespace trephine::bench {

// `data` is a slice of imaging's writer. All slices belong to one study. Any thread.
OFCondition putScannerHeader(DcmDataset& data, int series_number);

}  // namespace trephine::bench
