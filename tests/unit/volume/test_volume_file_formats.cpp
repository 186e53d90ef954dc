// Every format in every orientation, byte order, packing and type: the value of a voxel is a
// function of where it lies in the patient, so a wrong axis, sign, order or byte shows.
#include "base/memory.h"
#include "file_bytes.h"
#include "support.h"
#include "volumes.h"

namespace trephine {
namespace {

namespace fs = std::filesystem;
using namespace test;

constexpr VoxelType kTypes[] = {
    VoxelType::int8,   VoxelType::uint8, VoxelType::int16,  VoxelType::uint16,  VoxelType::int32,
    VoxelType::uint32, VoxelType::int64, VoxelType::uint64, VoxelType::float32, VoxelType::float64};

struct Image {
  Index3 size{4, 3, 5};
  Vec3 spacing{1, 2, 3};
  Vec3 origin{20, 21, 19};
  Mat3 direction{1.0};
  VoxelType type = VoxelType::int16;
  bool big_endian = false;
  Packing packing = Packing::none;

  Vec3 axis(int a) const { return direction[a] * spacing[a]; }
};

// Whole numbers from 0 on that differ from voxel to voxel; for 8 bits they repeat.
double valueAt(const Vec3& lps, VoxelType type) {
  const double value = lps.x + 35 * lps.y + 900 * lps.z;
  return bytesOf(type) == 1 ? std::fmod(value, 101.0) : value;
}

std::string voxelsOf(const Image& image) {
  std::string bytes;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i) {
        const Vec3 lps = image.origin + image.axis(0) * double(i) + image.axis(1) * double(j) +
                         image.axis(2) * double(k);
        appendAs(bytes, image.type, valueAt(lps, image.type), image.big_endian);
      }
    }
  }
  return bytes;
}

// ---- One writer a format; each returns the file to open.

const char* const kNrrdTypes[] = {"signed char",  "unsigned char", "short",  "uint16_t", "int",
                                  "unsigned int", "long long",     "uint64", "float",    "double"};

std::string nrrdHeader(const Image& image, const std::string& space, const Vec3& signs,
                       const std::string& more) {
  std::string axes;
  for (int a = 0; a < 3; ++a) axes += "(" + vectorText(image.axis(a) * signs, ",") + ") ";
  return "NRRD0005\n# made by a test\ntype: " + std::string(kNrrdTypes[int(image.type)]) +
         "\ndimension: 3\nspace: " + space + "\nsizes: 4 3 5\nspace directions: " + axes +
         "\nkinds: domain domain domain\nendian: " + (image.big_endian ? "big" : "little") +
         "\nencoding: " + (image.packing == Packing::none ? "raw" : "gzip") + "\nspace origin: (" +
         vectorText(image.origin * signs, ",") + ")\n" + more + "mine:=not: yours\n\n";
}

fs::path writeNrrd(const Image& image, const fs::path& folder) {
  writeBytes(
      folder / "a.nrrd",
      nrrdHeader(image, "left-posterior-superior", Vec3(1.0), "") +
          packed(voxelsOf(image), image.packing == Packing::none ? Packing::none : Packing::gzip));
  return folder / "a.nrrd";
}

fs::path writeNhdr(const Image& image, const fs::path& folder) {
  writeBytes(folder / "a.nhdr", nrrdHeader(image, "RAS", {-1, -1, 1}, "data file: b.bin\n"));
  writeBytes(
      folder / "b.bin",
      packed(voxelsOf(image), image.packing == Packing::none ? Packing::none : Packing::gzip));
  return folder / "a.nhdr";
}

std::string metaHeader(const Image& image, const std::string& data) {
  const char* types[] = {"MET_CHAR", "MET_UCHAR",     "MET_SHORT",      "MET_USHORT", "MET_INT",
                         "MET_UINT", "MET_LONG_LONG", "MET_ULONG_LONG", "MET_FLOAT",  "MET_DOUBLE"};
  std::string matrix;
  for (int a = 0; a < 3; ++a) matrix += vectorText(image.direction[a], " ") + " ";
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = " +
         std::string(image.big_endian ? "True" : "False") +
         "\nCompressedData = " + (image.packing == Packing::none ? "False" : "True") +
         "\nTransformMatrix = " + matrix + "\nOffset = " + vectorText(image.origin, " ") +
         "\nElementSpacing = " + vectorText(image.spacing, " ") +
         "\nDimSize = 4 3 5\nElementType = " + types[int(image.type)] +
         "\nElementDataFile = " + data + "\n";
}

fs::path writeMha(const Image& image, const fs::path& folder) {
  writeBytes(
      folder / "a.mha",
      metaHeader(image, "LOCAL") +
          packed(voxelsOf(image), image.packing == Packing::none ? Packing::none : Packing::zlib));
  return folder / "a.mha";
}

fs::path writeMhd(const Image& image, const fs::path& folder) {
  writeBytes(folder / "a.mhd", metaHeader(image, "a.zraw"));
  writeBytes(
      folder / "a.zraw",
      packed(voxelsOf(image), image.packing == Packing::none ? Packing::none : Packing::zlib));
  return folder / "a.mhd";
}

template <class T>
void put(std::string& bytes, std::size_t at, T value, bool big_endian) {
  std::string raw;
  append(raw, value, big_endian);
  bytes.replace(at, raw.size(), raw);
}

std::string niftiHeader(const Image& image) {
  const int types[] = {256, 2, 4, 512, 8, 768, 1024, 1280, 16, 64};
  const bool big = image.big_endian;
  std::string h(352, '\0');
  put(h, 0, std::int32_t(348), big);
  const std::int16_t dim[] = {3, 4, 3, 5, 1, 1, 1, 1};
  for (std::size_t d = 0; d < 8; ++d) put(h, 40 + 2 * d, dim[d], big);
  put(h, 70, std::int16_t(types[int(image.type)]), big);
  put(h, 72, std::int16_t(8 * bytesOf(image.type)), big);
  put(h, 76, 1.0f, big);
  for (int a = 0; a < 3; ++a) put(h, std::size_t(80 + 4 * a), float(image.spacing[a]), big);
  put(h, 108, 352.0f, big);
  h[123] = 2;  // mm
  put(h, 254, std::int16_t(1), big);
  for (int row = 0; row < 3; ++row) {
    const double sign = row < 2 ? -1.0 : 1.0;  // RAS
    for (int a = 0; a < 3; ++a) {
      put(h, std::size_t(280 + 16 * row + 4 * a), float(sign * image.axis(a)[row]), big);
    }
    put(h, std::size_t(292 + 16 * row), float(sign * image.origin[row]), big);
  }
  h.replace(344, 3, "n+1");
  return h;
}

fs::path writeNii(const Image& image, const fs::path& folder) {
  const bool pack = image.packing != Packing::none;
  const fs::path file = folder / (pack ? "a.nii.gz" : "a.nii");
  writeBytes(file,
             packed(niftiHeader(image) + voxelsOf(image), pack ? Packing::gzip : Packing::none));
  return file;
}

fs::path writeNifti2(const Image& image, const fs::path& folder) {
  const std::string first = niftiHeader(image);
  const bool big = image.big_endian, pack = image.packing != Packing::none;
  std::string h(544, '\0');
  put(h, 0, std::int32_t(540), big);
  h.replace(4, 8, std::string("n+2\0\r\n\032\n", 8));
  h.replace(12, 4, first.substr(70, 4));  // type and bits
  const std::int64_t dim[] = {3, 4, 3, 5, 1, 1, 1, 1};
  for (std::size_t d = 0; d < 8; ++d) put(h, 16 + 8 * d, dim[d], big);
  for (std::size_t a = 0; a < 3; ++a) put(h, 112 + 8 * a, image.spacing[int(a)], big);
  put(h, 104, 1.0, big);
  put(h, 168, std::int64_t(544), big);
  put(h, 348, std::int32_t(1), big);  // sform
  for (int row = 0; row < 3; ++row) {
    const double sign = row < 2 ? -1.0 : 1.0;  // RAS
    for (int a = 0; a < 3; ++a) {
      put(h, std::size_t(400 + 32 * row + 8 * a), sign * image.axis(a)[row], big);
    }
    put(h, std::size_t(424 + 32 * row), sign * image.origin[row], big);
  }
  put(h, 500, std::int32_t(2), big);  // mm
  writeBytes(folder / "b.nii", packed(h + voxelsOf(image), pack ? Packing::gzip : Packing::none));
  return folder / "b.nii";
}

fs::path writeRaw(const Image& image, const fs::path& folder) {
  std::string direction;
  for (int row = 0; row < 3; ++row) {
    for (int a = 0; a < 3; ++a) {
      direction += (row + a ? ", " : "") + std::to_string(image.direction[a][row]);
    }
  }
  writeBytes(folder / "a.json",
             "{\"size\": [4, 3, 5], \"spacing_mm\": [" + vectorText(image.spacing, ", ") +
                 "], \"type\": \"" + voxelTypeName(image.type) + "\", \"byte_order\": \"" +
                 (image.big_endian ? "big" : "little") + "\", \"origin_mm\": [" +
                 vectorText(image.origin, ", ") + "], \"direction\": [" + direction + "]}");
  writeBytes(folder / "a.raw", voxelsOf(image));
  return folder / "a.raw";
}

using Writer = fs::path (*)(const Image&, const fs::path&);
struct Format {
  const char* name;
  Writer write;
  bool packs;
};
constexpr Format kFormats[] = {{"NRRD", writeNrrd, true},     {"NRRD", writeNhdr, true},
                               {"MetaImage", writeMha, true}, {"MetaImage", writeMhd, true},
                               {"NIfTI", writeNii, true},     {"NIfTI", writeNifti2, true},
                               {"raw", writeRaw, false}};

std::vector<Mat3> allOrientations() {
  std::vector<Mat3> all;
  const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (const auto& order : orders) {
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 direction(0.0);
      for (int a = 0; a < 3; ++a) direction[a][order[a]] = signs >> a & 1 ? -1.0 : 1.0;
      all.push_back(direction);
    }
  }
  return all;
}

void expectReadAsWritten(const fs::path& file, const Image& image) {
  const auto reading = readVolumeFile(file);
  ASSERT_TRUE(reading) << reading.error().sentence();
  const GridGeometry& g = reading->volume.geometry;
  EXPECT_EQ(g.size, image.size);
  EXPECT_EQ(g.spacing_mm, image.spacing);
  EXPECT_GT(glm::determinant(g.direction), 0.0);
  EXPECT_EQ(reading->header.reversed_slices, glm::determinant(image.direction) < 0.0);
  EXPECT_EQ(reading->header.geometry, g);
  EXPECT_EQ(reading->header.type, image.type);
  EXPECT_EQ(reading->rounded + reading->clamped + reading->not_numbers, 0u);
  double low = 1e9, high = -1e9;
  int wrong = 0;
  for (std::size_t v = 0; v < reading->volume.hu.size(); ++v) {
    const Index3 at = g.indicesOf(v);
    const double expected = valueAt(g.toPatient_mm({at[0], at[1], at[2]}), image.type);
    wrong += reading->volume.hu[v] != expected;
    low = std::min(low, expected);
    high = std::max(high, expected);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(reading->hu_min, low);
  EXPECT_EQ(reading->hu_max, high);
}

TEST(VolumeFileFormats, EveryOrientationByteOrderAndPacking) {
  const TemporaryFolder folder;
  int count = 0;
  for (const Format& format : kFormats) {
    for (const Mat3& direction : allOrientations()) {
      for (int variant = 0; variant < (format.packs ? 4 : 2); ++variant) {
        Image image;
        image.direction = direction;
        image.big_endian = variant & 1;
        image.packing = variant & 2 ? Packing::gzip : Packing::none;
        SCOPED_TRACE(std::string(format.name) + " " + std::to_string(count++));
        expectReadAsWritten(format.write(image, folder.path()), image);
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_EQ(count, 6 * 48 * 4 + 48 * 2);
}

TEST(VolumeFileFormats, EveryTypeInEitherByteOrder) {
  const TemporaryFolder folder;
  for (const Format& format : kFormats) {
    for (const VoxelType type : kTypes) {
      for (int variant = 0; variant < (format.packs ? 4 : 2); ++variant) {
        Image image;
        image.type = type;
        image.big_endian = variant & 1;
        image.packing = variant & 2 ? Packing::gzip : Packing::none;
        SCOPED_TRACE(std::string(format.name) + " " + voxelTypeName(type));
        const fs::path file = format.write(image, folder.path());
        expectReadAsWritten(file, image);
        const auto header = readVolumeFileHeader(file);
        ASSERT_TRUE(header);
        EXPECT_EQ(header->format, format.name);
        EXPECT_EQ(header->big_endian, image.big_endian);
        EXPECT_EQ(header->data.packed, image.packing != Packing::none);
        EXPECT_EQ(header->storedBytes(), 60u * unsigned(bytesOf(type)));
        EXPECT_EQ(header->geometry.voxelCount(), 60u);
      }
    }
  }
}

TEST(VolumeFileFormats, NrrdSpacesInFullAndInShort) {
  const TemporaryFolder folder;
  const std::pair<const char*, Vec3> spaces[] = {
      {"left-posterior-superior", {1, 1, 1}},   {"LPS", {1, 1, 1}},
      {"right-anterior-superior", {-1, -1, 1}}, {"RAS", {-1, -1, 1}},
      {"left-anterior-superior", {1, -1, 1}},   {"LAS", {1, -1, 1}}};
  for (const auto& [space, signs] : spaces) {
    for (const Mat3& direction : allOrientations()) {
      Image image;
      image.direction = direction;
      SCOPED_TRACE(space);
      writeBytes(folder / "a.nrrd", nrrdHeader(image, space, signs, "") + voxelsOf(image));
      expectReadAsWritten(folder / "a.nrrd", image);
    }
  }
}

TEST(VolumeFileFormats, TheQformOfNiftiTwo) {
  const TemporaryFolder folder;
  Image image;
  for (const bool big : {false, true}) {
    image.big_endian = big;
    const fs::path file = writeNifti2(image, folder.path());
    std::string bytes = bytesOf(file);
    put(bytes, 344, std::int32_t(1), big);
    put(bytes, 348, std::int32_t(0), big);
    put(bytes, 368, 1.0, big);  // half a turn about z: from RAS to LPS
    const double origin[] = {-image.origin.x, -image.origin.y, image.origin.z};
    for (std::size_t a = 0; a < 3; ++a) put(bytes, 376 + 8 * a, origin[a], big);
    for (std::size_t i = 400; i < 496; ++i) bytes[i] = 0;
    writeBytes(file, bytes);
    expectReadAsWritten(file, image);
  }
}

// ---- Spoilt files: any answer but a crash, a print or an impossible volume.

void expectSane(const fs::path& file) {
  const auto reading = readVolumeFile(file);
  if (!reading) {
    EXPECT_FALSE(reading.error().what.empty());
    return;
  }
  const GridGeometry& g = reading->volume.geometry;
  EXPECT_EQ(reading->volume.hu.size(), g.voxelCount());
  EXPECT_TRUE(isFinite(g.origin_mm) && isFinite(g.spacing_mm));
  EXPECT_GT(glm::determinant(g.direction), 0.9);
}

TEST(VolumeFileFormats, SpoiltBytesAreSurvived) {
  const TemporaryFolder folder;
  ::testing::internal::CaptureStderr();
  const double before = peakResidentMb();
  std::uint32_t state = 7;
  const auto random = [&](std::size_t below) {
    state = state * 1664525u + 1013904223u;
    return std::size_t(state >> 8) % below;
  };
  for (const Format& format : kFormats) {
    for (int packing = 0; packing < (format.packs ? 2 : 1); ++packing) {
      Image image;
      image.packing = packing ? Packing::gzip : Packing::none;
      const fs::path opened = format.write(image, folder.path());
      // A raw file's sidecar is what can be spoilt.
      const fs::path file = opened.extension() == ".raw" ? folder / "a.json" : opened;
      const std::string whole = bytesOf(file);
      for (int n = 0; n < 1500; ++n) {
        std::string bytes = whole;
        const std::size_t changes = 1 + random(3);
        for (std::size_t c = 0; c < changes; ++c) {
          const std::size_t at = random(bytes.size());
          switch (random(4)) {
            case 0:
              bytes[at] = char(random(256));
              break;
            case 1:
              bytes[at] = "0123456789-.(),: \n\"{}"[random(21)];
              break;
            case 2:
              bytes.erase(at, 1 + random(8));
              break;
            default:
              bytes.insert(at, bytes.substr(random(bytes.size()), random(12)));
          }
          if (bytes.empty()) break;
        }
        writeBytes(file, bytes);
        expectSane(opened);
      }
      for (std::size_t length = 0; length < whole.size(); ++length) {
        writeBytes(file, whole.substr(0, length));
        expectSane(opened);
      }
      writeBytes(file, whole);
      EXPECT_EQ(codeOf(opened), "ok");
    }
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_LT(peakResidentMb() - before, 500.0) << "an address sanitizer keeps what was freed";
}

}  // namespace
}  // namespace trephine
