// `pin`: a PIN that a person types, as the workstation's settings keep it.
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "app/answer.h"
#include "app/lab_commands.h"
#include "base/codes.h"
#include "base/pin.h"
#include "exercise/policy.h"

namespace trephine {

namespace {

constexpr int kPoll_ms = 100;
constexpr std::size_t kMostTyped = 256;

// What is typed is not shown while this lives.
class QuietTerminal {
 public:
  QuietTerminal() {
    quiet_ = ::tcgetattr(STDIN_FILENO, &before_) == 0;
    termios without_echo = before_;
    without_echo.c_lflag &= ~tcflag_t(ECHO);
    if (quiet_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &without_echo);
  }
  ~QuietTerminal() {
    if (quiet_) ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
  }
  QuietTerminal(const QuietTerminal&) = delete;
  QuietTerminal& operator=(const QuietTerminal&) = delete;

 private:
  termios before_{};
  bool quiet_ = false;
};

// Up to the end of the line; by single bytes, so that a second line is left for who asks next.
Result<std::string> readLine(const Progress& progress) {
  std::string line;
  while (line.size() < kMostTyped) {
    if (progress.cancelled()) return Error{code::kCancelled, "No PIN was made", "", ""};
    pollfd in{STDIN_FILENO, POLLIN, 0};
    if (::poll(&in, 1, kPoll_ms) <= 0) continue;
    char c = 0;
    const ssize_t got = ::read(STDIN_FILENO, &c, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0 || c == '\n') break;
    line += c;
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  return line;
}

Result<std::string> askOnTerminal(const char* question, const Progress& progress) {
  const QuietTerminal quiet;
  sayError("%s", question);
  Result<std::string> line = readLine(progress);
  sayError("\n");
  return line;
}

Result<Pin> askForPin(const Progress& progress) {
  if (!::isatty(STDIN_FILENO)) {
    const Result<std::string> line = readLine(progress);
    return line ? makePin(*line) : line.error();
  }
  const Result<std::string> first =
      askOnTerminal("PIN, 4 to 12 digits or letters (not shown): ", progress);
  if (!first) return first.error();
  const Result<std::string> second = askOnTerminal("The same again: ", progress);
  if (!second) return second.error();
  if (*first != *second)
    return Error{code::kBadPin, "The two are not the same", "", "Type it again"};
  return makePin(*first);
}

}  // namespace

int pinCommand(bool json, const Progress& progress) {
  const Result<Pin> pin = askForPin(progress);
  if (!pin) return printError("pin", pin.error(), json);
  if (json) {
    printAnswer("pin", {{"pin", toJson(*pin)}});
  } else {
    sayError("Put this under \"pin\" into %s:\n", kPolicyFile);
    say("%s\n", toJson(*pin).dump(1).c_str());
  }
  return 0;
}

}  // namespace trephine
