// Slices of any orientation, and sheared ones: every voxel must lie where it was in the patient.
#include <cmath>
#include <numbers>

#include "imaging/codes.h"
#include "series_fixture.h"

namespace trephine::test {

class TrapTilt : public SeriesFixture {
 protected:
  struct Frame {
    Vec3 position;
    std::vector<bool> padded;
  };

  // Linear, so that interpolation gives it exactly up to rounding; each axis has its own slope.
  static double scanned(const Vec3& p) {
    return 250.0 + 5.0 * (p.x + 20) - 3.0 * (p.y - 10) + 4.0 * (p.z - 100);
  }

  // A slice of the patient at `position`, in HU that are whole numbers.
  void addSlice(Image image, const Vec3& position, int instance,
                const std::function<bool(int, int)>& padded = {}) {
    image.position_mm = position;
    image.instance = instance;
    image.is_signed = true;
    image.bits_stored = 16;
    image.high_bit = 15;
    image.intercept = "0";
    Frame frame{position, {}};
    for (int j = 0; j < image.rows; ++j) {
      for (int i = 0; i < image.columns; ++i) {
        frame.padded.push_back(padded && padded(i, j));
        const Vec3 p = place(image, position, i, j);
        image.stored.push_back(frame.padded.back() ? -2000 : int(std::lround(scanned(p))));
      }
    }
    DcmDataset data = makeImage(image);
    data.putAndInsertUint16(DCM_PixelPaddingValue, Uint16(-2000));
    frames_.push_back(frame);
    image_ = image;
    add(data);
  }

  static Vec3 row(const Image& image) {
    const auto& o = image.orientation;
    return {o[0], o[1], o[2]};
  }
  static Vec3 column(const Image& image) {
    const auto& o = image.orientation;
    return {o[3], o[4], o[5]};
  }
  static Vec3 place(const Image& image, const Vec3& position, double i, double j) {
    return position + row(image) * (i * image.spacing_mm[1]) +
           column(image) * (j * image.spacing_mm[0]);
  }

  // Each voxel is what was scanned at its place, or air where that lies outside of the slice or in
  // its padding. `most` is what rounding can do.
  void expectAtTheirPlaces(const Volume& volume, double most) {
    const GridGeometry& g = volume.geometry;
    const Vec3 normal = glm::cross(row(image_), column(image_));
    int air = 0, inside = 0, edge = 0;
    for (int k = 0; k < g.size[2]; ++k) {
      for (int j = 0; j < g.size[1]; ++j) {
        for (int i = 0; i < g.size[0]; ++i) {
          const Vec3 p = g.toPatient_mm({i, j, k});
          const int hu = volume.at(i, j, k);
          // The line of positions tells where a slice at this height would lie.
          const double t = glm::dot(p - frames_[0].position, normal) /
                           glm::dot(frames_.back().position - frames_[0].position, normal);
          const Vec3 from =
              frames_[0].position + (frames_.back().position - frames_[0].position) * t;
          const double x = glm::dot(p - from, row(image_)) / image_.spacing_mm[1];
          const double y = glm::dot(p - from, column(image_)) / image_.spacing_mm[0];
          const double outside =
              std::max({-x, -y, x - (image_.columns - 1), y - (image_.rows - 1)});
          if (hu == kAirHu) {
            ++air;
            ASSERT_TRUE(outside > -1e-6 || nearPadding(x, y)) << i << " " << j << " " << k;
          } else if (nearPadding(x, y) || outside > 1e-6) {
            // Beside padding or the edge it is a voxel of the scan, taken alone or with its like.
            ++edge;
            ASSERT_LT(outside, 0.5 + 1e-6) << i << " " << j << " " << k;
            ASSERT_NEAR(hu, scanned(p), 8.0) << i << " " << j << " " << k;
          } else {
            ++inside;
            ASSERT_NEAR(hu, scanned(p), most) << i << " " << j << " " << k;
          }
        }
      }
    }
    EXPECT_GT(inside, g.size[0] * g.size[1] * g.size[2] / 4);
    air_ = air;
    edge_ = edge;
  }

  bool nearPadding(double x, double y) const {
    for (int j = int(std::floor(y)); j <= int(std::ceil(y)); ++j) {
      for (int i = int(std::floor(x)); i <= int(std::ceil(x)); ++i) {
        if (i < 0 || j < 0 || i >= image_.columns || j >= image_.rows) continue;
        if (frames_[0].padded[std::size_t(j * image_.columns + i)]) return true;
      }
    }
    return false;
  }

  static Image wide() {
    Image image;
    image.columns = 24;
    image.rows = 20;
    image.spacing_mm = {0.8, 0.6};
    return image;
  }

  void addTilted(const Image& image, double degrees, bool about_x, int missing = -1,
                 const std::function<bool(int, int)>& padded = {}) {
    const Vec3 normal = glm::cross(row(image), column(image));
    const Vec3 aside = about_x ? column(image) : row(image);
    const double slope = std::tan(degrees * std::numbers::pi / 180.0);
    for (int k = 0; k < 9; ++k) {
      if (k == missing) continue;
      addSlice(image, Vec3(-20.0, 10.0, 100.0) + (normal + aside * slope) * (1.5 * k), k + 1,
               padded);
    }
  }

  std::vector<Frame> frames_;
  Image image_;
  int air_ = 0, edge_ = 0;
};

TEST_F(TrapTilt, TwentyDegreesEitherWayAboutEitherAxis) {
  for (const bool about_x : {true, false}) {
    for (const double degrees : {20.0, -20.0}) {
      SCOPED_TRACE(std::to_string(degrees) + (about_x ? " about x" : " about y"));
      std::filesystem::remove_all(folder());
      frames_.clear();
      addTilted(wide(), degrees, about_x);
      const Volume volume = import();
      EXPECT_EQ(chosen().verdict, Verdict::repaired);
      EXPECT_NEAR(chosen().tilt_deg, 20.0, 1e-4);
      ASSERT_NE(find(chosen(), about_x ? "GANTRY_TILT" : "SHEARED_SIDEWAYS"), nullptr);
      EXPECT_NEAR(volume.geometry.spacing_mm.z, 1.5, 1e-9);
      // 12 mm up and 4.37 mm aside: six rows of 0.8 mm, or eight columns of 0.6 mm.
      EXPECT_EQ(volume.geometry.size, about_x ? (Index3{24, 26, 9}) : (Index3{32, 20, 9}));
      expectAtTheirPlaces(volume, 1.01);
      // The corners that were not scanned.
      const bool up = degrees > 0.0;
      const Index3 last{volume.geometry.size[0] - 1, volume.geometry.size[1] - 1, 8};
      EXPECT_EQ(volume.at(up ? last[0] : 0, up ? last[1] : 0, 0), kAirHu);
      EXPECT_EQ(volume.at(up ? 0 : last[0], up ? 0 : last[1], 8), kAirHu);
      EXPECT_GT(air_, 300);
    }
  }
}

TEST_F(TrapTilt, ObliqueSlicesThatAreShearedToo) {
  Image image = wide();
  // Turned by 30 degrees about z and then 40 about x.
  const double a = std::numbers::pi / 6, b = std::numbers::pi / 4.5;
  image.orientation = {std::cos(a),  std::sin(a) * std::cos(b), std::sin(a) * std::sin(b),
                       -std::sin(a), std::cos(a) * std::cos(b), std::cos(a) * std::sin(b)};
  addTilted(image, 15.0, true);
  const Volume volume = import();
  EXPECT_NEAR(chosen().tilt_deg, 15.0, 1e-4);
  expectAtTheirPlaces(volume, 1.01);
}

TEST_F(TrapTilt, PaddingIsNeverBlendedWhenSlicesAreStraightened) {
  const auto round = [](int i, int j) {
    return (i - 11.5) * (i - 11.5) / 140 + (j - 9.5) * (j - 9.5) / 95 > 1.0;
  };
  addTilted(wide(), 20.0, true, -1, round);
  const Volume volume = import();
  expectAtTheirPlaces(volume, 1.01);
  EXPECT_GT(edge_, 50);
  ASSERT_NE(find(chosen(), "PADDING_TO_AIR"), nullptr);
}

TEST_F(TrapTilt, ATiltedStackWithAMissingSlice) {
  addTilted(wide(), -20.0, false, 4);
  EXPECT_EQ(expectRefused("MISSING_SLICES").slices, std::vector<std::string>{"106.00 mm"});
  const Volume volume = import({{code::kMissingSlices, "fill"}});
  ASSERT_EQ(volume.geometry.size[2], 9);
  ASSERT_NE(find(chosen(), "SHEARED_SIDEWAYS"), nullptr);
  ASSERT_NE(find(chosen(), "MISSING_SLICES"), nullptr);
  // Between two slices a voxel may be scanned in one of them alone.
  const int columns = volume.geometry.size[0];
  for (int i = columns / 3; i < 2 * columns / 3; ++i) {
    for (int j = 0; j < 20; ++j) {
      ASSERT_NEAR(volume.at(i, j, 4), scanned(volume.geometry.toPatient_mm({i, j, 4})), 1.6);
    }
  }
  const Volume part = import({{code::kMissingSlices, "part"}});
  ASSERT_EQ(part.geometry.size[2], 4);
  frames_.resize(4);
  expectAtTheirPlaces(part, 1.01);
}

TEST_F(TrapTilt, OneSliceAsideIsMovedBack) {
  for (int k = 0; k < 9; ++k) {
    addSlice(wide(), Vec3(-20.0 + (k == 5 ? 1.2 : 0.0), 10.0, 100.0 + 1.5 * k), k + 1);
  }
  const Volume volume = import();
  ASSERT_NE(find(chosen(), "SHIFTED_SLICES"), nullptr);
  EXPECT_EQ(volume.geometry.size, (Index3{26, 20, 9}));
  for (int k = 0; k < 9; ++k) {
    for (int i = 0; i < 26; ++i) {
      const bool there = k == 5 ? i >= 2 : i < 24;
      const double hu = there ? scanned(volume.geometry.toPatient_mm({i, 7, k})) : kAirHu;
      ASSERT_NEAR(volume.at(i, 7, k), hu, there ? 0.51 : 0.0) << i << " " << k;
    }
  }
}

// The direction matrix alone carries how the patient lay.
TEST_F(TrapTilt, EveryOrientationKeepsEveryVoxelAtItsPlace) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  const std::pair<const char*, std::array<double, 6>> orientations[] = {
      {"head first", {1, 0, 0, 0, 1, 0}},   {"feet first", {-1, 0, 0, 0, 1, 0}},
      {"prone", {-1, 0, 0, 0, -1, 0}},      {"feet first, prone", {1, 0, 0, 0, -1, 0}},
      {"coronal", {1, 0, 0, 0, 0, -1}},     {"sagittal", {0, 1, 0, 0, 0, -1}},
      {"on the side", {0, 1, 0, -1, 0, 0}}, {"oblique", {c, s, 0, -s * c, c * c, s}},
  };
  for (const auto& [name, orientation] : orientations) {
    for (const double step : {1.5, -1.5}) {
      SCOPED_TRACE(std::string(name) + (step > 0 ? ", up" : ", down"));
      std::filesystem::remove_all(folder());
      frames_.clear();
      Image image = wide();
      image.orientation = orientation;
      const Vec3 normal = glm::cross(row(image), column(image));
      for (int k = 0; k < 5; ++k) {
        addSlice(image, Vec3(-20.0, 10.0, 100.0) + normal * (step * k), k + 1);
      }
      const Volume volume = import();
      EXPECT_EQ(chosen().verdict, Verdict::pass);
      ASSERT_EQ(volume.geometry.size, (Index3{24, 20, 5}));
      const Mat4 to_voxel = volume.geometry.patientToVoxel();
      for (const Frame& frame : frames_) {
        for (int j = 0; j < 20; ++j) {
          for (int i = 0; i < 24; ++i) {
            const Vec3 p = place(image, frame.position, i, j);
            const Vec3 v = Vec3(to_voxel * glm::dvec4(p, 1.0));
            const Vec3 nearest = glm::round(v);
            ASSERT_LT(glm::distance(v, nearest), 1e-5);
            ASSERT_EQ(volume.at(int(nearest.x), int(nearest.y), int(nearest.z)),
                      int(std::lround(scanned(p))));
          }
        }
      }
      EXPECT_NEAR(glm::determinant(volume.geometry.direction), 1.0, 1e-9);
    }
  }
}

TEST_F(TrapTilt, AxesThatAreNotPerpendicularAreRefused) {
  Image image = wide();
  image.orientation = {1, 0, 0, 0.0523, 0.9986, 0};  // three degrees off
  for (int k = 0; k < 5; ++k) addSlice(image, {-20.0, 10.0, 100.0 + k}, k + 1);
  expectRefused("NOT_ORTHONORMAL");
}

}  // namespace trephine::test
