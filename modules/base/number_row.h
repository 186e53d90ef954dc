// A number of a file in one row: its name in JSON, what it may be, what holds where a file lacks
// it, and what it means to people. Reading, writing, checks, panels and the tables of the schema
// pages come from the rows of a room, so that a number is added in one place.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "base/json.h"
#include "base/math.h"
#include "base/range.h"
#include "base/result.h"

namespace trephine {

enum class Given { always, may_be };

struct NumberRow {
  const char* key;      // in JSON and recordings
  Range range;          // with its unit; of three numbers each
  Given given;          // in a file
  const char* meaning;  // Markdown: a cell of a schema page
};

// The row of a member of `Owner`. Where a file lacks a number that may be given, it is as a fresh
// Owner has it.
template <class Owner>
struct NumberOf {
  NumberRow row;
  std::variant<double Owner::*, int Owner::*, std::uint32_t Owner::*, Vec3 Owner::*> member;
};

// Every row's number of `item`; a number that may be given and is not stays as `owner` has it.
template <class Owner>
void readNumbers(JsonReader& item, std::type_identity_t<std::span<const NumberOf<Owner>>> rows,
                 Owner& owner) {
  for (const NumberOf<Owner>& number : rows) {
    const auto& [key, range, given, meaning] = number.row;
    if (given == Given::may_be && !item.has(key)) continue;
    std::visit(
        [&, key = key, range = range](auto member) {
          auto& value = owner.*member;
          using Value = std::remove_cvref_t<decltype(value)>;
          if constexpr (std::is_same_v<Value, Vec3>) {
            value = item.vec3(key, range);
          } else if constexpr (std::is_integral_v<Value>) {
            value = Value(item.integer(key, range));
          } else {
            value = item.number(key, range);
          }
        },
        number.member);
  }
}

template <class Owner>
void writeNumbers(Json& json, std::type_identity_t<std::span<const NumberOf<Owner>>> rows,
                  const Owner& owner) {
  for (const NumberOf<Owner>& number : rows) {
    std::visit(
        [&](auto member) {
          const auto& value = owner.*member;
          if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, Vec3>) {
            json[number.row.key] = {value.x, value.y, value.z};
          } else {
            json[number.row.key] = value;
          }
        },
        number.member);
  }
}

// IMPOSSIBLE_NUMBER for the first number of a value made in code that lies out of its range; `of`
// says whose it is.
Status checkNumber(const NumberRow& row, double value, const std::string& of);

template <class Owner>
Status checkNumbers(std::type_identity_t<std::span<const NumberOf<Owner>>> rows, const Owner& owner,
                    const std::string& of) {
  for (const NumberOf<Owner>& number : rows) {
    const auto check = [&](auto member) -> Status {
      const auto& value = owner.*member;
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, Vec3>) {
        for (int axis = 0; axis < 3; ++axis) {
          if (Status s = checkNumber(number.row, value[axis], of); !s) return s;
        }
        return {};
      } else {
        return checkNumber(number.row, double(value), of);
      }
    };
    if (Status status = std::visit(check, number.member); !status) return status;
  }
  return {};
}

// Schema pages: tables of Markdown. A line a row; `type` such as "number", `fallback` what holds
// where the file lacks it, empty where it must be given.
std::string schemaHead();
std::string schemaLine(std::string_view of, const NumberRow& row, std::string_view type,
                       const std::string& fallback);

template <class Owner>
std::string schemaLines(std::string_view of,
                        std::type_identity_t<std::span<const NumberOf<Owner>>> rows) {
  static const Owner fresh{};
  std::string lines;
  for (const NumberOf<Owner>& number : rows) {
    const auto line = [&](auto member) {
      const auto& value = fresh.*member;
      using Value = std::remove_cvref_t<decltype(value)>;
      const char* const type = std::is_same_v<Value, Vec3> ? "three numbers"
                               : std::is_integral_v<Value> ? "whole number"
                                                           : "number";
      std::string fallback;
      if constexpr (std::is_same_v<Value, Vec3>) {
        fallback = plainNumber(value.x) + ", " + plainNumber(value.y) + ", " + plainNumber(value.z);
      } else {
        fallback = plainNumber(double(value));
      }
      return schemaLine(of, number.row, type, fallback);
    };
    lines += std::visit(line, number.member);
  }
  return lines;
}

}  // namespace trephine
