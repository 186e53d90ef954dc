#include "imaging/dicom_file.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/oflog/oflog.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>

#include "imaging/text.h"

namespace trephine {

namespace {

constexpr Uint32 kLazyBytes = 1024;      // longer values stay on disk until asked for
constexpr Uint32 kLongestValue = 16384;  // no attribute that we read is longer
constexpr std::string_view kDeflated = "1.2.840.10008.1.2.1.99";
constexpr std::string_view kDicomDir = "1.2.840.10008.1.3.10";

// A level of nesting takes at least 16 bytes of file and up to 2.1 KB of stack (measured), so that
// a file of this size cannot exhaust a worker's stack; the items of larger ones are counted first.
constexpr std::uint64_t kSafeFileBytes = std::uint64_t(2) << 20;
constexpr std::size_t kMostItems = 100000;

void quietDcmtk() {
  static std::once_flag once;
  std::call_once(once, [] {
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);
    dcmEnableUnknownVRConversion.set(OFTrue);  // known attributes sent as VR UN
  });
}

Error skip(std::string reason) {
  return Error{"SKIPPED", std::move(reason), "", ""};
}

// Whether the first bytes can be DICOM: the preamble's mark, or a first element of group 2 or 8.
// DCMTK itself takes any bytes for a data set without a preamble.
bool looksLikeDicom(std::string_view head) {
  if (head.size() >= 132 && head.substr(128, 4) == "DICM") return true;
  if (head.size() < 16) return false;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(head[i]); };
  const auto isGroup = [](unsigned char high, unsigned char low) {
    return high == 0 && (low == 2 || low == 8);
  };
  const bool little = isGroup(byte(1), byte(0)), big = isGroup(byte(0), byte(1));
  if (!little && !big) return false;
  if (std::isupper(byte(4)) && std::isupper(byte(5))) return true;
  return little && byte(5) < 2 && byte(6) == 0 && byte(7) == 0;  // implicit: a short first value
}

bool tooManyItems(const std::filesystem::path& file) {
  constexpr std::string_view kLittle("\xFE\xFF\x00\xE0", 4), kBig("\xFF\xFE\xE0\x00", 4);
  std::ifstream in(file, std::ios::binary);
  std::string block(std::size_t(1) << 20, '\0');
  std::size_t items = 0, kept = 0;
  while (in) {
    in.read(block.data() + kept, std::streamsize(block.size() - kept));
    const std::string_view view(block.data(), kept + std::size_t(in.gcount()));
    for (const std::string_view tag : {kLittle, kBig}) {
      for (std::size_t at = view.find(tag); at != view.npos; at = view.find(tag, at + 4)) ++items;
    }
    if (items > kMostItems) return true;
    kept = std::min<std::size_t>(3, view.size());  // a tag across two blocks
    std::memmove(block.data(), view.data() + view.size() - kept, kept);
  }
  return false;
}

std::string valueText(DcmItem& item, const DcmTagKey& tag) {
  DcmElement* element = nullptr;
  if (item.findAndGetElement(tag, element).bad() || !element) return "";
  if (element->getLength() > kLongestValue) return "";
  OFString text;
  if (element->getOFStringArray(text).bad()) return "";
  return std::string(text.c_str(), text.length());
}

std::string trimmedText(DcmItem& item, const DcmTagKey& tag) {
  return cleanUtf8(valueText(item, tag));
}

// A UID, or nothing where it holds what no UID can.
std::string uidText(DcmItem& item, const DcmTagKey& tag) {
  const std::string text = trimmedText(item, tag);
  const bool valid = text.size() <= 64 && std::ranges::all_of(text, [](char c) {
                       return c == '.' || (c >= '0' && c <= '9');
                     });
  return valid ? text : "";
}

// A count: `fallback` where absent, 0 where it is more than `most` or negative, so that products of
// counts fit 64 bit.
int countOr(DcmItem& item, const DcmTagKey& tag, int fallback, int most) {
  const int count = parseInteger(valueText(item, tag)).value_or(fallback);
  return count >= 0 && count <= most ? count : 0;
}

std::string decodedText(DcmItem& item, const DcmTagKey& tag) {
  const std::string raw = valueText(item, tag);
  const bool plain = std::ranges::all_of(raw, [](char c) { return c >= 0x20 && c < 0x7F; });
  if (plain) return cleanUtf8(raw);
  const std::string charset = valueText(item, DCM_SpecificCharacterSet);
  DcmSpecificCharacterSet converter;
  OFString utf8;
  if (!charset.empty() &&
      converter.selectCharacterSet(OFString(charset.data(), charset.size()), "ISO_IR 192").good() &&
      converter.convertString(OFString(raw.data(), raw.size()), utf8).good()) {
    return cleanUtf8(std::string_view(utf8.c_str(), utf8.length()));
  }
  return guessUtf8(raw);
}

template <std::size_t kCount>
std::optional<std::array<double, kCount>> decimals(DcmItem& item, const DcmTagKey& tag) {
  const auto values = parseDecimals(valueText(item, tag));
  if (!values || values->size() != kCount) return std::nullopt;
  std::array<double, kCount> array;
  std::ranges::copy(*values, array.begin());
  return array;
}

void readFormat(DcmItem& data, DicomHeader& header) {
  StoredFormat& format = header.format;
  header.bits_allocated = countOr(data, DCM_BitsAllocated, 0, 64);
  format.bits_stored = countOr(data, DCM_BitsStored, header.bits_allocated, 64);
  format.high_bit = countOr(data, DCM_HighBit, format.bits_stored - 1, 63);
  format.is_signed = countOr(data, DCM_PixelRepresentation, 0, 1) == 1;

  const std::string slope = trimmedText(data, DCM_RescaleSlope);
  const std::string intercept = trimmedText(data, DCM_RescaleIntercept);
  const auto slope_value = parseDecimal(slope), intercept_value = parseDecimal(intercept);
  header.rescale_bad = (!slope.empty() && !slope_value) || (!intercept.empty() && !intercept_value);
  format.slope = slope_value.value_or(1.0);
  format.intercept = intercept_value.value_or(0.0);
  header.rescale_given = slope_value && intercept_value && *slope_value != 0.0;
  if (format.slope == 0.0) format.slope = 1.0;

  // US or SS: kept as the word that the pixels would hold.
  const auto padding = parseInteger(valueText(data, DCM_PixelPaddingValue));
  const auto limit = parseInteger(valueText(data, DCM_PixelPaddingRangeLimit));
  if (padding) {
    format.padding =
        StoredFormat::Padding{std::uint16_t(*padding), std::uint16_t(limit.value_or(*padding))};
  }
}

// Compares what the pixel element holds with what rows, columns and bits need, in 64 bit.
void checkPixels(DcmElement& pixels, bool cut, DicomHeader& header) {
  if (!isReadableTransferSyntax(header.transfer_syntax)) return;
  const std::uint64_t needed = header.frameBytes() * std::uint64_t(std::max(header.frames, 1)) *
                               std::uint64_t(std::max(header.samples, 1));
  const std::uint64_t length = pixels.getLength();
  if (cut || length > header.file_bytes) {
    header.defect = Defect::cut;
    header.defect_text = "its pixels are cut short";
  } else if (header.bits_allocated % 8 == 0 && needed > 0) {
    // Writers pad, by less than a row; more means that rows or columns are wrong.
    const std::uint64_t row = needed / std::uint64_t(header.rows);
    if (length < needed || length - needed >= std::max<std::uint64_t>(row, 2)) {
      header.defect = Defect::size_mismatch;
      header.defect_text = "it holds " + std::to_string(length) + " bytes of pixels where " +
                           std::to_string(header.columns) + "x" + std::to_string(header.rows) +
                           " need " + std::to_string(needed);
    }
  }
}

}  // namespace

std::string transferSyntaxName(const std::string& uid) {
  static const std::map<std::string, std::string> newer = {
      {"1.2.840.10008.1.2.4.201", "High-Throughput JPEG 2000 (Lossless only)"},
      {"1.2.840.10008.1.2.4.202", "High-Throughput JPEG 2000 with RPCL (Lossless only)"},
      {"1.2.840.10008.1.2.4.203", "High-Throughput JPEG 2000"}};
  if (const auto it = newer.find(uid); it != newer.end()) return it->second;
  const DcmXfer syntax(uid.c_str());
  return syntax.getXfer() == EXS_Unknown ? "unknown" : syntax.getXferName();
}

bool isReadableTransferSyntax(const std::string& uid) {
  return uid == UID_LittleEndianImplicitTransferSyntax ||
         uid == UID_LittleEndianExplicitTransferSyntax ||
         uid == UID_BigEndianExplicitTransferSyntax;
}

Result<DicomHeader> readDicomHeader(const std::filesystem::path& file, std::uint64_t file_bytes) {
  quietDcmtk();
  if (file_bytes == 0) return skip("the file is empty");
  std::string head(1024, '\0');
  {
    std::ifstream in(file, std::ios::binary);
    if (!in) return skip("the file could not be opened");
    in.read(head.data(), std::streamsize(head.size()));
    head.resize(std::size_t(in.gcount()));
  }
  if (!looksLikeDicom(head)) return skip("not a DICOM file");
  if (head.find(kDicomDir) != head.npos) {
    return skip("a DICOMDIR: the files themselves are read instead");
  }
  if (head.find(kDeflated) != head.npos) {
    return skip("the transfer syntax Deflated Explicit VR Little Endian (" +
                std::string(kDeflated) + ") cannot be read yet");
  }
  if (file_bytes > kSafeFileBytes && tooManyItems(file)) return skip("nested too deeply");

  DcmFileFormat dicom;
  const bool cut =
      dicom.loadFile(file.c_str(), EXS_Unknown, EGL_noChange, kLazyBytes, ERM_autoDetect).bad();
  DcmDataset& data = *dicom.getDataset();
  DcmMetaInfo& meta = *dicom.getMetaInfo();

  DicomHeader header;
  header.file = file;
  header.file_bytes = file_bytes;
  header.series_uid = uidText(data, DCM_SeriesInstanceUID);
  header.sop_class = uidText(data, DCM_SOPClassUID);
  if (header.sop_class.empty()) header.sop_class = uidText(meta, DCM_MediaStorageSOPClassUID);
  header.sop_instance = uidText(data, DCM_SOPInstanceUID);
  if (header.sop_instance.empty()) {
    header.sop_instance = uidText(meta, DCM_MediaStorageSOPInstanceUID);
  }
  for (const auto& [uid, name] : {std::pair(&header.series_uid, "Series Instance UID"),
                                  std::pair(&header.sop_class, "SOP Class UID"),
                                  std::pair(&header.sop_instance, "SOP Instance UID")}) {
    if (!uid->empty()) continue;
    return skip(cut ? "the DICOM header is cut short or damaged"
                    : std::string("a DICOM file without a ") + name);
  }
  header.study_uid = uidText(data, DCM_StudyInstanceUID);
  header.frame_of_reference = uidText(data, DCM_FrameOfReferenceUID);
  header.modality = trimmedText(data, DCM_Modality);
  header.description = decodedText(data, DCM_SeriesDescription);
  header.image_type = splitValues(trimmedText(data, DCM_ImageType));
  header.instance_number = trimmedText(data, DCM_InstanceNumber);
  header.rescale_type = trimmedText(data, DCM_RescaleType);
  header.photometric = trimmedText(data, DCM_PhotometricInterpretation);
  header.lossy = trimmedText(data, DCM_LossyImageCompression) == "01";
  header.transfer_syntax = uidText(meta, DCM_TransferSyntaxUID);
  if (header.transfer_syntax.empty()) {
    header.transfer_syntax = DcmXfer(data.getOriginalXfer()).getXferID();
  }
  header.rows = countOr(data, DCM_Rows, 0, 65535);
  header.columns = countOr(data, DCM_Columns, 0, 65535);
  header.samples = countOr(data, DCM_SamplesPerPixel, 1, 4);
  header.frames = countOr(data, DCM_NumberOfFrames, 1, 1000000);
  readFormat(data, header);

  if (const auto p = decimals<3>(data, DCM_ImagePositionPatient)) {
    header.position_mm = Vec3((*p)[0], (*p)[1], (*p)[2]);
  }
  header.orientation = decimals<6>(data, DCM_ImageOrientationPatient);
  header.pixel_spacing_mm = decimals<2>(data, DCM_PixelSpacing);
  if (header.pixel_spacing_mm && std::ranges::min(*header.pixel_spacing_mm) <= 0.0) {
    header.pixel_spacing_mm.reset();
  }

  DcmElement* pixels = nullptr;
  if (data.findAndGetElement(DCM_PixelData, pixels).good() && pixels) {
    header.has_pixels = true;
    const bool big = DcmXfer(data.getOriginalXfer()).getByteOrder() == EBO_BigEndian;
    header.ambiguous_order = big && header.bits_allocated > 8 && pixels->getVR() == EVR_OB;
    checkPixels(*pixels, cut, header);
  } else if (cut) {
    header.defect = Defect::cut;
    header.defect_text = "its header is cut short";
  }
  return header;
}

Status readStoredWords(const DicomHeader& header, std::int16_t* words) {
  const auto failed = [](std::string what) { return Error{"UNREADABLE", std::move(what), "", ""}; };
  DcmFileFormat dicom;
  if (dicom.loadFile(header.file.c_str(), EXS_Unknown, EGL_noChange, kLazyBytes, ERM_autoDetect)
          .bad()) {
    return failed("its file vanished, changed or is cut short");
  }
  DcmElement* pixels = nullptr;
  const std::uint64_t bytes = header.frameBytes();
  if (dicom.getDataset()->findAndGetElement(DCM_PixelData, pixels).bad() || !pixels ||
      pixels->getLength() < bytes || bytes > 0xFFFFFFFEU) {
    return failed("its file changed while it was read");
  }
  if (pixels->getPartialValue(words, 0, Uint32(bytes), nullptr, gLocalByteOrder).bad()) {
    return failed("its pixels are cut short");
  }
  return {};
}

}  // namespace trephine
