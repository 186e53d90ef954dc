#include "json_mutator.h"

#include <limits>
#include <random>
#include <vector>

#include "base/json.h"

namespace trephine::fuzz {

namespace {

class Mutator {
 public:
  explicit Mutator(std::uint32_t seed) : random_(seed) {}

  int below(std::size_t count) { return int(random_() % count); }

  void change(Json& root) {
    places_.clear();
    collect(root);
    Json& place = *places_[std::size_t(below(places_.size()))];
    switch (below(10)) {
      case 0:
      case 1:
      case 2:
        place = place.is_string() ? Json(text()) : number(place);
        break;
      case 3:  // another's value
        place = Json(*places_[std::size_t(below(places_.size()))]);
        break;
      case 4:  // one less
        if (place.is_structured() && !place.empty()) {
          place.erase(std::next(place.begin(), below(place.size())));
        }
        break;
      case 5:  // one twice
        if (place.is_array() && !place.empty() && place.size() < 1000) {
          place.push_back(Json(place[std::size_t(below(place.size()))]));
        }
        break;
      case 6:  // another type
        place = Json::array({nullptr, true, 7, "x", Json::array(), Json::object()})[below(6)];
        break;
      case 8:  // a long list
        if (place.is_array()) {
          const Json one = place.empty() ? Json(7) : Json(place[std::size_t(below(place.size()))]);
          const int count = 200 + below(3000);
          for (int n = 0; n < count; ++n) place.push_back(one);
        }
        break;
      case 9:  // many members
        if (place.is_object()) {
          const int count = 100 + below(2000);
          for (int n = 0; n < count; ++n) place["f" + std::to_string(n)] = n;
        }
        break;
      case 7:  // an unknown or a known field
        if (place.is_object()) place[kFields[below(std::size(kFields))]] = number(Json(1.0));
        break;
    }
  }

 private:
  static constexpr const char* kFields[] = {"x",        "vanish_after_s", "bulk_radius_mm",
                                            "label",    "centre_mm",      "dynamics",
                                            "commands", "rupture_N",      "to_s"};

  void collect(Json& value) {
    places_.push_back(&value);
    if (!value.is_structured()) return;
    for (Json& part : value) collect(part);
  }

  Json number(const Json& before) {
    constexpr double kOdd[] = {0.0,   -0.0,    1e-308, -1e-308, 1e-9, 1e308,  -1e308, 1e300, 1e19,
                               -1e19, 1e9,     1e6,    -1e6,    -1.0, -3.0,   0.5,    1.0,   2.0,
                               255.0, 32768.0, 1e4,    1e3,     1e2,  5e-324, 20000.0};
    switch (below(4)) {
      case 0:
        return before.is_number() ? Json(before.get<double>() * (below(5) - 2)) : Json(-1);
      case 1:
        return before.is_number() ? Json(before.get<double>() * 10.0) : Json(10);
      case 2:
        return std::int64_t(kOdd[below(std::size(kOdd))] * 0.5 > 9e18
                                ? std::numeric_limits<std::int64_t>::max()
                                : below(70000) - 35000);
      default:
        return kOdd[below(std::size(kOdd))];
    }
  }

  std::string text() {
    const std::string kTexts[] = {"",
                                  "pipe.json",
                                  "/dev/zero",
                                  ".",
                                  "bounded",
                                  "seed",
                                  "off",
                                  "rupture",
                                  "burr",
                                  "cylinder",
                                  "needle",
                                  "instant",
                                  "undo",
                                  "reset",
                                  "tissues",
                                  "rewind",
                                  "bone",
                                  "liver",
                                  "right",
                                  "../tools/burr6.json",
                                  "<b>x</b><img src='/dev/zero'>",
                                  "<a href='file:///etc/passwd'>x</a>",
                                  "\x1b[2J\x07 \xc2\x9b \xe2\x80\x8b \xe2\x80\xae",
                                  "two\nlines",
                                  "phantom:cranium/../x",
                                  "../../../etc/passwd",
                                  "link.json",
                                  std::string("a\0b", 3),
                                  "\xff\xfe",
                                  std::string(5000, 'a')};
    return kTexts[below(std::size(kTexts))];
  }

  std::mt19937 random_;
  std::vector<Json*> places_;
};

}  // namespace

std::string mutatedJson(const std::string& text, std::uint32_t seed) {
  Result<Json> json = parseJson(text, "input");
  if (!json) return {};
  Mutator mutator(seed);
  for (int changes = 1 + mutator.below(3); changes > 0; --changes) mutator.change(*json);
  std::string out = json->dump(-1, ' ', false, Json::error_handler_t::replace);
  // Deeper than a parser or a printer may recurse.
  if (mutator.below(200) == 0) out.insert(out.size() / 2, 100'000, '[');
  return out;
}

}  // namespace trephine::fuzz
