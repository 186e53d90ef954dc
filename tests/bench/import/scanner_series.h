// CT series of which every voxel is known, in each way that scanners and archives store them:
// imaging's writer writes them, with a scanner's header and in another transfer syntax after that.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/result.h"
#include "exercise/names.h"
#include "lab/import/import_series.h"
#include "volume/volume.h"

namespace trephine::bench {

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
std::vector<std::string> seriesNames();

// Writes the volume, one file a slice, into the folder, which is made. HU must lie in -1024..3071,
// axes along the patient's. Errors: CANNOT_WRITE, CANCELLED.
Status writeSeries(const Volume& volume, SeriesSyntax syntax, const std::filesystem::path& folder,
                   const Progress& progress);

// `series` series of `slices` files each in one folder, int16, of small pictures (64 x 64): what a
// scan for headers is timed on. Errors as above.
Status writeManySeries(int series, int slices, const std::filesystem::path& folder,
                       const Progress& progress);

// All of these, of the CT of noisy_ct.h. A SeriesWriter.
Result<std::vector<KnownVolume>> writeScannerSeries(const ImportSeries& series,
                                                    const std::filesystem::path& folder,
                                                    const Progress& progress);

}  // namespace trephine::bench
