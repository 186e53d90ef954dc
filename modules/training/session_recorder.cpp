#include "training/session_recorder.h"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <vector>

#include "base/codes.h"
#include "base/file.h"
#include "base/purpose.h"
#include "base/shared_folder.h"
#include "base/tr.h"
#include "training/codes.h"
#include "training/recording_layout.h"

namespace trephine {

namespace {

// A one-dimensional dataset that grows.
class Rows {
 public:
  bool create(hid_t file, const char* name, hid_t type, hsize_t chunk) {
    type_ = type;
    chunk_ = chunk;
    const hsize_t none = 0, unlimited = H5S_UNLIMITED;
    const hid_t space = H5Screate_simple(1, &none, &unlimited);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(properties, 1, &chunk);
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, 1);
    dataset_ = H5Dcreate2(file, name, type_, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    H5Sclose(space);
    return dataset_ >= 0;
  }

  bool append(const void* rows, std::size_t count) {
    if (count == 0) return true;
    const hsize_t start = size_, added = count, total = size_ + count;
    if (H5Dset_extent(dataset_, &total) < 0) return false;
    const hid_t file_space = H5Dget_space(dataset_);
    H5Sselect_hyperslab(file_space, H5S_SELECT_SET, &start, nullptr, &added, nullptr);
    const hid_t memory_space = H5Screate_simple(1, &added, nullptr);
    const bool ok = H5Dwrite(dataset_, type_, memory_space, file_space, H5P_DEFAULT, rows) >= 0;
    H5Sclose(memory_space);
    H5Sclose(file_space);
    if (ok) size_ = total;
    return ok;
  }

  bool flush() { return H5Dflush(dataset_) >= 0; }

  // The most that appending `count` rows can add to the file: whole chunks, uncompressed, since a
  // chunk that is half full now is written anew.
  std::size_t mostBytes(std::size_t count) const {
    return (count / chunk_ + 2) * chunk_ * H5Tget_size(type_);
  }

  void close() {
    if (dataset_ >= 0) H5Dclose(dataset_);
    if (type_ >= 0) H5Tclose(type_);
    dataset_ = type_ = -1;
  }

 private:
  hid_t dataset_ = -1;
  hid_t type_ = -1;
  hsize_t chunk_ = 1;
  hsize_t size_ = 0;
};

void writeText(hid_t file, const char* name, const std::string& text) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, text.size() + 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t dataset =
      H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str());
  H5Dclose(dataset);
  H5Sclose(space);
  H5Tclose(type);
}

void writeVersion(hid_t file) {
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute =
      H5Acreate2(file, "version", H5T_NATIVE_INT32, space, H5P_DEFAULT, H5P_DEFAULT);
  const int version = kRecordingVersion;
  H5Awrite(attribute, H5T_NATIVE_INT32, &version);
  H5Aclose(attribute);
  H5Sclose(space);
}

Json geometryJson(const GridGeometry& g) {
  Json direction = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) direction.push_back(g.direction[column][row]);
  }
  return {{"size", {g.size[0], g.size[1], g.size[2]}},
          {"spacing_mm", {g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z}},
          {"origin_mm", {g.origin_mm.x, g.origin_mm.y, g.origin_mm.z}},
          {"direction", direction}};
}

}  // namespace

struct SessionRecorder::File {
  std::filesystem::path path;
  hid_t file = -1;
  int descriptor = -1;  // of the same file, to reserve room
  Rows ticks, carves, events, tissue_tables, end;
  std::vector<Rows> arms;
  std::vector<TickRow> new_ticks;
  std::vector<std::vector<ArmRecord>> new_arms;
  std::vector<CarveRecord> new_carves;
  std::vector<EventRow> new_events;
  std::vector<TissueTable> new_tables;
  std::int32_t table_count = 0;
  std::optional<Error> failure;

  // HDF5 leaves an unreadable file when the disk fills in the middle of a write. So the room for
  // everything that is about to be written is taken first, and kept ahead of the writer.
  bool reserve() {
    constexpr std::size_t kMetadata = 256 * 1024;
    std::size_t bytes = kMetadata + ticks.mostBytes(new_ticks.size()) +
                        carves.mostBytes(new_carves.size()) + events.mostBytes(new_events.size()) +
                        tissue_tables.mostBytes(new_tables.size());
    for (std::size_t i = 0; i < arms.size(); ++i) bytes += arms[i].mostBytes(new_arms[i].size());
    haddr_t used = 0;
    if (H5Fget_eoa(file, &used) < 0) return false;
    const int error = ::posix_fallocate(descriptor, 0, off_t(used + bytes));
    if (error != 0) errno = error;
    return error == 0;
  }

  // Gives back the room that was reserved and not used.
  void trim() {
    quietHdf5();
    const hid_t closed = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    haddr_t used = 0;
    const bool known = closed >= 0 && H5Fget_eoa(closed, &used) >= 0;
    if (closed >= 0) H5Fclose(closed);
    if (known && used > 0) (void)!::ftruncate(descriptor, off_t(used));
  }

  // What is written into a file without a name is lost when it is closed.
  bool isGone() {
    struct stat of {};
    if (failure || ::fstat(descriptor, &of) != 0 || of.st_nlink > 0) return false;
    failure = Error{code::kRecordingGone, tr("The recording was deleted while it was written"),
                    path.filename().string(), tr("Start the exercise anew to have it recorded")};
    return true;
  }

  Status fail() {
    if (!failure) {
      const int error = errno;
      failure = Error{code::kCannotWrite,
                      tr("The recording can no longer be written: {}",
                         error ? std::strerror(error) : tr("unknown reason")),
                      path.filename().string(),
                      tr("{}; what was recorded until now is kept", afterFailedWrite(error))};
    }
    return *failure;
  }

  void close() {
    for (Rows& rows : arms) rows.close();
    for (Rows* rows : {&ticks, &carves, &events, &tissue_tables, &end}) rows->close();
    if (file >= 0) {
      H5Fclose(file);
      trim();
    }
    if (descriptor >= 0) ::close(descriptor);
    file = -1;
    descriptor = -1;
  }
};

SessionRecorder::SessionRecorder() : file_(std::make_unique<File>()) {}

SessionRecorder::~SessionRecorder() { file_->close(); }

Result<std::unique_ptr<SessionRecorder>> SessionRecorder::create(const std::filesystem::path& path,
                                                                 const RecordingHeader& header,
                                                                 std::size_t arm_count) {
  quietHdf5();
  std::error_code ec;
  const bool there =
      std::filesystem::symlink_status(path, ec).type() != std::filesystem::file_type::not_found;
  std::unique_ptr<SessionRecorder> recorder(new SessionRecorder);
  File& f = *recorder->file_;
  f.path = path;
  errno = 0;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  f.file = H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access);
  H5Pclose(access);
  if (f.file >= 0) keepOwn(path);
  const auto cannot = [&path] {
    const int error = errno;
    return Error{code::kCannotWrite,
                 tr("The recording cannot be started: {}",
                    error ? std::strerror(error) : tr("unknown reason")),
                 path.string(), afterFailedWrite(error)};
  };
  if (f.file < 0) {
    const Error error = cannot();
    if (!there) std::filesystem::remove(path, ec);  // a full disk leaves an empty one
    return error;
  }

  writeVersion(f.file);
  writeText(f.file, "format", "trephine.session");
  writeText(f.file, "purpose", kPurpose);
  Json volume = {{"sha256", header.volume_sha256}, {"geometry", geometryJson(header.geometry)}};
  if (!header.labels_sha256.empty()) volume["labels_sha256"] = header.labels_sha256;
  const std::string exercise_text = header.exercise.dump(1), volume_text = volume.dump(1);
  writeText(f.file, "build", header.build);
  writeText(f.file, "scene", exercise_text);
  writeText(f.file, "volume", volume_text);
  writeText(f.file, "head_sha256", headSha256(header.build, exercise_text, volume_text));

  bool ok = f.ticks.create(f.file, "ticks", compoundType(tickFields(), sizeof(TickRow)), 4096);
  f.arms.resize(arm_count);
  f.new_arms.resize(arm_count);
  for (std::size_t i = 0; i < arm_count; ++i) {
    ok = ok && f.arms[i].create(f.file, armDatasetName(i).c_str(),
                                compoundType(armFields(), sizeof(ArmRecord)), 512);
  }
  ok = ok && f.carves.create(f.file, "removed_voxels",
                             compoundType(carveFields(), sizeof(CarveRecord)), 4096);
  ok = ok && f.events.create(f.file, "events", eventType(), 64);
  ok = ok && f.tissue_tables.create(f.file, "tissue_tables", tissueTableType(), 8);
  ok = ok && f.end.create(f.file, "end", endType(), 1);
  f.descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (!ok || f.descriptor < 0 || !f.reserve() || H5Fflush(f.file, H5F_SCOPE_GLOBAL) < 0 || H5Fstart_swmr_write(f.file) < 0) {
    const Error error = cannot();
    f.close();
    std::filesystem::remove(path, ec);
    return error;
  }
  return recorder;
}

void SessionRecorder::tick(const TickRecord& record) {
  if (file_->failure) return;
  file_->new_ticks.push_back({record.tick, record.late_ns, record.journal});
  for (std::size_t i = 0; i < file_->new_arms.size(); ++i) {
    file_->new_arms[i].push_back(record.arms[i]);
  }
}

void SessionRecorder::carve(const CarveRecord& carve) {
  if (!file_->failure) file_->new_carves.push_back(carve);
}

void SessionRecorder::event(const Event& event) {
  File& f = *file_;
  if (f.failure) return;
  EventRow row{event, -1};
  if (event.command.tissues) {
    f.new_tables.push_back(*event.command.tissues);
    row.tissue_table = f.table_count++;
    row.event.command.tissues = nullptr;  // HDF5 writes whole rows
  }
  f.new_events.push_back(row);
}

void SessionRecorder::abandon(const Error& why) {
  if (!file_->failure) file_->failure = why;
}

Status SessionRecorder::flush() {
  File& f = *file_;
  if (f.failure || f.isGone()) return *f.failure;
  errno = 0;
  // Ticks last: a reader that finds a tick finds all that belongs to it.
  bool ok = f.reserve() && f.tissue_tables.append(f.new_tables.data(), f.new_tables.size()) &&
            f.tissue_tables.flush() && f.events.append(f.new_events.data(), f.new_events.size()) &&
            f.carves.append(f.new_carves.data(), f.new_carves.size());
  for (std::size_t i = 0; ok && i < f.arms.size(); ++i) {
    ok = f.arms[i].append(f.new_arms[i].data(), f.new_arms[i].size()) && f.arms[i].flush();
  }
  ok = ok && f.events.flush() && f.carves.flush() &&
       f.ticks.append(f.new_ticks.data(), f.new_ticks.size()) && f.ticks.flush();
  f.new_events.clear();
  f.new_tables.clear();
  f.new_carves.clear();
  f.new_ticks.clear();
  for (auto& rows : f.new_arms) rows.clear();
  return ok ? Status() : f.fail();
}

Status SessionRecorder::finish(const RecordingEnd& end) {
  Status status = flush();
  File& f = *file_;
  if (status) {
    EndRow row{end.ticks, end.dropped, end.missed_deadlines, {}};
    std::memcpy(row.volume_sha256, end.volume_sha256.data(),
                std::min(sizeof(row.volume_sha256), end.volume_sha256.size()));
    errno = 0;
    if (!f.reserve() || !f.end.append(&row, 1) || !f.end.flush()) status = f.fail();
  }
  f.close();
  return status;
}

}  // namespace trephine
