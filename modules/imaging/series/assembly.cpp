#include "imaging/series/detail/assembly.h"

#include <algorithm>
#include <mutex>
#include <new>

#include "base/codes.h"
#include "base/memory.h"
#include "base/tr.h"
#include "imaging/common/detail/source_watch.h"
#include "imaging/common/detail/text.h"
#include "imaging/common/workers.h"
#include "imaging/dicom/detail/dicom_pixels.h"
#include "imaging/series/detail/slice_mixing.h"

namespace trephine {

namespace {

// The parts of the job that read() and its caller show as one progress bar.
constexpr double kRead = 0.9;

class Assembler {
 public:
  Assembler(const Series& series, const SeriesPlan& plan, const Progress& progress,
            Assembly& assembly)
      : series_(series), plan_(plan), assembly_(assembly), reader_(progress) {
    const DicomHeader& first = series.slices[plan.sources.front()];
    source_ = {first.columns, first.rows};
    target_ = {assembly.volume.geometry.size[0], assembly.volume.geometry.size[1]};
    source_voxels_ = std::size_t(source_.columns) * std::size_t(source_.rows);
    target_voxels_ = std::size_t(target_.columns) * std::size_t(target_.rows);
    // Debris in uncompressed words is masked, as the standard has it; a compressor was given
    // values.
    bits_are_values_ = std::ranges::all_of(series.slices, [](const DicomHeader& slice) {
      return slice.pixels && slice.pixels->encapsulated && !slice.overlay_bits;
    });
  }

  // A slice of the volume for each source: in place, or shifted on the way.
  Status readOneToOne(const Progress& progress) {
    const bool sheared = plan_.stack.sheared();
    return forEachFile(plan_.sources.size(), progress, {0.0, kRead, tr("Reading slices")},
                       [&](std::size_t n) {
                         std::int16_t* target = assembly_.volume.hu.data() + n * target_voxels_;
                         if (!sheared) {
                           read(n, target, kAirHu);
                           return;
                         }
                         thread_local std::vector<std::int16_t> words;
                         words.resize(source_voxels_);
                         read(n, words.data(), kLostHu);
                         shiftSlice(words.data(), source_, plan_.stack.shifts[n], target, target_);
                       });
  }

  // All sources first, then slices that mix two of them.
  Status readAndMix(const Progress& progress) {
    std::vector<std::int16_t> stack;
    try {
      stack.resize(plan_.sources.size() * source_voxels_);
    } catch (const std::bad_alloc&) {
      return Error{code::kOutOfMemory, tr("There is not enough memory to interpolate the slices"),
                   "", tr("Close other programs and try again")};
    }
    const auto source = [&](std::size_t n) { return stack.data() + n * source_voxels_; };
    if (const Status status =
            forEachFile(plan_.sources.size(), progress, {0.0, 0.7 * kRead, tr("Reading slices")},
                        [&](std::size_t n) { read(n, source(n), kLostHu); });
        !status) {
      return status;
    }
    return forEachFile(plan_.stack.slices.size(), progress, {0.7 * kRead, kRead, "Interpolating"},
                       [&](std::size_t k) {
                         const SliceMixture& mixture = plan_.stack.slices[k];
                         std::int16_t* target = assembly_.volume.hu.data() + k * target_voxels_;
                         const auto shifted = [&](std::size_t n, std::int16_t* to) {
                           shiftSlice(source(n), source_, plan_.stack.shifts[n], to, target_);
                         };
                         shifted(mixture.lower, target);
                         if (mixture.lower == mixture.upper) return;
                         thread_local std::vector<std::int16_t> upper;
                         upper.resize(target_voxels_);
                         shifted(mixture.upper, upper.data());
                         mixSlices(target, upper.data(), mixture.upper_share, target_voxels_,
                                   target);
                       });
  }

  bool sourceVanished() const { return watch_.vanished(); }

  // Interpolation is done: what was not scanned becomes air, and the range is taken anew.
  void finish() {
    HuCounts& counts = assembly_.counts;
    counts.hu_min = 32767;
    counts.hu_max = -32768;
    for (std::int16_t& hu : assembly_.volume.hu) {
      if (hu == kLostHu) hu = kAirHu;
      counts.hu_min = std::min<int>(counts.hu_min, hu);
      counts.hu_max = std::max<int>(counts.hu_max, hu);
    }
  }

 private:
  void read(std::size_t n, std::int16_t* words, std::int16_t padding_hu) {
    thread_local HuConverter converter;
    thread_local std::vector<std::int16_t> sample;
    sample.clear();
    const std::size_t slice = plan_.sources[n];
    const DicomHeader& header = series_.slices[slice];
    const std::size_t number = watch_.begin();
    const Status read = reader_.read(header, words);
    watch_.end(number, header.file, header.file_bytes, read.ok());
    HuCounts counts;
    const bool odd =
        read && bits_are_values_ && hasHighBits({words, source_voxels_}, header.format);
    StoredFormat format = header.format;
    if (plan_.whole_words && bits_are_values_ && header.bits_allocated == 16) {
      format.bits_stored = 16;
      format.high_bit = 15;
    }
    if (read) counts = converter.convert(words, source_voxels_, format, padding_hu, &sample);
    const std::lock_guard lock(mutex_);
    assembly_.counts.add(counts);
    assembly_.look.add(sample);
    assembly_.high_bits |= odd;
    if (!read) assembly_.unreadable.push_back({slice, read.error().what});
  }

  const Series& series_;
  const SeriesPlan& plan_;
  Assembly& assembly_;
  SliceSize source_, target_;
  std::size_t source_voxels_ = 0, target_voxels_ = 0;
  bool bits_are_values_ = false;  // those above the stored ones, if there are any
  PixelReader reader_;
  SourceWatch watch_;
  std::mutex mutex_;
};

}  // namespace

Result<Assembly> assemble(const Series& series, const SeriesPlan& plan, const Progress& progress) {
  Assembly assembly;
  assembly.volume.geometry = plan.stack.geometry;
  try {
    assembly.volume.hu.resize(assembly.volume.geometry.voxelCount());
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("for the volume"), "");
  }
  Assembler assembler(series, plan, progress, assembly);
  const bool mixed = !plan.stack.oneToOne();
  const Status status = mixed ? assembler.readAndMix(progress) : assembler.readOneToOne(progress);
  if (!status) return status.error();
  assembly.vanished = !assembly.unreadable.empty() && assembler.sourceVanished();
  if (mixed || plan.stack.sheared()) assembler.finish();
  return assembly;
}

}  // namespace trephine
