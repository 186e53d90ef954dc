#include "imaging/codecs.h"

#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>

#include <cstring>
#include <optional>
#include <vector>

#include "imaging/dicom_values.h"
#include "imaging/jpeg2000.h"

namespace trephine {

namespace {

Error failed(std::string what) {
  return Error{"UNREADABLE", std::move(what), "", ""};
}

struct JpegFrame {
  int rows = 0, columns = 0, components = 0, precision = 0;
};

// What the frame header of a JPEG or JPEG-LS codestream says (ITU T.81 B.2.2, T.87 C.2.2).
std::optional<JpegFrame> jpegFrame(std::span<const std::uint8_t> bytes) {
  const auto number16 = [&](std::size_t at) { return int(bytes[at]) << 8 | bytes[at + 1]; };
  std::size_t at = 2;
  if (bytes.size() < 4 || bytes[0] != 0xFF || bytes[1] != 0xD8) return std::nullopt;
  while (at + 4 <= bytes.size()) {
    if (bytes[at] != 0xFF) return std::nullopt;
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {  // fill
      ++at;
      continue;
    }
    const bool frame = (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 &&
                        marker != 0xCC) ||
                       marker == 0xF7;
    if (frame) {
      if (at + 10 > bytes.size()) return std::nullopt;
      return JpegFrame{number16(at + 5), number16(at + 7), bytes[at + 9], bytes[at + 4]};
    }
    if (marker == 0xDA || marker == 0xD9) return std::nullopt;
    at += 2 + std::size_t(number16(at + 2));
  }
  return std::nullopt;
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
  if (!frame) return failed("its compressed pixels are damaged");
  if (frame->rows != header.rows || frame->columns != header.columns || frame->components != 1) {
    return failed("its compressed pixels are " + std::to_string(frame->columns) + "x" +
                  std::to_string(frame->rows) + " where the header says " +
                  std::to_string(header.columns) + "x" + std::to_string(header.rows));
  }
  if ((frame->precision > 8) != (header.bits_allocated > 8)) {
    return failed("its compressed pixels have " + std::to_string(frame->precision) + " bits");
  }
  if (!hasJpegEnd(codestream)) return failed("its compressed pixels are cut short");
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
    return failed(std::string("its compressed pixels cannot be decoded: ") + decoded.text());
  }
  return {};
}

}  // namespace

Status decodeFrame(const TransferSyntax& syntax, std::span<const std::uint8_t> codestream,
                   const DicomHeader& header, std::int16_t* words) {
  const StoredFormat& format = header.format;
  if (syntax.codec == Codec::jpeg2000) {
    return decodeJpeg2000(codestream,
                          {header.rows, header.columns, header.bits_allocated, format.bits_stored,
                           format.is_signed},
                          words);
  }
  const bool rle = syntax.uid == "1.2.840.10008.1.2.5";
  if (!rle) {
    if (const Status valid = checkJpeg(codestream, header); !valid) return valid;
  }
  const std::uint64_t bytes = header.frameBytes();
  const std::uint64_t even = bytes + bytes % 2;
  if (even > 0xFFFFFFFEU) return failed("its pixels are too many");
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
