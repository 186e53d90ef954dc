#include "session/session.h"

#include <algorithm>
#include <fstream>
#include <functional>

#include "base/file.h"
#include "cases.h"
#include "session_support.h"
#include "support.h"
#include "training/replay.h"
#include "volume/voxel_slabs.h"

namespace trephine {
namespace {

using test::cranium;
using test::scripted;
using test::smallHead;
using test::waitUntil;

// As it was while it ran, in the replay, and, but for what is removed, from the file alone.
void expectTheSameMetrics(const RunMetrics& live, const ReplayResult& replayed,
                          const SessionReader& file) {
  EXPECT_TRUE(replayed.metrics == live);
  const auto read = metricsOf(file);
  ASSERT_TRUE(read.ok()) << read.error().sentence();
  RunMetrics without = live;
  without.removed_mm3.clear();
  without.removed_unnamed_mm3 = 0.0;
  without.removed_voxels = 0;
  without.brought_back_mm3 = 0.0;
  for (RunMetrics::Arm& arm : without.arms) arm.removed_mm3 = 0.0;
  EXPECT_TRUE(*read == without);
}

TEST(Session, BothArmsCutBoneWithinTheForceLimitAndItReplaysIdentically) {
  test::TemporaryFolder folder;
  auto session = Session::create(test::placed(cranium(), smallHead()), scripted(folder / "s.h5"));
  ASSERT_TRUE(session.ok()) << session.error().sentence();
  ASSERT_TRUE((*session)->freewheel(10.0).ok());
  const RunReport report = (*session)->report();
  EXPECT_EQ(report.done.ticks, 10000u);
  ASSERT_EQ(report.done.arms.size(), 2u);
  for (const auto& arm : report.done.arms) {
    EXPECT_GT(arm.removed_mm3, 100.0) << arm.name;
    EXPECT_GT(arm.max_force_N, 1.0) << arm.name;
    EXPECT_LE(arm.max_force_N, 3.3) << arm.name;
  }
  EXPECT_EQ(report.done.removed_mm3.back().first, "bone");
  EXPECT_GT(report.done.removed_mm3.back().second, 200.0);
  EXPECT_EQ(report.machine.events_dropped, 0u);
  EXPECT_EQ(report.machine.nonfinite, 0u);
  EXPECT_NE(report.volume_sha256, report.volume_sha256_before);

  auto reader = SessionReader::open(folder / "s.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  const auto result = replay(**reader, smallHead());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
  EXPECT_EQ(result->volume_sha256, report.volume_sha256);
  EXPECT_EQ(report.done.strokes.size(), 2u) << "one of each hand";
  expectTheSameMetrics(report.done, *result, **reader);
}

TEST(Session, FreewheelsToTheSameVoxelsTwice) {
  std::string first;
  for (int i = 0; i < 2; ++i) {
    auto session = Session::create(test::placed(cranium(), smallHead()), scripted());
    ASSERT_TRUE((*session)->freewheel(5.0).ok());
    const std::string hash = (*session)->report().volume_sha256;
    if (i == 0) first = hash;
    EXPECT_EQ(hash, first);
  }
}

TEST(Session, RunsInRealTimeTakesLiveInputAndReplaysIdentically) {
  test::TemporaryFolder folder;
  auto made = Session::create(test::placed(cranium(), smallHead()), {folder / "s.h5", {}});
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  ASSERT_TRUE(session.start().ok());
  const Vec3 down_mm = glm::normalize(-session.landmarks()[0].frame.position_mm);
  TissueSet softer = session.exercise().tissues;
  softer.tissues[3].friction_N.value = 0.5;
  for (int i = 0; i < 60; ++i) {
    session.moveHand(1, 0.6 * down_mm);
    if (i == 40) {
      ASSERT_TRUE(session.setTissues(softer).ok());
    }
    if (i == 50) session.setController(ControllerKind::off);
    const std::uint64_t next = session.state().ticks + 15;
    ASSERT_TRUE(waitUntil([&] { return session.state().ticks >= next; }));
  }
  ASSERT_TRUE(waitUntil([&] {
    session.moveHand(1, 0.02 * down_mm);
    return session.state().can_undo;
  }));
  session.send(CommandKind::reset);
  EXPECT_TRUE(waitUntil([&] {
    session.moveHand(1, -1.0 * down_mm);
    return !session.state().can_undo && !session.state().busy;
  }));
  ASSERT_TRUE(session.stop().ok());
  const RunReport report = session.report();
  EXPECT_GT(report.done.arms[1].contact_ticks, 0u);
  EXPECT_GT(report.done.arms[1].max_force_N, 0.0);
  EXPECT_EQ(report.done.controllers, (std::vector<std::string>{"bounded", "off"}));
  EXPECT_NE(toText(report).find("controller 'bounded', later 'off'\n"), std::string::npos);

  const auto result = replay(**SessionReader::open(folder / "s.h5"), smallHead());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
  EXPECT_EQ(result->ticks, report.done.ticks);
}

// A freewheeling session of two arms that is spoken to every 256 ticks, as a window would.
void freewheelTalking(Session& session, double seconds, const std::function<void()>& talk) {
  const Progress progress([&](double, const std::string&) { talk(); });
  ASSERT_TRUE(session.freewheel(seconds, progress).ok());
}

TEST(Session, InAPauseAHandThatWasPressingDoesNotSinkInAndNothingMovesIt) {
  Exercise exercise = cranium();
  for (Tissue& tissue : exercise.tissues.tissues) {
    tissue.cuttable = false;
    tissue.friction_N.value = 3.0;
  }
  auto made = Session::create(test::placed(exercise, smallHead()), {});
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  const Vec3 down_mm = glm::normalize(-session.landmarks()[0].frame.position_mm);
  const auto deep_mm = [&] {
    return glm::dot(session.state().record.arms[1].patient_position_mm, down_mm);
  };
  double pressed_mm = 0.0, pause_mm = 0.0, deepest_mm = -1e9, after_mm = 0.0;
  int talks = 0;
  enum class Step { pressing, pausing, going_on, done } step = Step::pressing;
  freewheelTalking(session, 40.0, [&] {
    const LoopState& state = session.state();
    if (step == Step::pressing) {
      pressed_mm = glm::dot(session.handTarget_mm(1), down_mm) - deep_mm();
      if (state.record.arms[1].tissue_class < 0 || pressed_mm < 1.5) {
        return session.moveHand(1, 0.5 * down_mm);
      }
      pause_mm = deep_mm();
      EXPECT_TRUE(session.send(CommandKind::pause));
      step = Step::pausing;
    } else if (step == Step::pausing) {
      EXPECT_TRUE(state.paused);
      deepest_mm = std::max(deepest_mm, deep_mm());
      session.moveHand(1, 20.0 * down_mm);
      if (++talks < 8) return;
      EXPECT_TRUE(session.send(CommandKind::resume));
      step = Step::going_on;
    } else if (step == Step::going_on) {
      EXPECT_FALSE(state.paused);
      session.moveHand(1, -20.0 * down_mm);
      step = Step::done;
    }
    after_mm = deep_mm();
  });
  ASSERT_TRUE(step == Step::done) << "the tissue held the arm back by " << pressed_mm << " mm";
  EXPECT_LT(deepest_mm, pause_mm + 0.5);
  EXPECT_LT(after_mm, pause_mm - 10.0) << "the hand moves again";
}

TEST(Session, AScriptsHandIsHeldInAPauseAndGoesOnAfterIt) {
  auto made = Session::create(test::placed(cranium(), smallHead()), scripted());
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  std::vector<Vec3> tips_mm;
  freewheelTalking(session, 4.0, [&] {
    tips_mm.push_back(session.state().record.arms[0].patient_position_mm);
    if (tips_mm.size() == 4) session.send(CommandKind::pause);
    if (tips_mm.size() == 10) session.send(CommandKind::resume);
  });
  ASSERT_GT(tips_mm.size(), 14u);
  EXPECT_GT(glm::distance(tips_mm[3], tips_mm[1]), 1.0) << "the script moves it";
  EXPECT_LT(glm::distance(tips_mm[9], tips_mm[4]), 0.2);
  EXPECT_GT(glm::distance(tips_mm[13], tips_mm[9]), 1.0);
}

// Both arms cut while everything is changed under them, from another thread than theirs.
TEST(Session, UndoRewindAndParametersWhileItCutsLeaveARecordingThatReplaysIdentically) {
  test::TemporaryFolder folder;
  auto made = Session::create(test::placed(cranium(), smallHead()), scripted(folder / "s.h5"));
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  ASSERT_TRUE(session.start(4.0).ok());
  TissueSet tissues = session.exercise().tissues;
  double most_N = 0.0, last_N = 0.0;
  for (int i = 0; !session.finished(); ++i) {
    const std::uint64_t next = session.state().ticks + 13;
    ASSERT_TRUE(waitUntil([&] { return session.state().ticks >= next || session.finished(); }));
    const double sent_N = glm::length(session.state().record.arms[0].sent_N);
    most_N = std::max(most_N, sent_N);
    last_N = sent_N;
    switch (i % 25) {
      case 3:
        session.send(CommandKind::undo);
        break;
      case 8:
        session.send(CommandKind::redo);
        break;
      case 13:
        tissues.tissues[3].friction_N.value = 1.0 + 0.1 * double(i % 7);
        ASSERT_TRUE(session.setTissues(tissues).ok());
        break;
      case 18:
        session.setController(i % 2 ? ControllerKind::off : ControllerKind::bounded);
        break;
      case 23:
        session.rewind(session.state().seconds / 2);
        break;
      default:
        break;
    }
  }
  ASSERT_TRUE(session.stop().ok());
  EXPECT_GT(most_N, 0.0);
  EXPECT_LE(last_N, 3.3);
  const auto reader = SessionReader::open(folder / "s.h5");
  const auto result = replay(**reader, smallHead());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
  EXPECT_EQ(result->ticks, 4000u);
  expectTheSameMetrics(session.report().done, *result, **reader);
}

// The right hand takes a burr in air, wishes its blade back in the bone, and has it once it is out.
TEST(Session, AToolThatIsChangedOnTheWayReplaysIdenticallyAndItsCutsAreUndone) {
  test::TemporaryFolder folder;
  auto made = Session::create(test::placed(cranium(), smallHead()), scripted(folder / "s.h5"));
  ASSERT_TRUE(made.ok()) << made.error().sentence();
  Session& session = **made;
  EXPECT_FALSE(session.changeTool(1, 3)) << "it has three";
  EXPECT_FALSE(session.changeTool(2, 0)) << "there are two arms";
  EXPECT_TRUE(session.changeTool(1, 2));
  bool wished = false, waited = false, undone = false;
  std::uint64_t by_burr = 0;
  const auto cut = [](const LoopState& now) {
    std::uint64_t voxels = 0;
    for (const std::uint64_t of_tissue : now.removed[1]) voxels += of_tissue;
    return voxels;
  };
  const Progress talk([&](double, const std::string&) {
    const LoopState& now = session.state();
    if (now.ticks == 0) return;
    const bool touches = now.record.arms[1].tissue_class >= 0;
    if (!wished) {
      EXPECT_EQ(now.tools[1], 2);
      EXPECT_EQ(now.tools[0], 0) << "the other hand keeps its own";
      if (touches && cut(now) > 20) wished = session.changeTool(1, 0);
    } else if (now.wanted_tools[1] != now.tools[1]) {
      waited = waited || touches;
      by_burr = cut(now);
    } else if (now.tools[1] == 0 && !undone && now.can_undo) {
      undone = session.send(CommandKind::undo);
    }
  });
  ASSERT_TRUE(session.freewheel(14.0, talk).ok());
  EXPECT_TRUE(waited);
  EXPECT_TRUE(undone);
  EXPECT_EQ(session.state().tools[1], 0);
  EXPECT_LT(cut(session.state()), by_burr);
  const auto reader = SessionReader::open(folder / "s.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  std::vector<std::uint32_t> changed;
  const auto events = (*reader)->events();
  for (const Event& event : *events) {
    if (event.kind == EventKind::tool_changed) changed.push_back(event.value);
  }
  EXPECT_EQ(changed, (std::vector<std::uint32_t>{2, 0}));
  const auto result = replay(**reader, smallHead());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
}

namespace {

struct CountingSink : RecordSink {
  void tick(const TickRecord& record) override {
    ++ticks;
    last_tick = record.tick;
  }
  void carve(const CarveRecord&) override { ++carved; }
  void event(const Event&) override { ++events; }
  std::uint64_t ticks = 0, last_tick = 0, carved = 0, events = 0;
};

}  // namespace

TEST(Session, GivesTheWholeStreamToWhoeverElseTakesIt) {
  CountingSink sink;
  SessionOptions options = scripted();
  options.sinks = {&sink};
  auto session = *Session::create(test::placed(cranium(), smallHead()), options);
  ASSERT_TRUE(session->freewheel(10.0).ok());
  const RunReport report = session->report();
  EXPECT_EQ(sink.ticks, report.done.ticks);
  EXPECT_EQ(sink.last_tick + 1, report.done.ticks);
  EXPECT_EQ(sink.carved, report.done.removed_voxels);
  EXPECT_GT(sink.carved, 0u);
  EXPECT_GT(sink.events, 0u);
}

TEST(Session, APokeCutsNothingWhateverIsEditedAndTellsForceAgainstDepth) {
  SessionOptions options = scripted();
  options.poke = true;
  auto session = *Session::create(test::placed(cranium(), smallHead()), options);
  EXPECT_TRUE(session->isPoke());
  TissueSet softer = session->exercise().tissues;
  for (Tissue& tissue : softer.tissues) {
    tissue.cuttable = true;
    tissue.toughness_J_per_m2.reset();
    tissue.cutting_J_per_mm3 = SourcedNumber{1e-9, "test"};
  }
  ASSERT_TRUE(session->setTissues(softer).ok());
  ASSERT_TRUE(session->freewheel(10.0).ok());
  const RunReport report = session->report();
  EXPECT_EQ(report.done.removed_voxels, 0u);
  EXPECT_EQ(report.volume_sha256, report.volume_sha256_before);
  EXPECT_TRUE(report.recording.empty());
  const std::vector<PokeCurve> pokes = session->pokes();
  ASSERT_FALSE(pokes.empty());
  double most_N = 0.0;
  for (const PokeCurve& poke : pokes) {
    for (const PokePoint& p : poke.points) most_N = std::max(most_N, p.sent_N);
  }
  EXPECT_GT(most_N, 0.5);
  EXPECT_LE(most_N, 3.3);
}

// A sharp tool parts soft tissue in a poke as it does in the exercise, which here cannot pay for a
// cut either.
TEST(Session, APokeIsFeltAsTheExerciseIsUntilThatCuts) {
  Exercise tough = cranium();
  for (Tissue& tissue : tough.tissues.tissues) {
    tissue.toughness_J_per_m2.reset();
    tissue.cutting_J_per_mm3 = SourcedNumber{kMechanicsRange.high, "test"};
  }
  const auto felt = [](const Exercise& exercise, bool poke) {
    SessionOptions options = scripted();
    options.poke = poke;
    auto session = *Session::create(test::placed(exercise, smallHead()), options);
    std::vector<double> forces_N;
    freewheelTalking(*session, 8.0, [&] {
      for (std::size_t arm = 0; arm < session->exercise().arms.size(); ++arm) {
        forces_N.push_back(glm::length(session->state().record.arms[arm].demanded_N));
      }
    });
    EXPECT_EQ(session->report().done.removed_voxels, 0u);
    return forces_N;
  };
  const std::vector<double> exercise_N = felt(tough, false), poke_N = felt(cranium(), true);
  ASSERT_EQ(poke_N.size(), exercise_N.size());
  EXPECT_GT(*std::ranges::max_element(exercise_N), 0.1);
  for (std::size_t i = 0; i < poke_N.size(); ++i) EXPECT_EQ(poke_N[i], exercise_N[i]) << i;
}

// A tool that rests in bone, or in soft tissue, while the numbers of that change a hundredfold: the
// arm has them two ticks later, and its force goes there no faster than 0.05 N/ms.
TEST(Session, AnEditIsFeltWithinTwoTicksAndTheForceNeverJumps) {
  test::TemporaryFolder folder;
  auto session = *Session::create(test::placed(cranium(), smallHead()), scripted(folder / "s.h5"));
  const TissueSet own = session->exercise().tissues;
  TissueSet soft = own, hard = own;
  for (Tissue& tissue : soft.tissues) {
    for (const TissueNumber& number : kTissueNumbers) {
      if (number.of(tissue)) number.set(tissue, {0.1 * number.valueOf(tissue), "asked"});
    }
  }
  for (Tissue& tissue : hard.tissues) {
    for (const TissueNumber& number : kTissueNumbers) {
      if (number.of(tissue)) number.set(tissue, {10.0 * number.valueOf(tissue), "asked"});
    }
  }
  int talks = 0;
  std::vector<std::uint64_t> asked;
  freewheelTalking(*session, 8.0, [&] {
    asked.push_back(session->state().ticks);
    ASSERT_TRUE(session->setTissues(++talks % 2 == 0 ? soft : hard).ok());
  });
  auto reader = SessionReader::open(folder / "s.h5");
  ASSERT_TRUE(reader.ok());
  std::vector<std::uint64_t> felt;
  const auto events = (*reader)->events();
  ASSERT_TRUE(events.ok());
  for (const Event& event : *events) {
    if (event.kind == EventKind::command && event.command.kind == CommandKind::tissues) {
      felt.push_back(event.tick);
    }
  }
  if (asked.size() > felt.size()) asked.pop_back();  // after the last tick
  ASSERT_EQ(felt.size(), asked.size());
  std::uint64_t longest = 0;
  for (std::size_t i = 0; i < felt.size(); ++i) longest = std::max(longest, felt[i] - asked[i]);
  EXPECT_LE(longest, 2u);
  const auto ticks = (*reader)->ticks(0, 8000);
  ASSERT_TRUE(ticks.ok());
  double fastest_N = 0.0, most_N = 0.0;
  for (std::size_t t = 1; t < ticks->size(); ++t) {
    for (std::size_t arm = 0; arm < 2; ++arm) {
      const double before_N = glm::length((*ticks)[t - 1].arms[arm].sent_N);
      const double now_N = glm::length((*ticks)[t].arms[arm].sent_N);
      fastest_N = std::max(fastest_N, now_N - before_N);
      most_N = std::max(most_N, now_N);
    }
  }
  std::printf(
      "%zu edits: in the hand after at most %d ticks, the force rises by at most %.4f N a "
      "ms, to %.2f N\n",
      felt.size(), int(longest), fastest_N, most_N);
  EXPECT_GT(most_N, 0.5);
  EXPECT_LE(fastest_N, 0.05 + 1e-9);
}

// Every event of a recording of a kind, as the tick had it.
std::size_t commandsIn(const std::filesystem::path& recording) {
  const auto events = (*SessionReader::open(recording))->events();
  return std::size_t(std::count_if(events->begin(), events->end(),
                                   [](const Event& e) { return e.kind == EventKind::command; }));
}

TEST(Session, RecolouringATissueNeverReachesTheHapticThread) {
  test::TemporaryFolder folder;
  auto session = *Session::create(test::placed(cranium(), smallHead()), scripted(folder / "s.h5"));
  TissueSet tissues = session->exercise().tissues;
  for (int step = 0; step < 200; ++step) {  // more than the ring of commands holds
    tissues.tissues[3].opacity = 0.001 * step;
    tissues.tissues[3].colour = Vec3(0.001 * step);
    tissues.tissues[3].name = "Bone " + std::to_string(step);
    ASSERT_TRUE(session->setTissues(tissues).ok()) << step;
  }
  EXPECT_EQ(session->exercise().tissues.tissues[3].opacity, 0.199) << "kept for the window";
  tissues.tissues[3].friction_N.value += 0.5;
  ASSERT_TRUE(session->setTissues(tissues).ok());
  ASSERT_TRUE(session->freewheel(0.2).ok());
  EXPECT_EQ(commandsIn(folder / "s.h5"), 1u) << "the friction alone";
}

// Simulated arms as the shipped ones, with something more to them.
std::string arms(const std::filesystem::path& folder, const Json& more) {
  Json json = *readJsonFile(resourceFolder() / "devices" / "omni.json");
  json.update(more);
  const std::filesystem::path file = folder / "arms.json";
  std::ofstream(file) << json.dump();
  return file.string();
}

// Simulated arms by that file.
Rig rigOf(const Exercise& exercise, const std::string& config) {
  Rig rig = simulatedRig(exercise);
  for (Rig::Arm& arm : rig.arms) arm.device.config = config;
  return rig;
}

TEST(Session, NamesTheArmsThatWereLostInItsReport) {
  test::TemporaryFolder folder;
  const Exercise exercise = cranium();
  SessionOptions options = scripted(folder / "s.h5");
  options.rig = rigOf(exercise, arms(folder.path(), {{"vanish_after_s", 0.3}}));
  auto session = *Session::create(test::placed(exercise, smallHead()), options);
  ASSERT_TRUE(session->freewheel(0.5).ok());
  const RunReport report = session->report();
  ASSERT_EQ(report.done.faults.size(), 2u);
  EXPECT_EQ(report.done.faults[0].tick, 300u);
  const Json json = toJson(report);
  EXPECT_EQ(json["faults"][0], (Json{{"tick", 300}, {"arm", "left"}, {"fault", "lost"}}));
  EXPECT_EQ(json["faults"][1]["arm"], "right");
  EXPECT_NE(toText(report).find("FAULT at 0.300 s, left: the arm did not answer"),
            std::string::npos);

  auto sound = *Session::create(test::placed(exercise, smallHead()), scripted());
  ASSERT_TRUE(sound->freewheel(0.5).ok());
  EXPECT_TRUE(sound->report().done.faults.empty());
  EXPECT_EQ(toJson(sound->report())["faults"], Json::array());
}

// As a script commands it.
TEST(Session, OneArmsDeviceIsLostTheOtherGoesOnAndTheRecordingReplays) {
  test::TemporaryFolder folder;
  const Exercise exercise = cranium();
  SessionOptions options = scripted(folder / "s.h5");
  const auto at = [](double time_s, CommandKind kind, int arm) {
    ScriptCommand command;
    command.time_s = time_s;
    command.command.kind = kind;
    command.command.arm = arm;
    return command;
  };
  options.script->commands = {
      at(0.3, CommandKind::device_lost, 0), at(0.6, CommandKind::clear_faults, -1),
      at(0.8, CommandKind::device_back, 0), at(0.9, CommandKind::clear_faults, -1)};
  const Placement of = test::placed(exercise, smallHead());
  auto session = *Session::create(of, options);
  ASSERT_TRUE(session->freewheel(1.2).ok());
  const RunReport report = session->report();
  ASSERT_EQ(report.done.faults.size(), 2u) << "once more after the first clearing";
  EXPECT_EQ(report.done.faults[0].tick, 300u);
  session.reset();
  const auto reader = *SessionReader::open(folder / "s.h5");
  const std::vector<TickRecord> ticks = *reader->ticks(0, 1200);
  for (const TickRecord& tick : ticks) {
    const bool gone = (tick.tick >= 300 && tick.tick < 900);
    EXPECT_EQ(tick.arms[0].faults, gone ? kFaultDeviceLost : 0u) << tick.tick;
    if (gone) {
      ASSERT_EQ(glm::length(tick.arms[0].sent_N), 0.0) << tick.tick;
    }
    EXPECT_EQ(tick.arms[1].faults, 0u) << tick.tick;
  }
  const Result<ReplayResult> again = replay(*reader, *of.patient.volume, of.labels.get());
  ASSERT_TRUE(again) << again.error().sentence();
  EXPECT_TRUE(again->identical);
}

TEST(Session, StandsStillWhileItsVoxelsAreReadAndGoesOnAfterwards) {
  auto session = *Session::create(test::placed(cranium(), smallHead()), scripted());
  ASSERT_TRUE(session->start(30.0).ok());
  ASSERT_TRUE(waitUntil([&] { return session->state().can_undo; })) << "something was cut";
  ASSERT_TRUE(waitUntil([&] { return session->freeze(); }));
  const std::string before = slabsSha256(slabsOf(session->grid()));
  EXPECT_TRUE(session->state().paused);
  for (CommandKind kind : {CommandKind::undo, CommandKind::reset, CommandKind::resume}) {
    EXPECT_FALSE(session->send(kind));
  }
  EXPECT_FALSE(session->rewind(0));
  const auto pass = [&](std::uint64_t ticks) {
    const std::uint64_t until = session->state().ticks + ticks;
    ASSERT_TRUE(waitUntil([&] { return session->state().ticks >= until; }));
  };
  pass(200);
  EXPECT_EQ(slabsSha256(slabsOf(session->grid())), before);
  session->thaw();
  ASSERT_TRUE(waitUntil([&] { return !session->state().paused; }));
  EXPECT_TRUE(session->send(CommandKind::reset));
  ASSERT_TRUE(session->send(CommandKind::pause));
  ASSERT_TRUE(waitUntil([&] { return session->freeze(); })) << "with all that still waits";
  const std::string whole = slabsSha256(slabsOf(session->grid()));
  EXPECT_NE(whole, before) << "put back before";
  pass(100);
  EXPECT_EQ(slabsSha256(slabsOf(session->grid())), whole);
  EXPECT_TRUE(session->send(CommandKind::pause)) << "one that is asked for meanwhile stays";
  session->thaw();
  pass(50);
  EXPECT_TRUE(session->state().paused) << "a pause that was there before stays";
  ASSERT_TRUE(session->stop().ok());
}

TEST(Session, IsReplayedOnlyWhereThereIsMemoryForIt) {
  test::TemporaryFolder folder;
  const Volume head = smallHead();
  {
    auto session = *Session::create(test::placed(cranium(), head), scripted(folder / "s.h5"));
    ASSERT_TRUE(session->freewheel(0.1).ok());
  }
  const auto reader = SessionReader::open(folder / "s.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  {
    const test::DataLimit limit(200.0);
    const auto refused = replay(**reader, head);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code.str(), "OUT_OF_MEMORY");
    EXPECT_NE(refused.error().what.find("needs"), std::string::npos) << refused.error().what;
  }
  EXPECT_TRUE(replay(**reader, head)->identical);
}

TEST(Session, ThatNeverCameToATickHasTheVoxelsThatItBeganWith) {
  test::TemporaryFolder folder;
  const Placement of = test::placed(cranium(), smallHead());
  { ASSERT_TRUE(Session::create(of, scripted(folder / "s.h5")).ok()); }
  const auto reader = SessionReader::open(folder / "s.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  ASSERT_TRUE((*reader)->end());
  EXPECT_EQ((*reader)->end()->volume_sha256, of.patient.sha256);
}

TEST(Session, KeepsAScriptsCommandsWhileItsVoxelsAreRead) {
  SessionOptions options = scripted();
  Command back{CommandKind::reset, 0, {}};
  options.script->commands = {{4.0, back}};
  auto session = *Session::create(test::placed(cranium(), smallHead()), options);
  ASSERT_TRUE(session->startStepped(30.0).ok());
  const auto advanceUntil = [&](const std::function<bool()>& condition) {
    while (!condition() && !session->finished()) session->advance(0.005);
    return condition();
  };
  ASSERT_TRUE(advanceUntil([&] { return session->state().can_undo; })) << "something was cut";
  ASSERT_TRUE(advanceUntil([&] { return session->freeze(); }));
  ASSERT_LT(session->state().ticks, 4000u);
  const std::string before = slabsSha256(slabsOf(session->grid()));
  ASSERT_NE(before, slabsSha256(slabsOf(smallHead())));
  ASSERT_TRUE(advanceUntil([&] { return session->state().ticks >= 4400; }));
  EXPECT_EQ(slabsSha256(slabsOf(session->grid())), before);
  session->thaw();
  EXPECT_TRUE(advanceUntil([&] {
    const LoopState& state = session->state();
    return !state.paused && !state.busy && !state.can_undo;
  }));
  ASSERT_TRUE(session->stop().ok());
}

// A device that returns late: force away, back, and the same in the replay.
TEST(Session, AStallIsAFaultInTheReportAndReplaysIdentically) {
  test::TemporaryFolder folder;
  const Exercise exercise = cranium();
  SessionOptions options = scripted(folder / "s.h5");
  options.rig =
      rigOf(exercise, arms(folder.path(), {{"block_after_s", 0.3}, {"block_for_s", 0.1}}));
  auto session = *Session::create(test::placed(exercise, smallHead()), options);
  ASSERT_TRUE(session->start(0.6).ok());
  ASSERT_TRUE(waitUntil([&] { return session->finished(); }));
  ASSERT_TRUE(session->stop().ok());
  EXPECT_FALSE(session->leftBehind());
  const RunReport report = session->report();
  ASSERT_GE(report.done.faults.size(), 2u);
  EXPECT_EQ(toJson(report)["faults"][0]["fault"], "late");
  const auto events = (*SessionReader::open(folder / "s.h5"))->events();
  EXPECT_TRUE(std::any_of(events->begin(), events->end(), [](const Event& e) {
    return e.kind == EventKind::silenced;
  })) << "the watchdog's";
  const auto result = replay(**SessionReader::open(folder / "s.h5"), smallHead());
  ASSERT_TRUE(result.ok()) << result.error().sentence();
  EXPECT_TRUE(result->identical) << result->first_difference->field;
}

long lockedKiB() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word && word != "VmLck:") {
  }
  long kib = -1;
  status >> kib;
  return kib;
}

TEST(Session, HoldsItsMemoryWhileItRunsInRealTimeOrSaysHowThatIsAllowed) {
  if (test::kSanitized) GTEST_SKIP() << "A sanitizer holds no memory";
  const long before = lockedKiB();
  auto session = *Session::create(test::placed(cranium(), smallHead()), scripted());
  EXPECT_FALSE(session->memoryLocked()) << "not known yet";
  ASSERT_TRUE(session->start(60.0).ok());
  ASSERT_TRUE(waitUntil([&] { return session->state().ticks > 0; }));
  ASSERT_TRUE(session->memoryLocked());
  const bool locked = *session->memoryLocked();
  EXPECT_EQ(lockedKiB() > before, locked);
  ASSERT_TRUE(session->stop().ok());
  EXPECT_EQ(lockedKiB(), before) << "given back";
  EXPECT_EQ(toJson(session->report())["memory_locked"], locked);
  EXPECT_EQ(toText(session->report()).find("memlock") == std::string::npos, locked);
}

TEST(Session, TwoArmsThatShareVoxelsShareTheirVolumeInTheReport) {
  auto session = *Session::create(test::placed(cranium(), smallHead()), scripted());
  ASSERT_TRUE(session->freewheel(10.0).ok());
  const RunReport report = session->report();
  double of_arms = 0.0, of_tissues = 0.0;
  for (const auto& arm : report.done.arms) of_arms += arm.removed_mm3;
  for (const auto& [tissue, mm3] : report.done.removed_mm3) of_tissues += mm3;
  of_tissues += report.done.removed_unnamed_mm3;
  EXPECT_NEAR(of_arms, of_tissues, 1e-6 * of_tissues);
}

TEST(Session, RefusesTissuesThatCannotBe) {
  auto session = Session::create(test::placed(cranium(), smallHead()), {});
  TissueSet bad = (*session)->exercise().tissues;
  bad.tissues[0].damping_Ns_per_m.value = -1.0;
  EXPECT_FALSE((*session)->setTissues(bad).ok());
}

TEST(FreshFile, NeverNamesAFileThatIsThere) {
  test::TemporaryFolder folder;
  EXPECT_EQ(freshFile(folder.path(), "a", ".h5"), folder / "a.h5");
  (void)makeFolder(folder / "a.h5");
  EXPECT_EQ(freshFile(folder.path(), "a", ".h5"), folder / "a-2.h5");
}

TEST(FreshFile, OfAFolderThatCannotBeLookedIntoIsLeftToWhoWritesThere) {
  const std::filesystem::path folder(std::string(300, 'x'));  // longer than names may be
  EXPECT_EQ(freshFile(folder, "a", ".h5"), folder / "a.h5");
  const auto made =
      Session::create(test::placed(cranium(), smallHead()), scripted(folder / "a.h5"));
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code.str(), "CANNOT_WRITE");
}

TEST(Session, AMissingTemporaryFolderIsAnErrorWhereOneIsNeeded) {
  test::TemporaryFolder folder;
  const test::Environment missing("TMPDIR", (folder / "none").string());
  const auto unrecorded = Session::create(test::placed(cranium(), smallHead()), scripted());
  ASSERT_FALSE(unrecorded.ok());
  EXPECT_EQ(unrecorded.error().code.str(), "NO_TEMPORARY_FOLDER");

  // Beside a recording there is room for what does not fit into memory; a replay has no such place.
  auto recorded = Session::create(test::placed(cranium(), smallHead()), scripted(folder / "s.h5"));
  ASSERT_TRUE(recorded.ok()) << recorded.error().sentence();
  ASSERT_TRUE((*recorded)->freewheel(0.1).ok());
  const auto reader = SessionReader::open(folder / "s.h5");
  ASSERT_TRUE(reader.ok()) << reader.error().sentence();
  const auto replayed = replay(**reader, smallHead());
  ASSERT_FALSE(replayed.ok());
  EXPECT_EQ(replayed.error().code.str(), "NO_TEMPORARY_FOLDER");
}

}  // namespace
}  // namespace trephine
