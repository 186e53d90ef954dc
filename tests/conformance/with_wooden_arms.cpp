// usage: [LEFT_ARM=reversed|scatters] umockdev-wrapper with_wooden_arms REPORT.json COMMAND
// ARGUMENTS...
// Plugs in two emulated WoodenHaptics boards in hands that swing them, runs the command, and writes
// what the boards saw: reports that were sent and answered, how long an answer took, and by how
// much the hands were late at most, who then stand still for so long. Ends as the command did.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "base/file.h"
#include "base/json.h"
#include "wooden_hand.h"

namespace trephine {
namespace {

using test::WoodenFirmware;
using woodenhaptics::Vector;

// What the hands are late by is made up for at once up to here: more would be a blow.
constexpr std::chrono::milliseconds kCatchUp(3);

class Arm {
 public:
  Arm(test::HidTestbed& bed, const char* port) : fd_(bed.plugIn(test::woodenBoard(), port)) {
    if (fd_ >= 0) firmware_ = std::make_unique<WoodenFirmware>(fd_);
  }
  test::WoodenHand& hand() { return hand_; }
  bool isThere() const { return firmware_ != nullptr; }
  void end() { firmware_->end(); }
  void step(double time_s) {
    const Vector force_N = hand_.force_N(*firmware_);
    most_N_ = std::max(most_N_, std::hypot(force_N[0], force_N[1], force_N[2]));
    hand_.step(*firmware_, force_N, time_s);
  }
  Json report() const {
    std::vector<double> us = firmware_->answers_us();
    std::sort(us.begin(), us.end());
    const auto at = [&](double share) {
      return us.empty() ? 0.0 : us[std::min(us.size() - 1, std::size_t(share * double(us.size())))];
    };
    return {{"reports", firmware_->sent()},
            {"lost", firmware_->lost()},
            {"answered", us.size()},
            {"answer_ms",
             {{"median", 1e-3 * at(0.5)}, {"p99", 1e-3 * at(0.99)}, {"max", 1e-3 * at(1.0)}}},
            {"most_N", most_N_}};
  }

 private:
  int fd_;
  std::unique_ptr<WoodenFirmware> firmware_;
  test::WoodenHand hand_;
  double most_N_ = 0.0;
};

int run(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: with_wooden_arms REPORT.json COMMAND ARGUMENTS...\n");
    return 2;
  }
  test::HidTestbed bed;
  Arm left(bed, "1-1"), right(bed, "1-2");
  if (!left.isThere() || !right.isThere()) {
    std::fprintf(stderr, "no board can be emulated: %s\n", bed.why().c_str());
    return 2;
  }
  const char* variable = std::getenv("LEFT_ARM");
  const std::string wrong = variable ? variable : "";
  if (wrong == "reversed") left.hand().setReversed();
  if (wrong == "scatters") left.hand().setScatter(20.0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execvp(argv[2], argv + 2);
    std::perror(argv[2]);
    ::_exit(127);
  }
  int status = 0;
  auto due = WoodenFirmware::Clock::now();
  WoodenFirmware::Clock::duration most_late{0};
  for (double time_s = 0.0; ::waitpid(child, &status, WNOHANG) == 0; time_s += 1e-3) {
    due += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(due);  // the hands' own clock
    const auto now = WoodenFirmware::Clock::now();
    most_late = std::max(most_late, now - due);
    if (now - due > kCatchUp) due = now;
    left.step(time_s);
    right.step(time_s);
  }
  left.end();
  right.end();
  const double late_ms = std::chrono::duration<double, std::milli>(most_late).count();
  const Json report{{"left", left.report()}, {"right", right.report()}, {"hands_late_ms", late_ms}};
  if (Status written = writeTextFile(argv[1], report.dump(1) + "\n"); !written) {
    std::fprintf(stderr, "%s\n", written.error().sentence().c_str());
    return 2;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace
}  // namespace trephine

int main(int argc, char** argv) {
  return trephine::run(argc, argv);
}
