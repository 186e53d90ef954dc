#include "training/recording_list.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

#include "base/child_process.h"
#include "base/codes.h"
#include "base/file.h"
#include "base/shared_folder.h"
#include "base/stretched_hash.h"
#include "base/tr.h"
#include "base/utf8.h"
#include "training/codes.h"
#include "training/paused_ticks.h"
#include "training/session_reader.h"
#include "volume/codes.h"

namespace trephine {

namespace {

constexpr double kLongest_s = 1e9;  // 30 years

ListedRecording headOf(const std::filesystem::path& file) {
  ListedRecording row;
  row.file = file;
  const Result<std::unique_ptr<SessionReader>> reader = SessionReader::open(file);
  if (!reader) {
    row.problem = reader.error();
    return row;
  }
  const RecordingHeader& header = (*reader)->header();
  const Json& exercise = header.exercise;
  row.exercise = cleanUtf8(exercise.value("name", ""));
  row.case_source = cleanUtf8(exercise.value("case", ""));
  row.volume_sha256 = header.volume_sha256;
  constexpr double kSlowest_hz = 1.0;  // no exercise is slower
  const double rate_hz = std::max(kSlowest_hz, exercise.value("rate_hz", 1000.0));
  const std::uint64_t ticks = (*reader)->tickCount();
  PausedTicks paused;
  if (const Result<std::vector<Event>> events = (*reader)->events()) {
    for (const Event& event : *events) paused.add(event);
  }
  const std::uint64_t done = ticks - std::min(ticks, paused.until(ticks));
  row.seconds = std::min(double(done) / rate_hz, kLongest_s);
  row.cut_short = !(*reader)->end();
  if (!row.cut_short && (*reader)->end()->dropped > 0) {
    row.problem = Error{code::kNotReplayable, tr("A part of the recording is missing"),
                        file.string(), tr("It can be kept, but not replayed")};
  }
  return row;
}

ListedRecording rowFrom(const Json& json, const std::filesystem::path& file) {
  JsonReader reader(json, "recordings");
  ListedRecording row;
  row.file = file;
  for (const char* known : {"schema", "build", "file"}) (void)reader.raw(known);
  row.exercise = reader.text("exercise");
  row.case_source = reader.text("case");
  row.volume_sha256 = reader.text("volume_sha256");
  row.seconds = reader.number("seconds", {0.0, kLongest_s, "s"});
  row.cut_short = reader.boolean("cut_short", false);
  if (reader.has("problem")) {
    JsonReader problem = reader.object("problem");
    (void)problem.raw("where");
    row.problem = Error{Code::named(problem.text("code")), problem.text("what"), file.string(),
                        problem.text("next")};
  }
  if (const Status read = reader.finish(); !read) row.problem = read.error();
  return row;
}

// What one child read before it ended or its time was up.
struct Pass {
  enum class End { timed_out, crashed, ended };
  std::vector<ListedRecording> rows;
  End end = End::ended;
};

Error cannotRun(const ReadApart& how) {
  return {code::kCannotRun, tr("The recordings cannot be listed"), how.program.filename().string(),
          tr("See that there is room for temporary files and memory, else install Trephine anew")};
}

// Files for one child: a command line holds no more than 2 MB.
constexpr std::size_t kFirstPass = 10, kMoreEachPass = 4, kMostInPass = 200;

Result<Pass> readPass(const std::vector<std::filesystem::path>& files, std::size_t first,
                      std::size_t most, const Progress& progress, const ReadApart& how) {
  const Result<std::filesystem::path> folder = temporaryFolder();
  const Result<std::string> unique = randomHex(8);
  if (!folder) return folder.error();
  if (!unique) return unique.error();
  ChildCommand command;
  command.words = {how.program.string(), "recordings", "--json", "--"};
  const std::size_t end = std::min(files.size(), first + most);
  for (std::size_t i = first; i < end; ++i) command.words.push_back(files[i].string());
  command.output = *folder / ("trephine-list-" + *unique);
  command.limit_s = how.patience_s;
  progress.at(double(first) / double(files.size()), tr("Looking at the recordings"));
  const Result<ChildRun> run = runChild(command, progress);
  Pass pass;
  std::ifstream lines(command.output);
  std::error_code ec;
  std::filesystem::remove(command.output, ec);
  if (!run) return run.error();
  constexpr int kNotRun = 100, kSignals = 128;  // by the loader, or by the command line
  if (run->exit_code >= kNotRun && run->exit_code < kSignals) return cannotRun(how);
  pass.end = run->timed_out               ? Pass::End::timed_out
             : run->exit_code >= kSignals ? Pass::End::crashed
                                          : Pass::End::ended;
  for (std::string line; first + pass.rows.size() < end && std::getline(lines, line);) {
    const Result<Json> json = parseJson(line, "recordings");
    if (!json) break;  // half a line
    pass.rows.push_back(rowFrom(*json, files[first + pass.rows.size()]));
  }
  return pass;
}

ListedRecording unread(const std::filesystem::path& file, Pass::End end) {
  ListedRecording row;
  row.file = file;
  std::error_code ec;
  row.written = std::filesystem::last_write_time(file, ec);
  switch (end) {
    case Pass::End::timed_out:
      row.problem = Error{code::kTakesTooLong, tr("The recording takes too long to read"),
                          file.string(), tr("Check its disk, then look again")};
      break;
    case Pass::End::crashed:
      row.problem = Error{code::kBadRecording, tr("The recording is damaged"), file.string(),
                          tr("It cannot be replayed")};
      break;
    case Pass::End::ended:
      row.problem =
          Error{code::kUnreadable, tr("The recording could not be read"), file.string(),
                tr("See that there is memory and room for temporary files, then look again")};
      break;
  }
  return row;
}

}  // namespace

ListedRecording listRecording(const std::filesystem::path& file) {
  try {
    return headOf(file);
  } catch (const Json::exception&) {  // a head that is no exercise
    ListedRecording row;
    row.file = file;
    row.problem = Error{code::kBadRecording, tr("The recording's head is damaged"), file.string(),
                        tr("It cannot be replayed")};
    return row;
  }
}

Json toJson(const ListedRecording& row) {
  Json json = {{"file", row.file.string()}, {"exercise", row.exercise},
               {"case", row.case_source},   {"volume_sha256", row.volume_sha256},
               {"seconds", row.seconds},    {"cut_short", row.cut_short}};
  if (const auto& problem = row.problem) {
    json["problem"] = {{"code", problem->code.str()},
                       {"what", cleanUtf8(problem->what)},
                       {"where", problem->where},
                       {"next", cleanUtf8(problem->next)}};
  }
  return json;
}

Result<std::vector<ListedRecording>> listFiles(const std::vector<std::filesystem::path>& files,
                                               const Progress& progress, const ReadApart& how) {
  std::vector<ListedRecording> rows;
  constexpr double kLeast_s = 0.5;
  constexpr int kMostEmpty = 3;  // of a reader that ends by itself without a word: it cannot work
  ReadApart now = how;
  int empty = 0;
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kTellEvery{100};
  std::optional<Clock::time_point> told;
  const auto tell = [&] {
    if (!how.read || (told && Clock::now() - *told < kTellEvery)) return;
    told = Clock::now();
    how.read(rows);
  };
  for (std::size_t most = kFirstPass; rows.size() < files.size();
       most = std::min(kMostInPass, most * kMoreEachPass)) {
    Result<Pass> pass = readPass(files, rows.size(), most, progress, now);
    if (!pass) return pass.error();
    for (ListedRecording& row : pass->rows) {
      std::error_code ec;
      row.written = std::filesystem::last_write_time(row.file, ec);
      rows.push_back(std::move(row));
    }
    if (!pass->rows.empty()) {
      empty = 0;
      tell();
      continue;
    }
    empty = pass->end == Pass::End::ended ? empty + 1 : 0;
    if (empty == kMostEmpty) return cannotRun(how);
    rows.push_back(unread(files[rows.size()], pass->end));
    tell();
    // A folder of many such files does not keep a person waiting for each.
    if (pass->end == Pass::End::timed_out) {
      now.patience_s = std::max(std::min(kLeast_s, how.patience_s), now.patience_s / 2.0);
    }
  }
  return rows;
}

Result<std::vector<ListedRecording>> listRecordings(const std::filesystem::path& folder,
                                                    const Progress& progress,
                                                    const ReadApart& how) {
  std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> found;
  const bool others_keep_theirs = isEachOnesOwn(folder);
  std::error_code ec;
  for (std::filesystem::directory_iterator it(folder, ec), end; !ec && it != end;
       it.increment(ec)) {
    if (it->path().extension() != ".h5") continue;
    // What another account of the machine keeps for itself is not this one's list.
    if (others_keep_theirs && ::access(it->path().c_str(), R_OK) != 0) continue;
    std::error_code none;
    found.emplace_back(std::filesystem::last_write_time(it->path(), none), it->path());
  }
  std::ranges::sort(found, std::greater());
  std::vector<std::filesystem::path> files;
  for (auto& [written, file] : found) files.push_back(std::move(file));
  return listFiles(files, progress, how);
}

}  // namespace trephine
