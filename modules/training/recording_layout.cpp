#include "training/recording_layout.h"

#include <string>
#include <vector>

#include "base/sha256.h"

namespace trephine {

namespace {

using Type = RecordField::Type;

#define FIELD(Record, member, type, count) {#member, offsetof(Record, member), Type::type, count}

constexpr int kWork = 12;  // the first version that says where the work went

constexpr RecordField kArmFields[] = {
    FIELD(ArmRecord, device_position_m, f64, 3),
    {"device_orientation_xyzw", offsetof(ArmRecord, device_orientation), Type::f64, 4},
    FIELD(ArmRecord, patient_position_mm, f64, 3),
    {"patient_orientation_xyzw", offsetof(ArmRecord, patient_orientation), Type::f64, 4},
    FIELD(ArmRecord, proxy_position_mm, f64, 3),
    {"proxy_orientation_xyzw", offsetof(ArmRecord, proxy_orientation), Type::f64, 4},
    FIELD(ArmRecord, velocity_m_s, f64, 3),
    FIELD(ArmRecord, demanded_N, f64, 3),
    FIELD(ArmRecord, demanded_torque_Nm, f64, 3),
    FIELD(ArmRecord, bounded_N, f64, 3),
    FIELD(ArmRecord, clamped_N, f64, 3),
    FIELD(ArmRecord, sent_N, f64, 3),
    FIELD(ArmRecord, energy_out_J, f64, 3),
    FIELD(ArmRecord, observer_J, f64, 1),
    FIELD(ArmRecord, alpha, f64, 1),
    FIELD(ArmRecord, credit_J, f64, 1),
    FIELD(ArmRecord, learnt_scale, f64, 1),
    FIELD(ArmRecord, rendered_share, f64, 1),
    FIELD(ArmRecord, hand_work_J, f64, 1),
    FIELD(ArmRecord, stored_J, f64, 1),
    FIELD(ArmRecord, cutting_credit_J, f64, 1),
    {"model_work_J", offsetof(ArmRecord, model_work_J), Type::f64, 1, kWork},
    {"motor_work_J", offsetof(ArmRecord, motor_work_J), Type::f64, 1, kWork},
    {"removal_work_J", offsetof(ArmRecord, removal_work_J), Type::f64, 1, kWork},
    {"heat_J", offsetof(ArmRecord, heat_J), Type::f64, 1, kWork},
    FIELD(ArmRecord, controller_parts, u32, 1),
    FIELD(ArmRecord, tissue_class, i32, 1),
    FIELD(ArmRecord, points_in_tissue, i32, 1),
    FIELD(ArmRecord, removed_voxels, i32, 1),
    FIELD(ArmRecord, tool_state, u32, 1),
    FIELD(ArmRecord, faults, u32, 1),
    FIELD(ArmRecord, buttons, u32, 1),
    FIELD(ArmRecord, flags, u32, 1),
};
static_assert(sizeof(Quat) == 4 * sizeof(double) && offsetof(Quat, x) == 0,
              "recordings keep quaternions as glm stores them: x, y, z, w");

constexpr RecordField kTickFields[] = {
    FIELD(TickRow, tick, u64, 1),
    FIELD(TickRow, late_ns, i64, 1),
    FIELD(TickRow, journal, u32, 1),
};

constexpr RecordField kCarveFields[] = {
    FIELD(CarveRecord, tick, u64, 1),  FIELD(CarveRecord, voxel, u32, 1),
    FIELD(CarveRecord, old_hu, i16, 1), FIELD(CarveRecord, arm, i8, 1),
    FIELD(CarveRecord, tissue_class, i8, 1),
};

#undef FIELD

hid_t nativeType(Type type) {
  switch (type) {
    case Type::f64: return H5T_NATIVE_DOUBLE;
    case Type::i64: return H5T_NATIVE_INT64;
    case Type::u64: return H5T_NATIVE_UINT64;
    case Type::i32: return H5T_NATIVE_INT32;
    case Type::u32: return H5T_NATIVE_UINT32;
    case Type::i16: return H5T_NATIVE_INT16;
    case Type::i8: return H5T_NATIVE_INT8;
  }
  return -1;
}

std::size_t offsetIn(const void* whole, const void* member) {
  return std::size_t(static_cast<const char*>(member) - static_cast<const char*>(whole));
}

std::vector<RecordField> fieldsOfEvents() {
  const Event at{};
  const auto field = [&](const char* name, const auto& member, Type type) {
    return RecordField{name, offsetIn(&at, &member), type, 1};
  };
  return {field("tick", at.tick, Type::u64),
          field("kind", at.kind, Type::i32),
          field("arm", at.arm, Type::i32),
          field("value", at.value, Type::u32),
          field("command", at.command.kind, Type::i32),
          field("command_value", at.command.value, Type::i32),
          field("command_arm", at.command.arm, Type::i32),
          {"command_rotation_xyzw", offsetIn(&at, &at.command.rotation), Type::f64, 4}};
}

// A field for each of a tissue's numbers, and for what else the tick keeps of one. A number that an
// older recording does not have is read as 0.
std::vector<RecordField> fieldsOfTissues() {
  const TissueClass at{};
  std::vector<RecordField> fields;
  const auto add = [&](const char* name, const auto& member, Type type) {
    fields.push_back({name, offsetIn(&at, &member), type, 1});
  };
  add("hu_min", at.hu_min, Type::i32);
  add("hu_max", at.hu_max, Type::i32);
  for (const TissueNumber& number : kTissueNumbers) add(number.key, at.*number.in_tick, Type::f64);
  add("cuttable", at.cuttable, Type::i32);
  add("label", at.label, Type::i32);
  add("solid", at.solid, Type::i32);
  return fields;
}

}  // namespace

std::size_t RecordField::bytes() const {
  switch (type) {
    case Type::f64:
    case Type::i64:
    case Type::u64: return 8 * count;
    case Type::i32:
    case Type::u32: return 4 * count;
    case Type::i16: return 2 * count;
    case Type::i8: return count;
  }
  return 0;
}

std::span<const RecordField> armFields() { return kArmFields; }
std::span<const RecordField> tickFields() { return kTickFields; }
std::span<const RecordField> carveFields() { return kCarveFields; }
std::span<const RecordField> eventFields() {
  static const std::vector<RecordField> fields = fieldsOfEvents();
  return fields;
}

hid_t compoundType(std::span<const RecordField> fields, std::size_t size) {
  const hid_t compound = H5Tcreate(H5T_COMPOUND, size);
  for (const RecordField& field : fields) {
    if (field.count == 1) {
      H5Tinsert(compound, field.name, field.offset, nativeType(field.type));
    } else {
      const hsize_t count = field.count;
      const hid_t array = H5Tarray_create2(nativeType(field.type), 1, &count);
      H5Tinsert(compound, field.name, field.offset, array);
      H5Tclose(array);
    }
  }
  return compound;
}

hid_t eventType() {
  const EventRow at{};
  const hid_t event = compoundType(eventFields(), sizeof(EventRow));
  H5Tinsert(event, "tissue_table", offsetIn(&at, &at.tissue_table), H5T_NATIVE_INT32);
  return event;
}

namespace {

hid_t tissuesType() {
  const hid_t tissue = compoundType(fieldsOfTissues(), sizeof(TissueClass));
  const hsize_t count = kMaxTissues;
  const hid_t tissues = H5Tarray_create2(tissue, 1, &count);
  H5Tclose(tissue);
  return tissues;
}

}  // namespace

hid_t tissueTableType() {
  const TissueTable at{};
  const hid_t table = H5Tcreate(H5T_COMPOUND, sizeof(TissueTable));
  H5Tinsert(table, "count", offsetIn(&at, &at.count), H5T_NATIVE_INT32);
  const hid_t tissues = tissuesType();
  H5Tinsert(table, "tissues", offsetIn(&at, &at.classes), tissues);
  H5Tclose(tissues);
  return table;
}

hid_t eventWithTissuesType() {
  const EventWithTissues at{};
  const hid_t event = compoundType(eventFields(), sizeof(EventWithTissues));
  H5Tinsert(event, "tissue_count", offsetIn(&at, &at.tissues.count), H5T_NATIVE_INT32);
  const hid_t tissues = tissuesType();
  H5Tinsert(event, "tissues", offsetIn(&at, &at.tissues.classes), tissues);
  H5Tclose(tissues);
  return event;
}

hid_t endType() {
  const hid_t end = H5Tcreate(H5T_COMPOUND, sizeof(EndRow));
  H5Tinsert(end, "ticks", offsetof(EndRow, ticks), H5T_NATIVE_UINT64);
  H5Tinsert(end, "dropped", offsetof(EndRow, dropped), H5T_NATIVE_UINT64);
  H5Tinsert(end, "missed_deadlines", offsetof(EndRow, missed), H5T_NATIVE_UINT64);
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, sizeof(EndRow::volume_sha256));
  H5Tset_strpad(text, H5T_STR_NULLPAD);
  H5Tinsert(end, "volume_sha256", offsetof(EndRow, volume_sha256), text);
  H5Tclose(text);
  return end;
}

void quietHdf5() {
  static const herr_t no_exit = H5dont_atexit();  // refused when it is asked again
  // A file names filters and drivers, and none of ours needs one that is loaded.
  static const herr_t no_plugins = H5PLset_loading_state(0);
  // What it prints of errors is set for each thread.
  thread_local const herr_t quiet = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  (void)no_exit;
  (void)no_plugins;
  (void)quiet;
}

std::string armDatasetName(std::size_t arm) { return "arm" + std::to_string(arm); }

std::string headSha256(const std::string& build, const std::string& exercise,
                       const std::string& volume) {
  const std::string head = build + '\n' + exercise + '\n' + volume;
  return sha256Hex(head.data(), head.size());
}

}  // namespace trephine
