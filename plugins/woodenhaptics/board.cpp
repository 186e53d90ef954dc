#include "board.h"

#include <hidapi/hidapi.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "../common/hid.h"

namespace trephine::woodenhaptics {

using plugin::inFront;
using plugin::narrow;
using plugin::now_ns;
using plugin::usbPort;

namespace {

constexpr unsigned short kVendor = 0x1234, kProduct = 0x0006, kUsagePage = 0xFFAB, kUsage = 0x0200;
constexpr int kLook_ms = 20;                     // how often the reader looks whether it is to end
constexpr int kMostWaiting = 64;                 // reports that the system keeps
constexpr int kAttempts = 100;                   // to read what another thread writes
constexpr std::int64_t kStuck_ns = 15'000'000;   // a report takes a millisecond
constexpr std::int64_t kFirst_ns = 500'000'000;  // for the first report
// Without a command for so long the motors get nothing: the host stands still, and its own watchdog
// may too. The firmware's takes 0.5 s.
constexpr std::int64_t kSilentHost_ns = 50'000'000;

timespec at(std::int64_t ns) {
  return {time_t(ns / 1'000'000'000), long(ns % 1'000'000'000)};
}

std::uint64_t pack(const std::array<std::int16_t, 3>& three) {
  std::uint64_t packed = 0;
  std::memcpy(&packed, three.data(), 6);
  return packed;
}

}  // namespace

std::vector<Found> findBoards() {
  std::vector<Found> boards;
  hid_device_info* list = hid_enumerate(kVendor, kProduct);
  for (const hid_device_info* of = list; of; of = of->next) {
    if (of->usage_page != kUsagePage || of->usage != kUsage) continue;
    boards.push_back({of->path, usbPort(of->path), narrow(of->serial_number)});
  }
  hid_free_enumeration(list);
  std::sort(boards.begin(), boards.end(),
            [](const Found& a, const Found& b) { return a.port < b.port; });
  return boards;
}

Board::Board(const plugin::Silence& silence) : silence_(silence) {
  sem_init(&came_, 0, 0);
  sem_init(&due_, 0, 0);
}

Board::~Board() {
  stop();
  if (in_) hid_close(in_);
  if (out_) hid_close(out_);
  sem_destroy(&came_);
  sem_destroy(&due_);
}

std::string Board::open(const Found& board) {
  found_ = board;
  in_ = hid_open_path(board.node.c_str());
  out_ = in_ ? hid_open_path(board.node.c_str()) : nullptr;
  if (out_) return {};
  return "The arm on USB port " + board.port + " cannot be opened (" + narrow(hid_error(nullptr)) +
         "): unplug it and plug it in again, or install Trephine's udev rules.";
}

std::string Board::start() {
  if (lost_) return "The arm on USB port " + found_.port + " went away: plug it in and try again.";
  wanted_mA_ = 0;
  begun_ = number_ = 0;
  last_ = Report{};
  ending_ = false;
  // What has waited since it was opened is old, however new it would look.
  std::uint8_t old[kReportBytes];
  for (int i = 0; i < kMostWaiting && hid_read_timeout(in_, old, sizeof(old), 0) > 0; ++i) {
  }
  while (sem_trywait(&came_) == 0) {
  }
  reader_ = inFront([this] { readReports(); });
  writer_ = inFront([this] { writeReports(); });
  const std::int64_t until_ns = now_ns() + kFirst_ns;
  while (!waitForOther(0, 0.02) && !lost_ && now_ns() < until_ns) {
  }
  if (latest().number != 0) return {};
  stop();
  return "The arm on USB port " + found_.port + " sends no reports: is it switched on?";
}

void Board::stop() {
  ending_ = true;
  sem_post(&due_);
  if (reader_.joinable()) reader_.join();
  if (writer_.joinable()) writer_.join();
}

// As it is told by two equal numbers around what was read.
Report Board::latest() {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Report out;
    out.number = number_.load(std::memory_order_acquire);
    const std::uint64_t packed = report_.load(std::memory_order_acquire);
    out.time_ns = time_ns_.load(std::memory_order_acquire);
    std::memcpy(out.counts.data(), &packed, 6);
    if (begun_.load(std::memory_order_acquire) == out.number) return last_ = out;
  }
  return last_;
}

bool Board::lost() const {
  const std::int64_t since_ns = writing_ns_;
  return lost_ || (since_ns != 0 && now_ns() - since_ns > kStuck_ns);
}

bool Board::waitForOther(std::uint64_t given, double timeout_s) {
  const timespec until = at(now_ns() + std::int64_t(timeout_s * 1e9));
  while (number_.load(std::memory_order_acquire) == given) {
    if (lost_) return false;
    if (sem_clockwait(&came_, CLOCK_MONOTONIC, &until) != 0 && errno == ETIMEDOUT) return false;
  }
  return true;
}

void Board::command(const std::array<std::int16_t, 3>& milliamps) {
  wanted_mA_ = pack(milliamps);
  sem_post(&due_);
}

void Board::sendNow() {
  sem_post(&due_);
}

// Its own running number says how many reports did not arrive.
void Board::take(const std::uint8_t* report) {
  std::uint64_t packed = 0;
  for (std::size_t i = 0; i < kReportBytes; ++i) packed |= std::uint64_t(report[i]) << (8 * i);
  const std::uint64_t before = number_;
  std::uint16_t step = 1;
  if (before != 0) step = std::uint16_t(std::uint16_t(packed >> 48) - std::uint16_t(report_ >> 48));
  if (step == 0) return;  // the same one again
  begun_.store(before + step, std::memory_order_release);
  report_.store(packed, std::memory_order_release);
  time_ns_.store(now_ns(), std::memory_order_release);
  number_.store(before + step, std::memory_order_release);
  sem_post(&came_);
}

void Board::readReports() {
  std::uint8_t report[kReportBytes];
  while (!ending_) {
    const int bytes = hid_read_timeout(in_, report, sizeof(report), kLook_ms);
    if (bytes < 0) {
      lost_ = true;
      sem_post(&came_);
      return;
    }
    if (bytes == int(kReportBytes)) take(report);  // one of another length is none
  }
}

void Board::writeReports() {
  for (bool goes_on = true; goes_on;) {
    const timespec until = at(now_ns() + kSilentHost_ns);
    const bool commanded = sem_clockwait(&due_, CLOCK_MONOTONIC, &until) == 0;
    while (sem_trywait(&due_) == 0) {  // the newest counts
    }
    goes_on = !ending_;
    // A report id, which this board has none of, then the currents and two bytes that it ignores.
    std::uint8_t report[1 + kReportBytes] = {};
    // Silence is looked at first: it ends only once zero is what is wanted.
    const bool silent = silence_.holds();
    const std::uint64_t milliamps = wanted_mA_;
    if (goes_on && commanded && !silent && !lost_) {
      for (std::size_t i = 0; i < 6; ++i) report[1 + i] = std::uint8_t(milliamps >> (8 * i));
    }
    // To one that is lost too: should it hear, its motors get nothing.
    writing_ns_ = now_ns();
    if (hid_write(out_, report, sizeof(report)) < 0) lost_ = true;
    writing_ns_ = 0;
  }
}

}  // namespace trephine::woodenhaptics
