#include "base/system.h"

#include <cstdlib>

namespace trephine {

namespace build_info {
extern const char* const name;
}  // namespace build_info

namespace {

namespace fs = std::filesystem;

// Beside bin/, where this program is: wherever all of it was put, its own files are found. Links on
// the way are followed, so that a file has one name.
fs::path besidePrograms(const char* folder) {
  std::error_code problem;
  const fs::path programs = fs::read_symlink("/proc/self/exe", problem).parent_path();
  const fs::path plain = programs.parent_path() / folder;
  const fs::path real = fs::canonical(plain, problem);
  return problem ? plain : real;
}

fs::path fromEnvironment(const char* variable, const fs::path& fallback) {
  const char* value = std::getenv(variable);
  return value && *value ? fs::path(value) : fallback;
}

}  // namespace

std::string buildName() { return build_info::name; }

std::filesystem::path resourceFolder() {
  static const fs::path shipped = besidePrograms("share/trephine");
  return fromEnvironment("TREPHINE_RESOURCES", shipped);
}

std::filesystem::path pluginFolder() {
  static const fs::path shipped = besidePrograms("lib/trephine/plugins");
  return fromEnvironment("TREPHINE_PLUGINS", shipped);
}

std::optional<std::filesystem::path> configFolder() {
  const fs::path own = fromEnvironment("XDG_CONFIG_HOME", {}), home = fromEnvironment("HOME", {});
  if (own.is_absolute()) return own / "trephine";
  if (home.is_absolute()) return home / ".config" / "trephine";
  return {};
}

void keepToOwnFolders() {
  ::unsetenv("TREPHINE_RESOURCES");
  ::unsetenv("TREPHINE_PLUGINS");
}

}  // namespace trephine
