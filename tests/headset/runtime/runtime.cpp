// The functions of the test runtime, each as short as its rule.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "runtime_state.h"

namespace trephine::xr_test {

XrResult makeImages(RuntimeState& runtime, Swapchain& chain, std::int64_t format);

namespace {

constexpr std::int64_t kFormats[] = {0x8C43 /* GL_SRGB8_ALPHA8 */, 0x8058 /* GL_RGBA8 */};
constexpr std::uint32_t kLargest = 4096;

// The loader's side of the negotiation, from the specification: Debian ships no header of it.
struct LoaderInfo {
  int type;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t least_interface, most_interface;
  XrVersion least_api, most_api;
};
struct RuntimeRequest {
  int type;
  std::uint32_t version;
  std::size_t size;
  std::uint32_t interface_version;
  XrVersion api;
  PFN_xrGetInstanceProcAddr get;
};

// OpenXR's way to give a list: how many there are, and the list where there is room for it.
template <class T>
XrResult give(const std::vector<T>& all, std::uint32_t room, std::uint32_t* count, T* to) {
  *count = std::uint32_t(all.size());
  if (room == 0) return XR_SUCCESS;
  if (room < all.size()) return XR_ERROR_SIZE_INSUFFICIENT;
  std::copy(all.begin(), all.end(), to);
  return XR_SUCCESS;
}

// Holds the lock for the rest of the function, which ends here where the script says so.
#define TREPHINE_ENTER(function, of_session)                                                    \
  RuntimeState& runtime = theRuntime();                                                         \
  [[maybe_unused]] auto held = runtime.lock();                                                  \
  if (const XrResult scripted = runtime.enter(#function, of_session); scripted != XR_SUCCESS) { \
    return scripted;                                                                            \
  }

XrResult XRAPI_CALL enumerateExtensions(const char*, std::uint32_t room, std::uint32_t* count,
                                        XrExtensionProperties* to) {
  TREPHINE_ENTER(xrEnumerateInstanceExtensionProperties, false)
  XrExtensionProperties opengl{XR_TYPE_EXTENSION_PROPERTIES, nullptr, {}, 0};
  std::snprintf(opengl.extensionName, sizeof opengl.extensionName, "%s",
                XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  opengl.extensionVersion = XR_KHR_opengl_enable_SPEC_VERSION;
  return give<XrExtensionProperties>({opengl}, room, count, to);
}

XrResult XRAPI_CALL createInstance(const XrInstanceCreateInfo*, XrInstance* instance) {
  TREPHINE_ENTER(xrCreateInstance, false)
  if (!runtime.instances.empty()) return XR_ERROR_LIMIT_REACHED;
  runtime.instances.insert(++runtime.last_handle);
  runtime.events.clear();
  runtime.asked_for_requirements = false;
  *instance = XrInstance(runtime.last_handle);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroyInstance(XrInstance) {
  RuntimeState& runtime = theRuntime();
  const auto held = runtime.lock();
  (void)runtime.enter("xrDestroyInstance", false);
  runtime.instances.clear();
  runtime.dropSession();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL instanceProperties(XrInstance, XrInstanceProperties* to) {
  TREPHINE_ENTER(xrGetInstanceProperties, false)
  to->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
  std::snprintf(to->runtimeName, sizeof to->runtimeName, "Trephine's test runtime");
  return XR_SUCCESS;
}

XrResult XRAPI_CALL pollEvent(XrInstance, XrEventDataBuffer* to) {
  TREPHINE_ENTER(xrPollEvent, false)
  if (runtime.events.empty()) return XR_EVENT_UNAVAILABLE;
  *to = runtime.events.front();
  runtime.events.pop_front();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL getSystem(XrInstance, const XrSystemGetInfo* wanted, XrSystemId* system) {
  TREPHINE_ENTER(xrGetSystem, false)
  if (wanted->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY) {
    return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
  }
  if (!runtime.plugged_in) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
  *system = 1;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL systemProperties(XrInstance, XrSystemId, XrSystemProperties* to) {
  TREPHINE_ENTER(xrGetSystemProperties, false)
  std::snprintf(to->systemName, sizeof to->systemName, "Test headset");
  to->graphicsProperties = {kLargest, kLargest, 16};
  to->trackingProperties = {XR_TRUE, XR_TRUE};
  return XR_SUCCESS;
}

XrResult XRAPI_CALL viewConfigurationViews(XrInstance, XrSystemId, XrViewConfigurationType,
                                           std::uint32_t room, std::uint32_t* count,
                                           XrViewConfigurationView* to) {
  TREPHINE_ENTER(xrEnumerateViewConfigurationViews, false)
  const XrViewConfigurationView view{XR_TYPE_VIEW_CONFIGURATION_VIEW,
                                     nullptr,
                                     runtime.width,
                                     kLargest,
                                     runtime.height,
                                     kLargest,
                                     1,
                                     1};
  return give<XrViewConfigurationView>({view, view}, room, count, to);
}

XrResult XRAPI_CALL openGlRequirements(XrInstance, XrSystemId,
                                       XrGraphicsRequirementsOpenGLKHR* to) {
  TREPHINE_ENTER(xrGetOpenGLGraphicsRequirementsKHR, false)
  to->minApiVersionSupported = XR_MAKE_VERSION(3, 2, 0);
  to->maxApiVersionSupported = XR_MAKE_VERSION(4, 6, 0);
  runtime.asked_for_requirements = true;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL createSession(XrInstance, const XrSessionCreateInfo* info, XrSession* session) {
  TREPHINE_ENTER(xrCreateSession, false)
  if (!runtime.asked_for_requirements) return XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING;
  if (!runtime.sessions.empty()) return XR_ERROR_LIMIT_REACHED;
  const auto* next = static_cast<const XrBaseInStructure*>(info->next);
  while (next && next->type != XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR) next = next->next;
  const auto* binding = reinterpret_cast<const XrGraphicsBindingOpenGLXlibKHR*>(next);
  if (!binding || !binding->xDisplay || !binding->glxContext || !binding->glxDrawable ||
      !binding->glxFBConfig || binding->visualid == 0) {
    return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  }
  int id = 0;
  if (::glXGetFBConfigAttrib(binding->xDisplay, binding->glxFBConfig, GLX_FBCONFIG_ID, &id) != 0) {
    return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  }
  runtime.context = binding->glxContext;
  if (!runtime.hasContext("xrCreateSession")) {
    runtime.context = nullptr;
    return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  }
  runtime.sessions.insert(++runtime.last_handle);
  runtime.frames_waited_for = 0;
  *session = XrSession(runtime.last_handle);
  runtime.push(XR_SESSION_STATE_IDLE);
  runtime.push(XR_SESSION_STATE_READY);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroySession(XrSession) {
  RuntimeState& runtime = theRuntime();
  const auto held = runtime.lock();
  (void)runtime.enter("xrDestroySession", false);
  runtime.dropSession();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL beginSession(XrSession, const XrSessionBeginInfo*) {
  TREPHINE_ENTER(xrBeginSession, true)
  if (runtime.running) return XR_ERROR_SESSION_RUNNING;
  if (runtime.state != XR_SESSION_STATE_READY) return XR_ERROR_SESSION_NOT_READY;
  runtime.running = true;
  runtime.seen = false;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL requestExit(XrSession) {
  TREPHINE_ENTER(xrRequestExitSession, true)
  if (!runtime.running) return XR_ERROR_SESSION_NOT_RUNNING;
  if (runtime.state == XR_SESSION_STATE_FOCUSED) runtime.push(XR_SESSION_STATE_VISIBLE);
  if (runtime.state == XR_SESSION_STATE_VISIBLE) runtime.push(XR_SESSION_STATE_SYNCHRONIZED);
  runtime.push(XR_SESSION_STATE_STOPPING);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL endSession(XrSession) {
  TREPHINE_ENTER(xrEndSession, true)
  if (!runtime.running) return XR_ERROR_SESSION_NOT_RUNNING;
  if (runtime.state != XR_SESSION_STATE_STOPPING) return XR_ERROR_SESSION_NOT_STOPPING;
  runtime.running = false;
  runtime.push(XR_SESSION_STATE_IDLE);
  runtime.push(XR_SESSION_STATE_EXITING);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL createSpace(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* space) {
  TREPHINE_ENTER(xrCreateReferenceSpace, true)
  if (info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_STAGE && !runtime.stage) {
    return XR_ERROR_REFERENCE_SPACE_UNSUPPORTED;
  }
  runtime.spaces[++runtime.last_handle] = info->referenceSpaceType;
  *space = XrSpace(runtime.last_handle);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroySpace(XrSpace space) {
  RuntimeState& runtime = theRuntime();
  const auto held = runtime.lock();
  (void)runtime.enter("xrDestroySpace", false);
  return runtime.spaces.erase(handleOf(space)) ? XR_SUCCESS : XR_ERROR_HANDLE_INVALID;
}

XrResult XRAPI_CALL swapchainFormats(XrSession, std::uint32_t room, std::uint32_t* count,
                                     std::int64_t* to) {
  TREPHINE_ENTER(xrEnumerateSwapchainFormats, true)
  return give<std::int64_t>({std::begin(kFormats), std::end(kFormats)}, room, count, to);
}

XrResult XRAPI_CALL createSwapchain(XrSession, const XrSwapchainCreateInfo* info,
                                    XrSwapchain* chain) {
  TREPHINE_ENTER(xrCreateSwapchain, true)
  if (std::find(std::begin(kFormats), std::end(kFormats), info->format) == std::end(kFormats)) {
    return XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED;
  }
  if (info->width == 0 || info->height == 0 || info->width > kLargest || info->height > kLargest) {
    return XR_ERROR_VALIDATION_FAILURE;
  }
  if (!runtime.hasContext("xrCreateSwapchain")) return XR_ERROR_RUNTIME_FAILURE;
  Swapchain made;
  made.width = info->width;
  made.height = info->height;
  makeImages(runtime, made, info->format);
  runtime.swapchains[++runtime.last_handle] = std::move(made);
  *chain = XrSwapchain(runtime.last_handle);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroySwapchain(XrSwapchain chain) {
  RuntimeState& runtime = theRuntime();
  const auto held = runtime.lock();
  (void)runtime.enter("xrDestroySwapchain", false);
  const auto of = runtime.swapchains.find(handleOf(chain));
  if (of == runtime.swapchains.end()) return XR_ERROR_HANDLE_INVALID;
  runtime.dropSwapchain(of->second);
  runtime.swapchains.erase(of);
  return XR_SUCCESS;
}

// The functions below are of a chain that exists.
#define TREPHINE_CHAIN(function)                                         \
  TREPHINE_ENTER(function, true)                                         \
  const auto found = runtime.swapchains.find(handleOf(chain));           \
  if (found == runtime.swapchains.end()) return XR_ERROR_HANDLE_INVALID; \
  Swapchain& of = found->second;

XrResult XRAPI_CALL swapchainImages(XrSwapchain chain, std::uint32_t room, std::uint32_t* count,
                                    XrSwapchainImageBaseHeader* to) {
  TREPHINE_CHAIN(xrEnumerateSwapchainImages)
  *count = std::uint32_t(of.images.size());
  if (room == 0) return XR_SUCCESS;
  if (room < *count) return XR_ERROR_SIZE_INSUFFICIENT;
  for (std::uint32_t i = 0; i < *count; ++i) {
    reinterpret_cast<XrSwapchainImageOpenGLKHR*>(to)[i].image = of.images[i];
  }
  return XR_SUCCESS;
}

XrResult XRAPI_CALL acquireImage(XrSwapchain chain, const XrSwapchainImageAcquireInfo*,
                                 std::uint32_t* index) {
  TREPHINE_CHAIN(xrAcquireSwapchainImage)
  if (of.acquired >= 0) {
    runtime.violated("xrAcquireSwapchainImage: one is acquired already");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  of.acquired = int(of.next);
  of.next = (of.next + 1) % of.images.size();
  of.waited = false;
  *index = std::uint32_t(of.acquired);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL waitImage(XrSwapchain chain, const XrSwapchainImageWaitInfo*) {
  TREPHINE_CHAIN(xrWaitSwapchainImage)
  if (of.acquired < 0) {
    runtime.violated("xrWaitSwapchainImage: none is acquired");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  of.waited = true;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL releaseImage(XrSwapchain chain, const XrSwapchainImageReleaseInfo*) {
  TREPHINE_CHAIN(xrReleaseSwapchainImage)
  if (!runtime.hasContext("xrReleaseSwapchainImage")) return XR_ERROR_RUNTIME_FAILURE;
  if (of.acquired < 0 || !of.waited) {
    runtime.violated("xrReleaseSwapchainImage: none was waited for");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  of.released = of.acquired;
  of.acquired = -1;
  ::glFinish();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL waitFrame(XrSession, const XrFrameWaitInfo*, XrFrameState* frame) {
  TREPHINE_ENTER(xrWaitFrame, true)
  if (!runtime.running) return XR_ERROR_SESSION_NOT_RUNNING;
  return runtime.waitFrame(held, *frame);
}

XrResult XRAPI_CALL beginFrame(XrSession, const XrFrameBeginInfo*) {
  TREPHINE_ENTER(xrBeginFrame, true)
  if (!runtime.running) return XR_ERROR_SESSION_NOT_RUNNING;
  if (!runtime.hasContext("xrBeginFrame")) return XR_ERROR_RUNTIME_FAILURE;
  if (runtime.frames_waited_for == 0) {
    runtime.violated("xrBeginFrame: no frame was waited for");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  --runtime.frames_waited_for;
  return std::exchange(runtime.frame_begun, true) ? XR_FRAME_DISCARDED : XR_SUCCESS;
}

XrResult XRAPI_CALL locateViews(XrSession, const XrViewLocateInfo* info, XrViewState* state,
                                std::uint32_t room, std::uint32_t* count, XrView* to) {
  TREPHINE_ENTER(xrLocateViews, true)
  const auto space = runtime.spaces.find(handleOf(info->space));
  if (space == runtime.spaces.end()) return XR_ERROR_HANDLE_INVALID;
  *count = 2;
  state->viewStateFlags = XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT |
                          XR_VIEW_STATE_ORIENTATION_TRACKED_BIT |
                          XR_VIEW_STATE_POSITION_TRACKED_BIT;
  if (room == 0) return XR_SUCCESS;
  if (room < 2) return XR_ERROR_SIZE_INSUFFICIENT;
  for (int eye = 0; eye < 2; ++eye) {
    to[eye].pose = runtime.eyePose(eye);
    to[eye].fov = runtime.eyeFov(eye);
  }
  return XR_SUCCESS;
}

// A rectangle of a chain from which something can be shown.
XrResult check(RuntimeState& runtime, const XrSwapchainSubImage& of) {
  const auto chain = runtime.swapchains.find(handleOf(of.swapchain));
  if (chain == runtime.swapchains.end()) return XR_ERROR_HANDLE_INVALID;
  if (chain->second.released < 0) return XR_ERROR_LAYER_INVALID;
  const XrRect2Di& r = of.imageRect;
  if (r.offset.x < 0 || r.offset.y < 0 || r.extent.width < 1 || r.extent.height < 1 ||
      std::uint32_t(r.offset.x + r.extent.width) > chain->second.width ||
      std::uint32_t(r.offset.y + r.extent.height) > chain->second.height) {
    return XR_ERROR_SWAPCHAIN_RECT_INVALID;
  }
  return XR_SUCCESS;
}

XrResult check(const XrPosef& pose) {
  const XrQuaternionf& q = pose.orientation;
  const float length = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  return std::abs(length - 1.0F) < 0.01F ? XR_SUCCESS : XR_ERROR_POSE_INVALID;
}

XrResult check(RuntimeState& runtime, const XrCompositionLayerBaseHeader& layer) {
  if (!runtime.spaces.contains(handleOf(layer.space))) return XR_ERROR_HANDLE_INVALID;
  if (layer.type == XR_TYPE_COMPOSITION_LAYER_QUAD) {
    const auto& quad = reinterpret_cast<const XrCompositionLayerQuad&>(layer);
    if (const XrResult pose = check(quad.pose); pose != XR_SUCCESS) return pose;
    return check(runtime, quad.subImage);
  }
  if (layer.type != XR_TYPE_COMPOSITION_LAYER_PROJECTION) return XR_ERROR_LAYER_INVALID;
  const auto& eyes = reinterpret_cast<const XrCompositionLayerProjection&>(layer);
  if (eyes.viewCount != 2) return XR_ERROR_VALIDATION_FAILURE;
  for (int eye = 0; eye < 2; ++eye) {
    if (const XrResult pose = check(eyes.views[eye].pose); pose != XR_SUCCESS) return pose;
    const XrResult image = check(runtime, eyes.views[eye].subImage);
    if (image != XR_SUCCESS) return image;
  }
  return XR_SUCCESS;
}

XrResult XRAPI_CALL endFrame(XrSession, const XrFrameEndInfo* frame) {
  TREPHINE_ENTER(xrEndFrame, true)
  if (!runtime.running) return XR_ERROR_SESSION_NOT_RUNNING;
  if (!runtime.hasContext("xrEndFrame")) return XR_ERROR_RUNTIME_FAILURE;
  if (!runtime.frame_begun) {
    runtime.violated("xrEndFrame: no frame has begun");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  for (std::uint32_t i = 0; i < frame->layerCount; ++i) {
    const XrResult good = check(runtime, *frame->layers[i]);
    if (good == XR_SUCCESS) continue;
    runtime.violated("xrEndFrame: a layer that cannot be shown");
    return good;
  }
  runtime.frame_begun = false;
  runtime.take(*frame);
  if (!std::exchange(runtime.seen, true)) {  // a session is seen from its first frame on
    runtime.push(XR_SESSION_STATE_SYNCHRONIZED);
    runtime.push(XR_SESSION_STATE_VISIBLE);
    runtime.push(XR_SESSION_STATE_FOCUSED);
  }
  return XR_SUCCESS;
}

XrResult XRAPI_CALL getFunction(XrInstance, const char* name, PFN_xrVoidFunction* function);

struct Named {
  const char* name;
  PFN_xrVoidFunction function;
};
template <class F>
Named named(const char* name, F* function) {
  return {name, reinterpret_cast<PFN_xrVoidFunction>(function)};
}

const std::vector<Named>& table() {
  static const std::vector<Named> all = {
      named("xrGetInstanceProcAddr", getFunction),
      named("xrEnumerateInstanceExtensionProperties", enumerateExtensions),
      named("xrCreateInstance", createInstance),
      named("xrDestroyInstance", destroyInstance),
      named("xrGetInstanceProperties", instanceProperties),
      named("xrPollEvent", pollEvent),
      named("xrGetSystem", getSystem),
      named("xrGetSystemProperties", systemProperties),
      named("xrEnumerateViewConfigurationViews", viewConfigurationViews),
      named("xrGetOpenGLGraphicsRequirementsKHR", openGlRequirements),
      named("xrCreateSession", createSession),
      named("xrDestroySession", destroySession),
      named("xrBeginSession", beginSession),
      named("xrRequestExitSession", requestExit),
      named("xrEndSession", endSession),
      named("xrCreateReferenceSpace", createSpace),
      named("xrDestroySpace", destroySpace),
      named("xrEnumerateSwapchainFormats", swapchainFormats),
      named("xrCreateSwapchain", createSwapchain),
      named("xrDestroySwapchain", destroySwapchain),
      named("xrEnumerateSwapchainImages", swapchainImages),
      named("xrAcquireSwapchainImage", acquireImage),
      named("xrWaitSwapchainImage", waitImage),
      named("xrReleaseSwapchainImage", releaseImage),
      named("xrWaitFrame", waitFrame),
      named("xrBeginFrame", beginFrame),
      named("xrLocateViews", locateViews),
      named("xrEndFrame", endFrame),
  };
  return all;
}

XrResult XRAPI_CALL getFunction(XrInstance, const char* name, PFN_xrVoidFunction* function) {
  *function = nullptr;
  for (const Named& each : table()) {
    if (std::strcmp(each.name, name) == 0) *function = each.function;
  }
  return *function ? XR_SUCCESS : XR_ERROR_FUNCTION_UNSUPPORTED;
}

}  // namespace

const std::vector<std::string>& functionNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Named& each : table()) all.emplace_back(each.name);
    return all;
  }();
  return names;
}

}  // namespace trephine::xr_test

using trephine::xr_test::LoaderInfo;
using trephine::xr_test::RuntimeRequest;

extern "C" __attribute__((visibility("default"))) XrResult XRAPI_CALL
xrNegotiateLoaderRuntimeInterface(const LoaderInfo* loader, RuntimeRequest* request) {
  constexpr int kLoaderInfo = 1, kRuntimeRequest = 3;
  if (!loader || !request || loader->type != kLoaderInfo || loader->version != 1 ||
      loader->size != sizeof(LoaderInfo) || request->type != kRuntimeRequest ||
      request->version != 1 || request->size != sizeof(RuntimeRequest) ||
      loader->least_interface > 1 || loader->most_interface < 1) {
    return XR_ERROR_INITIALIZATION_FAILED;
  }
  request->interface_version = 1;
  request->api = XR_MAKE_VERSION(1, 0, 20);
  request->get = trephine::xr_test::getFunction;
  return XR_SUCCESS;
}
