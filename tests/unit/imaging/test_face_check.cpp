// Whether a defaced head is one is found out by looking for eyes, nose and mouth again. Figures are
// printed: they are what the thresholds rest on.
#include <algorithm>
#include <cstdio>

#include "imaging/codes.h"
#include "imaging/steps/face.h"
#include "imaging/steps/face_check.h"
#include "posed.h"
#include "series_fixture.h"
#include "volume/codes.h"
#include "volume/reduce.h"
#include "volume/volume_files.h"

namespace trephine::test {

namespace {

// Where the built-in head has them.
const Vec3 kLeftEye(31, -67, -28), kNose(0, -96, -54), kMouth(0, -85, -78);

// Made once.
const Volume& upright() {
  static const Volume volume = posedHead({});
  return volume;
}

struct Look {
  FaceFinding finding;
  FaceMarks marks;
  FaceLeft left;
};

// A look at `volume` before and after `cut` is made.
template <class Cut>
Look lookAfter(const Volume& volume, const char* name, const Cut& cut) {
  Look look{findFace(volume), {}, {}};
  const CoarseGrid before = faceGrid(volume);
  look.marks = findFaceMarks(before);
  Volume after = volume;
  cut(after, look.finding);
  look.left = faceLeft(look.marks, before, faceGrid(after));
  std::printf("[ figures  ] %s: %zu eyes, %s, %s; left eyes %.2f nose %.2f mouth %.2f\n", name,
              look.marks.eyes.size(), look.marks.nose ? "nose" : "no nose",
              look.marks.mouth ? "mouth" : "no mouth", look.left.eyes, look.left.nose,
              look.left.mouth);
  return look;
}

void defaceIt(Volume& volume, const FaceFinding& finding) {
  deface(volume, finding);
}
void nothing(Volume&, const FaceFinding&) {}

void expectRecognised(const FaceMarks& marks, const HeadPose& pose, const std::string& name) {
  ASSERT_EQ(marks.eyes.size(), 2u) << name;
  for (const Vec3& eye : marks.eyes) {
    const Vec3 p = intoHead(eye, pose);
    EXPECT_LT(glm::distance(Vec3(std::abs(p.x), p.y, p.z), kLeftEye), 8.0) << name;
  }
  ASSERT_TRUE(marks.nose && marks.mouth) << name;
  EXPECT_LT(glm::distance(intoHead(*marks.nose, pose), kNose), 25.0) << name;
  // The built-in face is a quarter lower than life, so that life's proportions miss its lips by
  // some.
  EXPECT_LT(glm::distance(intoHead(*marks.mouth, pose), kMouth), 32.0) << name;
}

}  // namespace

TEST(FaceCheck, EyesNoseAndMouthAreFoundInAnyPoseAndAreGoneAfterTheCut) {
  for (const HeadPose& pose :
       {HeadPose{}, HeadPose{40}, HeadPose{-30}, HeadPose{0, 45}, HeadPose{30, 25, true}}) {
    const std::string name = "extended " + std::to_string(int(pose.extended_deg)) + " turned " +
                             std::to_string(int(pose.turned_deg)) + (pose.arms_up ? " arms" : "");
    const Look look = lookAfter(posedHead(pose), name.c_str(), defaceIt);
    EXPECT_TRUE(look.finding.found) << name;
    expectRecognised(look.marks, pose, name);
    EXPECT_LT(std::max({look.left.eyes, look.left.nose, look.left.mouth}), 0.2) << name;
  }
}

// With the neck that far back the slices cut through an open orbit, which then counts as braincase.
TEST(FaceCheck, AnEyeThatTheCutLeavesInAHeadThatIsFarExtendedIsSeen) {
  const Look look = lookAfter(posedHead(HeadPose{50}), "extended 50", defaceIt);
  ASSERT_EQ(look.marks.eyes.size(), 2u);
  EXPECT_GT(look.left.eyes, 0.2);
  EXPECT_LT(std::max(look.left.nose, look.left.mouth), 0.2);
}

TEST(FaceCheck, WhatTheCutLeavesIsSeen) {
  const Volume head = upright();
  const auto below = [](double z) {
    return [z](Volume& volume, const FaceFinding&) {
      const GridGeometry& g = volume.geometry;
      for (std::size_t n = 0; n < volume.hu.size(); ++n) {
        const Index3 at = g.indicesOf(n);
        if (g.toPatient_mm(Vec3(at[0], at[1], at[2])).z < z) volume.hu[n] = kAirHu;
      }
    };
  };
  const Look whole = lookAfter(head, "no cut", nothing);
  EXPECT_EQ(whole.left.eyes, 1.0);
  EXPECT_EQ(whole.left.nose, 1.0);
  EXPECT_EQ(whole.left.mouth, 1.0);
  const Look mouth_gone = lookAfter(head, "cut below the nose", below(-69));
  EXPECT_EQ(mouth_gone.left.eyes, 1.0);
  EXPECT_GT(mouth_gone.left.nose, 0.5);
  EXPECT_LT(mouth_gone.left.mouth, 0.5);
  const Look eyes_left = lookAfter(head, "cut below the eyes", below(-42));
  EXPECT_GT(eyes_left.left.eyes, 0.9);
  EXPECT_LT(eyes_left.left.nose, 0.25);
  EXPECT_EQ(eyes_left.left.mouth, 0.0);
  const Look mouth_left = lookAfter(head, "cut above the mouth", [](Volume& v, const FaceFinding&) {
    const GridGeometry& g = v.geometry;
    for (std::size_t n = 0; n < v.hu.size(); ++n) {
      const Index3 at = g.indicesOf(n);
      if (g.toPatient_mm(Vec3(at[0], at[1], at[2])).z > -68) v.hu[n] = kAirHu;
    }
  });
  EXPECT_EQ(mouth_left.left.eyes, 0.0);
  EXPECT_GT(mouth_left.left.mouth, 0.4);
}

TEST(FaceCheck, HoweverThePatientLiesTheFaceIsFoundAndGone) {
  // Prone, feet first, both: the voxels turn with the words.
  for (const Vec3& axes : {Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1)}) {
    Volume turned = upright();
    GridGeometry& g = turned.geometry;
    std::vector<std::int16_t> hu(turned.hu.begin(), turned.hu.end());
    for (std::size_t n = 0; n < hu.size(); ++n) {
      Index3 at = g.indicesOf(n);
      for (int i = 0; i < 3; ++i) {
        if (axes[i] < 0) at[std::size_t(i)] = g.size[std::size_t(i)] - 1 - at[std::size_t(i)];
      }
      turned.hu[g.indexOf(at[0], at[1], at[2])] = hu[n];
    }
    const Look look = lookAfter(laidAs(turned, axes), "other way round", defaceIt);
    expectRecognised(look.marks, {}, "other way round");
    EXPECT_LT(std::max({look.left.eyes, look.left.nose, look.left.mouth}), 0.2);
  }
}

TEST(FaceCheck, AHeaderThatTurnsThePatientOverHidesNeitherAFaceNorWhatTheCutLeftOfIt) {
  for (const Vec3& axes : {Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1)}) {
    const Look look = lookAfter(laidAs(upright(), axes), "wrong header", defaceIt);
    EXPECT_TRUE(look.finding.found);
    EXPECT_EQ(look.marks.eyes.size(), 2u);
    EXPECT_TRUE(look.marks.nose);
    // Turned about the long axis the cut is made at the nape; feet for head it still meets the
    // face.
    const bool gone = std::max({look.left.eyes, look.left.nose, look.left.mouth}) < 0.2;
    EXPECT_EQ(gone, axes.y > 0.0);
  }
}

TEST(FaceCheck, WhatIsNoFaceHasNoMarks) {
  const Volume body = paint(centredGrid({200, 160, 60}, {2.5, 2.5, 6.0}), man).volume;
  GridGeometry geometry = phantomGeometry("abdomen").value();
  for (int axis = 0; axis < 3; ++axis) {
    geometry.size[std::size_t(axis)] /= 2;
    geometry.spacing_mm[axis] *= 2.0;
  }
  const Volume abdomen = makePhantomOn(phantomTruth("abdomen").value(), geometry, kPhantomNoiseHu);
  Volume one;
  one.geometry.size = {1, 1, 1};
  one.hu = {40};
  for (const Volume& volume : {body, abdomen, one, Volume()}) {
    const FaceMarks marks = findFaceMarks(faceGrid(volume));
    EXPECT_TRUE(marks.eyes.empty());
    EXPECT_FALSE(marks.nose);
    EXPECT_FALSE(marks.mouth);
  }
}

TEST(FaceCheck, OfRealScansTheSkullHasANoseAtMostAndTheAbdomenNothing) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  auto ct = CtFolder::scan(data / "head-ct-plastic-skull", Progress());
  const Volume skull = *ct->read(*ct->bestSeries(), ImportRequest(), Progress());
  const auto abdomen = readVolume(data / "abdomen-ct-totalsegmentator/example_ct.nii.gz");
  ASSERT_TRUE(abdomen.ok());
  const FaceMarks of_skull = findFaceMarks(faceGrid(skull));
  const FaceMarks of_abdomen = findFaceMarks(faceGrid(*abdomen));
  std::printf("[ figures  ] skull: %zu eyes, %s; abdomen: %zu eyes, %s\n", of_skull.eyes.size(),
              of_skull.nose ? "nose" : "no nose", of_abdomen.eyes.size(),
              of_abdomen.nose ? "nose" : "no nose");
  EXPECT_TRUE(of_skull.eyes.empty());
  EXPECT_TRUE(of_abdomen.eyes.empty());
  EXPECT_FALSE(of_abdomen.nose);
}

TEST(FaceCheck, WhatElseGoesIsMeasured) {
  const auto beyond = [](const HeadPose& pose) {
    const CoarseGrid grid = coarseGrid(posedHead(pose));
    return beyondFace(grid, findFace(grid), {{0, 0, 0}, grid.voxels.size});
  };
  const BeyondFace neck = beyond({}), arms = beyond({0, 20, true});  // turned a little
  std::printf("[ figures  ] throat %.0f mL, beside %.0f; with arms up %.0f and %.0f, bone %.0f\n",
              neck.throat_mL, neck.beside_mL, arms.throat_mL, arms.beside_mL, arms.bone_mL);
  EXPECT_GT(neck.throat_mL, 50.0);
  EXPECT_LT(neck.beside_mL, 20.0);
  EXPECT_LT(neck.bone_mL, 5.0);
  EXPECT_GT(arms.beside_mL, 300.0);
  EXPECT_GT(arms.bone_mL, 30.0);
}

using FaceSteps = SeriesFixture;

namespace {

Result<Volume> readAs(CtFolder& ct, const Answers& answers,
                      const std::optional<VoxelBox>& crop = std::nullopt) {
  ImportRequest request;
  request.answers = answers;
  request.crop = crop;
  return ct.read(ct.report().series.front().uid, request, Progress());
}

const Finding* findingOf(const CtFolder& ct, const std::string& code) {
  const std::vector<Finding>& findings = ct.report().series.front().findings;
  const auto it = std::ranges::find(findings, Code::named(code), &Finding::code);
  return it == findings.end() ? nullptr : &*it;
}

// Codes of what the series asks.
std::vector<std::string> asked(const CtFolder& ct) {
  std::vector<std::string> codes;
  for (const Choice& choice : ct.report().series.front().choices)
    codes.push_back(choice.code.str());
  return codes;
}

using Codes = std::vector<std::string>;

}  // namespace

TEST_F(FaceSteps, AHeadWhoseFaceIsGoneForSureIsSaidToBeDefaced) {
  write(makePhantomOn(phantomTruth("cranium").value(), centredGrid({128, 128, 90}, {1.6, 1.6, 2.0}),
                      8.0));
  CtFolder ct = scan();
  const auto defaced = readAs(ct, {{code::kFace, "deface"}});
  ASSERT_TRUE(defaced.ok()) << defaced.error().sentence();
  EXPECT_EQ(asked(ct), Codes{"FACE"});
  ASSERT_NE(findingOf(ct, "FACE"), nullptr);
  EXPECT_EQ(findingOf(ct, "FACE")->severity, Severity::edit);
  EXPECT_EQ(ct.report().series.front().verdict, Verdict::pass);
  EXPECT_NE(findingOf(ct, "FACE")->action.find("looked for again"), std::string::npos);
}

TEST_F(FaceSteps, WhereTheFaceRemainsNothingIsReadAsDefaced) {
  const Volume head = laidAs(upright(), {-1, -1, 1});
  write(head);
  CtFolder ct = scan();
  const Answers deface{{code::kFace, "deface"}, {code::kFaceTakesMore, "accept"}};
  const auto refused = readAs(ct, deface);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code.str(), "FACE_REMAINS");
  EXPECT_NE(refused.error().what.find("could not be made sure"), std::string::npos);
  EXPECT_NE(refused.error().what.find("eyes, nose and mouth"), std::string::npos);
  EXPECT_EQ(ct.report().series.front().verdict, Verdict::refused);
  EXPECT_FALSE(ct.report().chosen.has_value());
  ASSERT_NE(findingOf(ct, "FACE_REMAINS"), nullptr);
  EXPECT_EQ(findingOf(ct, "FACE_REMAINS")->severity, Severity::refusal);

  Answers keep = deface;
  keep[code::kFaceRemains] = "keep";
  const auto kept = readAs(ct, keep);
  ASSERT_TRUE(kept.ok()) << kept.error().sentence();
  EXPECT_EQ(kept->hu, head.hu);
  EXPECT_EQ(findingOf(ct, "FACE")->severity, Severity::notice);
  EXPECT_NE(findingOf(ct, "FACE")->action.find("must stay on this computer"), std::string::npos);
  EXPECT_EQ(readAs(ct, {{code::kFace, "keep"}})->hu, head.hu);
}

TEST_F(FaceSteps, AFaceOfWhichNothingCanBeRecognisedIsNotSaidToBeGone) {
  // A bandage over eyes and nose.
  Volume head = makePhantomOn(phantomTruth("cranium").value(),
                              centredGrid({128, 128, 90}, {1.6, 1.6, 2.0}), 8.0);
  for (std::size_t n = 0; n < head.hu.size(); ++n) {
    const Index3 at = head.geometry.indicesOf(n);
    const Vec3 p = head.geometry.toPatient_mm(Vec3(at[0], at[1], at[2]));
    if (p.y < -55 && p.y > -95 && p.z > -72 && p.z < -8 && std::abs(p.x) < 60) head.hu[n] = 60;
  }
  write(head);
  CtFolder ct = scan();
  ASSERT_TRUE(readAs(ct, {}).ok());
  ASSERT_EQ(asked(ct), Codes{"FACE"});
  const auto refused = readAs(ct, {{code::kFace, "deface"}});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code.str(), "FACE_REMAINS");
  EXPECT_NE(refused.error().what.find("can be recognised"), std::string::npos);
}

TEST_F(FaceSteps, ThroatAndArmsThatWouldGoAreNamedAndAskedFor) {
  const Volume head = posedHead({0, 0, true});
  write(head);
  CtFolder ct = scan();
  ASSERT_TRUE(readAs(ct, {}).ok());
  EXPECT_EQ(asked(ct), Codes{"FACE"}) << "it is asked once the face is to go";
  const auto refused = readAs(ct, {{code::kFace, "deface"}});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code.str(), "FACE_TAKES_MORE");
  EXPECT_NE(refused.error().what.find("mL of the throat"), std::string::npos);
  EXPECT_NE(refused.error().what.find("arms"), std::string::npos);
  EXPECT_NE(refused.error().what.find("bone included"), std::string::npos);
  EXPECT_EQ(asked(ct), (Codes{"FACE", "FACE_TAKES_MORE"}));

  const auto cut = readAs(ct, {{code::kFace, "deface"}, {code::kFaceTakesMore, "accept"}});
  ASSERT_TRUE(cut.ok()) << cut.error().sentence();
  EXPECT_NE(cut->hu, head.hu);
  EXPECT_NE(findingOf(ct, "FACE")->action.find("mL of the throat"), std::string::npos);
  const auto kept = readAs(ct, {{code::kFace, "deface"}, {code::kFaceTakesMore, "keep"}});
  ASSERT_TRUE(kept.ok());
  EXPECT_EQ(kept->hu, head.hu);
  EXPECT_EQ(findingOf(ct, "FACE")->severity, Severity::notice);
  EXPECT_EQ(readAs(ct, {{code::kFace, "deface"}, {code::kFaceTakesMore, "yes"}}).error().code.str(),
            "BAD_CHOICE");
}

TEST_F(FaceSteps, ACropThatLeavesTheFaceOutNeedsNoCut) {
  const Volume head = upright();
  write(head);
  CtFolder ct = scan();
  const VoxelBox shoulders{{0, 0, 0}, {200, 150, 20}};
  const auto part = readAs(ct, {{code::kFace, "deface"}}, shoulders);
  ASSERT_TRUE(part.ok()) << part.error().sentence();
  EXPECT_EQ(asked(ct), Codes{});
  EXPECT_EQ(part->hu, crop(head, shoulders)->hu);
  // To the head: then throat and shoulders do not count.
  const auto skull = readAs(ct, {{code::kFace, "deface"}}, VoxelBox{{0, 0, 75}, {200, 150, 150}});
  EXPECT_TRUE(skull.ok()) << skull.error().sentence();
  EXPECT_EQ(asked(ct), Codes{"FACE"});
}

TEST_F(FaceSteps, AFaceInTheCropIsAskedAboutThoughTheCutWouldBeElsewhere) {
  // The header turns her over: the cut would be made at the nape, which the crop leaves out.
  const Volume head = laidAs(upright(), {-1, -1, 1});
  write(head);
  CtFolder ct = scan();
  ASSERT_TRUE(readAs(ct, {}, VoxelBox{{0, 0, 0}, {200, 65, 150}}).ok());
  EXPECT_EQ(asked(ct), Codes{"FACE"});
}

}  // namespace trephine::test
