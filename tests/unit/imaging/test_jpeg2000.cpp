#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <openjpeg.h>

#include <chrono>
#include <random>
#include <thread>
#include <vector>

#include "imaging/jpeg2000.h"
#include "series_fixture.h"

namespace trephine::test {

namespace {

using Bytes = std::vector<std::uint8_t>;
using Words = std::vector<std::int16_t>;

struct Picture {
  int columns = 61, rows = 47;  // odd, so that edges of tiles and wavelet levels are not whole
  int bits = 12;
  bool is_signed = false;
  std::vector<int> samples = {};
};

// Every sample differs from its neighbours; the range is that of the bits.
Picture ramp(int bits, bool is_signed, int columns = 61, int rows = 47) {
  Picture picture{columns, rows, bits, is_signed};
  const int range = 1 << bits, low = is_signed ? -range / 2 : 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      picture.samples.push_back(low + (x * 1021 + y * 617 + (x * y) % 13) % range);
    }
  }
  return picture;
}

struct Coding {
  int tile = 0;  // columns and rows of a tile; 0: one tile
  bool irreversible = false;
  float ratio = 0;  // of compression; 0: lossless
  int layers = 1;
  int precinct = 0;  // columns and rows of a precinct; 0: one a resolution
  bool jp2 = false;
  int channels = 1;
};

// What OpenJPEG itself writes.
Bytes encode(const Picture& picture, const Coding& coding = {}) {
  opj_cparameters_t parameters;
  opj_set_default_encoder_parameters(&parameters);
  parameters.numresolution = 4;
  parameters.irreversible = coding.irreversible;
  parameters.tcp_numlayers = coding.layers;
  for (int i = 0; i < coding.layers; ++i) {
    parameters.tcp_rates[i] = coding.ratio * float(coding.layers - i);
  }
  parameters.tcp_rates[coding.layers - 1] = coding.ratio;
  parameters.cp_disto_alloc = 1;
  if (coding.tile) {
    parameters.tile_size_on = OPJ_TRUE;
    parameters.cp_tdx = parameters.cp_tdy = coding.tile;
  }
  if (coding.precinct) {
    parameters.csty |= 1;
    parameters.res_spec = parameters.numresolution;
    for (int i = 0; i < parameters.res_spec; ++i) {
      parameters.prcw_init[i] = parameters.prch_init[i] = coding.precinct;
    }
  }
  std::vector<opj_image_cmptparm_t> components(std::size_t(coding.channels));
  for (auto& component : components) {
    component = {};
    component.dx = component.dy = 1;
    component.w = unsigned(picture.columns);
    component.h = unsigned(picture.rows);
    component.prec = unsigned(picture.bits);
    component.sgnd = picture.is_signed;
  }
  opj_image_t* image =
      opj_image_create(unsigned(coding.channels), components.data(), OPJ_CLRSPC_GRAY);
  image->x1 = unsigned(picture.columns);
  image->y1 = unsigned(picture.rows);
  for (int c = 0; c < coding.channels; ++c) {
    std::ranges::copy(picture.samples, image->comps[c].data);
  }

  struct Sink {
    Bytes bytes;
    std::size_t at = 0;
  } sink;
  opj_stream_t* stream = opj_stream_default_create(OPJ_FALSE);
  opj_stream_set_user_data(stream, &sink, nullptr);
  opj_stream_set_write_function(stream, [](void* from, OPJ_SIZE_T count, void* user) {
    Sink& to = *static_cast<Sink*>(user);
    to.bytes.resize(std::max(to.bytes.size(), to.at + count));
    std::copy_n(static_cast<std::uint8_t*>(from), count, to.bytes.begin() + std::ptrdiff_t(to.at));
    to.at += count;
    return count;
  });
  opj_stream_set_skip_function(stream, [](OPJ_OFF_T count, void* user) {
    static_cast<Sink*>(user)->at += std::size_t(count);
    return count;
  });
  opj_stream_set_seek_function(stream, [](OPJ_OFF_T to, void* user) -> OPJ_BOOL {
    static_cast<Sink*>(user)->at = std::size_t(to);
    return OPJ_TRUE;
  });
  opj_codec_t* codec = opj_create_compress(coding.jp2 ? OPJ_CODEC_JP2 : OPJ_CODEC_J2K);
  EXPECT_TRUE(opj_setup_encoder(codec, &parameters, image));
  EXPECT_TRUE(opj_start_compress(codec, image, stream) && opj_encode(codec, stream) &&
              opj_end_compress(codec, stream));
  opj_stream_destroy(stream);
  opj_destroy_codec(codec);
  opj_image_destroy(image);
  return sink.bytes;
}

Jpeg2000Expectation expectation(const Picture& picture) {
  return {picture.rows, picture.columns, picture.bits > 8 ? 16 : 8, picture.bits,
          picture.is_signed};
}

// The values of the words in the sense of `expected`; none, and the reason, after an error.
struct Decoded {
  std::vector<int> values;
  std::string error;
};

Decoded decode(const Bytes& bytes, const Jpeg2000Expectation& expected) {
  Words words(std::size_t(expected.rows) * std::size_t(expected.columns));
  const Status status = decodeJpeg2000(bytes, expected, words.data());
  if (!status.ok()) {
    EXPECT_EQ(status.error().code, "UNREADABLE");
    return {{}, status.error().what};
  }
  Decoded decoded;
  for (const std::int16_t word : words) {
    decoded.values.push_back(expected.is_signed ? word : int(std::uint16_t(word)));
  }
  return decoded;
}

std::string whyRefused(const Bytes& bytes, const Jpeg2000Expectation& expected) {
  const Decoded decoded = decode(bytes, expected);
  return decoded.error;
}

constexpr auto kDamaged = "its JPEG 2000 picture is cut short or damaged";

void put(Bytes& bytes, std::size_t at, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) {
    bytes.at(at + std::size_t(i)) = std::uint8_t(value >> (8 * (size - 1 - i)));
  }
}

// Where a marker stands.
std::size_t find(const Bytes& bytes, std::uint8_t marker, std::size_t from = 0) {
  const std::uint8_t pattern[] = {0xFF, marker};
  const auto at = std::search(bytes.begin() + std::ptrdiff_t(from), bytes.end(), pattern,
                              pattern + sizeof pattern);
  EXPECT_NE(at, bytes.end());
  return std::size_t(at - bytes.begin());
}

constexpr std::uint8_t kCod = 0x52, kCom = 0x64, kSot = 0x90;
constexpr std::size_t kSiz = 2;  // the first marker behind the start

Bytes first(const Bytes& bytes, std::size_t count) {
  return Bytes(bytes.begin(), bytes.begin() + std::ptrdiff_t(count));
}

int largestDifference(const std::vector<int>& a, const std::vector<int>& b) {
  EXPECT_EQ(a.size(), b.size());
  int most = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
  }
  return most;
}

// The HTJ2K codestreams of data/README.md.
struct HighThroughput {
  const char* file;
  bool is_signed;
  int (*sample)(int x, int y);
};
int unsignedRamp(int x, int y) {
  return 1021 * x + 17 * y + (x * y) % 13;
}
int signedRamp(int x, int y) {
  return -1024 + 37 * x + 19 * y + (x * y) % 13;
}
constexpr HighThroughput kLossless[] = {
    {"htj2k_unsigned.j2c", false, unsignedRamp},
    {"htj2k_signed_rpcl_tiles.j2c", true, signedRamp},
};
constexpr HighThroughput kIrreversible = {"htj2k_irreversible.j2c", true, signedRamp};

Bytes bytesOf(const HighThroughput& picture) {
  const auto text = readBytes(std::filesystem::path(TREPHINE_TEST_IMAGING_DATA) / picture.file);
  EXPECT_FALSE(text.empty()) << picture.file;
  return Bytes(text.begin(), text.end());
}

Picture pictureOf(const HighThroughput& source) {
  Picture picture{64, 48, 16, source.is_signed};
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.columns; ++x) picture.samples.push_back(source.sample(x, y));
  }
  return picture;
}

// The first frame of a DICOM file, and what its header says.
std::pair<Bytes, Jpeg2000Expectation> frameOf(const std::filesystem::path& file) {
  DcmFileFormat dicom;
  EXPECT_TRUE(dicom.loadFile(file.c_str()).good()) << "the file cannot be read";
  DcmDataset& data = *dicom.getDataset();
  DcmElement* element = nullptr;
  EXPECT_TRUE(data.findAndGetElement(DCM_PixelData, element).good());
  auto& pixels = dynamic_cast<DcmPixelData&>(*element);
  E_TransferSyntax syntax = EXS_Unknown;
  const DcmRepresentationParameter* parameter = nullptr;
  pixels.getOriginalRepresentationKey(syntax, parameter);
  DcmPixelSequence* items = nullptr;
  EXPECT_TRUE(pixels.getEncapsulatedRepresentation(syntax, parameter, items).good());
  Bytes bytes;
  for (unsigned long i = 1; i < items->card(); ++i) {  // 0 is the offset table
    DcmPixelItem* item = nullptr;
    Uint8* fragment = nullptr;
    EXPECT_TRUE(items->getItem(item, i).good() && item->getUint8Array(fragment).good());
    bytes.insert(bytes.end(), fragment, fragment + item->getLength());
  }
  const auto value = [&](const DcmTagKey& tag) {
    Uint16 number = 0;
    EXPECT_TRUE(data.findAndGetUint16(tag, number).good());
    return int(number);
  };
  return {bytes,
          {value(DCM_Rows), value(DCM_Columns), value(DCM_BitsAllocated), value(DCM_BitsStored),
           value(DCM_PixelRepresentation) == 1}};
}

}  // namespace

TEST(Jpeg2000, EveryPixelOfEveryFormatComesBack) {
  for (const int bits : {8, 12, 13, 16}) {
    for (const bool is_signed : {false, true}) {
      for (const int tile : {0, 16}) {
        SCOPED_TRACE(testing::Message()
                     << bits << " bits, signed " << is_signed << ", tile " << tile);
        const Picture picture = ramp(bits, is_signed);
        const Bytes bytes = encode(picture, {.tile = tile, .layers = 3, .precinct = tile});
        const Decoded decoded = decode(bytes, expectation(picture));
        EXPECT_EQ(decoded.error, "");
        EXPECT_EQ(decoded.values, picture.samples);
        EXPECT_EQ(decode(encode(picture, {.tile = tile, .jp2 = true}), expectation(picture)).values,
                  picture.samples)
            << "in a JP2 file";
      }
    }
  }
}

TEST(Jpeg2000, FewerBitsThanAreStoredAndMoreAreRead) {
  Picture picture = ramp(10, false);
  const std::vector<int> samples = picture.samples;
  auto expected = expectation(picture);
  expected.bits_stored = 12;
  EXPECT_EQ(decode(encode(picture), expected).values, samples);
  picture.bits = 16;
  EXPECT_EQ(decode(encode(picture), expected).values, samples);
}

TEST(Jpeg2000, TheHeaderIsRightAboutTheSign) {
  for (const int bits : {8, 12, 13, 16}) {
    SCOPED_TRACE(bits);
    const Picture with_sign = ramp(bits, true), without = ramp(bits, false);
    Picture coded = without;
    for (std::size_t i = 0; i < coded.samples.size(); ++i) {
      coded.samples[i] = with_sign.samples[i] & ((1 << bits) - 1);
    }
    EXPECT_EQ(decode(encode(coded), expectation(with_sign)).values, with_sign.samples);

    coded = with_sign;
    for (std::size_t i = 0; i < coded.samples.size(); ++i) {
      const int sample = without.samples[i];
      coded.samples[i] = sample < 1 << (bits - 1) ? sample : sample - (1 << bits);
    }
    EXPECT_EQ(decode(encode(coded), expectation(without)).values, without.samples);
  }
}

TEST(Jpeg2000, HighThroughputIsReadToThePixel) {
  for (const HighThroughput& source : kLossless) {
    const Picture picture = pictureOf(source);
    const Decoded decoded = decode(bytesOf(source), expectation(picture));
    EXPECT_EQ(decoded.error, "") << source.file;
    EXPECT_EQ(decoded.values, picture.samples) << source.file;
    const auto lossy = isIrreversibleJpeg2000(bytesOf(source));
    EXPECT_TRUE(lossy.ok() && !*lossy) << source.file;
  }
}

TEST(Jpeg2000, AnIrreversibleWaveletIsToldByTheFirstBytes) {
  for (const bool jp2 : {false, true}) {
    for (const bool irreversible : {false, true}) {
      Bytes bytes = encode(ramp(12, true), {.irreversible = irreversible, .jp2 = jp2});
      bytes.resize(find(bytes, kSot) + 2);
      const auto lossy = isIrreversibleJpeg2000(bytes);
      ASSERT_TRUE(lossy.ok());
      EXPECT_EQ(*lossy, irreversible);
    }
  }
  const auto lossy = isIrreversibleJpeg2000(bytesOf(kIrreversible));
  EXPECT_TRUE(lossy.ok() && *lossy);
  EXPECT_FALSE(isIrreversibleJpeg2000({}).ok());
  EXPECT_FALSE(isIrreversibleJpeg2000(Bytes(4096, 0xFF)).ok());
}

TEST(Jpeg2000, AnIrreversiblePictureIsReadAsCloseAsItWasKept) {
  Picture smooth = ramp(12, true);
  for (int i = 0; i < int(smooth.samples.size()); ++i) {
    smooth.samples[std::size_t(i)] = 20 * (i % smooth.columns) + 11 * (i / smooth.columns) - 900;
  }
  const Decoded decoded = decode(encode(smooth, {.irreversible = true}), expectation(smooth));
  EXPECT_LE(largestDifference(decoded.values, smooth.samples), 1);

  const Picture high = pictureOf(kIrreversible);
  const int most =
      largestDifference(decode(bytesOf(kIrreversible), expectation(high)).values, high.samples);
  EXPECT_GT(most, 0);
  EXPECT_LE(most, 12);
}

// 12-bit CT coded as 16 bits: the wavelet's overshoot beside an edge leaves the 12 bits.
TEST(Jpeg2000, LossyOvershootDoesNotWrapAround) {
  Picture edges{64, 64, 16, false};
  for (int i = 0; i < 64 * 64; ++i) edges.samples.push_back((i / 5 + i / 64 / 5) % 2 ? 4095 : 0);
  const Bytes bytes = encode(edges, {.irreversible = true, .ratio = 20});
  auto expected = expectation(edges);
  const Decoded whole = decode(bytes, expected);
  ASSERT_FALSE(whole.values.empty());
  ASSERT_GT(std::ranges::max(whole.values), 4095) << "no overshoot: the test shows nothing";
  expected.bits_stored = 12;
  const Decoded stored = decode(bytes, expected);
  for (std::size_t i = 0; i < stored.values.size(); ++i) {
    ASSERT_EQ(stored.values[i], std::min(whole.values[i], 4095));
  }
}

TEST(Jpeg2000, EveryCutIsAnErrorAndPaddingIsNot) {
  const Picture picture = ramp(12, false);
  const Bytes one = encode(picture), tiles = encode(picture, {.tile = 32});
  Bytes open = one;  // its only tile-part is as long as the file is
  put(open, find(open, kSot) + 6, 0, 4);
  for (const Bytes& whole : {one, tiles, open}) {
    for (std::size_t cut = 0; cut < whole.size(); ++cut) {
      ASSERT_NE(whyRefused(first(whole, cut), expectation(picture)), "") << "cut at " << cut;
    }
    for (int sixteenth = 1; sixteenth < 16; ++sixteenth) {  // with an end mark put behind the cut
      Bytes cut = first(whole, whole.size() * std::size_t(sixteenth) / 16);
      cut.insert(cut.end(), {0xFF, 0xD9});
      EXPECT_NE(whyRefused(cut, expectation(picture)), "") << sixteenth << "/16";
    }
    Bytes padded = whole;
    padded.insert(padded.end(), 3, 0);
    EXPECT_EQ(decode(padded, expectation(picture)).values, picture.samples);
  }
  for (const HighThroughput& source : kLossless) {
    const Bytes whole = bytesOf(source);
    for (std::size_t cut = 0; cut < whole.size(); ++cut) {
      ASSERT_NE(whyRefused(first(whole, cut), expectation(pictureOf(source))), "") << cut;
    }
  }
}

TEST(Jpeg2000, AMissingTileIsAnError) {
  const Picture picture = ramp(12, false);
  Bytes bytes = encode(picture, {.tile = 32});
  const std::size_t second = find(bytes, kSot, find(bytes, kSot) + 12);
  const std::size_t third = find(bytes, kSot, second + 12);
  bytes.erase(bytes.begin() + std::ptrdiff_t(second), bytes.begin() + std::ptrdiff_t(third));
  EXPECT_EQ(whyRefused(bytes, expectation(picture)), kDamaged);
}

TEST(Jpeg2000, AMissingPartOfATileIsAnError) {
  const Picture picture = ramp(12, false);
  Bytes bytes = encode(picture);
  put(bytes, find(bytes, kSot) + 11, 2, 1);  // it has two parts, it says
  EXPECT_EQ(whyRefused(bytes, expectation(picture)), kDamaged);
}

TEST(Jpeg2000, AnotherSizeOrFormatThanTheHeaderSaysIsRefused) {
  const Picture picture = ramp(12, false);
  const Bytes bytes = encode(picture);
  auto expected = expectation(picture);
  expected.rows = 48;
  EXPECT_EQ(whyRefused(bytes, expected),
            "its JPEG 2000 picture is 61x47 where its header says 61x48");
  expected = expectation(picture);
  expected.columns = 62;
  EXPECT_EQ(whyRefused(bytes, expected),
            "its JPEG 2000 picture is 61x47 where its header says 62x47");
  expected = expectation(picture);
  expected.bits_allocated = expected.bits_stored = 8;
  EXPECT_EQ(whyRefused(bytes, expected),
            "its JPEG 2000 picture has 12 bits a pixel where its header says 8");
  EXPECT_EQ(whyRefused(encode(ramp(8, false), {.channels = 3}), expectation(ramp(8, false))),
            "its JPEG 2000 picture is not one grey channel, which cannot be read");
  Bytes subsampled = bytes;
  put(subsampled, kSiz + 41, 2, 1);
  EXPECT_EQ(whyRefused(subsampled, expectation(picture)),
            "its JPEG 2000 picture is subsampled, which cannot be read");
  Bytes moved = bytes;
  put(moved, kSiz + 14, 1, 4);
  EXPECT_EQ(whyRefused(moved, expectation(picture)),
            "its JPEG 2000 picture is cut out of another, which cannot be read");
  EXPECT_EQ(whyRefused(Bytes(1000, 0x55), expectation(picture)),
            "its pixels are not the JPEG 2000 that its header says");
}

// Each of these headers asks for hours or for gigabytes. A refusal takes none.
TEST(Jpeg2000, HostileHeadersAreRefusedAtOnce) {
  const Picture picture = ramp(12, false, 512, 512);
  const Bytes bytes = encode(picture, {.precinct = 16});
  const auto refused = [&](const char* what, Bytes hostile, std::string why = kDamaged,
                           int columns = 512, int rows = 512) {
    SCOPED_TRACE(what);
    Words words(1);  // nothing may be written
    const auto start = std::chrono::steady_clock::now();
    const Status status = decodeJpeg2000(hostile, {rows, columns, 16, 12, false}, words.data());
    (void)isIrreversibleJpeg2000(hostile);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().what, why);
  };
  const auto patched = [&](std::vector<std::array<std::uint32_t, 3>> patches) {
    Bytes hostile = bytes;
    for (const auto& [at, value, size] : patches) put(hostile, at, value, int(size));
    return hostile;
  };
  const auto siz = std::uint32_t(kSiz), cod = std::uint32_t(find(bytes, kCod));
  ASSERT_EQ(decode(bytes, expectation(picture)).values, picture.samples);

  refused("2^31 x 2^31",
          patched({{siz + 6, 1u << 31, 4},
                   {siz + 10, 1u << 31, 4},
                   {siz + 22, 1u << 31, 4},
                   {siz + 26, 1u << 31, 4}}),
          "its JPEG 2000 picture is 2147483648x2147483648 where its header says 512x512");
  refused(
      "a size that the header repeats",
      patched(
          {{siz + 6, 65535, 4}, {siz + 10, 65535, 4}, {siz + 22, 65535, 4}, {siz + 26, 65535, 4}}),
      "its JPEG 2000 picture is over 8192x8192, which cannot be read", 65535, 65535);
  refused("no rows, and columns as tiles",
          patched({{siz + 6, 0xFFFFFFFF, 4}, {siz + 10, 0, 4}, {siz + 22, 1, 4}}));
  refused("tiles of one pixel", patched({{siz + 22, 1, 4}, {siz + 26, 1, 4}}),
          "its JPEG 2000 picture is cut into over 4096 tiles, which cannot be read");
  refused("no tiles", patched({{siz + 22, 0, 4}}));
  refused("65535 layers of small precincts", patched({{cod + 6, 65535, 2}, {cod + 17, 0x11, 1}}));
  refused("more levels than there are", patched({{cod + 9, 33, 1}}));
  refused("a segment longer than the file", patched({{cod + 2, 65535, 2}}));
  refused("a segment without a length", patched({{std::uint32_t(find(bytes, kCom)) + 2, 0, 2}}));
  refused("an unknown segment", patched({{std::uint32_t(find(bytes, kCom)), 0xFF30, 2}}));

  Bytes twice = bytes;  // a second coding style, in the main header and in the tile's
  const auto style = bytes.begin() + cod;
  const auto style_end = style + 2 + bytes[cod + 2] * 256 + bytes[cod + 3];
  twice.insert(twice.begin() + cod, style, style_end);
  refused("two coding styles", twice);
  Bytes tile_style = bytes;
  const std::size_t sot = find(bytes, kSot);
  tile_style.insert(tile_style.begin() + std::ptrdiff_t(sot) + 12, style, style_end);
  put(tile_style, sot + 6, 0, 4);
  refused("a tile of its own style", tile_style,
          "its JPEG 2000 picture has tiles of several kinds, which cannot be read");
}

TEST(Jpeg2000, SpoiltBytesNeitherCrashNorPrint) {
  std::vector<std::pair<Bytes, Jpeg2000Expectation>> sources;
  for (const HighThroughput& source : kLossless) {
    sources.emplace_back(bytesOf(source), expectation(pictureOf(source)));
  }
  sources.emplace_back(bytesOf(kIrreversible), expectation(pictureOf(kIrreversible)));
  const Picture picture = ramp(12, true);
  for (const Coding& coding :
       {Coding{}, Coding{.tile = 16, .layers = 2}, Coding{.irreversible = true, .jp2 = true}}) {
    sources.emplace_back(encode(picture, coding), expectation(picture));
  }
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::mt19937 random(1);
  int errors = 0, pictures = 0;
  for (const auto& [bytes, expected] : sources) {
    for (int round = 0; round < 300; ++round) {
      Bytes spoilt = bytes;
      // Half of the rounds spoil what the headers say, which stands in front.
      const std::size_t range =
          round % 2 ? spoilt.size() : std::min<std::size_t>(200, spoilt.size());
      for (unsigned n = 1 + random() % 4; n > 0; --n) {
        spoilt[random() % range] = std::uint8_t(random());
      }
      ++(whyRefused(spoilt, expected).empty() ? pictures : errors);
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(errors, 100);
  EXPECT_GT(pictures, 100);  // so that the decoder itself was reached
}

TEST(Jpeg2000, ManyThreadsDecodeAtOnce) {
  const Picture picture = ramp(16, true);
  const Bytes bytes = encode(picture, {.tile = 32});
  std::vector<Decoded> decoded(8);
  {
    std::vector<std::jthread> threads;
    for (Decoded& one : decoded) {
      threads.emplace_back([&] {
        for (int i = 0; i < 10; ++i) one = decode(bytes, expectation(picture));
      });
    }
  }
  for (const Decoded& one : decoded) EXPECT_EQ(one.values, picture.samples);
}

TEST(Jpeg2000, ThePhantomIsReadToThePixel) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto folder = data / "hard/derived_phantom_ts";
  const auto [bytes, expected] = frameOf(folder / "j2k_lossless.dcm");
  const Decoded decoded = decode(bytes, expected);

  DcmFileFormat plain;
  ASSERT_TRUE(plain.loadFile((folder / "explicit_le.dcm").c_str()).good());
  const Uint16* words = nullptr;
  unsigned long count = 0;
  ASSERT_TRUE(plain.getDataset()->findAndGetUint16Array(DCM_PixelData, words, &count).good());
  EXPECT_EQ(decoded.values, std::vector<int>(words, words + count));
}

// The range and the sum that pydicom 2.3.1 reads.
TEST(Jpeg2000, RealCtIsReadAsPydicomReadsIt) {
  TREPHINE_TEST_DATA_OR_SKIP(data);
  const auto summary = [](const std::filesystem::path& file) {
    const auto [bytes, expected] = frameOf(file);
    const std::vector<int> values = decode(bytes, expected).values;
    std::int64_t sum = 0;
    for (const int value : values) sum += value;
    if (values.empty()) return std::array<std::int64_t, 3>{};
    return std::array<std::int64_t, 3>{std::ranges::min(values), std::ranges::max(values), sum};
  };
  using Summary = std::array<std::int64_t, 3>;
  // Coded without a sign, though the header says that it has one.
  EXPECT_EQ(summary(data / "hard/pydicom/J2K_pixelrep_mismatch.dcm"),
            (Summary{-2000, 1896, -172605258}));

  std::vector<std::filesystem::path> slices;
  for (const auto& entry :
       std::filesystem::directory_iterator(data / "abdomen-ct-totalsegmentator/example_ct_dicom")) {
    slices.push_back(entry.path());
  }
  std::ranges::sort(slices);
  ASSERT_EQ(slices.size(), 20u);
  EXPECT_EQ(summary(slices.front()), (Summary{0, 2460, 105356346}));
  EXPECT_EQ(summary(slices.back()), (Summary{0, 2429, 103453060}));
}

}  // namespace trephine::test
