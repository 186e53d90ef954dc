#include "device/device_bench.h"

#include <dlfcn.h>

#include "base/tr.h"
#include "device/codes.h"

namespace trephine {

Result<DeviceBench*> loadDeviceBench(const std::filesystem::path& library) {
  const auto problem = [&](const std::string& what) {
    return Error{code::kNoBench, tr("The bench cannot be used: {}", what), library.string(),
                 tr("Give a library that emulates devices for measurements")};
  };
  std::error_code ec;
  const std::filesystem::path file = std::filesystem::absolute(library, ec);
  if (!std::filesystem::is_regular_file(file, ec)) return problem(tr("it is no file"));
  void* handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) return problem(::dlerror());
  using Entry = DeviceBench* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(handle, "trephine_device_bench"));
  DeviceBench* bench = entry ? entry() : nullptr;
  if (!bench) return problem(tr("it offers none"));
  return bench;
}

}  // namespace trephine
