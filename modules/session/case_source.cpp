#include "session/case_source.h"

#include <filesystem>
#include <string_view>

#include "imaging/importer.h"
#include "volume/phantom.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

constexpr std::string_view kPhantom = "phantom:";

}  // namespace

bool isPhantom(const std::string& source) { return source.starts_with(kPhantom); }

Result<Volume> openCase(const std::string& source, const Progress& progress) {
  if (source.empty()) {
    return Error{"NO_CASE", "The scene names no case and none was given", "--case",
                 "Give a folder of CT, or phantom:cranium or phantom:abdomen"};
  }
  if (isPhantom(source)) return makePhantom(source.substr(kPhantom.size()), progress);
  std::error_code ec;
  if (isVolumeFile(source) && !std::filesystem::is_directory(source, ec)) {
    return readVolume(source, progress);
  }

  Result<CtFolder> folder = CtFolder::scan(source, progress);
  if (!folder) return folder.error();
  const std::optional<std::string> series = folder->bestSeries();
  if (!series) {
    if (folder->report().error) return *folder->report().error;
    return Error{"ALL_REFUSED", "No series in the folder can be used", source,
                 "The import report says why for each"};
  }
  return folder->read(*series, {}, progress);
}

}  // namespace trephine
