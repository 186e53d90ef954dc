#include <limits>

#include "lab/touch/extremes_rows.h"

namespace trephine::extremes {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNotFinite[] = {kNaN, kInf, -kInf};

const char* const kFaultAtFirst =
    "a fault from the first touch until the table is good and it is cleared, no force meanwhile";
const char* const kRefused = "each refused with a sentence";

Outcome badPose(const Vec3& position_m, const Quat& orientation = {1, 0, 0, 0}) {
  const auto spoil = [=](Sample& sample) {
    sample.position_m = position_m;
    sample.orientation = orientation;
  };
  return faultThenWork(
      {.script = strokeWith(spoil, kMiddle, kMiddle + 1), .commands = {kClearFaults}},
      kFaultNonFinite, kMiddle);
}

Vec3 middle_m() {
  return stroke(kMiddle).position_m;
}

// Past the validation: a table that no file and no panel can give, in the first tick of a loop that
// would not start with it.
Outcome badTable(double damping, double stiffness, double friction) {
  Setup setup;
  setup.commands = {tissuesAt(0, table(damping, stiffness, friction)),
                    tissuesAt(kClear - 1, setup.tissues), kClearFaults};
  return faultThenWork(setup, kFaultNonFinite, 0);
}

TissueSet validSet() {
  Tissue bone;
  bone.id = bone.name = "bone";
  bone.hu_min = 226;
  bone.hu_max = 3071;
  bone.hu_source = "made up";
  for (const TissueNumber& number : kTissueNumbers) number.set(bone, {0.0, "made up"});
  return {"made up", {bone}};
}

struct Refusals {
  int cases = 0, refused = 0;
  std::string first;
  void add(const auto& answer) {
    ++cases;
    if (!answer && ++refused == 1) first = answer.error().sentence();
  }
  Outcome outcome() const {
    return {formatted("%d of %d refused: ", refused, cases) + first, refused == cases};
  }
};

Outcome refusedTissues() {
  const Json valid = toJson(validSet());
  if (auto set = parseTissueSet(valid, "file"); !set) return {set.error().sentence(), false};
  Refusals refusals;
  for (double value : kNotFinite) {
    for (const TissueNumber& number : kTissueNumbers) {
      TissueSet set = validSet();
      number.set(set.tissues[0], {value, "made up"});
      refusals.add(validate(set, "set"));
      Json json = valid;
      json["tissues"][0]["mechanics"][number.key]["value"] = value;
      refusals.add(parseTissueSet(json, "file"));
    }
    TissueSet opaque = validSet(), coloured = validSet();
    opaque.tissues[0].opacity = coloured.tissues[0].colour.y = value;
    refusals.add(validate(opaque, "set"));
    refusals.add(validate(coloured, "set"));
  }
  refusals.add(parseJson(R"({"value": 1e999})", "file"));
  return refusals.outcome();
}

Outcome refusedTools() {
  Refusals refusals;
  for (double length_m : kNotFinite) {
    for (ToolKind kind : {ToolKind::needle, ToolKind::blade, ToolKind::burr}) {
      refusals.add(makeTool({kind, 1000.0 * length_m, 10}));
    }
  }
  return refusals.outcome();
}

Outcome refusedCapabilities() {
  if (Status usual = tryToOpen(omniCapabilities()); !usual)
    return {usual.error().sentence(), false};
  Refusals refusals;
  for (double value : kNotFinite) {
    for (auto field : {&TrephineCapabilities::peak_force_N, &TrephineCapabilities::apparent_mass_kg,
                       &TrephineCapabilities::encoder_step_m, &TrephineCapabilities::rate_hz}) {
      TrephineCapabilities capabilities = omniCapabilities();
      capabilities.*field = value;
      refusals.add(tryToOpen(capabilities));
    }
  }
  return refusals.outcome();
}

}  // namespace

std::vector<Case> notFiniteCases() {
  return {
      {"position NaN", "y of the position in tick 200", kFaultInMiddle,
       [] { return badPose(Vec3(0.0, kNaN, 0.0)); }},
      {"position infinite", "x of the position in tick 200", kFaultInMiddle,
       [] { return badPose(Vec3(kInf, 0.0, 0.0)); }},
      {"position minus infinite", "z of the position in tick 200", kFaultInMiddle,
       [] { return badPose(Vec3(0.0, 0.0, -kInf)); }},
      {"position 1e308 m", "x of the position in tick 200: finite, its velocity is not",
       kFaultInMiddle, [] { return badPose(Vec3(1e308, 0.0, 0.0)); }},
      {"orientation NaN", "w of the quaternion in tick 200", kFaultInMiddle,
       [] { return badPose(middle_m(), Quat(kNaN, 0.0, 0.0, 0.0)); }},
      {"orientation infinite", "x of the quaternion in tick 200", kFaultInMiddle,
       [] { return badPose(middle_m(), Quat(1.0, kInf, 0.0, 0.0)); }},
      {"orientation minus infinite", "z of the quaternion in tick 200", kFaultInMiddle,
       [] { return badPose(middle_m(), Quat(1.0, 0.0, 0.0, -kInf)); }},
      {"tissue parameters not finite", "NaN, infinity, minus infinity and 1e999 in set and file",
       kRefused, refusedTissues},
      {"tool length not finite", "NaN, infinity and minus infinity", kRefused, refusedTools},
      {"arm capabilities not finite", "NaN, infinity and minus infinity", kRefused,
       refusedCapabilities},
      {"b NaN past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(kNaN, 800.0, 2.0); }},
      {"b infinite past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(kInf, 800.0, 2.0); }},
      {"k NaN past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(10.0, kNaN, 2.0); }},
      {"k infinite past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(10.0, kInf, 2.0); }},
      {"friction NaN past validation", "in the core's table", kFaultAtFirst,
       [] { return badTable(10.0, 800.0, kNaN); }},
  };
}

}  // namespace trephine::extremes
