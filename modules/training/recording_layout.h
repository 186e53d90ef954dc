// How the plain data of a tick lie in an HDF5 file: one table of fields a record, from which the
// file's types are made and by which a replay is compared.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <span>
#include <string>

#include "haptics/haptic_types.h"

namespace trephine {

struct RecordField {
  enum class Type { f64, i64, u64, i32, u32, i16, i8 };
  const char* name;
  std::size_t offset;
  Type type;
  std::size_t count;  // elements; more than 1 is an array
  int since = 0;      // the version of recordings that has it first; 0: all that are read have it

  std::size_t bytes() const;
};

// The row of the dataset "ticks".
struct TickRow {
  std::uint64_t tick = 0;
  std::int64_t late_ns = 0;
  std::uint32_t journal = 0;
};

// A field that a recording is too old for is read as it is by default.
std::span<const RecordField> armFields();    // ArmRecord
std::span<const RecordField> tickFields();   // TickRow
std::span<const RecordField> carveFields();  // CarveRecord
std::span<const RecordField> eventFields();  // Event, but for the tissues of its command

// The row of the dataset "events".
struct EventRow {
  Event event{};
  std::int32_t tissue_table = -1;  // row of the dataset "tissue_tables"; -1: none
};
// That of version 8, which held the table itself.
struct EventWithTissues {
  Event event{};
  TissueTable tissues{};
};

// HDF5 memory types; the caller closes them with H5Tclose.
hid_t compoundType(std::span<const RecordField> fields, std::size_t size);
hid_t eventType();             // EventRow
hid_t eventWithTissuesType();  // EventWithTissues
hid_t tissueTableType();       // TissueTable

// Row of the dataset "end".
struct EndRow {
  std::uint64_t ticks = 0;
  std::uint64_t dropped = 0;
  std::uint64_t missed = 0;
  char volume_sha256[64] = {};
};
hid_t endType();

// Before HDF5 is first used, any number of times: it prints nothing, loads no plugins, and does not
// tidy up at exit, where it would crash on a file that a full disk kept it from closing.
void quietHdf5();
std::string armDatasetName(std::size_t arm);  // "arm0"

// Of the texts at the head of a recording, which HDF5 itself does not guard.
std::string headSha256(const std::string& build, const std::string& exercise,
                       const std::string& volume);

}  // namespace trephine
