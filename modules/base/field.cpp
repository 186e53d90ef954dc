#include "base/field.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/codes.h"
#include "base/tr.h"

namespace trephine {

namespace {

// As schema pages have it: 1e9, not 1e+09, and commas in no number, since tables are searched.
std::string pageNumber(double value) {
  const double size = std::abs(value);
  if (size < 1e6) return plainNumber(value);
  const int power = int(std::log10(size) + 1e-9);
  const double front = value / std::pow(10.0, power);
  return front == std::floor(front) ? plainNumber(front) + "e" + std::to_string(power)
                                    : plainNumber(value);
}

bool isNumber(FieldKind kind) {
  return kind <= FieldKind::three_numbers;
}

std::string listed(std::span<const std::string_view> names, const char* quote) {
  std::string text;
  for (const std::string_view name : names) {
    text += (text.empty() ? "" : ", ") + (quote + std::string(name)) + quote;
  }
  return text;
}

bool isAmong(std::span<const std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

std::string noSuchChoice(const std::string& name) {
  return tr("'{}' is none of its choices", name);
}

std::string useOneOf(const FieldShape& field) {
  return tr("Use one of: {}", listed(field.names, ""));
}

// Longer than any list of ours.
constexpr std::size_t kMostInAList = 64;

std::string typeWords(const FieldShape& field) {
  switch (field.kind) {
    case FieldKind::number:
      return "number";
    case FieldKind::whole:
      return "whole number";
    case FieldKind::three_numbers:
      return "three numbers";
    case FieldKind::direction:
      return "direction";
    case FieldKind::flag:
      return "true or false";
    case FieldKind::text:
    case FieldKind::reference:
      return "text";
    case FieldKind::lines:
    case FieldKind::references:
      return "list of texts";
    case FieldKind::choice:
      return listed(field.names, "`");
    case FieldKind::choices:
      return "list of " + listed(field.names, "`");
  }
  return {};
}

std::string valueWords(const FieldValue& value) {
  struct Words {
    std::string operator()(double number) const { return plainNumber(number); }
    std::string operator()(const Vec3& v) const {
      return plainNumber(v.x) + ", " + plainNumber(v.y) + ", " + plainNumber(v.z);
    }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(const std::string& text) const { return text.empty() ? "none" : text; }
    std::string operator()(const std::vector<std::string>& texts) const {
      std::string all;
      for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + text;
      return all.empty() ? "none" : all;
    }
  };
  return std::visit(Words{}, value);
}

}  // namespace

FieldValue readField(JsonReader& item, const FieldShape& field) {
  const char* const key = field.row.key;
  switch (field.kind) {
    case FieldKind::number:
      return item.number(key, field.row.range);
    case FieldKind::whole:
      return double(item.integer(key, field.row.range));
    case FieldKind::three_numbers:
      return item.vec3(key, field.row.range);
    case FieldKind::direction:
      return item.direction(key);
    case FieldKind::flag:
      return item.boolean(key, false);
    case FieldKind::text:
    case FieldKind::reference:
      return item.text(key);
    case FieldKind::lines:
    case FieldKind::references:
      return item.texts(key, field.row.range.high > 0.0 ? std::size_t(field.row.range.high)
                                                        : kMostInAList);
    case FieldKind::choice: {
      const std::string name = item.text(key);
      if (isAmong(field.names, name)) return name;
      item.fail(key, noSuchChoice(name), useOneOf(field));
      return std::string(field.names.front());
    }
    case FieldKind::choices: {
      std::vector<std::string> names;
      for (const std::string& name : item.texts(key, kMostInAList)) {
        if (!isAmong(field.names, name)) {
          item.fail(key, noSuchChoice(name), useOneOf(field));
        } else if (std::ranges::find(names, name) != names.end()) {
          item.fail(key, tr("'{}' stands twice in the list", name), tr("Name each once"));
        } else {
          names.push_back(name);
        }
      }
      return names;
    }
  }
  return 0.0;
}

void writeField(Json& json, const FieldShape& field, const FieldValue& value) {
  struct Written {
    const FieldShape& field;
    Json operator()(double number) const {
      return field.kind == FieldKind::whole ? Json(std::int64_t(number)) : Json(number);
    }
    Json operator()(const Vec3& v) const { return {v.x, v.y, v.z}; }
    Json operator()(bool flag) const { return flag; }
    Json operator()(const std::string& text) const { return text; }
    Json operator()(const std::vector<std::string>& texts) const { return texts; }
  };
  const auto* const text = std::get_if<std::string>(&value);
  const auto* const texts = std::get_if<std::vector<std::string>>(&value);
  const bool empty = (text && text->empty()) || (texts && texts->empty());
  if (empty && field.row.given == Given::may_be) return;
  json[field.row.key] = std::visit(Written{field}, value);
}

Status checkNumber(const FieldRow& row, double value, const std::string& of) {
  if (row.range.holds(value)) return {};
  return Error{code::kImpossibleNumber,
               tr("The value {} must lie {}", plainNumber(value), row.range.words()),
               of + ": " + row.key, tr("Correct that value")};
}

Status checkField(const FieldShape& field, const FieldValue& value, const std::string& of) {
  if (!isNumber(field.kind)) return {};
  if (const auto* number = std::get_if<double>(&value)) {
    return checkNumber(field.row, *number, of);
  }
  const Vec3& three = std::get<Vec3>(value);
  for (int axis = 0; axis < 3; ++axis) {
    if (Status s = checkNumber(field.row, three[axis], of); !s) return s;
  }
  return {};
}

Result<FieldValue> parseField(const FieldShape& field, const std::string& text,
                              const std::string& where) {
  const auto bad = [&](const std::string& what, const std::string& next) {
    return Error{code::kBadArgument, what, where, next};
  };
  switch (field.kind) {
    case FieldKind::number:
    case FieldKind::whole: {
      double number = 0.0;
      const char* const end = text.data() + text.size();
      const auto [stop, error] = std::from_chars(text.data(), end, number);
      const bool whole = field.kind == FieldKind::whole;
      const bool read = error == std::errc() && stop == end && (!whole || number == std::floor(number));
      if (read && field.row.range.holds(number)) return FieldValue(number);
      return bad(tr("'{}' is no possible {}", text, field.row.key),
                 std::string(whole ? tr("Give a whole number ") : tr("Give a number ")) +
                     field.row.range.words());
    }
    case FieldKind::flag:
      if (text == "true" || text == "false") return FieldValue(text == "true");
      return bad(tr("'{}' is neither true nor false", text), tr("Give true or false"));
    case FieldKind::text:
    case FieldKind::reference:
      return FieldValue(text);
    case FieldKind::choice:
      if (isAmong(field.names, text)) return FieldValue(text);
      return bad(tr("There is no {} '{}'", field.row.key, text), useOneOf(field));
    default:
      return bad(tr("{} cannot be given here", field.row.key), tr("Set it in the file"));
  }
}

std::string wordsOf(const FieldRow& row) {
  std::string words = row.key;
  static constexpr std::string_view kUnits[] = {"mm", "N", "Hz", "hz", "W", "s", "m", "deg"};
  const std::size_t last = words.rfind('_');
  if (last != words.npos && isAmong(kUnits, std::string_view(words).substr(last + 1))) {
    words.erase(last);
  }
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string optionOf(const FieldRow& row) {
  std::string option = "--" + wordsOf(row);
  std::ranges::replace(option, ' ', '-');
  return option;
}

std::string schemaHead() {
  return "| of | key | type | range | unit | without it | meaning "
         "|\n|---|---|---|---|---|---|---|\n";
}

std::string schemaLine(std::string_view of, const FieldRow& row, std::string_view type,
                       const std::string& fallback) {
  const auto cell = [](std::string_view text) {
    return text.empty() ? std::string(" |") : " " + std::string(text) + " |";
  };
  const std::string range =
      type.ends_with("number") || type.ends_with("numbers")
          ? pageNumber(row.range.low) + " to " + pageNumber(row.range.high)
          : "";
  return "|" + cell(of) + cell("`" + std::string(row.key) + "`") + cell(type) + cell(range) +
         cell(row.range.unit) + cell(row.given == Given::always ? "refused" : fallback) +
         cell(row.meaning) + "\n";
}

std::string schemaLine(std::string_view of, const FieldShape& field, const FieldValue& fallback) {
  return schemaLine(of, field.row, typeWords(field), valueWords(fallback));
}

}  // namespace trephine
