#include "headset/openxr_session.h"

#include <QOpenGLExtraFunctions>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/tr.h"
#include "headset/active_runtime.h"
#include "headset/room_place.h"
//
#include <unistd.h>
// Xlib comes with it.
#include "headset/codes.h"
#include "headset/openxr_layers.h"

namespace trephine {

namespace {

using namespace std::chrono_literals;

constexpr XrViewConfigurationType kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
// With GL_FRAMEBUFFER_SRGB off, the first keeps the bytes as the window shows them.
constexpr std::int64_t kSrgb8 = 0x8C43, kRgba8 = 0x8058;
constexpr GLenum kFramebufferSrgb = 0x8DB9;
constexpr XrDuration kImagePatience_ns = 100'000'000;
constexpr auto kExitPatience = 2s;      // for the runtime to end a session that is to end
constexpr double kTryEvery_s = 0.5;     // a pair of eyes, while the flat screen stands there
constexpr double kPanelEvery_s = 0.03;  // its picture, on that screen
constexpr int kScreenWidth = 1280, kScreenHeight = 800;  // pixels

// Leaves the functions below; caught in runOpenXr.
struct Over {
  HeadsetEnd how;
};

class OpenXrSession {
 public:
  OpenXrSession(HeadsetShared& shared, QOpenGLExtraFunctions& gl)
      : shared_(shared), gl_(gl), pace_(shared.options.pace) {}
  ~OpenXrSession() { cleanUp(); }

  void open();
  void run();  // until it is to end

 private:
  struct Chain {
    XrSwapchain handle = XR_NULL_HANDLE;
    std::vector<XrSwapchainImageOpenGLKHR> images;
    int width = 0, height = 0;
  };
  enum class Shows { nothing, eyes, flat };
  template <class Call>
  XrResult call(Call&& function);
  void check(XrResult result, const char* function);
  [[noreturn]] void end(Status why, bool again);

  void createInstance();
  void findHeadset();
  void createSession();
  XrGraphicsBindingOpenGLXlibKHR binding();
  Chain createChain(int width, int height);
  bool pollEvents();  // false: it has ended as it was asked to
  void changeState(XrSessionState state);
  void frame();
  void addShown(OpenXrLayers& layers);
  bool locate(XrTime at);
  void showEyes();
  void showFlat();
  void dropPanel();
  void discard(SharedPicture& picture);
  void placeScreen();
  void draw(const SharedPicture& picture, std::size_t texture, Chain& into);
  void blitFresh(SharedPicture& picture, Shows kind);
  void release(SharedPicture*& held);
  void cleanUp();

  HeadsetShared& shared_;
  QOpenGLExtraFunctions& gl_;
  PaceRule pace_;
  OpenXr xr_;
  XrInstance instance_ = XR_NULL_HANDLE;
  XrSystemId system_ = 0;
  XrSession session_ = XR_NULL_HANDLE;
  XrSpace room_ = XR_NULL_HANDLE;
  std::int64_t format_ = 0;
  Chain eyes_[2], screen_;
  std::vector<XrSwapchain> made_chains_;
  GLuint framebuffers_[2] = {0, 0};  // read, draw
  bool running_ = false, asked_to_end_ = false, ended_ = false;
  std::chrono::steady_clock::time_point end_by_{};

  HeadsetState state_;
  std::optional<XrTime> room_changes_at_;
  Eyes now_m_{};  // where the eyes will be when this frame is seen
  std::uint64_t number_ = 0;
  Shows shows_ = Shows::nothing;
  SharedPicture *pair_ = nullptr, *panel_ = nullptr;  // shown
  PictureRequest pair_shown_;
  int repeats_ = 0;  // of the shown pair
  Pose screen_pose_m_;
  double screen_height_m_ = 1.0, last_try_s_ = 0.0, last_panel_s_ = 0.0;
};

// An abandoned thread ends with the process: nothing that it knew is there any more.
template <class Call>
XrResult OpenXrSession::call(Call&& function) {
  shared_.in_call_since_ns = monotonic_ns();
  const XrResult result = function();
  shared_.in_call_since_ns = 0;
  while (shared_.abandoned) ::pause();
  return result;
}

void OpenXrSession::end(Status why, bool again) {
  throw Over{{std::move(why), again}};
}

void OpenXrSession::check(XrResult result, const char* function) {
  if (XR_SUCCEEDED(result) && result != XR_SESSION_LOSS_PENDING) return;
  const std::string where = tr("{}, XrResult {}", function, int(result));
  switch (result) {
    case XR_ERROR_RUNTIME_UNAVAILABLE:
      end(noActiveRuntime(where), false);
    case XR_ERROR_FORM_FACTOR_UNAVAILABLE:
    case XR_ERROR_FORM_FACTOR_UNSUPPORTED:
      end(Error{code::kNoHeadset, tr("No headset is found"), where,
                tr("Plug it in, switch it on, try again")},
          true);
    case XR_ERROR_LIMIT_REACHED:
      end(Error{code::kHeadsetInUse, tr("Another program has the headset"), where,
                tr("Close it, try again")},
          true);
    case XR_ERROR_INSTANCE_LOST:
    case XR_ERROR_SESSION_LOST:
    case XR_SESSION_LOSS_PENDING:
      end(Error{code::kHeadsetLost, tr("The headset went away"), where,
                tr("The exercise goes on in the window; put the headset on again when it is back")},
          true);
    default:
      end(Error{code::kHeadsetFailed, tr("The headset's software reports an error"), where,
                tr("Start that software anew and try again")},
          true);
  }
}

void OpenXrSession::open() {
  createInstance();
  findHeadset();
  createSession();
}

void OpenXrSession::createInstance() {
  const Result<const OpenXr*> loader = OpenXr::load();
  if (!loader) end(loader.error(), false);
  xr_ = **loader;
  std::uint32_t count = 0;
  check(call([&] { return xr_.enumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr); }),
        "xrEnumerateInstanceExtensionProperties");
  std::vector extensions(count, typed<XrExtensionProperties>(XR_TYPE_EXTENSION_PROPERTIES));
  check(call([&] {
          return xr_.enumerateInstanceExtensionProperties(nullptr, count, &count,
                                                          extensions.data());
        }),
        "xrEnumerateInstanceExtensionProperties");
  const bool opengl = std::ranges::any_of(extensions, [](const XrExtensionProperties& each) {
    return std::strcmp(each.extensionName, XR_KHR_OPENGL_ENABLE_EXTENSION_NAME) == 0;
  });
  if (!opengl) {
    end(Error{code::kNoRuntime, tr("The active OpenXR runtime takes no pictures of OpenGL"),
              XR_KHR_OPENGL_ENABLE_EXTENSION_NAME,
              tr("Use another runtime, such as Monado or SteamVR")},
        false);
  }
  const char* const names[] = {XR_KHR_OPENGL_ENABLE_EXTENSION_NAME};
  auto info = typed<XrInstanceCreateInfo>(XR_TYPE_INSTANCE_CREATE_INFO);
  std::snprintf(info.applicationInfo.applicationName, XR_MAX_APPLICATION_NAME_SIZE, "Trephine");
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  info.enabledExtensionCount = 1;
  info.enabledExtensionNames = names;
  check(call([&] { return xr_.createInstance(&info, &instance_); }), "xrCreateInstance");
  if (!xr_.loadFor(instance_)) {
    // Then xrDestroyInstance may be missing too.
    if (!xr_.destroyInstance) instance_ = XR_NULL_HANDLE;
    end(Error{code::kNoRuntime, tr("The active OpenXR runtime lacks a function"), "",
              tr("Update the headset's software")},
        false);
  }
}

void OpenXrSession::findHeadset() {
  const XrSystemGetInfo wanted{XR_TYPE_SYSTEM_GET_INFO, nullptr,
                               XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
  check(call([&] { return xr_.getSystem(instance_, &wanted, &system_); }), "xrGetSystem");
  std::uint32_t count = 0;
  std::vector views(2, typed<XrViewConfigurationView>(XR_TYPE_VIEW_CONFIGURATION_VIEW));
  check(call([&] {
          return xr_.enumerateViewConfigurationViews(instance_, system_, kStereo, 2, &count,
                                                     views.data());
        }),
        "xrEnumerateViewConfigurationViews");
  int width = int(views[0].recommendedImageRectWidth);
  int height = int(views[0].recommendedImageRectHeight);
  if (const int most = shared_.options.most_pixels; most > 0 && std::max(width, height) > most) {
    const double by = double(most) / std::max(width, height);
    width = std::max(1, int(width * by));
    height = std::max(1, int(height * by));
  }
  state_.width = width;
  state_.height = height;
}

XrGraphicsBindingOpenGLXlibKHR OpenXrSession::binding() {
  auto to = typed<XrGraphicsBindingOpenGLXlibKHR>(XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR);
  to.xDisplay = ::glXGetCurrentDisplay();
  to.glxContext = ::glXGetCurrentContext();
  to.glxDrawable = ::glXGetCurrentDrawable();
  if (!to.xDisplay || !to.glxContext) return to;
  int id = 0, screen = 0, visual = 0, count = 0;
  ::glXQueryContext(to.xDisplay, to.glxContext, GLX_FBCONFIG_ID, &id);
  ::glXQueryContext(to.xDisplay, to.glxContext, GLX_SCREEN, &screen);
  const int wanted[] = {GLX_FBCONFIG_ID, id, 0};
  if (GLXFBConfig* found = ::glXChooseFBConfig(to.xDisplay, screen, wanted, &count)) {
    if (count > 0) to.glxFBConfig = found[0];
    ::XFree(found);
  }
  if (to.glxFBConfig) {
    ::glXGetFBConfigAttrib(to.xDisplay, to.glxFBConfig, GLX_VISUAL_ID, &visual);
  }
  to.visualid = std::uint32_t(visual);
  return to;
}

void OpenXrSession::createSession() {
  auto needs = typed<XrGraphicsRequirementsOpenGLKHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
  check(call([&] { return xr_.getOpenGlGraphicsRequirements(instance_, system_, &needs); }),
        "xrGetOpenGLGraphicsRequirementsKHR");
  const XrGraphicsBindingOpenGLXlibKHR graphics = binding();
  if (!graphics.glxFBConfig) {
    end(Error{code::kNoGlx, tr("The graphics driver tells nothing of its windows"),
              "glXChooseFBConfig", tr("Update the graphics driver")},
        false);
  }
  const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system_};
  check(call([&] { return xr_.createSession(instance_, &info, &session_); }), "xrCreateSession");
  // Of the room where the headset knows one, else of where it was put on.
  XrReferenceSpaceCreateInfo space{XR_TYPE_REFERENCE_SPACE_CREATE_INFO,
                                   nullptr,
                                   XR_REFERENCE_SPACE_TYPE_STAGE,
                                   {{0.0F, 0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 0.0F}}};
  XrResult made = call([&] { return xr_.createReferenceSpace(session_, &space, &room_); });
  state_.keeps_room = XR_SUCCEEDED(made);
  if (made == XR_ERROR_REFERENCE_SPACE_UNSUPPORTED) {
    space.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
    made = call([&] { return xr_.createReferenceSpace(session_, &space, &room_); });
  }
  check(made, "xrCreateReferenceSpace");
  std::uint32_t count = 0;
  check(call([&] { return xr_.enumerateSwapchainFormats(session_, 0, &count, nullptr); }),
        "xrEnumerateSwapchainFormats");
  std::vector<std::int64_t> formats(count);
  check(
      call([&] { return xr_.enumerateSwapchainFormats(session_, count, &count, formats.data()); }),
      "xrEnumerateSwapchainFormats");
  for (const std::int64_t usable : {kRgba8, kSrgb8}) {
    if (std::ranges::find(formats, usable) != formats.end()) format_ = usable;
  }
  if (format_ == 0) {
    end(Error{code::kHeadsetFailed, tr("The headset's software takes no 8-bit pictures"), "",
              tr("Update the headset's software")},
        false);
  }
  for (Chain& each : eyes_) each = createChain(state_.width, state_.height);
  screen_ = createChain(kScreenWidth, kScreenHeight);
  gl_.glGenFramebuffers(2, framebuffers_);
}

OpenXrSession::Chain OpenXrSession::createChain(int width, int height) {
  Chain chain;
  chain.width = width;
  chain.height = height;
  auto info = typed<XrSwapchainCreateInfo>(XR_TYPE_SWAPCHAIN_CREATE_INFO);
  info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
  info.format = format_;
  info.sampleCount = info.faceCount = info.arraySize = info.mipCount = 1;
  info.width = std::uint32_t(width);
  info.height = std::uint32_t(height);
  check(call([&] { return xr_.createSwapchain(session_, &info, &chain.handle); }),
        "xrCreateSwapchain");
  made_chains_.push_back(chain.handle);
  std::uint32_t count = 0;
  check(call([&] { return xr_.enumerateSwapchainImages(chain.handle, 0, &count, nullptr); }),
        "xrEnumerateSwapchainImages");
  chain.images.assign(count, {XR_TYPE_SWAPCHAIN_IMAGE_OPENGL_KHR, nullptr, 0});
  check(call([&] {
          return xr_.enumerateSwapchainImages(
              chain.handle, count, &count,
              reinterpret_cast<XrSwapchainImageBaseHeader*>(chain.images.data()));
        }),
        "xrEnumerateSwapchainImages");
  return chain;
}

void OpenXrSession::changeState(XrSessionState state) {
  switch (state) {
    case XR_SESSION_STATE_READY: {
      const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, kStereo};
      check(call([&] { return xr_.beginSession(session_, &info); }), "xrBeginSession");
      running_ = true;
      break;
    }
    case XR_SESSION_STATE_STOPPING:
      check(call([&] { return xr_.endSession(session_); }), "xrEndSession");
      running_ = false;
      ended_ = asked_to_end_;
      break;
    case XR_SESSION_STATE_EXITING:
      if (asked_to_end_) {
        ended_ = true;
        break;
      }
      end(Error{code::kHeadsetEnded, tr("The headset's software has ended the picture"), "",
                tr("The exercise goes on in the window; put the headset on again when you like")},
          true);
    case XR_SESSION_STATE_LOSS_PENDING:
      check(XR_SESSION_LOSS_PENDING, "a loss that is announced");
      break;
    default:
      break;
  }
  state_.seen = state == XR_SESSION_STATE_VISIBLE || state == XR_SESSION_STATE_FOCUSED;
}

bool OpenXrSession::pollEvents() {
  while (!ended_) {
    auto event = typed<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    const XrResult result = call([&] { return xr_.pollEvent(instance_, &event); });
    if (result == XR_EVENT_UNAVAILABLE) break;
    check(result, "xrPollEvent");
    if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) {
      check(XR_ERROR_INSTANCE_LOST, "a loss that is announced");
    }
    if (event.type == XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) {
      const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(event);
      const XrReferenceSpaceType ours =
          state_.keeps_room ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL;
      if (change.referenceSpaceType == ours) room_changes_at_ = change.changeTime;
    }
    if (event.type != XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) continue;
    changeState(reinterpret_cast<const XrEventDataSessionStateChanged&>(event).state);
  }
  return !ended_;
}

void OpenXrSession::run() {
  while (true) {
    if (shared_.stop && !asked_to_end_) {
      asked_to_end_ = true;
      if (!running_) return;
      end_by_ = std::chrono::steady_clock::now() + kExitPatience;
      check(call([&] { return xr_.requestExitSession(session_); }), "xrRequestExitSession");
    }
    if (asked_to_end_ && std::chrono::steady_clock::now() > end_by_) return;
    const bool seen = state_.seen;
    if (!pollEvents()) return;
    if (seen != state_.seen) {
      shared_.tell(state_);
      shared_.wake();
    }
    if (running_) {
      frame();
    } else {
      std::this_thread::sleep_for(10ms);
    }
  }
}

bool OpenXrSession::locate(XrTime at) {
  const XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO, nullptr, kStereo, at, room_};
  auto of = typed<XrViewState>(XR_TYPE_VIEW_STATE);
  XrView views[2] = {typed<XrView>(XR_TYPE_VIEW), typed<XrView>(XR_TYPE_VIEW)};
  std::uint32_t count = 0;
  check(call([&] { return xr_.locateViews(session_, &info, &of, 2, &count, views); }),
        "xrLocateViews");
  constexpr XrViewStateFlags kBoth =
      XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;
  if ((of.viewStateFlags & kBoth) != kBoth) return false;
  for (std::size_t eye = 0; eye < 2; ++eye) now_m_[eye] = viewOf(views[eye]);
  if (room_changes_at_ && at >= *room_changes_at_) {  // these are the first of the new room
    room_changes_at_.reset();
    ++state_.room_changes;
  }
  state_.eyes_m = now_m_;
  state_.located = true;
  return true;
}

void OpenXrSession::draw(const SharedPicture& picture, std::size_t texture, Chain& into) {
  std::uint32_t index = 0;
  check(call([&] { return xr_.acquireSwapchainImage(into.handle, nullptr, &index); }),
        "xrAcquireSwapchainImage");
  const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr,
                                      kImagePatience_ns};
  const XrResult waited = call([&] { return xr_.waitSwapchainImage(into.handle, &wait); });
  check(waited == XR_TIMEOUT_EXPIRED ? XR_ERROR_RUNTIME_FAILURE : waited, "xrWaitSwapchainImage");
  gl_.glDisable(kFramebufferSrgb);
  gl_.glDisable(GL_SCISSOR_TEST);
  gl_.glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_[0]);
  gl_.glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                             picture.textures[texture], 0);
  gl_.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_[1]);
  gl_.glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                             into.images[index].image, 0);
  gl_.glBlitFramebuffer(0, 0, picture.width, picture.height, 0, 0, into.width, into.height,
                        GL_COLOR_BUFFER_BIT, GL_LINEAR);
  check(call([&] { return xr_.releaseSwapchainImage(into.handle, nullptr); }),
        "xrReleaseSwapchainImage");
}

void OpenXrSession::release(SharedPicture*& held) {
  if (held) shared_.pictures.giveBack(*held);
  held = nullptr;
}

// Into the chains; from then on it is what is shown.
void OpenXrSession::blitFresh(SharedPicture& picture, Shows kind) {
  SharedPicture*& shown = kind == Shows::eyes ? pair_ : panel_;
  release(shown);
  shown = &picture;
  gl_.glWaitSync(static_cast<GLsync>(picture.drawn), 0, GL_TIMEOUT_IGNORED);
  gl_.glDeleteSync(static_cast<GLsync>(picture.drawn));
  picture.drawn = nullptr;
  if (kind == Shows::eyes) {
    for (std::size_t eye = 0; eye < 2; ++eye) draw(picture, eye, eyes_[eye]);
  } else {
    draw(picture, 0, screen_);
  }
  picture.read = gl_.glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl_.glFlush();
}

// Upright before the head, and then it stays there.
void OpenXrSession::placeScreen() {
  const Head head_m = headOf(now_m_);
  const Vec3 ahead = levelAhead(head_m);
  screen_pose_m_ = {head_m.position + shared_.options.screen_m * ahead,
                    glm::angleAxis(std::atan2(-ahead.x, -ahead.z), Vec3(0.0, 1.0, 0.0))};
}

void OpenXrSession::showEyes() {
  const std::uint64_t number = ++number_;
  shared_.pictures.ask(
      {number, PictureRequest::Of::eyes, now_m_, state_.width, state_.height, monotonic_ns()});
  shared_.wake();
  const auto patience = std::chrono::milliseconds(shared_.options.patience_ms);
  SharedPicture* fresh = shared_.pictures.take(PictureRequest::Of::eyes, number, patience);
  if (fresh) {
    blitFresh(*fresh, Shows::eyes);
    pair_shown_ = fresh->request;
    dropPanel();
    repeats_ = 0;
    ++state_.fresh;
    shows_ = Shows::eyes;
  } else if (shows_ == Shows::eyes) {
    ++repeats_;
    repeats_ > 1 ? ++state_.held : ++state_.repeated;
  }
  pace_.frame(1e-9 * double(monotonic_ns()), fresh != nullptr);
}

// Of a picture that is not shown after all.
void OpenXrSession::discard(SharedPicture& picture) {
  gl_.glDeleteSync(static_cast<GLsync>(picture.drawn));
  picture.drawn = nullptr;
  shared_.pictures.giveBack(picture);
}

// What was the flat screen's would keep pairs from being drawn.
void OpenXrSession::dropPanel() {
  release(panel_);
  while (SharedPicture* left = shared_.pictures.take(PictureRequest::Of::panel, 0, 0us)) {
    discard(*left);
  }
}

void OpenXrSession::showFlat() {
  if (shows_ == Shows::eyes) {  // until there is a picture of the panel
    ++repeats_;
    ++state_.held;
  }
  const double now_s = 1e-9 * double(monotonic_ns());
  const bool tries = now_s - last_try_s_ > kTryEvery_s;
  if (tries || now_s - last_panel_s_ > kPanelEvery_s) {
    const auto kind = tries ? PictureRequest::Of::eyes : PictureRequest::Of::panel;
    (tries ? last_try_s_ : last_panel_s_) = now_s;
    shared_.pictures.ask({++number_, kind, now_m_, state_.width, state_.height, monotonic_ns()});
    shared_.wake();
  }
  if (SharedPicture* tried = shared_.pictures.take(PictureRequest::Of::eyes, 0, 0us)) {
    pace_.tried(1e-9 * double(tried->finished_ns - tried->request.asked_ns));
    discard(*tried);
  }
  SharedPicture* fresh = shared_.pictures.take(PictureRequest::Of::panel, 0, 0us);
  if (!fresh) return;
  blitFresh(*fresh, Shows::flat);
  if (shows_ != Shows::flat) placeScreen();
  screen_height_m_ = shared_.options.screen_width_m * fresh->height / std::max(1, fresh->width);
  shows_ = Shows::flat;
  release(pair_);
}

void OpenXrSession::addShown(OpenXrLayers& layers) {
  const auto whole = [](const Chain& chain) {
    return XrSwapchainSubImage{chain.handle, {{0, 0}, {chain.width, chain.height}}, 0};
  };
  if (shows_ == Shows::flat) {
    return layers.addScreen(screen_pose_m_, shared_.options.screen_width_m, screen_height_m_,
                            whole(screen_));
  }
  if (shows_ != Shows::eyes) return;
  state_.pose_age_ms = 1e-6 * double(monotonic_ns() - pair_shown_.asked_ns);
  state_.most_pose_age_ms = std::max(state_.most_pose_age_ms, state_.pose_age_ms);
  const OpenXrLayers::Images images{whole(eyes_[0]), whole(eyes_[1])};
  // What they were drawn for and not where the eyes are now: the runtime moves the pictures.
  repeats_ > 1 ? layers.addStanding(pair_shown_.eyes_m, shared_.options.screen_m, images)
               : layers.addPair(pair_shown_.eyes_m, images);
}

void OpenXrSession::frame() {
  auto of = typed<XrFrameState>(XR_TYPE_FRAME_STATE);
  check(call([&] { return xr_.waitFrame(session_, nullptr, &of); }), "xrWaitFrame");
  check(call([&] { return xr_.beginFrame(session_, nullptr); }), "xrBeginFrame");
  const bool draws = of.shouldRender && !asked_to_end_ && locate(of.predictedDisplayTime);
  if (!draws) pace_.pause();
  if (draws) {
    const bool flat = pace_.tooSlow();
    flat ? showFlat() : showEyes();
  }
  OpenXrLayers layers(room_);
  if (draws) addShown(layers);
  const XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO,  nullptr,
                            of.predictedDisplayTime, XR_ENVIRONMENT_BLEND_MODE_OPAQUE,
                            layers.count(),          layers.all()};
  check(call([&] { return xr_.endFrame(session_, &info); }), "xrEndFrame");
  state_.flat = shows_ == Shows::flat;
  state_.pairs_hz = pace_.pairs_hz();
  shared_.tell(state_);
}

// Whatever they answer: after a loss all of these are still allowed, and needed.
void OpenXrSession::cleanUp() {
  gl_.glFinish();
  release(pair_);
  release(panel_);
  if (framebuffers_[0]) gl_.glDeleteFramebuffers(2, framebuffers_);
  for (XrSwapchain chain : made_chains_) call([&] { return xr_.destroySwapchain(chain); });
  if (room_) call([&] { return xr_.destroySpace(room_); });
  if (session_) call([&] { return xr_.destroySession(session_); });
  if (instance_) call([&] { return xr_.destroyInstance(instance_); });
}

}  // namespace

HeadsetEnd runOpenXr(HeadsetShared& shared, QOpenGLExtraFunctions& gl) {
  try {
    OpenXrSession session(shared, gl);
    session.open();
    session.run();
    return {};
  } catch (const Over& over) {
    return over.how;
  }
}

}  // namespace trephine
