#include "headset/test_runtime.h"

#include <dlfcn.h>

#include "base/tr.h"
#include "headset/codes.h"

namespace trephine {

Result<TestRuntime*> loadTestRuntime(const std::filesystem::path& library) {
  const auto problem = [&](const std::string& what) {
    return Error{code::kNoRuntime, tr("The test runtime cannot be used: {}", what),
                 library.string(), tr("Give a runtime of your own (XR_RUNTIME_JSON)")};
  };
  std::error_code ec;
  const std::filesystem::path file = std::filesystem::absolute(library, ec);
  if (!std::filesystem::is_regular_file(file, ec)) return problem(tr("it is not there"));
  void* handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) return problem(::dlerror());
  using Entry = TestRuntime* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(handle, "trephine_xr_test_runtime"));
  TestRuntime* runtime = entry ? entry() : nullptr;
  if (!runtime) return problem(tr("it offers none"));
  return runtime;
}

}  // namespace trephine
