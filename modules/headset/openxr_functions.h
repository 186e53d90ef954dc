// OpenXR's functions, from the system's loader, which is opened when a headset is first wanted: a
// machine without it runs as before. Include it after Qt's headers: it brings Xlib's macros, of
// which only the three below are taken back.
#pragma once

#include "base/result.h"
//
#include <GL/glx.h>
// Xlib's names for what others call so.
#undef Bool
#undef None
#undef Status
#define XR_USE_PLATFORM_XLIB
#define XR_USE_GRAPHICS_API_OPENGL
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

namespace trephine {

// A structure of OpenXR with its `type` set and all else zero.
template <class T>
T typed(XrStructureType type) {
  T of{};
  of.type = type;
  return of;
}

struct OpenXr {
  // Any thread. Once loaded it stays for good; where the loader is missing it is looked for again
  // at every call. Copy it for an instance's own functions. Error: NO_LOADER.
  static Result<const OpenXr*> load();
  // Gets the functions of an instance that was created. False where its runtime lacks one: that and
  // all below it are null, so ask before calling destroyInstance.
  bool loadFor(XrInstance instance);

  PFN_xrGetInstanceProcAddr getInstanceProcAddr = nullptr;
  PFN_xrEnumerateInstanceExtensionProperties enumerateInstanceExtensionProperties = nullptr;
  PFN_xrCreateInstance createInstance = nullptr;
  // ---- Null until loadFor().
  PFN_xrDestroyInstance destroyInstance = nullptr;
  PFN_xrPollEvent pollEvent = nullptr;
  PFN_xrGetSystem getSystem = nullptr;
  PFN_xrEnumerateViewConfigurationViews enumerateViewConfigurationViews = nullptr;
  PFN_xrGetOpenGLGraphicsRequirementsKHR getOpenGlGraphicsRequirements = nullptr;
  PFN_xrCreateSession createSession = nullptr;
  PFN_xrDestroySession destroySession = nullptr;
  PFN_xrBeginSession beginSession = nullptr;
  PFN_xrRequestExitSession requestExitSession = nullptr;
  PFN_xrEndSession endSession = nullptr;
  PFN_xrCreateReferenceSpace createReferenceSpace = nullptr;
  PFN_xrDestroySpace destroySpace = nullptr;
  PFN_xrEnumerateSwapchainFormats enumerateSwapchainFormats = nullptr;
  PFN_xrCreateSwapchain createSwapchain = nullptr;
  PFN_xrDestroySwapchain destroySwapchain = nullptr;
  PFN_xrEnumerateSwapchainImages enumerateSwapchainImages = nullptr;
  PFN_xrAcquireSwapchainImage acquireSwapchainImage = nullptr;
  PFN_xrWaitSwapchainImage waitSwapchainImage = nullptr;
  PFN_xrReleaseSwapchainImage releaseSwapchainImage = nullptr;
  PFN_xrWaitFrame waitFrame = nullptr;
  PFN_xrBeginFrame beginFrame = nullptr;
  PFN_xrLocateViews locateViews = nullptr;
  PFN_xrEndFrame endFrame = nullptr;
};

}  // namespace trephine
