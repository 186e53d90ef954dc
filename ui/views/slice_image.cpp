#include "ui/views/slice_image.h"

#include <QString>
#include <algorithm>
#include <cmath>

#include "ui/common/colours.h"

namespace trephine {

HuWindow draggedWindow(const HuWindow& before, double right, double down) {
  constexpr double kWidthPerPixel = 0.006;        // natural logarithm
  constexpr double kLevelPerPixel = 1.0 / 300.0;  // of the width
  constexpr double kWidest_HU = 8000.0, kHighest_HU = 4000.0;
  const double width = before.width_hu * std::exp(kWidthPerPixel * right);
  const double centre = before.centre_hu + kLevelPerPixel * down * before.width_hu;
  return {std::round(std::clamp(centre, -kHighest_HU, kHighest_HU)),
          std::round(std::clamp(width, 1.0, kWidest_HU))};
}

namespace {

struct GreyRamp {
  explicit GreyRamp(const HuWindow& window)
      : black(float(window.centre_hu - window.width_hu / 2.0)),
        scale(float(255.0 / window.width_hu)) {}
  std::uint8_t operator()(std::int16_t hu) const {
    return std::uint8_t(std::clamp((float(hu) - black) * scale + 0.5f, 0.0f, 255.0f));
  }
  float black, scale;
};

constexpr double kGhostShare = 0.5;  // of the overlay's opacity

// Voxel coordinates as whole numbers of 2^-32 voxels, so that a step is an addition and a voxel's
// number the upper half.
constexpr double kUnit = 4294967296.0;
constexpr int kUnitShift = 32;
struct FixedVoxel {
  explicit FixedVoxel(const Vec3& v) {
    for (std::size_t a = 0; a < 3; ++a) at[a] = std::llround(v[int(a)] * kUnit);
  }
  std::array<std::int64_t, 3> at;
};

// Of the steps 0 to count - 1 from `start`, those that lie in the grid: [first, second).
std::pair<int, int> insideSteps(const FixedVoxel& start, const FixedVoxel& step, const Index3& size,
                                int count) {
  std::int64_t first = 0, end = count;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t at = start.at[a], by = step.at[a];
    const std::int64_t high = (std::int64_t(size[a]) << kUnitShift) - 1;
    if (by == 0) {
      if (at < 0 || at > high) return {0, 0};
      continue;
    }
    const auto floored = [](std::int64_t n, std::int64_t d) {
      return n / d - ((n % d != 0) && ((n < 0) != (d < 0)));
    };
    // 0 <= at + n by <= high
    const std::int64_t low_n = by > 0 ? -floored(at, by) : -floored(high - at, -by);
    const std::int64_t high_n = by > 0 ? floored(high - at, by) : floored(at, -by);
    first = std::max(first, low_n);
    end = std::min(end, high_n + 1);
  }
  return first < end ? std::pair{int(first), int(end)} : std::pair{0, 0};
}

// HU between the eight voxels around places of a grid; at its borders those inside count twice.
class Between {
 public:
  explicit Between(const Volume& volume) : hu_(volume.hu.data()) {
    std::int64_t stride = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      last_[a] = volume.geometry.size[a] - 1;
      stride_[a] = stride;
      stride *= volume.geometry.size[a];
    }
  }
  // Of a place inside the grid, half a voxel on from its voxel coordinates.
  std::int16_t at(const std::array<std::int64_t, 3>& place) const {
    // From the voxel's middle to its number and, rounded, 256ths of the way to the next.
    constexpr std::int64_t kBack =
        (std::int64_t(1) << (kUnitShift - 1)) - (std::int64_t(1) << (kUnitShift - 9));
    std::array<std::int64_t, 3> next;
    std::array<std::int32_t, 3> share;
    const std::int16_t* from = hu_;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t low = place[a] - kBack;
      const std::int64_t voxel = low >> kUnitShift;
      share[a] = std::int32_t((low >> (kUnitShift - 8)) & 255);
      next[a] = voxel >= 0 && voxel < last_[a] ? stride_[a] : 0;
      from += std::max<std::int64_t>(voxel, 0) * stride_[a];
    }
    const auto row = [&](const std::int16_t* p) {
      return p[0] * 256 + (p[next[0]] - p[0]) * share[0];
    };
    const auto plane = [&](const std::int16_t* p) {
      const std::int32_t a = row(p) >> 4, b = row(p + next[1]) >> 4;
      return (a * 256 + (b - a) * share[1]) >> 8;
    };
    const std::int32_t a = plane(from), b = plane(from + next[2]);
    return std::int16_t((a * 256 + (b - a) * share[2] + (1 << 11)) >> 12);
  }

 private:
  const std::int16_t* hu_;
  std::array<std::int64_t, 3> last_, stride_;
};

}  // namespace

HuWindow windowOfBodyPart(const std::string& body_part) {
  const QString part = QString::fromStdString(body_part).toUpper();
  for (const char* of_bone : {"HEAD", "SKULL", "BRAIN", "FACE", "SINUS", "JAW", "SPINE"}) {
    if (part.contains(of_bone)) return kWindowPresets[kFirstPreset].window;
  }
  return usualWindow("abdomen");
}

HuWindow wholeRange(const SlicePicture& slice) {
  if (slice.hu.empty()) return kWideWindow;
  const auto [low, high] = std::ranges::minmax(slice.hu);
  return {0.5 * (double(low) + double(high)), std::max(1.0, double(high) - double(low))};
}

QImage windowed(const SlicePicture& slice, const HuWindow& window) {
  if (slice.columns <= 0 || slice.rows <= 0 ||
      slice.hu.size() != std::size_t(slice.columns) * std::size_t(slice.rows)) {
    return {};
  }
  const GreyRamp grey(window);
  QImage image(slice.columns, slice.rows, QImage::Format_Grayscale8);
  const std::int16_t* hu = slice.hu.data();
  for (int row = 0; row < slice.rows; ++row) {
    uchar* line = image.scanLine(row);
    for (int column = 0; column < slice.columns; ++column) line[column] = grey(*hu++);
  }
  return image;
}

SliceColours::SliceColours() : grey_(65536) {
  setWindow(window_);
}

void SliceColours::setWindow(const HuWindow& window) {
  window_ = {window.centre_hu, std::max(1.0, window.width_hu)};
  const GreyRamp grey(window_);
  for (int hu = -32768; hu <= 32767; ++hu) grey_[std::size_t(hu + 32768)] = grey(std::int16_t(hu));
}

void SliceColours::setTissues(const TissueSet& tissues, const TissueLooks& looks) {
  tissues_ = tissues;
  looks_ = looks;
  lookup_.set(tissueTable(tissues));
  mix();
}

void SliceColours::setOverlay(Overlay overlay, double opacity) {
  overlay_ = overlay;
  opacity_ = std::clamp(opacity, 0.0, 1.0);
  mix();
}

SliceColours::Tint SliceColours::tintOf(const Vec3& colour, TissueLook look) const {
  if (look == TissueLook::hidden) return {};
  return tint(colour, look == TissueLook::ghosted ? kGhostShare * opacity_ : opacity_);
}

SliceColours::Tint SliceColours::tint(const Vec3& colour, double opacity) {
  const auto part = [&](double c) {
    return unsigned(std::lround(std::clamp(c, 0.0, 1.0) * 255.0 * 256.0 * opacity));
  };
  return {unsigned(std::lround(256.0 * (1.0 - opacity))), part(colour.x), part(colour.y),
          part(colour.z)};
}

void SliceColours::mix() {
  of_class_.fill({});
  for (std::size_t c = 0; c < tissues_.tissues.size() && c < kMaxTissues; ++c) {
    const Tissue& tissue = tissues_.tissues[c];
    of_class_[c + 1] = tintOf(tissue.colour, lookOf(tissue, looks_));
  }
  of_label_[0] = {};
  for (int label = 1; label < 256; ++label) {
    // Of several tissues of a label, the one that is seen best.
    const Tissue* named = nullptr;
    for (const Tissue& tissue : tissues_.tissues) {
      if (tissue.label != label) continue;
      if (!named || lookOf(tissue, looks_) < lookOf(*named, looks_)) named = &tissue;
    }
    of_label_[std::size_t(label)] = named ? tintOf(named->colour, lookOf(*named, looks_))
                                          : tintOf(labelColour(label), TissueLook::shown);
  }
  for (const Structure& s : structures_) {
    const Tissue* of = nullptr;
    for (const Tissue& tissue : tissues_.tissues) {
      if (tissue.label == s.label && sameName(tissue.structure, s.name)) of = &tissue;
    }
    of_label_[std::size_t(s.label)] =
        tintOf(s.colour, of ? lookOf(*of, looks_) : TissueLook::shown);
  }
}

void SliceColours::setMark(const std::optional<Mark>& mark) {
  constexpr double kMarked = 0.55, kMoved = 0.85;  // opacity: what changes before what stays
  const bool same_table = mark && mark_ && mark->before == mark_->before;
  mark_ = mark;
  if (!mark_) return;
  if (!same_table) before_.set(mark_->before);
  const auto tissue = std::size_t(mark_->tissue);
  const Vec3 own = tissue < tissues_.tissues.size() ? tissues_.tissues[tissue].colour : Vec3(1.0);
  of_mark_ = {Tint{}, tint(own, kMarked), tint(colours::rgbOf(colours::kGained), kMoved),
              tint(colours::rgbOf(colours::kLost), kMoved)};
}

void SliceColours::setStructures(const LabelMap* labels) {
  std::vector<Structure> structures;
  if (labels) structures = labels->structures;
  if (structures == structures_) return;
  structures_ = std::move(structures);
  mix();
}

void drawSlice(const Volume& volume, const LabelMap* labels, const GridGeometry& stack, int k,
               const QRect& part, const SliceColours& colours, QImage& image) {
  if (image.size() != part.size() || image.format() != QImage::Format_RGB32) {
    image = QImage(part.size(), QImage::Format_RGB32);
  }
  const GridGeometry& g = volume.geometry;
  const Mat4 to_voxel = g.patientToVoxel();
  const Vec3 across = Mat3(to_voxel) * stack.direction[0] * stack.spacing_mm.x;
  const Vec3 down = Mat3(to_voxel) * stack.direction[1] * stack.spacing_mm.y;
  const Vec3 corner = toVoxel(g, stack.toPatient_mm(Vec3(part.left(), part.top(), k))) + 0.5;
  const FixedVoxel step(across);
  const std::int16_t* hu = volume.hu.data();
  const bool coloured = labels && (colours.overlay() != Overlay::none || colours.marks());
  const std::uint8_t* label = coloured ? labels->labels.data() : nullptr;
  const bool between = !hasVoxelsForPixels(stack, g);
  const Between voxels(volume);
  for (int row = 0; row < part.height(); ++row) {
    auto* line = reinterpret_cast<QRgb*>(image.scanLine(row));
    const FixedVoxel start(corner + down * double(row));
    const auto [first, end] = insideSteps(start, step, g.size, part.width());
    std::fill(line, line + first, qRgb(0, 0, 0));
    std::array<std::int64_t, 3> at;
    for (std::size_t a = 0; a < 3; ++a) at[a] = start.at[a] + first * step.at[a];
    for (int x = first; x < end; ++x) {
      const std::size_t voxel =
          g.indexOf(int(at[0] >> kUnitShift), int(at[1] >> kUnitShift), int(at[2] >> kUnitShift));
      const std::int16_t shown = between ? voxels.at(at) : hu[voxel];
      line[x] = colours.of(shown, hu[voxel], label ? label[voxel] : 0);
      for (std::size_t a = 0; a < 3; ++a) at[a] += step.at[a];
    }
    std::fill(line + end, line + part.width(), qRgb(0, 0, 0));
  }
}

}  // namespace trephine
