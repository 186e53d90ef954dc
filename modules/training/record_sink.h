// Takes what a session did, as it comes: the records of its ticks, the voxels that it removed, and
// its events. Statistics, the recording, curves of pokes are sinks of one stream, live and from a
// file alike.
#pragma once

#include "haptics/haptic_types.h"

namespace trephine {

// One thread. Each kind comes in the order of its ticks. What belongs to a tick comes before or
// after its record, but before the records of a later slice (live: a quarter of a second).
class RecordSink {
 public:
  virtual ~RecordSink() = default;
  virtual void tick(const TickRecord&) {}
  virtual void carve(const CarveRecord&) {}
  virtual void event(const Event&) {}
};

}  // namespace trephine
