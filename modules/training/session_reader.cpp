#include "training/session_reader.h"

#include <hdf5.h>

#include <algorithm>
#include <cstring>

#include "training/recording_layout.h"

namespace trephine {

namespace {

// Beside a writer, what is half written has a wrong checksum for a moment. HDF5 then waits 1 ns and
// reads again, the next time twice as long: 16 ms in all with 24 attempts. With its own 100 a byte
// that stays wrong would be waited for without end.
constexpr unsigned kReadAttempts = 24;

hsize_t rowCount(hid_t dataset) {
  const hid_t space = H5Dget_space(dataset);
  hsize_t size = 0;
  const bool one = H5Sget_simple_extent_ndims(space) == 1;
  if (one) H5Sget_simple_extent_dims(space, &size, nullptr);
  H5Sclose(space);
  return size;
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
  const hid_t dataset = H5Dopen2(file, name, H5P_DEFAULT);
  if (dataset < 0) return {};
  const hid_t type = H5Dget_type(dataset);
  std::optional<std::string> out;
  constexpr std::size_t kLongest = 16 << 20;
  const std::size_t size = H5Tget_size(type);
  if (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && size <= kLongest) {
    std::string text(size, '\0');
    if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0) {
      out = text.c_str();
    }
  }
  H5Tclose(type);
  H5Dclose(dataset);
  return out;
}

int readVersion(hid_t file) {
  const hid_t attribute = H5Aopen(file, "version", H5P_DEFAULT);
  if (attribute < 0) return 0;
  int version = 0;
  if (H5Aread(attribute, H5T_NATIVE_INT32, &version) < 0) version = 0;
  H5Aclose(attribute);
  return version;
}

Result<GridGeometry> readGeometry(JsonReader reader) {
  GridGeometry g;
  const Vec3 size = reader.vec3("size");
  for (int axis = 0; axis < 3; ++axis) g.size[std::size_t(axis)] = std::int32_t(size[axis]);
  g.spacing_mm = reader.vec3("spacing_mm");
  g.origin_mm = reader.vec3("origin_mm");
  const Json& direction = reader.raw("direction");
  if (!direction.is_array() || direction.size() != 9) reader.fail("direction", "Expected 9 numbers");
  for (int i = 0; reader.ok() && i < 9; ++i) {
    const Json& value = direction[std::size_t(i)];
    if (!value.is_number()) {
      reader.fail("direction", "Expected 9 numbers");
    } else {
      g.direction[i % 3][i / 3] = value.get<double>();
    }
  }
  if (Status status = reader.finish(); !status) return status.error();
  return g;
}

}  // namespace

struct SessionReader::File {
  std::filesystem::path path;
  hid_t file = -1;
  hid_t ticks = -1, carves = -1, events = -1;
  std::vector<hid_t> arms;
  std::uint64_t tick_count = 0;
  RecordingHeader header;
  std::optional<RecordingEnd> end;

  Error bad(const std::string& what) const {
    return Error{"BAD_RECORDING", what, path.string(),
                 "Choose a file that this program recorded; a copy may be incomplete"};
  }
  ~File() {
    for (hid_t arm : arms) H5Dclose(arm);
    for (hid_t dataset : {ticks, carves, events}) {
      if (dataset >= 0) H5Dclose(dataset);
    }
    if (file >= 0) H5Fclose(file);
  }
};

SessionReader::SessionReader() : file_(std::make_unique<File>()) {}
SessionReader::~SessionReader() = default;

Result<std::unique_ptr<SessionReader>> SessionReader::open(const std::filesystem::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  std::error_code ec;
  if (!std::filesystem::is_regular_file(path, ec)) {
    return Error{"MISSING_FILE", "There is no recording", path.string(), "Check the name"};
  }
  std::unique_ptr<SessionReader> reader(new SessionReader);
  File& f = *reader->file_;
  f.path = path;
  // A recording that was killed still carries its writer's mark; reading beside a writer ignores it.
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  H5Pset_metadata_read_attempts(access, kReadAttempts);
  f.file = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access);
  if (f.file < 0) f.file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  H5Pclose(access);
  if (f.file < 0) return f.bad("The recording cannot be read: it is damaged or not a recording");

  const std::optional<std::string> format = readText(f.file, "format");
  if (format != "trephine.session") return f.bad("The file is not a recording of Trephine");
  const int version = readVersion(f.file);
  if (version > kRecordingVersion) {
    return Error{"NEWER_VERSION",
                 "The recording has version " + std::to_string(version) +
                     " of trephine.session, and this program reads up to " +
                     std::to_string(kRecordingVersion),
                 path.string(), "Open it with a newer Trephine"};
  }
  if (version < kOldestRecordingVersion) {
    return Error{"OLDER_VERSION",
                 "The recording has version " + std::to_string(version) +
                     " of trephine.session, and this program reads from " +
                     std::to_string(kOldestRecordingVersion) + " on",
                 path.string(), "Open it with the Trephine that made it"};
  }
  const auto scene = readText(f.file, "scene");
  const auto volume = readText(f.file, "volume");
  const auto build = readText(f.file, "build");
  const auto head_sha256 = readText(f.file, "head_sha256");  // older recordings have none
  if (version < 1 || !scene || !volume || !build ||
      (head_sha256 && *head_sha256 != headSha256(*build, *scene, *volume))) {
    return f.bad("The recording is incomplete: its head is damaged");
  }
  Result<Json> scene_json = parseJson(*scene, path.string());
  if (!scene_json) return scene_json.error();
  Result<Json> volume_json = parseJson(*volume, path.string());
  if (!volume_json) return volume_json.error();
  JsonReader volume_reader(*volume_json, path.string(), "volume");
  f.header.scene = *std::move(scene_json);
  f.header.volume_sha256 = volume_reader.text("sha256");
  f.header.labels_sha256 = volume_reader.text("labels_sha256", "");
  Result<GridGeometry> geometry = readGeometry(volume_reader.object("geometry"));
  if (!geometry) return geometry.error();
  f.header.geometry = *geometry;
  f.header.build = *build;

  f.ticks = H5Dopen2(f.file, "ticks", H5P_DEFAULT);
  f.carves = H5Dopen2(f.file, "removed_voxels", H5P_DEFAULT);
  f.events = H5Dopen2(f.file, "events", H5P_DEFAULT);
  for (std::size_t i = 0; i < std::size_t(kMaxArms); ++i) {
    const hid_t arm = H5Dopen2(f.file, armDatasetName(i).c_str(), H5P_DEFAULT);
    if (arm < 0) break;
    f.arms.push_back(arm);
  }
  if (f.ticks < 0 || f.carves < 0 || f.events < 0 || f.arms.empty()) {
    return f.bad("The recording is incomplete: its tables are damaged");
  }
  hsize_t count = rowCount(f.ticks);
  for (hid_t arm : f.arms) count = std::min(count, rowCount(arm));
  f.tick_count = count;

  if (const hid_t end = H5Dopen2(f.file, "end", H5P_DEFAULT); end >= 0) {
    EndRow row;
    if (rowCount(end) == 1 && readRows(end, endType(), 0, 1, &row)) {
      f.end = RecordingEnd{row.ticks, row.dropped, row.missed,
                           std::string(row.volume_sha256, sizeof(row.volume_sha256))};
    }
    H5Dclose(end);
  }
  return reader;
}

const RecordingHeader& SessionReader::header() const { return file_->header; }
std::size_t SessionReader::armCount() const { return file_->arms.size(); }
std::uint64_t SessionReader::tickCount() const { return file_->tick_count; }
const std::optional<RecordingEnd>& SessionReader::end() const { return file_->end; }

Result<std::vector<TickRecord>> SessionReader::ticks(std::uint64_t first, std::uint64_t count) const {
  std::vector<TickRow> rows(count);
  std::vector<ArmRecord> arm_rows(count);
  std::vector<TickRecord> out(count);
  bool ok = readRows(file_->ticks, compoundType(tickFields(), sizeof(TickRow)), first, count,
                     rows.data());
  for (std::uint64_t i = 0; i < count; ++i) {
    out[i].tick = rows[i].tick;
    out[i].late_ns = rows[i].late_ns;
    out[i].journal = rows[i].journal;
  }
  for (std::size_t arm = 0; ok && arm < armCount(); ++arm) {
    ok = readRows(file_->arms[arm], compoundType(armFields(), sizeof(ArmRecord)), first, count,
                  arm_rows.data());
    for (std::uint64_t i = 0; i < count; ++i) out[i].arms[arm] = arm_rows[i];
  }
  if (!ok) return file_->bad("The recording is damaged after tick " + std::to_string(first));
  return out;
}

Result<std::vector<Event>> SessionReader::events() const {
  std::vector<Event> out(rowCount(file_->events));
  if (!readRows(file_->events, eventType(), 0, out.size(), out.data())) {
    return file_->bad("The recording's events are damaged");
  }
  for (const Event& event : out) {
    const Command& command = event.command;
    const bool controller_known =
        command.kind != CommandKind::controller ||
        (command.value >= 0 && std::size_t(command.value) < kControllerNames.size());
    if (!controller_known || command.tissues.count < 0 || command.tissues.count > kMaxTissues) {
      return file_->bad("The recording's events are damaged");
    }
  }
  return out;
}

Result<std::vector<CarveRecord>> SessionReader::carves() const {
  std::vector<CarveRecord> out(rowCount(file_->carves));
  if (!readRows(file_->carves, compoundType(carveFields(), sizeof(CarveRecord)), 0, out.size(),
                out.data())) {
    return file_->bad("The recording's removed voxels are damaged");
  }
  return out;
}

}  // namespace trephine
