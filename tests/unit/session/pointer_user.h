// A person at the window, as numbers: where the pointer is when, and how hard it pushes. The eye
// looks as it does at first; what it sees under the pointer is marched for in the grid.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "session/session.h"
#include "tissue/tissue_set.h"

namespace trephine::test {

// The pointer on the plane through a landmark [mm, its axes], in straight lines; the push holds
// until the next.
struct Pointed {
  double t_s = 0.0, x_mm = 0.0, y_mm = 0.0, push_N = 0.0;
};

class PointerUser {
 public:
  PointerUser(Session& session, std::size_t arm, std::vector<Pointed> path, double rate_hz)
      : session_(session),
        frame_(session.landmarks()[0].frame),
        arm_(arm),
        path_(std::move(path)),
        rate_hz_(rate_hz),
        tissues_(tissueTable(session.exercise().tissues)) {}

  // All events up to then.
  void playUntil(double t_s) {
    for (;;) {
      const double sample_s = double(samples_) / rate_hz_;
      const double turn_s = turns_ < path_.size() ? path_[turns_].t_s : 1e9;
      if (std::min(sample_s, turn_s) > t_s) return;
      if (turn_s <= sample_s) {  // of the wheel
        session_.setPush(arm_, path_[turns_++].push_N, std::int64_t(turn_s * 1e9));
      } else {
        all_taken_ = session_.point(arm_, at(sample_s)) && all_taken_;
        ++samples_;
      }
    }
  }
  bool allTaken() const { return all_taken_; }
  double end_s() const { return path_.back().t_s; }

  PointerSample at(double t_s) const {
    std::size_t i = 0;
    while (i + 1 < path_.size() && path_[i + 1].t_s <= t_s) ++i;
    double x_mm = path_[i].x_mm, y_mm = path_[i].y_mm;
    if (i + 1 < path_.size()) {
      const double share = (t_s - path_[i].t_s) / (path_[i + 1].t_s - path_[i].t_s);
      x_mm += share * (path_[i + 1].x_mm - x_mm);
      y_mm += share * (path_[i + 1].y_mm - y_mm);
    }
    const Vec3 eye_mm = frame_.position_mm - kEye_mm * frame_.viewDirection();
    const Vec3 along = glm::normalize(frame_.toPatient_mm({x_mm, y_mm, 0.0}) - eye_mm);
    return {std::int64_t(t_s * 1e9), eye_mm, along, seen_mm(eye_mm, along)};
  }

 private:
  static constexpr double kEye_mm = 300.0;

  // To the first voxel that is more opaque than not.
  std::optional<double> seen_mm(const Vec3& eye_mm, const Vec3& along) const {
    const Grid& grid = session_.grid();
    const GridGeometry& g = grid.geometry();
    const Mat4 to_voxel = g.patientToVoxel();
    for (double deep_mm = 0.5 * kEye_mm; deep_mm < 2.0 * kEye_mm; deep_mm += 0.25) {
      const Vec3 v = glm::round(Vec3(to_voxel * glm::dvec4(eye_mm + deep_mm * along, 1.0)));
      const int i = int(v.x), j = int(v.y), k = int(v.z);
      if (!g.contains(i, j, k)) continue;
      const std::size_t voxel = g.indexOf(i, j, k);
      const int c =
          classify(tissues_, grid.hu(voxel), grid.labels() ? grid.labels()->labels[voxel] : 0);
      if (c >= 0 && session_.exercise().tissues.tissues[std::size_t(c)].opacity > 0.5)
        return deep_mm;
    }
    return {};
  }

  Session& session_;
  LandmarkFrame frame_;
  std::size_t arm_;
  std::vector<Pointed> path_;
  double rate_hz_;
  TissueTable tissues_;
  long samples_ = 0;
  std::size_t turns_ = 0;
  bool all_taken_ = true;
};

}  // namespace trephine::test
