#include "training/recording_list.h"

#include <unistd.h>

#include <algorithm>

#include "base/shared_folder.h"
#include "training/paused_ticks.h"
#include "training/session_reader.h"

namespace trephine {

namespace {

ListedRecording headOf(const std::filesystem::path& file) {
  ListedRecording row;
  row.file = file;
  std::error_code ec;
  row.written = std::filesystem::last_write_time(file, ec);
  const Result<std::unique_ptr<SessionReader>> reader = SessionReader::open(file);
  if (!reader) {
    row.problem = reader.error();
    return row;
  }
  const RecordingHeader& header = (*reader)->header();
  const Json& scene = header.scene;
  row.exercise = scene.value("name", "");
  row.case_source = scene.value("case", "");
  row.volume_sha256 = header.volume_sha256;
  const double rate_hz = scene.value("rate_hz", 1000.0);
  const std::uint64_t ticks = (*reader)->tickCount();
  PausedTicks paused;
  if (const Result<std::vector<Event>> events = (*reader)->events()) {
    for (const Event& event : *events) paused.add(event);
  }
  const std::uint64_t done = ticks - std::min(ticks, paused.until(ticks));
  row.seconds = rate_hz > 0.0 ? double(done) / rate_hz : 0.0;
  row.cut_short = !(*reader)->end();
  if (!row.cut_short && (*reader)->end()->dropped > 0) {
    row.problem = Error{"NOT_REPLAYABLE", "A part of the recording is missing", file.string(),
                        "It can be kept, but not replayed"};
  }
  return row;
}

}  // namespace

ListedRecording listRecording(const std::filesystem::path& file) {
  try {
    return headOf(file);
  } catch (const Json::exception&) {  // a head that is no scene
    ListedRecording row;
    row.file = file;
    row.problem = Error{"BAD_RECORDING", "The recording's head is damaged", file.string(),
                        "It cannot be replayed"};
    return row;
  }
}

Result<std::vector<ListedRecording>> listRecordings(const std::filesystem::path& folder,
                                                    const Progress& progress) {
  std::vector<std::filesystem::path> files;
  const bool others_keep_theirs = isEachOnesOwn(folder);
  std::error_code ec;
  for (std::filesystem::directory_iterator it(folder, ec), end; !ec && it != end;
       it.increment(ec)) {
    if (it->path().extension() != ".h5") continue;
    // What another account of the machine keeps for itself is not this one's list.
    if (others_keep_theirs && ::access(it->path().c_str(), R_OK) != 0) continue;
    files.push_back(it->path());
  }
  std::vector<ListedRecording> rows;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (progress.cancelled()) return Error{"CANCELLED", "The list was not made", "", ""};
    progress.at(double(i) / double(files.size()), "Looking at the recordings");
    rows.push_back(listRecording(files[i]));
  }
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return a.written != b.written ? a.written > b.written : a.file > b.file;
  });
  return rows;
}

}  // namespace trephine
