#include "base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <optional>

#include "base/codes.h"
#include "base/descriptor.h"
#include "base/json.h"
#include "base/tr.h"

extern char** environ;

namespace trephine {

namespace {

constexpr int kPoll_ms = 100;
constexpr std::int64_t kPatience_ns = 1'500'000'000;  // after it was asked to end

std::int64_t now_ns() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

// Not in the place of stdin, stdout or stderr, also where this program has none of them.
Descriptor aboveStandard(int fd) {
  Descriptor opened(fd);
  if (!opened.ok() || fd > STDERR_FILENO) return opened;
  return Descriptor(::fcntl(fd, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
}

Error cannotRun(const ChildCommand& command, int error) {
  return {code::kCannotRun, tr("A program could not be run: {}", std::strerror(error)),
          std::filesystem::path(command.words.front()).filename().string(), ""};
}

// What the child tells before its exec, and after an exec that failed.
struct Report {
  std::int64_t start_ns = 0;
  int error = 0;
};

// In the child, which has this program's memory until its exec: nothing but system calls.
[[noreturn]] void becomeProgram(char* const* arguments, char* const* environment, int output,
                                int nothing, int reports, const sigset_t& signals) {
  Report report;
  ::setpgid(0, 0);  // Ctrl-C is told to us, and we ask it once
  if (::dup2(output, STDOUT_FILENO) >= 0 && ::dup2(nothing, STDERR_FILENO) >= 0 &&
      ::dup2(nothing, STDIN_FILENO) >= 0 && ::prctl(PR_SET_PDEATHSIG, SIGTERM) == 0) {
    report.start_ns = now_ns();
    if (::write(reports, &report, sizeof report) == sizeof report) {
      ::sigprocmask(SIG_SETMASK, &signals, nullptr);
      ::execve(arguments[0], arguments, environment);
    }
  }
  report.error = errno;
  static_cast<void>(!::write(reports, &report, sizeof report));
  ::_exit(127);
}

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> environmentWith(const std::filesystem::path& home) {
  std::vector<std::string> environment;
  if (!home.empty()) environment.push_back("HOME=" + home.string());
  for (char** variable = environ; *variable; ++variable) {
    if (home.empty() || std::strncmp(*variable, "HOME=", 5) != 0)
      environment.emplace_back(*variable);
  }
  return environment;
}

}  // namespace

Result<ChildRun> runChild(const ChildCommand& command, const Progress& progress) {
  const Descriptor output =
      aboveStandard(::open(command.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  const Descriptor nothing = aboveStandard(::open("/dev/null", O_RDWR | O_CLOEXEC));
  int ends[2] = {-1, -1};
  if (!output.ok() || !nothing.ok() || ::pipe2(ends, O_CLOEXEC) != 0) {
    return cannotRun(command, errno);
  }
  const Descriptor reports = aboveStandard(ends[0]);
  Descriptor reporting = aboveStandard(ends[1]);
  std::vector<std::string> words = command.words;
  std::vector<std::string> variables = environmentWith(command.home);
  const std::vector<char*> arguments = pointersTo(words);
  const std::vector<char*> environment = pointersTo(variables);

  // After fork() all memory is shared until it is written: a page fault for each page that the
  // haptic thread touches. After vfork() the child counts our own peak of memory for its own. This
  // thread waits for the exec; no signal's handler runs in the child before it.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t child = command.measures_memory ? ::fork() : ::vfork();
  if (child == 0) {
    becomeProgram(arguments.data(), environment.data(), output.get(), nothing.get(),
                  reporting.get(), before);
  }
  const int refused = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (child < 0) return cannotRun(command, refused);
  reporting.close();
  Report report;
  for (Report next; ::read(reports.get(), &next, sizeof next) == sizeof next;) report = next;

  const Descriptor process = aboveStandard(int(::syscall(SYS_pidfd_open, child, 0)));
  ChildRun run;
  // Asked first: one that has an arm takes its force away.
  std::optional<std::int64_t> asked_ns;
  bool killed = false;
  const std::int64_t limit_ns = report.start_ns + std::int64_t(command.limit_s * 1e9);
  while (!killed) {
    pollfd ended{process.get(), POLLIN, 0};
    const int polled = ::poll(&ended, 1, kPoll_ms);
    if (polled > 0 && ended.revents != 0) break;
    const std::int64_t now = now_ns();
    run.timed_out = run.timed_out || now > limit_ns;
    if (!command.step.empty()) {
      const double share = 1e-9 * double(now - report.start_ns) / command.limit_s;
      progress.at(std::min(share, 1.0), command.step);
    }
    const bool unknown = !process.ok();  // whether it has ended
    if (!progress.cancelled() && !run.timed_out && !unknown) continue;
    if (unknown || (asked_ns && now > *asked_ns + kPatience_ns)) {
      ::kill(child, SIGKILL);
      killed = true;
    } else if (!asked_ns) {
      ::kill(child, SIGTERM);
      asked_ns = now;
    }
  }
  const std::int64_t end_ns = now_ns();
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  if (progress.cancelled()) return Error{code::kCancelled, tr("It was cancelled"), "", ""};
  if (report.error != 0) return cannotRun(command, report.error);
  if (process.get() < 0) return cannotRun(command, ENOSYS);
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.seconds = double(end_ns - report.start_ns) / 1e9;
  if (command.measures_memory) run.peak_rss_mb = double(usage.ru_maxrss) / 1024.0;
  return run;
}

std::optional<Error> errorSaid(const std::filesystem::path& output) {
  const Result<Json> said = readJsonFile(output);
  if (!said || !said->contains("error")) return {};
  try {
    const Json& error = said->at("error");
    return Error{Code::named(error.at("code").get<std::string>()), error.at("what"),
                 error.at("where"), error.at("next")};
  } catch (const Json::exception&) {
    return {};
  }
}

}  // namespace trephine
