#include "ui/work/arms_in_room.h"

#include "ui/common/settings.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

// One arm a row: plugin, bus path, serial, kept, error, then the pose as x y z and w x y z.
constexpr int kFields = 12;
constexpr QChar kBetween = '\t';

struct Row {
  FoundArm device;
  ArmInRoom where;
};

std::optional<Row> rowOf(const QString& text) {
  const QStringList fields = text.split(kBetween);
  if (fields.size() != kFields) return std::nullopt;
  double numbers[7];
  for (int i = 0; i < 7; ++i) {
    bool ok = false;
    numbers[i] = fields[5 + i].toDouble(&ok);
    if (!ok) return std::nullopt;
  }
  Row row;
  row.device = {fields[0].toStdString(), fields[1].toStdString(), fields[2].toStdString(), {}};
  row.where.kept = fields[3] == "kept";
  bool ok = false;
  if (const double error_mm = fields[4].toDouble(&ok); ok) row.where.error_mm = error_mm;
  const Quat turn(numbers[3], numbers[4], numbers[5], numbers[6]);
  row.where.room_from_device_m = {Vec3(numbers[0], numbers[1], numbers[2]), glm::normalize(turn)};
  if (!isFinite(row.where.room_from_device_m)) return std::nullopt;
  return row;
}

QString textOf(const Row& row) {
  const Pose& pose = row.where.room_from_device_m;
  const Quat& q = pose.orientation;
  QStringList fields{toQt(row.device.plugin), toQt(row.device.bus_path), toQt(row.device.serial),
                     row.where.kept ? "kept" : "now",
                     row.where.error_mm ? QString::number(*row.where.error_mm) : "by hand"};
  for (const double number :
       {pose.position.x, pose.position.y, pose.position.z, q.w, q.x, q.y, q.z})
    fields << QString::number(number, 'g', 12);
  return fields.join(kBetween);
}

std::vector<Row> rows() {
  std::vector<Row> all;
  for (const QString& text : read(settings::kArmsInRoom)) {
    if (std::optional<Row> row = rowOf(text)) all.push_back(*std::move(row));
  }
  return all;
}

void keep(const std::vector<Row>& all) {
  QStringList texts;
  for (const Row& row : all) texts << textOf(row);
  write(settings::kArmsInRoom, texts);
}

}  // namespace

std::optional<ArmInRoom> armInRoom(const FoundArm& device) {
  for (const Row& row : rows()) {
    if (row.device.isSame(device)) return row.where;
  }
  return std::nullopt;
}

void setArmInRoom(const FoundArm& device, const std::optional<ArmInRoom>& where) {
  std::vector<Row> all = rows();
  std::erase_if(all, [&](const Row& row) { return row.device.isSame(device); });
  if (where) all.push_back({device, *where});
  keep(all);
}

bool forgetArmsInRoom(bool all) {
  std::vector<Row> left = rows();
  const std::size_t before = left.size();
  std::erase_if(left, [&](const Row& row) { return all || !row.where.kept; });
  if (left.size() == before) return false;
  keep(left);
  return true;
}

}  // namespace trephine
