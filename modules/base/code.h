// What an error, a warning, a finding or a choice is to a program: one of the constants that the
// rooms declare in their `codes.h`. A program compares constants, so that a code that is not
// declared does not compile; a person, a file and a command line see its name. Any thread.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace trephine {

class Code {
 public:
  static constexpr std::size_t kLongest = 31;  // bytes of a name

  constexpr Code() = default;  // none: its name is empty
  // `name`: stable, upper case with underscores (MISSING_FOLDER).
  consteval explicit Code(const char* name) { take(name); }
  // The code that a file or another program names; a name that is too long is cut.
  static constexpr Code named(std::string_view name) {
    Code code;
    code.take(name.substr(0, kLongest));
    return code;
  }

  const char* c_str() const { return name_.data(); }
  std::string str() const { return name_.data(); }
  bool empty() const { return name_[0] == 0; }

  friend constexpr auto operator<=>(const Code&, const Code&) = default;

 private:
  constexpr void take(std::string_view name) { std::ranges::copy(name, name_.begin()); }

  std::array<char, kLongest + 1> name_{};  // ends with 0
};

// The names of codes, in their order, for a file or a sentence.
template <class Codes>
std::vector<std::string> namesOf(const Codes& codes) {
  std::vector<std::string> names;
  for (const Code& code : codes) names.push_back(code.str());
  return names;
}

}  // namespace trephine
