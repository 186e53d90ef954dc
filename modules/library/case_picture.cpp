#include "library/case_picture.h"

#include <QBuffer>
#include <QImage>
#include <QString>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/purpose.h"
#include "volume/two_threads.h"

namespace trephine {

namespace {

constexpr int kWidth = CasePicture::kWidth, kHeight = CasePicture::kHeight;
constexpr int kFiner = 2;  // each pixel is the mean of so many, both ways
constexpr float kBoneHu = 250.0F, kBodyHu = -300.0F;
constexpr Vec3 kBackground(14, 16, 20);

// The nearest voxel, by a rounding that costs no call: a ray asks for hundreds.
inline Index3 nearestVoxel(const Vec3& v) {
  constexpr double kFar = 1 << 20;  // no voxel of ours is that far outside
  const auto round = [&](double x) {
    return std::int32_t(std::clamp(x, -kFar, kFar) + (kFar + 0.5)) - std::int32_t(kFar);
  };
  return {round(v.x), round(v.y), round(v.z)};
}

// Values on a grid of their own, part of the volume's.
struct Field {
  GridGeometry grid;
  std::vector<float> values;

  float at(int i, int j, int k) const { return values[grid.indexOf(i, j, k)]; }
  float nearest(const Vec3& v, float outside) const {
    const Index3 n = nearestVoxel(v);
    return grid.contains(n[0], n[1], n[2]) ? at(n[0], n[1], n[2]) : outside;
  }
  // Trilinear; what lies beyond the border is as the border.
  float sample(const Vec3& v) const {
    std::array<int, 3> low{}, high{};
    Vec3 t(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const double last = grid.size[std::size_t(axis)] - 1;
      const double at_axis = std::clamp(v[axis], 0.0, last);
      low[std::size_t(axis)] = int(at_axis);
      high[std::size_t(axis)] = std::min(low[std::size_t(axis)] + 1, int(last));
      t[axis] = at_axis - low[std::size_t(axis)];
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
      sum += (a ? t.x : 1 - t.x) * (b ? t.y : 1 - t.y) * (c ? t.z : 1 - t.z) *
             at(a ? high[0] : low[0], b ? high[1] : low[1], c ? high[2] : low[2]);
    }
    return float(sum);
  }
};

// Means over blocks of the volume's voxels in `box` that are about `step_mm` wide; single voxels
// where `means` is false. Metal counts as no more than dense bone.
Field fieldOf(const Volume& volume, const VoxelBox& box, double step_mm, bool means) {
  const GridGeometry& g = volume.geometry;
  Index3 stride{};
  Vec3 first(0.0);
  Field field;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = std::size_t(axis);
    const int extent = box.high[n] - box.low[n];
    stride[n] = std::clamp(int(std::lround(step_mm / g.spacing_mm[axis])), 1, extent);
    field.grid.size[n] = extent / stride[n];
    field.grid.spacing_mm[axis] = g.spacing_mm[axis] * stride[n];
    first[axis] = box.low[n] + (stride[n] - 1) * 0.5;
  }
  field.grid.direction = g.direction;
  field.grid.origin_mm = g.toPatient_mm(first);
  field.values.resize(field.grid.voxelCount());
  const Index3 block = means ? stride : Index3{1, 1, 1};
  const float share = 1.0F / float(block[0] * block[1] * block[2]);
  onTwoThreads(field.grid.size[2], [&](int k) {
    for (int j = 0; j < field.grid.size[1]; ++j) {
      float* row = &field.values[field.grid.indexOf(0, j, k)];
      for (int c = 0; c < block[2]; ++c) {
        for (int b = 0; b < block[1]; ++b) {
          const int from_j = box.low[1] + j * stride[1] + b,
                    from_k = box.low[2] + k * stride[2] + c;
          const std::int16_t* hu = &volume.hu[g.indexOf(box.low[0], from_j, from_k)];
          for (int i = 0; i < field.grid.size[0]; ++i) {
            int sum = 0;
            for (int a = 0; a < block[0]; ++a) {
              sum += std::clamp(int(hu[i * stride[0] + a]), -1000, 1500);
            }
            row[i] += float(sum);
          }
        }
      }
      for (int i = 0; i < field.grid.size[0]; ++i) row[i] *= share;
    }
  });
  return field;
}

VoxelBox wholeOf(const GridGeometry& grid) {
  return {{0, 0, 0}, grid.size};
}

// The largest piece above a value: 1 in it, on the field's grid. All zero where there is none.
std::vector<std::uint8_t> largestPiece(const Field& field, float above) {
  const GridGeometry& g = field.grid;
  std::vector<std::uint32_t> piece(field.values.size(), 0);
  std::vector<std::size_t> open;
  std::uint32_t count = 0, best = 0;
  std::size_t best_size = 0;
  for (std::size_t seed = 0; seed < piece.size(); ++seed) {
    if (piece[seed] || field.values[seed] < above) continue;
    piece[seed] = ++count;
    open.assign(1, seed);
    std::size_t size = 0;
    while (!open.empty()) {
      const Index3 at = g.indicesOf(open.back());
      open.pop_back();
      ++size;
      for (int n = 0; n < 27; ++n) {
        const int i = at[0] + n % 3 - 1, j = at[1] + n / 3 % 3 - 1, k = at[2] + n / 9 - 1;
        if (!g.contains(i, j, k)) continue;
        const std::size_t next = g.indexOf(i, j, k);
        if (piece[next] || field.values[next] < above) continue;
        piece[next] = count;
        open.push_back(next);
      }
    }
    if (size > best_size) {
      best_size = size;
      best = count;
    }
  }
  std::vector<std::uint8_t> in(piece.size(), 0);
  for (std::size_t n = 0; best && n < piece.size(); ++n) in[n] = piece[n] == best;
  return in;
}

// Where its voxels lie on the way along `axis`: between which all but a hundredth do.
struct Extent {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  double middle() const { return 0.5 * (low + high); }
  double length() const { return high - low; }
};

Extent extentOf(const GridGeometry& grid, const std::vector<std::uint8_t>& in, const Vec3& along) {
  Extent extent;
  const Mat4 to_patient = grid.voxelToPatient();
  const Vec3 step(glm::dot(Vec3(to_patient[0]), along), glm::dot(Vec3(to_patient[1]), along),
                  glm::dot(Vec3(to_patient[2]), along));
  const double start = glm::dot(grid.origin_mm, along);
  for (std::size_t n = 0; n < in.size(); ++n) {
    if (!in[n]) continue;
    const Index3 at = grid.indicesOf(n);
    const double place = start + step.x * at[0] + step.y * at[1] + step.z * at[2];
    extent.low = std::min(extent.low, place);
    extent.high = std::max(extent.high, place);
  }
  return extent;
}

// Pixels in patient mm: the plane through `centre` along `right` and `up`.
struct View {
  Vec3 centre{0.0}, right{0.0}, up{0.0};
  double pixel_mm = 1.0;  // of the finer ones

  Vec3 at(int column, int row) const {
    return centre + right * ((column - (kWidth * kFiner - 1) * 0.5) * pixel_mm) -
           up * ((row - (kHeight * kFiner - 1) * 0.5) * pixel_mm);
  }
};

// So large that `right` and `up` extents fit, with some room around.
View viewOf(const GridGeometry& grid, const std::vector<std::uint8_t>& in, const Vec3& right,
            const Vec3& up, const Vec3& eye) {
  const Extent across = extentOf(grid, in, right), upwards = extentOf(grid, in, up),
               depth = extentOf(grid, in, eye);
  View view{right * across.middle() + up * upwards.middle() + eye * depth.middle(), right, up, 1.0};
  constexpr double kRoom = 1.08;
  view.pixel_mm = kRoom * std::max({across.length() / (kWidth * kFiner),
                                    upwards.length() / (kHeight * kFiner), 0.05});
  return view;
}

// Each finer pixel from `colour`, then their means.
template <class Colour>
CasePicture drawn(const Colour& colour) {
  CasePicture picture;
  picture.rgb.resize(std::size_t(kWidth) * kHeight * 3);
  onTwoThreads(kHeight, [&](int y) {
    for (int x = 0; x < kWidth; ++x) {
      Vec3 sum(0.0);
      for (int n = 0; n < kFiner * kFiner; ++n) {
        sum += colour(x * kFiner + n % kFiner, y * kFiner + n / kFiner);
      }
      for (int c = 0; c < 3; ++c) {
        const double mean = sum[c] / (kFiner * kFiner);
        picture.rgb[(std::size_t(y) * kWidth + std::size_t(x)) * 3 + std::size_t(c)] =
            std::uint8_t(std::clamp(std::lround(mean), 0L, 255L));
      }
    }
  });
  return picture;
}

// The bone as finely as the picture shows it; other pieces are taken out of it.
Field boneField(const Volume& volume, const Field& coarse, const std::vector<std::uint8_t>& bone) {
  const GridGeometry& g = coarse.grid;
  Index3 low = g.size, high{-1, -1, -1};
  std::vector<std::uint8_t> beside(bone.size(), 0);
  for (std::size_t n = 0; n < bone.size(); ++n) {
    if (!bone[n]) continue;
    const Index3 at = g.indicesOf(n);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis]);
    }
    for (int m = 0; m < 27; ++m) {
      const int i = at[0] + m % 3 - 1, j = at[1] + m / 3 % 3 - 1, k = at[2] + m / 9 - 1;
      if (g.contains(i, j, k)) beside[g.indexOf(i, j, k)] = 1;
    }
  }
  VoxelBox box;
  double mm3 = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int size = volume.geometry.size[axis];
    const int stride =
        int(std::lround(g.spacing_mm[int(axis)] / volume.geometry.spacing_mm[int(axis)]));
    box.low[axis] = std::max((low[axis] - 2) * stride, 0);
    box.high[axis] = std::min((high[axis] + 3) * stride, size);
    mm3 *= (box.high[axis] - box.low[axis]) * volume.geometry.spacing_mm[int(axis)];
  }
  constexpr double kMostVoxels = 5e6;
  Field field = fieldOf(volume, box, std::max(0.9, std::cbrt(mm3 / kMostVoxels)), true);
  // What is bright and further than a coarse voxel from the bone is something else.
  const Mat4 to_coarse = g.patientToVoxel() * field.grid.voxelToPatient();
  onTwoThreads(field.grid.size[2], [&](int k) {
    for (int j = 0; j < field.grid.size[1]; ++j) {
      for (int i = 0; i < field.grid.size[0]; ++i) {
        float& value = field.values[field.grid.indexOf(i, j, k)];
        if (value < 100.0F) continue;
        const Index3 near = nearestVoxel(Vec3(to_coarse * glm::dvec4(i, j, k, 1.0)));
        const bool inside = g.contains(near[0], near[1], near[2]);
        if (!inside || !beside[g.indexOf(near[0], near[1], near[2])]) value = 0.0F;
      }
    }
  });
  return field;
}

CasePicture skullPicture(const Volume& volume, const Field& coarse,
                         const std::vector<std::uint8_t>& bone) {
  // To the eye: the patient's left, back and head are +x, +y and +z.
  const Vec3 eye = glm::normalize(Vec3(0.74, 0.60, 0.30));
  const Vec3 right = glm::normalize(glm::cross(Vec3(0, 0, 1), eye));
  const Vec3 up = glm::cross(eye, right);
  const View view = viewOf(coarse.grid, bone, right, up, eye);
  const Field field = boneField(volume, coarse, bone);
  const GridGeometry& g = field.grid;
  const Mat4 to_voxel = g.patientToVoxel();
  const double reach_mm = 0.5 * g.diagonal_mm() + glm::length(g.centre_mm() - view.centre);
  const double step_mm = 0.7 * std::min({g.spacing_mm.x, g.spacing_mm.y, g.spacing_mm.z});
  const int steps = int(2.0 * reach_mm / step_mm) + 1;
  const Vec3 step = Vec3(to_voxel * glm::dvec4(-eye * step_mm, 0.0));
  const Vec3 light = glm::normalize(eye + 0.75 * up - 0.45 * right);
  const Extent depth = extentOf(coarse.grid, bone, eye);

  const auto colour = [&](int column, int row) {
    const Vec3 pixel = view.at(column, row);
    Vec3 v = Vec3(to_voxel * glm::dvec4(pixel + eye * reach_mm, 1.0));
    // Far more steps lie outside of the box than within.
    double before = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(step[axis]) < 1e-9) continue;
      const double border = step[axis] > 0 ? -1.0 : double(g.size[std::size_t(axis)]);
      before = std::max(before, (border - v[axis]) / step[axis]);
    }
    int n = int(std::min(before, double(steps)));
    v += step * double(n);
    for (; n < steps; ++n, v += step) {
      if (field.nearest(v, kBodyHu) < 60.0F || field.sample(v) < kBoneHu) continue;
      Vec3 outside = v - step, inside = v;
      for (int halving = 0; halving < 4; ++halving) {
        const Vec3 between = 0.5 * (outside + inside);
        (field.sample(between) < kBoneHu ? outside : inside) = between;
      }
      Vec3 slope(0.0);
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 aside(0.0);
        aside[axis] = 1.2;
        slope[axis] = double(field.sample(inside + aside) - field.sample(inside - aside)) /
                      g.spacing_mm[axis];
      }
      const Vec3 outwards = -(g.direction * slope);
      const double length = glm::length(outwards);
      const Vec3 normal = length > 1e-6 ? outwards / length : eye;
      const double lit = std::max(0.0, glm::dot(normal, light));
      const double facing = std::max(0.0, glm::dot(normal, eye));
      const double near = (glm::dot(pixel, eye) + reach_mm - n * step_mm - depth.low) /
                          std::max(depth.length(), 1.0);
      const double shade =
          (0.16 + 0.22 * facing + 0.66 * lit) * (0.45 + 0.55 * std::clamp(near * 1.15, 0.0, 1.0));
      return glm::min(Vec3(246, 234, 212) * shade, Vec3(255.0));
    }
    return kBackground;
  };
  return drawn(colour);
}

CasePicture slicePicture(const Volume& volume, const Field& coarse) {
  std::vector<std::uint8_t> body = largestPiece(coarse, kBodyHu);
  if (std::ranges::count(body, 1) == 0) std::ranges::fill(body, std::uint8_t(1));
  const Vec3 left(1, 0, 0), back(0, 1, 0), head(0, 0, 1);
  const double width = extentOf(coarse.grid, body, left).length();
  const double height = extentOf(coarse.grid, body, head).length();
  constexpr double kTooFlat = 0.4;
  const bool coronal = height > kTooFlat * width;
  const View view = coronal ? viewOf(coarse.grid, body, left, head, back)
                            : viewOf(coarse.grid, body, left, -back, head);
  // Some mm thick, against noise.
  const Vec3 through = coronal ? back : head;
  constexpr std::array<double, 5> kAside_mm{-2.0, -1.0, 0.0, 1.0, 2.0};
  const GridGeometry& g = volume.geometry;
  const Mat4 to_voxel = g.patientToVoxel();
  const auto colour = [&](int column, int row) {
    double sum = 0.0;
    int inside = 0;
    for (const double aside_mm : kAside_mm) {
      const Vec3 at = view.at(column, row) + through * aside_mm;
      const Index3 n = nearestVoxel(Vec3(to_voxel * glm::dvec4(at, 1.0)));
      if (!g.contains(n[0], n[1], n[2])) continue;
      sum += volume.at(n[0], n[1], n[2]);
      ++inside;
    }
    if (inside == 0) return kBackground;
    constexpr double kCentre = 40.0, kWindow = 400.0;
    const double grey = std::clamp((sum / inside - kCentre) / kWindow + 0.5, 0.0, 1.0);
    return glm::max(kBackground, Vec3(255.0 * grey));
  };
  return drawn(colour);
}

}  // namespace

CasePicture casePicture(const Volume& volume, BodyRegion region) {
  constexpr double kCoarse_mm = 2.5;
  const Field coarse = fieldOf(volume, wholeOf(volume.geometry), kCoarse_mm, false);
  if (region == BodyRegion::head) {
    const std::vector<std::uint8_t> bone = largestPiece(coarse, kBoneHu);
    constexpr std::ptrdiff_t kFewest = 200;  // coarse voxels: 3 mL
    if (std::ranges::count(bone, 1) >= kFewest) return skullPicture(volume, coarse, bone);
  }
  return slicePicture(volume, coarse);
}

std::string pngOf(const CasePicture& picture) {
  QImage image(picture.rgb.data(), kWidth, kHeight, kWidth * 3, QImage::Format_RGB888);
  image.setText("Description", kPurpose);
  QBuffer png;
  png.open(QBuffer::WriteOnly);
  image.save(&png, "PNG");
  return png.data().toStdString();
}

}  // namespace trephine
