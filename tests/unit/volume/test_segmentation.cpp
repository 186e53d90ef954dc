#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "support.h"
#include "volume/segmentation.h"
#include "volume/volume_files.h"
#include "volumes.h"

namespace trephine {
namespace {

using test::obliqueVolume;

void writeBytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string packed(const std::string& bytes) {
  z_stream zlib{};
  deflateInit2(&zlib, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&zlib, uLong(bytes.size())), '\0');
  zlib.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  zlib.avail_in = uInt(bytes.size());
  zlib.next_out = reinterpret_cast<Bytef*>(out.data());
  zlib.avail_out = uInt(out.size());
  deflate(&zlib, Z_FINISH);
  out.resize(out.size() - zlib.avail_out);
  deflateEnd(&zlib);
  return out;
}

// As 3D Slicer writes one: RAS turned to LPS, a list of layers first, gzip.
struct SlicerFile {
  Index3 size{4, 3, 2};
  std::size_t layers = 2;
  std::string segments =
      "Segment0_Color:=0.5 0.25 0.125\nSegment0_ID:=Segment_1\nSegment0_LabelValue:=1\n"
      "Segment0_Layer:=0\nSegment0_Name:=liver\n"
      "Segment1_Color:=1 0 0\nSegment1_ID:=Segment_2\nSegment1_LabelValue:=2\n"
      "Segment1_Layer:=0\nSegment1_Name:=\xe8\x82\x9d\xe8\x84\x8f\n"
      "Segment2_Color:=0 0 1\nSegment2_ID:=Segment_3\nSegment2_LabelValue:=1\n"
      "Segment2_Layer:=1\nSegment2_Name:=portal vein\n";
  std::string voxels;  // layer fastest

  SlicerFile() {
    for (int v = 0; v < 24; ++v) {
      voxels += char(v % 3);               // layer 0: none, liver, the second
      voxels += char(v % 4 == 1 ? 1 : 0);  // layer 1: the vein
    }
  }
  std::string bytes(const std::string& sizes = "2 4 3 2") const {
    return "NRRD0004\n# Complete NRRD file format specification at:\n"
           "type: unsigned char\ndimension: 4\nspace: left-posterior-superior\nsizes: " +
           sizes +
           "\nspace directions: none (0,2,0) (0,0,1.5) (3,0,0)\nkinds: list domain domain "
           "domain\nencoding: gzip\nspace origin: (10,20,30)\n" +
           segments + "Segmentation_MasterRepresentation:=Binary labelmap\n\n" + packed(voxels);
  }
};

TEST(Segmentation, ReadsNamesColoursAndLayersOfSlicer) {
  const test::TemporaryFolder folder;
  const SlicerFile slicer;
  writeBytes(folder / "a.seg.nrrd", slicer.bytes());
  const auto of = readSegmentation(folder / "a.seg.nrrd");
  ASSERT_TRUE(of) << of.error().sentence();
  ASSERT_EQ(of->segments.size(), 3u);
  EXPECT_EQ(of->segments[0].name, "liver");
  EXPECT_EQ(of->segments[0].colour, Vec3(0.5, 0.25, 0.125));
  EXPECT_EQ(of->segments[1].name, "\xe8\x82\x9d\xe8\x84\x8f");
  EXPECT_EQ(of->segments[2].name, "portal vein");
  EXPECT_EQ(of->segments[2].layer, 1u);
  EXPECT_TRUE(of->named);
  ASSERT_EQ(of->layers.size(), 2u);
  for (std::size_t v = 0; v < 24; ++v) {
    EXPECT_EQ(of->layers[0][v], v % 3) << v;
    EXPECT_EQ(of->layers[1][v], v % 4 == 1) << v;
  }
  EXPECT_EQ(of->geometry.size, (Index3{4, 3, 2}));
  EXPECT_LT(glm::length(of->geometry.toPatient_mm({1, 1, 1}) - Vec3(13, 22, 31.5)), 1e-9);
}

TEST(Segmentation, WhereStructuresShareVoxelsTheOrderDecides) {
  const test::TemporaryFolder folder;
  writeBytes(folder / "a.seg.nrrd", SlicerFile().bytes());
  const auto of = readSegmentation(folder / "a.seg.nrrd");
  ASSERT_TRUE(of);
  const std::vector<Overlap> shared = overlaps(*of);
  ASSERT_EQ(shared.size(), 2u);
  EXPECT_EQ(shared[0].a, 0u);
  EXPECT_EQ(shared[0].b, 2u);
  EXPECT_EQ(shared[0].voxels, 2u);  // v % 3 == 1 and v % 4 == 1: 1 and 13
  EXPECT_EQ(smallerFirst(*of), (std::vector<std::size_t>{2, 0, 1}));
  const LabelMap vein_first = merged(*of, {2, 0, 1}), vein_last = merged(*of, {0, 1, 2});
  ASSERT_EQ(vein_first.structures.size(), 3u);
  const int vein = vein_first.find("portal vein")->label;
  EXPECT_EQ(vein, 3) << "1 is the liver's";
  EXPECT_EQ(vein_first.labels[1], vein);
  EXPECT_EQ(vein_last.labels[1], 1);
  EXPECT_EQ(vein_first.labels[9], vein) << "there the vein is alone";
  EXPECT_EQ(vein_last.labels[9], vein);
}

// Before values and layers were written each segment had a layer of its own.
TEST(Segmentation, ReadsLayersOfOldSlicerFiles) {
  const test::TemporaryFolder folder;
  SlicerFile slicer;
  slicer.segments = "Segment0_ID:=Segment_1\nSegment0_Name:=a\nSegment1_ID:=x\nSegment1_Name:=b\n";
  for (char& c : slicer.voxels) c = c == 2 ? 0 : c;
  writeBytes(folder / "old.seg.nrrd", slicer.bytes());
  const auto of = readSegmentation(folder / "old.seg.nrrd");
  ASSERT_TRUE(of) << of.error().sentence();
  ASSERT_EQ(of->segments.size(), 2u);
  EXPECT_EQ(of->segments[1].layer, 1u);
  EXPECT_EQ(of->segments[1].value, 1);
}

TEST(Segmentation, ASegmentOfALayerThatIsMissingIsSaid) {
  const test::TemporaryFolder folder;
  SlicerFile slicer;
  slicer.segments +=
      "Segment3_ID:=Segment_4\nSegment3_LabelValue:=1\nSegment3_Layer:=7\n"
      "Segment3_Name:=spleen\n";
  writeBytes(folder / "a.seg.nrrd", slicer.bytes());
  const auto of = readSegmentation(folder / "a.seg.nrrd");
  ASSERT_TRUE(of) << of.error().sentence();
  EXPECT_EQ(of->segments.size(), 3u);
  ASSERT_EQ(of->notes.size(), 1u);
  EXPECT_NE(of->notes[0].find("spleen"), std::string::npos);
}

TEST(Segmentation, ADamagedFileOfSlicerIsRefused) {
  const test::TemporaryFolder folder;
  SlicerFile slicer;
  const auto codeOf = [&](const std::string& bytes) {
    writeBytes(folder / "bad.seg.nrrd", bytes);
    const auto of = readSegmentation(folder / "bad.seg.nrrd");
    return of ? std::string("none") : of.error().code.str();
  };
  EXPECT_EQ(codeOf(slicer.bytes()), "none");
  EXPECT_EQ(codeOf(slicer.bytes("900 4 3 2")), "UNREADABLE");
  EXPECT_EQ(codeOf(slicer.bytes("2 4 3")), "UNREADABLE");
  EXPECT_EQ(codeOf(slicer.bytes("2 40 30 20")), "UNREADABLE");
  EXPECT_EQ(codeOf(slicer.bytes("2 1073741825 3 2")), "UNREADABLE");
  slicer.voxels.resize(20);
  EXPECT_EQ(codeOf(slicer.bytes()), "UNREADABLE");
  EXPECT_EQ(readVolumeFile(folder / "bad.seg.nrrd").error().code.str(), "NOT_HU");
}

TEST(Segmentation, IsWrittenWithItsNamesAndReadBackTheSame) {
  const test::TemporaryFolder folder;
  LabelMap map{obliqueVolume({6, 5, 4}).geometry, {}};
  map.labels.resize(map.geometry.voxelCount());
  for (std::size_t v = 0; v < map.labels.size(); ++v)
    map.labels[v] = v % 5 == 1 ? 7 : v % 3 ? 0 : 2;
  map.structures = {{7, "Leber \\ \xc3\xa4", Vec3(0.25, 0.5, 0.75), "liver"},
                    {2, "\xe8\x82\x9d", Vec3(1.0, 0.0, 0.0)}};
  for (const char* name : {"a.nii.gz", "b.nii", "c.mha", "d.nrrd", "e.seg.nrrd"}) {
    for (const bool reversed : {false, true}) {
      ASSERT_TRUE(writeSegmentation(map, folder / name, reversed)) << name;
      const auto back = readLabelMap(folder / name);
      ASSERT_TRUE(back) << name << ": " << back.error().sentence();
      EXPECT_EQ(back->labels, map.labels) << name;
      ASSERT_EQ(back->structures.size(), 2u) << name;
      for (const Structure& s : map.structures) {
        const Structure* other = back->find(s.name);
        ASSERT_TRUE(other) << name;
        EXPECT_EQ(other->label, s.label) << name;
        EXPECT_LT(glm::length(other->colour - s.colour), 1e-6) << name;
      }
    }
  }
  for (const char* name : {"a.nii.gz", "e.seg.nrrd"}) {
    EXPECT_EQ(readLabelMap(folder / name)->find("Leber \\ \xc3\xa4")->tissue, "liver") << name;
  }
  EXPECT_EQ(structuresFile("x/liver.seg.nii.gz"), std::filesystem::path("x/liver.structures.json"));
}

TEST(Segmentation, ReadsTheTextOfLabelsOfItkSnap) {
  const test::TemporaryFolder folder;
  LabelMap map{obliqueVolume({4, 3, 2}).geometry, std::vector<std::uint8_t>(24, 5)};
  map.labels[0] = 9;
  ASSERT_TRUE(writeLabelMap(map, folder / "seg.nii.gz"));
  const auto unnamed = readSegmentation(folder / "seg.nii.gz");
  ASSERT_TRUE(unnamed);
  EXPECT_FALSE(unnamed->named);
  EXPECT_TRUE(readLabelMap(folder / "seg.nii.gz")->find("label 5"));
  writeBytes(folder / "seg.txt", "notes of mine, no labels\n");
  EXPECT_FALSE(readSegmentation(folder / "seg.nii.gz")->named) << "anybody's text";
  writeBytes(folder / "seg.txt",
             "################\n# ITK-SnAP Label Description File\n"
             "    0     0    0    0        0  0  0    \"Clear Label\"\n"
             "    5   255  128    0        1  1  1    \"Liver \xe8\x82\x9d\"\n"
             "    6     0  255    0        1  1  1    \"Not in the map\"\n");
  const auto map_back = readLabelMap(folder / "seg.nii.gz");
  ASSERT_TRUE(map_back);
  ASSERT_TRUE(map_back->find("liver \xe8\x82\x9d"));
  EXPECT_EQ(map_back->find("liver \xe8\x82\x9d")->label, 5);
  EXPECT_LT(glm::length(map_back->find(5)->colour - Vec3(1.0, 128 / 255.0, 0.0)), 1e-9);
  EXPECT_EQ(map_back->find(9)->name, "label 9") << "which the text leaves out";
}

// Whatever fails in between, no map is beside the names of another.
TEST(Segmentation, AMapAndItsNamesAreBothWrittenOrNeither) {
  const test::TemporaryFolder folder;
  LabelMap map{obliqueVolume({6, 5, 4}).geometry, {}};
  map.labels.assign(map.geometry.voxelCount(), 1);
  map.structures = {{1, "liver", Vec3(1.0)}};
  const std::string long_name(238, 'n');  // with the sidecar's ending it is too long
  const auto file = folder / (long_name + ".mha");
  const auto before = std::string("not a map");
  writeBytes(file, before);
  const Status refused = writeSegmentation(map, file);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("too long"), std::string::npos) << refused.error().sentence();
  std::ifstream now(file, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(now), {}), before);

  const auto good = folder / "a.nii.gz";
  ASSERT_TRUE(writeSegmentation(map, good));
  map.structures[0].name = "spleen";
  ASSERT_TRUE(writeSegmentation(map, good));
  EXPECT_TRUE(readLabelMap(good)->find("spleen"));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / ".")) {
    files += !entry.path().filename().string().starts_with(long_name);
  }
  EXPECT_EQ(files, 2u) << "nothing else is left";
}

TEST(Segmentation, ALeftHandedNrrdHasItsSlicesAsTheCtsFile) {
  const test::TemporaryFolder folder;
  LabelMap map{obliqueVolume({4, 3, 2}).geometry, std::vector<std::uint8_t>(24)};
  map.labels[0] = 5;
  ASSERT_TRUE(writeSegmentation(map, folder / "a.nrrd", true));
  const auto header = readVolumeFileHeader(folder / "a.nrrd");
  ASSERT_TRUE(header);
  EXPECT_TRUE(header->reversed_slices);
  EXPECT_EQ(readLabelMap(folder / "a.nrrd")->labels, map.labels);
}

TEST(Segmentation, ABadSidecarIsNamedWithItsField) {
  const test::TemporaryFolder folder;
  const LabelMap map{obliqueVolume({4, 3, 2}).geometry, std::vector<std::uint8_t>(24, 1)};
  ASSERT_TRUE(writeLabelMap(map, folder / "seg.mha"));
  const auto error = [&](const std::string& text) {
    writeBytes(folder / "seg.structures.json", text);
    const auto of = readSegmentation(folder / "seg.mha");
    return of ? Error{Code("NONE"), "", "", ""} : of.error();
  };
  const std::string start = R"({"format": "trephine.structures", "version": 1, "structures": [)";
  EXPECT_EQ(error(start + R"({"label": 1, "name": "liver"}]})").code.str(), "NONE");
  EXPECT_EQ(error(start + R"({"label": 0, "name": "liver"}]})").code.str(), "BAD_FIELD");
  EXPECT_NE(error(start + R"({"label": 1, "name": "  "}]})").what.find("blank"), std::string::npos);
  EXPECT_EQ(error(start + R"({"label": 1, "name": "a"}, {"label": 1, "name": "b"}]})").code.str(),
            "BAD_FIELD");
  EXPECT_EQ(error(start + R"({"label": 1, "name": "Left Lung"},
                             {"label": 2, "name": "left_lung"}]})")
                .code.str(),
            "BAD_FIELD");
  EXPECT_NE(error(start + R"({"label": 1}]})").where.find("structures[0].name"), std::string::npos);
  EXPECT_EQ(error("{").code.str(), "BAD_JSON");
}

TEST(Segmentation, ThreeHundredStructuresAreRefusedInWords) {
  const test::TemporaryFolder folder;
  SlicerFile slicer;
  slicer.segments.clear();
  for (int n = 0; n < 300; ++n) {
    const std::string key = "Segment" + std::to_string(n) + "_";
    slicer.segments += key + "ID:=s" + std::to_string(n) + "\n" + key +
                       "LabelValue:=" + std::to_string(1 + n % 200) + "\n" + key +
                       "Layer:=" + std::to_string(n / 200) + "\n";
  }
  writeBytes(folder / "many.seg.nrrd", slicer.bytes());
  const auto of = readSegmentation(folder / "many.seg.nrrd");
  ASSERT_FALSE(of);
  EXPECT_EQ(of.error().code.str(), "TOO_MANY_STRUCTURES");
  EXPECT_NE(of.error().what.find("300"), std::string::npos);
}

TEST(Structures, HaveTheSameNameInAnyLettersAndWithBlanks) {
  EXPECT_TRUE(sameName("Left_Kidney", "left kidney"));
  EXPECT_FALSE(sameName("left kidney", "left kidneys"));
  EXPECT_FALSE(sameName("", "a"));
}

LabelMap ballIn(const GridGeometry& g, double radius_mm) {
  LabelMap map{g, std::vector<std::uint8_t>(g.voxelCount())};
  for (std::size_t v = 0; v < map.labels.size(); ++v) {
    const Index3 at = g.indicesOf(v);
    const Vec3 mm = g.toPatient_mm(Vec3(at[0], at[1], at[2]));
    if (glm::length(mm - g.centre_mm()) < radius_mm) map.labels[v] = 1;
  }
  map.structures = {{1, "liver", Vec3(1.0)}};
  return map;
}

TEST(Structures, AShellIsAsThickAsAskedAndNothingLeaksThroughIt) {
  for (const Vec3& spacing : {Vec3(1.0), Vec3(0.7, 0.7, 3.0)}) {
    GridGeometry g;
    g.size = {41, 43, 31};
    g.spacing_mm = spacing;
    const LabelMap map = ballIn(g, 12.0);
    for (const double mm : {0.2, 3.0}) {
      const std::vector<std::uint8_t> shell = shellOf(map, 1, mm);
      double deepest_mm = 0.0;
      for (std::size_t v = 0; v < shell.size(); ++v) {
        const Index3 at = g.indicesOf(v);
        if (shell[v]) {
          EXPECT_EQ(map.labels[v], 1);
          const Vec3 place = g.toPatient_mm(Vec3(at[0], at[1], at[2]));
          deepest_mm = std::max(deepest_mm, 12.0 - glm::length(place - g.centre_mm()));
          continue;
        }
        if (map.labels[v] != 1) continue;
        for (int n = 0; n < 27; ++n) {  // inside: no neighbour at all is outside
          const int a = at[0] + n % 3 - 1, b = at[1] + n / 3 % 3 - 1, c = at[2] + n / 9 - 1;
          EXPECT_EQ(map.labels[g.indexOf(a, b, c)], 1);
        }
      }
      EXPECT_LE(deepest_mm, mm + glm::length(spacing)) << mm;
      if (mm > 1.0) {
        EXPECT_GT(deepest_mm, mm - 0.5 * spacing.z) << mm;
      }
    }
  }
}

// A vessel in the liver has no capsule around it, nor has the scan's end one.
TEST(Structures, AShellIsOnlyWhereTheStructureEnds) {
  GridGeometry g;
  g.size = {31, 31, 20};
  LabelMap map = ballIn(g, 12.0);
  for (int k = 4; k < 16; ++k) map.labels[g.indexOf(15, 15, k)] = 2;
  std::vector<std::uint8_t> shell = shellOf(map, 1, 1.0);
  EXPECT_FALSE(shell[g.indexOf(14, 15, 10)]) << "beside the vessel";
  EXPECT_FALSE(shell[g.indexOf(15, 14, 0)]) << "where the scan ends";
  EXPECT_TRUE(shell[g.indexOf(15, 4, 10)]);
}

TEST(Structures, AnUnusedLabelIsOneThatNothingHas) {
  LabelMap map{{}, {1, 2, 4}, {{3, "a"}, {4, "b"}}};
  EXPECT_EQ(unusedLabel(map), 5);
  nameTheRest(map);
  ASSERT_TRUE(map.find(2));
  EXPECT_EQ(map.find(2)->name, "label 2");
  EXPECT_EQ(map.structures.size(), 4u);
}

// A label map of 4 x 3 x 2 voxels as NIfTI, of any type; `extension` stands behind the header.
std::string niftiOf(const std::vector<double>& values, int type, int bits, float slope = 1.0f,
                    const std::string& extension = "") {
  std::string bytes(352, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  };
  put(0, std::int32_t(348));
  const std::int16_t dims[] = {3, 4, 3, 2};
  for (std::size_t n = 0; n < 4; ++n) put(40 + 2 * n, dims[n]);
  put(70, std::int16_t(type));
  put(72, std::int16_t(bits));
  for (std::size_t n = 0; n < 4; ++n) put(76 + 4 * n, 1.0f);
  const std::size_t start = (352 + (extension.empty() ? 0 : extension.size() + 8) + 15) / 16 * 16;
  put(108, float(start));
  put(112, slope);
  put(254, std::int16_t(1));
  put(280, 1.0f);
  put(300, 1.0f);
  put(320, 1.0f);
  bytes[344] = 'n';
  bytes[345] = '+';
  bytes[346] = '1';
  if (!extension.empty()) {
    bytes[348] = 1;
    bytes.resize(360);
    put(352, std::int32_t(extension.size() + 8));
    bytes += extension;
  }
  bytes.resize(start, '\0');
  for (const double value : values) {
    if (type == 2) bytes += char(std::uint8_t(value));
    if (type == 4) {
      const auto v = std::int16_t(value);
      bytes.append(reinterpret_cast<const char*>(&v), 2);
    }
    if (type == 8) {
      const auto v = std::int32_t(value);
      bytes.append(reinterpret_cast<const char*>(&v), 4);
    }
    if (type == 16) {
      const auto v = float(value);
      bytes.append(reinterpret_cast<const char*>(&v), 4);
    }
  }
  return bytes;
}

std::vector<double> labelsOf(const std::vector<double>& some) {
  std::vector<double> values;
  for (std::size_t v = 0; v < 24; ++v) values.push_back(some[v % some.size()]);
  return values;
}

TEST(SegmentationNumbers, AboveWhatACaseCountsToAreGivenOthersAndNamedByWhatTheyWere) {
  test::TemporaryFolder folder;
  for (const std::vector<double>& some : std::vector<std::vector<double>>{
           {0, 5000}, {0, 1, 5000, 2}, {0, 256, 257}, {0, 1, 2, 3, 32767}, {0, 14175, 255, 1000}}) {
    writeBytes(folder / "l.nii", niftiOf(labelsOf(some), 8, 32));
    const auto read = readSegmentation(folder / "l.nii");
    ASSERT_TRUE(read.ok()) << read.error().sentence();
    ASSERT_EQ(read->segments.size(), some.size() - 1);
    for (const Segmentation::Segment& segment : read->segments) {
      const auto at = std::ranges::find(read->layers[0], segment.value) - read->layers[0].begin();
      const double number = labelsOf(some)[std::size_t(at)];
      if (number <= 255) {
        EXPECT_EQ(segment.value, number);
      } else {
        EXPECT_EQ(segment.name, "label " + std::to_string(int(number)));
      }
    }
  }
  // A list beside the file names them by their own numbers.
  writeBytes(folder / "l.nii", niftiOf(labelsOf({0, 5000, 7}), 8, 32));
  writeBytes(folder / "l.label", "5000 255 0 0 1 1 1 \"liver\"\n7 0 255 0 1 1 1 \"vein\"\n");
  const auto named = readSegmentation(folder / "l.nii");
  ASSERT_TRUE(named.ok());
  EXPECT_EQ(named->segments[0].name, "liver");
  EXPECT_EQ(named->segments[1].name, "vein");
  EXPECT_EQ(named->segments[1].value, 7);
  std::vector<double> many;
  for (int n = 0; n < 24; ++n) many.push_back(40000 + n);
  writeBytes(folder / "l.nii", niftiOf(many, 8, 32));
  EXPECT_EQ(readSegmentation(folder / "l.nii").error().code.str(), "NOT_LABELS");
}

TEST(SegmentationNumbers, ThatASlopeOrAFloatLeavesBesideAWholeNumberAreThatNumber) {
  test::TemporaryFolder folder;
  // 5 / 32768 and the like, as nibabel scales labels into int16.
  for (const double most : {5.0, 7.0, 100.0, 117.0, 255.0}) {
    const float slope = float(most / 32767.0);
    writeBytes(folder / "l.nii", niftiOf(labelsOf({0, 32767}), 4, 16, slope));
    const auto read = readSegmentation(folder / "l.nii");
    ASSERT_TRUE(read.ok()) << read.error().sentence();
    ASSERT_EQ(read->segments.size(), 1u);
    EXPECT_EQ(read->segments[0].value, most);
  }
  for (const double off : {3e-7, -3e-7, 5e-5}) {
    writeBytes(folder / "l.nii", niftiOf(labelsOf({0, 5.0 + off}), 16, 32));
    EXPECT_TRUE(readSegmentation(folder / "l.nii").ok()) << off;
  }
  for (const double off : {0.5, 0.01, -0.3}) {
    writeBytes(folder / "l.nii", niftiOf(labelsOf({0, 5.0 + off}), 16, 32));
    EXPECT_EQ(readSegmentation(folder / "l.nii").error().code.str(), "NOT_LABELS") << off;
  }
}

TEST(SegmentationNames, OfATableInTheHeaderOfANiftiAreTaken) {
  test::TemporaryFolder folder;
  const std::string table =
      R"(<?xml version="1.0"?><CaretExtension><VolumeInformation Index="0"><LabelTable>)"
      R"(<Label Key="0" Red="0" Green="0" Blue="0" Alpha="0">???</Label>)"
      R"(<Label Key="5" Red="0.6" Green="0.2" Blue="0.1" Alpha="1"><![CDATA[liver <b>]]></Label>)"
      R"(<Label Key="9" Red="0" Green="1" Blue="0" Alpha="1">Milz &amp; co</Label>)"
      R"(<Label Key="77" Red="0" Green="1" Blue="0" Alpha="1">not there</Label>)"
      R"(<Label Key="x">broken</Label><Label Key="8")";
  writeBytes(folder / "l.nii", niftiOf(labelsOf({0, 5, 9}), 2, 8, 1.0f, table));
  const auto read = readSegmentation(folder / "l.nii");
  ASSERT_TRUE(read.ok()) << read.error().sentence();
  ASSERT_EQ(read->segments.size(), 2u);
  EXPECT_EQ(read->segments[0].name, "liver <b>");
  EXPECT_EQ(read->segments[0].value, 5);
  EXPECT_NEAR(read->segments[0].colour.x, 0.6, 1e-6);
  EXPECT_EQ(read->segments[1].name, "Milz & co");
  EXPECT_TRUE(read->named);
}

TEST(SegmentationFolder, OfMasksIsOneSegmentation) {
  test::TemporaryFolder folder;
  const std::filesystem::path masks = folder / "masks";
  std::filesystem::create_directory(masks);
  const auto write = [&](const std::string& name, const std::vector<double>& some) {
    writeBytes(masks / (name + ".nii"), niftiOf(labelsOf(some), 2, 8));
  };
  write("liver", {0, 1, 0, 0});
  write("spleen", {0, 0, 1, 0});
  write("vessel", {0, 1, 1, 0});  // in both
  write("gallbladder", {0});
  writeBytes(masks / "readme.txt", "made by a program");
  const auto read = readSegmentation(masks);
  ASSERT_TRUE(read.ok()) << read.error().sentence();
  EXPECT_EQ(read->layers.size(), 2u);
  ASSERT_EQ(read->segments.size(), 4u);
  EXPECT_EQ(read->segments[0].name, "gallbladder");
  EXPECT_EQ(overlaps(*read).size(), 2u);
  for (const Segmentation::Segment& segment : read->segments) {
    const auto count = std::ranges::count(read->layers[segment.layer], segment.value);
    EXPECT_EQ(count, segment.name == "gallbladder" ? 0 : segment.name == "vessel" ? 12 : 6);
  }
  write("both", {0, 1, 2});
  EXPECT_EQ(readSegmentation(masks).error().code.str(), "NOT_LABELS");
  std::filesystem::remove(masks / "both.nii");
  std::string other = niftiOf(labelsOf({0, 1}), 2, 8);
  const float moved = 3.0f;
  std::memcpy(other.data() + 292, &moved, 4);
  writeBytes(masks / "other.nii", other);
  EXPECT_EQ(readSegmentation(masks).error().code.str(), "OTHER_GRID");
  std::filesystem::create_directory(folder / "none");
  EXPECT_EQ(readSegmentation(folder / "none").error().code.str(), "NOT_LABELS");
}

}  // namespace
}  // namespace trephine
