// One arm's board over USB HID: 8-byte reports in with its encoders and a running number, 8 bytes
// out with its motor currents. Two threads of its own talk to it, since a write to a HID device
// takes as long as the bus does: what the haptic thread calls here neither waits nor allocates.
#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "../common/plugin.h"

struct hid_device_;

namespace trephine::woodenhaptics {

constexpr std::size_t kReportBytes = 8;

struct Found {
  std::string node;  // of the system, now
  std::string port;  // of USB, e.g. "1-2.3": the same for the same socket
  std::string serial;
};
// The boards that are plugged in, by their ports.
std::vector<Found> findBoards();

struct Report {
  std::array<std::int16_t, 3> counts{};
  std::uint64_t number = 0;  // of reports since start, those that were lost counted too
  std::int64_t time_ns = 0;  // CLOCK_MONOTONIC, when it was here
};

class Board {
 public:
  // `silence` outlives it.
  explicit Board(const plugin::Silence& silence);
  ~Board();
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  // Empty, or why not.
  std::string open(const Found& board);
  // Until a first report has come: empty, or why not.
  std::string start();
  void stop();

  // ---- Haptic thread.
  Report latest();  // the one before where the reader is just taking another in
  // Gone, or it takes no report any more: then its motors have what they had, until it hears again
  // or has heard nothing for half a second.
  bool lost() const;
  // Until there is a report of another number than `given`; false after timeout_s, or when it is
  // lost.
  bool waitForOther(std::uint64_t given, double timeout_s);
  // Motor currents [mA], sent at once unless there is silence.
  void command(const std::array<std::int16_t, 3>& milliamps);

  // ---- Any thread: what there is to send is sent now, such as the zero of a silence that begins.
  void sendNow();

 private:
  void readReports();
  void writeReports();
  void take(const std::uint8_t* report);

  const plugin::Silence& silence_;
  Found found_;
  hid_device_ *in_ = nullptr, *out_ = nullptr;  // apart: hidapi keeps its error in the handle
  std::thread reader_, writer_;
  std::atomic<bool> ending_{false}, lost_{false};
  std::atomic<std::int64_t> writing_ns_{0};  // since when, 0: not
  // The newest report and its number twice: a reader that finds two numbers looks again.
  std::atomic<std::uint64_t> begun_{0}, report_{0}, number_{0};
  std::atomic<std::int64_t> time_ns_{0};
  std::atomic<std::uint64_t> wanted_mA_{0};  // three int16, packed
  Report last_;                              // that was told
  sem_t came_, due_;
};

}  // namespace trephine::woodenhaptics
