#include "imaging/dicom/detail/codecs.h"

#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "base/tr.h"
#include "imaging/dicom/detail/dicom_values.h"
#include "imaging/dicom/detail/pixel_error.h"
#include "imaging/dicom/jpeg2000.h"

namespace trephine {

namespace {

struct JpegFrame {
  int rows = 0, columns = 0, components = 0, precision = 0;
  std::optional<bool> lossy;  // nothing where the scan header is not there
};

// What the scan header at `at` says of a scan of one component: in lossless JPEG the point
// transform (T.81 H.1), in JPEG-LS NEAR (T.87 C.2.3). A DCT always loses.
std::optional<bool> isLossyScan(std::span<const std::uint8_t> bytes, std::size_t at,
                                std::uint8_t frame_marker) {
  const bool jpeg_ls = frame_marker == 0xF7;
  const bool lossless = jpeg_ls || (frame_marker & 3) == 3;  // SOF3, 7, 11, 15
  if (!lossless) return true;
  if (at + 10 > bytes.size() || bytes[at + 4] != 1) return std::nullopt;
  return jpeg_ls ? bytes[at + 7] != 0 : (bytes[at + 9] & 15) != 0;
}

// What the frame header of a JPEG or JPEG-LS codestream says (ITU T.81 B.2.2, T.87 C.2.2).
std::optional<JpegFrame> jpegFrame(std::span<const std::uint8_t> bytes) {
  const auto number16 = [&](std::size_t at) { return int(bytes[at]) << 8 | bytes[at + 1]; };
  std::size_t at = 2;
  std::optional<JpegFrame> found;
  std::uint8_t frame_marker = 0;
  if (bytes.size() < 4 || bytes[0] != 0xFF || bytes[1] != 0xD8) return std::nullopt;
  while (at + 4 <= bytes.size()) {
    if (bytes[at] != 0xFF) return found;
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {  // fill
      ++at;
      continue;
    }
    const bool frame =
        (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC) ||
        marker == 0xF7;
    if (frame) {
      if (at + 10 > bytes.size() || found) return std::nullopt;
      found = JpegFrame{number16(at + 5), number16(at + 7), bytes[at + 9], bytes[at + 4], {}};
      frame_marker = marker;
    }
    if (marker == 0xDA && found) found->lossy = isLossyScan(bytes, at, frame_marker);
    if (marker == 0xDA || marker == 0xD9) return found;
    at += 2 + std::size_t(number16(at + 2));
  }
  return found;
}

// Whether the segments of an RLE frame hold these many bytes each, and no more (PS3.5 annex G).
// DCMTK fills up what is short, and leaves out what is too much.
bool fitsRle(std::span<const std::uint8_t> bytes, std::size_t segments, std::uint64_t pixels) {
  const auto number32 = [&](std::size_t at) {
    return std::size_t(bytes[at]) | std::size_t(bytes[at + 1]) << 8 |
           std::size_t(bytes[at + 2]) << 16 | std::size_t(bytes[at + 3]) << 24;
  };
  if (bytes.size() < 64 || number32(0) != segments) return false;
  for (std::size_t segment = 0; segment < segments; ++segment) {
    std::size_t at = number32(4 + 4 * segment);
    const std::size_t end = segment + 1 < segments ? number32(8 + 4 * segment) : bytes.size();
    if (at < 64 || end > bytes.size() || at > end) return false;
    std::uint64_t count = 0;
    while (count < pixels && at < end) {
      const std::uint8_t code = bytes[at];
      if (code < 128) {
        count += code + 1U;
        at += code + 2U;
      } else {
        if (code > 128) count += 257U - code;
        at += code > 128 ? 2 : 1;
      }
    }
    // An odd number of pixels may be padded by one, and the segment by a byte.
    if (count < pixels || count > pixels + pixels % 2 || at > end) return false;
    const auto rest = bytes.subspan(at, end - at);
    if (rest.size() > 1 && std::ranges::any_of(rest, [](std::uint8_t b) { return b != 0; })) {
      return false;
    }
  }
  return true;
}

// DCMTK decodes what is there of a codestream that was cut, so its end is looked for.
bool hasJpegEnd(std::span<const std::uint8_t> bytes) {
  for (std::size_t n = bytes.size(); n >= 2; --n) {
    if (bytes[n - 2] == 0xFF && bytes[n - 1] == 0xD9) return true;
    if (bytes.size() - n > 64) return false;  // padding is short
  }
  return false;
}

Status checkJpeg(std::span<const std::uint8_t> codestream, const DicomHeader& header) {
  const auto frame = jpegFrame(codestream);
  if (!frame) return unreadablePixels(tr("its compressed pixels are damaged"));
  if (frame->rows != header.rows || frame->columns != header.columns || frame->components != 1) {
    return unreadablePixels(tr("its compressed pixels are {}x{} where the header says {}x{}",
                               frame->columns, frame->rows, header.columns, header.rows));
  }
  if ((frame->precision > 8) != (header.bits_allocated > 8)) {
    return unreadablePixels(tr("its compressed pixels have {} bits", frame->precision));
  }
  if (!hasJpegEnd(codestream)) return unreadablePixels(tr("its compressed pixels are cut short"));
  return {};
}

// The one fragment as a data set of its own, decoded by the decoder that DCMTK has for it.
Status decodeWithDcmtk(const TransferSyntax& syntax, std::span<const std::uint8_t> codestream,
                       const DicomHeader& header, std::uint8_t* to, std::size_t bytes) {
  setUpDcmtk();
  DcmDataset data;
  const auto put = [&](const DcmTagKey& tag, int value) {
    data.putAndInsertUint16(tag, Uint16(value));
  };
  put(DCM_Rows, header.rows);
  put(DCM_Columns, header.columns);
  put(DCM_SamplesPerPixel, 1);
  put(DCM_BitsAllocated, header.bits_allocated);
  put(DCM_BitsStored, header.format.bits_stored);
  put(DCM_HighBit, header.format.high_bit);
  put(DCM_PixelRepresentation, header.format.is_signed);
  data.putAndInsertString(DCM_NumberOfFrames, "1");
  data.putAndInsertString(DCM_PhotometricInterpretation, "MONOCHROME2");

  auto* sequence = new DcmPixelSequence(DCM_PixelSequenceTag);  // owned by `pixels`
  sequence->insert(new DcmPixelItem(DCM_PixelItemTag));         // an empty offset table
  auto* item = new DcmPixelItem(DCM_PixelItemTag);
  item->putUint8Array(codestream.data(), static_cast<unsigned long>(codestream.size()));
  sequence->insert(item);
  DcmPixelData pixels(DCM_PixelData);
  const DcmXfer xfer(std::string(syntax.uid).c_str());
  pixels.putOriginalRepresentation(xfer.getXfer(), nullptr, sequence);

  Uint32 fragment = 1;
  OFString colour;
  const OFCondition decoded =
      pixels.getUncompressedFrame(&data, 0, fragment, to, Uint32(bytes), colour);
  if (decoded.bad()) {
    return unreadablePixels(tr("its compressed pixels cannot be decoded: {}", decoded.text()));
  }
  return {};
}

}  // namespace

std::optional<bool> isLossyCodestream(const TransferSyntax& syntax,
                                      std::span<const std::uint8_t> first_bytes) {
  if (syntax.codec == Codec::jpeg2000) {
    const Result<bool> irreversible = isIrreversibleJpeg2000(first_bytes);
    return irreversible ? std::optional(*irreversible) : std::nullopt;
  }
  const auto frame = jpegFrame(first_bytes);
  return frame ? frame->lossy : std::nullopt;
}

std::optional<int> bitsOfCodestream(const TransferSyntax& syntax,
                                    std::span<const std::uint8_t> first_bytes) {
  if (syntax.codec == Codec::jpeg2000) {
    // SOC, then SIZ: 36 bytes of sizes and the number of components, then Ssiz of the first one
    // (ITU T.800 A.5.1).
    constexpr std::size_t kSsiz = 42;
    const bool siz = first_bytes.size() > kSsiz && first_bytes[0] == 0xFF &&
                     first_bytes[1] == 0x4F && first_bytes[2] == 0xFF && first_bytes[3] == 0x51;
    return siz ? std::optional(int(first_bytes[kSsiz] & 0x7F) + 1) : std::nullopt;
  }
  const auto frame = jpegFrame(first_bytes);
  return frame ? std::optional(frame->precision) : std::nullopt;
}

Status decodeFrame(const TransferSyntax& syntax, std::span<const std::uint8_t> codestream,
                   const DicomHeader& header, std::int16_t* words) {
  const StoredFormat& format = header.format;
  if (syntax.codec == Codec::jpeg2000) {
    return decodeJpeg2000(
        codestream,
        {header.rows, header.columns, header.bits_allocated, format.bits_stored, format.is_signed},
        words);
  }
  const bool rle = syntax.uid == "1.2.840.10008.1.2.5";
  if (rle) {
    if (!fitsRle(codestream, std::size_t(header.bits_allocated / 8), header.pixelCount())) {
      return unreadablePixels(
          tr("its RLE pixels are not as many as rows and columns say, or are damaged"));
    }
  } else {
    if (const Status valid = checkJpeg(codestream, header); !valid) return valid;
  }
  const std::uint64_t bytes = header.frameBytes();
  const std::uint64_t even = bytes + bytes % 2;
  if (even > 0xFFFFFFFEU) return unreadablePixels(tr("its pixels are too many"));
  if (header.bits_allocated != 8) {
    return decodeWithDcmtk(syntax, codestream, header, reinterpret_cast<std::uint8_t*>(words),
                           bytes);
  }
  std::vector<std::uint8_t> narrow(even);
  const Status decoded = decodeWithDcmtk(syntax, codestream, header, narrow.data(), even);
  for (std::uint64_t n = 0; decoded && n < bytes; ++n) words[n] = narrow[n];
  return decoded;
}

}  // namespace trephine
