// The state of a program as bytes, and back: one function in each type, for both ways.
//
//   template <class Self, class Archive>
//   static void visitState(Self& self, Archive& archive) { archive(self.one_, self.other_); }
//
// It names every member that one call leaves for a later one, and none that is written anew before
// it is read. After them, where `Archive::kReads`, it computes anew what follows from them. A type
// without members needs none.
//
// The bytes are those of this machine (little-endian, IEEE 754) and of one version: they go to
// another process of the same release. An archive is for one thread; bad bytes are said by ok(),
// not thrown; it allocates, so it is not for the haptic tick.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/math.h"
#include "base/result.h"

namespace trephine {

static_assert(std::endian::native == std::endian::little);

namespace detail {
template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;
}  // namespace detail

// What writing and reading have in common; `To` is the one that does it. Of each value:
//   scalars, Vec3, Quat, Pose, arrays, optionals: their parts; an enumeration is not checked for
//   its range: within() does that;
//   vectors: as many as there are, which on reading must be as many as there are already;
//   variants: what they hold, which on reading must be what they hold already.
template <class To>
class StateVisitor {
 public:
  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }

 private:
  To& to() { return static_cast<To&>(*this); }

  template <class T>
  void one(T& value) {
    using Type = std::remove_const_t<T>;
    if constexpr (requires { Type::visitState(value, to()); }) {
      Type::visitState(value, to());
    } else if constexpr (detail::Scalar<Type>) {
      to().scalar(value);
    } else {
      static_assert(std::is_empty_v<Type>, "a state needs its visitState()");
    }
  }
  template <class T>
  requires std::is_same_v<std::remove_const_t<T>, Vec3>
  void one(T& v) { (*this)(v.x, v.y, v.z); }
  template <class T>
  requires std::is_same_v<std::remove_const_t<T>, Quat>
  void one(T& q) { (*this)(q.w, q.x, q.y, q.z); }
  template <class T>
  requires std::is_same_v<std::remove_const_t<T>, Pose>
  void one(T& pose) { (*this)(pose.position, pose.orientation); }
  template <class T, std::size_t N>
  void one(std::array<T, N>& values) {
    for (T& value : values) one(value);
  }
  template <class T, std::size_t N>
  void one(const std::array<T, N>& values) {
    for (const T& value : values) one(value);
  }
  template <class T, std::size_t N>
  void one(T (&values)[N]) {
    for (T& value : values) one(value);
  }
  template <class T>
  void one(std::vector<T>& values) {
    to().same(values.size());
    for (T& value : values) one(value);
  }
  template <class T>
  void one(const std::vector<T>& values) {
    to().same(values.size());
    for (const T& value : values) one(value);
  }
  template <class... T>
  void one(std::variant<T...>& value) {
    to().same(value.index());
    std::visit([this](auto& held) { one(held); }, value);
  }
  template <class... T>
  void one(const std::variant<T...>& value) {
    to().same(value.index());
    std::visit([this](auto& held) { one(held); }, value);
  }
  template <class T>
  void one(std::optional<T>& value) {
    bool there = value.has_value();
    one(there);
    if (there && !value) value.emplace();
    if (!there) value.reset();
    if (value) one(*value);
  }
  template <class T>
  void one(const std::optional<T>& value) {
    to().scalar(value.has_value());
    if (value) one(*value);
  }
};

class StateWriter : public StateVisitor<StateWriter> {
 public:
  static constexpr bool kReads = false;

  template <detail::Scalar T>
  void scalar(const T& value) {
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
  }
  // What a reader must have already.
  template <detail::Scalar T>
  void same(const T& value) {
    scalar(value);
  }
  // A whole number from `low` on, below `end`.
  template <detail::Scalar T>
  void within(const T& value, std::int64_t /*low*/, std::int64_t /*end*/) {
    scalar(value);
  }
  // The first `count` of `values`, which has as many at least; a reader must have room for them,
  // and gets their number.
  template <class T>
  void firstOf(const std::vector<T>& values, const std::size_t& count) {
    scalar(count);
    for (std::size_t n = 0; n < count; ++n) (*this)(values[n]);
  }
  // A vector that has as many values as there are, and never more than it has room for.
  template <class T>
  void grown(const std::vector<T>& values) {
    firstOf(values, values.size());
  }

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

// The caller asks ok() and atEnd() at the end. Where one is false the object is partly overwritten,
// each member in range as far as the visited types say: it may be destroyed or read anew, but not
// used.
class StateReader : public StateVisitor<StateReader> {
 public:
  static constexpr bool kReads = true;

  explicit StateReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <detail::Scalar T>
  void scalar(T& value) {
    if (!ok_ || bytes_.size() < sizeof(T)) return refuse();
    if constexpr (std::is_same_v<T, bool>) {
      if (std::to_integer<unsigned>(bytes_[0]) > 1u) return refuse();
    }
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
  }
  template <detail::Scalar T>
  void same(const T& value) {
    T read{};
    scalar(read);
    if (read != value) refuse();
  }
  template <detail::Scalar T>
  void within(T& value, std::int64_t low, std::int64_t end) {
    T read{};
    scalar(read);
    if (std::int64_t(read) < low || std::int64_t(read) >= end) return refuse();
    value = read;
  }
  template <class T>
  void firstOf(std::vector<T>& values, std::size_t& count) {
    std::size_t read = 0;
    scalar(read);
    if (read > values.size()) return refuse();
    count = read;
    for (std::size_t n = 0; n < count && ok_; ++n) (*this)(values[n]);
  }
  template <class T>
  void grown(std::vector<T>& values) {
    std::size_t count = 0;
    scalar(count);
    if (count > values.capacity()) return refuse();
    values.resize(count);
    for (std::size_t n = 0; n < count && ok_; ++n) (*this)(values[n]);
  }

  // The bytes are not such a state; for what a type knows of itself beside the above.
  void refuse() { ok_ = false; }
  bool ok() const { return ok_; }
  bool atEnd() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
  bool ok_ = true;
};

// A state with a head: what it is of (`kind`; what is beyond 8 letters is cut), its version, its
// length and its SHA-256, which finds damage and not forgery. `version` is the kind's own number:
// raise it when any visitState() below names other members or another order.
std::vector<std::byte> sealedState(std::string_view kind, std::uint32_t version,
                                   const StateWriter& state);
// The state in it: the span lies in `sealed`. Errors: BAD_STATE for what is none of this kind, of
// another version, shorter or longer than it says, or not as it was written.
Result<std::span<const std::byte>> openedState(std::string_view kind, std::uint32_t version,
                                               std::span<const std::byte> sealed);

}  // namespace trephine
