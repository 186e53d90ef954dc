#include "base/system.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace trephine {

namespace build_info {
extern const char* const name;
extern const char* const resources;
extern const char* const plugins;
}  // namespace build_info

namespace {

constexpr double kMb = 1024.0 * 1024.0;

std::filesystem::path fromEnvironment(const char* variable, const char* fallback) {
  const char* value = std::getenv(variable);
  return value && *value ? value : fallback;
}

}  // namespace

std::string buildName() { return build_info::name; }

double residentMb() {
  std::ifstream statm("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  statm >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / kMb;
}

double peakResidentMb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / kMb;
}

double availableMemoryMb() {
  std::ifstream in("/proc/meminfo");
  std::string name, unit;
  double kilobytes = 0.0;
  while (in >> name >> kilobytes) {
    if (name == "MemAvailable:") return kilobytes / 1024.0;
    std::getline(in, unit);
  }
  return static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<double>(::sysconf(_SC_PAGESIZE)) / kMb;
}

std::filesystem::path resourceFolder() {
  return fromEnvironment("TREPHINE_RESOURCES", build_info::resources);
}

std::filesystem::path pluginFolder() {
  return fromEnvironment("TREPHINE_PLUGINS", build_info::plugins);
}

}  // namespace trephine
