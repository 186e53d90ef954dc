// CT series of which every voxel is known, in each way that scanners and archives store them: what
// the import is measured and tested on.
#pragma once

#include <filesystem>
#include <string>

#include "base/progress.h"
#include "base/result.h"
#include "scene/names.h"
#include "volume/volume.h"

namespace trephine {

// int16: explicit little endian, HU as signed 16 bit words, slope 1, intercept 0. All others hold
// unsigned words of 12 bits in 16, intercept -1024, as most scanners do: u12 in explicit little
// endian, the rest as their names say (jpegls and j2k lossless, jpegll process 14 with selection
// value 1).
enum class SeriesSyntax { int16, u12, big_endian, deflated, rle, jpegls, jpegll, j2k };
constexpr Names<SeriesSyntax, 8> kSeriesSyntaxes{{{"int16", SeriesSyntax::int16},
                                                  {"u12", SeriesSyntax::u12},
                                                  {"big-endian", SeriesSyntax::big_endian},
                                                  {"deflated", SeriesSyntax::deflated},
                                                  {"rle", SeriesSyntax::rle},
                                                  {"jpegls", SeriesSyntax::jpegls},
                                                  {"jpegll", SeriesSyntax::jpegll},
                                                  {"j2k", SeriesSyntax::j2k}}};

// The part of a whole job's progress that one step of it fills.
struct ProgressShare {
  const Progress& progress;
  double from = 0.0, to = 1.0;
};

// BAD_ARGUMENT unless edges are of 2 to 2048 voxels, and all are at most 2^28.
Status checkSeriesSize(const Index3& size);

// The head of the cranium phantom, 230 x 230 x 180 mm, with the noise of a CT: standard deviation
// 15 HU, neighbours within a slice correlated by 0.44 (a head CT with a bone kernel: 13 HU, 0.25 to
// 0.53). All of it comes from formulas in whole numbers, so the bits are the same everywhere.
// HU -1024 to 3071. Errors: BAD_ARGUMENT (checkSeriesSize), CANCELLED, OUT_OF_MEMORY.
Result<Volume> makeNoisyCt(const Index3& size, const ProgressShare& share);

// Writes the volume, one file a slice, into the folder, which is made. A header is as long as a
// scanner's: about 110 elements with private ones and sequences. HU must lie in -1024..3071 but for
// int16. Errors: CANNOT_WRITE, CANCELLED.
Status writeSeries(const Volume& volume, SeriesSyntax syntax, const std::filesystem::path& folder,
                   const ProgressShare& share);

// `series` series of `slices` files each in one folder, int16, of small pictures (64 x 64): what a
// scan for headers is timed on. Errors as above.
Status writeManySeries(int series, int slices, const std::filesystem::path& folder,
                       const ProgressShare& share);

}  // namespace trephine
