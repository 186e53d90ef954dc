#include "headset/openxr_functions.h"

#include <dlfcn.h>

#include <mutex>

#include "base/tr.h"
#include "headset/codes.h"

namespace trephine {

namespace {

template <class F>
bool get(const OpenXr& from, XrInstance instance, const char* name, F& function) {
  PFN_xrVoidFunction found = nullptr;
  if (XR_FAILED(from.getInstanceProcAddr(instance, name, &found)) || !found) return false;
  function = reinterpret_cast<F>(found);
  return true;
}

OpenXr open() {
  OpenXr xr;
  // Not closed: what it has loaded in turn may have threads.
  void* library = ::dlopen("libopenxr_loader.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library) return xr;
  xr.getInstanceProcAddr =
      reinterpret_cast<PFN_xrGetInstanceProcAddr>(::dlsym(library, "xrGetInstanceProcAddr"));
  if (!xr.getInstanceProcAddr ||
      !get(xr, XR_NULL_HANDLE, "xrEnumerateInstanceExtensionProperties",
           xr.enumerateInstanceExtensionProperties) ||
      !get(xr, XR_NULL_HANDLE, "xrCreateInstance", xr.createInstance)) {
    xr.createInstance = nullptr;
  }
  return xr;
}

}  // namespace

Result<const OpenXr*> OpenXr::load() {
  // Tried again where it was not there: somebody may have installed it.
  static std::mutex one_at_a_time;
  static OpenXr loaded;
  const std::lock_guard lock(one_at_a_time);
  if (!loaded.createInstance) loaded = open();
  if (loaded.createInstance) return &loaded;
  return Error{code::kNoLoader, tr("No headset can be used: OpenXR's loader is not installed"),
               "libopenxr_loader.so.1", tr("Install the package libopenxr-loader1 and try again")};
}

bool OpenXr::loadFor(XrInstance instance) {
  const auto has = [&](const char* name, auto& function) {
    return get(*this, instance, name, function);
  };
  return has("xrDestroyInstance", destroyInstance) && has("xrPollEvent", pollEvent) &&
         has("xrGetSystem", getSystem) &&
         has("xrEnumerateViewConfigurationViews", enumerateViewConfigurationViews) &&
         has("xrGetOpenGLGraphicsRequirementsKHR", getOpenGlGraphicsRequirements) &&
         has("xrCreateSession", createSession) && has("xrDestroySession", destroySession) &&
         has("xrBeginSession", beginSession) && has("xrRequestExitSession", requestExitSession) &&
         has("xrEndSession", endSession) && has("xrCreateReferenceSpace", createReferenceSpace) &&
         has("xrDestroySpace", destroySpace) &&
         has("xrEnumerateSwapchainFormats", enumerateSwapchainFormats) &&
         has("xrCreateSwapchain", createSwapchain) && has("xrDestroySwapchain", destroySwapchain) &&
         has("xrEnumerateSwapchainImages", enumerateSwapchainImages) &&
         has("xrAcquireSwapchainImage", acquireSwapchainImage) &&
         has("xrWaitSwapchainImage", waitSwapchainImage) &&
         has("xrReleaseSwapchainImage", releaseSwapchainImage) && has("xrWaitFrame", waitFrame) &&
         has("xrBeginFrame", beginFrame) && has("xrLocateViews", locateViews) &&
         has("xrEndFrame", endFrame);
}

}  // namespace trephine
