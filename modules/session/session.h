// A running exercise: the one place where volume, arms, loop, recorder and operator meet.
//
// One owner thread (the window's, or a program's main). A session runs once: in real time on its
// own threads from start() to stop(); or on the owner's thread, as fast as its ticks are computed,
// from startStepped() over advance() to stop(). freewheel() is the latter in one call.
//
// Force goes first: stop() takes it away before it waits for anything, and a watchdog takes it away
// when the ticks stand still for 20 ms. A haptic thread that a call of a device holds is left
// behind with the loop and the device, which it then owns; the voxels stay here.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "base/rt/abandonable_thread.h"
#include "case/placement.h"
#include "exercise/exercise.h"
#include "haptics/haptic_loop.h"
#include "session/live_operator.h"
#include "session/operator_script.h"
#include "session/poke_curves.h"
#include "session/run_report.h"
#include "training/record_sink.h"
#include "training/run_metrics.h"
#include "training/session_recorder.h"
#include "training/session_view.h"
#include "volume/grid.h"
#include "volume/journal_file.h"

namespace trephine {

struct SessionOptions {
  std::filesystem::path recording;       // empty: not recorded
  std::optional<OperatorScript> script;  // empty: the hands rest until the window moves them
  // Without a script: the hands of simulated arms begin outside of tissue (hand_start.h), and a
  // reset takes them back there.
  bool hands_outside = false;
  // Nothing is cut, whatever the tissues say, and pokes() tells what was felt.
  bool poke = false;
  LoopProbe* probe = nullptr;  // looks on; it outlives the session
  // Take what the session does, after its own; they outlive it and throw
  // nothing. Called by the recorder's thread, and by the owner's where the session has none.
  std::vector<RecordSink*> sinks{};
  Rig rig{};  // what moves the arms; those that it lacks are simulated
};

class Session : public SessionView {
 public:
  // Takes a copy of the voxels of the case, opens the devices, starts the recording. Errors of all
  // of these, the placement's, OUT_OF_MEMORY; nothing is left behind on one. Any thread.
  static Result<std::unique_ptr<Session>> create(const Placement& placed,
                                                 const SessionOptions& options);
  ~Session() override;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Maps fixed, forces within the arms' limits.
  const Exercise& exercise() const override { return exercise_; }
  const Rig& rig() const { return rig_; }        // with the dynamics of its devices
  const std::vector<PlacedLandmark>& landmarks() const { return landmarks_; }
  Grid& grid() override { return *grid_; }
  // What was cut, also when the session is gone.
  std::shared_ptr<const Grid> carved() const { return grid_; }
  const TrephineCapabilities& capabilities(std::size_t arm) const { return capabilities_[arm]; }

  // Real time, until stop() or `seconds`.
  Status start(double seconds = 1e9);
  // Without threads: time is what advance() makes of it, until stop() or `seconds`. The hands, the
  // recording and all commands are as in real time; nothing is late.
  Status startStepped(double seconds = 1e9);
  // The ticks of the next `seconds`, and what they recorded; nothing once finished() or stopped, in
  // real time, or where `seconds` is not above 0. Owner thread.
  void advance(double seconds);
  bool running() const { return running_; }
  // True once the ticks asked for are done.
  bool finished() const;
  // Zeroes the forces, ends the threads, ends the recording; the threads within 0.5 s, whatever a
  // device does. The Status is the recording's.
  Status stop();
  // After stop(), where a device did not answer and was left behind: DEVICE_STUCK.
  const std::optional<Error>& leftBehind() const { return left_behind_; }
  // A device that has not returned for so long does not: a run without a person is stopped.
  static constexpr double kGivenUp_s = 2.0;
  // How long the ticks have stood still, from 20 ms on; else 0.
  double standsStillFor_s() const;
  // Whether voxels, the loop's state and its stack are held in memory. Known from the first tick in
  // real time on.
  std::optional<bool> memoryLocked() const;

  // As fast as it goes, on the calling thread; the recorder keeps up. Errors: CANCELLED, and the
  // recording's.
  Status freewheel(double seconds, const Progress& progress = Progress());

  // Live input. Commands are answered within a tick or two; false when 64 of them are waiting.
  // From a pause to a resume the hands of simulated arms rest where their arms are: a hand that
  // was pressing would sink into tissue that no longer pushes back. Then it presses as before.
  bool send(CommandKind kind);
  // So many ticks later a command has been taken up, unless the state is `busy`: its own takes a
  // tick or two, and the others are for a few that were sent before it, of which each takes one.
  static constexpr std::uint64_t kAnswerTicks = 20;
  // From the answer true to thaw() no voxel changes, so that the grid can be read: waits for what
  // was asked for before, pauses, refuses what would bring tissue back or go on, and keeps a
  // script's commands for later. To be asked again until it is true.
  bool freeze();
  void thaw();  // goes on, unless it was paused before
  // Tissue, counts and law states as they were in that second of the session.
  bool rewind(std::uint32_t second);
  bool setController(ControllerKind kind);
  // Errors: those of validate() and checkLabels().
  Status setTissues(const TissueSet& tissues);
  // Moves the rest position of a simulated arm's hand, in patient mm, within the arm's workspace.
  // Nothing in a pause.
  void moveHand(std::size_t arm, const Vec3& by_mm);
  Vec3 handTarget_mm(std::size_t arm) const;

  // ---- A hand of a simulated arm that goes where a pointer is (pointer_hand.h). Owner thread.
  // From the first sample on, and until moveHand(). Times are now_ns()'s and do not fall; in a
  // stepped session a sample may wait for its time. False for a real arm, a ray that is none, and
  // while 2048 samples wait.
  bool point(std::size_t arm, const PointerSample& sample);
  // The session's time: the steady clock while it runs in real time, else 0 at its first tick.
  std::int64_t now_ns() const;
  // How hard it presses along the tool from then on, in newtons at the arm: 0, hovering, to
  // mostPush_N. An undo, redo, rewind or reset makes it 0.
  bool setPush(std::size_t arm, double push_N, std::int64_t time_ns = kNow);
  double handPush_N(std::size_t arm) const { return push_N_[arm]; }
  double mostPush_N(std::size_t arm) const;
  // Puts the tool down: it rests where it is, in tissue too, without force. It comes out only where
  // its arm waits for that.
  bool releaseHand(std::size_t arm, std::int64_t time_ns = kNow);
  // Turns the tool about its tip, by a patient axis, within a tenth of a second; at most
  // kMostTurn_rad from how the exercise holds it.
  void turnHand(std::size_t arm, const Vec3& axis, double by_rad);
  void straightenHand(std::size_t arm);
  static constexpr double kMostTurn_rad = 1.2;
  static constexpr std::int64_t kNow = -1;  // now_ns()

  // Clutches an arm: its force fades within 20 ms, its tool stays where it is and the arm moves
  // freely. Off again, the arm moves the tool from where both are, by `rotation`, device axes to
  // patient axes, so that a hand's motion follows a view; the force comes back as after a pause. A
  // tool that this turns in tissue waits until it is out. False when 64 commands are waiting.
  bool clutch(std::size_t arm, bool on, const Quat& rotation);
  bool clutch(std::size_t arm, bool on);  // keeps the rotation
  // The arm's hand is one that is told where to go; a real one is where it is.
  bool isSimulated(std::size_t arm) const { return simulated_[arm]; }
  // Puts the tool where the exercise starts it, and turns the map back: with a real arm where it is
  // now; a simulated arm's hand goes back to where it began, upright. Where the tool comes into
  // tissue it waits.
  bool recentre(std::size_t arm);

  // Gives an arm another of its tools (Exercise::toolOf), once neither that nor the one in hand
  // touches tissue and the arm has no force; until then it waits (LoopState::wanted_tools), and the
  // number of the one in hand takes the wish back. Also in a pause. An undo or a rewind changes no
  // tool; a reset gives each arm the one that it began with. False for a tool that the arm does not
  // have, and when 64 commands are waiting.
  bool changeTool(std::size_t arm, std::size_t tool);

  // The newest state of the loop. Owner thread.
  LoopState state() override;
  // The strokes that began so far, as far as they are known: within 50 ms.
  std::vector<StrokeBegin> strokes() const;
  // Of a session for poking: its last pokes, as far as they are known: within 50 ms.
  std::vector<PokeCurve> pokes() const;
  bool isPoke() const { return poke_curves_ != nullptr; }
  // What became of the recording so far.
  Status recordingStatus() const;
  // How much of the session is not on disk yet; 0 where nothing is recorded any more. Owner thread.
  double recorderBehind_s();

  // After stop() or freewheel().
  RunReport report() const;

 private:
  struct Engine;

  Session() = default;
  Status set(const Placement& placed, const SessionOptions& options);
  void startThreads(double seconds);
  Status stopStepped();
  std::uint64_t drainTicks() const;
  bool push(CommandKind kind);
  void leaveBehind(std::size_t held, bool watchdog_ended);
  void holdHands(bool hold);
  WorkspaceMap map(std::size_t arm) const;  // as clutching left it
  void beginOutside();
  bool playPointer(std::size_t arm, std::int64_t time_ns, bool put_down);
  void stopPushing();
  void record();  // the recorder thread
  void drain();
  // Recorder thread; the owner where there is none, and after it.
  template <class Add>
  void tellSinks(Add add) {
    const std::lock_guard lock(sinks_mutex_);
    for (RecordSink* sink : sinks_) add(*sink);
  }
  void flush();
  // So much of the session may wait to be written. Counted in ticks, not on the recorder's clock: a
  // recorder that gets to run seldom must not put off what it then finds waiting.
  static constexpr double kFlushEvery_s = 0.25;
  Status finishRecording();
  void noteFailure(const Error& error);

  Exercise exercise_;
  Rig rig_;
  std::vector<PlacedLandmark> landmarks_;
  std::vector<TrephineCapabilities> capabilities_;
  std::string sha256_before_, sha256_after_;
  std::shared_ptr<const Volume> before_;        // the case's
  std::shared_ptr<const LabelMap> structures_;  // the case's; null: none
  CutVoxels cut_;                               // once it has ended
  std::vector<CutStructure> structures_cut_;    // once it has ended
  std::filesystem::path recording_file_;
  std::shared_ptr<Grid> grid_;
  std::unique_ptr<HapticCore> core_;
  LiveHands hands_;  // the owner's side of the engine's
  std::array<std::optional<Vec3>, kMaxArms> begin_m_{};  // where a hand begins, outside of tissue
  std::array<std::optional<PointerSample>, kMaxArms> pointer_{};  // the last of each arm
  std::array<double, kMaxArms> push_N_{};
  std::array<bool, kMaxArms> simulated_{};
  std::shared_ptr<Engine> engine_;
  HapticLoop* loop_ = nullptr;  // the engine's
  std::unique_ptr<SessionRecorder> recorder_;
  bool recording_ended_ = false;
  std::unique_ptr<JournalFile> journal_file_;
  std::vector<Warning> warnings_;  // of the case and the exercise
  std::chrono::steady_clock::time_point last_flush_ = std::chrono::steady_clock::now();
  std::uint64_t unflushed_ticks_ = 0, most_behind_ticks_ = 0;  // the recorder's
  std::atomic<std::uint64_t> flushed_ticks_{0};

  bool running_ = false;
  bool stepped_ = false;         // by advance()
  std::uint64_t last_tick_ = 0;  // of startStepped()
  // freeze(): first all that waits is let happen, then comes a pause of its own.
  enum class Freeze { none, settling, pausing } freeze_ = Freeze::none;
  bool paused_before_ = false;
  std::uint64_t unsettled_tick_ = 0;  // the last at which a command waited or a job ran
  std::atomic<bool> stop_recorder_{false};
  rt::AbandonableThread haptic_thread_, watchdog_thread_;
  std::thread recorder_thread_;
  std::optional<Error> left_behind_;
  // What is made of the records, each a sink of the recorder's thread; what the owner reads of them
  // meanwhile is behind the mutex.
  std::unique_ptr<RunMeter> meter_;
  std::unique_ptr<PokeCurves> poke_curves_;  // of a session for poking
  std::unique_ptr<RecordSink> warning_log_;  // of what the meter warns of
  std::vector<RecordSink*> sinks_;
  mutable std::mutex failure_mutex_;  // recorder and owner only, never the tick
  mutable std::mutex sinks_mutex_;    // so too
  std::optional<Error> failure_;
};

// "session.h5" in `folder`, or "session-2.h5" and so on where that is taken. Asks the disk, but
// never fails: a folder that cannot be looked into is for who then writes there to report.
std::filesystem::path freshFile(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension);

}  // namespace trephine
