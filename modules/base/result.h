// Result<T>: a value, or an Error that a person can act on. Nothing in the product throws across a
// function that returns one of these.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "base/code.h"

namespace trephine {

// One clear sentence in four parts. `code` is for programs; `what` says what went wrong, `where`
// names file, field or part, `next` says what to do.
struct Error {
  Code code;
  std::string what;
  std::string where;
  std::string next;

  // All of it in one line, also where a file's name or a file's own words hold line breaks.
  std::string sentence() const;
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T result) : state_(std::in_place_index<0>, std::move(result)) {}
  Result(Error why) : state_(std::in_place_index<1>, std::move(why)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

// What a person should know of something that went on all the same. `code` as of an Error, `text` a
// sentence.
struct Warning {
  Code code;
  std::string text;
};

// Success, or an Error.
class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(Error why) : error_(std::move(why)) {}
  bool ok() const { return !error_; }
  explicit operator bool() const { return ok(); }
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

}  // namespace trephine
