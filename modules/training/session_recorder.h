// Writes a recording while the session runs: HDF5 in single-writer-multiple-reader mode, so that
// a killed process leaves a file that opens and holds all that was flushed.
//
// One thread, the recorder's. Nothing here is called from the tick.
#pragma once

#include <filesystem>
#include <memory>

#include "base/result.h"
#include "haptics/haptic_types.h"
#include "training/record_sink.h"
#include "training/recording.h"

namespace trephine {

class SessionRecorder : public RecordSink {
 public:
  // Errors: CANNOT_WRITE. A file that is already there is refused, never overwritten.
  static Result<std::unique_ptr<SessionRecorder>> create(const std::filesystem::path& file,
                                                         const RecordingHeader& header,
                                                         std::size_t arm_count);
  ~SessionRecorder() override;
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;

  void tick(const TickRecord& record) override;
  void carve(const CarveRecord& carve) override;
  void event(const Event& event) override;

  // Gives up after a row was lost: nothing more is written, so that no hole hides in the file.
  void abandon(const Error& why);
  // Appends what was added and pushes it to the system. After the first failure (a full disk)
  // nothing more is written: what is on disk stays readable, and every later call says the same.
  Status flush();
  // Writes the end and closes.
  Status finish(const RecordingEnd& end);

 private:
  SessionRecorder();
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace trephine
