#include "imaging/dicom/jpeg2000.h"

#include <openjpeg.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "base/tr.h"
#include "imaging/dicom/detail/pixel_error.h"

namespace trephine {

namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t kMostPixels = std::uint64_t(1) << 26;  // 8192 x 8192
constexpr std::uint64_t kMostTiles = 4096;                     // OpenJPEG takes 6 KB for each

// Markers of 15444-1 table A.2. Each but SOC, SOD and EOC starts a segment with its length.
enum Marker : unsigned {
  kSoc = 0xFF4F,
  kSiz = 0xFF51,
  kCod = 0xFF52,
  kSot = 0xFF90,
  kSod = 0xFF93,
  kEoc = 0xFFD9,
};
// The segments taken beside these: CAP, TLM, PLM, PLT, CPF, QCD, QCC, RGN, POC, PPM, PPT, CRG, COM.
// OpenJPEG looks for a marker inside any that it does not know, so others are refused; so is COC,
// which no grey picture needs.
constexpr std::array kOtherSegments = {0xFF50, 0xFF55, 0xFF57, 0xFF58, 0xFF59, 0xFF5C, 0xFF5D,
                                       0xFF5E, 0xFF5F, 0xFF60, 0xFF61, 0xFF63, 0xFF64};

Error cutOrDamaged() {
  return unreadablePixels(tr("its JPEG 2000 picture is cut short or damaged"));
}

Error unsupported(const std::string& what) {
  return unreadablePixels(tr("its JPEG 2000 picture {}, which cannot be read", what));
}

// A big-endian number; 0 where it is not all there, which no marker, length or count may be.
std::uint64_t number(Bytes bytes, std::size_t at, std::size_t size) {
  if (at > bytes.size() || bytes.size() - at < size) return 0;
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes.subspan(at, size)) value = value << 8 | byte;
  return value;
}

// The codestream in a JP2 file (15444-1 annex I), or all that is given.
Bytes codestreamIn(Bytes bytes) {
  constexpr std::uint64_t kSignatureBox = 0x6A502020, kCodestreamBox = 0x6A703263;
  if (number(bytes, 4, 4) != kSignatureBox) return bytes;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t left = bytes.size() - at;
    std::uint64_t length = number(bytes, at, 4), head = 8;
    if (length == 1) {
      length = number(bytes, at + 8, 8);
      head = 16;
    } else if (length == 0) {
      length = left;
    }
    if (length < head || left < head) break;
    length = std::min<std::uint64_t>(length, left);
    if (number(bytes, at + 4, 4) == kCodestreamBox) return bytes.subspan(at + head, length - head);
    at += length;
  }
  return {};
}

struct MainHeader {
  std::uint64_t columns = 0, rows = 0;
  std::uint64_t tile_columns = 0, tile_rows = 0;  // size of one tile
  std::uint64_t tiles = 0;
  int precision = 0;
  bool is_signed = false;
  bool irreversible = false;
  bool high_throughput = false;
  std::uint64_t packets = 0;  // that all tiles hold together
  std::size_t bytes = 0;      // up to the first tile-part
};

std::uint64_t ceilDivide(std::uint64_t a, std::uint64_t b) {
  return (a + b - 1) / b;
}

Status readSize(Bytes segment, MainHeader& header) {
  const auto field = [&](std::size_t at) { return number(segment, at, 4); };
  header.columns = field(2);
  header.rows = field(6);
  header.tile_columns = field(18);
  header.tile_rows = field(22);
  if (field(10) || field(14) || field(26) || field(30))
    return unsupported(tr("is cut out of another"));
  if (number(segment, 34, 2) != 1) return unsupported(tr("is not one grey channel"));
  if (segment.size() != 39 || !header.columns || !header.rows || !header.tile_columns ||
      !header.tile_rows) {
    return cutOrDamaged();
  }
  header.is_signed = segment[36] & 0x80;
  header.precision = (segment[36] & 0x7F) + 1;
  if (segment[37] != 1 || segment[38] != 1) return unsupported(tr("is subsampled"));
  header.tiles =
      ceilDivide(header.columns, header.tile_columns) * ceilDivide(header.rows, header.tile_rows);
  if (header.tiles > kMostTiles) return unsupported(tr("is cut into over 4096 tiles"));
  return {};
}

// Precincts along one axis, in all tiles together, of a resolution `halvings` below the full one
// (15444-1 B.5 and B.6).
std::uint64_t precinctsAlong(std::uint64_t size, std::uint64_t tile, int halvings, int exponent) {
  const auto up = [](std::uint64_t value, int bits) {
    return ceilDivide(value, std::uint64_t(1) << bits);
  };
  std::uint64_t count = 0;
  for (std::uint64_t start = 0; start < size; start += tile) {
    const std::uint64_t low = up(start, halvings);
    const std::uint64_t high = up(std::min(start + tile, size), halvings);
    if (high > low) count += up(high, exponent) - (low >> exponent);
  }
  return count;
}

Status readCodingStyle(Bytes segment, MainHeader& header) {
  const std::uint64_t layers = number(segment, 2, 2);
  const bool has_precincts = !segment.empty() && segment[0] & 1;
  const auto levels = int(number(segment, 5, 1));
  if (levels > 32 || segment.size() != std::size_t(10 + (has_precincts ? levels + 1 : 0))) {
    return cutOrDamaged();
  }
  header.irreversible = segment[9] != 1;
  header.high_throughput = segment[8] & 0x40;
  if (header.high_throughput && (layers != 1 || segment[0] & 6)) {
    return unsupported(tr("is HTJ2K in several layers or with packet markers"));
  }
  for (int r = 0; r <= levels; ++r) {
    const unsigned exponents = has_precincts ? segment[10 + std::size_t(r)] : 0xFF;
    header.packets +=
        layers *
        precinctsAlong(header.columns, header.tile_columns, levels - r, int(exponents & 15)) *
        precinctsAlong(header.rows, header.tile_rows, levels - r, int(exponents >> 4));
  }
  return {};
}

// The segment at `at`, or nothing where there is none that is known and whole.
Bytes segmentAt(Bytes stream, std::size_t at) {
  const std::uint64_t marker = number(stream, at, 2), length = number(stream, at + 2, 2);
  const bool known = marker == kSiz || marker == kCod || marker == kSot ||
                     std::ranges::find(kOtherSegments, int(marker)) != kOtherSegments.end();
  if (!known || length < 3 || at + 2 + length > stream.size()) return {};
  return stream.subspan(at + 4, length - 2);
}

Result<MainHeader> readMainHeader(Bytes stream) {
  if (number(stream, 0, 2) != kSoc || number(stream, 2, 2) != kSiz) {
    return unreadablePixels(tr("its pixels are not the JPEG 2000 that its header says"));
  }
  MainHeader header;
  int sizes = 0, styles = 0;
  std::size_t at = 2;
  while (number(stream, at, 2) != kSot) {
    const Bytes segment = segmentAt(stream, at);
    if (segment.empty()) return cutOrDamaged();
    const std::uint64_t marker = number(stream, at, 2);
    Status read;
    if (marker == kSiz && ++sizes == 1) read = readSize(segment, header);
    if (marker == kCod && ++styles == 1) read = readCodingStyle(segment, header);
    if (!read.ok()) return read.error();
    at += 4 + segment.size();
  }
  if (sizes != 1 || styles != 1) return cutOrDamaged();
  header.bytes = at;
  return header;
}

Status compare(const MainHeader& header, const Jpeg2000Expectation& expected) {
  if (header.columns != std::uint64_t(expected.columns) ||
      header.rows != std::uint64_t(expected.rows)) {
    return unreadablePixels(tr("its JPEG 2000 picture is {}x{} where its header says {}x{}",
                               header.columns, header.rows, expected.columns, expected.rows));
  }
  if (header.columns * header.rows > kMostPixels) return unsupported(tr("is over 8192x8192"));
  if (header.precision > std::min(expected.bits_allocated, 16)) {
    return unreadablePixels(tr("its JPEG 2000 picture has {} bits a pixel where its header says {}",
                               header.precision, expected.bits_allocated));
  }
  return {};
}

// Whether what only a marker may hold stands in coded data: a byte over 8F behind an FF, or an FF
// at the end. The HTJ2K decoder of OpenJPEG 2.5.0, as Debian builds it, asserts that no data of a
// code block do, and so would end the program; with one layer, those are the bytes of one packet.
bool holdsMarker(Bytes data) {
  while (!data.empty()) {
    const void* found = std::memchr(data.data(), 0xFF, data.size());
    if (!found) return false;
    data = data.subspan(std::size_t(static_cast<const std::uint8_t*>(found) - data.data()) + 1);
    if (data.empty() || data.front() > 0x8F) return true;
  }
  return false;
}

// Follows the tile-parts to the end mark and returns the bytes up to behind it. OpenJPEG leaves a
// tile that it does not meet black, and takes packets that it does not meet for empty.
Result<Bytes> wholeCodestream(Bytes stream, const MainHeader& header) {
  struct Parts {
    unsigned found = 0, said = 0;
  };
  std::vector<Parts> tiles(header.tiles);
  std::size_t at = header.bytes;
  while (number(stream, at, 2) == kSot) {
    const Bytes part = segmentAt(stream, at);
    if (part.size() != 8) return cutOrDamaged();
    const std::uint64_t tile = number(part, 0, 2), length = number(part, 2, 4);
    if (tile >= tiles.size()) return cutOrDamaged();
    ++tiles[tile].found;
    tiles[tile].said = std::max(tiles[tile].said, unsigned(part[7]));

    std::size_t end = at + length;
    if (length == 0) {  // up to the end mark
      end = stream.size();
      while (end > at && stream[end - 1] == 0) --end;
      end -= 2;
    }
    for (at += 4 + part.size(); number(stream, at, 2) != kSod;) {
      const Bytes segment = segmentAt(stream, at);
      if (segment.empty()) return cutOrDamaged();
      if (number(stream, at, 2) == kCod) return unsupported(tr("has tiles of several kinds"));
      at += 4 + segment.size();
    }
    at += 2;
    if (end < at || end > stream.size()) return cutOrDamaged();
    if (header.high_throughput && holdsMarker(stream.subspan(at, end - at))) return cutOrDamaged();
    at = end;
  }
  const bool complete = std::ranges::all_of(
      tiles, [](const Parts& parts) { return parts.found > 0 && parts.found >= parts.said; });
  // A packet takes a byte at least: without this, a header of a few bytes could ask for hours.
  if (number(stream, at, 2) != kEoc || !complete || header.packets > stream.size()) {
    return cutOrDamaged();
  }
  return stream.first(at + 2);
}

struct Reader {
  Bytes bytes;
  std::size_t at = 0;

  std::size_t left() const { return bytes.size() - at; }

  static OPJ_SIZE_T read(void* to, OPJ_SIZE_T count, void* self) {
    Reader& reader = *static_cast<Reader*>(self);
    count = std::min<std::size_t>(count, reader.left());
    if (count == 0) return OPJ_SIZE_T(-1);
    std::memcpy(to, reader.bytes.data() + reader.at, count);
    reader.at += count;
    return count;
  }
  static OPJ_OFF_T skip(OPJ_OFF_T count, void* self) {
    Reader& reader = *static_cast<Reader*>(self);
    if (count < 0 || std::uint64_t(count) > reader.left()) return -1;
    reader.at += std::size_t(count);
    return count;
  }
  static OPJ_BOOL seek(OPJ_OFF_T to, void* self) {
    Reader& reader = *static_cast<Reader*>(self);
    if (to < 0 || std::uint64_t(to) > reader.bytes.size()) return OPJ_FALSE;
    reader.at = std::size_t(to);
    return OPJ_TRUE;
  }
};

template <auto kDestroy>
struct Destroy {
  template <class T>
  void operator()(T* object) const {
    kDestroy(object);
  }
};
using Stream = std::unique_ptr<opj_stream_t, Destroy<&opj_stream_destroy>>;
using Decoder = std::unique_ptr<opj_codec_t, Destroy<&opj_destroy_codec>>;
using Image = std::unique_ptr<opj_image_t, Destroy<&opj_image_destroy>>;

// Null where OpenJPEG gives up. It prints nothing unless it is given somewhere to.
Image decode(Bytes codestream) {
  constexpr OPJ_SIZE_T kBuffer = OPJ_SIZE_T(1) << 16;
  Reader reader{codestream};
  const Stream stream(opj_stream_create(kBuffer, OPJ_TRUE));
  const Decoder decoder(opj_create_decompress(OPJ_CODEC_J2K));
  if (!stream || !decoder) return nullptr;
  opj_stream_set_user_data(stream.get(), &reader, nullptr);
  opj_stream_set_user_data_length(stream.get(), codestream.size());
  opj_stream_set_read_function(stream.get(), &Reader::read);
  opj_stream_set_skip_function(stream.get(), &Reader::skip);
  opj_stream_set_seek_function(stream.get(), &Reader::seek);

  opj_dparameters_t parameters;
  opj_set_default_decoder_parameters(&parameters);
  opj_image_t* read = nullptr;
  const bool ready = opj_setup_decoder(decoder.get(), &parameters) &&
                     opj_decoder_set_strict_mode(decoder.get(), OPJ_TRUE) &&
                     opj_codec_set_threads(decoder.get(), 0) &&  // whatever OPJ_NUM_THREADS says
                     opj_read_header(stream.get(), decoder.get(), &read);
  Image image(read);
  if (!ready || !opj_decode(decoder.get(), stream.get(), image.get())) return nullptr;
  return image;
}

// Decoded samples -> words of the header's sign.
void toWords(const std::int32_t* samples, std::size_t count, const MainHeader& header,
             const Jpeg2000Expectation& expected, std::int16_t* words) {
  const int unused = 32 - header.precision;
  // A lossy picture overshoots; where more bits are coded than stored, that must not wrap round.
  const bool clamps = header.irreversible && header.precision > expected.bits_stored &&
                      header.is_signed == expected.is_signed;
  const int span = 1 << expected.bits_stored;
  const int low = !clamps ? -32768 : expected.is_signed ? -span / 2 : 0;
  const int high = !clamps ? 65535 : low + span - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t top = std::uint32_t(samples[i]) << unused;
    const int value = expected.is_signed ? std::int32_t(top) >> unused : int(top >> unused);
    words[i] = std::int16_t(std::clamp(value, low, high));
  }
}

}  // namespace

Result<bool> isIrreversibleJpeg2000(std::span<const std::uint8_t> bytes) {
  const auto header = readMainHeader(codestreamIn(bytes));
  if (!header.ok()) return header.error();
  return header->irreversible;
}

Status decodeJpeg2000(std::span<const std::uint8_t> bytes, const Jpeg2000Expectation& expected,
                      std::int16_t* words) {
  const Bytes stream = codestreamIn(bytes);
  const auto header = readMainHeader(stream);
  if (!header.ok()) return header.error();
  if (const Status fits = compare(*header, expected); !fits.ok()) return fits;
  const auto whole = wholeCodestream(stream, *header);
  if (!whole.ok()) return whole.error();

  const Image image = decode(*whole);
  if (!image || image->numcomps != 1) return cutOrDamaged();
  const opj_image_comp_t& grey = image->comps[0];
  if (!grey.data || grey.w != header->columns || grey.h != header->rows ||
      grey.prec != std::uint32_t(header->precision)) {
    return cutOrDamaged();
  }
  toWords(grey.data, std::size_t(grey.w) * grey.h, *header, expected, words);
  return {};
}

}  // namespace trephine
