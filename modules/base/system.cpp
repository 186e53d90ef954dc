#include "base/system.h"

#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
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

// A local X display ":N" answers when its socket accepts; a remote one is taken at its word.
bool xDisplayAnswers(const std::string& display) {
  auto colon = display.rfind(':');
  if (colon == std::string::npos) return false;
  if (colon > 0) return true;
  std::string number = display.substr(colon + 1, display.find('.', colon) - colon - 1);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::string path = "/tmp/.X11-unix/X" + number;
  if (path.size() + 1 >= sizeof(address.sun_path)) return false;
  for (bool abstract : {true, false}) {
    int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0) return false;
    std::memset(address.sun_path, 0, sizeof(address.sun_path));
    std::memcpy(address.sun_path + (abstract ? 1 : 0), path.data(), path.size());
    auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size() + 1);
    bool connected = ::connect(fd, reinterpret_cast<sockaddr*>(&address), size) == 0;
    ::close(fd);
    if (connected) return true;
  }
  return false;
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

bool displayAvailable() {
  const char* display = std::getenv("DISPLAY");
  return display && *display && xDisplayAnswers(display);
}

std::filesystem::path resourceFolder() {
  return fromEnvironment("TREPHINE_RESOURCES", build_info::resources);
}

std::filesystem::path pluginFolder() {
  return fromEnvironment("TREPHINE_PLUGINS", build_info::plugins);
}

}  // namespace trephine
