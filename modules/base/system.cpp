#include "base/system.h"

#include <cstdlib>

namespace trephine {

namespace build_info {
extern const char* const name;
}  // namespace build_info

namespace {

namespace fs = std::filesystem;

fs::path programs() {
  std::error_code problem;
  return fs::read_symlink("/proc/self/exe", problem).parent_path();
}

// Beside bin/, where this program is: wherever all of it was put, its own files are found. Links on
// the way are followed, so that a file has one name.
fs::path besidePrograms(const char* folder) {
  std::error_code problem;
  const fs::path plain = programs().parent_path() / folder;
  const fs::path real = fs::canonical(plain, problem);
  return problem ? plain : real;
}

fs::path fromEnvironment(const char* variable, const fs::path& fallback) {
  const char* value = std::getenv(variable);
  return value && *value ? fs::path(value) : fallback;
}

std::optional<fs::path> ofThisPerson(const char* variable, const char* usual) {
  const fs::path given = fromEnvironment(variable, {}), home = fromEnvironment("HOME", {});
  if (given.is_absolute()) return given / "trephine";
  if (home.is_absolute()) return home / usual / "trephine";
  return {};
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

std::filesystem::path builtInFolder() {
  static const fs::path shipped = besidePrograms("lib/trephine/cases");
  return shipped;
}

std::filesystem::path labProgram() {
  return programs() / "trephine-lab";
}

std::optional<std::filesystem::path> configFolder() {
  return ofThisPerson("XDG_CONFIG_HOME", ".config");
}

std::optional<std::filesystem::path> dataFolder() {
  return ofThisPerson("XDG_DATA_HOME", ".local/share");
}

std::optional<std::filesystem::path> stateFolder() {
  return ofThisPerson("XDG_STATE_HOME", ".local/state");
}

void keepToOwnFolders() {
  ::unsetenv("TREPHINE_RESOURCES");
  ::unsetenv("TREPHINE_PLUGINS");
}

}  // namespace trephine
