// What several tests need: a folder that goes away, a wait for what nobody announces, and the real
// CT where it is.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace trephine::test {

// A sanitizer holds no memory, and has more of its own than the program.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

// An empty folder of this test's own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "trephine-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TemporaryFolder() {
    std::error_code ec;
    std::filesystem::remove_all(path_, ec);
  }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// Waits for what another thread, process or device does and nobody announces; false where it does
// not come.
template <class Condition>
bool waitUntil(const Condition& condition,
               std::chrono::seconds longest = std::chrono::seconds(60)) {
  const auto end = std::chrono::steady_clock::now() + longest;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return condition();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // nobody would wake us
  }
  return true;
}

// Of this program, as the system counts them; of any name where none is given.
inline std::vector<pid_t> threadsNamed(const std::string& name = {}) {
  std::vector<pid_t> threads;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string its;
    std::getline(std::ifstream(task.path() / "comm"), its);
    if (name.empty() || its == name) threads.push_back(std::stoi(task.path().filename()));
  }
  return threads;
}

// Whether that thread of this program has come to a call that waits.
inline bool isWaiting(pid_t thread) {
  std::ifstream stat("/proc/self/task/" + std::to_string(thread) + "/stat");
  std::string text;
  std::getline(stat, text);
  const std::size_t name = text.rfind(") ");  // of the thread; after it its state
  return name != text.npos && text.compare(name + 2, 1, "S") == 0;
}

// A variable of the environment, for as long as this lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) before_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    if (before_) {
      ::setenv(name_, before_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

// No more than so many MB of data of the process's own, beyond what it has, for as long as this
// lives.
class DataLimit {
 public:
  explicit DataLimit(double more_mb) {
    std::ifstream status("/proc/self/status");
    double used_kb = 0.0;
    for (std::string name; status >> name;) {
      if (name == "VmData:") status >> used_kb;
    }
    ::getrlimit(RLIMIT_DATA, &before_);
    const rlimit limit{rlim_t((used_kb / 1024.0 + more_mb) * 1048576.0), before_.rlim_max};
    ::setrlimit(RLIMIT_DATA, &limit);
  }
  ~DataLimit() { ::setrlimit(RLIMIT_DATA, &before_); }
  DataLimit(const DataLimit&) = delete;
  DataLimit& operator=(const DataLimit&) = delete;

 private:
  rlimit before_{};
};

}  // namespace trephine::test

// Declares `folder`, the test data, or skips the test with the reason.
#define TREPHINE_TEST_DATA_OR_SKIP(folder)                                             \
  const char* folder##_text = std::getenv("TREPHINE_TEST_DATA");                       \
  if (!folder##_text || !*folder##_text) {                                             \
    GTEST_SKIP() << "TREPHINE_TEST_DATA is not set: this test needs the real CT data"; \
  }                                                                                    \
  const std::filesystem::path folder = folder##_text
