// Small inputs remade after what people reported of programs like this one: each is read right, or
// what is doubtful about it is said in the right words.
#include <cmath>

#include "imaging/codes.h"
#include "imaging/structure_importer.h"
#include "series_fixture.h"
#include "volume/codes.h"

namespace trephine::test {
namespace {

namespace fs = std::filesystem;

// HU of the inputs' CTs at a place in the patient.
double huAt(const Vec3& mm) {
  return 3.0 * mm.x + 5.0 * mm.y + 11.0 * mm.z - 150.0;
}

struct Reported {
  const char* folder;
  const char* said;          // a code or words of the report, or of why there is none
  Answers answers = {};      // with which it is read
  bool read = true;          // with these its HU are right
};

const Reported kReported[] = {
    {"nii_sform_step_0.8_qform_0.6",
     "2.667 mm, the other of 1.5 x 2 x 2 mm",
     {{code::kFormsDiffer, "qform"}}},
    {"nii_qform_30mm_off", "up to 30 mm from where", {{code::kFormsDiffer, "sform"}}},
    {"concatenation_last_missing", "part 3 of 3 is missing", {{code::kIncomplete, "accept"}}},
    {"concatenation_middle_missing", "part 2 of 3 is missing", {{code::kMissingSlices, "fill"}}},
    {"jpeg_12bit_stream_header_10", "more bits than that", {{code::kHighBits, "use"}}},
    {"rle_12bit_values_header_10", "more bits than that", {{code::kHighBits, "use"}}},
    {"mhd_352_bytes_more", "352 bytes longer than its header says", {}, false},
    {"dual_energy_alternate", "(80 kV)", {}, false},
    {"enhanced_cardiac_delay_only", "(40 ms)", {}, false},
    {"wrong_syntax_implicit_called_explicit", "written in Implicit VR", {}, false},
    {"un_undefined_explicit_inside", "pass"},
    {"cbct_one_position_slicelocation", "slice locations", {{code::kOneLocation, "locations"}}},
    {"nii_padding_3024", "-3024 HU", {}, false},
    {"nii_microct_mu_per_cm", "attenuation", {}, false},
    {"nrrd_detached_list", "voxels are in several files", {}, false},
    {"freesurfer_mgz", "FreeSurfer", {}, false},
    {"nii_pair_hdr_img", "half of a pair", {}, false},
    {"folder_ct_seg_rtstruct", "contours", {}, false}};

std::string everythingSaid(const ImportReport& report) {
  std::string all = report.error ? report.error->sentence() : "";
  for (const SkippedFiles& files : report.skipped) all += "\n" + files.reason;
  for (const SeriesReport& series : report.series) {
    all += std::string("\n") + verdictName(series.verdict);
    for (const Finding& finding : series.findings) all += "\n" + finding.text;
    for (const Choice& choice : series.choices) {
      all += "\n" + choice.question;
      for (const std::string& words : choice.words) all += "\n" + words;
    }
  }
  return all;
}

TEST(ReportedInputs, EachIsReadRightOrItsDoubtIsSaid) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  for (const Reported& input : kReported) {
    SCOPED_TRACE(input.folder);
    auto ct = CtFolder::scan(data / "reported" / input.folder, Progress());
    ASSERT_TRUE(ct.ok());
    if (!ct->report().series.empty()) {
      (void)ct->read(ct->report().series.front().uid, {}, Progress());
    }
    const std::string said = everythingSaid(ct->report());
    EXPECT_NE(said.find(input.said), std::string::npos) << said;
    if (!input.read) continue;
    ImportRequest request;
    request.answers = input.answers;
    const auto series = ct->bestSeries(input.answers);
    const auto volume =
        ct->read(series.value_or(ct->report().series.front().uid), request, Progress());
    ASSERT_TRUE(volume.ok()) << volume.error().sentence();
    const GridGeometry& g = volume->geometry;
    int wrong = 0;
    for (std::size_t n = 0; n < volume->hu.size(); ++n) {
      const Index3 at = g.indicesOf(n);
      const double is = huAt(g.toPatient_mm(Vec3(at[0], at[1], at[2])));
      wrong += std::abs(volume->hu[n] - is) > 1.0;
    }
    EXPECT_EQ(wrong, 0) << "of " << volume->hu.size();
  }
}

TEST(ReportedInputs, SegmentationsAreReadOrNamed) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto on = [&](const char* ct_folder, const char* file, const Answers& answers = {}) {
    auto ct = CtFolder::scan(data / "reported" / ct_folder, Progress());
    EXPECT_TRUE(ct.ok());
    const auto volume = ct->read(*ct->bestSeries(), {}, Progress());
    EXPECT_TRUE(volume.ok());
    StructureRequest request;
    request.answers = answers;
    return importStructures(data / "reported" / "segs" / file, *volume, request);
  };
  // The organ's own part of the CT is of 60 HU.
  const auto organ = [](const Result<StructureFit>& fit, const std::string& name) {
    if (!fit) return fit.error().sentence();
    for (const StructureCard& card : fit->structures) {
      if (card.name != name) continue;
      return card.hu && (*card.hu)[1] == 60.0 ? std::string() : "another HU";
    }
    return std::string("no such structure");
  };
  EXPECT_EQ(organ(on("seg_ct", "lab_int32_5000.nii.gz"), "label 5000"), "");
  EXPECT_EQ(organ(on("seg_ct", "lab_scaled_int16.nii.gz"), "label 5"), "");
  EXPECT_EQ(organ(on("seg_ct", "labelmap_2024.dcm"), "liver"), "");
  EXPECT_EQ(organ(on("seg_ct_tilted", "tilted.dcm"), "liver"), "");
  EXPECT_EQ(organ(on("seg_ct", "lab_names_in_header.nii.gz"), "liver"), "");
  EXPECT_EQ(organ(on("seg_ct", "masks"), "liver"), "");
  EXPECT_EQ(on("seg_ct", "rtstruct.dcm").error().code.str(), "CONTOURS");
  EXPECT_EQ(on("seg_ct", "lab_identity_affine.nii.gz").error().code.str(), "NO_AFFINE");
  EXPECT_EQ(organ(on("seg_ct", "lab_identity_affine.nii.gz", {{code::kNoAffine, "ct"}}), "label 5"),
            "");
}

}  // namespace
}  // namespace trephine::test
