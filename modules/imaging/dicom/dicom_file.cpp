#include "imaging/dicom/detail/dicom_file.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <functional>
#include <mutex>
#include <shared_mutex>

#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/dicom/detail/codecs.h"
#include "imaging/dicom/detail/dicom_names.h"
#include "imaging/dicom/detail/dicom_pixels.h"
#include "imaging/dicom/detail/dicom_stream.h"
#include "imaging/dicom/detail/dicom_values.h"
#include "imaging/dicom/detail/transfer_syntax.h"

namespace trephine {

namespace {

constexpr std::string_view kDicomDir = "1.2.840.10008.1.3.10";
constexpr const char* kUnnamedSeries = "unnamed";
constexpr int kMostFrames = 100000;

Error skip(std::string reason) {
  return Error{code::kSkipped, std::move(reason), "", ""};
}

// What other programs keep volumes in, told by its ending.
const char* otherFormat(const std::filesystem::path& file) {
  constexpr std::pair<std::string_view, const char*> kEndings[] = {
      {".mgz", trLater("a FreeSurfer volume: convert it to NIfTI first (mri_convert)")},
      {".mgh", trLater("a FreeSurfer volume: convert it to NIfTI first (mri_convert)")},
      {".hdr",
       trLater("half of a pair of header and voxels (Analyze or NIfTI): save it as one .nii file")},
      {".img",
       trLater(
           "half of a pair of header and voxels (Analyze or NIfTI): save it as one .nii file")}};
  std::string name = file.filename().string();
  for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
  for (const auto& [ending, words] : kEndings) {
    if (name.ends_with(ending)) return words;
  }
  return nullptr;
}

// What holds files, or a file, in packed form: told by its first bytes, whatever its name.
struct Packed {
  std::size_t at;
  std::string_view mark;
  const char* name;
};
using namespace std::string_view_literals;
constexpr Packed kPacked[] = {{0, "PK\3\4"sv, trLater("a ZIP archive")},
                              {0, "\x1F\x8B\x08"sv, trLater("a gzip file")},
                              {0, "7z\xBC\xAF\x27\x1C"sv, "a 7z archive"},
                              {0, "Rar!\x1A\x07"sv, trLater("a RAR archive")},
                              {0,
                               "\xFD"
                               "7zXZ\0"sv,
                               trLater("an xz file")},
                              {0, "\x28\xB5\x2F\xFD"sv, trLater("a Zstandard file")},
                              {4, "1AY&SY"sv, "a bzip2 file"},
                              {257, "ustar"sv, trLater("a tar archive")}};

// Whether DCMTK came to the element's end. Its transfer state does not tell: values of odd length
// never become ready.
struct ElementState : DcmObject {
  static bool isWhole(const DcmObject& element) {
    return (element.*&ElementState::errorFlag).good();
  }
};

// An element that the file's end cut holds what was in memory before, be it another patient's name.
void dropHalfRead(DcmItem& item) {
  std::vector<DcmObject*> half_read;
  for (DcmObject* at = item.nextInContainer(nullptr); at; at = item.nextInContainer(at)) {
    if (!ElementState::isWhole(*at)) half_read.push_back(at);
  }
  for (DcmObject* element : half_read) delete item.remove(element);
}

// Slope and intercept stand in the data set, or in a functional group of an enhanced image.
void readRescale(const DicomItem& item, DicomHeader& header) {
  StoredFormat& format = header.format;
  const std::string slope = trimmedText(item, DCM_RescaleSlope);
  const std::string intercept = trimmedText(item, DCM_RescaleIntercept);
  const auto slope_value = parseDecimal(slope), intercept_value = parseDecimal(intercept);
  // No scale of CT comes near to these.
  constexpr double kSteepest = 1e4, kFarthest = 1e7;
  const bool odd = std::abs(slope_value.value_or(1.0)) > kSteepest ||
                   std::abs(intercept_value.value_or(0.0)) > kFarthest;
  header.rescale_bad =
      odd || (!slope.empty() && !slope_value) || (!intercept.empty() && !intercept_value);
  format.slope = slope_value.value_or(1.0);
  format.intercept = intercept_value.value_or(0.0);
  header.intercept_given = intercept_value.has_value();
  header.rescale_given = slope_value && intercept_value && *slope_value != 0.0;
  if (format.slope == 0.0) format.slope = 1.0;
  header.rescale_type = trimmedText(item, DCM_RescaleType);
}

void readFormat(const DicomItem& data, DicomHeader& header) {
  StoredFormat& format = header.format;
  header.bits_allocated = countOr(data, DCM_BitsAllocated, 0, 64);
  format.bits_stored = countOr(data, DCM_BitsStored, header.bits_allocated, 64);
  format.high_bit = countOr(data, DCM_HighBit, format.bits_stored - 1, 63);
  format.is_signed = countOr(data, DCM_PixelRepresentation, 0, 1) == 1;
  // US or SS: kept as the word that the pixels would hold.
  const auto padding = parseInteger(valueText(data, DCM_PixelPaddingValue));
  const auto limit = parseInteger(valueText(data, DCM_PixelPaddingRangeLimit));
  if (padding) {
    format.padding =
        StoredFormat::Padding{std::uint16_t(*padding), std::uint16_t(limit.value_or(*padding))};
  }
}

void readSpacing(const DicomItem& item, DicomHeader& header) {
  header.pixel_spacing_mm = decimals<2>(item, DCM_PixelSpacing);
  if (header.pixel_spacing_mm && std::ranges::min(*header.pixel_spacing_mm) <= 0.0) {
    header.pixel_spacing_mm.reset();
  }
}

void readPosition(const DicomItem& item, DicomHeader& header) {
  header.position_mm.reset();
  if (const auto p = decimals<3>(item, DCM_ImagePositionPatient)) {
    header.position_mm = Vec3((*p)[0], (*p)[1], (*p)[2]);
  }
}

std::optional<double> number(const DicomItem& item, const DcmTagKey& tag) {
  return parseDecimal(trimmedText(item, tag));
}

void readPhase(const DicomItem& data, DicomHeader& header) {
  header.phase[kTemporalPosition] = number(data, DCM_TemporalPositionIdentifier);
  header.phase[kCardiacPercent] = number(data, DCM_NominalPercentageOfCardiacPhase);
  header.phase[kAcquisitionNumber] = number(data, DCM_AcquisitionNumber);
  header.phase[kTriggerTime] = number(data, DCM_TriggerTime);
  header.phase[kTriggerDelay] = number(data, DCM_NominalCardiacTriggerDelayTime);
  const auto date_time = timeNumber(data, DCM_AcquisitionDateTime);
  header.phase[kAcquisitionTime] = date_time ? date_time : timeNumber(data, DCM_AcquisitionTime);
  header.phase[kContentTime] = timeNumber(data, DCM_ContentTime);
}

std::optional<double> notZero(std::optional<double> value) {
  return value && *value != 0.0 ? value : std::nullopt;
}

// What tells one way of scanning from another, and what says in other words where slices lie.
void readAcquisition(const DicomItem& data, DicomHeader& header) {
  header.kernel = trimmedText(data, DCM_ConvolutionKernel);
  header.scanner = trimmedText(data, DCM_Manufacturer) +
                   trimmedText(data, DCM_ManufacturerModelName) +
                   trimmedText(data, DCM_DeviceSerialNumber);
  header.patient_position = trimmedText(data, DCM_PatientPosition);
  header.contrast = trimmedText(data, DCM_ContrastBolusAgent);
  header.kvp = notZero(number(data, DCM_KVP));
  header.thickness_mm = notZero(number(data, DCM_SliceThickness));
  header.spacing_between_mm = notZero(number(data, DCM_SpacingBetweenSlices));
  header.tilt_deg = notZero(number(data, DCM_GantryDetectorTilt));
  header.location_mm = number(data, DCM_SliceLocation);
}

// The first item of a sequence.
DicomItem firstItem(const DicomItem& item, const DcmTagKey& sequence) {
  const std::vector<DcmItem*> items = item.items(sequence);
  return DicomItem(items.empty() ? nullptr : items.front());
}

// Of the whole image, or of a frame, which overrides it where it says anything.
void readKind(const DicomItem& item, const DcmTagKey& type, DicomHeader& header) {
  const auto take = [&](const DcmTagKey& tag, std::string& value) {
    if (std::string text = trimmedText(item, tag); !text.empty()) value = std::move(text);
  };
  std::string values;
  take(type, values);
  if (!values.empty()) header.image_type = splitValues(values);
  take(DCM_VolumetricProperties, header.volumetric);
  take(DCM_VolumeBasedCalculationTechnique, header.technique);
  take(DCM_PixelPresentation, header.presentation);
}

void readValueMaps(const DicomItem& item, DicomHeader& header) {
  const std::vector<DcmItem*> maps = item.items(DCM_RealWorldValueMappingSequence);
  if (!maps.empty()) header.value_maps.clear();
  constexpr std::size_t kMost = 64;  // each frame of a file has its own
  for (DcmItem* map : maps) {
    if (header.value_maps.size() == kMost) break;
    const DicomItem values(map);
    header.value_maps.push_back(
        {trimmedText(firstItem(values, DCM_MeasurementUnitsCodeSequence), DCM_CodeValue),
         number(values, DCM_RealWorldValueSlope), number(values, DCM_RealWorldValueIntercept)});
  }
}

// Enhanced CT: what a frame says of itself overrides what all share (PS3.3 C.7.6.16).
void readFunctionalGroups(const DicomItem& shared, const DicomItem& own, DicomHeader& header) {
  const auto group = [&](const DcmTagKey& macro) {
    DicomItem item = firstItem(own, macro);
    return item.empty() ? firstItem(shared, macro) : item;
  };
  const auto read = [&](const DcmTagKey& macro, const auto& values) {
    if (const DicomItem item = group(macro); !item.empty()) values(item);
  };
  read(DCM_PixelMeasuresSequence, [&](const DicomItem& item) {
    readSpacing(item, header);
    header.thickness_mm = notZero(number(item, DCM_SliceThickness));
    header.spacing_between_mm = notZero(number(item, DCM_SpacingBetweenSlices));
  });
  read(DCM_CTReconstructionSequence, [&](const DicomItem& item) {
    header.kernel = trimmedText(item, DCM_ConvolutionKernel);
  });
  read(DCM_CTXRayDetailsSequence,
       [&](const DicomItem& item) { header.kvp = notZero(number(item, DCM_KVP)); });
  read(DCM_CTAcquisitionDetailsSequence, [&](const DicomItem& item) {
    header.tilt_deg = notZero(number(item, DCM_GantryDetectorTilt));
  });
  read(DCM_PlanePositionSequence, [&](const DicomItem& item) { readPosition(item, header); });
  read(DCM_PlaneOrientationSequence, [&](const DicomItem& item) {
    header.orientation = decimals<6>(item, DCM_ImageOrientationPatient);
  });
  read(DCM_PixelValueTransformationSequence,
       [&](const DicomItem& item) { readRescale(item, header); });
  read(DCM_CTImageFrameTypeSequence,
       [&](const DicomItem& item) { readKind(item, DCM_FrameType, header); });
  readValueMaps(shared, header);
  readValueMaps(own, header);
  read(DCM_CardiacSynchronizationSequence, [&](const DicomItem& item) {
    header.phase[kCardiacPercent] = number(item, DCM_NominalPercentageOfCardiacPhase);
    header.phase[kTriggerDelay] = number(item, DCM_NominalCardiacTriggerDelayTime);
  });
  read(DCM_FrameContentSequence, [&](const DicomItem& item) {
    header.phase[kTemporalPosition] = number(item, DCM_TemporalPositionIndex);
    header.phase[kAcquisitionNumber] = number(item, DCM_FrameAcquisitionNumber);
    header.phase[kAcquisitionTime] = timeNumber(item, DCM_FrameAcquisitionDateTime);
  });
}

// Whether a frame's pixels lie before the end of a file that is cut.
bool isThere(const DicomHeader& frame) {
  if (frame.defect != Defect::cut || !frame.pixels) return false;
  if (frame.pixels->encapsulated) {
    const auto& frames = frame.pixels->frames;
    return std::size_t(frame.frame) < frames.size() && !frames[std::size_t(frame.frame)].empty();
  }
  const TransferSyntax* syntax = findTransferSyntax(frame.transfer_syntax);
  return syntax && syntax->codec == Codec::none && frame.frameBytes() > 0 &&
         frame.pixels->offset + frame.frameBytes() * std::uint64_t(frame.frame + 1) <=
             frame.file_bytes;
}

// Memory that a copy of a header takes for its texts.
std::uint64_t textBytes(const DicomHeader& h) {
  std::uint64_t bytes = 0;
  for (const std::string* text :
       {&h.series_key, &h.modality, &h.description, &h.body_part, &h.rescale_type,
        &h.instance_number, &h.patient[0], &h.patient[1], &h.patient[2], &h.patient[3],
        &h.patient_name, &h.acquired, &h.concatenation, &h.study_text, &h.volumetric, &h.technique,
        &h.presentation, &h.kernel, &h.scanner,
        &h.patient_position, &h.contrast, &h.photometric, &h.defect_text}) {
    bytes += text->size();
  }
  for (const std::string& text : h.image_type) bytes += sizeof text + text.size();
  for (const auto& map : h.value_maps) bytes += sizeof map + map.unit.size();
  return bytes;
}

std::vector<DicomHeader> splitFrames(const DicomItem& data, DicomHeader whole) {
  const bool grouped = data.find(DCM_SharedFunctionalGroupsSequence) ||
                       data.find(DCM_PerFrameFunctionalGroupsSequence);
  const std::vector<DcmItem*> per_frame = data.items(DCM_PerFrameFunctionalGroupsSequence);
  const bool lost = !whole.pixels || (whole.pixels->encapsulated && whole.pixels->frames.empty());
  const auto alone = [&whole] {
    std::vector<DicomHeader> one;
    one.push_back(std::move(whole));
    return one;
  };
  // A claim of frames that are not there is refused once, not a hundred thousand times.
  if ((whole.frames == 1 && !grouped) || whole.defect == Defect::size_mismatch ||
      (lost && per_frame.size() < std::size_t(whole.frames))) {
    return alone();
  }
  // Without functional groups nothing says where a frame lies.
  if (!grouped) whole.position_mm.reset();
  const DicomItem shared = firstItem(data, DCM_SharedFunctionalGroupsSequence);
  constexpr std::uint64_t kMostText = std::uint64_t(512) << 20;
  if (textBytes(whole) * std::uint64_t(whole.frames) > kMostText) {
    whole.defect = Defect::size_mismatch;
    whole.defect_text = tr("its header says too much for so many frames");
    return alone();
  }
  std::vector<DicomHeader> frames(std::size_t(whole.frames), whole);
  for (int n = 0; n < whole.frames; ++n) {
    DicomHeader& frame = frames[std::size_t(n)];
    frame.frame = n;
    if (isThere(frame)) {
      frame.defect = Defect::none;
      frame.defect_text.clear();
    }
    if (whole.frames > 1) frame.instance_number = std::to_string(n + 1);
    const bool there = std::size_t(n) < per_frame.size();
    readFunctionalGroups(shared, DicomItem(there ? per_frame[std::size_t(n)] : nullptr), frame);
  }
  return frames;
}

// Compares what the pixel element holds with what rows, columns and bits need, in 64 bit.
void checkPixels(bool cut, DicomHeader& header) {
  const TransferSyntax* syntax = findTransferSyntax(header.transfer_syntax);
  if (!syntax) return;
  const auto spoilt = [&](Defect defect, std::string text) {
    header.defect = defect;
    header.defect_text = std::move(text);
  };
  const PixelPlace& place = *header.pixels;
  if (cut) spoilt(Defect::cut, tr("its pixels are cut short"));
  if (cut && (header.frames == 1 || place.encapsulated)) return;
  const bool encapsulated = syntax->codec == Codec::dcmtk || syntax->codec == Codec::jpeg2000;
  if (place.encapsulated != encapsulated) {
    return spoilt(Defect::size_mismatch,
                  tr("its pixels are not stored as its transfer syntax says"));
  }
  if (encapsulated) {
    if (place.frames.empty()) {
      spoilt(Defect::size_mismatch, tr("its frames cannot be told apart"));
    }
    return;
  }
  const std::uint64_t needed = header.frameBytes() * std::uint64_t(std::max(header.frames, 1));
  if (header.bits_allocated % 8 != 0 || needed == 0) return;
  // Writers pad, by less than a row; more means that rows or columns are wrong.
  // Deflate shrinks to a thousandth at most.
  if (syntax->codec == Codec::deflated && needed / 1032 > header.file_bytes) {
    return spoilt(Defect::size_mismatch, tr("it is too small for the pixels that it claims"));
  }
  const std::uint64_t row = header.frameBytes() / std::uint64_t(header.rows);
  if (place.bytes < needed || place.bytes - needed >= std::max<std::uint64_t>(row, 2)) {
    spoilt(Defect::size_mismatch, tr("it holds {} bytes of pixels where {}x{} need {}", place.bytes,
                                     header.columns, header.rows, needed));
  }
}

// The first bytes of the first frame's codestream, whatever fragments they lie in.
std::vector<std::uint8_t> firstBytes(const DicomHeader& header) {
  constexpr std::uint64_t kEnough = 4096;
  std::vector<std::uint8_t> bytes;
  for (const PixelPlace::Fragment& fragment : header.pixels->frames.front()) {
    const auto wanted = std::min<std::uint64_t>(fragment.bytes, kEnough - bytes.size());
    const auto part = readBytes(header.file, fragment.offset, wanted);
    if (!part || wanted == 0) break;
    bytes.insert(bytes.end(), part->begin(), part->end());
  }
  return bytes;
}

// Whether HU can differ from what the scanner made. The codestream may tell what its name does not.
bool isLossy(const DicomItem& data, const DicomHeader& header) {
  if (trimmedText(data, DCM_LossyImageCompression) == "01") return true;
  const TransferSyntax* syntax = findTransferSyntax(header.transfer_syntax);
  if (!syntax || syntax->loss == Loss::never) return false;
  if (syntax->loss == Loss::always) return true;
  if (!header.pixels || header.pixels->frames.empty()) return false;
  return isLossyCodestream(*syntax, firstBytes(header)).value_or(syntax->loss == Loss::may_be);
}

// Bits that the codestream has and the header does not say: they would be masked away. One of all
// allocated bits tells nothing: many writers give none else. Neither do those above a sign, or with
// an overlay among them.
void takeBitsOfStream(DicomHeader& header) {
  const TransferSyntax* syntax = findTransferSyntax(header.transfer_syntax);
  const bool compressed = syntax && header.pixels && !header.pixels->frames.empty() &&
                          (syntax->codec == Codec::dcmtk || syntax->codec == Codec::jpeg2000);
  if (!compressed || header.pixels->frames.front().empty()) return;
  const int bits = bitsOfCodestream(*syntax, firstBytes(header)).value_or(0);
  StoredFormat& format = header.format;
  const bool as_said =
      format.high_bit == format.bits_stored - 1 && !format.is_signed && !header.overlay_bits;
  if (!as_said || bits <= format.bits_stored || bits >= header.bits_allocated) return;
  header.said_bits_stored = format.bits_stored;
  format.bits_stored = bits;
  format.high_bit = bits - 1;
}

// Whether an overlay lies in the pixels' own words (PS3.3 C.9.2, retired): its bits are no value.
bool hasOverlayBits(const DicomItem& data) {
  for (Uint16 group = 0x6000; group <= 0x601E; group = Uint16(group + 2)) {
    const DcmTagKey allocated(group, 0x0100), position(group, 0x0102);
    if (countOr(data, allocated, 0, 64) > 1 || countOr(data, position, 0, 64) > 0) return true;
  }
  return false;
}

void findPixelsOf(const DcmXfer& xfer, DicomStream& stream, DicomHeader& header) {
  const TransferSyntax* syntax = findTransferSyntax(header.transfer_syntax);
  bool cut = false;
  std::string vr;
  if (syntax && syntax->codec == Codec::deflated && stream.eos()) {
    // No pixels follow.
  } else if (syntax && syntax->codec == Codec::deflated) {
    // Its offset lies in the inflated data set; its length is compared when it is inflated.
    auto place = std::make_shared<PixelPlace>();
    place->bytes = header.frameBytes() * std::uint64_t(header.frames);
    header.pixels = std::move(place);
    vr = "OW";
  } else {
    header.big_endian = xfer.getByteOrder() == EBO_BigEndian;
    header.pixels =
        findPixels(header.file, header.file_bytes, std::uint64_t(stream.tell()), stream.newest(),
                   xfer.isExplicitVR(), header.big_endian, header.frames, vr, cut);
  }
  header.has_pixels = header.pixels != nullptr;
  header.swapped_pairs = header.big_endian && header.bits_allocated == 8 && vr == "OW";
  header.ambiguous_order = header.big_endian && header.bits_allocated > 8 && vr == "OB";
  if (header.has_pixels) checkPixels(cut, header);
}

bool isCut(DcmFileFormat& dicom, DicomStream& stream) {
  dicom.transferInit();
  return dicom.readUntilTag(stream, EXS_Unknown, EGL_noChange, kLongestValue, DCM_PixelData).bad();
}

// Why a header cannot be read: its data set may be written in another way than its first part says.
Error damagedHeader(const std::filesystem::path& file) {
  constexpr std::size_t kGroupLength = 132, kLengthEnd = 144;
  const Error damaged{code::kCutShort, tr("the DICOM header is cut short or damaged"), "", ""};
  const auto first = readBytes(file, 0, kLengthEnd);
  if (!first) return damaged;
  const std::uint8_t* head = first->data() + kGroupLength;  // (0002,0000) UL, 4 bytes
  const bool has_length = head[0] == 2 && head[1] == 0 && head[2] == 0 && head[3] == 0;
  if (!has_length) return damaged;
  const std::uint64_t length = std::uint64_t(head[8]) | std::uint64_t(head[9]) << 8 |
                               std::uint64_t(head[10]) << 16 | std::uint64_t(head[11]) << 24;
  const auto element = readBytes(file, kLengthEnd + length, 8);
  if (!element || length > kLongestValue) return damaged;
  const auto& e = *element;
  const bool group_8 = e[0] == 8 && e[1] == 0;
  const bool explicit_vr = std::isupper(e[4]) && std::isupper(e[5]);
  const auto meta = readBytes(file, kLengthEnd, length);
  const std::string text = meta ? std::string(meta->begin(), meta->end()) : std::string();
  const bool says_explicit = text.find("1.2.840.10008.1.2.1") != text.npos;
  const bool says_implicit = !says_explicit && text.find("1.2.840.10008.1.2") != text.npos &&
                             text.find("1.2.840.10008.1.2.") == text.npos;
  if (group_8 && says_explicit && !explicit_vr) {
    return skip(
        tr("it is written in Implicit VR Little Endian, and says Explicit VR: correct its transfer "
           "syntax to 1.2.840.10008.1.2"));
  }
  if (group_8 && says_implicit && explicit_vr) {
    return skip(
        tr("it is written in Explicit VR Little Endian, and says Implicit VR: correct its transfer "
           "syntax to 1.2.840.10008.1.2.1"));
  }
  return damaged;
}

}  // namespace

Result<std::vector<DicomHeader>> readDicomHeaders(const std::filesystem::path& file,
                                                  std::uint64_t file_bytes,
                                                  const Progress& progress) {
  setUpDcmtk();
  if (file_bytes == 0) return skip(tr("the file is empty"));
  DicomStream stream(file, kSliceBounds, &progress);
  const std::string_view head = stream.beginning(1024);
  if (head.empty()) return Error{code::kUnreadableFile, tr("the file may not be read"), "", ""};
  if (!looksLikeDicom(head)) {
    if (const char* other = otherFormat(file)) return skip(tr(other));
    const auto packed = std::ranges::find_if(kPacked, [&](const Packed& kind) {
      return head.size() > kind.at && head.substr(kind.at).starts_with(kind.mark);
    });
    if (packed == std::end(kPacked)) return skip(tr("not a DICOM file"));
    return Error{code::kPacked, tr("{}: unpack it first", tr(packed->name)), "", ""};
  }
  if (head.find(kDicomDir) != head.npos) {
    return skip(tr("a DICOMDIR: the files themselves are read instead"));
  }

  DcmFileFormat dicom;
  bool cut = false;
  {
    const std::shared_lock other_rule(unknownRule());
    cut = isCut(dicom, stream);
  }
  if (stream.isTooDeep()) return skip(tr("nested too deeply"));
  if (stream.isTooLong()) return skip(tr("its header is longer than any real one"));
  std::optional<DicomStream> again;
  if (cut && !progress.cancelled()) {
    // Elements of unknown kind and length (UN) are to be written in implicit VR, and some writers
    // write them as they write everything else.
    const std::unique_lock other_rule(unknownRule());
    dcmEnableCP246Support.set(OFFalse);
    again.emplace(file, kSliceBounds, &progress);
    DcmFileFormat other;
    if (!isCut(other, *again)) {
      dicom = other;
      cut = false;
    }
    dcmEnableCP246Support.set(OFTrue);
  }
  DicomStream& stream_read = again && !cut ? *again : stream;
  if (cut) {
    dropHalfRead(*dicom.getDataset());
    dropHalfRead(*dicom.getMetaInfo());
  }
  dicom.transferEnd();
  const DicomItem data(dicom.getDataset()), meta(dicom.getMetaInfo());
  const DcmXfer xfer(dicom.getDataset()->getOriginalXfer());

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
  // Anonymising software empties UIDs; that the attribute is there tells such files from debris.
  if (header.series_uid.empty() && data.find(DCM_SeriesInstanceUID) &&
      valueText(data, DCM_SeriesInstanceUID).empty()) {
    header.series_uid = kUnnamedSeries;
    header.series_key = trimmedText(data, DCM_SeriesNumber) + "\\" +
                        trimmedText(data, DCM_SeriesDate) + "\\" +
                        trimmedText(data, DCM_SeriesTime);
  }
  for (const auto& [uid, name] : {std::pair(&header.series_uid, "Series Instance UID"),
                                  std::pair(&header.sop_class, "SOP Class UID"),
                                  std::pair(&header.sop_instance, "SOP Instance UID")}) {
    if (!uid->empty()) continue;
    return cut ? damagedHeader(file) : skip(tr("a DICOM file without a {}", name));
  }
  header.study_uid = uidText(data, DCM_StudyInstanceUID);
  header.frame_of_reference = uidText(data, DCM_FrameOfReferenceUID);
  header.modality = trimmedText(data, DCM_Modality);
  header.description = decodedText(data, DCM_SeriesDescription);
  header.body_part = trimmedText(data, DCM_BodyPartExamined);
  readKind(data, DCM_ImageType, header);
  readValueMaps(data, header);
  header.modality_lut = !data.items(DCM_ModalityLUTSequence).empty();
  header.instance_number = trimmedText(data, DCM_InstanceNumber);
  header.photometric = trimmedText(data, DCM_PhotometricInterpretation);
  header.transfer_syntax = uidText(meta, DCM_TransferSyntaxUID);
  if (header.transfer_syntax.empty()) {
    header.transfer_syntax = xfer.getXferID();
  }
  header.rows = countOr(data, DCM_Rows, 0, 65535);
  header.columns = countOr(data, DCM_Columns, 0, 65535);
  header.samples = countOr(data, DCM_SamplesPerPixel, 1, 4);
  header.frames = std::max(countOr(data, DCM_NumberOfFrames, 1, kMostFrames), 1);
  readFormat(data, header);
  readRescale(data, header);
  readPosition(data, header);
  readSpacing(data, header);
  readPhase(data, header);
  readAcquisition(data, header);
  header.patient = patientOf(data);
  header.acquired = trimmedText(data, DCM_AcquisitionDate);
  if (header.acquired.empty()) {
    header.acquired = trimmedText(data, DCM_AcquisitionDateTime).substr(0, 8);
  }
  header.concatenation = uidText(data, DCM_ConcatenationUID);
  if (!header.concatenation.empty()) {
    header.in_concatenation = countOr(data, DCM_InConcatenationNumber, 0, 65535);
    header.concatenated = countOr(data, DCM_InConcatenationTotalNumber, 0, 65535);
  }
  header.patient_name = patientText(data);
  header.study_text = studyText(data);
  header.identity = std::make_shared<const SourceIdentity>(identityOf(data));
  header.orientation = decimals<6>(data, DCM_ImageOrientationPatient);

  if (cut) {
    header.defect = Defect::cut;
    header.defect_text = tr("its header is cut short");
  } else {
    findPixelsOf(xfer, stream_read, header);
    header.overlay_bits = header.pixels && header.pixels->encapsulated && hasOverlayBits(data);
    takeBitsOfStream(header);
  }
  header.lossy = isLossy(data, header);
  return splitFrames(data, std::move(header));
}

}  // namespace trephine
