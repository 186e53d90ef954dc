// Headers that contradict themselves or their pixels, and good inputs that only look as if they
// did: the ones are asked about or said, the others read without a word.
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "imaging/codes.h"
#include "imaging/common/detail/hu_sanity_check.h"
#include "imaging/series/detail/series_geometry.h"
#include "imaging/structure_importer.h"
#include "series_fixture.h"
#include "volume/codes.h"
#include "volume/segmentation.h"
#include "volume/volume_files.h"

namespace trephine::test {
namespace {

namespace fs = std::filesystem;

// --- Stacks ---

StackInput stackAt(const std::vector<double>& places_mm, const Mat3& axes = Mat3(1.0)) {
  StackInput input{16, 16, {1.0, 1.0}, {}, {}, {}, ""};
  for (int n = 0; n < 3; ++n) {
    input.orientation[std::size_t(n)] = axes[0][n];
    input.orientation[std::size_t(n) + 3] = axes[1][n];
  }
  for (const double place : places_mm) input.positions_mm.push_back(axes[2] * place);
  return input;
}

std::string codesOf(const Stack& stack) {
  std::string codes;
  for (const Finding& finding : stack.findings) codes += finding.code.str() + " ";
  return codes;
}

TEST(StackThatLooksRounded, WholeStepsWithGapsAreMissingSlicesWhateverTheThickness) {
  std::mt19937 random(1);
  for (const double step : {1.0, 2.0, 3.0, 5.0, 0.1, 0.2, 0.3, 0.5, 0.6, 0.7}) {
    for (const double thickness : {0.0, 0.6, 1.0, 1.2, 1.25, 2.0, 2.5, 5.0}) {
      const int count = 10 + int(random() % 30), gap = 2 + int(random() % 6);
      std::vector<double> places;
      for (int n = 0; n < count; ++n) {
        if (n != gap) places.push_back(std::round(10.0 * step * n) / 10.0 - 50.0);
      }
      StackInput input = stackAt(places);
      if (thickness > 0.0) input.thickness_mm = thickness;
      const Stack stack = stackSlices(input);
      ASSERT_EQ(codesOf(stack), "MISSING_SLICES ") << step << " mm, " << thickness << " thick";
      EXPECT_NEAR(stack.geometry.spacing_mm.z, step, 1e-9);
      EXPECT_EQ(stack.findings[0].slices.size(), 1u);
      input.spacing_between_mm = step;
      EXPECT_EQ(codesOf(stackSlices(input)), "MISSING_SLICES ");
    }
  }
}

TEST(StackThatLooksRounded, WholeEvenStepsAreReadAsTheyAre) {
  for (int n = 1; n <= 40; ++n) {
    const double step = 0.1 * n;
    std::vector<double> places;
    for (int k = 0; k < 12; ++k) places.push_back(std::round(10.0 * step * k) / 10.0);
    for (const double thickness : {0.5, 0.625, 1.25, 3.0}) {
      StackInput input = stackAt(places);
      input.thickness_mm = thickness;
      EXPECT_EQ(codesOf(stackSlices(input)), "") << step << " " << thickness;
    }
  }
}

TEST(StackThatLooksRounded, AStepThatLessThanHalfOfTheIntervalsHaveIsFoundAllTheSame) {
  const Stack stack = stackSlices(stackAt({0, 4, 6, 10, 14, 16, 20}));
  EXPECT_EQ(codesOf(stack), "MISSING_SLICES ");
  EXPECT_DOUBLE_EQ(stack.geometry.spacing_mm.z, 2.0);
}

TEST(StackThatLooksRounded, RoundedStepsAreStillPutBack) {
  for (const double step : {1.25, 1.5, 2.5, 0.625, 3.75}) {
    std::vector<double> places;
    const double grid = step < 1.0 ? 0.1 : 1.0;
    for (int n = 0; n < 20; ++n) places.push_back(std::round(step * n / grid) * grid);
    StackInput input = stackAt(places);
    input.spacing_between_mm = step;
    const Stack stack = stackSlices(input);
    EXPECT_EQ(codesOf(stack), "ROUNDED_POSITIONS ") << step;
    EXPECT_NEAR(stack.geometry.spacing_mm.z, step, 1e-6);
  }
}

// Without a step that is stated many slices tell a rounding, and few leave a question; neither
// hangs on whether their number is odd.
TEST(StackThatLooksRounded, WithoutAStatedStepManySlicesTellAndFewAreAskedAbout) {
  const auto at = [](double step, double grid, int count) {
    std::vector<double> places;
    for (int n = 0; n < count; ++n) places.push_back(std::round((step * n - 70.3) / grid) * grid);
    return stackAt(places);
  };
  for (int count = 40; count < 60; ++count) {
    for (const auto& [step, grid] :
         {std::pair(1.5, 1.0), std::pair(1.25, 1.0), std::pair(2.25, 1.0), std::pair(0.75, 0.1),
          std::pair(0.7, 0.5), std::pair(0.625, 0.1)}) {
      StackInput input = at(step, grid, count);
      const Stack stack = stackSlices(input);
      EXPECT_EQ(codesOf(stack), "ROUNDED_POSITIONS ") << step << " " << count;
      EXPECT_NEAR(stack.geometry.spacing_mm.z, step, 0.01 * step);
      input.thickness_mm = step;
      EXPECT_NEAR(stackSlices(input).geometry.spacing_mm.z, step, 1e-9);
    }
  }
  for (const int count : {8, 9}) {
    const Stack asked = stackSlices(at(1.5, 1.0, count));
    ASSERT_EQ(codesOf(asked), "MISSING_SLICES ") << count;
    const auto& options = asked.choices.front().options;
    EXPECT_NE(std::ranges::find(options, "line"), options.end());
  }
}

TEST(StackThatLooksRounded, NumbersWithoutABreakLackNoSliceAndThickStepsAreNoLine) {
  std::vector<double> places;
  for (int n = 0; n < 16; ++n) places.push_back(std::round(1.25 * n));
  StackInput input = stackAt(places);
  input.thickness_mm = 1.25;
  EXPECT_EQ(codesOf(stackSlices(input)), "MISSING_SLICES ");
  input.numbered_on = true;
  EXPECT_EQ(codesOf(stackSlices(input)), "ROUNDED_POSITIONS ");
  places.clear();
  for (int n = 0; n < 17; ++n) {
    if (n != 9) places.push_back(n);
  }
  input = stackAt(places);
  input.thickness_mm = 1.0;
  const Stack gap = stackSlices(input);
  ASSERT_EQ(codesOf(gap), "MISSING_SLICES ");
  EXPECT_EQ(gap.findings[0].text.find("Either"), std::string::npos);
  const auto& options = gap.choices.front().options;
  EXPECT_EQ(std::ranges::find(options, "line"), options.end());
}

// GE's overlapped reconstruction: slices of 1.25 mm every 1 mm.
TEST(StackThatLooksRounded, AGapIsNoRoundingToTheThickness) {
  for (int gap = 1; gap < 7; ++gap) {
    std::vector<double> places;
    for (int n = 0; n < 8; ++n) {
      if (n != gap) places.push_back(n);
    }
    StackInput input = stackAt(places);
    input.thickness_mm = 1.25;
    EXPECT_EQ(codesOf(stackSlices(input)), "MISSING_SLICES ") << gap;
  }
}

TEST(StackThatLooksUneven, StepsOfTwoDecimalsAreEvenWhereverTheyBegin) {
  for (const double begin : {0.0, -123.37, 17.21, 1000.01}) {
    std::vector<double> places;
    for (int n = 0; n < 100; ++n) {
      places.push_back(std::round(100.0 * (begin + 2.0 / 3.0 * n)) / 100.0);
    }
    EXPECT_EQ(codesOf(stackSlices(stackAt(places))), "") << begin;
  }
}

TEST(StackThatLooksTilted, ObliqueRowsAreNoTilt) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int n = 0; n < 60; ++n) {
    const Mat3 axes = glm::mat3_cast(
        glm::normalize(Quat(1.5 + any(random), any(random), any(random), any(random))));
    std::vector<double> places;
    const double step = 0.5 + 0.1 * (n % 20);
    for (int k = 0; k < 10; ++k) places.push_back(step * k);
    const Stack stack = stackSlices(stackAt(places, axes));
    EXPECT_EQ(codesOf(stack), "");
    EXPECT_NEAR(stack.tilt_deg, 0.0, 1e-4);
  }
}

TEST(StackThatLooksFullOfGaps, ThinStacksAndWideStepsAreEven) {
  for (int count = 2; count < 12; ++count) {
    for (const double step : {0.2, 0.3333, 0.625, 0.7, 1.25, 3.27, 7.5}) {
      std::vector<double> places;
      for (int k = 0; k < count; ++k) places.push_back(12.345 + step * k);
      EXPECT_EQ(codesOf(stackSlices(stackAt(places))), "") << count << " of " << step;
    }
  }
}

TEST(ValuesThatLookStored, CtOfLittleAirIsCt) {
  std::mt19937 random(3);
  for (int n = 0; n < 40; ++n) {
    // Fat, muscle, organ and bone, and next to no air.
    std::vector<std::int16_t> hu;
    const double fat = -105.0 + random() % 20, organ = 40.0 + random() % 60;
    std::normal_distribution<double> noise(0.0, 8.0 + n % 10);
    for (int voxel = 0; voxel < 20000; ++voxel) {
      const unsigned kind = random() % 100;
      const double mean = kind < 35 ? fat : kind < 85 ? organ : kind < 97 ? 50.0 : 600.0;
      hu.push_back(std::int16_t(std::lround(mean + noise(random))));
    }
    HuSanityCheck look;
    look.add(hu);
    const auto [low, high] = std::ranges::minmax(hu);
    EXPECT_TRUE(look.doubts(low, high).empty()) << look.doubts(low, high).front();
  }
}

// Air, fat, organs and bone of `count` voxels, with noise.
std::vector<std::int16_t> patientLike(std::mt19937& random, double air, int count = 30000) {
  std::vector<std::int16_t> hu;
  std::normal_distribution<double> noise(0.0, 12.0);
  std::uniform_real_distribution<double> share(0.0, 1.0), bone(250.0, 1600.0);
  for (int n = 0; n < count; ++n) {
    const double at = share(random);
    const double mean = at < air                        ? -1000.0
                        : at < air + 0.3 * (1.0 - air)  ? -100.0
                        : at < air + 0.92 * (1.0 - air) ? 45.0
                                                        : bone(random);
    hu.push_back(std::int16_t(std::lround(std::max(-1024.0, mean + noise(random)))));
  }
  return hu;
}

std::vector<std::string> doubtsOf(const std::vector<std::int16_t>& hu) {
  HuSanityCheck look;
  look.add(hu);
  const auto [low, high] = std::ranges::minmax(hu);
  return look.doubts(low, high);
}

TEST(ValuesThatAreNoHu, OfAnInterceptThatWasAppliedTwiceOrNeverOrOfAWindowAreDoubted) {
  std::mt19937 random(9);
  for (int n = 0; n < 20; ++n) {
    const std::vector<std::int16_t> truth = patientLike(random, 0.3 + 0.02 * n);
    EXPECT_TRUE(doubtsOf(truth).empty()) << doubtsOf(truth).front();
    const auto changed = [&](auto change) {
      std::vector<std::int16_t> hu = truth;
      for (std::int16_t& value : hu) value = std::int16_t(change(value));
      const auto doubts = doubtsOf(hu);
      return doubts.empty() ? std::string() : doubts.front();
    };
    EXPECT_NE(changed([](int hu) { return hu - 1024; }).find("twice"), std::string::npos);
    EXPECT_NE(changed([](int hu) { return std::min(hu, 900) - 1024; }).find("twice"),
              std::string::npos);
    EXPECT_NE(changed([](int hu) { return hu + 1024; }).find("without their intercept"),
              std::string::npos);
    EXPECT_NE(changed([](int hu) { return std::clamp(hu, -160, 240); }).find("window"),
              std::string::npos);
  }
}

TEST(ValuesThatLookStored, CropsOfAHeadOrALungAreCt) {
  std::mt19937 random(10);
  std::normal_distribution<double> noise(0.0, 10.0);
  std::uniform_real_distribution<double> share(0.0, 1.0), bone(300.0, 1800.0);
  for (int n = 0; n < 20; ++n) {
    std::vector<std::int16_t> head, lung;
    for (int voxel = 0; voxel < 20000; ++voxel) {
      const double at = share(random);
      head.push_back(std::int16_t(
          std::lround(std::max(1.0, (at < 0.3 + 0.02 * n ? bone(random) : 35.0) + noise(random)))));
      lung.push_back(
          std::int16_t(std::lround((at < 0.03 + 0.01 * n ? 40.0 : -860.0) + 3.0 * noise(random))));
    }
    EXPECT_TRUE(doubtsOf(head).empty()) << doubtsOf(head).front();
    std::vector<std::int16_t> dry = lung;
    for (std::int16_t& hu : dry) hu = std::int16_t(hu < -400 ? hu - 140 : hu + 800);
    EXPECT_TRUE(doubtsOf(dry).empty()) << doubtsOf(dry).front();
    EXPECT_TRUE(doubtsOf(lung).empty()) << doubtsOf(lung).front();
  }
}

// --- NIfTI ---

// What a header says, in its own RAS.
struct Nifti {
  Index3 size{8, 6, 5};
  std::optional<Mat4> sform,
      qform;  // a qform is a rotation by steps, its third axis mirrored or not
  Vec3 pixdim{1.0};
  bool labels = false;
};

std::string niftiBytes(const Nifti& of) {
  std::string bytes(352, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  };
  put(0, std::int32_t(348));
  const std::int16_t dims[] = {3, std::int16_t(of.size[0]), std::int16_t(of.size[1]),
                               std::int16_t(of.size[2])};
  for (std::size_t n = 0; n < 4; ++n) put(40 + 2 * n, dims[n]);
  put(70, std::int16_t(of.labels ? 2 : 4));
  put(72, std::int16_t(of.labels ? 8 : 16));
  put(76, 1.0f);
  for (int axis = 0; axis < 3; ++axis) put(80 + 4 * std::size_t(axis), float(of.pixdim[axis]));
  put(108, 352.0f);
  put(123, std::uint8_t(2));
  if (of.sform) {
    put(254, std::int16_t(1));
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        put(280 + std::size_t(16 * row + 4 * column), float((*of.sform)[column][row]));
      }
    }
  }
  if (of.qform) {
    put(252, std::int16_t(1));
    Mat3 rotation;
    for (int axis = 0; axis < 3; ++axis) rotation[axis] = glm::normalize(Vec3((*of.qform)[axis]));
    if (glm::determinant(rotation) < 0.0) {
      rotation[2] = -rotation[2];
      put(76, -1.0f);
    }
    Quat q = glm::quat_cast(rotation);
    if (q.w < 0.0) q = -q;
    put(256, float(q.x));
    put(260, float(q.y));
    put(264, float(q.z));
    for (int axis = 0; axis < 3; ++axis) {
      put(268 + 4 * std::size_t(axis), float((*of.qform)[3][axis]));
    }
  }
  bytes[344] = 'n';
  bytes[345] = '+';
  bytes[346] = '1';
  const int voxels = of.size[0] * of.size[1] * of.size[2];
  for (int n = 0; n < voxels; ++n) {
    if (of.labels) {
      bytes += char(n % 3);
    } else {
      const auto hu = std::int16_t(n % 7 == 0 ? -1000 : n % 200);
      bytes.append(reinterpret_cast<const char*>(&hu), 2);
    }
  }
  return bytes;
}

Mat4 anyAffine(std::mt19937& random, Vec3& steps) {
  std::uniform_real_distribution<double> any(-1.0, 1.0), step(0.4, 5.0);
  steps = Vec3(step(random), step(random), step(random));
  // As scanners write them: nearly along the patient's axes, or askew.
  const double skew = random() % 3 == 0 ? 1.0 : 0.05;
  const Mat3 turn = glm::mat3_cast(
      glm::normalize(Quat(1.2, skew * any(random), skew * any(random), skew * any(random))));
  Mat4 affine(1.0);
  for (int axis = 0; axis < 3; ++axis) affine[axis] = glm::dvec4(turn[axis] * steps[axis], 0.0);
  affine[3] = glm::dvec4(200.0 * any(random), 200.0 * any(random), 400.0 * any(random), 1.0);
  if (random() % 2 == 0) affine[2] = -affine[2];
  return affine;
}

class NiftiForms : public SeriesFixture {
 protected:
  void writeCt(const Nifti& of) { writeBytes(folder() / "ct.nii", niftiBytes(of)); }
  SeriesReport scanned(const Answers& answers = {}) {
    CtFolder ct = scan();
    if (!answers.empty()) {
      ImportRequest request;
      request.answers = answers;
      (void)ct.read(ct.report().series.front().uid, request, Progress());
    }
    return ct.report().series.front();
  }
};

TEST_F(NiftiForms, EqualOnesAreReadAndContradictingOnesAskedAbout) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int equal = 0, contradicting = 0;
  for (int n = 0; n < 300; ++n) {
    SCOPED_TRACE(n);
    Nifti of;
    const Mat4 truth = anyAffine(random, of.pixdim);
    of.sform = truth;
    if (n % 5 != 4) of.qform = truth;  // else the sform and pixdim alone
    const int kind = n % 3;
    if (kind == 1) {  // what floats and short decimals leave
      for (int row = 0; row < 3; ++row) (*of.sform)[3][row] += 0.005 * any(random);
    }
    if (kind == 2) {
      const int axis = int(random() % 3);
      switch (of.qform ? n / 3 % 3 : 0) {
        case 0:
          (*of.sform)[axis] *= 1.0 + (random() % 2 ? 0.2 : 1.0 / 3.0);
          break;
        case 1:
          (*of.sform)[3] +=
              glm::dvec4(glm::normalize(Vec3(truth[axis])) * (of.pixdim[axis] + 3.0), 0.0);
          break;
        default:
          (*of.sform)[0] = -(*of.sform)[0];
          break;
      }
    }
    writeCt(of);
    const SeriesReport report = scanned();
    Nifti labels = of;
    labels.labels = true;
    writeBytes(temporary_ / "labels.nii", niftiBytes(labels));
    const auto segmentation = readSegmentation(temporary_ / "labels.nii");
    if (kind < 2) {
      ++equal;
      EXPECT_EQ(report.verdict, Verdict::pass) << codes(report);
      EXPECT_EQ(find(report, "FORMS_DIFFER"), nullptr);
      EXPECT_TRUE(segmentation.ok());
      continue;
    }
    ++contradicting;
    ASSERT_EQ(report.verdict, Verdict::refused);
    const std::string other = of.qform ? "qform" : "pixdim";
    ASSERT_EQ(report.choices.size(), 1u);
    EXPECT_EQ(report.choices[0].options, (std::vector<std::string>{"refuse", "sform", other}));
    const Finding& said = *find(report, "FORMS_DIFFER");
    EXPECT_NE(said.text.find("sform and " + other), std::string::npos) << said.text;
    ASSERT_FALSE(segmentation.ok());
    EXPECT_EQ(segmentation.error().code.str(), "FORMS_DIFFER");
    for (const std::string& form : {std::string("sform"), other}) {
      const SeriesReport read = scanned({{code::kFormsDiffer, form}});
      EXPECT_EQ(read.verdict, Verdict::repaired) << codes(read);
      EXPECT_NE(find(read, "FORMS_DIFFER")->action.find(form), std::string::npos);
      const Mat4& is = form == "qform" ? *of.qform : *of.sform;
      for (int axis = 0; axis < 3; ++axis) {
        const double step = form == "sform" ? glm::length(Vec3(is[axis])) : of.pixdim[axis];
        EXPECT_NEAR(read.geometry.spacing_mm[axis], step, 1e-4);
      }
      EXPECT_TRUE(readSegmentation(temporary_ / "labels.nii", Progress(), form).ok());
    }
  }
  EXPECT_EQ(equal, 200);
  EXPECT_EQ(contradicting, 100);
}

// b, c and d of a half turn leave a tenth of a degree open, as floats are rounded.
TEST_F(NiftiForms, EqualOnesNearAHalfTurnAreReadHoweverLargeTheImage) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int n = 0; n < 60; ++n) {
    Nifti of;
    of.size = {1024, 2, 900};
    of.pixdim = Vec3(0.3, 0.3, 0.5);
    const double tilt = glm::radians(n % 3 == 0 ? 0.03 : n % 3 == 1 ? 0.3 : 1.0);
    const Vec3 axis = glm::normalize(Vec3(any(random), any(random), any(random)));
    const Mat3 turn = glm::mat3_cast(glm::angleAxis(tilt, axis));
    Mat4 affine(1.0);
    for (int a = 0; a < 3; ++a) {
      const double sign = a == 0 || (a == 1 && n % 2 == 0) ? -1.0 : 1.0;
      affine[a] = glm::dvec4(turn[a] * (sign * of.pixdim[a]), 0.0);
    }
    affine[3] = glm::dvec4(150.0, -180.0, 20.0, 1.0);
    of.sform = of.qform = affine;
    writeCt(of);
    EXPECT_EQ(codes(scanned()).find("FORMS_DIFFER"), std::string::npos) << n;
  }
}

TEST_F(NiftiForms, StepsHaveNoSign) {
  Nifti of;
  of.pixdim = Vec3(1.0, 2.0, 3.0);
  Mat4 affine(1.0);
  for (int a = 0; a < 3; ++a) affine[a] *= of.pixdim[a];
  of.qform = affine;
  writeCt(of);
  const Result<Volume> plain = readVolume(folder() / "ct.nii");
  of.pixdim.y = -2.0;
  writeCt(of);
  const Result<Volume> negative = readVolume(folder() / "ct.nii");
  ASSERT_TRUE(plain.ok() && negative.ok());
  EXPECT_EQ(negative->geometry.voxelToPatient(), plain->geometry.voxelToPatient());
}

TEST_F(NiftiForms, ALabelMapOfAnotherOrderOfVoxelsTakesTheFormOnTheCtAsWell) {
  Nifti of;
  of.pixdim = Vec3(1.0, 2.0, 3.0);
  Mat4 affine(1.0);
  for (int a = 0; a < 3; ++a) affine[a] *= of.pixdim[a];
  of.sform = of.qform = affine;
  writeCt(of);
  const Result<Volume> ct = readVolume(folder() / "ct.nii");
  of.labels = true;
  (*of.sform)[3].y += (of.size[1] - 1) * of.pixdim.y;
  (*of.sform)[1].y *= -1.0;  // rows counted from the other end
  *of.qform = *of.sform;
  (*of.qform)[3].x += 30.0;
  writeBytes(temporary_ / "labels.nii", niftiBytes(of));
  const auto fit = importStructures(temporary_ / "labels.nii", *ct);
  ASSERT_TRUE(fit.ok()) << fit.error().sentence();
  const auto said = std::ranges::find(fit->findings, code::kFormsDiffer, &Finding::code);
  ASSERT_NE(said, fit->findings.end());
  EXPECT_NE(said->action.find("sform"), std::string::npos);
}

TEST_F(NiftiForms, ALabelMapTakesTheFormThatPutsItOnTheCt) {
  std::mt19937 random(5);
  for (int n = 0; n < 20; ++n) {
    Nifti of;
    const Mat4 truth = anyAffine(random, of.pixdim);
    of.sform = of.qform = truth;
    writeCt(of);
    const Result<Volume> ct = readVolume(folder() / "ct.nii");
    ASSERT_TRUE(ct.ok()) << ct.error().sentence();
    of.labels = true;
    (*of.sform)[2] *= 4.0 / 3.0;
    writeBytes(temporary_ / "labels.nii", niftiBytes(of));
    StructureRequest request;
    request.ask_all = false;
    const auto fit = importStructures(temporary_ / "labels.nii", *ct, request);
    ASSERT_TRUE(fit.ok()) << fit.error().sentence();
    EXPECT_FALSE(fit->resampled);
    const auto said = std::ranges::find(fit->findings, code::kFormsDiffer, &Finding::code);
    ASSERT_NE(said, fit->findings.end());
    EXPECT_NE(said->action.find("qform"), std::string::npos);
  }
}

TEST_F(NiftiForms, OneThatSaysNothingOfItsPlaceAndHasTheCtsSizeIsAskedAbout) {
  std::mt19937 random(6);
  for (int n = 0; n < 5; ++n) {
    Nifti of;
    of.size = {8 + n, 6, 5};
    of.sform = of.qform = anyAffine(random, of.pixdim);
    writeCt(of);
    const Result<Volume> ct = readVolume(folder() / "ct.nii");
    ASSERT_TRUE(ct.ok());
    of.labels = true;
    // In steps of 1 mm or the CT's.
    if (n % 2 == 0) of.pixdim = Vec3(1.0);
    of.sform = of.qform = glm::scale(Mat4(1.0), of.pixdim);
    writeBytes(temporary_ / "labels.nii", niftiBytes(of));
    EXPECT_EQ(importStructures(temporary_ / "labels.nii", *ct).error().code.str(), "NO_AFFINE");
    StructureRequest request;
    request.answers = {{code::kNoAffine, "ct"}};
    const auto fit = importStructures(temporary_ / "labels.nii", *ct, request);
    ASSERT_TRUE(fit.ok()) << fit.error().sentence();
    EXPECT_FALSE(fit->resampled);
    EXPECT_DOUBLE_EQ(fit->covers_percent, 100.0);
  }
}

// A CT whose first voxel lies a whole number of its steps from 0.
TEST_F(NiftiForms, OneThatSaysNothingOfItsPlaceIsAskedAboutOnWholeStepsToo) {
  for (const Vec3& origin : {Vec3(-10, -10, -20), Vec3(0, 0, 30), Vec3(-8, 4, 0)}) {
    Nifti of;
    of.size = {8, 8, 8};
    of.pixdim = Vec3(2.0);
    const Mat4 here = glm::scale(Mat4(1.0), of.pixdim);
    of.sform = of.qform = here;
    (*of.sform)[3] = glm::dvec4(origin, 1.0);
    of.qform = of.sform;
    writeCt(of);
    const Result<Volume> ct = readVolume(folder() / "ct.nii");
    ASSERT_TRUE(ct.ok());
    of.labels = true;
    of.sform = of.qform = here;
    writeBytes(temporary_ / "labels.nii", niftiBytes(of));
    EXPECT_EQ(importStructures(temporary_ / "labels.nii", *ct).error().code.str(), "NO_AFFINE");
  }
}

// --- Volume files ---

// A header's numbers are the file's own, and voxels are what lies behind it.
TEST_F(NiftiForms, AFileThatIsLongerThanItsHeaderSaysIsRefused) {
  Nifti of;
  of.sform = of.qform = Mat4(1.0);
  of.pixdim = Vec3(1.0);
  writeCt(of);
  const std::string whole = readBytes(folder() / "ct.nii");
  const Volume right = import();
  for (const int more : {1, 2, 35, 352, 4096}) {
    const std::string longer = whole + std::string(std::size_t(more), '\1');
    for (const bool packed : {false, true}) {
      fs::remove_all(folder());
      fs::create_directories(folder());
      writeBytes(folder() / (packed ? "ct.nii.gz" : "ct.nii"),
                 packed ? packedBy(Deflate::gzip, longer) : longer);
      const CtFolder ct = scan();
      const Error why = refusal();
      EXPECT_EQ(why.code.str(), "UNREADABLE") << more;
      EXPECT_NE(why.what.find("longer than its header says"), std::string::npos) << why.what;
    }
  }
  // Bytes behind a gzip stream are none of it.
  fs::remove_all(folder());
  fs::create_directories(folder());
  writeBytes(folder() / "ct.nii.gz", packedBy(Deflate::gzip, whole) + std::string(512, '\0'));
  EXPECT_EQ(import().hu, right.hu);
  // The four bytes behind the header, which some writers do not count.
  for (const float offset : {0.0F, 348.0F, 352.0F}) {
    std::string bytes = whole;
    std::memcpy(bytes.data() + 108, &offset, sizeof offset);
    fs::remove_all(folder());
    fs::create_directories(folder());
    writeBytes(folder() / "ct.nii", bytes);
    EXPECT_EQ(import().hu, right.hu) << offset;
  }
}

TEST_F(NiftiForms, AWrongByteOrderIsDoubtedAndAsksNoOther) {
  std::mt19937 random(9);
  for (int n = 0; n < 20; ++n) {
    // A smooth body in air, with noise.
    Volume volume;
    volume.geometry.size = {20, 18, 8};
    const int noise = 1 + n;
    for (std::size_t at = 0; at < volume.geometry.voxelCount(); ++at) {
      const int x = int(at % 20), y = int(at / 20 % 18);
      const bool body = (x - 10) * (x - 10) + (y - 9) * (y - 9) < 30 + n;
      volume.hu.push_back(std::int16_t((body ? 40 : -1000) + int(random() % unsigned(noise))));
    }
    fs::create_directories(folder());
    ASSERT_TRUE(writeVolume(volume, folder() / "ct.nii"));
    EXPECT_EQ(import().hu, volume.hu) << noise;
    EXPECT_EQ(find(chosen(), "IMPLAUSIBLE_HU"), nullptr);
    std::string bytes = readBytes(folder() / "ct.nii");
    for (std::size_t at = 352; at < bytes.size(); at += 2) std::swap(bytes[at], bytes[at + 1]);
    writeBytes(folder() / "ct.nii", bytes);
    scan();
    const Error why = refusal();
    EXPECT_EQ(why.code.str(), "IMPLAUSIBLE_HU");
    EXPECT_NE(why.what.find("byte order"), std::string::npos) << why.what;
  }
}

// A wide scan whose first rows are of one value, as around a round field.
TEST_F(NiftiForms, AWrongByteOrderIsDoubtedWhereverTheBodyLies) {
  for (const int around : {-1024, -1000, -2000, -3024, 0}) {
    Volume volume;
    volume.geometry.size = {256, 256, 4};
    std::mt19937 random(11);
    for (std::size_t at = 0; at < volume.geometry.voxelCount(); ++at) {
      const int x = int(at % 256) - 128, y = int(at / 256 % 256) - 128, square = x * x + y * y;
      volume.hu.push_back(std::int16_t(square > 15000  ? around
                                       : square > 6000 ? -1000 + int(random() % 30)
                                                       : 40 + int(random() % 30)));
    }
    fs::create_directories(folder());
    ASSERT_TRUE(writeVolume(volume, folder() / "ct.nii"));
    std::string bytes = readBytes(folder() / "ct.nii");
    for (std::size_t at = 352; at < bytes.size(); at += 2) std::swap(bytes[at], bytes[at + 1]);
    writeBytes(folder() / "ct.nii", bytes);
    EXPECT_EQ(refusal().code.str(), "IMPLAUSIBLE_HU") << around;
  }
  // A phantom without noise, in steps of 256.
  Volume phantom;
  phantom.geometry.size = {32, 32, 8};
  for (std::size_t at = 0; at < phantom.geometry.voxelCount(); ++at) {
    const int x = int(at % 32) - 16, y = int(at / 32 % 32) - 16, square = x * x + y * y;
    phantom.hu.push_back(std::int16_t(square > 200 ? -1024 : square > 50 ? 0 : 512));
  }
  ASSERT_TRUE(writeVolume(phantom, folder() / "ct.nii"));
  scan();
  EXPECT_EQ(import().hu, phantom.hu);
}

TEST_F(NiftiForms, AHeaderIsNeverReadAsVoxels) {
  const Volume volume = rampVolume({20, 20, 10});
  fs::create_directories(folder());
  ASSERT_TRUE(writeVolume(volume, folder() / "ct.mha"));
  std::string bytes = readBytes(folder() / "ct.mha");
  const std::size_t at = bytes.find("ElementDataFile");
  ASSERT_NE(at, bytes.npos);
  bytes.insert(at, "HeaderSize = -1\n");
  writeBytes(folder() / "ct.mha", bytes);
  EXPECT_EQ(import().hu, volume.hu);
  for (const std::size_t cut : {1, 2, 100, 200}) {
    writeBytes(folder() / "ct.mha", bytes.substr(0, bytes.size() - cut));
    EXPECT_EQ(refusal().code.str(), "UNREADABLE") << cut;
  }
}

TEST_F(NiftiForms, ALabelMapOfTheWrongByteOrderIsRefused) {
  Nifti of;
  of.sform = of.qform = Mat4(1.0);
  of.pixdim = Vec3(1.0);
  writeCt(of);
  const Result<Volume> ct = readVolume(folder() / "ct.nii");
  ASSERT_TRUE(ct.ok());
  Volume labels = *ct;
  for (std::size_t n = 0; n < labels.hu.size(); ++n) labels.hu[n] = n % 7 < 3 ? 5 * 256 : 0;
  ASSERT_TRUE(writeVolume(labels, temporary_ / "labels.nii"));
  const auto fit = importStructures(temporary_ / "labels.nii", *ct);
  ASSERT_FALSE(fit.ok());
  EXPECT_NE(fit.error().what.find("another order"), std::string::npos) << fit.error().sentence();
}

TEST_F(NiftiForms, MicrometresAreNoHospitalsCt) {
  Nifti of;
  of.pixdim = Vec3(0.0015);
  of.sform = of.qform = glm::scale(Mat4(1.0), of.pixdim);
  writeCt(of);
  EXPECT_EQ(refusal().code.str(), "BAD_GEOMETRY");
}

TEST_F(NiftiForms, WhatStandsAroundTheScanBecomesAirAndStreaksOfMetalDoNot) {
  std::mt19937 random(7);
  for (const int padding : {-3024, -2048, -2000, -1500, -32768}) {
    Volume volume = rampVolume({16, 16, 8});
    for (std::size_t n = 0; n < volume.hu.size(); ++n) {
      volume.hu[n] = std::int16_t(n % 5 == 0 ? padding : n % 3 == 0 ? -1000 : 40);
    }
    fs::create_directories(folder());
    ASSERT_TRUE(writeVolume(volume, folder() / "ct.nii"));
    const Volume read = import();
    EXPECT_EQ(*std::ranges::min_element(read.hu), -1000) << padding;
    EXPECT_NE(find(chosen(), "PADDING_TO_AIR"), nullptr);
    EXPECT_EQ(chosen().verdict, Verdict::pass);
  }
  for (int n = 0; n < 20; ++n) {
    Volume volume = rampVolume({16, 16, 8});
    for (std::size_t at = 0; at < volume.hu.size(); ++at) {
      volume.hu[at] = std::int16_t(at % 50 == 0 ? -1110 - int(random() % 900)
                                   : at % 3     ? 40
                                                : -1000);
    }
    ASSERT_TRUE(writeVolume(volume, folder() / "ct.nii"));
    const Volume read = import();
    EXPECT_EQ(std::vector(read.hu.begin(), read.hu.end()),
              std::vector(volume.hu.begin(), volume.hu.end()));
  }
}

// --- DICOM ---

class HeadersDisagree : public SeriesFixture {
 protected:
  void writeSlices(int bits_stored, E_TransferSyntax syntax = EXS_LittleEndianExplicit,
                   int edge = 7) {
    for (int k = 0; k < 6; ++k) {
      Image image;
      image.columns = image.rows = edge;
      image.position_mm.z = 100.0 + 2.0 * k;
      image.instance = k + 1;
      fillPattern(image, k);
      DcmDataset data = makeImage(image);
      data.putAndInsertUint16(DCM_BitsStored, Uint16(bits_stored));
      data.putAndInsertUint16(DCM_HighBit, Uint16(bits_stored - 1));
      Packing packing;
      packing.syntax = syntax;
      add(data, packing);
    }
  }
  std::vector<std::vector<std::int16_t>> slices_[2];
};

TEST_F(HeadersDisagree, BitsOfTheCodestreamAreTakenWhereNoSignAndNoOverlayLiesInThem) {
  constexpr E_TransferSyntax kSyntax = EXS_JPEG2000LosslessOnly;
  const auto says12 = [](DcmDataset& data) {
    data.putAndInsertUint16(DCM_BitsStored, 12);
    data.putAndInsertUint16(DCM_HighBit, 11);
  };
  writeSlices(14, kSyntax, 32);
  const Volume truth = import();
  editAll(says12, kSyntax);
  EXPECT_EQ(import().hu, truth.hu);
  EXPECT_NE(find(chosen(), "BITS_STORED"), nullptr) << codes(chosen());
  editAll([](DcmDataset& data) { data.putAndInsertUint16(DCM_PixelRepresentation, 1); }, kSyntax);
  EXPECT_EQ(find(scan().report().series.front(), "BITS_STORED"), nullptr) << "signs above 12 bits";
  fs::remove_all(folder());
  writeSlices(14, kSyntax, 32);
  editAll(
      [&](DcmDataset& data) {
        says12(data);
        data.putAndInsertUint16(DcmTagKey(0x6000, 0x0100), 16);
        data.putAndInsertUint16(DcmTagKey(0x6000, 0x0102), 12);
      },
      kSyntax);
  EXPECT_EQ(find(scan().report().series.front(), "BITS_STORED"), nullptr) << "an overlay";
}

TEST_F(HeadersDisagree, SlicesThatRoundingPutTogetherStayInTheOrderOfTheScan) {
  for (const bool up : {true, false}) {
    fs::remove_all(folder());
    constexpr int kCount = 20;
    for (int k = 0; k < kCount; ++k) {
      Image image;
      const double z = std::nearbyint(100.0 + 0.5 * k);
      image.position_mm.z = z;
      image.instance = up ? k + 1 : kCount - k;
      fillPattern(image, k);
      DcmDataset data = makeImage(image);
      put(data, DCM_SliceLocation, std::to_string(int(z)));
      put(data, DCM_SpacingBetweenSlices, "0.5");
      put(data, DCM_SliceThickness, "0.5");
      add(data);
    }
    const Volume volume = import();
    ASSERT_EQ(volume.geometry.size[2], kCount);
    for (int k = 0; k < kCount; ++k) {
      const auto from = volume.hu.begin() + std::ptrdiff_t(volume.geometry.indexOf(0, 0, k));
      std::vector<std::int16_t> slice(from,
                                      from + volume.geometry.size[0] * volume.geometry.size[1]);
      slices_[up].push_back(std::move(slice));
    }
  }
  EXPECT_EQ(slices_[0], slices_[1]);
  EXPECT_NE(slices_[0][0], slices_[0][1]);
}

TEST_F(HeadersDisagree, BitsBeyondThoseThatTheHeaderSaysAreAskedAbout) {
  writeSlices(12);
  const Volume truth = import();
  fs::remove_all(folder());
  for (const int bits : {8, 9, 10, 11}) {
    writeSlices(bits, EXS_RLELossless);
    EXPECT_EQ(refusal().code.str(), "HIGH_BITS") << bits;
    const Volume whole = import({{code::kHighBits, "use"}});
    EXPECT_EQ(whole.hu, truth.hu);
    EXPECT_EQ(chosen().verdict, Verdict::repaired);
    const Volume masked = import({{code::kHighBits, "mask"}});
    EXPECT_NE(masked.hu, truth.hu);
    fs::remove_all(folder());
    // Uncompressed words are masked, as the standard has it.
    writeSlices(bits);
    EXPECT_EQ(import().hu, masked.hu);
    fs::remove_all(folder());
  }
}

TEST_F(HeadersDisagree, AnOverlayInTheHighBitsIsMaskedWithoutAWord) {
  writeSlices(12);
  const Volume truth = import();
  editAll([](DcmDataset& data) {
    data.putAndInsertUint16(DcmTagKey(0x6000, 0x0100), 16);
    data.putAndInsertUint16(DcmTagKey(0x6000, 0x0102), 12);
    Uint16* words = nullptr;
    unsigned long count = 0;
    ASSERT_TRUE(data.findAndGetUint16Array(DCM_PixelData, const_cast<const Uint16*&>(words), &count)
                    .good());
    std::vector<Uint16> marked(words, words + count);
    for (std::size_t n = 0; n < marked.size(); n += 3) marked[n] = Uint16(marked[n] | 0x1000);
    data.putAndInsertUint16Array(DCM_PixelData, marked.data(), count);
  });
  EXPECT_EQ(import().hu, truth.hu);
  EXPECT_EQ(chosen().verdict, Verdict::pass);
}

TEST_F(HeadersDisagree, WhatStandsAroundTheScanBecomesAirInDicomToo) {
  for (const int padding : {-3024, -2048, -2000}) {
    fs::remove_all(folder());
    Volume volume = rampVolume({16, 16, 8});
    for (std::size_t n = 0; n < volume.hu.size(); ++n) {
      volume.hu[n] = std::int16_t(n % 5 == 0 ? padding : n % 3 == 0 ? -1000 : 40);
    }
    write(volume);
    const Volume read = import();
    EXPECT_EQ(*std::ranges::min_element(read.hu), -1000) << padding;
    EXPECT_NE(find(chosen(), "PADDING_TO_AIR"), nullptr) << codes(chosen());
    EXPECT_EQ(chosen().verdict, Verdict::pass);
    EXPECT_EQ(chosen().hu_min, -1000);
  }
}

TEST_F(HeadersDisagree, EmptyFilesBesideASeriesAreNotedAsWhatMayBeMissing) {
  write(rampVolume({7, 5, 8}));
  writeBytes(slice(8), "");
  const CtFolder ct = scan();
  ASSERT_NE(find(ct.report().series.front(), "INCOMPLETE"), nullptr);
  EXPECT_NE(find(ct.report().series.front(), "INCOMPLETE")->text.find("1 file lies beside"),
            std::string::npos);
  EXPECT_EQ(ct.report().series.front().verdict, Verdict::pass);
  // One that lies elsewhere is none of it.
  fs::remove(slice(8));
  writeBytes(folder() / "other" / "notes.txt", "");
  EXPECT_EQ(find(scan().report().series.front(), "INCOMPLETE"), nullptr);
}

TEST_F(HeadersDisagree, SlicesAtOnePlaceAreOfferedByTheirLocation) {
  writeSlices(12);
  const Volume truth = import();
  editAll([](DcmDataset& data) {
    const std::vector<double> at{-20.0, 10.5, 100.0};
    double z = 0.0;
    data.findAndGetFloat64(DCM_ImagePositionPatient, z, 2);
    OFString position;
    data.findAndGetOFStringArray(DCM_ImagePositionPatient, position);
    const std::string text = position.c_str();
    put(data, DCM_SliceLocation, text.substr(text.rfind('\\') + 1));
    put(data, DCM_ImagePositionPatient, "-20\\10.5\\100");
  });
  EXPECT_EQ(expectRefused("ONE_LOCATION").slices.size(), 1u);
  const Volume read = import({{code::kOneLocation, "locations"}});
  EXPECT_EQ(read.hu, truth.hu);
  EXPECT_NEAR(read.geometry.spacing_mm.z, 2.0, 1e-9);
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
}

TEST_F(HeadersDisagree, SlopesOfAnotherSignAreAskedAbout) {
  writeSlices(12);
  int slices = 0;
  editAll([&](DcmDataset& data) {
    if (++slices == 3) put(data, DCM_RescaleSlope, "-1");
  });
  EXPECT_EQ(expectRefused("SLOPES_DIFFER").slices.size(), 1u);
  import({{ code::kSlopesDiffer, "accept" }});
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
}

TEST_F(HeadersDisagree, ANegativeSlopeIsSaid) {
  write(rampVolume({7, 5, 6}));
  EXPECT_EQ(find(scan().report().series.front(), "NEGATIVE_SLOPE"), nullptr);
  editAll([](DcmDataset& data) {
    put(data, DCM_RescaleSlope, "-1");
    put(data, DCM_RescaleIntercept, "1024");
  });
  const CtFolder ct = scan();
  EXPECT_NE(find(ct.report().series.front(), "NEGATIVE_SLOPE"), nullptr);
}

TEST_F(HeadersDisagree, ScansOfTwoDaysArePartsAndOneThatGoesOnPastMidnightIsNone) {
  const auto dated = [&](const char* second_day, const char* first_time, const char* second_time) {
    fs::remove_all(folder());
    writeSlices(12);
    editAll([&](DcmDataset& data) {
      OFString number;
      data.findAndGetOFString(DCM_InstanceNumber, number);
      const bool second = std::stoi(number.c_str()) > 3;
      put(data, DCM_AcquisitionDate, second ? second_day : "20240102");
      put(data, DCM_AcquisitionTime, second ? second_time : first_time);
    });
    const CtFolder ct = scan();
    return codes(ct.report().series.front());
  };
  EXPECT_NE(dated("20240209", "101010", "101015").find("PARTS"), std::string::npos);
  EXPECT_NE(dated("20240103", "101010", "101015").find("PARTS"), std::string::npos);
  EXPECT_EQ(dated("20240103", "235958", "000003"), "");
  EXPECT_EQ(dated("20240102", "101010", "101015"), "");
}

TEST_F(HeadersDisagree, PatientsOfTwoSexesAreTwoPatientsAndOneThatIsNotToldIsNone) {
  const auto series = [&](const char* second) {
    fs::remove_all(folder());
    writeSlices(12);
    editAll([&](DcmDataset& data) {
      OFString number;
      data.findAndGetOFString(DCM_InstanceNumber, number);
      put(data, DCM_PatientSex, std::stoi(number.c_str()) > 3 ? second : "F");
    });
    return scan().report().series.size();
  };
  EXPECT_EQ(series("M"), 2u);
  EXPECT_EQ(series("O"), 1u);
  EXPECT_EQ(series(""), 1u);
  EXPECT_EQ(series("F"), 1u);
}

TEST_F(HeadersDisagree, ScansOfTwoVoltagesAreToldApartByThem) {
  for (const auto& [first, second] : std::vector<std::pair<const char*, const char*>>{
           {"80", "140"}, {"70", "150"}, {"90", "150"}, {"100", "140"}, {"80", "100"}}) {
    fs::remove_all(folder());
    for (int n = 0; n < 12; ++n) {
      Image image;
      image.position_mm.z = 100.0 + 2.0 * (n / 2);
      image.instance = n + 1;
      fillPattern(image, n);
      DcmDataset data = makeImage(image);
      put(data, DCM_KVP, n % 2 == 0 ? first : second);
      add(data);
    }
    expectRefused("PHASES");
    const Choice& choice = report_.series.front().choices.front();
    EXPECT_NE(choice.words[1].find(std::string("(") + first + " kV)"), std::string::npos)
        << choice.words[1];
    EXPECT_NE(choice.words[2].find(std::string("(") + second + " kV)"), std::string::npos);
    import({{ code::kPhases, "2" }});
  }
}

TEST_F(HeadersDisagree, PartsOfAnImageThatAreMissingAreNamed) {
  const auto part = [&](int number, int total, double z) {
    Image image;
    image.frames = 4;
    image.instance = number;
    fillPattern(image, 4 * number);
    DcmDataset data = makeEnhanced(
        image, {Vec3(0, 0, z), Vec3(0, 0, z + 2), Vec3(0, 0, z + 4), Vec3(0, 0, z + 6)});
    put(data, DCM_ConcatenationUID, "1.2.3.9");
    data.putAndInsertUint16(DCM_InConcatenationNumber, Uint16(number));
    if (total > 0) data.putAndInsertUint16(DCM_InConcatenationTotalNumber, Uint16(total));
    add(data);
  };
  part(1, 3, 0);
  part(2, 3, 8);
  EXPECT_NE(expectRefused("INCOMPLETE").text.find("part 3 of 3 is missing"), std::string::npos);
  import({{ code::kIncomplete, "accept" }});
  EXPECT_EQ(chosen().verdict, Verdict::repaired);
  part(3, 3, 16);
  import();
  EXPECT_EQ(chosen().verdict, Verdict::pass) << codes(chosen());
  fs::remove_all(folder());
  part(2, 0, 8);
  part(3, 0, 16);
  EXPECT_NE(expectRefused("INCOMPLETE").text.find("part 1 is missing"), std::string::npos);
  fs::remove_all(folder());
  part(1, 3, 0);
  part(3, 3, 16);
  const Finding gap = expectRefused("MISSING_SLICES");
  EXPECT_NE(find(report_.series.front(), "INCOMPLETE")->text.find("part 2 of 3"),
            std::string::npos);
}

TEST_F(HeadersDisagree, AFileOfAnotherSyntaxThanItSaysIsNamedSo) {
  Image image;
  fillPattern(image, 0);
  Packing packing;
  packing.syntax = EXS_LittleEndianImplicit;
  add(makeImage(image), packing);
  const fs::path file = fs::directory_iterator(folder())->path();
  std::string bytes = readBytes(file);
  const std::string implicit("1.2.840.10008.1.2\0", 18);
  const std::size_t at = bytes.find(implicit);
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, implicit.size(), std::string("1.2.840.10008.1.2.1\0", 20));
  bytes[at - 2] = 20;                 // the element's length
  bytes[140] = char(bytes[140] + 2);  // the group's
  writeBytes(file, bytes);
  const CtFolder ct = scan();
  ASSERT_EQ(ct.report().skipped.size(), 1u);
  EXPECT_NE(ct.report().skipped[0].reason.find("written in Implicit VR"), std::string::npos)
      << ct.report().skipped[0].reason;
}

TEST_F(HeadersDisagree, AVolumeFileMayBeTheCtOfALabelMapBesideIt) {
  std::mt19937 random(8);
  Nifti of;
  of.sform = of.qform = anyAffine(random, of.pixdim);
  writeBytes(folder() / "ct.nii", niftiBytes(of));
  of.labels = true;
  writeBytes(folder() / "liver.nii", niftiBytes(of));
  const CtFolder ct = scan();
  ASSERT_EQ(ct.labelFiles().size(), 1u);
  EXPECT_EQ(ct.labelFiles()[0].name, "liver.nii");
}

}  // namespace
}  // namespace trephine::test
