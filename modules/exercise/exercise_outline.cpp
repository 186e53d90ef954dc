#include "exercise/exercise_outline.h"

#include <algorithm>
#include <cmath>

#include "base/tr.h"
#include "exercise/exercise.h"
#include "exercise/exercise_fields.h"

namespace trephine {

namespace {

Vec3 readPoint(JsonReader& outline, const Json& value, std::size_t number) {
  const std::string key = "points[" + std::to_string(number) + "]";
  Json named = Json::object();
  named[key] = value;
  JsonReader point(named, outline.file());
  const Vec3 at_mm = point.vec3(key.c_str(), kMapPlace_mm);
  if (const Status read = point.finish(); !read) {
    outline.fail(key.c_str(), read.error().what, read.error().next);
  }
  return at_mm;
}

double lengthOf_mm(const ExerciseOutline& outline) {
  const std::vector<Vec3>& points = outline.points_mm;
  double length_mm = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    length_mm += glm::length(points[i] - points[i - 1]);
  }
  if (outline.closed && !points.empty()) length_mm += glm::length(points.front() - points.back());
  return length_mm;
}

// Points of its own at most kOutlineStep_mm apart, beside those of the line itself.
std::vector<Vec3> inSmallSteps(const ExerciseOutline& outline) {
  const std::vector<Vec3>& corners = outline.points_mm;
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    points.push_back(corners[i]);
    if (i + 1 == corners.size() && !outline.closed) break;
    const Vec3 way = corners[(i + 1) % corners.size()] - corners[i];
    const int parts = int(std::ceil(glm::length(way) / kOutlineStep_mm));
    for (int part = 1; part < parts; ++part) {
      points.push_back(corners[i] + way * (double(part) / parts));
    }
  }
  return points;
}

}  // namespace

ExerciseOutline readExerciseOutline(JsonReader reader) {
  ExerciseOutline outline;
  const Json& points = reader.raw("points");
  if (!points.is_array() || points.size() < 2 || points.size() > kOutlinePoints) {
    reader.fail("points",
                tr("Expected a list of 2 to {} places, each three numbers", kOutlinePoints));
  } else {
    for (std::size_t i = 0; i < points.size() && reader.ok(); ++i) {
      outline.points_mm.push_back(readPoint(reader, points[i], i));
    }
  }
  // A line that went with its landmark may be longer by a rounding.
  const double length_mm = lengthOf_mm(outline);
  if (reader.ok() && length_mm > kOutlineLength_mm + 1e-3) {
    reader.fail("points", tr("The line is {} mm long, at most {} can be drawn",
                             plainNumber(std::round(length_mm)), plainNumber(kOutlineLength_mm)));
  }
  readFields(reader, kOutlineFields, outline);
  if (reader.has("frame")) {
    JsonReader frame = reader.object("frame");
    ExerciseOutline::Frame& of = outline.frame.emplace();
    of.landmark = frame.text("landmark");
    readFields(frame, kOutlineFrameFields, of.at);
    of.at.rotation = readRotation(frame);
  }
  return outline;
}

Json toJson(const ExerciseOutline& outline) {
  Json points = Json::array();
  for (const Vec3& p : outline.points_mm) points.push_back({p.x, p.y, p.z});
  Json json{{"points", points}};
  writeFields(json, kOutlineFields, outline);
  if (!outline.frame) return json;
  Json frame{{"landmark", outline.frame->landmark}};
  writeFields(frame, kOutlineFrameFields, outline.frame->at);
  const Quat& q = outline.frame->at.rotation;
  frame["rotation_wxyz"] = {q.w, q.x, q.y, q.z};
  json["frame"] = frame;
  return json;
}

std::optional<ExerciseOutline> placedOutline(const ExerciseOutline& outline,
                                             const std::vector<PlacedLandmark>& landmarks) {
  if (!outline.frame) return outline;
  const auto of = std::ranges::find(landmarks, outline.frame->landmark, &PlacedLandmark::id);
  if (of == landmarks.end()) return {};
  const LandmarkFrame &from = outline.frame->at, &to = of->frame;
  if (from.position_mm == to.position_mm && from.rotation == to.rotation) return outline;
  ExerciseOutline placed = outline;
  placed.frame->at = to;
  for (Vec3& p : placed.points_mm) {
    p = to.toPatient_mm(glm::conjugate(from.rotation) * (p - from.position_mm));
  }
  return placed;
}

std::vector<Vec3> outlineOn(const Exercise& exercise, const std::vector<PlacedLandmark>& landmarks,
                            const Volume& volume, const LabelMap* labels) {
  if (!exercise.outline) return {};
  const std::optional<ExerciseOutline> placed = placedOutline(*exercise.outline, landmarks);
  if (!placed) return {};
  std::vector<Vec3> points = inSmallSteps(*placed);
  const Landmark* of = placed->frame ? exercise.findLandmarkById(placed->frame->landmark) : nullptr;
  if (!of) return points;
  const Vec3 outward = placed->frame->at.rotation * Vec3(0.0, 0.0, 1.0);
  return ontoSurface(std::move(points), outward, kOutlineReach_mm, *of, volume, exercise.tissues,
                     labels);
}

}  // namespace trephine
