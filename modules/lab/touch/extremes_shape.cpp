#include <cmath>
#include <utility>

#include "lab/touch/extremes_rows.h"

namespace trephine::extremes {

namespace {

Tool blade(double length_m, int points) {
  return *makeTool({ToolKind::blade, 1000.0 * length_m, points, 0.05});
}

Outcome tissueOf(std::int16_t hu) {
  return ordinary({.volume = block(Vec3(1.0), hu), .tissues = table(10.0, 800.0, 2.0, hu, hu)},
                  voxelsOnTheWay(1.0));
}

Outcome noTissueOf(std::int16_t hu) {
  return nothingTouched({.volume = block(Vec3(1.0), hu)});
}

Outcome spacingOf(double mm, const Index3& size) {
  const Index3 middle{size[0] / 2, size[1] / 2, size[2] / 2};
  return ordinary({.volume = block(size, Vec3(mm), kBoneHu, middle)}, voxelsOnTheWay(mm));
}

Outcome anisotropic() {
  const Volume volume = block(Vec3(0.5, 0.5, 10.0));
  const auto turn = [](Sample& s) { std::swap(s.position_m.x, s.position_m.z); };
  const Outcome x = ordinary({.volume = volume}, voxelsOnTheWay(0.5));
  const Outcome z = ordinary({.volume = volume, .script = strokeWith(turn)}, voxelsOnTheWay(10.0));
  return {"along x " + x.got + "; along z " + z.got, x.pass && z.pass};
}

Outcome oneVoxel() {
  Setup setup{.volume = block({1, 1, 1}, Vec3(1.0), kBoneHu, {0, 0, 0})};
  const Run cut = run(setup);
  setup.tissues.classes[0].cuttable = 0;
  const Run kept = run(setup);
  const Outcome a = judge(cut, cut.removed == 1 && cut.touching() <= 70 && !cut.faulty(),
                          formatted("%d tick of contact, ", cut.touching()) + facts(cut));
  const Outcome b = judge(
      kept,
      kept.removed == 0 && kept.touching() >= 40 && kept.largest_N() > kFelt_N && !kept.faulty(),
      formatted("%d ticks of contact, ", kept.touching()) + facts(kept));
  return {a.got + "; not cuttable: " + b.got, a.pass && b.pass};
}

Outcome flatVolume() {
  // To the last voxel of 4,194,304 and beyond it: half of the way lies inside.
  return ordinary({.volume = block({2048, 2048, 1}, Vec3(0.5), kBoneHu, {2047, 2047, 0})}, 11);
}

// Along +x, from the voxel of the tip to the last of the volume.
Outcome longBlade(double length_m, int points) {
  constexpr int kVoxels = 5 + 16;
  const double half = std::sqrt(0.5);
  const auto turn = [=](Sample& s) { s.orientation = Quat(half, 0.0, half, 0.0); };
  return ordinary({.tool = blade(length_m, points), .script = strokeWith(turn)}, kVoxels);
}

Outcome outside() {
  return nothingTouched({.script = strokeWith([](Sample& s) { s.position_m.y = 1.0; })});
}

}  // namespace

std::vector<Case> shapeCases() {
  return {
      {"HU -32768 in range", "every voxel, and a tissue of just that HU", kStroke,
       [] { return tissueOf(-32768); }},
      {"HU -32768 out of range", "every voxel, tissue 226 to 3071", "air: no contact, no force",
       [] { return noTissueOf(-32768); }},
      {"HU 32767 in range", "every voxel, and a tissue of just that HU", kStroke,
       [] { return tissueOf(32767); }},
      {"HU 32767 out of range", "every voxel, tissue 226 to 3071", "air: no contact, no force",
       [] { return noTissueOf(32767); }},
      {"spacing 0.05 mm", "256x32x32 voxels",
       "above 0.1 N, 200 voxels cut (2 more or less), no fault",
       [] {
         return spacingOf(0.05, {256, 32, 32});
       }},
      {"spacing 10 mm", "32x32x32 voxels", "above 0.1 N, 2 voxels cut (2 more or less), no fault",
       [] {
         return spacingOf(10.0, {32, 32, 32});
       }},
      {"anisotropy 1:20", "0.5x0.5x10 mm, along x and along z",
       "above 0.1 N, 21 voxels cut along x and 2 along z (2 more or less), no fault", anisotropic},
      {"volume 1x1x1", "the stroke passes its one voxel",
       "cut while it touches; above 0.1 N where it cannot be cut", oneVoxel},
      {"volume 2048x2048x1", "0.5 mm, through the last voxel and out", kStroke, flatVolume},
      {"blade of 0 m", "5 points, all at the tip", kAsUsual,
       [] { return undisturbed({.tool = blade(0.0, 5)}); }},
      {"blade of 1 m", "2001 points, along the stroke and out of the volume",
       "above 0.1 N, the 21 voxels ahead cut, no fault", [] { return longBlade(1.0, 2001); }},
      {"1 point", "blade of 20 mm", kAsUsual, [] { return undisturbed({.tool = blade(0.02, 1)}); }},
      {"10,000 points", "blade of 25 mm, along the stroke",
       "above 0.1 N, the 21 voxels ahead cut, no fault", [] { return longBlade(0.025, 10000); }},
      {"tool outside the volume", "the stroke 1 m beside it", "air: no contact, no force", outside},
  };
}

}  // namespace trephine::extremes
