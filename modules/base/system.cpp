#include "base/system.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

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

std::filesystem::path measureProgram() {
  return programs() / "trephine-measure";
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
  for (const char* name :
       {"TREPHINE_RESOURCES", "TREPHINE_PLUGINS",
        "HDF5_PLUGIN_PATH", "HDF5_PLUGIN_PRELOAD", "HDF5_DRIVER", "HDF5_VOL_CONNECTOR",
        "QT_PLUGIN_PATH", "QT_QPA_PLATFORM_PLUGIN_PATH", "QT_QPA_PLATFORMTHEME",
        "QT_QPA_GENERIC_PLUGINS", "QT_STYLE_OVERRIDE", "QT_LOGGING_CONF",
        "XR_RUNTIME_JSON", "XR_API_LAYER_PATH", "XR_ENABLE_API_LAYERS", "XR_CONFIG_DIRS",
        "OPENSSL_CONF", "OPENSSL_MODULES", "OPENSSL_ENGINES", "DCMDICTPATH",
        "LIBGL_DRIVERS_PATH", "LIBGL_DRIVERS_DIR", "GBM_BACKENDS_PATH", "GALLIUM_PIPE_SEARCH_DIR",
        "__EGL_VENDOR_LIBRARY_FILENAMES", "__EGL_VENDOR_LIBRARY_DIRS",
        "VK_ICD_FILENAMES", "VK_DRIVER_FILES", "VK_ADD_DRIVER_FILES", "VK_LAYER_PATH",
        "VK_ADD_LAYER_PATH", "VK_INSTANCE_LAYERS",
        "VTK_AUTOLOAD_PATH", "VK_IMPLICIT_LAYER_PATH", "VK_ADD_IMPLICIT_LAYER_PATH", "SASL_PATH",
        "XLOCALEDIR", "XLOCALELIBDIR", "__GLX_VENDOR_LIBRARY_NAME", "__GLX_FORCE_VENDOR_LIBRARY_0",
        "GCONV_PATH", "LOCPATH", "GTK_MODULES", "GTK_PATH", "GIO_EXTRA_MODULES",
        "GIO_MODULE_DIR"}) {
    ::unsetenv(name);
  }
}

void keepMemoryPrivate() {
  // A limit of 0 alone does not stop a core_pattern that is a pipe.
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  ::prctl(PR_SET_DUMPABLE, 0);
}

}  // namespace trephine
