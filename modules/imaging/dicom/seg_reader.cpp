#include "imaging/dicom/seg_reader.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <new>
#include <set>

#include "base/codes.h"
#include "base/memory.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/detail/text.h"
#include "imaging/common/workers.h"
#include "imaging/dicom/detail/dicom_file.h"
#include "imaging/dicom/detail/dicom_pixels.h"
#include "imaging/dicom/detail/dicom_stream.h"
#include "imaging/dicom/detail/dicom_values.h"
#include "imaging/dicom/detail/frame_stack.h"
#include "imaging/dicom/detail/seg_header.h"
#include "imaging/dicom/detail/transfer_syntax.h"

namespace trephine {

namespace {

namespace fs = std::filesystem;

constexpr double kHeaderShare = 0.3;  // of the progress

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
    if (Status enough = enoughMemory(double(voxels()) / 1048576.0, tr("The segmentation"), "");
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
                  tr("Reading the segmentation"));
      const Status read = frames.addTo(layers.slice(stack.slices[frame]), frame,
                                       stack.geometry.size[0], stack.shifts[frame]);
      if (!read) {
        if (progress.cancelled()) return cancelled();
        return unreadableSegmentation(
            tr("Frame {} cannot be read: {}", frame + 1, read.error().what));
      }
    }
    return layers.put(value);
  }

  // Of a label map: all segments of all frames, one layer.
  Result<std::vector<std::uint8_t>> labels() {
    std::vector<std::uint8_t> layer(stack.geometry.voxelCount());
    if (std::set(stack.slices.begin(), stack.slices.end()).size() < stack.slices.size()) {
      return unreadableSegmentation(tr("Two frames of the label map lie at one place"));
    }
    for (std::size_t frame = 0; frame < stack.slices.size(); ++frame) {
      if (progress.cancelled()) return cancelled();
      progress.at(kHeaderShare + (1.0 - kHeaderShare) * double(frame) / double(stack.slices.size()),
                  tr("Reading the segmentation"));
      std::uint8_t* slice = layer.data() + stack.geometry.indexOf(0, 0, stack.slices[frame]);
      const Status read =
          frames.addTo(slice, frame, stack.geometry.size[0], stack.shifts[frame]);
      if (!read) {
        if (progress.cancelled()) return cancelled();
        return unreadableSegmentation(
            tr("Frame {} cannot be read: {}", frame + 1, read.error().what));
      }
    }
    return layer;
  }

  static Error cancelled() {
    return Error{code::kCancelled, tr("Reading the segmentation was cancelled"), "", ""};
  }
};

Result<DicomSegmentation> read(const fs::path& file, double threshold, const Progress& progress) {
  if (!(threshold >= 0.0 && threshold <= 1.0)) {
    return Error{code::kBadThreshold,
                 tr("The threshold of a fractional segmentation is a share of 0 to 1"), "",
                 tr("Give one, such as 0.5")};
  }
  std::optional<Result<SegHeader>> read_header;
  PixelReader pixels(progress, kManyFrames);
  const Status done = forEachFile(
      1, progress, {0.0, kHeaderShare, tr("Reading the segmentation")}, [&](std::size_t) {
        read_header = readSegHeader(file, progress);
        const TransferSyntax* syntax =
            *read_header ? findTransferSyntax(read_header->value().pixels.transfer_syntax)
                         : nullptr;
        if (!syntax || syntax->codec != Codec::deflated) return;
        std::uint8_t first = 0;
        const Status inflated = pixels.read(read_header->value().pixels, 0, 1, &first);
        if (!inflated)
          read_header =
              unreadableSegmentation(tr("The frames cannot be read: {}", inflated.error().what));
      });
  if (!done) {
    return done.error().code == code::kCancelled ? Filling::cancelled() : done.error();
  }
  if (!*read_header) return read_header->error();
  const SegHeader& header = read_header->value();
  const Result<FrameStack> stack =
      stackFrames(header.planes, header.pixels.columns, header.pixels.rows, header.between_mm,
                  header.thickness_mm);
  if (!stack) return stack.error();
  // The mask, and a layer.
  const double grid_mb = double(stack->geometry.voxelCount()) / 1048576.0;
  if (Status enough = enoughMemory(2.0 * grid_mb, tr("The segmentation"), ""); !enough) {
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
      out.notes.push_back(trCount(frames.unnamed(),
                                  "Left out: {} voxel of segments that the file does not name.",
                                  "Left out: {} voxels of segments that the file does not name."));
    }
    out.format = "DICOM label map";
    out.named = std::ranges::any_of(out.segments, [](const auto& s) { return !s.name.empty(); });
    progress.at(1.0, tr("Done"));
    return result;
  }
  for (const SegHeader::Segment& segment : header.segments) {
    const int value = own_numbers ? segment.number : int(out.segments.size()) + 1;
    const auto layer = filling.segment(frames_of[segment.number], std::uint8_t(value));
    if (!layer) return layer.error();
    if (!*layer) {
      const std::string name =
          segment.name.empty() ? std::to_string(segment.number) : "\"" + segment.name + "\"";
      out.notes.push_back(tr("The segment {} has no voxel.", name));
    }
    out.segments.push_back({segment.name, segment.colour.value_or(labelColour(value)), "",
                            layer->value_or(0), std::uint8_t(value)});
    frames_of.erase(segment.number);
  }
  std::size_t unnamed = 0;
  for (const auto& [number, own] : frames_of) unnamed += own.size();
  if (unnamed > 0) {
    out.notes.push_back(trCount(unnamed,
                                "Left out: {} frame of segments that the file does not name.",
                                "Left out: {} frames of segments that the file does not name."));
  }
  out.named = std::ranges::any_of(out.segments, [](const auto& s) { return !s.name.empty(); });
  auto filled = layers.take();
  if (!filled) return filled.error();
  out.layers = std::move(filled).value();
  progress.at(1.0, tr("Done"));
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

namespace {

Error named(Error error, const fs::path& file) {
  if (error.where.empty()) error.where = cleanUtf8(file.filename().string());
  return error;
}

}  // namespace

Result<bool> isFractional(const fs::path& file, const Progress& progress) try {
  const Result<SegHeader> header = readSegHeader(file, progress);
  if (!header) return named(header.error(), file);
  return !header->binary && !header->label_map;
} catch (const std::bad_alloc&) {
  return named(outOfMemory(tr("for the segmentation"), ""), file);
}

Result<DicomSegmentation> readDicomSegmentation(const fs::path& file, double threshold,
                                                const Progress& progress) {
  try {
    Result<DicomSegmentation> result = read(file, threshold, progress);
    if (!result) return named(result.error(), file);
    return result;
  } catch (const std::bad_alloc&) {
    return named(outOfMemory(tr("for the segmentation"), ""), file);
  }
}

}  // namespace trephine
