#include "base/crash_report.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <mutex>
#include <vector>

#include "base/file.h"
#include "base/system.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLines = 24, kLength = 240, kPath = 4096, kName = 256;
constexpr int kFrames = 64;
constexpr const char* kRunning = "running-";
constexpr const char* kCrash = "crash-";
constexpr std::uintmax_t kMostBytes = 1'000'000;  // of a file here that is read
constexpr std::size_t kReportsKept = 10;

// What the handler reads: all of it is there before it is needed, and nothing of it is locked.
char last_lines[kLines][kLength] = {};
std::atomic<std::size_t> lines_kept{0};
char report_path[kPath] = {};
char version[64] = {};
char recording_name[kName] = {};
std::time_t started = 0;
std::atomic<bool> reporting{false};
alignas(16) char handler_stack[65536];

fs::path folder_of_reports;

// Only what may be called while anything else was interrupted.
class Report {
 public:
  explicit Report(int fd) : fd_(fd) {}
  Report& operator<<(const char* text) {
    put(text, std::strlen(text));
    return *this;
  }
  Report& operator<<(long number) {
    char digits[24];
    const auto end = std::to_chars(digits, digits + sizeof digits, number);
    put(digits, std::size_t(end.ptr - digits));
    return *this;
  }
  Report& hex(unsigned long number) {
    char digits[24];
    const auto end = std::to_chars(digits, digits + sizeof digits, number, 16);
    put("+0x", 3);
    put(digits, std::size_t(end.ptr - digits));
    return *this;
  }

 private:
  void put(const char* text, std::size_t size) { static_cast<void>(!::write(fd_, text, size)); }
  int fd_;
};

const char* nameOf(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "SIGSEGV, memory that is not there";
    case SIGBUS:
      return "SIGBUS, a file or memory that went away";
    case SIGFPE:
      return "SIGFPE, a division that cannot be";
    case SIGILL:
      return "SIGILL, an instruction that this processor lacks";
    default:
      return "SIGABRT, it gave itself up";
  }
}

void writeStack(Report& report) {
  void* frames[kFrames];
  const int count = ::backtrace(frames, kFrames);
  for (int i = 0; i < count; ++i) {
    report << "  ";
    Dl_info at{};
    if (::dladdr(frames[i], &at) == 0 || !at.dli_fname) {
      report << "?\n";
      continue;
    }
    const char* name = std::strrchr(at.dli_fname, '/');
    report << (name ? name + 1 : at.dli_fname) << " ";
    report.hex(reinterpret_cast<unsigned long>(frames[i]) -
               reinterpret_cast<unsigned long>(at.dli_fbase));
    if (at.dli_sname) report << " " << at.dli_sname;
    report << "\n";
  }
}

// "2026-11-27 09:15:02 UTC", by arithmetic alone.
void writeTime(Report& report, std::time_t of) {
  const std::chrono::sys_seconds at{std::chrono::seconds(of)};
  const auto day = std::chrono::floor<std::chrono::days>(at);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(at - day);
  const auto two = [&](long number) -> Report& {
    return report << (number < 10 ? "0" : "") << number;
  };
  report << long(int(date.year())) << "-";
  two(long(unsigned(date.month()))) << "-";
  two(long(unsigned(date.day()))) << " ";
  two(time.hours().count()) << ":";
  two(time.minutes().count()) << ":";
  two(time.seconds().count()) << " UTC";
}

void onCrash(int signal) {
  // One that comes while this is at work ends the program as it would have ended.
  if (!reporting.exchange(true)) {
    const int fd = ::open(report_path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (fd >= 0) {
      Report report(fd);
      report << "Trephine ended unexpectedly.\n\nversion    " << version << "\nsignal     "
             << nameOf(signal) << "\nended      ";
      writeTime(report, ::time(nullptr));
      report << "\nran        " << long(::time(nullptr) - started) << " s\nrecording  "
             << (recording_name[0] ? recording_name : "none") << "\n\nLast lines of the log:\n";
      const std::size_t kept = lines_kept;
      for (std::size_t i = kept > kLines ? kept - kLines : 0; i < kept; ++i) {
        report << "  " << last_lines[i % kLines] << "\n";
      }
      report << "\nStack (module, offset):\n";
      writeStack(report);
      ::fsync(fd);
      ::close(fd);
    }
  }
  ::raise(signal);  // as it would have ended: the handler is gone by now
}

fs::path runningFile(const fs::path& folder, long pid) {
  return folder / (kRunning + std::to_string(pid));
}

// "crash-123.txt" -> 123; nothing where it is none of that kind.
std::optional<long> pidIn(const std::string& name, const std::string& begin,
                          const std::string& end) {
  if (!name.starts_with(begin) || !name.ends_with(end)) return {};
  const char* from = name.data() + begin.size();
  const char* to = name.data() + name.size() - end.size();
  long pid = 0;
  const auto read = std::from_chars(from, to, pid);
  return read.ec == std::errc() && read.ptr == to && pid > 0 ? std::optional(pid) : std::nullopt;
}

// "crash-1795734987-123.txt": a report that somebody was told of.
bool isTold(const std::string& name) {
  const std::size_t last = name.rfind('-');
  const std::string begin = kCrash;
  return last != std::string::npos && last > begin.size() &&
         pidIn(name.substr(0, last), begin, "") && pidIn(name.substr(last), "-", ".txt");
}

bool lives(long pid) {
  return ::kill(pid_t(pid), 0) == 0 || errno == EPERM;
}

void deleteOldReports(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> told;
  std::error_code ec;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    if (isTold(it->path().filename().string())) {
      told.emplace_back(it->last_write_time(ec), it->path());
    }
  }
  std::sort(told.rbegin(), told.rend());
  for (std::size_t i = kReportsKept; i < told.size(); ++i) fs::remove(told[i].second, ec);
}

}  // namespace

Status reportCrashesTo(const fs::path& folder) {
  if (Status made = makeFolder(folder); !made) return made;
  std::error_code ec;
  // A recording's path may tell who a patient is.
  if (!fs::is_symlink(folder, ec)) fs::permissions(folder, fs::perms::owner_all, ec);
  const std::string path = (folder / (kCrash + std::to_string(long(::getpid())) + ".txt")).string();
  if (path.size() >= kPath) return writeError(folder, ENAMETOOLONG);
  path.copy(report_path, kPath - 1);
  buildName().copy(version, sizeof version - 1);
  started = ::time(nullptr);
  folder_of_reports = folder;
  void* first[2];
  ::backtrace(first, 2);  // loads what it needs, which must not happen in the handler
  stack_t stack{};
  stack.ss_sp = handler_stack;
  stack.ss_size = sizeof handler_stack;
  ::sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = onCrash;
  action.sa_flags = SA_ONSTACK | SA_RESETHAND | SA_NODEFER;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    ::sigaction(signal, &action, nullptr);
  }
  return {};
}

void noteRecording(const fs::path& recording) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  std::memset(recording_name, 0, sizeof recording_name);
  recording.filename().string().copy(recording_name, kName - 1);
  if (folder_of_reports.empty()) return;
  const fs::path running = runningFile(folder_of_reports, ::getpid());
  std::error_code ec;
  if (recording.empty()) {
    fs::remove(running, ec);
  } else {
    (void)writeTextFile(running, fs::absolute(recording, ec).string());
  }
}

void keepLastLine(const char* text, std::size_t size) {
  char(&line)[kLength] = last_lines[lines_kept++ % kLines];
  size = std::min(size, kLength - 1);
  std::memcpy(line, text, size);
  line[size] = '\0';
}

std::optional<LeftBehind> takeLeftBehind(const fs::path& folder) {
  std::map<long, LeftBehind> left;
  std::map<long, fs::file_time_type> when;
  std::error_code ec;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const std::string name = it->path().filename().string();
    const auto crashed = pidIn(name, kCrash, ".txt"), ran = pidIn(name, kRunning, "");
    const auto pid = crashed ? crashed : ran;
    std::error_code none;
    if (!pid || (lives(*pid) && !crashed) || *pid == ::getpid()) continue;
    // What is no file of a sensible size is none of ours: a pipe would keep its reader for ever.
    if (it->symlink_status(none).type() != fs::file_type::regular) continue;
    if (it->file_size(none) > kMostBytes) continue;
    const auto [known, first] = when.try_emplace(*pid, it->last_write_time(none));
    if (!first) known->second = std::max(known->second, it->last_write_time(none));
    if (crashed) left[*pid].report = it->path();
    if (ran) {
      std::string recording;
      std::ifstream file(it->path());
      std::getline(file, recording);
      left[*pid].recording = recording;
    }
  }
  std::optional<LeftBehind> newest;
  std::optional<fs::file_time_type> at;
  for (auto& [pid, one] : left) {
    fs::remove(runningFile(folder, pid), ec);
    if (!one.report.empty()) {
      // Told: of another name, so that a program of this number may crash again.
      const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(
          std::chrono::file_clock::to_sys(when[pid]).time_since_epoch());
      const fs::path told =
          folder / (kCrash + std::to_string(seconds.count()) + "-" + std::to_string(pid) + ".txt");
      fs::rename(one.report, told, ec);
      if (!ec) one.report = told;
    }
    if (!at || when[pid] > *at) {
      at = when[pid];
      newest = one;
    }
  }
  deleteOldReports(folder);
  return newest;
}

}  // namespace trephine
