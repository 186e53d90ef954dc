#include "imaging/dicom/seg_reader.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmfg/fgpixmsr.h>
#include <dcmtk/dcmfg/fgplanor.h>
#include <dcmtk/dcmfg/fgplanpo.h>
#include <dcmtk/dcmfg/fgseg.h>
#include <dcmtk/dcmseg/segdoc.h>
#include <dcmtk/dcmseg/segment.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <set>

#include "base/memory.h"
#include "imaging/common/cielab.h"
#include "imaging/common/text.h"
#include "imaging/common/workers.h"
#include "imaging/dicom/dicom_file.h"
#include "imaging/dicom/dicom_pixels.h"
#include "imaging/dicom/dicom_stream.h"
#include "imaging/dicom/dicom_values.h"
#include "imaging/dicom/frame_stack.h"
#include "imaging/dicom/transfer_syntax.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr const char* kLabelMapStorage = "1.2.840.10008.5.1.4.1.1.66.7";  // newer than DCMTK 3.6.7
constexpr int kMostFrames = 1000000;
constexpr double kHeaderShare = 0.3;  // of the progress

// DCMTK's own reading of the pixels loses bits where rows x columns is no multiple of eight, and
// keeps them twice; all else of it serves.
class FramesWithoutPixels : public DcmSegmentation {
 public:
  using DcmSegmentation::readWithoutPixelData;
};

// What the header says, as plain values.
struct SegHeader {
  struct Segment {
    int number = 0;
    std::string name;
    std::optional<Vec3> colour;
  };
  std::string study, frame_of_reference;
  std::vector<std::string> series;  // UIDs, each once
  bool binary = true;
  bool label_map = false;  // pixels are segments' numbers; frames are of no segment
  int most = 255;  // the value of a fractional one that stands for 1
  DicomHeader pixels;
  std::vector<Segment> segments;
  std::vector<FramePlane> planes;  // of each frame
  std::vector<int> of;             // the number of each frame's segment
  std::optional<double> between_mm, thickness_mm;
  std::vector<std::string> notes;
};

Error unreadable(const std::string& what) {
  return Error{"UNREADABLE", what, "", "Copy or export the file anew"};
}

Error wrongSize(const std::string& what) {
  return Error{"SIZE_MISMATCH", what, "", "Copy or export the file anew"};
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
  if (items.empty()) return unreadable("The file names no segment");
  if (items.size() > std::size_t(kMostStructures)) {
    return Error{"TOO_MANY_STRUCTURES",
                 "The file holds " + std::to_string(items.size()) + " segments, more than " +
                     std::to_string(kMostStructures),
                 "", "Export those that the exercise needs"};
  }
  std::set<int> numbers;
  for (std::size_t n = 0; n < items.size(); ++n) {
    const DicomItem item(items[n]);
    SegHeader::Segment segment;
    segment.number = countOr(item, DCM_SegmentNumber, 0, 65535);
    if (segment.number == 0 || !numbers.insert(segment.number).second) {
      return unreadable("The segments' numbers are missing or stand twice");
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
    return wrongSize("The file says of " +
                     std::to_string(segmentation.getFunctionalGroups().getNumberOfFrames()) +
                     " frames where they lie, and claims " + std::to_string(frames));
  }
  for (std::size_t n = 0; n < frames; ++n) {
    const std::string frame = "Frame " + std::to_string(n + 1);
    FramePlane plane;
    auto* const position =
        groupOf<FGPlanePosPatient>(segmentation, n, DcmFGTypes::EFG_PLANEPOSPATIENT);
    Vec3& p = plane.position_mm;
    if (!position || position->getImagePositionPatient(p.x, p.y, p.z).bad()) {
      return noGeometry(frame + " does not say where it lies");
    }
    auto* const turned =
        groupOf<FGPlaneOrientationPatient>(segmentation, n, DcmFGTypes::EFG_PLANEORIENTPATIENT);
    auto& o = plane.orientation;
    if (!turned || turned->getImageOrientationPatient(o[0], o[1], o[2], o[3], o[4], o[5]).bad()) {
      return noGeometry(frame + " does not say how it is turned");
    }
    auto* const measures = groupOf<FGPixelMeasures>(segmentation, n, DcmFGTypes::EFG_PIXELMEASURES);
    auto& spacing = plane.pixel_spacing_mm;
    if (!measures || measures->getPixelSpacing(spacing[0], 0).bad() ||
        measures->getPixelSpacing(spacing[1], 1).bad()) {
      return noGeometry(frame + " does not say how large its pixels are");
    }
    double length = 0.0;
    if (n == 0 && measures->getSpacingBetweenSlices(length).good()) header.between_mm = length;
    if (n == 0 && measures->getSliceThickness(length).good()) header.thickness_mm = length;
    header.planes.push_back(plane);
    if (header.label_map) continue;
    auto* const segment = groupOf<FGSegmentation>(segmentation, n, DcmFGTypes::EFG_SEGMENTATION);
    Uint16 number = 0;
    if (!segment || segment->getReferencedSegmentNumber(number).bad()) {
      return unreadable(frame + " does not say of which segment it is");
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
    return Error{"UNSUPPORTED_TRANSFER_SYNTAX",
                 "The segmentation is stored as " + transferSyntaxName(pixels.transfer_syntax) +
                     " (" + pixels.transfer_syntax + "), which is not read",
                 "", "Export it without compression"};
  }
  if (syntax->loss == Loss::always) {
    header.notes.push_back("The segmentation was compressed with loss: borders may be off.");
  }
  if (pixels.frames > kMostFrames) {
    return Error{"TOO_LARGE", "The file claims more than a million frames", "",
                 "Copy or export the file anew"};
  }
  if (pixels.frames == 0) {
    return Error{"NO_FRAMES", "The file holds no frame", "", "Export a segmentation with voxels"};
  }
  if (pixels.rows == 0 || pixels.columns == 0) {
    return wrongSize("The frames have no rows or no columns");
  }
  if (pixels.pixelCount() > kLargestSlice) {
    return Error{"TOO_LARGE", "A frame has more than 8192 x 8192 pixels", "",
                 "Export it at a lower resolution"};
  }
  const int bits = header.binary                                          ? 1
                   : header.label_map && pixels.bits_allocated == 16 ? 16
                                                                          : 8;
  if (pixels.samples != 1 || pixels.bits_allocated != bits) {
    return wrongSize("The frames do not have " + std::string(header.binary ? "one bit" : "a byte") +
                     " for each pixel");
  }
  if (!pixels.pixels) {
    return Error{"NO_FRAMES", "The file holds no pixels", "", "Export a segmentation with voxels"};
  }
  if (cut) return unreadable("The file is cut short: its frames are not all there");
  const PixelPlace& place = *pixels.pixels;
  if (place.encapsulated != encapsulated) {
    return wrongSize("The frames are not stored as the file's transfer syntax says");
  }
  const std::uint64_t all = pixels.pixelCount() * std::uint64_t(pixels.frames) * unsigned(bits);
  const std::uint64_t needed = (all + 7) / 8;
  if (encapsulated ? place.frames.size() != std::size_t(pixels.frames) : place.bytes < needed) {
    return wrongSize("The file holds fewer frames than it claims");
  }
  // Deflate shrinks to a thousandth at most.
  if (syntax->codec == Codec::deflated && needed / 1032 > pixels.file_bytes) {
    return wrongSize("The file is too small for the frames that it claims");
  }
  if (syntax->codec == Codec::deflated) {
    return enoughMemory(double(needed) / 1048576.0, "The segmentation", "");
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
    const bool read =
        segments->getItem(n)->findAndGetUint16(DCM_SegmentNumber, number).good();
    if (read && number == 0) delete segments->remove(n);
  }
}

// On a worker's thread.
Result<SegHeader> readHeader(const fs::path& file, const Progress& progress) {
  setUpDcmtk();
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  const std::shared_lock rule(unknownRule());
  DicomStream stream(file, kManyFrames, &progress);
  if (error || stream.beginning(1).empty()) {
    return unreadable("The file is not there, is empty or may not be read");
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
    return Error{"NOT_SEGMENTATION", "The file is no DICOM segmentation", "",
                 "Choose a file of modality SEG"};
  }
  if (!whole) return unreadable("The file is cut short or damaged");

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
    return Error{"UNSUPPORTED_SEGMENTATION",
                 header.label_map ? "The label map segmentation does not say that it is one"
                                  : "The segmentation is neither binary nor fractional",
                 "", "Export it as a binary segmentation"};
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
          "The file does not say which value stands for a whole voxel: 255 was taken.");
    }
  }

  // DCMTK reads no frame's group where nothing is shared.
  DcmItem* shared = nullptr;
  dicom.getDataset()->findOrCreateSequenceItem(DCM_SharedFunctionalGroupsSequence, shared, 0);
  if (header.label_map) readAsBinary(*dicom.getDataset());
  FramesWithoutPixels segmentation;
  if (segmentation.readWithoutPixelData(*dicom.getDataset()).bad()) {
    return unreadable("The file's header cannot be understood");
  }
  const DicomItem all(dicom.getDataset());
  if (const Status read = readSegments(all, segmentation, header); !read) return read.error();
  if (const Status read = readFrames(segmentation, header); !read) return read.error();
  readReferences(segmentation, header);
  header.study = uidText(all, DCM_StudyInstanceUID);
  header.frame_of_reference = uidText(all, DCM_FrameOfReferenceUID);
  return header;
}

// Layers of labels that a segment after the other is put into.
class Layers {
 public:
  explicit Layers(const GridGeometry& geometry) : geometry_(geometry), mask_(voxels()) {}

  // The mask of a slice of the segment at hand; cleared by put().
  std::uint8_t* slice(int k) {
    used_.insert(k);
    return mask_.data() + geometry_.indexOf(0, 0, k);
  }

  // Puts the mask into the first layer where none of its voxels is taken. Which one that was;
  // nothing of an empty mask.
  Result<std::optional<std::size_t>> put(std::uint8_t value) {
    const std::size_t count = sliceVoxels();
    const auto any = [&](const auto& isTaken) {
      return std::ranges::any_of(used_, [&](int k) {
        const std::size_t from = geometry_.indexOf(0, 0, k);
        for (std::size_t n = from; n < from + count; ++n) {
          if (mask_[n] && isTaken(n)) return true;
        }
        return false;
      });
    };
    std::optional<std::size_t> layer;
    if (any([](std::size_t) { return true; })) {
      layer = 0;
      while (*layer < layers_.size() &&
             any([&](std::size_t n) { return layers_[*layer][n] != 0; })) {
        ++*layer;
      }
      if (*layer == layers_.size()) {
        if (const Status enough = addLayer(); !enough) return enough.error();
      }
    }
    for (const int k : used_) {
      const std::size_t from = geometry_.indexOf(0, 0, k);
      for (std::size_t n = from; n < from + count; ++n) {
        if (mask_[n]) layers_[*layer][n] = value;
        mask_[n] = 0;
      }
    }
    used_.clear();
    return layer;
  }

  // One at least.
  Result<std::vector<std::vector<std::uint8_t>>> take() {
    if (layers_.empty()) {
      if (const Status enough = addLayer(); !enough) return enough.error();
    }
    return std::move(layers_);
  }

 private:
  std::size_t voxels() const { return geometry_.voxelCount(); }
  std::size_t sliceVoxels() const {
    return std::size_t(geometry_.size[0]) * std::size_t(geometry_.size[1]);
  }
  Status addLayer() {
    if (Status enough = enoughMemory(double(voxels()) / 1048576.0, "The segmentation", "");
        !enough) {
      return enough;
    }
    layers_.emplace_back(voxels());
    return {};
  }

  const GridGeometry& geometry_;
  std::vector<std::uint8_t> mask_;
  std::set<int> used_;
  std::vector<std::vector<std::uint8_t>> layers_;
};

// Reads one frame after the other into masks.
class FrameReader {
 public:
  FrameReader(const SegHeader& header, double threshold, PixelReader& pixels)
      : header_(header),
        least_(std::max(1, int(std::ceil(threshold * header.most - 1e-9)))),
        pixels_(pixels),
        words_(header.binary ? 0 : header.pixels.pixelCount()) {}

  // Adds the frame's voxels to a slice of so many columns, from this column and row of it on.
  Status addTo(std::uint8_t* slice, std::size_t frame, int slice_columns,
               const std::array<int, 2>& at) {
    const int columns = header_.pixels.columns;
    if (slice_columns == columns && at[0] == 0 && at[1] == 0) return add(slice, frame);
    own_.assign(header_.pixels.pixelCount(), 0);
    if (Status read = add(own_.data(), frame); !read) return read;
    for (int row = 0; row < header_.pixels.rows; ++row) {
      std::uint8_t* to = slice + std::ptrdiff_t(row + at[1]) * slice_columns + at[0];
      const std::uint8_t* from = own_.data() + std::ptrdiff_t(row) * columns;
      for (int column = 0; column < columns; ++column) {
        if (from[column]) to[column] = from[column];
      }
    }
    return {};
  }

  // Of a label map: by a segment's number in the file, its value here; and how many voxels had a
  // number that has none.
  void setValues(const std::map<int, std::uint8_t>& values) {
    values_.assign(65536, 0);
    for (const auto& [number, value] : values) values_[std::size_t(number)] = value;
  }
  std::size_t unnamed() const { return unnamed_; }

 private:
  Status add(std::uint8_t* mask, std::size_t frame) {
    return header_.label_map ? addLabels(mask, frame)
           : header_.binary  ? addBits(mask, frame)
                             : addValues(mask, frame);
  }

  Status addLabels(std::uint8_t* mask, std::size_t frame) {
    DicomHeader header = header_.pixels;
    header.frame = int(frame);
    if (Status read = pixels_.read(header, words_.data()); !read) return read;
    for (std::size_t n = 0; n < words_.size(); ++n) {
      const auto number = std::uint16_t(words_[n]);
      mask[n] = values_[number];
      unnamed_ += number != 0 && mask[n] == 0;
    }
    return {};
  }

  // Bits are packed without a gap between frames, the lowest of a byte first (PS3.5 8.1.1, D).
  Status addBits(std::uint8_t* mask, std::size_t frame) {
    const std::uint64_t count = header_.pixels.pixelCount(), first = count * frame;
    // Of words in big-endian order, whole ones.
    const bool swapped = header_.pixels.swapped_pairs;
    std::uint64_t from = first / 8, end = (first + count + 7) / 8;
    if (swapped) {
      from &= ~std::uint64_t(1);
      end = (end + 1) & ~std::uint64_t(1);
    }
    bytes_.resize(end - from);
    if (Status read = pixels_.read(header_.pixels, from, end - from, bytes_.data()); !read) {
      return read;
    }
    std::uint64_t bit = first - from * 8;
    for (std::uint64_t n = 0; n < count; ++n, ++bit) {
      const std::uint64_t byte = swapped ? (bit / 8) ^ 1 : bit / 8;
      if (bytes_[byte] >> (bit % 8) & 1) mask[n] = 1;
    }
    return {};
  }

  Status addValues(std::uint8_t* mask, std::size_t frame) {
    DicomHeader header = header_.pixels;
    header.frame = int(frame);
    if (Status read = pixels_.read(header, words_.data()); !read) return read;
    for (std::size_t n = 0; n < words_.size(); ++n) {
      if (words_[n] >= least_) mask[n] = 1;
    }
    return {};
  }

  const SegHeader& header_;
  const int least_;
  PixelReader& pixels_;
  std::vector<std::uint8_t> bytes_, own_, values_;
  std::vector<std::int16_t> words_;
  std::size_t unnamed_ = 0;
};

// A segment's voxels of all its frames, put into a layer.
struct Filling {
  const SegHeader& header;
  const FrameStack& stack;
  FrameReader& frames;
  Layers& layers;
  const Progress& progress;
  std::size_t done = 0;  // frames

  Result<std::optional<std::size_t>> segment(const std::vector<std::size_t>& own,
                                             std::uint8_t value) {
    for (const std::size_t frame : own) {
      if (progress.cancelled()) return cancelled();
      progress.at(kHeaderShare + (1.0 - kHeaderShare) * double(done++) / double(header.of.size()),
                  "Reading the segmentation");
      const Status read = frames.addTo(layers.slice(stack.slices[frame]), frame,
                                       stack.geometry.size[0], stack.shifts[frame]);
      if (!read) {
        if (progress.cancelled()) return cancelled();
        return unreadable("Frame " + std::to_string(frame + 1) +
                          " cannot be read: " + read.error().what);
      }
    }
    return layers.put(value);
  }

  // Of a label map: all segments of all frames, one layer.
  Result<std::vector<std::uint8_t>> labels() {
    std::vector<std::uint8_t> layer(stack.geometry.voxelCount());
    for (std::size_t frame = 0; frame < stack.slices.size(); ++frame) {
      if (progress.cancelled()) return cancelled();
      progress.at(kHeaderShare + (1.0 - kHeaderShare) * double(frame) / double(stack.slices.size()),
                  "Reading the segmentation");
      std::uint8_t* slice = layer.data() + stack.geometry.indexOf(0, 0, stack.slices[frame]);
      const Status read =
          frames.addTo(slice, frame, stack.geometry.size[0], stack.shifts[frame]);
      if (!read) {
        if (progress.cancelled()) return cancelled();
        return unreadable("Frame " + std::to_string(frame + 1) +
                          " cannot be read: " + read.error().what);
      }
    }
    return layer;
  }

  static Error cancelled() {
    return Error{"CANCELLED", "Reading the segmentation was cancelled", "", ""};
  }
};

Result<DicomSegmentation> read(const fs::path& file, double threshold, const Progress& progress) {
  if (!(threshold >= 0.0 && threshold <= 1.0)) {
    return Error{"BAD_THRESHOLD", "The threshold of a fractional segmentation is a share of 0 to 1",
                 "", "Give one, such as 0.5"};
  }
  std::optional<Result<SegHeader>> read_header;
  PixelReader pixels(progress, kManyFrames);
  const Status done =
      forEachFile(1, progress, {0.0, kHeaderShare, "Reading the segmentation"}, [&](std::size_t) {
        read_header = readHeader(file, progress);
        const TransferSyntax* syntax =
            *read_header ? findTransferSyntax(read_header->value().pixels.transfer_syntax)
                         : nullptr;
        if (!syntax || syntax->codec != Codec::deflated) return;
        std::uint8_t first = 0;
        const Status inflated = pixels.read(read_header->value().pixels, 0, 1, &first);
        if (!inflated)
          read_header = unreadable("The frames cannot be read: " + inflated.error().what);
      });
  if (!done) {
    return done.error().code == "CANCELLED" ? Filling::cancelled() : done.error();
  }
  if (!*read_header) return read_header->error();
  const SegHeader& header = read_header->value();
  const Result<FrameStack> stack =
      stackFrames(header.planes, header.pixels.columns, header.pixels.rows, header.between_mm,
                  header.thickness_mm);
  if (!stack) return stack.error();
  // The mask, and a layer.
  const double grid_mb = double(stack->geometry.voxelCount()) / 1048576.0;
  if (Status enough = enoughMemory(2.0 * grid_mb, "The segmentation", ""); !enough) {
    return enough.error();
  }

  DicomSegmentation result;
  Segmentation& out = result.segmentation;
  out.format = "DICOM SEG";
  out.geometry = stack->geometry;
  out.notes = header.notes;
  out.notes.insert(out.notes.end(), stack->notes.begin(), stack->notes.end());
  result.of = {hashOrNone(header.study),
               header.series.size() == 1 ? seriesHash(header.series.front()) : "",
               hashOrNone(header.frame_of_reference)};
  result.fractional = !header.binary && !header.label_map;
  for (const std::string& uid : header.series) result.series.push_back(seriesHash(uid));

  std::map<int, std::vector<std::size_t>> frames_of;
  for (std::size_t n = 0; n < header.of.size(); ++n) frames_of[header.of[n]].push_back(n);
  const bool own_numbers = std::ranges::all_of(
      header.segments, [](const auto& segment) { return segment.number <= kMostStructures; });
  Layers layers(out.geometry);
  FrameReader frames(header, threshold, pixels);
  Filling filling{header, *stack, frames, layers, progress};
  if (header.label_map) {
    std::map<int, std::uint8_t> values;
    for (const SegHeader::Segment& segment : header.segments) {
      const int value = own_numbers ? segment.number : int(out.segments.size()) + 1;
      values[segment.number] = std::uint8_t(value);
      out.segments.push_back({segment.name, segment.colour.value_or(labelColour(value)), "", 0,
                              std::uint8_t(value)});
    }
    frames.setValues(values);
    Result<std::vector<std::uint8_t>> layer = filling.labels();
    if (!layer) return layer.error();
    out.layers.push_back(*std::move(layer));
    if (frames.unnamed() > 0) {
      out.notes.push_back("Left out: " + counted(frames.unnamed(), "voxel") +
                          " of segments that the file does not name.");
    }
    out.format = "DICOM label map";
    out.named = std::ranges::any_of(out.segments, [](const auto& s) { return !s.name.empty(); });
    progress.at(1.0, "Done");
    return result;
  }
  for (const SegHeader::Segment& segment : header.segments) {
    const int value = own_numbers ? segment.number : int(out.segments.size()) + 1;
    const auto layer = filling.segment(frames_of[segment.number], std::uint8_t(value));
    if (!layer) return layer.error();
    if (!*layer) {
      const std::string name =
          segment.name.empty() ? std::to_string(segment.number) : "\"" + segment.name + "\"";
      out.notes.push_back("The segment " + name + " has no voxel.");
    }
    out.segments.push_back({segment.name, segment.colour.value_or(labelColour(value)), "",
                            layer->value_or(0), std::uint8_t(value)});
    frames_of.erase(segment.number);
  }
  std::size_t unnamed = 0;
  for (const auto& [number, own] : frames_of) unnamed += own.size();
  if (unnamed > 0) {
    out.notes.push_back("Left out: " + counted(unnamed, "frame") +
                        " of segments that the file does not name.");
  }
  out.named = std::ranges::any_of(out.segments, [](const auto& s) { return !s.name.empty(); });
  auto filled = layers.take();
  if (!filled) return filled.error();
  out.layers = std::move(filled).value();
  progress.at(1.0, "Done");
  return result;
}

}  // namespace

std::string dicomKind(const fs::path& file, const Progress& progress) {
  setUpDcmtk();
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return "";
  try {
    const std::shared_lock rule(unknownRule());
    DicomStream stream(file, kManyFrames, &progress);
    const std::string_view head = stream.beginning(132);
    if (head.size() < 132 || !looksLikeDicom(head)) return "";
    DcmFileFormat dicom;
    dicom.transferInit();
    // What it is stands at the beginning, or in the file meta header alone.
    static_cast<void>(
        dicom.readUntilTag(stream, EXS_Unknown, EGL_noChange, kLongestValue, DCM_SOPInstanceUID));
    const DicomItem meta(dicom.getMetaInfo()), data(dicom.getDataset());
    const std::string uid = uidText(data, DCM_SOPClassUID);
    const std::string meta_uid = uidText(meta, DCM_MediaStorageSOPClassUID);
    return uid.empty() || (!isSegmentation(uid) && isSegmentation(meta_uid)) ? meta_uid : uid;
  } catch (const std::bad_alloc&) {
    return "";
  }
}

bool isSegmentation(const std::string& sop_class) {
  return sop_class == UID_SegmentationStorage || sop_class == kLabelMapStorage;
}

Result<DicomSegmentation> readDicomSegmentation(const fs::path& file, double threshold,
                                                const Progress& progress) {
  const auto named = [&](Error error) {
    if (error.where.empty()) error.where = cleanUtf8(file.filename().string());
    return error;
  };
  try {
    Result<DicomSegmentation> result = read(file, threshold, progress);
    if (!result) return named(result.error());
    return result;
  } catch (const std::bad_alloc&) {
    return named(outOfMemory("for the segmentation", ""));
  }
}

}  // namespace trephine
