#include "training/session_reader.h"

#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "base/codes.h"
#include "base/memory.h"
#include "base/tr.h"
#include "base/utf8.h"
#include "training/codes.h"
#include "training/own_dataset.h"
#include "training/recording_layout.h"

namespace trephine {

namespace {

// Beside a writer, what is half written has a wrong checksum for a moment. HDF5 then waits 1 ns and
// reads again, the next time twice as long: 16 ms in all with 24 attempts. With its own 100 a byte
// that stays wrong would be waited for without end. Where nobody writes, a wrong checksum is
// damage.
constexpr unsigned kReadAttempts = 24, kOneReadAttempt = 1;

// The last version in which an event held its table of tissues.
constexpr int kTissuesInEvents = 8;

hsize_t rowCount(hid_t dataset) {
  const hid_t space = H5Dget_space(dataset);
  hsize_t size = 0;
  const bool one = H5Sget_simple_extent_ndims(space) == 1;
  if (one) H5Sget_simple_extent_dims(space, &size, nullptr);
  H5Sclose(space);
  return size;
}

// Whether the file can hold that many rows of that size: else its tables lie, and there is no need
// to set aside room for them. Deflate shrinks no further than 1 : 1032.
bool canHold(hid_t dataset, hsize_t rows, std::size_t row_bytes) {
  constexpr hsize_t kDeflated = 1032;
  const hsize_t stored = storedBytes(dataset);
  return stored != kLies && rows <= stored / row_bytes * kDeflated + kDeflated;
}

Status roomFor(hsize_t rows, std::size_t row_bytes) {
  const double needed_mb = double(rows) * double(row_bytes) / double(1 << 20);
  return enoughMemory(needed_mb, tr("The recording"), tr("the recording"));
}

// Takes the type over.
bool readRows(hid_t dataset, hid_t type, hsize_t first, hsize_t count, void* rows) {
  bool ok = true;
  if (count > 0) {
    const hid_t file_space = H5Dget_space(dataset);
    H5Sselect_hyperslab(file_space, H5S_SELECT_SET, &first, nullptr, &count, nullptr);
    const hid_t memory_space = H5Screate_simple(1, &count, nullptr);
    ok = H5Dread(dataset, type, memory_space, file_space, H5P_DEFAULT, rows) >= 0;
    H5Sclose(memory_space);
    H5Sclose(file_space);
  }
  H5Tclose(type);
  return ok;
}

std::optional<std::string> readText(hid_t file, const char* name) {
  const hid_t dataset = openOwnDataset(file, name);
  if (dataset < 0) return {};
  const hid_t type = H5Dget_type(dataset);
  const hid_t space = H5Dget_space(dataset);
  std::optional<std::string> out;
  constexpr std::size_t kLongest = 16 << 20;
  const std::size_t size = H5Tget_size(type);
  const bool is_text = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
  if (is_text && size <= kLongest && isOneElement(space)) {
    std::string text(size, '\0');
    if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0) {
      out = text.c_str();
    }
  }
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(dataset);
  return out;
}

int readVersion(hid_t file) {
  const hid_t attribute = H5Aopen(file, "version", H5P_DEFAULT);
  if (attribute < 0) return 0;
  const hid_t space = H5Aget_space(attribute);
  int version = 0;
  if (!isOneElement(space) || H5Aread(attribute, H5T_NATIVE_INT32, &version) < 0) version = 0;
  H5Sclose(space);
  H5Aclose(attribute);
  return version;
}

std::vector<std::string> datasetNames() {
  std::vector<std::string> names{"format", "build",          "scene",  "volume", "head_sha256",
                                 "ticks",  "removed_voxels", "events", "tissue_tables",
                                 "end"};
  for (std::size_t arm = 0; arm < std::size_t(kMaxArms); ++arm) {
    names.push_back(armDatasetName(arm));
  }
  return names;
}

// A grid that this program opened: what it can be is asked where a case is read.
Result<GridGeometry> readGeometry(JsonReader reader) {
  constexpr double kAny = 1e300;
  GridGeometry g;
  const auto size = reader.integers("size", 3, {1, 1e6, "voxels"});
  for (std::size_t axis = 0; axis < 3; ++axis) g.size[axis] = std::int32_t(size[axis]);
  g.spacing_mm = reader.vec3("spacing_mm", {1e-9, 1e9, "mm"});
  g.origin_mm = reader.vec3("origin_mm", {-kAny, kAny, "mm"});
  const auto direction = reader.numbers("direction", 9, {-1.01, 1.01});
  for (int i = 0; i < 9; ++i) g.direction[i % 3][i / 3] = direction[std::size_t(i)];
  if (Status status = reader.finish(); !status) return status.error();
  return g;
}

// Version 8 was also written before texts had to be single lines.
void makePlainLines(Json& json) {
  if (json.is_string()) json = cleanUtf8(json.get_ref<const std::string&>());
  if (!json.is_structured()) return;
  for (Json& part : json) makePlainLines(part);
}

}  // namespace

struct SessionReader::File {
  std::filesystem::path path;
  hid_t file = -1;
  int version = 0;
  hid_t ticks = -1, carves = -1, events = -1, tissue_tables = -1;
  std::vector<hid_t> arms;
  std::uint64_t tick_count = 0;
  RecordingHeader header;
  std::optional<RecordingEnd> end;
  // The events, and the tables that they point to, which stay where they are; read once.
  mutable bool events_read = false;
  mutable std::vector<Event> known_events;
  mutable std::vector<TissueTable> tables;

  Status readEvents() const;
  Status readEventsWithTissues() const;
  // Ticks [first, first + count) of ticks and arms; false where they cannot be read.
  bool read(std::uint64_t first, std::uint64_t count, std::vector<TickRecord>& out) const {
    std::vector<TickRow> rows(count);
    std::vector<ArmRecord> arm_rows(count);
    out.assign(count, TickRecord{});
    bool ok =
        readRows(ticks, compoundType(tickFields(), sizeof(TickRow)), first, count, rows.data());
    for (std::uint64_t i = 0; i < count; ++i) {
      out[i].tick = rows[i].tick;
      out[i].late_ns = rows[i].late_ns;
      out[i].journal = rows[i].journal;
    }
    for (std::size_t arm = 0; ok && arm < arms.size(); ++arm) {
      ok = readRows(arms[arm], compoundType(armFields(), sizeof(ArmRecord)), first, count,
                    arm_rows.data());
      for (std::uint64_t i = 0; i < count; ++i) out[i].arms[arm] = arm_rows[i];
    }
    return ok;
  }

  Error bad(const std::string& what) const {
    return Error{code::kBadRecording, what, path.string(),
                 tr("Choose a file that this program recorded; a copy may be incomplete")};
  }
  ~File() {
    for (hid_t arm : arms) H5Dclose(arm);
    for (hid_t dataset : {ticks, carves, events, tissue_tables}) {
      if (dataset >= 0) H5Dclose(dataset);
    }
    if (file >= 0) H5Fclose(file);
  }
};

// The first field that a table of this version has to have and has not, or of another kind or
// shape; empty where there is none.
std::string lackingColumn(hid_t table, std::span<const RecordField> fields, int version) {
  const hid_t type = H5Dget_type(table);
  std::string lacks;
  for (const RecordField& field : fields) {
    if (field.since > version || !lacks.empty()) continue;
    const bool compound = H5Tget_class(type) == H5T_COMPOUND;
    const int place = compound ? H5Tget_member_index(type, field.name) : -1;
    bool fits = place >= 0;
    if (fits) {
      const hid_t member = H5Tget_member_type(type, unsigned(place));
      const hid_t element = field.count > 1 && H5Tget_class(member) == H5T_ARRAY
                                ? H5Tget_super(member)
                                : H5Tcopy(member);
      const bool real = field.type == RecordField::Type::f64;
      fits = H5Tget_class(element) == (real ? H5T_FLOAT : H5T_INTEGER) &&
             H5Tget_size(member) == field.count * H5Tget_size(element);
      H5Tclose(element);
      H5Tclose(member);
    }
    if (!fits) lacks = field.name;
  }
  H5Tclose(type);
  return lacks;
}

// By the byte "file consistency flags" of HDF5's superblock, versions 2 and 3. A recorder writes
// four times a second.
bool isBeingWritten(const std::filesystem::path& recording) {
  constexpr auto kLast = std::chrono::seconds(10);
  std::error_code ec;
  const auto written = std::filesystem::last_write_time(recording, ec);
  if (ec || std::filesystem::file_time_type::clock::now() - written > kLast) return false;
  constexpr std::size_t kVersion = 8, kFlags = 11;
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  constexpr unsigned char kFirst = 2, kOpenForWriting = 0x01, kWrittenBesideReaders = 0x04;
  std::array<char, kFlags + 1> head{};
  std::ifstream in(recording, std::ios::binary);
  if (!in.read(head.data(), head.size())) return false;
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(head[at]); };
  return std::string_view(head.data(), kSignature.size()) == kSignature &&
         byte(kVersion) >= kFirst && (byte(kFlags) & (kOpenForWriting | kWrittenBesideReaders)) != 0;
}

SessionReader::SessionReader() : file_(std::make_unique<File>()) {}
SessionReader::~SessionReader() = default;

Result<std::unique_ptr<SessionReader>> SessionReader::open(const std::filesystem::path& path) {
  quietHdf5();
  std::error_code ec;
  if (::access(path.c_str(), R_OK) != 0 && errno == EACCES) {
    return Error{code::kCannotRead, tr("The recording may not be read: {}", std::strerror(errno)),
                 path.string(), tr("Ask the person who keeps it, or an administrator")};
  }
  if (std::filesystem::exists(path, ec) && !std::filesystem::is_regular_file(path, ec)) {
    return Error{code::kBadRecording, tr("This is no file but a folder, a pipe or a device"),
                 path.string(), tr("Give a recording's file")};
  }
  if (!std::filesystem::is_regular_file(path, ec)) {
    return Error{code::kMissingFile, tr("There is no recording"), path.string(),
                 tr("Check the name")};
  }
  std::unique_ptr<SessionReader> reader(new SessionReader);
  File& f = *reader->file_;
  f.path = path;
  // A recording that was killed still carries its writer's mark; reading beside a writer ignores
  // it.
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  const bool written = isBeingWritten(path);
  H5Pset_metadata_read_attempts(access, written ? kReadAttempts : kOneReadAttempt);
  f.file = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access);
  if (f.file < 0) f.file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  H5Pclose(access);
  if (f.file < 0)
    return f.bad(tr("The recording cannot be read: it is damaged or not a recording"));

  for (const std::string& name : datasetNames()) {
    if (!isForeign(f.file, name.c_str())) continue;
    return f.bad(
        tr("The recording's \"{}\" is not in the file itself, or not stored as Trephine stores it",
           name));
  }
  const std::optional<std::string> format = readText(f.file, "format");
  if (format != "trephine.session") return f.bad(tr("The file is not a recording of Trephine"));
  const int version = readVersion(f.file);
  if (version > kRecordingVersion) {
    return Error{
        code::kNewerVersion,
        tr("The recording has version {} of trephine.session, and this program reads up to {}",
           version, kRecordingVersion),
        path.string(), tr("Open it with a newer Trephine")};
  }
  if (version < kOldestRecording) {
    return Error{
        code::kOlderVersion,
        tr("The recording has version {} of trephine.session, and this program reads from {} on",
           version, kOldestRecording),
        path.string(), tr("Open it with the Trephine that made it")};
  }
  f.version = version;
  const auto exercise = readText(f.file, "scene");
  const auto volume = readText(f.file, "volume");
  const auto build = readText(f.file, "build");
  const auto head_sha256 = readText(f.file, "head_sha256");
  if (!exercise || !volume || !build || head_sha256 != headSha256(*build, *exercise, *volume)) {
    return f.bad(tr("The recording is incomplete: its head is damaged"));
  }
  Result<Json> exercise_json = parseJson(*exercise, path.string());
  if (!exercise_json) return f.bad(tr("The recording is damaged: its scene cannot be read"));
  Result<Json> volume_json = parseJson(*volume, path.string());
  if (!volume_json) return f.bad(tr("The recording is damaged: its volume cannot be read"));
  JsonReader volume_reader(*volume_json, path.string(), "volume");
  f.header.exercise = *std::move(exercise_json);
  makePlainLines(f.header.exercise);
  f.header.volume_sha256 = volume_reader.text("sha256");
  f.header.labels_sha256 = volume_reader.text("labels_sha256", "");
  Result<GridGeometry> geometry = readGeometry(volume_reader.object("geometry"));
  if (!geometry) return geometry.error();
  f.header.geometry = *geometry;
  f.header.build = *build;
  f.header.version = version;

  f.ticks = openOwnDataset(f.file, "ticks");
  f.carves = openOwnDataset(f.file, "removed_voxels");
  f.events = openOwnDataset(f.file, "events");
  const bool apart = version > kTissuesInEvents;
  if (apart) f.tissue_tables = openOwnDataset(f.file, "tissue_tables");
  for (std::size_t i = 0; i < std::size_t(kMaxArms); ++i) {
    const hid_t arm = openOwnDataset(f.file, armDatasetName(i).c_str());
    if (arm < 0) break;
    f.arms.push_back(arm);
  }
  const bool tables = !apart || f.tissue_tables >= 0;
  if (f.ticks < 0 || f.carves < 0 || f.events < 0 || !tables || f.arms.empty()) {
    return f.bad(tr("The recording is incomplete: its tables are damaged"));
  }
  for (hid_t arm : f.arms) {
    const std::string lacks = lackingColumn(arm, armFields(), version);
    if (!lacks.empty()) {
      return f.bad(
          tr("The recording is damaged: an arm's table has no '{}' as its version has it", lacks));
    }
  }
  hsize_t count = rowCount(f.ticks), most = count;
  for (hid_t arm : f.arms) {
    count = std::min(count, rowCount(arm));
    most = std::max(most, rowCount(arm));
  }
  f.tick_count = count;

  // The end of a recording that was killed has no row; one that cannot be read is damage.
  const hid_t end = openOwnDataset(f.file, "end");
  const hsize_t ends = end >= 0 ? rowCount(end) : 1;
  EndRow row;
  const bool read = end >= 0 && ends == 1 && readRows(end, endType(), 0, 1, &row);
  if (end >= 0) H5Dclose(end);
  if (ends > 0 && !read) return f.bad(tr("The recording is damaged: its end cannot be read"));
  if (read) {
    f.end = RecordingEnd{row.ticks, row.dropped, row.missed,
                         std::string(row.volume_sha256, sizeof(row.volume_sha256))};
  }
  // What ended in order has all its rows, unless it says that it dropped some.
  if (f.end && f.end->dropped == 0 && (f.end->ticks != count || most != count)) {
    return f.bad(
        tr("The recording contradicts itself: its end counts {} ticks, and its tables hold {}{}",
           f.end->ticks, count, (most == count ? "" : tr(" to {}", most))));
  }
  return reader;
}

const RecordingHeader& SessionReader::header() const { return file_->header; }
std::size_t SessionReader::armCount() const { return file_->arms.size(); }
std::uint64_t SessionReader::tickCount() const { return file_->tick_count; }
const std::optional<RecordingEnd>& SessionReader::end() const { return file_->end; }

Result<std::vector<TickRecord>> SessionReader::ticks(std::uint64_t first, std::uint64_t count) const {
  std::vector<TickRecord> out;
  if (file_->read(first, count, out)) return out;
  // The first tick that cannot be read lies in [damaged, last].
  std::uint64_t damaged = first, last = first + count - 1;
  while (damaged < last) {
    const std::uint64_t middle = damaged + (last - damaged) / 2;
    if (file_->read(damaged, middle - damaged + 1, out)) {
      damaged = middle + 1;
    } else {
      last = middle;
    }
  }
  return file_->bad(tr("The recording is damaged from tick {} on", damaged));
}

namespace {

bool isKnown(const Command& command) {
  const bool controller =
      command.kind != CommandKind::controller ||
      (command.value >= 0 && std::size_t(command.value) < kControllerNames.size());
  return controller && (command.kind == CommandKind::tissues) == (command.tissues != nullptr);
}

bool isTable(const TissueTable& table) {
  return table.count >= 0 && table.count <= kMaxTissues;
}

}  // namespace

Status SessionReader::File::readEvents() const {
  const Error damaged = bad(tr("The recording's events are damaged"));
  const hsize_t count = rowCount(events);
  // Beside a writer there may be tables of events that come later.
  const hsize_t table_count = std::min(rowCount(tissue_tables), count);
  if (!canHold(events, count, sizeof(EventRow)) ||
      !canHold(tissue_tables, table_count, sizeof(TissueTable))) {
    return damaged;
  }
  const std::size_t all = sizeof(EventRow) + sizeof(Event);
  if (Status enough = roomFor(count, all); !enough) return enough;
  if (Status enough = roomFor(table_count, sizeof(TissueTable)); !enough) return enough;
  std::vector<EventRow> rows(count);
  tables.assign(table_count, TissueTable{});
  if (!readRows(events, eventType(), 0, count, rows.data()) ||
      !readRows(tissue_tables, tissueTableType(), 0, table_count, tables.data())) {
    return damaged;
  }
  known_events.reserve(count);
  for (EventRow& row : rows) {
    row.event.command.tissues = nullptr;  // whatever the file's bytes make of it
    if (row.tissue_table >= std::int64_t(table_count) || row.tissue_table < -1) return damaged;
    if (row.tissue_table >= 0) {
      row.event.command.tissues = &tables[std::size_t(row.tissue_table)];
    }
    known_events.push_back(row.event);
  }
  return {};
}

// Of version 8: a table in each row, which only a command for tissues means.
Status SessionReader::File::readEventsWithTissues() const {
  const Error damaged = bad(tr("The recording's events are damaged"));
  const hsize_t count = rowCount(events);
  if (!canHold(events, count, sizeof(EventWithTissues))) return damaged;
  const std::size_t all = sizeof(EventWithTissues) + sizeof(TissueTable) + sizeof(Event);
  if (Status enough = roomFor(count, all); !enough) return enough;
  std::vector<EventWithTissues> rows(count);
  if (!readRows(events, eventWithTissuesType(), 0, count, rows.data())) return damaged;
  const auto means = [](const EventWithTissues& row) {
    return row.event.kind == EventKind::command && row.event.command.kind == CommandKind::tissues;
  };
  tables.reserve(std::size_t(std::ranges::count_if(rows, means)));  // they stay where they are
  known_events.reserve(count);
  for (EventWithTissues& row : rows) {
    row.event.command.tissues = nullptr;
    if (means(row)) row.event.command.tissues = &tables.emplace_back(row.tissues);
    known_events.push_back(row.event);
  }
  return {};
}

Result<std::vector<Event>> SessionReader::events() const {
  const File& f = *file_;
  if (f.events_read) return f.known_events;
  f.tables.clear();
  f.known_events.clear();
  Status read = f.version > kTissuesInEvents ? f.readEvents() : f.readEventsWithTissues();
  if (!read) return read.error();
  if (!std::ranges::all_of(f.tables, isTable))
    return f.bad(tr("The recording's events are damaged"));
  for (const Event& event : f.known_events) {
    if (isKnown(event.command)) continue;
    return f.bad(tr("The recording's events are damaged at tick {}", event.tick));
  }
  f.events_read = true;
  return f.known_events;
}

Result<std::vector<CarveRecord>> SessionReader::carves() const {
  const Error damaged = file_->bad(tr("The recording's removed voxels are damaged"));
  const hsize_t count = rowCount(file_->carves);
  if (!canHold(file_->carves, count, sizeof(CarveRecord))) return damaged;
  if (Status enough = roomFor(count, sizeof(CarveRecord)); !enough) return enough.error();
  std::vector<CarveRecord> out(count);
  if (!readRows(file_->carves, compoundType(carveFields(), sizeof(CarveRecord)), 0, out.size(),
                out.data())) {
    return damaged;
  }
  return out;
}

}  // namespace trephine
