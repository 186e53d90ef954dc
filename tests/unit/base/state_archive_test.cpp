#include "base/state_archive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace trephine {
namespace {

struct Inner {
  double number = 0.0;
  bool flag = false;
  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.number, self.flag);
  }
  bool operator==(const Inner&) const = default;
};
struct Nothing {
  bool operator==(const Nothing&) const = default;
};
struct Outer {
  std::vector<Inner> fixed{2}, grown;
  std::vector<int> many = std::vector<int>(8);
  std::size_t many_count = 0;
  std::optional<Pose> pose;
  std::variant<Nothing, Inner> one;
  std::array<Vec3, 2> places{};
  std::int8_t index = -1;
  int doubled = 0;  // follows from `index`

  Outer() { grown.reserve(4); }
  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.fixed);
    archive.grown(self.grown);
    archive.firstOf(self.many, self.many_count);
    archive(self.pose, self.one, self.places);
    archive.within(self.index, -1, 4);
    if constexpr (Archive::kReads) self.doubled = 2 * self.index;
  }
};

Outer filled() {
  Outer out;
  out.fixed = {{1.5, true}, {-0.0, false}};
  out.grown.push_back({std::numeric_limits<double>::infinity(), true});
  out.many = {1, 2, 3, 4, 5, 6, 7, 8};
  out.many_count = 3;
  out.pose = Pose{Vec3(1, 2, 3), Quat(0.5, 0.5, -0.5, 0.5)};
  out.one = Inner{7.0, true};
  out.places = {Vec3(1.0), Vec3(2.0)};
  out.index = 3;
  return out;
}

std::vector<std::byte> bytesOf(const Outer& value) {
  StateWriter writer;
  writer(value);
  return writer.bytes();
}

TEST(StateArchive, ReadsWhatItWrote) {
  const Outer from = filled();
  Outer to;
  to.one = Inner{};
  const std::vector<std::byte> bytes = bytesOf(from);
  StateReader reader(bytes);
  reader(to);
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader.atEnd());
  EXPECT_EQ(to.fixed, from.fixed);
  EXPECT_EQ(to.grown, from.grown);
  EXPECT_EQ(to.many_count, 3u);
  EXPECT_EQ(to.many, (std::vector<int>{1, 2, 3, 0, 0, 0, 0, 0})) << "the first alone";
  EXPECT_EQ(to.pose->position, from.pose->position);
  EXPECT_EQ(to.pose->orientation, from.pose->orientation);
  EXPECT_EQ(to.one, from.one);
  EXPECT_EQ(to.places, from.places);
  EXPECT_EQ(to.doubled, 6);
  EXPECT_EQ(bytesOf(to), bytes);
}

TEST(StateArchive, TakesAwayWhatIsNotThere) {
  const Outer empty;
  Outer to = filled();
  to.one = Nothing{};
  const std::vector<std::byte> bytes = bytesOf(empty);
  StateReader reader(bytes);
  reader(to);
  ASSERT_TRUE(reader.ok());
  EXPECT_FALSE(to.pose);
  EXPECT_TRUE(to.grown.empty());
  EXPECT_EQ(to.many_count, 0u);
}

bool reads(const Outer& from, Outer to) {
  to.grown.reserve(4);
  const std::vector<std::byte> bytes = bytesOf(from);
  StateReader reader(bytes);
  reader(to);
  return reader.ok();
}

TEST(StateArchive, RefusesWhatDoesNotFit) {
  Outer ready;
  ready.one = Inner{};
  ASSERT_TRUE(reads(filled(), ready));
  Outer other = ready;
  other.one = Nothing{};
  EXPECT_FALSE(reads(filled(), other)) << "another of the variant";
  other = ready;
  other.fixed.resize(3);
  EXPECT_FALSE(reads(filled(), other)) << "a vector of another size";
  other = ready;
  other.many.resize(2);
  EXPECT_FALSE(reads(filled(), other)) << "no room for the first";
  Outer many = filled();
  many.grown.resize(5);
  EXPECT_FALSE(reads(many, ready)) << "no room to grow";
  many = filled();
  many.index = 4;
  EXPECT_FALSE(reads(many, ready)) << "an index beyond its end";
  const std::vector<std::byte> bytes = bytesOf(filled());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    Outer to = ready;
    StateReader reader{std::span(bytes).first(length)};
    reader(to);
    ASSERT_FALSE(reader.ok()) << length;
  }
  std::vector<std::byte> flag = bytes;
  flag[sizeof(std::size_t) + sizeof(double)] = std::byte{2};
  Outer to = ready;
  StateReader reader(flag);
  reader(to);
  EXPECT_FALSE(reader.ok()) << "a flag that is neither true nor false";
}

TEST(StateArchive, OpensOnlyTheStateThatWasSealed) {
  StateWriter writer;
  const Outer value = filled();
  writer(value);
  const std::vector<std::byte> sealed = sealedState("test", 3, writer);
  const auto opened = openedState("test", 3, sealed);
  ASSERT_TRUE(opened);
  EXPECT_TRUE(std::ranges::equal(*opened, writer.bytes()));
  const auto refused = [](const auto& result) {
    return !result && result.error().code.str() == "BAD_STATE";
  };
  EXPECT_TRUE(refused(openedState("tests", 3, sealed)));
  EXPECT_TRUE(refused(openedState("test", 4, sealed)));
  for (std::size_t length = 0; length < sealed.size(); ++length) {
    ASSERT_TRUE(refused(openedState("test", 3, std::span(sealed).first(length)))) << length;
  }
  std::vector<std::byte> other = sealed;
  other.push_back(std::byte{});
  EXPECT_TRUE(refused(openedState("test", 3, other)));
  for (std::size_t at = 0; at < sealed.size(); ++at) {
    other = sealed;
    other[at] ^= std::byte{4};
    ASSERT_TRUE(refused(openedState("test", 3, other))) << at;
  }
}

}  // namespace
}  // namespace trephine
