/* The interface between Trephine and a device plugin. Plain C; a plugin includes this header alone.
 *
 * A plugin is a shared library that exports one symbol, TREPHINE_DEVICE_ENTRY. The host calls it
 * with the ABI version it speaks and gets a table of functions, or NULL where the plugin cannot
 * serve that version. Every struct starts with its size in bytes and a version, set by whoever
 * allocates it (the host for infos, capabilities, states and commands, before each call; the plugin
 * for its table), so that fields can be appended later: the other side ignores what lies beyond the
 * size that it knows, refuses less, and steps through an array by the size in its first element.
 *
 * Units: metres, seconds, newtons, kilograms, radians; times in monotonic nanoseconds. Frame: +x
 * right, +y up, +z towards the user, origin at the centre of the workspace (see FRAMES.md).
 * Orientation is a unit quaternion (w, x, y, z) from the tool's frame into the device frame.
 * Forces are those that push the hand.
 *
 * Threads: `read`, `write`, `wait` and `set_target` are called on the haptic thread: none but
 * `wait` blocks, and none allocates, logs or throws. `safe_stop` comes from any thread at any time.
 * Everything else is called on one other thread while none of those four runs. A tick reads,
 * computes, writes at once, and then waits for the next.
 * Functions return TREPHINE_OK or a TREPHINE_ERROR_*; `last_error` then has one sentence, which
 * stays until the next call.
 *
 * Torques are not sent: nothing in the host keeps one passive. A plugin states what the host can
 * act on and no more; what an arm's maker says of its stiffness and damping is not asked, since the
 * host computes its own bound from mass, encoder, rate and latency.
 */
#ifndef TREPHINE_DEVICE_H
#define TREPHINE_DEVICE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TREPHINE_DEVICE_ABI 3u
#define TREPHINE_DEVICE_ENTRY "trephine_device_plugin"

enum {
  TREPHINE_OK = 0,
  TREPHINE_ERROR_ARGUMENT = 1,  /* wrong index, wrong struct size, bad configuration text */
  TREPHINE_ERROR_NO_DEVICE = 2, /* nothing there, or it went away */
  TREPHINE_ERROR_STATE = 3,     /* not allowed now: reading before start, and the like */
  TREPHINE_ERROR_DEVICE = 4,    /* the device reports a fault */
  TREPHINE_ERROR_TIMEOUT = 5    /* of `wait` alone: no sample came */
};

/* Flags of an arm's state. What the host does of them is in brackets. */
enum {
  TREPHINE_ARM_CALIBRATED = 1u << 0, /* it knows where it is [shown] */
  TREPHINE_ARM_WARM = 1u << 1,     /* motors near their thermal limit [half the force, over 2 s] */
  TREPHINE_ARM_NO_HAND = 1u << 2,  /* it rests in its holder, or nobody holds it [no force while
                                      that is so; an arm that cannot tell is taken to be held once
                                      it was moved or a button was pressed] */
  TREPHINE_ARM_LOST = 1u << 3,     /* it is gone, or its pose is old [no force until asked for] */
  TREPHINE_ARM_AT_LIMIT = 1u << 4, /* at the edge of its workspace [shown] */
  TREPHINE_ARM_ERROR = 1u << 6 /* an error that passes [no force until 1 s without; the third in 10
                                  s: none until asked for] */
};

typedef struct TrephineArmInfo {
  uint32_t size, version;
  char bus_path[128]; /* tells two equal arms apart, e.g. a USB port path */
  char serial[64];
  char model[64];
} TrephineArmInfo;

typedef struct TrephineCapabilities {
  uint32_t size, version;
  /* 6; 3 where it does not say how it is turned; or 0 for a pedal, which has buttons alone: the
   * fields below but rate_hz are not looked at, and what it is sent it drops. */
  uint32_t input_dof;
  double workspace_m[3]; /* full extent of x, y, z around the origin */
  double peak_force_N;
  /* What it can be sent for good, and the time constant [s] with which its motors warm: the host
   * lets the force fall to the former as they do. 0 s: the arm looks after itself, or nothing is
   * known of it. */
  double continuous_force_N, thermal_s;
  double apparent_mass_kg;
  double encoder_step_m;
  double rate_hz; /* of its samples: highest where the host paces it, the one it has with `wait` */
  double latency_s; /* from a sample to the force at the arm that answers it, p99, as measured */
  double friction_N; /* what it takes to move it by hand, dry; 0: nothing is known of it */
} TrephineCapabilities;

typedef struct TrephineArmState {
  uint32_t size, version;
  uint64_t sequence; /* counts samples; equal to the last one where none came: for 15 ms, lost */
  int64_t time_ns;   /* when the sample was taken: CLOCK_MONOTONIC, or simulated time */
  double position_m[3];
  double orientation[4]; /* w, x, y, z */
  uint32_t buttons;      /* bit 0 the first */
  uint32_t flags;
} TrephineArmState;

typedef struct TrephineArmCommand {
  uint32_t size, version;
  double force_N[3];
} TrephineArmCommand;

typedef struct TrephineDevice TrephineDevice; /* one opened plugin instance with all its arms */

typedef struct TrephineDeviceApi {
  uint32_t size, version;
  const char* name;

  /* Arms present now. Writes at most `capacity` infos and returns how many there are. Where none
   * can be (a library that is not installed), last_error(NULL) then has the sentence, else "". */
  uint32_t (*enumerate)(TrephineArmInfo* infos, uint32_t capacity);
  /* Opens `n_arms` arms by their place in the enumeration. `*device` is NULL on failure; then
   * last_error(NULL) has the sentence. */
  int (*open)(const uint32_t* arms, uint32_t n_arms, TrephineDevice** device);
  /* JSON text, as its file has it; before start. */
  int (*configure)(TrephineDevice* device, const char* json);
  int (*capabilities)(TrephineDevice* device, uint32_t arm, TrephineCapabilities* capabilities);
  int (*calibrate)(TrephineDevice* device, uint32_t arm);
  int (*start)(TrephineDevice* device);
  /* Every arm's newest sample. Simulated arms first move on by dt_s under the force that was
   * written last, none since start; others take no notice of dt_s. */
  int (*read)(TrephineDevice* device, double dt_s, TrephineArmState* states);
  /* Gives every arm its force, at once: it holds until the next, or until the plugin has heard
   * nothing for 50 ms or more and lets it go. A force that is not finite: that
   * arm gets none, and the answer is TREPHINE_ERROR_ARGUMENT. */
  int (*write)(TrephineDevice* device, const TrephineArmCommand* commands);
  /* NULL for arms that the host paces. Else returns when there is a sample that `read` has not
   * given yet, at once if there is one, or TREPHINE_ERROR_TIMEOUT after timeout_s: the arms' own
   * samples then are the host's clock, at their rate_hz. Of several arms, the first one's. */
  int (*wait)(TrephineDevice* device, double timeout_s);
  /* Simulated arms only, NULL elsewhere: the rest pose of the hand that holds the arm, and the
   * stiffness [N/m] and damping [N s/m] with which it holds. */
  int (*set_target)(TrephineDevice* device, uint32_t arm, const double position_m[3],
                    const double orientation[4], double hand_k, double hand_b);
  int (*stop)(TrephineDevice* device);
  /* Zero force at once, from any thread, in any state, also while another call runs or blocks. It
   * holds until the next start, or until a write that began after it has commanded zero force for
   * every arm: so the host says that it knows, and later writes move the arms again. */
  void (*safe_stop)(TrephineDevice* device);
  const char* (*last_error)(TrephineDevice* device);
  void (*close)(TrephineDevice* device);
} TrephineDeviceApi;

typedef const TrephineDeviceApi* (*TrephineDeviceEntry)(uint32_t host_abi);

#ifdef __cplusplus
}
#endif

#endif
