/* The smallest arm that keeps to trephine_device.h: one tip on a spring of 100 N/m, without mass, so
 * that it stands where the force puts it. Begin a device of your own with a copy. */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "trephine_device.h"

struct TrephineDevice {
  int configured, running;
  double force_N[3];
  uint64_t sequence;
  atomic_uint stops; /* calls of safe_stop, from any thread */
  unsigned answered; /* how many of them the host has answered with zero */
  const char* error;
};

static const char* open_error = "";

static int fail(TrephineDevice* device, int code, const char* sentence) {
  device->error = sentence;
  return code;
}

static uint32_t enumerate(TrephineArmInfo* infos, uint32_t capacity) {
  if (infos && capacity > 0 && infos->size >= sizeof *infos) {
    strcpy(infos->bus_path, "example-0");
    strcpy(infos->serial, "1");
    strcpy(infos->model, "Example arm");
  }
  return 1;
}
static int open_arms(const uint32_t* arms, uint32_t n_arms, TrephineDevice** device) {
  *device = NULL;
  open_error = "The example has one arm, number 0.";
  if (!arms || n_arms != 1 || arms[0] != 0) return TREPHINE_ERROR_NO_DEVICE;
  *device = calloc(1, sizeof **device);
  if (!*device) return TREPHINE_ERROR_DEVICE;
  (*device)->error = "";
  return TREPHINE_OK;
}
static int configure(TrephineDevice* device, const char* json) {
  if (device->running) return fail(device, TREPHINE_ERROR_STATE, "It runs: stop it first.");
  if (!json || !strstr(json, "trephine.device")) /* a real plugin reads it with a JSON library */
    return fail(device, TREPHINE_ERROR_ARGUMENT, "The text is no configuration of a device.");
  device->configured = 1;
  return TREPHINE_OK;
}
static int capabilities(TrephineDevice* device, uint32_t arm, TrephineCapabilities* able) {
  if (arm != 0 || !able || able->size < sizeof *able)
    return fail(device, TREPHINE_ERROR_ARGUMENT, "There is no such arm, or no room for it.");
  able->input_dof = 3;
  for (int axis = 0; axis < 3; ++axis) able->workspace_m[axis] = 0.1;
  able->peak_force_N = able->continuous_force_N = 3.0;
  able->thermal_s = 0.0; /* it looks after itself */
  able->apparent_mass_kg = 0.05;
  able->encoder_step_m = 0.0;
  able->rate_hz = 1000.0;
  able->latency_s = 0.0;
  able->friction_N = 0.0;
  return TREPHINE_OK;
}
static int calibrate(TrephineDevice* device, uint32_t arm) {
  return arm == 0 ? TREPHINE_OK : fail(device, TREPHINE_ERROR_ARGUMENT, "There is no such arm.");
}
static int start(TrephineDevice* device) {
  if (!device->configured || device->running)
    return fail(device, TREPHINE_ERROR_STATE, "It runs already, or has no configuration.");
  memset(device->force_N, 0, sizeof device->force_N);
  device->answered = atomic_load(&device->stops);
  device->running = 1;
  return TREPHINE_OK;
}
static int read_states(TrephineDevice* device, double dt_s, TrephineArmState* state) {
  if (!device || !state || state->size < sizeof *state || !(dt_s > 0)) return TREPHINE_ERROR_ARGUMENT;
  if (!device->running) return fail(device, TREPHINE_ERROR_STATE, "It does not run: start it.");
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  state->sequence = ++device->sequence;
  state->time_ns = (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
  const int stopped = atomic_load(&device->stops) != device->answered;
  for (int axis = 0; axis < 3; ++axis)
    state->position_m[axis] = stopped ? 0.0 : device->force_N[axis] / 100.0;
  state->orientation[0] = 1.0;
  state->orientation[1] = state->orientation[2] = state->orientation[3] = 0.0;
  state->buttons = 0;
  state->flags = TREPHINE_ARM_CALIBRATED;
  return TREPHINE_OK;
}
static int write_forces(TrephineDevice* device, const TrephineArmCommand* command) {
  if (!device || !command || command->size < sizeof *command) return TREPHINE_ERROR_ARGUMENT;
  if (!device->running) return fail(device, TREPHINE_ERROR_STATE, "It does not run: start it.");
  const unsigned stops = atomic_load(&device->stops); /* those that this write can answer */
  const double* f = command->force_N;
  const int finite = isfinite(f[0]) && isfinite(f[1]) && isfinite(f[2]);
  for (int axis = 0; axis < 3; ++axis) device->force_N[axis] = finite ? f[axis] : 0.0;
  if (!finite) return fail(device, TREPHINE_ERROR_ARGUMENT, "A force was no number: there is none.");
  if (f[0] == 0 && f[1] == 0 && f[2] == 0) device->answered = stops;
  return TREPHINE_OK;
}
static int stop(TrephineDevice* device) { return device->running = 0, TREPHINE_OK; }
static void safe_stop(TrephineDevice* device) { if (device) atomic_fetch_add(&device->stops, 1); }
static const char* last_error(TrephineDevice* device) { return device ? device->error : open_error; }
static void close_arms(TrephineDevice* device) { free(device); }

static const TrephineDeviceApi api = {
    sizeof api, TREPHINE_DEVICE_ABI, "example", enumerate, open_arms, configure, capabilities,
    calibrate, start, read_states, write_forces, NULL /* wait */, NULL /* set_target */, stop,
    safe_stop, last_error, close_arms};

__attribute__((visibility("default"))) const TrephineDeviceApi* trephine_device_plugin(uint32_t abi) {
  return abi == TREPHINE_DEVICE_ABI ? &api : NULL;
}
