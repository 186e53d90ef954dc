#include "headset/lens_profile.h"

#include "base/json.h"
#include "base/tr.h"

namespace trephine {

namespace {

constexpr Range kBend{-2.0, 2.0}, kColour{0.8, 1.25}, kAxis{-0.5, 0.5};

// How far from the axis what is seen at r is taken from.
double bent(const LensProfile& lens, double r) {
  const double r2 = r * r;
  return r * (1.0 + r2 * (lens.k[0] + r2 * (lens.k[1] + r2 * lens.k[2])));
}

}  // namespace

Result<LensProfile> readLensProfile(const std::filesystem::path& file) {
  Result<Json> json = readJsonFile(file);
  if (!json) return json.error();
  JsonReader reader(*json, file.string());
  reader.format("trephine.lens", 1);
  LensProfile lens;
  if (reader.has("k")) {
    const std::vector<double> k = reader.numbers("k", 3, kBend);
    std::copy_n(k.begin(), 3, lens.k.begin());
  }
  if (reader.has("colour")) {
    const std::vector<double> colour = reader.numbers("colour", 3, kColour);
    std::copy_n(colour.begin(), 3, lens.colour.begin());
  }
  lens.axis = reader.number("axis", kAxis, 0.0);
  constexpr double kCorner = 2.2;  // of a wide picture
  double last = 0.0;
  for (double r = 0.01; reader.ok() && r <= kCorner; r += 0.01) {
    const double now = bent(lens, r);
    if (now <= last)
      reader.fail("k", tr("These numbers fold the picture over itself"),
                  tr("Check the lens's numbers"));
    last = now;
  }
  if (Status read = reader.finish(); !read) return read.error();
  return lens;
}

glm::dvec2 lensSource(const LensProfile& lens, std::size_t eye, int colour, const glm::dvec2& at) {
  const glm::dvec2 axis(eye == 0 ? lens.axis : -lens.axis, 0.0);
  const glm::dvec2 away = at - axis;
  const double r = glm::length(away);
  if (r == 0.0) return axis;
  return axis + away * (bent(lens, r) / r * lens.colour[std::size_t(colour)]);
}

}  // namespace trephine
