#include "base/memory.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include "base/codes.h"
#include "base/tr.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr double kMb = 1024.0 * 1024.0;
constexpr double kSpare_mb = 64.0;  // left to everything else
constexpr const char* kLess =
    trLater("Close other programs, or import the case cropped or at a lower resolution");
// Groups of version 1 without a limit have the largest number of pages there is.
constexpr double kNoLimit_bytes = 1e18;

std::optional<double> numberIn(const fs::path& file) {
  std::ifstream in(file);
  double number = 0.0;
  if (!(in >> number)) return {};  // missing, or "max"
  return number;
}

// Lines of a name and a number, whatever follows.
std::map<std::string, double> table(const fs::path& file) {
  std::map<std::string, double> table;
  std::ifstream in(file);
  std::string name, rest;
  for (double number = 0.0; in >> name;) {
    if (in >> number) table[name] = number;
    in.clear();
    std::getline(in, rest);
  }
  return table;
}

// What one group leaves [bytes].
std::optional<double> leftIn(const fs::path& group) {
  std::error_code ec;
  const bool first = fs::exists(group / "memory.limit_in_bytes", ec);
  const auto limit = numberIn(group / (first ? "memory.limit_in_bytes" : "memory.max"));
  const auto used = numberIn(group / (first ? "memory.usage_in_bytes" : "memory.current"));
  if (!limit || !used || *limit > kNoLimit_bytes) return {};
  std::map<std::string, double> parts = table(group / "memory.stat");
  const std::string of_all = first ? "total_" : "";
  return *limit - *used + parts[of_all + "active_file"] + parts[of_all + "inactive_file"];
}

}  // namespace

double residentMb() {
  std::ifstream statm("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  statm >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / kMb;
}

void giveBackFreedMemory() {
  ::malloc_trim(0);
}

double peakResidentMb() {
  // Not getrusage(): it knows the memory of the program that started this one, too.
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::strtod(line.c_str() + 6, nullptr) * 1024.0 / kMb;
  }
  return 0.0;
}

std::optional<double> controlGroupMemoryMb(const fs::path& membership, const fs::path& mounted) {
  std::optional<double> least_bytes;
  std::ifstream in(membership);
  // "4:memory:/a/b" of version 1, "0::/a/b" of version 2.
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = ',' + line.substr(first + 1, second - first - 1) + ',';
    const bool unified = controllers == ",,";
    if (!unified && controllers.find(",memory,") == std::string::npos) continue;
    fs::path group = fs::path(line.substr(second + 1)).relative_path();
    const fs::path root = unified ? mounted : mounted / "memory";
    // In a container the path may be the host's, of which only the root is seen.
    for (bool more = true; more; group = group.parent_path()) {
      more = !group.empty();
      if (const auto left = leftIn(root / group)) {
        least_bytes = std::min(least_bytes.value_or(*left), *left);
      }
    }
  }
  if (!least_bytes) return {};
  return std::max(0.0, *least_bytes / kMb);
}

double availableMemoryMb() {
  std::map<std::string, double> machine = table("/proc/meminfo");
  double least_mb = machine.contains("MemAvailable:")
                        ? machine["MemAvailable:"] / 1024.0
                        : static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                              static_cast<double>(::sysconf(_SC_PAGESIZE)) / kMb;
  if (const auto group_mb = controlGroupMemoryMb("/proc/self/cgroup", "/sys/fs/cgroup")) {
    least_mb = std::min(least_mb, *group_mb);
  }
  rlimit data{};
  if (::getrlimit(RLIMIT_DATA, &data) == 0 && data.rlim_cur != RLIM_INFINITY) {
    const double used_mb = table("/proc/self/status")["VmData:"] / 1024.0;
    least_mb =
        std::min(least_mb, std::max(0.0, static_cast<double>(data.rlim_cur) / kMb - used_mb));
  }
  return least_mb;
}

double usableMemoryMb() {
  return std::max(0.0, availableMemoryMb() - kSpare_mb);
}

Status enoughMemory(double needed_mb, const std::string& what, const std::string& where,
                    double usable_mb) {
  if (needed_mb <= usable_mb) return {};
  const auto figure = [](double mb) { return std::to_string(std::llround(mb)) + " MB"; };
  return Error{
      code::kOutOfMemory,
      tr("{} needs {} of memory, and {} can be had", what, figure(needed_mb), figure(usable_mb)),
      where, tr(kLess)};
}

Status enoughToRead(double needed_mb, const std::string& what, const std::string& where,
                    double usable_mb) {
  Status enough = enoughMemory(needed_mb, what, where, usable_mb);
  if (enough) return enough;
  Error error = enough.error();
  error.next =
      tr("Close other programs, use a computer with more memory, or have a smaller part exported");
  return error;
}

Error outOfMemory(const std::string& what, const std::string& where) {
  return {code::kOutOfMemory, tr("There is not enough memory {}", what), where, tr(kLess)};
}

}  // namespace trephine
