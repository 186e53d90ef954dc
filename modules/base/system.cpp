#include "base/system.h"

#include <cstdlib>

namespace trephine {

namespace build_info {
extern const char* const name;
extern const char* const resources;
extern const char* const plugins;
}  // namespace build_info

namespace {

std::filesystem::path fromEnvironment(const char* variable, const char* fallback) {
  const char* value = std::getenv(variable);
  return value && *value ? value : fallback;
}

}  // namespace

std::string buildName() { return build_info::name; }

std::filesystem::path resourceFolder() {
  return fromEnvironment("TREPHINE_RESOURCES", build_info::resources);
}

std::filesystem::path pluginFolder() {
  return fromEnvironment("TREPHINE_PLUGINS", build_info::plugins);
}

void keepToBuiltFolders() {
  ::unsetenv("TREPHINE_RESOURCES");
  ::unsetenv("TREPHINE_PLUGINS");
}

}  // namespace trephine
