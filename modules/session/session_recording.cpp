// The recorder thread of a session: from the loop's rings to the file.
#include <algorithm>
#include <chrono>
#include <new>

#include "base/codes.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/rt/thread.h"
#include "base/tr.h"
#include "session/session.h"
#include "volume/voxel_slabs.h"

namespace trephine {

namespace {

using namespace std::chrono_literals;

constexpr auto kDrainEvery = 20ms;

}  // namespace

void Session::record() {
  rt::nameThread("recorder");
  while (!stop_recorder_) {
    std::this_thread::sleep_for(kDrainEvery);
    drain();
  }
  drain();
}

// In slices, each written before the next is taken: who comes late and finds seconds waiting does
// not gather them all first. Records first: the loop pushes what belongs to a tick before the
// tick's record, so that all of it is found after the record was.
void Session::drain() {
  const auto slice = std::uint64_t(kFlushEvery_s * exercise_.rate_hz);
  for (bool more = true; more;) {
    if (Status served = journal_file_->service(core_->journal()); !served)
      noteFailure(served.error());
    try {
      TickRecord record;
      while (unflushed_ticks_ < slice && (more = loop_->records().pop(record))) {
        tellSinks([&](RecordSink& sink) { sink.tick(record); });
        ++unflushed_ticks_;
      }
      CarveRecord carve;
      while (loop_->carves().pop(carve)) tellSinks([&](RecordSink& sink) { sink.carve(carve); });
      Event event;
      while (loop_->events().pop(event)) tellSinks([&](RecordSink& sink) { sink.event(event); });
    } catch (const std::exception&) {
      const Error error{code::kOutOfMemory, tr("The recorder ran out of memory"),
                        tr("the recording"),
                        tr("Close other programs; what was recorded until now is kept")};
      if (recorder_) recorder_->abandon(error);
      noteFailure(error);
    }
    // By the clock too: ticks of a device that is slow come seldom.
    const bool waited = std::chrono::steady_clock::now() - last_flush_ >
                        std::chrono::duration<double>(2.0 * kFlushEvery_s);
    if (unflushed_ticks_ >= slice || (unflushed_ticks_ > 0 && waited)) flush();
  }
}

void Session::flush() {
  last_flush_ = std::chrono::steady_clock::now();
  if (recorder_) {
    const Status status = recorder_->flush();
    // Until here a kill would have lost these.
    most_behind_ticks_ =
        std::max<std::uint64_t>(most_behind_ticks_, unflushed_ticks_ + loop_->records().size());
    if (!status) noteFailure(status.error());
  }
  flushed_ticks_ += unflushed_ticks_;
  unflushed_ticks_ = 0;
}

// Said at once, since the run may last for long and then ends in another error.
void Session::noteFailure(const Error& error) {
  std::lock_guard lock(failure_mutex_);
  if (failure_) return;
  failure_ = error;
  spdlog::error("{}. {}.", error.what, error.next);  // `where` may name a folder
}

std::vector<StrokeBegin> Session::strokes() const {
  const std::lock_guard lock(sinks_mutex_);
  return meter_->metrics().strokes;
}

std::vector<PokeCurve> Session::pokes() const {
  const std::lock_guard lock(sinks_mutex_);
  return poke_curves_ ? poke_curves_->curves() : std::vector<PokeCurve>();
}

Status Session::recordingStatus() const {
  std::lock_guard lock(failure_mutex_);
  if (failure_) return *failure_;
  return {};
}

double Session::recorderBehind_s() {
  if (!recorder_ || !recordingStatus()) return 0.0;
  const std::uint64_t flushed = flushed_ticks_;  // before the ticks, which go on
  // What was dropped is never written.
  const std::uint64_t settled = flushed + loop_->records().dropped();
  const std::uint64_t ticks = state().ticks;
  return double(ticks - std::min(settled, ticks)) / exercise_.rate_hz;
}

Status Session::finishRecording() {
  recording_ended_ = true;
  try {
    // Where no tick came the voxels are what they were.
    sha256_after_ = loop_->ticks() == 0 ? sha256_before_ : slabsSha256(slabsOf(*grid_));
    const TrueTissues tissues(exercise_.tissues, *before_, grid_->labels().get(),
                              exercise_.case_source);
    cut_ = cutVoxels(tissues, *before_, *grid_);
    if (structures_) structures_cut_ = cutStructures(*structures_, *before_, *grid_);
  } catch (const std::bad_alloc&) {
    const Error error = outOfMemory(tr("to end the recording"), tr("the recording"));
    if (recorder_) recorder_->abandon(error);
    noteFailure(error);
  }
  if (recorder_ && !sha256_after_.empty()) {
    const RecordingEnd end{loop_->ticks(), loop_->dropped(), loop_->missed(), sha256_after_};
    if (Status status = recorder_->finish(end); !status) noteFailure(status.error());
  }
  return recordingStatus();
}

}  // namespace trephine
