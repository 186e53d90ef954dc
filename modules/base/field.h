// A setting of a file in one row: its name in JSON, what it may be, what holds where a file lacks
// it, and what it means to people. Reading, writing, checks, forms, options of a command line and
// the tables of the schema pages come from the rows of a room, so that a setting is added in one
// place. Pure; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/json.h"
#include "base/math.h"
#include "base/range.h"
#include "base/result.h"

namespace trephine {

enum class Given { always, may_be };

struct FieldRow {
  const char* key;      // in JSON and recordings
  Range range;          // of a number, with its unit, of three numbers each; of a text or list, how
                        // long a form lets it be
  Given given;          // in a file
  const char* meaning;  // Markdown: a cell of a schema page
  const char* label = "";  // on a form; empty: the key in words
  const char* help = "";   // below the field of a form; empty: the meaning's first clause
  const char* lock = "";   // the lock that keeps it while an exercise is practised; empty: none
  // Of a number on a form: its step, 0 as its unit has one; its decimals, below 0 as its kind has
  // them; and the unit that it is shown in, of which `shown_per` make one of the range's.
  double step = 0.0;
  int decimals = -1;
  const char* shown_unit = "";
  double shown_per = 1.0;
  int lines = 1;  // over which a text is shown on a form
};

// What a field is to a file and to a form.
enum class FieldKind {
  number,
  whole,          // number
  three_numbers,
  direction,      // three numbers of which a unit vector is made
  flag,           // true or false
  text,           // one line
  lines,          // a list of texts, one a line
  reference,      // a text: the name of something else in the document
  references,     // a list of such names
  choice,         // one of a few names
  choices,        // a list of some of a few names, each once
};
using FieldValue = std::variant<double, Vec3, bool, std::string, std::vector<std::string>>;

// Ways to a member of `Owner` for which its type alone does not say the kind.
template <class Owner>
struct DirectionIn {
  Vec3 Owner::*member;
};
template <class Owner>
struct ReferenceIn {
  std::string Owner::*member;
};
template <class Owner>
struct ReferencesIn {
  std::vector<std::string> Owner::*member;
};
template <class Owner>
struct OneOf {
  std::span<const std::string_view> names;
  std::size_t (*get)(const Owner&);  // place in `names`
  void (*set)(Owner&, std::size_t);
};
template <class Owner>
struct SomeOf {
  std::span<const std::string_view> names;
  std::vector<std::size_t> (*get)(const Owner&);
  void (*set)(Owner&, const std::vector<std::size_t>&);
};
template <class Owner>
using FieldMember =
    std::variant<double Owner::*, int Owner::*, std::uint32_t Owner::*, Vec3 Owner::*,
                 DirectionIn<Owner>, bool Owner::*, std::string Owner::*,
                 std::vector<std::string> Owner::*, ReferenceIn<Owner>, ReferencesIn<Owner>,
                 OneOf<Owner>, SomeOf<Owner>>;

// A row of which only some owners have the field: `of` names them on a schema page.
template <class Owner>
struct FieldOnlyIf {
  const char* of = "";
  bool (*applies)(const Owner&) = nullptr;
};

// The row of a member of `Owner`. Where a file lacks a field that may be given, it is as a fresh
// Owner has it.
template <class Owner>
struct FieldOf {
  FieldRow row;
  FieldMember<Owner> member;
  FieldOnlyIf<Owner> only_if{};

  bool appliesTo(const Owner& owner) const { return !only_if.applies || only_if.applies(owner); }
};
template <class Owner>
using FieldsOf = std::span<const FieldOf<Owner>>;

namespace detail {
template <class Member>
struct MemberTypes;
template <class Owner, class Value>
struct MemberTypes<Value Owner::*> {
  using OwnerType = Owner;
  using ValueType = Value;
};
template <auto Member>
using OwnerOf = typename MemberTypes<decltype(Member)>::OwnerType;
template <auto Member>
using ValueOf = typename MemberTypes<decltype(Member)>::ValueType;

template <const auto& kNames>
inline constexpr auto kNamesAlone = [] {
  std::array<std::string_view, kNames.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kNames[i].first;
  return names;
}();
template <const auto& kNames, class Kind>
std::size_t placeOf(Kind kind) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i].second == kind) return i;
  }
  return 0;
}
}  // namespace detail

// A member of an enumeration, by a table of pairs (name, kind).
template <auto Member, const auto& kNames>
constexpr auto oneOf() {
  using Owner = detail::OwnerOf<Member>;
  return OneOf<Owner>{
      detail::kNamesAlone<kNames>,
      [](const Owner& owner) { return detail::placeOf<kNames>(owner.*Member); },
      [](Owner& owner, std::size_t place) { owner.*Member = kNames[place].second; }};
}
// A list or set of such kinds; a list keeps its order.
template <auto Member, const auto& kNames>
constexpr auto someOf() {
  using Owner = detail::OwnerOf<Member>;
  return SomeOf<Owner>{detail::kNamesAlone<kNames>,
                       [](const Owner& owner) {
                         std::vector<std::size_t> places;
                         for (const auto kind : owner.*Member) {
                           places.push_back(detail::placeOf<kNames>(kind));
                         }
                         return places;
                       },
                       [](Owner& owner, const std::vector<std::size_t>& places) {
                         detail::ValueOf<Member> kinds;
                         for (const std::size_t place : places) {
                           kinds.insert(kinds.end(), kNames[place].second);
                         }
                         owner.*Member = std::move(kinds);
                       }};
}

// The row without its owner's type.
struct FieldShape {
  FieldRow row;
  FieldKind kind = FieldKind::number;
  std::span<const std::string_view> names;  // of choices
};
template <class Owner>
FieldShape shapeOf(const FieldOf<Owner>& field) {
  static constexpr FieldKind kKinds[] = {
      FieldKind::number,    FieldKind::whole, FieldKind::whole, FieldKind::three_numbers,
      FieldKind::direction, FieldKind::flag,  FieldKind::text,  FieldKind::lines,
      FieldKind::reference, FieldKind::references, FieldKind::choice, FieldKind::choices};
  static_assert(std::size(kKinds) == std::variant_size_v<FieldMember<Owner>>);
  FieldShape shape{field.row, kKinds[field.member.index()], {}};
  if (const auto* one = std::get_if<OneOf<Owner>>(&field.member)) shape.names = one->names;
  if (const auto* some = std::get_if<SomeOf<Owner>>(&field.member)) shape.names = some->names;
  return shape;
}

template <class Owner>
FieldValue valueOf(const FieldOf<Owner>& field, const Owner& owner) {
  const auto value = [&](const auto& member) -> FieldValue {
    using Member = std::remove_cvref_t<decltype(member)>;
    if constexpr (std::is_same_v<Member, OneOf<Owner>>) {
      return std::string(member.names[member.get(owner)]);
    } else if constexpr (std::is_same_v<Member, SomeOf<Owner>>) {
      std::vector<std::string> names;
      for (const std::size_t place : member.get(owner)) names.emplace_back(member.names[place]);
      return names;
    } else if constexpr (std::is_member_pointer_v<Member>) {
      using Value = std::remove_cvref_t<decltype(owner.*member)>;
      if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
        return double(owner.*member);
      } else {
        return owner.*member;
      }
    } else {
      return owner.*member.member;
    }
  };
  return std::visit(value, field.member);
}

// `value` is of the field's kind; a name that is not among its choices is left out.
template <class Owner>
void setValue(const FieldOf<Owner>& field, Owner& owner, const FieldValue& value) {
  const auto set = [&](const auto& member) {
    using Member = std::remove_cvref_t<decltype(member)>;
    const auto placeIn = [&](const std::string& name) {
      std::size_t place = 0;
      if constexpr (requires { member.names; }) {
        while (place < member.names.size() && member.names[place] != name) ++place;
        if (place == member.names.size()) place = std::string::npos;
      }
      return place;
    };
    if constexpr (std::is_same_v<Member, OneOf<Owner>>) {
      const std::size_t place = placeIn(std::get<std::string>(value));
      if (place != std::string::npos) member.set(owner, place);
    } else if constexpr (std::is_same_v<Member, SomeOf<Owner>>) {
      std::vector<std::size_t> places;
      for (const std::string& name : std::get<std::vector<std::string>>(value)) {
        if (const std::size_t place = placeIn(name); place != std::string::npos) {
          places.push_back(place);
        }
      }
      member.set(owner, places);
    } else if constexpr (std::is_member_pointer_v<Member>) {
      using Value = std::remove_cvref_t<decltype(owner.*member)>;
      if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
        owner.*member = Value(std::get<double>(value));
      } else {
        owner.*member = std::get<Value>(value);
      }
    } else {
      using Value = std::remove_cvref_t<decltype(owner.*member.member)>;
      owner.*member.member = std::get<Value>(value);
    }
  };
  std::visit(set, field.member);
}

// --- Files ---

// What is wrong is told to the reader, and the value is then one that the field can have.
FieldValue readField(JsonReader& item, const FieldShape& field);
void writeField(Json& json, const FieldShape& field, const FieldValue& value);

// Every field that applies to `owner` as it is after those before it; one that may be given and is
// not stays as it is.
template <class Owner>
void readFields(JsonReader& item, std::type_identity_t<FieldsOf<Owner>> fields, Owner& owner) {
  for (const FieldOf<Owner>& field : fields) {
    if (!field.appliesTo(owner)) continue;
    if (field.row.given == Given::may_be && !item.has(field.row.key)) continue;
    setValue(field, owner, readField(item, shapeOf(field)));
  }
}

// A text or a list that may be given and is empty is not written.
template <class Owner>
void writeFields(Json& json, std::type_identity_t<FieldsOf<Owner>> fields, const Owner& owner) {
  for (const FieldOf<Owner>& field : fields) {
    if (field.appliesTo(owner)) writeField(json, shapeOf(field), valueOf(field, owner));
  }
}

// --- Values made in code, and options of a command line ---

// IMPOSSIBLE_NUMBER for a number out of its range; `of` says whose it is.
Status checkNumber(const FieldRow& row, double value, const std::string& of);
// The same for every number of a field.
Status checkField(const FieldShape& field, const FieldValue& value, const std::string& of);

template <class Owner>
Status checkFields(std::type_identity_t<FieldsOf<Owner>> fields, const Owner& owner,
                   const std::string& of) {
  for (const FieldOf<Owner>& field : fields) {
    if (!field.appliesTo(owner)) continue;
    if (Status s = checkField(shapeOf(field), valueOf(field, owner), of); !s) return s;
  }
  return {};
}

// `text` as a value of a field that is a number, a flag, a text or a choice. BAD_ARGUMENT with
// `where` for anything else, a number out of its range and a name that is none of its choices.
Result<FieldValue> parseField(const FieldShape& field, const std::string& text,
                              const std::string& where);

// "motion scale" of "motion_scale": without the unit at its end.
std::string wordsOf(const FieldRow& row);
// "--motion-scale" of it.
std::string optionOf(const FieldRow& row);

// --- Schema pages: tables of Markdown ---

std::string schemaHead();
// Of a number; `type` such as "number". `fallback`: what holds where a file lacks it.
std::string schemaLine(std::string_view of, const FieldRow& row, std::string_view type,
                       const std::string& fallback);
std::string schemaLine(std::string_view of, const FieldShape& field, const FieldValue& fallback);

template <class Owner>
std::string schemaLines(std::string_view of, std::type_identity_t<FieldsOf<Owner>> fields) {
  static const Owner fresh{};
  std::string lines;
  for (const FieldOf<Owner>& field : fields) {
    lines += schemaLine(*field.only_if.of ? std::string_view(field.only_if.of) : of,
                        shapeOf(field), valueOf(field, fresh));
  }
  return lines;
}

}  // namespace trephine
