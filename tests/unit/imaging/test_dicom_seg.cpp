#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "imaging/codes.h"
#include "imaging/common/detail/cielab.h"
#include "imaging/common/detail/text.h"
#include "imaging/dicom/detail/frame_stack.h"
#include "imaging/dicom/detail/seg_codes.h"
#include "imaging/dicom/seg_reader.h"
#include "imaging/dicom/seg_writer.h"
#include "series_fixture.h"

namespace trephine::test {

namespace {

namespace fs = std::filesystem;

// A segmentation made element by element.
struct SegFile {
  struct Segment {
    int number = 1;
    std::string label = "liver";
    std::array<int, 3> lab{-1, 0, 0};
  };
  struct Frame {
    int segment = 1;
    Vec3 position_mm{0.0};
    std::vector<int> values;            // of each pixel
    std::vector<double> orientation{};  // its own, where it is not shared
  };
  int columns = 7, rows = 5;
  bool fractional = false;
  bool words = false;  // pixels are stored as words of 16 bits
  int most = 255;
  std::string charset = "ISO_IR 192";
  std::string between = "2.5", thickness = "2.5";
  std::vector<double> orientation{1, 0, 0, 0, 1, 0};
  std::vector<Segment> segments{Segment{}};
  std::vector<Frame> frames;
};

std::string joined(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : "\\") + decimalText(value);
  return text;
}

DcmItem& itemOf(DcmItem& in, const DcmTagKey& sequence, long number = 0) {
  DcmItem* item = nullptr;
  in.findOrCreateSequenceItem(sequence, item, number);
  return *item;
}

void set(DcmItem& item, const DcmTagKey& tag, const std::string& value) {
  EXPECT_TRUE(item.putAndInsertString(tag, value.c_str()).good());
}

void set16(DcmItem& item, const DcmTagKey& tag, int value) {
  EXPECT_TRUE(item.putAndInsertUint16(tag, Uint16(value)).good());
}

void setPixels(DcmDataset& data, const SegFile& file) {
  const std::size_t count = std::size_t(file.columns) * std::size_t(file.rows);
  Bytes bytes;
  std::size_t bit = 0;
  for (const SegFile::Frame& frame : file.frames) {
    for (std::size_t n = 0; n < count; ++n, ++bit) {
      if (file.fractional) {
        bytes.push_back(std::uint8_t(frame.values[n]));
        continue;
      }
      if (bit / 8 == bytes.size()) bytes.push_back(0);
      bytes.back() = std::uint8_t(bytes.back() | (frame.values[n] != 0) << bit % 8);
    }
  }
  if (bytes.size() % 2) bytes.push_back(0);
  if (!file.words) {
    EXPECT_TRUE(data.putAndInsertUint8Array(DCM_PixelData, bytes.data(), bytes.size()).good());
    return;
  }
  std::vector<Uint16> words;
  for (std::size_t n = 0; n < bytes.size(); n += 2) {
    words.push_back(Uint16(bytes[n] | bytes[n + 1] << 8));
  }
  EXPECT_TRUE(data.putAndInsertUint16Array(DCM_PixelData, words.data(), words.size()).good());
}

DcmDataset datasetOf(const SegFile& file) {
  DcmDataset data;
  set(data, DCM_SpecificCharacterSet, file.charset);
  set(data, DCM_SOPClassUID, UID_SegmentationStorage);
  set(data, DCM_SOPInstanceUID, "1.2.3.9");
  set(data, DCM_StudyInstanceUID, "1.2.3");
  set(data, DCM_SeriesInstanceUID, "1.2.3.8");
  set(data, DCM_FrameOfReferenceUID, "1.2.3.7");
  set(data, DCM_Modality, "SEG");
  set(data, DCM_ImageType, "DERIVED\\PRIMARY");
  set(data, DCM_PatientName, "");
  DcmItem& series = itemOf(data, DCM_ReferencedSeriesSequence);
  set(series, DCM_SeriesInstanceUID, "1.2.3.4");
  set(data, DCM_SegmentationType, file.fractional ? "FRACTIONAL" : "BINARY");
  if (file.fractional) {
    set(data, DCM_SegmentationFractionalType, "OCCUPANCY");
    if (file.most > 0) set16(data, DCM_MaximumFractionalValue, file.most);
  }
  for (std::size_t n = 0; n < file.segments.size(); ++n) {
    const SegFile::Segment& segment = file.segments[n];
    DcmItem& item = itemOf(data, DCM_SegmentSequence, long(n));
    set16(item, DCM_SegmentNumber, segment.number);
    set(item, DCM_SegmentLabel, segment.label);
    set(item, DCM_SegmentAlgorithmType, "MANUAL");
    if (segment.lab[0] >= 0) {
      const Uint16 lab[3] = {Uint16(segment.lab[0]), Uint16(segment.lab[1]),
                             Uint16(segment.lab[2])};
      item.putAndInsertUint16Array(DCM_RecommendedDisplayCIELabValue, lab, 3);
    }
  }
  DcmItem& shared = itemOf(data, DCM_SharedFunctionalGroupsSequence);
  DcmItem& measures = itemOf(shared, DCM_PixelMeasuresSequence);
  set(measures, DCM_PixelSpacing, "0.75\\0.5");
  if (!file.thickness.empty()) set(measures, DCM_SliceThickness, file.thickness);
  if (!file.between.empty()) set(measures, DCM_SpacingBetweenSlices, file.between);
  const bool turned = std::ranges::any_of(
      file.frames, [](const SegFile::Frame& f) { return !f.orientation.empty(); });
  if (!turned) {
    set(itemOf(shared, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient,
        joined(file.orientation));
  }
  for (std::size_t n = 0; n < file.frames.size(); ++n) {
    const SegFile::Frame& frame = file.frames[n];
    DcmItem& item = itemOf(data, DCM_PerFrameFunctionalGroupsSequence, long(n));
    set(itemOf(item, DCM_PlanePositionSequence), DCM_ImagePositionPatient,
        positionText(frame.position_mm));
    set16(itemOf(item, DCM_SegmentIdentificationSequence), DCM_ReferencedSegmentNumber,
          frame.segment);
    if (turned) {
      set(itemOf(item, DCM_PlaneOrientationSequence), DCM_ImageOrientationPatient,
          joined(frame.orientation.empty() ? file.orientation : frame.orientation));
    }
  }
  const int bits = file.fractional ? 8 : 1;
  set16(data, DCM_Rows, file.rows);
  set16(data, DCM_Columns, file.columns);
  set16(data, DCM_SamplesPerPixel, 1);
  set(data, DCM_PhotometricInterpretation, "MONOCHROME2");
  set16(data, DCM_BitsAllocated, bits);
  set16(data, DCM_BitsStored, bits);
  set16(data, DCM_HighBit, bits - 1);
  set16(data, DCM_PixelRepresentation, 0);
  set(data, DCM_NumberOfFrames, std::to_string(file.frames.size()));
  setPixels(data, file);
  return data;
}

// A frame of segment `number` at slice k, whose pixels are of it where `is` says so.
template <class Is>
SegFile::Frame frameOf(const SegFile& file, int number, int k, const Is& is) {
  SegFile::Frame frame{number, Vec3(-20.0, 10.5, 100.0 + 2.5 * k), {}};
  for (int j = 0; j < file.rows; ++j) {
    for (int i = 0; i < file.columns; ++i) frame.values.push_back(is(i, j, k));
  }
  return frame;
}

// Any pattern without symmetry.
bool pattern(int i, int j, int k) {
  return (i * 7 + j * 5 + k * 3 + i * j * k) % 4 == 1;
}

// Labels without symmetry: `count` structures and voxels of none.
LabelMap scattered(const GridGeometry& geometry, int count, unsigned seed = 3) {
  LabelMap map{geometry, std::vector<std::uint8_t>(geometry.voxelCount())};
  std::mt19937 random(seed);
  for (std::uint8_t& label : map.labels) label = std::uint8_t(random() % unsigned(count + 1));
  nameTheRest(map);
  return map;
}

Volume someCt(Index3 size = {7, 5, 6}) {
  return rampVolume(size);
}

}  // namespace

class DicomSeg : public SeriesFixture {
 protected:
  fs::path file() const { return temporary_ / "seg.dcm"; }
  fs::path written() const { return temporary_ / "out" / "structures.dcm"; }

  void save(const SegFile& seg, E_TransferSyntax syntax = EXS_LittleEndianExplicit) {
    DcmDataset data = datasetOf(seg);
    save(data, syntax);
  }
  void save(DcmDataset& data, E_TransferSyntax syntax = EXS_LittleEndianExplicit) {
    DcmFileFormat dicom(&data);
    ASSERT_TRUE(dicom.saveFile(file().c_str(), syntax).good());
  }

  DicomSegmentation read(double threshold = 0.5) { return read(file(), threshold); }
  static DicomSegmentation read(const fs::path& path, double threshold = 0.5) {
    auto result = readDicomSegmentation(path, threshold);
    EXPECT_TRUE(result.ok()) << result.error().sentence();
    return result.ok() ? std::move(result).value() : DicomSegmentation{};
  }
  Error refused(double threshold = 0.5) {
    const auto result = readDicomSegmentation(file(), threshold);
    EXPECT_FALSE(result.ok());
    if (result.ok()) return {};
    EXPECT_FALSE(result.error().what.empty());
    EXPECT_EQ(result.error().where, "seg.dcm");
    return result.error();
  }
  Error refused(const SegFile& seg) {
    save(seg);
    return refused();
  }

  std::vector<std::string> write(const Volume& ct, const LabelMap& map,
                                 const SegWriting& writing = {}) {
    const auto result = writeStructuresAsDicom(ct, map, temporary_ / "out", writing);
    EXPECT_TRUE(result.ok()) << result.error().sentence();
    return result.ok() ? result->notes : std::vector<std::string>{};
  }

  static bool has(const Segmentation& s, std::size_t segment, int i, int j, int k) {
    const Segmentation::Segment& one = s.segments[segment];
    return s.layers[one.layer][s.geometry.indexOf(i, j, k)] == one.value;
  }
  static std::size_t voxels(const Segmentation& s, std::size_t segment) {
    const Segmentation::Segment& one = s.segments[segment];
    return std::size_t(std::ranges::count(s.layers[one.layer], one.value));
  }

  // Every voxel of the map lies at its place in the patient, under its structure's name.
  static void expectSame(const LabelMap& map, const Segmentation& s) {
    const GridGeometry& from = map.geometry;
    std::map<std::string, int> label_of;
    for (const Structure& structure : map.structures) label_of[structure.name] = structure.label;
    std::vector<std::uint8_t> back(from.voxelCount());
    const Mat4 to_map = from.patientToVoxel();
    for (std::size_t n = 0; n < s.segments.size(); ++n) {
      for (int k = 0; k < s.geometry.size[2]; ++k) {
        for (int j = 0; j < s.geometry.size[1]; ++j) {
          for (int i = 0; i < s.geometry.size[0]; ++i) {
            if (!has(s, n, i, j, k)) continue;
            const Vec3 v = Vec3(to_map * glm::dvec4(s.geometry.toPatient_mm(Vec3(i, j, k)), 1.0));
            const Vec3 whole = glm::round(v);
            ASSERT_LT(glm::distance(v, whole), 1e-6);
            ASSERT_TRUE(from.contains(int(whole.x), int(whole.y), int(whole.z)));
            std::uint8_t& voxel = back[from.indexOf(int(whole.x), int(whole.y), int(whole.z))];
            ASSERT_EQ(voxel, 0);
            voxel = std::uint8_t(label_of.at(s.segments[n].name));
          }
        }
      }
    }
    EXPECT_EQ(back, map.labels);
  }
};

TEST_F(DicomSeg, StructuresReadBackVoxelByVoxel) {
  // Sizes whose rows x columns leave every remainder when divided by eight.
  for (const Index3 size : {Index3{7, 5, 6}, Index3{8, 8, 3}, Index3{9, 1, 4}, Index3{5, 2, 5},
                            Index3{11, 1, 9}, Index3{6, 2, 3}, Index3{13, 1, 5}, Index3{7, 2, 4}}) {
    SCOPED_TRACE(size[0] * size[1]);
    fs::remove_all(temporary_ / "out");
    const Volume ct = someCt(size);
    const LabelMap map = scattered(ct.geometry, 5);
    EXPECT_TRUE(write(ct, map).empty());
    const DicomSegmentation back = read(written());
    EXPECT_EQ(back.segmentation.format, "DICOM SEG");
    EXPECT_EQ(back.segmentation.layers.size(), 1U);
    EXPECT_EQ(back.segmentation.geometry, ct.geometry);
    expectSame(map, back.segmentation);
  }
}

TEST_F(DicomSeg, StructuresOnAnObliqueGridReadBackAtTheirPlaces) {
  Volume ct = someCt();
  const Vec3 i = glm::normalize(Vec3(1.0, 0.2, -0.1));
  const Vec3 k = glm::normalize(glm::cross(i, Vec3(0.1, 1.0, 0.3)));
  ct.geometry.direction = Mat3(i, glm::cross(k, i), k);
  const LabelMap map = scattered(ct.geometry, 3);
  write(ct, map);
  expectSame(map, read(written()).segmentation);
}

TEST_F(DicomSeg, ALeftHandedGridComesBackRightHandedWithEveryVoxelInItsPlace) {
  for (int axis = 0; axis < 3; ++axis) {
    fs::remove_all(temporary_ / "out");
    Volume ct = someCt();
    ct.geometry.direction[axis] = -ct.geometry.direction[axis];
    const LabelMap map = scattered(ct.geometry, 3);
    write(ct, map);
    const Segmentation back = read(written()).segmentation;
    EXPECT_NEAR(glm::determinant(back.geometry.direction), 1.0, 1e-12);
    expectSame(map, back);
  }
}

TEST_F(DicomSeg, OnlySlicesWithVoxelsHaveFramesAndTheGridSpansThem) {
  const Volume ct = someCt({6, 4, 9});
  LabelMap map{ct.geometry, std::vector<std::uint8_t>(ct.geometry.voxelCount())};
  map.structures = {{4, "vessel", Vec3(1, 0, 0)}};
  map.labels[map.geometry.indexOf(1, 2, 2)] = 4;
  map.labels[map.geometry.indexOf(5, 3, 7)] = 4;
  write(ct, map);
  edit(written(), [](DcmDataset& data) { EXPECT_EQ(text(data, DCM_NumberOfFrames), "2"); });
  const Segmentation back = read(written()).segmentation;
  EXPECT_EQ(back.geometry.size, (Index3{6, 4, 6}));
  expectSame(map, back);
}

TEST_F(DicomSeg, SegmentsThatOverlapShareNoLayerAndThoseThatDoNotShareOne) {
  SegFile seg;
  seg.segments = {{1, "liver"}, {2, "vessel"}, {3, "spleen"}};
  for (int k = 0; k < 3; ++k) {
    seg.frames.push_back(frameOf(seg, 1, k, [](int i, int, int) { return i < 4; }));
    seg.frames.push_back(frameOf(seg, 2, k, [](int i, int j, int) { return i == 3 && j == 2; }));
    seg.frames.push_back(frameOf(seg, 3, k, [](int i, int, int) { return i > 4; }));
  }
  save(seg);
  const Segmentation s = read().segmentation;
  ASSERT_EQ(s.layers.size(), 2U);
  EXPECT_EQ(s.segments[0].layer, 0U);
  EXPECT_EQ(s.segments[1].layer, 1U);
  EXPECT_EQ(s.segments[2].layer, 0U);
  EXPECT_TRUE(has(s, 0, 3, 2, 1) && has(s, 1, 3, 2, 1));
  EXPECT_EQ(voxels(s, 0), 60U);
  EXPECT_EQ(voxels(s, 1), 3U);
  EXPECT_EQ(voxels(s, 2), 30U);
}

TEST_F(DicomSeg, OfAFractionalOneVoxelsFromTheThresholdOnAreOfTheSegment) {
  SegFile seg;
  seg.fractional = true;
  seg.most = 200;
  SegFile::Frame frame = frameOf(seg, 1, 0, [](int, int, int) { return 0; });
  frame.values[0] = 1;
  frame.values[1] = 99;
  frame.values[2] = 100;  // half
  frame.values[3] = 200;
  seg.frames = {frame};
  for (const E_TransferSyntax syntax :
       {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_BigEndianExplicit,
        EXS_DeflatedLittleEndianExplicit, EXS_RLELossless}) {
    SCOPED_TRACE(DcmXfer(syntax).getXferName());
    DcmDataset data = datasetOf(seg);
    test::save(data, file(), {syntax});
    EXPECT_EQ(voxels(read().segmentation, 0), 2U);
    EXPECT_EQ(voxels(read(0.0).segmentation, 0), 4U);
    EXPECT_EQ(voxels(read(0.495).segmentation, 0), 3U);
    EXPECT_EQ(voxels(read(1.0).segmentation, 0), 1U);
  }
}

TEST_F(DicomSeg, AFractionalOneThatDoesNotSayItsHighestValueIsReadWithANote) {
  SegFile seg;
  seg.fractional = true;
  seg.most = 0;
  seg.frames = {frameOf(seg, 1, 0, [](int i, int, int) { return i == 0 ? 128 : 127; })};
  save(seg);
  const Segmentation s = read().segmentation;
  EXPECT_EQ(voxels(s, 0), 5U);
  EXPECT_EQ(s.notes.size(), 1U);
}

TEST_F(DicomSeg, AThresholdThatIsNoShareIsRefused) {
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern)};
  save(seg);
  for (const double threshold : {-0.1, 1.1, std::nan("")}) {
    EXPECT_EQ(refused(threshold).code.str(), "BAD_THRESHOLD");
  }
}

TEST_F(DicomSeg, FramesInAnyOrderAndEveryTransferSyntaxWithoutCompressionGiveTheSame) {
  SegFile seg;
  seg.segments = {{3, "b"}, {1, "a"}};
  for (int k = 0; k < 6; ++k) {
    for (const int number : {1, 3}) {
      seg.frames.push_back(frameOf(seg, number, k, [number](int i, int j, int slice) {
        return (number == 1) == pattern(i, j, slice);
      }));
    }
  }
  save(seg);
  const Segmentation in_order = read().segmentation;
  EXPECT_EQ(in_order.geometry.size, (Index3{7, 5, 6}));
  EXPECT_EQ(in_order.geometry.spacing_mm, Vec3(0.5, 0.75, 2.5));
  EXPECT_EQ(in_order.geometry.origin_mm, Vec3(-20.0, 10.5, 100.0));
  for (int k = 0; k < 6; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 7; ++i) {
        ASSERT_EQ(has(in_order, 1, i, j, k), pattern(i, j, k));
        ASSERT_EQ(has(in_order, 0, i, j, k), !pattern(i, j, k));
      }
    }
  }
  EXPECT_EQ(in_order.segments[0].name, "b");
  EXPECT_EQ(in_order.segments[0].value, 3);
  std::ranges::shuffle(seg.frames, std::mt19937(5));
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit,
                                        EXS_BigEndianExplicit, EXS_DeflatedLittleEndianExplicit}) {
    SCOPED_TRACE(DcmXfer(syntax).getXferName());
    for (const bool words : {false, true}) {
      seg.words = words;
      save(seg, syntax);
      const Segmentation shuffled = read().segmentation;
      EXPECT_EQ(shuffled.layers, in_order.layers);
      EXPECT_EQ(shuffled.geometry, in_order.geometry);
    }
  }
}

TEST_F(DicomSeg, SlicesWithoutFramesAreGapsOfTheirOwnWidth) {
  // Slices 0, 2, 5: only together do they tell the step.
  SegFile seg;
  for (const int k : {0, 2, 5}) seg.frames.push_back(frameOf(seg, 1, k, pattern));
  for (const auto& [between, thickness] :
       {std::pair("2.5", "2.5"), std::pair("", "2.5"), std::pair("", ""), std::pair("0", "9")}) {
    seg.between = between;
    seg.thickness = thickness;
    save(seg);
    const Segmentation s = read().segmentation;
    ASSERT_EQ(s.geometry.size, (Index3{7, 5, 6})) << between << " " << thickness;
    for (int k = 0; k < 6; ++k) {
      for (int i = 0; i < 7; ++i) {
        EXPECT_EQ(has(s, 0, i, 2, k), (k == 0 || k == 2 || k == 5) && pattern(i, 2, k));
      }
    }
  }
  // Every other slice alone: what is stated beside positions tells that there are more.
  seg.frames = {frameOf(seg, 1, 0, pattern), frameOf(seg, 1, 2, pattern)};
  seg.between = "2.5";
  save(seg);
  EXPECT_EQ(read().segmentation.geometry.size[2], 3);
  seg.between = "5";
  save(seg);
  EXPECT_EQ(read().segmentation.geometry.size[2], 2);
}

TEST_F(DicomSeg, OneSliceIsAsThickAsItSays) {
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern)};
  seg.between = "3";
  save(seg);
  EXPECT_EQ(read().segmentation.geometry.spacing_mm.z, 3.0);
  seg.between = "";
  seg.thickness = "1.25";
  save(seg);
  EXPECT_EQ(read().segmentation.geometry.spacing_mm.z, 1.25);
  seg.thickness = "";
  EXPECT_EQ(refused(seg).code.str(), "NO_GEOMETRY");
}

TEST_F(DicomSeg, FramesThatDoNotLieInOneStraightEvenStackAreRefused) {
  SegFile seg;
  seg.between = seg.thickness = "";
  for (int k = 0; k < 5; ++k) seg.frames.push_back(frameOf(seg, 1, k, pattern));
  SegFile uneven = seg;
  uneven.frames[4].position_mm.z += 0.9;
  EXPECT_EQ(refused(uneven).code.str(), "UNEVEN_SPACING");
  SegFile drifting = seg;  // no step is far off, but their sum is
  for (std::size_t k = 0; k < 5; ++k) {
    drifting.frames[k].position_mm.z = 100.0 + 2.5 * double(k) - (k > 2 ? 0.22 * double(k - 2) : 0);
  }
  for (std::size_t k = 5; k < 9; ++k) {
    drifting.frames.push_back(drifting.frames[k - 1]);
    drifting.frames[k].position_mm.z += 2.28;
  }
  EXPECT_EQ(refused(drifting).code.str(), "UNEVEN_SPACING");
  SegFile nearly = seg;
  nearly.frames[4].position_mm.z += 0.1;
  save(nearly);
  EXPECT_EQ(read().segmentation.notes.size(), 1U);
  SegFile shifted = seg;
  shifted.frames[2].position_mm.x += 0.4;
  EXPECT_EQ(refused(shifted).code.str(), "FRAMES_DIFFER");
  SegFile tilted = seg;
  tilted.frames[3].orientation = {1, 0, 0, 0, std::cos(0.1), std::sin(0.1)};
  EXPECT_EQ(refused(tilted).code.str(), "FRAMES_DIFFER");
  SegFile crooked = seg;
  crooked.orientation = {1, 0, 0, 0.5, 1, 0};
  EXPECT_EQ(refused(crooked).code.str(), "NO_GEOMETRY");
  SegFile far = seg;
  for (const int k : {1, 2, 3, 4}) far.frames[std::size_t(k)].position_mm.z = 0.02 + 100.0 * k;
  EXPECT_EQ(refused(far).code.str(), "TOO_LARGE");
}

TEST_F(DicomSeg, AnOrientationOfEachFrameThatIsTheSameIsRead) {
  SegFile seg;
  for (int k = 0; k < 3; ++k) {
    seg.frames.push_back(frameOf(seg, 1, k, pattern));
    seg.frames.back().orientation = seg.orientation;
  }
  save(seg);
  EXPECT_EQ(voxels(read().segmentation, 0),
            std::size_t(std::ranges::count(seg.frames[0].values, 1) +
                        std::ranges::count(seg.frames[1].values, 1) +
                        std::ranges::count(seg.frames[2].values, 1)));
}

TEST_F(DicomSeg, NamesComeOutAsUtf8WhateverTheirCharacterSet) {
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern)};
  const std::string liver = "\xE8\x82\x9D\xE8\x84\x8F";  // of the liver, in Chinese
  const std::pair<const char*, std::string> cases[] = {
      {"ISO_IR 192", liver},
      {"GB18030", "\xB8\xCE\xD4\xE0"},
      {"GBK", "\xB8\xCE\xD4\xE0"},
  };
  for (const auto& [charset, bytes] : cases) {
    seg.charset = charset;
    seg.segments = {{1, bytes}};
    save(seg);
    EXPECT_EQ(read().segmentation.segments[0].name, liver) << charset;
  }
  seg.charset = "ISO_IR 100";
  seg.segments = {{1, "Gef\xE4\xDF"}};
  save(seg);
  EXPECT_EQ(read().segmentation.segments[0].name, "Gef\xC3\xA4\xC3\x9F");
  // What is wrong about them never hurts.
  seg.charset = "ISO_IR 192";
  seg.segments = {{1, "\xFF\xFE liver"}};
  save(seg);
  EXPECT_TRUE(isUtf8(read().segmentation.segments[0].name));
}

TEST_F(DicomSeg, NamesOfEveryScriptAndLengthAreWrittenAndReadBack) {
  const Volume ct = someCt();
  LabelMap map = scattered(ct.geometry, 3);
  const std::string liver = "\xE8\x82\x9D\xE8\x84\x8F";
  std::string longest, longer;
  for (int n = 0; n < 64; ++n) longest += "\xE8\x82\x9D";
  longer = longest + "\xE8\x84\x8F";
  map.structures = {
      {1, liver, Vec3(1, 0, 0)}, {2, longer, Vec3(0, 1, 0)}, {3, "a\\b", Vec3(0, 0, 1)}};
  const auto notes = write(ct, map);
  ASSERT_EQ(notes.size(), 1U);
  const Segmentation s = read(written()).segmentation;
  EXPECT_EQ(s.segments[0].name, liver);
  EXPECT_EQ(s.segments[1].name, longest);
  EXPECT_EQ(s.segments[2].name, "a/b");
}

TEST_F(DicomSeg, ColoursReadBack) {
  const Volume ct = someCt();
  LabelMap map = scattered(ct.geometry, 8);
  std::mt19937 random(4);
  for (Structure& structure : map.structures) {
    for (int n = 0; n < 3; ++n) structure.colour[n] = double(random() % 256) / 255.0;
  }
  map.structures[0].colour = Vec3(0.0);
  map.structures[1].colour = Vec3(1.0);
  map.structures[2].colour = Vec3(1.0, 0.0, 0.0);
  map.structures[3].colour = Vec3(0.0, 0.0, 1.0);
  write(ct, map);
  const Segmentation s = read(written()).segmentation;
  for (std::size_t n = 0; n < 8; ++n) {
    EXPECT_LT(glm::distance(s.segments[n].colour, map.structures[n].colour), 1e-3) << n;
  }
}

TEST(CieLab, WordsAreThoseOfTheStandard) {
  EXPECT_EQ(labOf(Vec3(0.0)), (LabWords{0, 0x8080, 0x8080}));
  const LabWords white = labOf(Vec3(1.0));
  EXPECT_EQ(white[0], 0xFFFF);
  EXPECT_NEAR(white[1], 0x8080, 2);
  EXPECT_NEAR(white[2], 0x8080, 2);
  // Red of sRGB under D50: L* 54.29, a* 80.81, b* 69.89.
  const LabWords red = labOf(Vec3(1, 0, 0));
  EXPECT_NEAR(red[0] / 65535.0 * 100.0, 54.29, 0.02);
  EXPECT_NEAR(red[1] / 65535.0 * 255.0 - 128.0, 80.81, 0.05);
  EXPECT_NEAR(red[2] / 65535.0 * 255.0 - 128.0, 69.89, 0.05);
}

TEST(CieLab, ColoursThatNoScreenShowsStayWithinItsRange) {
  for (const LabWords& lab :
       {LabWords{65535, 65535, 65535}, LabWords{0, 0, 0}, LabWords{32768, 0, 65535}}) {
    const Vec3 colour = srgbOf(lab);
    for (int n = 0; n < 3; ++n) EXPECT_TRUE(colour[n] >= 0.0 && colour[n] <= 1.0);
  }
}

TEST_F(DicomSeg, ASegmentWithoutColourHasThatOfItsLabel) {
  SegFile seg;
  seg.segments = {{1, "a"}, {7, "b", {0, 0x8080, 0x8080}}};
  seg.frames = {frameOf(seg, 1, 0, pattern)};
  save(seg);
  const Segmentation s = read().segmentation;
  EXPECT_EQ(s.segments[0].colour, labelColour(1));
  EXPECT_LT(glm::length(s.segments[1].colour), 1e-6);
}

TEST_F(DicomSeg, AnEmptySegmentIsKeptAndSaid) {
  SegFile seg;
  seg.segments = {{1, "liver"}, {2, "spleen"}, {3, "kidney"}};
  seg.frames = {frameOf(seg, 1, 0, pattern),
                frameOf(seg, 3, 0, [](int, int, int) { return false; })};
  save(seg);
  const Segmentation s = read().segmentation;
  ASSERT_EQ(s.segments.size(), 3U);
  EXPECT_EQ(voxels(s, 1), 0U);
  EXPECT_EQ(voxels(s, 2), 0U);
  ASSERT_EQ(s.notes.size(), 2U);
  EXPECT_NE(s.notes[0].find("spleen"), s.notes[0].npos);
  EXPECT_NE(s.notes[1].find("kidney"), s.notes[1].npos);
}

TEST_F(DicomSeg, FramesOfASegmentThatIsNotNamedAreLeftOutAndSaid) {
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern), frameOf(seg, 9, 1, pattern)};
  save(seg);
  const Segmentation s = read().segmentation;
  EXPECT_EQ(s.segments.size(), 1U);
  EXPECT_EQ(s.notes,
            std::vector<std::string>{"Left out: 1 frame of segments that the file does not name."});
}

TEST_F(DicomSeg, NumbersBeyondThoseOfLabelsBecomeOnesOfTheList) {
  SegFile seg;
  seg.segments = {{700, "a"}, {12, "b"}};
  seg.frames = {frameOf(seg, 700, 0, pattern), frameOf(seg, 12, 0, pattern)};
  save(seg);
  const Segmentation s = read().segmentation;
  EXPECT_EQ(s.segments[0].value, 1);
  EXPECT_EQ(s.segments[1].value, 2);
  EXPECT_EQ(voxels(s, 0), voxels(s, 1));
}

TEST_F(DicomSeg, TwoHundredAndFiftySegmentsAreReadAndThreeHundredRefused) {
  SegFile seg;
  seg.segments.clear();
  for (int n = 1; n <= 250; ++n) {
    seg.segments.push_back({n, "s" + std::to_string(n)});
    seg.frames.push_back(frameOf(seg, n, 0, [](int i, int, int) { return i == 0; }));
  }
  save(seg);
  const Segmentation s = read().segmentation;
  EXPECT_EQ(s.layers.size(), 250U);
  for (int n = 251; n <= 300; ++n) seg.segments.push_back({n, "s"});
  const Error error = refused(seg);
  EXPECT_EQ(error.code.str(), "TOO_MANY_STRUCTURES");
  EXPECT_NE(error.what.find("300"), error.what.npos);
}

TEST_F(DicomSeg, WhatItIsOfIsSaidByHashes) {
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern)};
  DcmDataset data = datasetOf(seg);
  save(data);
  const DicomSegmentation one = read();
  EXPECT_EQ(one.of, (SourceIds{seriesHash("1.2.3"), seriesHash("1.2.3.4"), seriesHash("1.2.3.7")}));
  EXPECT_EQ(one.series, std::vector<std::string>{seriesHash("1.2.3.4")});
  set(itemOf(data, DCM_ReferencedSeriesSequence, 1), DCM_SeriesInstanceUID, "1.2.3.5");
  save(data);
  const DicomSegmentation two = read();
  EXPECT_EQ(two.series.size(), 2U);
  EXPECT_TRUE(two.of.series.empty());
}

TEST_F(DicomSeg, ACutFileIsRefusedAtEveryLength) {
  SegFile seg;
  for (int k = 0; k < 4; ++k) seg.frames.push_back(frameOf(seg, 1, k, pattern));
  for (const bool fractional : {false, true}) {
    seg.fractional = fractional;
    for (const E_TransferSyntax syntax :
         {EXS_LittleEndianExplicit, EXS_DeflatedLittleEndianExplicit}) {
      save(seg, syntax);
      const std::string whole = readBytes(file());
      for (std::size_t length = 0; length + 2 < whole.size(); length += 31) {
        writeBytes(file(), whole.substr(0, length));
        const auto result = readDicomSegmentation(file());
        ASSERT_FALSE(result.ok()) << length << " of " << whole.size();
        EXPECT_FALSE(result.error().code.empty());
      }
    }
  }
  seg.fractional = false;
  save(seg);
  const std::string whole = readBytes(file());
  writeBytes(file(), whole.substr(0, whole.size() - 4));
  EXPECT_EQ(refused().what, "The file is cut short: its frames are not all there");
}

TEST_F(DicomSeg, NoSpoiltByteCrashesTheReader) {
  SegFile seg;
  seg.segments = {{1, "liver"}, {2, "vessel", {30000, 40000, 20000}}};
  for (int k = 0; k < 4; ++k) seg.frames.push_back(frameOf(seg, 1 + k % 2, k, pattern));
  save(seg);
  const std::string whole = readBytes(file());
  std::mt19937 random(7);
  for (int round = 0; round < 400; ++round) {
    std::string bytes = whole;
    for (int n = 0; n < 1 + round % 5; ++n) bytes[random() % bytes.size()] = char(random());
    if (round % 5 == 0) bytes.resize(random() % bytes.size());
    writeBytes(file(), bytes);
    isDicomSegmentation(file());
    const auto result = readDicomSegmentation(file());
    EXPECT_TRUE(result.ok() || !result.error().what.empty());
  }
}

TEST_F(DicomSeg, AbsurdSizesAreRefusedBeforeAnythingIsAllocated) {
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern)};
  const auto spoilt = [&](const Change& change) {
    DcmDataset data = datasetOf(seg);
    change(data);
    save(data);
    return refused().code.str();
  };
  EXPECT_EQ(spoilt([](DcmDataset& d) {
              set16(d, DCM_Rows, 65535);
              set16(d, DCM_Columns, 65535);
            }),
            "TOO_LARGE");
  EXPECT_EQ(spoilt([](DcmDataset& d) { set16(d, DCM_Rows, 8192); }), "SIZE_MISMATCH");
  EXPECT_EQ(spoilt([](DcmDataset& d) { set(d, DCM_NumberOfFrames, "1000000"); }), "SIZE_MISMATCH");
  EXPECT_EQ(spoilt([](DcmDataset& d) { set(d, DCM_NumberOfFrames, "2000000000"); }), "TOO_LARGE");
  EXPECT_EQ(spoilt([](DcmDataset& d) { set16(d, DCM_Rows, 0); }), "SIZE_MISMATCH");
  EXPECT_EQ(spoilt([](DcmDataset& d) { set16(d, DCM_BitsAllocated, 8); }), "SIZE_MISMATCH");
  EXPECT_EQ(spoilt([](DcmDataset& d) { set(d, DCM_NumberOfFrames, "0"); }), "NO_FRAMES");
  EXPECT_EQ(spoilt([](DcmDataset& d) { delete d.remove(DCM_PixelData); }), "NO_FRAMES");
}

TEST_F(DicomSeg, WhatIsMissingIsNamed) {
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern), frameOf(seg, 1, 1, pattern)};
  const auto without = [&](const DcmTagKey& group) {
    DcmDataset data = datasetOf(seg);
    delete itemOf(data, DCM_PerFrameFunctionalGroupsSequence, 1).remove(group);
    delete itemOf(data, DCM_SharedFunctionalGroupsSequence).remove(group);
    save(data);
    return refused();
  };
  EXPECT_EQ(without(DCM_PlanePositionSequence).what, "Frame 2 does not say where it lies");
  EXPECT_EQ(without(DCM_PlaneOrientationSequence).code.str(), "NO_GEOMETRY");
  EXPECT_EQ(without(DCM_PixelMeasuresSequence).code.str(), "NO_GEOMETRY");
  EXPECT_EQ(without(DCM_SegmentIdentificationSequence).code.str(), "UNREADABLE");
  DcmDataset data = datasetOf(seg);
  delete data.remove(DCM_PerFrameFunctionalGroupsSequence);
  save(data);
  EXPECT_EQ(refused().code.str(), "SIZE_MISMATCH");
  data = datasetOf(seg);
  delete data.remove(DCM_SegmentSequence);
  save(data);
  EXPECT_EQ(refused().code.str(), "UNREADABLE");
  seg.segments = {{1, "a"}, {1, "b"}};
  EXPECT_EQ(refused(seg).code.str(), "UNREADABLE");
}

TEST_F(DicomSeg, WhatIsNoSegmentationIsRefusedByName) {
  SeriesFixture::write(rampVolume());
  EXPECT_FALSE(isDicomSegmentation(slice(1)));
  fs::copy_file(slice(1), file());
  EXPECT_EQ(refused().code.str(), "NOT_SEGMENTATION");
  writeBytes(file(), "no DICOM at all, but longer than a preamble" + std::string(500, 'x'));
  EXPECT_FALSE(isDicomSegmentation(file()));
  EXPECT_EQ(refused().code.str(), "NOT_SEGMENTATION");
  writeBytes(file(), "");
  EXPECT_FALSE(isDicomSegmentation(file()));
  EXPECT_EQ(refused().code.str(), "UNREADABLE");
  fs::remove(file());
  EXPECT_FALSE(isDicomSegmentation(file()));
  EXPECT_FALSE(isDicomSegmentation(temporary_ / "out"));
  EXPECT_EQ(refused().code.str(), "UNREADABLE");
}

TEST_F(DicomSeg, AFileOfATerabyteOfNothingIsNoneAndKeepsNobodyWaiting) {
  constexpr std::uintmax_t kHuge = std::uintmax_t(1) << 40;  // of which nothing is stored
  writeBytes(file(), "");
  fs::resize_file(file(), kHuge);
  EXPECT_FALSE(isDicomSegmentation(file()));
  writeBytes(file(), std::string(128, '\0') + "DICM");
  fs::resize_file(file(), kHuge);
  EXPECT_FALSE(isDicomSegmentation(file()));
  // After a good beginning.
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern)};
  save(seg);
  writeBytes(file(), readBytes(file()).substr(0, 600));
  fs::resize_file(file(), kHuge);
  EXPECT_EQ(refused().code.str(), "UNREADABLE");
}

TEST_F(DicomSeg, FramesAlongTheAxisOfATiltedGantryAreReadWhereTheyLie) {
  for (const double tilt : {0.28, -0.28, 0.2, -0.12, 0.05}) {
    SegFile seg;
    for (int k = 0; k < 6; ++k) {
      seg.frames.push_back(frameOf(seg, 1, k, pattern));
      seg.frames.back().position_mm.y += tilt * 2.5 * k;
    }
    save(seg);
    const Segmentation s = read().segmentation;
    ASSERT_EQ(s.geometry.size[2], 6);
    std::size_t voxels_there = 0, voxels = 0;
    for (const std::uint8_t label : s.layers[0]) voxels += label != 0;
    for (int k = 0; k < 6; ++k) {
      const SegFile::Frame& frame = seg.frames[std::size_t(k)];
      for (int j = 0; j < seg.rows; ++j) {
        for (int i = 0; i < seg.columns; ++i) {
          if (!pattern(i, j, k)) continue;
          // Within half a pixel of where the frame has it.
          const Vec3 at = frame.position_mm + Vec3(0.5 * i, 0.75 * j, 0.0);
          const Vec3 v = Vec3(s.geometry.patientToVoxel() * glm::dvec4(at, 1.0));
          const int column = int(std::round(v.x));
          for (const int row : {int(std::floor(v.y)), int(std::ceil(v.y))}) {
            const bool inside = s.geometry.contains(column, row, k) && std::abs(v.y - row) <= 0.501;
            if (!inside || s.layers[0][s.geometry.indexOf(column, row, k)] == 0) continue;
            ++voxels_there;
            break;
          }
        }
      }
    }
    std::size_t marked = 0;
    for (int k = 0; k < 6; ++k) {
      for (int j = 0; j < seg.rows; ++j) {
        for (int i = 0; i < seg.columns; ++i) marked += pattern(i, j, k);
      }
    }
    EXPECT_EQ(voxels, marked) << tilt;
    EXPECT_EQ(voxels_there, marked) << tilt;
  }
}

TEST_F(DicomSeg, ALabelMapSegmentationIsRead) {
  for (int variant = 0; variant < 5; ++variant) {
    SegFile seg;
    seg.fractional = true;  // a byte for each pixel
    seg.segments = {{3, "liver"}, {7, "spleen"}};
    if (variant > 2) seg.segments.push_back({0, "Background"});
    for (int k = 0; k < 4; ++k) {
      seg.frames.push_back(frameOf(seg, 1, k, [&](int i, int j, int n) {
        return (i + j + n) % 3 == 0 ? 3 : (i * j + n + variant) % 4 == 0 ? 7 : 0;
      }));
    }
    DcmDataset data = datasetOf(seg);
    set(data, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.66.7");
    set(data, DCM_SegmentationType, "LABELMAP");
    for (int k = 0; k < 4; ++k) {
      delete itemOf(data, DCM_PerFrameFunctionalGroupsSequence, k)
          .remove(DCM_SegmentIdentificationSequence);
    }
    save(data);
    const Segmentation s = read().segmentation;
    ASSERT_EQ(s.layers.size(), 1u);
    ASSERT_EQ(s.segments.size(), 2u);
    EXPECT_EQ(s.segments[0].name, "liver");
    EXPECT_EQ(s.segments[1].value, 7);
    for (int k = 0; k < 4; ++k) {
      for (int n = 0; n < seg.rows * seg.columns; ++n) {
        ASSERT_EQ(int(s.layers[0][std::size_t(k * seg.rows * seg.columns + n)]),
                  seg.frames[std::size_t(k)].values[std::size_t(n)]);
      }
    }
  }
}

TEST_F(DicomSeg, ASegmentationIsToldFromOthersAndOtherKindsAreNamed) {
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern)};
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit,
                                        EXS_BigEndianExplicit, EXS_DeflatedLittleEndianExplicit}) {
    save(seg, syntax);
    EXPECT_TRUE(isDicomSegmentation(file()));
  }
  DcmDataset data = datasetOf(seg);
  set(data, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.66.7");
  save(data);
  EXPECT_TRUE(isDicomSegmentation(file()));
  EXPECT_EQ(refused().code.str(), "UNSUPPORTED_SEGMENTATION") << "it does not say that it is one";
  data = datasetOf(seg);
  set(data, DCM_SegmentationType, "LABELMAP");
  save(data);
  EXPECT_EQ(refused().code.str(), "UNSUPPORTED_SEGMENTATION");
}

TEST_F(DicomSeg, SequencesNestedDeepDoNotExhaustTheStack) {
  SegFile seg;
  seg.frames = {frameOf(seg, 1, 0, pattern)};
  save(seg);
  const std::string whole = readBytes(file());
  // A private sequence in group 9, before Patient Name and after the SOP classes.
  const std::size_t at = whole.find(std::string("\x10\x00\x10\x00", 4));
  ASSERT_NE(at, whole.npos);
  std::string nested;
  for (int n = 0; n < 200000; ++n) {
    nested +=
        std::string("\x09\x00\x40\x11SQ\0\0\xFF\xFF\xFF\xFF\xFE\xFF\x00\xE0\xFF\xFF\xFF\xFF", 20);
  }
  writeBytes(file(), whole.substr(0, at) + nested + whole.substr(at));
  EXPECT_TRUE(isDicomSegmentation(file()));
  EXPECT_EQ(refused().code.str(), "UNREADABLE");
}

TEST_F(DicomSeg, CancelledReadingIsSaid) {
  SegFile seg;
  for (int k = 0; k < 4; ++k) seg.frames.push_back(frameOf(seg, 1, k, pattern));
  save(seg);
  Progress before;
  before.cancel();
  EXPECT_EQ(readDicomSegmentation(file(), 0.5, before).error().code.str(), "CANCELLED");
  Progress* at_frames = nullptr;
  Progress during([&](double fraction, const std::string&) {
    if (fraction > 0.5) at_frames->cancel();
  });
  at_frames = &during;
  EXPECT_EQ(readDicomSegmentation(file(), 0.5, during).error().code.str(), "CANCELLED");
}

TEST_F(DicomSeg, WithoutASourceTheCtIsWrittenBesideAndBothAreOfOneNewStudy) {
  const Volume ct = someCt();
  write(ct, scattered(ct.geometry, 2));
  EXPECT_EQ(std::distance(fs::directory_iterator(temporary_ / "out"), fs::directory_iterator{}), 2);
  std::set<std::string> instances;
  std::string study, frame;
  for (const auto& entry : fs::directory_iterator(temporary_ / "out" / "CT")) {
    edit(entry.path(), [&](DcmDataset& data) {
      EXPECT_EQ(text(data, DCM_PatientName), "TREPHINE^CASE");
      EXPECT_EQ(text(data, DCM_PatientID), "CASE");
      instances.insert(text(data, DCM_SOPInstanceUID));
      study = text(data, DCM_StudyInstanceUID);
      frame = text(data, DCM_FrameOfReferenceUID);
    });
  }
  EXPECT_EQ(instances.size(), 6U);
  edit(written(), [&](DcmDataset& data) {
    EXPECT_EQ(text(data, DCM_PatientName), "TREPHINE^CASE");
    EXPECT_EQ(text(data, DCM_StudyInstanceUID), study);
    EXPECT_EQ(text(data, DCM_ContentDate), "19000101");
    EXPECT_EQ(text(data, DCM_ContentTime), "000000");
    EXPECT_EQ(text(data, DCM_FrameOfReferenceUID), frame);
  });
  CtFolder folder = scan(temporary_ / "out");
  const auto best = folder.bestSeries();
  ASSERT_TRUE(best.has_value());
  const auto volume = folder.read(*best, {}, Progress());
  ASSERT_TRUE(volume.ok());
  EXPECT_EQ(volume->hu, ct.hu);
  // The segmentation says of which CT it is, in the words of the CT's provenance.
  EXPECT_EQ(read(written()).of, folder.report().provenance->source_ids);
}

TEST_F(DicomSeg, EqualContentGivesEqualFiles) {
  const Volume ct = someCt();
  LabelMap map = scattered(ct.geometry, 2);
  write(ct, map);
  const std::string first = readBytes(written());
  fs::remove_all(temporary_ / "out");
  write(ct, map);
  EXPECT_EQ(readBytes(written()), first);
  fs::remove_all(temporary_ / "out");
  map.structures[0].colour = Vec3(0.25);
  write(ct, map);
  EXPECT_NE(readBytes(written()), first);
}

TEST_F(DicomSeg, WithASourceTheSegmentationAloneIsWrittenAndRefersToIt) {
  Volume ct = someCt();
  SegWriting writing;
  writing.source = RawSourceUids{"1.2.3", "1.2.3.4", "1.2.3.7"};
  // The source has slices half as far apart, in any order, and none beyond the middle.
  for (const int n : {3, 0, 4, 1, 2}) {
    writing.source->slices.push_back({UID_CTImageStorage, "1.2.3.4." + std::to_string(n), 0,
                                      ct.geometry.toPatient_mm(Vec3(0, 0, 0.5 * n))});
  }
  write(ct, scattered(ct.geometry, 1), writing);
  EXPECT_FALSE(fs::exists(temporary_ / "out" / "CT"));
  const DicomSegmentation back = read(written());
  EXPECT_EQ(back.of,
            (SourceIds{seriesHash("1.2.3"), seriesHash("1.2.3.4"), seriesHash("1.2.3.7")}));
  edit(written(), [&](DcmDataset& data) {
    for (long n = 0; n < 6; ++n) {
      DcmItem& frame = itemOf(data, DCM_PerFrameFunctionalGroupsSequence, n);
      OFString uid;
      DcmItem* derivation = nullptr;
      if (frame.findAndGetSequenceItem(DCM_DerivationImageSequence, derivation).good()) {
        itemOf(*derivation, DCM_SourceImageSequence)
            .findAndGetOFString(DCM_ReferencedSOPInstanceUID, uid);
      }
      EXPECT_EQ(std::string(uid.c_str()), n < 3 ? "1.2.3.4." + std::to_string(2 * n) : "");
    }
  });
  fs::remove_all(temporary_ / "out");
  writing.source->study = "somebody";
  const auto refused_source =
      writeStructuresAsDicom(ct, scattered(ct.geometry, 1), temporary_ / "out", writing);
  EXPECT_EQ(refused_source.error().code.str(), "BAD_SOURCE");
}

TEST_F(DicomSeg, StructuresWithoutVoxelsAreLeftOutAndSaid) {
  const Volume ct = someCt();
  LabelMap map = scattered(ct.geometry, 2);
  map.structures.push_back({9, "spleen", Vec3(1.0)});
  const auto notes = write(ct, map);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("spleen"), notes[0].npos);
  EXPECT_EQ(read(written()).segmentation.segments.size(), 2U);
  fs::remove_all(temporary_ / "out");
  std::ranges::fill(map.labels, std::uint8_t(0));
  EXPECT_EQ(writeStructuresAsDicom(ct, map, temporary_ / "out").error().code.str(),
            "NO_STRUCTURES");
  EXPECT_FALSE(fs::exists(temporary_ / "out"));
}

TEST_F(DicomSeg, NothingIsOverwrittenAndNothingHalfWrittenIsLeft) {
  const Volume ct = someCt();
  const LabelMap map = scattered(ct.geometry, 2);
  const fs::path out = temporary_ / "out";
  Progress* at_structures = nullptr;
  Progress progress([&](double fraction, const std::string&) {
    if (fraction > 0.7) at_structures->cancel();
  });
  at_structures = &progress;
  EXPECT_EQ(writeStructuresAsDicom(ct, map, out, {}, progress).error().code.str(), "CANCELLED");
  EXPECT_FALSE(fs::exists(out));
  for (const char* name : {"structures.dcm", "CT/IM0001.dcm"}) {
    fs::remove_all(out);
    writeBytes(out / name, "mine");
    EXPECT_EQ(writeStructuresAsDicom(ct, map, out).error().code.str(), "CANNOT_WRITE");
    EXPECT_EQ(readBytes(out / name), "mine");
    EXPECT_EQ(std::distance(fs::directory_iterator(out), fs::directory_iterator{}), 1);
  }
  writeBytes(temporary_ / "file", "x");
  EXPECT_EQ(writeStructuresAsDicom(ct, map, temporary_ / "file").error().code.str(),
            "CANNOT_WRITE");
}

TEST_F(DicomSeg, StructuresOnAnotherGridAreRefused) {
  const Volume ct = someCt();
  LabelMap map = scattered(ct.geometry, 2);
  map.geometry.origin_mm.x += 1.0;
  EXPECT_EQ(writeStructuresAsDicom(ct, map, temporary_ / "out").error().code.str(),
            "LABELS_ELSEWHERE");
}

TEST(SegCodes, NamesSayWhatAStructureIsByTheirLastWords) {
  const auto type = [](const char* name) { return std::string(segmentCodesOf(name).type.meaning); };
  EXPECT_EQ(type("Liver"), "Liver");
  EXPECT_EQ(std::string(segmentCodesOf("Liver").type.value), "10200004");
  EXPECT_EQ(std::string(segmentCodesOf("Liver").category.value), "123037004");
  EXPECT_EQ(type("liver vessels"), "Blood vessel");
  EXPECT_EQ(type("kidney_left"), "Kidney");
  EXPECT_EQ(type("Left_Kidney"), "Kidney");
  EXPECT_EQ(type("rib_right_12"), "Rib");
  EXPECT_EQ(type("portal vein"), "Portal vein");
  EXPECT_EQ(type("gallbladder"), "Gallbladder");
  EXPECT_EQ(type("liver tumour 2"), "Neoplasm");
  EXPECT_EQ(std::string(segmentCodesOf("liver tumour").category.value), "49755003");
  EXPECT_EQ(type("kidney stone"), "Tissue");
  EXPECT_EQ(type("deliver"), "Tissue");
  EXPECT_EQ(type(""), "Tissue");
  EXPECT_EQ(type("1"), "Tissue");
  EXPECT_EQ(type("\xE8\x82\x9D"), "Tissue");
}

TEST_F(DicomSeg, AProvenanceKnowsItsSourceAndWritesNothingOfIt) {
  SeriesFixture::write(rampVolume());
  const std::string study = "1.2.826.0.1.3680043.9.1";
  editAll([&](DcmDataset& data) { put(data, DCM_StudyInstanceUID, study); });
  import();
  const SourceIds& ids = report_.provenance->source_ids;
  EXPECT_EQ(ids.study, seriesHash(study));
  EXPECT_EQ(ids.series, seriesHash(*report_.chosen));
  EXPECT_EQ(ids.frame_of_reference.size(), 32U);
  const std::string json = toJson(report_).at("provenance").dump();
  EXPECT_EQ(json.find(ids.study), json.npos);
  EXPECT_EQ(json.find(study), json.npos);
  EXPECT_EQ(json.find("2.25."), json.npos);
}

TEST_F(DicomSeg, SlicesThatDoNotAgreeOnAFrameOfReferenceAreOfNone) {
  SeriesFixture::write(rampVolume());
  edit(slice(3), [](DcmDataset& data) { put(data, DCM_FrameOfReferenceUID, "1.2.3"); });
  import({{ code::kParts, "join" }});
  EXPECT_TRUE(report_.provenance->source_ids.frame_of_reference.empty());
  EXPECT_FALSE(report_.provenance->source_ids.study.empty());
}

}  // namespace trephine::test
