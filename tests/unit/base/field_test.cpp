#include "base/field.h"

#include <gtest/gtest.h>

namespace trephine {
namespace {

enum class Shape { ball, rod };
constexpr std::array<std::pair<std::string_view, Shape>, 2> kShapes{
    {{"ball", Shape::ball}, {"rod", Shape::rod}}};

struct Thing {
  double length_mm = 2.5;
  int points = 4;
  Vec3 place_mm{1, 2, 3};
  Vec3 towards{0, 0, 1};
  bool closed = true;
  std::string name = "thing";
  std::vector<std::string> steps{"first", "then"};
  std::string landmark = "vault";
  std::vector<std::string> tools{"burr"};
  Shape shape = Shape::rod;
  std::vector<Shape> shapes{Shape::rod, Shape::ball};
  double rod_mm = 7.0;
  bool operator==(const Thing&) const = default;
};

bool isRod(const Thing& thing) { return thing.shape == Shape::rod; }

constexpr FieldOf<Thing> kFields[] = {
    {{"length_mm", {0, 10, "mm"}, Given::may_be, "how long"}, &Thing::length_mm},
    {{"points", {1, 9}, Given::may_be, "how many"}, &Thing::points},
    {{"place_mm", {-5, 5, "mm"}, Given::may_be, "where"}, &Thing::place_mm},
    {{"towards", {-1, 1}, Given::may_be, "which way"}, DirectionIn<Thing>{&Thing::towards}},
    {{"closed", {}, Given::may_be, "whether"}, &Thing::closed},
    {{"name", {}, Given::always, "shown"}, &Thing::name},
    {{"steps", {1, 3}, Given::may_be, "in their order"}, &Thing::steps},
    {{"landmark", {}, Given::may_be, "of it"}, ReferenceIn<Thing>{&Thing::landmark}},
    {{"tools", {}, Given::may_be, "with it"}, ReferencesIn<Thing>{&Thing::tools}},
    {{"shape", {}, Given::may_be, "of it", "", "", "looks"}, oneOf<&Thing::shape, kShapes>()},
    {{"shapes", {}, Given::may_be, "also"}, someOf<&Thing::shapes, kShapes>()},
    {{"rod_mm", {0, 10, "mm"}, Given::always, "of a rod"}, &Thing::rod_mm, {"rod", isRod}},
};
constexpr FieldsOf<Thing> kAll = kFields;

const FieldOf<Thing>& field(std::string_view key) {
  return *std::find_if(kAll.begin(), kAll.end(),
                       [&](const auto& of) { return of.row.key == key; });
}

Result<Thing> read(const Json& json) {
  JsonReader reader(json, "a file");
  Thing thing;
  readFields(reader, kFields, thing);
  if (Status status = reader.finish(); !status) return status.error();
  return thing;
}

Json written(const Thing& thing) {
  Json json;
  writeFields(json, kFields, thing);
  return json;
}

TEST(Field, OfEveryKindIsReadAsItWasWritten) {
  Thing thing;
  thing.length_mm = 0.1 + 0.2;
  thing.points = 9;
  thing.place_mm = {-1.5, 0, 5};
  thing.towards = {0, -1, 0};
  thing.closed = false;
  thing.name = "another";
  thing.steps = {"one"};
  thing.landmark = "ear";
  thing.tools = {"blade", "needle"};
  thing.shape = Shape::ball;
  thing.shapes = {Shape::ball, Shape::rod};
  const Result<Thing> again = read(written(thing));
  ASSERT_TRUE(again.ok()) << again.error().sentence();
  EXPECT_EQ(*again, thing);
  EXPECT_TRUE(written(thing)["points"].is_number_integer());
}

TEST(Field, ThatMayBeLackingIsThenAsAFreshOwnerHasIt) {
  const Result<Thing> thing = read({{"name", "thing"}, {"rod_mm", 7}});
  ASSERT_TRUE(thing.ok()) << thing.error().sentence();
  EXPECT_EQ(*thing, Thing{});
}

TEST(Field, ThatMustBeThereIsMissedByName) {
  const Result<Thing> thing = read({{"rod_mm", 7}});
  ASSERT_FALSE(thing.ok());
  EXPECT_NE(thing.error().where.find("name"), std::string::npos);
}

TEST(Field, WithAnImpossibleValueIsRefusedByName) {
  const std::pair<const char*, Json> bad[] = {
      {"length_mm", 11},          {"length_mm", "long"}, {"points", 2.5},
      {"points", 0},              {"place_mm", {0, 6, 0}}, {"towards", {0, 0, 0}},
      {"closed", "yes"},          {"name", 3},           {"steps", {"1", "2", "3", "4"}},
      {"landmark", Json::array()}, {"tools", "burr"},     {"shape", "cube"},
      {"shapes", {"rod", "cube"}}, {"shapes", {"rod", "rod"}}};
  for (const auto& [key, value] : bad) {
    Json json = written(Thing{});
    json[key] = value;
    const Result<Thing> thing = read(json);
    ASSERT_FALSE(thing.ok()) << key << " " << value.dump();
    EXPECT_NE(thing.error().where.find(key), std::string::npos) << thing.error().sentence();
  }
}

TEST(Field, ThatOnlySomeOwnersHaveIsNeitherReadNorWrittenOfOthers) {
  Thing ball;
  ball.shape = Shape::ball;
  EXPECT_FALSE(written(ball).contains("rod_mm"));
  EXPECT_TRUE(read(written(ball)).ok());
  Json json = written(ball);
  json["rod_mm"] = 3;
  EXPECT_FALSE(read(json).ok()) << "a ball has none";
}

TEST(Field, ATextOrListThatMayBeLackingAndIsEmptyIsNotWritten) {
  Thing thing;
  thing.landmark.clear();
  thing.tools.clear();
  thing.name.clear();
  const Json json = written(thing);
  EXPECT_FALSE(json.contains("landmark") || json.contains("tools"));
  EXPECT_TRUE(json.contains("name"));
}

TEST(Field, MadeInCodeIsHeldToItsRange) {
  Thing thing;
  EXPECT_TRUE(checkFields<Thing>(kFields, thing, "it").ok());
  thing.place_mm.y = 5.1;
  const Status far = checkFields<Thing>(kFields, thing, "it");
  ASSERT_FALSE(far.ok());
  EXPECT_EQ(far.error().where, "it: place_mm");
  thing = {};
  thing.rod_mm = -1.0;
  EXPECT_FALSE(checkFields<Thing>(kFields, thing, "it").ok());
  thing.shape = Shape::ball;
  EXPECT_TRUE(checkFields<Thing>(kFields, thing, "it").ok()) << "a ball has none";
}

TEST(Field, IsReadFromTheTextOfAnOption) {
  Thing thing;
  const std::pair<const char*, const char*> good[] = {
      {"length_mm", "1e-3"}, {"points", "9"}, {"closed", "false"}, {"name", "x"}, {"shape", "ball"}};
  for (const auto& [key, text] : good) {
    const Result<FieldValue> value = parseField(shapeOf(field(key)), text, "--x");
    ASSERT_TRUE(value.ok()) << value.error().sentence();
    setValue(field(key), thing, *value);
  }
  EXPECT_EQ(thing.length_mm, 1e-3);
  EXPECT_EQ(thing.points, 9);
  EXPECT_FALSE(thing.closed);
  EXPECT_EQ(thing.name, "x");
  EXPECT_EQ(thing.shape, Shape::ball);
  const std::pair<const char*, const char*> bad[] = {
      {"length_mm", "11"}, {"length_mm", "1 mm"}, {"length_mm", "nan"}, {"length_mm", ""},
      {"points", "2.5"},   {"closed", "no"},      {"shape", "cube"},    {"place_mm", "1"}};
  for (const auto& [key, text] : bad) {
    const Result<FieldValue> value = parseField(shapeOf(field(key)), text, "--x");
    ASSERT_FALSE(value.ok()) << key << " " << text;
    EXPECT_EQ(value.error().code.str(), "BAD_ARGUMENT");
    EXPECT_EQ(value.error().where, "--x");
  }
}

TEST(Field, IsCalledByItsKeyWithoutTheUnit) {
  EXPECT_EQ(wordsOf(field("rod_mm").row), "rod");
  EXPECT_EQ(wordsOf(field("landmark").row), "landmark");
  EXPECT_EQ(optionOf(field("length_mm").row), "--length");
}

TEST(Field, StandsOnASchemaPageWithAllThatItMayBe) {
  const std::string page = schemaLines<Thing>("thing", kFields);
  for (const char* line :
       {"| thing | `length_mm` | number | 0 to 10 | mm | 2.5 | how long |\n",
        "| thing | `points` | whole number | 1 to 9 | | 4 | how many |\n",
        "| thing | `place_mm` | three numbers | -5 to 5 | mm | 1, 2, 3 | where |\n",
        "| thing | `towards` | direction | | | 0, 0, 1 | which way |\n",
        "| thing | `closed` | true or false | | | true | whether |\n",
        "| thing | `name` | text | | | refused | shown |\n",
        "| thing | `steps` | list of texts | | | first, then | in their order |\n",
        "| thing | `shape` | `ball`, `rod` | | | rod | of it |\n",
        "| thing | `shapes` | list of `ball`, `rod` | | | rod, ball | also |\n",
        "| rod | `rod_mm` | number | 0 to 10 | mm | refused | of a rod |\n"}) {
    EXPECT_NE(page.find(line), std::string::npos) << line << page;
  }
}

}  // namespace
}  // namespace trephine
