#include "ui/common/preferences.h"

#include <optional>

namespace trephine {

namespace {

constexpr FieldsOf<Preferences> kAll[] = {kWorkFields, kHeadsetFields, kScreenFields};

// The kept value, as the file of settings writes it: null where it is none of the field's.
std::optional<FieldValue> kept(const QVariant& found, const FieldShape& shape) {
  const std::string text = found.toString().toStdString();
  if (!found.isValid()) return {};
  Result<FieldValue> value = parseField(shape, text, shape.row.key);
  if (!value) return {};
  return *std::move(value);
}

QVariant written(const FieldValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  return QString::fromStdString(std::get<std::string>(value));
}

}  // namespace

Preferences preferences() {
  Preferences all;
  const QSettings settings = windowSettings();
  for (const FieldsOf<Preferences>& fields : kAll) {
    for (const FieldOf<Preferences>& field : fields) {
      const auto value = kept(settings.value(field.row.key), shapeOf(field));
      if (value) setValue(field, all, *value);
    }
  }
  return all;
}

void keepPreferences(const Preferences& preferences) {
  const Preferences fresh;
  QSettings settings = windowSettings();
  for (const FieldsOf<Preferences>& fields : kAll) {
    for (const FieldOf<Preferences>& field : fields) {
      const FieldValue value = valueOf(field, preferences);
      if (value == valueOf(field, fresh)) {
        settings.remove(field.row.key);
      } else {
        settings.setValue(field.row.key, written(value));
      }
    }
  }
}

std::string languageInUse() {
  return std::string(kLanguages[std::size_t(preferences().language)].first);
}

}  // namespace trephine
