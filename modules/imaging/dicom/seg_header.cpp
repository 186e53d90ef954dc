#include "imaging/dicom/detail/seg_header.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmfg/fgpixmsr.h>
#include <dcmtk/dcmfg/fgplanor.h>
#include <dcmtk/dcmfg/fgplanpo.h>
#include <dcmtk/dcmfg/fgseg.h>
#include <dcmtk/dcmseg/segdoc.h>
#include <dcmtk/dcmseg/segment.h>

#include <algorithm>
#include <limits>
#include <set>
#include <shared_mutex>

#include "base/codes.h"
#include "base/memory.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/cielab.h"
#include "imaging/dicom/detail/dicom_pixels.h"
#include "imaging/dicom/detail/dicom_stream.h"
#include "imaging/dicom/detail/dicom_values.h"
#include "imaging/dicom/detail/transfer_syntax.h"
#include "imaging/dicom/seg_reader.h"
#include "volume/codes.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr int kMostFrames = 1000000;

// DCMTK's own reading of the pixels loses bits where rows x columns is no multiple of eight, and
// keeps them twice; all else of it serves.
class FramesWithoutPixels : public DcmSegmentation {
 public:
  using DcmSegmentation::readWithoutPixelData;
};

Error wrongSize(const std::string& what) {
  return Error{code::kSizeMismatch, what, "", tr("Copy or export the file anew")};
}

template <class Group>
Group* groupOf(DcmSegmentation& segmentation, std::size_t frame, DcmFGTypes::E_FGType type) {
  return dynamic_cast<Group*>(segmentation.getFunctionalGroups().get(Uint32(frame), type));
}

std::string uidOrNone(const OFString& text) {
  const std::string uid(text.c_str(), text.length());
  const bool valid = uid.size() <= 64 && uid.find_first_not_of("0123456789.") == uid.npos;
  return valid ? uid : "";
}

void readReferences(DcmSegmentation& segmentation, SegHeader& header) {
  const auto add = [&](const auto& items) {
    for (auto* item : items) {
      OFString text;
      if (item->getSeriesInstanceUID(text).bad()) continue;
      const std::string uid = uidOrNone(text);
      if (!uid.empty() && std::ranges::find(header.series, uid) == header.series.end()) {
        header.series.push_back(uid);
      }
    }
  };
  auto& references = segmentation.getCommonInstanceReference();
  add(references.getReferencedSeriesItems());
  for (auto* study : references.getStudiesContainingOtherReferences()) {
    add(study->getReferencedSeriesAndInstanceReferences().getReferencedSeriesItems());
  }
}

Status readSegments(const DicomItem& data, DcmSegmentation& segmentation, SegHeader& header) {
  // DCMTK knows segments by their place alone: their own numbers, and names in all character sets,
  // are looked up beside it.
  const std::vector<DcmItem*> items = data.items(DCM_SegmentSequence);
  if (items.empty()) return unreadableSegmentation(tr("The file names no segment"));
  if (items.size() > std::size_t(kMostStructures)) {
    return Error{code::kTooManyStructures,
                 tr("The file holds {} segments, more than {}", items.size(), kMostStructures), "",
                 tr("Export those that the exercise needs")};
  }
  std::set<int> numbers;
  for (std::size_t n = 0; n < items.size(); ++n) {
    const DicomItem item(items[n]);
    SegHeader::Segment segment;
    segment.number = countOr(item, DCM_SegmentNumber, 0, 65535);
    if (segment.number == 0 || !numbers.insert(segment.number).second) {
      return unreadableSegmentation(tr("The segments' numbers are missing or stand twice"));
    }
    segment.name = decodedText(item, DCM_SegmentLabel, data);
    LabWords lab{};
    DcmSegment* const known = segmentation.getNumberOfSegments() == items.size()
                                  ? segmentation.getSegment(n + 1)
                                  : nullptr;
    if (known && known->getRecommendedDisplayCIELabValue(lab[0], lab[1], lab[2]).good()) {
      segment.colour = srgbOf(lab);
    }
    header.segments.push_back(std::move(segment));
  }
  return {};
}

Status readFrames(DcmSegmentation& segmentation, SegHeader& header) {
  const auto frames = std::size_t(header.pixels.frames);
  if (segmentation.getFunctionalGroups().getNumberOfFrames() != frames) {
    return wrongSize(tr("The file says of {} frames where they lie, and claims {}",
                        segmentation.getFunctionalGroups().getNumberOfFrames(), frames));
  }
  for (std::size_t n = 0; n < frames; ++n) {
    const std::string frame = tr("Frame {}", n + 1);
    FramePlane plane;
    auto* const position =
        groupOf<FGPlanePosPatient>(segmentation, n, DcmFGTypes::EFG_PLANEPOSPATIENT);
    Vec3& p = plane.position_mm;
    if (!position || position->getImagePositionPatient(p.x, p.y, p.z).bad()) {
      return noGeometry(tr("{} does not say where it lies", frame));
    }
    auto* const turned =
        groupOf<FGPlaneOrientationPatient>(segmentation, n, DcmFGTypes::EFG_PLANEORIENTPATIENT);
    auto& o = plane.orientation;
    if (!turned || turned->getImageOrientationPatient(o[0], o[1], o[2], o[3], o[4], o[5]).bad()) {
      return noGeometry(tr("{} does not say how it is turned", frame));
    }
    auto* const measures = groupOf<FGPixelMeasures>(segmentation, n, DcmFGTypes::EFG_PIXELMEASURES);
    auto& spacing = plane.pixel_spacing_mm;
    if (!measures || measures->getPixelSpacing(spacing[0], 0).bad() ||
        measures->getPixelSpacing(spacing[1], 1).bad()) {
      return noGeometry(tr("{} does not say how large its pixels are", frame));
    }
    double length = 0.0;
    if (n == 0 && measures->getSpacingBetweenSlices(length).good()) header.between_mm = length;
    if (n == 0 && measures->getSliceThickness(length).good()) header.thickness_mm = length;
    header.planes.push_back(plane);
    if (header.label_map) continue;
    auto* const segment = groupOf<FGSegmentation>(segmentation, n, DcmFGTypes::EFG_SEGMENTATION);
    Uint16 number = 0;
    if (!segment || segment->getReferencedSegmentNumber(number).bad()) {
      return unreadableSegmentation(tr("{} does not say of which segment it is", frame));
    }
    header.of.push_back(number);
  }
  return {};
}

// Rows, columns and frames against the bytes that are there, in 64 bit.
Status checkPixels(bool cut, SegHeader& header) {
  DicomHeader& pixels = header.pixels;
  const TransferSyntax* syntax = findTransferSyntax(pixels.transfer_syntax);
  const bool encapsulated =
      syntax && (syntax->codec == Codec::dcmtk || syntax->codec == Codec::jpeg2000);
  if (!syntax || (encapsulated && header.binary)) {
    return Error{code::kUnsupportedTransferSyntax,
                 tr("The segmentation is stored as {} ({}), which is not read",
                    transferSyntaxName(pixels.transfer_syntax), pixels.transfer_syntax),
                 "", tr("Export it without compression")};
  }
  if (syntax->loss == Loss::always) {
    header.notes.push_back(tr("The segmentation was compressed with loss: borders may be off."));
  }
  if (pixels.frames > kMostFrames) {
    return Error{code::kTooLarge, tr("The file claims more than a million frames"), "",
                 tr("Copy or export the file anew")};
  }
  if (pixels.frames == 0) {
    return Error{code::kNoFrames, tr("The file holds no frame"), "",
                 tr("Export a segmentation with voxels")};
  }
  if (pixels.rows == 0 || pixels.columns == 0) {
    return wrongSize(tr("The frames have no rows or no columns"));
  }
  if (pixels.pixelCount() > kLargestSlice) {
    return Error{code::kTooLarge, tr("A frame has more than 8192 x 8192 pixels"), "",
                 tr("Export it at a lower resolution")};
  }
  const int bits = header.binary ? 1 : header.label_map && pixels.bits_allocated == 16 ? 16 : 8;
  if (pixels.samples != 1 || pixels.bits_allocated != bits) {
    return wrongSize(
        tr("The frames do not have {} for each pixel", header.binary ? tr("one bit") : "a byte"));
  }
  if (!pixels.pixels) {
    return Error{code::kNoFrames, tr("The file holds no pixels"), "",
                 tr("Export a segmentation with voxels")};
  }
  if (cut) return unreadableSegmentation(tr("The file is cut short: its frames are not all there"));
  const PixelPlace& place = *pixels.pixels;
  if (place.encapsulated != encapsulated) {
    return wrongSize(tr("The frames are not stored as the file's transfer syntax says"));
  }
  const std::uint64_t all = pixels.pixelCount() * std::uint64_t(pixels.frames) * unsigned(bits);
  const std::uint64_t needed = (all + 7) / 8;
  if (encapsulated ? place.frames.size() != std::size_t(pixels.frames) : place.bytes < needed) {
    return wrongSize(tr("The file holds fewer frames than it claims"));
  }
  // Deflate shrinks to a thousandth at most.
  if (syntax->codec == Codec::deflated && needed / 1032 > pixels.file_bytes) {
    return wrongSize(tr("The file is too small for the frames that it claims"));
  }
  if (syntax->codec == Codec::deflated) {
    return enoughMemory(double(needed) / 1048576.0, tr("The segmentation"), "");
  }
  return {};
}

// Where the pixels lie, once all before them was read.
void findFrames(const DcmXfer& xfer, DicomStream& stream, DicomHeader& pixels, bool binary,
                bool& cut) {
  const TransferSyntax* syntax = findTransferSyntax(pixels.transfer_syntax);
  if (syntax && syntax->codec == Codec::deflated) {
    if (stream.eos()) return;
    auto place = std::make_shared<PixelPlace>();
    const std::uint64_t all = pixels.pixelCount() * std::uint64_t(pixels.frames);
    place->bytes = binary ? (all + 7) / 8 : all * std::uint64_t(pixels.bits_allocated > 8 ? 2 : 1);
    pixels.pixels = std::move(place);
    return;
  }
  std::string vr;
  pixels.pixels =
      findPixels(pixels.file, pixels.file_bytes, std::uint64_t(stream.tell()), stream.newest(),
                 xfer.isExplicitVR(), pixels.big_endian, pixels.frames, vr, cut);
  pixels.swapped_pairs = pixels.big_endian && vr == "OW";
}

// A label map is newer than DCMTK's reader, which takes all but its pixels if it is called binary.
// Number 0, which some give to what is no structure, is no segment.
void readAsBinary(DcmDataset& data) {
  data.putAndInsertString(DCM_SOPClassUID, UID_SegmentationStorage);
  data.putAndInsertString(DCM_SegmentationType, "BINARY");
  data.putAndInsertUint16(DCM_BitsAllocated, 1);
  data.putAndInsertUint16(DCM_BitsStored, 1);
  data.putAndInsertUint16(DCM_HighBit, 0);
  data.putAndInsertString(DCM_PhotometricInterpretation, "MONOCHROME2");
  DcmSequenceOfItems* segments = nullptr;
  if (data.findAndGetSequence(DCM_SegmentSequence, segments).bad() || !segments) return;
  for (unsigned long n = segments->card(); n-- > 0;) {
    Uint16 number = 0;
    const bool read = segments->getItem(n)->findAndGetUint16(DCM_SegmentNumber, number).good();
    if (read && number == 0) delete segments->remove(n);
  }
}

}  // namespace

Error unreadableSegmentation(const std::string& what) {
  return Error{code::kUnreadable, what, "", tr("Copy or export the file anew")};
}

Result<SegHeader> readSegHeader(const fs::path& file, const Progress& progress) {
  setUpDcmtk();
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  const std::shared_lock rule(unknownRule());
  DicomStream stream(file, kManyFrames, &progress);
  if (error || stream.beginning(1).empty()) {
    return unreadableSegmentation(tr("The file is not there, is empty or may not be read"));
  }
  DcmFileFormat dicom;
  dicom.transferInit();
  const bool whole =
      dicom.readUntilTag(stream, EXS_Unknown, EGL_noChange, kLongestValue, DCM_PixelData).good();
  dicom.transferEnd();
  const DicomItem meta(dicom.getMetaInfo()), data(dicom.getDataset());
  std::string sop_class = uidText(data, DCM_SOPClassUID);
  if (sop_class.empty()) sop_class = uidText(meta, DCM_MediaStorageSOPClassUID);
  if (!isSegmentation(sop_class)) {
    return Error{code::kNotSegmentation, tr("The file is no DICOM segmentation"), "",
                 tr("Choose a file of modality SEG")};
  }
  if (!whole) return unreadableSegmentation(tr("The file is cut short or damaged"));

  SegHeader header;
  DicomHeader& pixels = header.pixels;
  const DcmXfer xfer(dicom.getDataset()->getOriginalXfer());
  pixels.file = file;
  pixels.file_bytes = bytes;
  pixels.transfer_syntax = uidText(meta, DCM_TransferSyntaxUID);
  if (pixels.transfer_syntax.empty()) pixels.transfer_syntax = xfer.getXferID();
  pixels.rows = countOr(data, DCM_Rows, 0, 65535);
  pixels.columns = countOr(data, DCM_Columns, 0, 65535);
  pixels.samples = countOr(data, DCM_SamplesPerPixel, 1, 4);
  pixels.frames = countOr(data, DCM_NumberOfFrames, 0, std::numeric_limits<int>::max());
  pixels.bits_allocated = countOr(data, DCM_BitsAllocated, 0, 64);
  pixels.format.bits_stored = pixels.bits_allocated == 16 ? 16 : 8;
  pixels.format.high_bit = pixels.format.bits_stored - 1;
  pixels.big_endian = xfer.getByteOrder() == EBO_BigEndian;
  const std::string type = trimmedText(data, DCM_SegmentationType);
  header.label_map = sop_class == kLabelMapStorage;
  if (header.label_map ? type != "LABELMAP" : type != "BINARY" && type != "FRACTIONAL") {
    return Error{code::kUnsupportedSegmentation,
                 header.label_map ? tr("The label map segmentation does not say that it is one")
                                  : tr("The segmentation is neither binary nor fractional"),
                 "", tr("Export it as a binary segmentation")};
  }
  header.binary = type == "BINARY";
  bool cut = false;
  findFrames(xfer, stream, pixels, header.binary, cut);
  if (const Status right = checkPixels(cut, header); !right) return right.error();
  if (!header.binary && !header.label_map) {
    header.most = countOr(data, DCM_MaximumFractionalValue, 0, 65535);
    if (header.most == 0) {
      header.most = 255;
      header.notes.push_back(
          tr("The file does not say which value stands for a whole voxel: 255 was taken."));
    }
  }

  // DCMTK reads no frame's group where nothing is shared.
  DcmItem* shared = nullptr;
  dicom.getDataset()->findOrCreateSequenceItem(DCM_SharedFunctionalGroupsSequence, shared, 0);
  if (header.label_map) readAsBinary(*dicom.getDataset());
  FramesWithoutPixels segmentation;
  if (segmentation.readWithoutPixelData(*dicom.getDataset()).bad()) {
    return unreadableSegmentation(tr("The file's header cannot be understood"));
  }
  const DicomItem all(dicom.getDataset());
  if (const Status read = readSegments(all, segmentation, header); !read) return read.error();
  if (const Status read = readFrames(segmentation, header); !read) return read.error();
  readReferences(segmentation, header);
  header.study = uidText(all, DCM_StudyInstanceUID);
  header.frame_of_reference = uidText(all, DCM_FrameOfReferenceUID);
  return header;
}

}  // namespace trephine
