// A volume file (NIfTI, MetaImage, NRRD, raw) as a series with a report card.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/progress.h"
#include "base/result.h"
#include "imaging/common/detail/hu_sanity_check.h"
#include "imaging/common/detail/stored_values.h"
#include "imaging/report/report.h"
#include "volume/volume_files.h"

namespace trephine {

// Reads the header only. `name` is the file's path below the folder that was opened; it becomes
// uid and description. A file that cannot be read is a refused series, by the reader's own code.
// Asks FORMS_DIFFER where a NIfTI contradicts itself (volume_files.h).
SeriesReport assessFile(const std::filesystem::path& file, const std::string& name,
                        const Answers& answers = {});

// Reads the voxels, looks at them and adds what they tell to `report`. Errors: the reader's.
Result<Volume> readFileSeries(const std::filesystem::path& file, const Answers& answers,
                              const Progress& progress, SeriesReport& report, HuSanityCheck& look);

// One slice, for a preview: the whole file is read. Errors: NO_SUCH_SLICE, the reader's.
Result<SlicePicture> fileSlice(const std::filesystem::path& file, int index,
                               const Progress& progress);

}  // namespace trephine
