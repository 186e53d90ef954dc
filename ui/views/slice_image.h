// A slice as a picture: which HU are black and which are white, and what is coloured over them.
// Looking never changes a volume.
#pragma once

#include <QImage>
#include <array>
#include <optional>
#include <vector>

#include "haptics/tissue_lookup.h"
#include "imaging/importer.h"
#include "tissue/tissue_look.h"
#include "ui/views/slice_plane.h"

namespace trephine {

struct HuWindow {
  double centre_hu = 0.0;
  double width_hu = 2000.0;
  friend bool operator==(const HuWindow&, const HuWindow&) = default;
};

// `before` after a drag of so many pixels to the right, which makes it wider, and down, which makes
// the picture darker: whole numbers.
HuWindow draggedWindow(const HuWindow& before, double right, double down);

// The whole of a body from air to dense bone: for thumbnails.
inline constexpr HuWindow kWideWindow{0.0, 2000.0};

struct WindowPreset {
  const char* name;  // translated in the context "HuWindow"
  HuWindow window;
};
// Usual settings of CT viewers. A preset's key is its place.
inline constexpr std::array<WindowPreset, 5> kWindowPresets{{
    {QT_TRANSLATE_NOOP("HuWindow", "Brain"), {40.0, 80.0}},
    {QT_TRANSLATE_NOOP("HuWindow", "Bone"), {500.0, 2000.0}},
    {QT_TRANSLATE_NOOP("HuWindow", "Soft"), {40.0, 400.0}},
    {QT_TRANSLATE_NOOP("HuWindow", "Lung"), {-600.0, 1500.0}},
    {QT_TRANSLATE_NOOP("HuWindow", "Liver"), {60.0, 160.0}},
}};
inline constexpr std::size_t kFirstPreset = 1;  // what a view begins with
// What a series of that body part (DICOM's BodyPartExamined) is looked at with: bone for a head
// or a spine, soft tissue for what else there is and where the file does not say.
HuWindow windowOfBodyPart(const std::string& body_part);
// What a case of that anatomy is looked at with: soft tissue for an abdomen, else bone.
inline HuWindow usualWindow(const std::string& anatomy) {
  return kWindowPresets[anatomy == "abdomen" ? 2 : kFirstPreset].window;
}

// From the lowest to the highest value of the slice: for what is no CT.
HuWindow wholeRange(const SlicePicture& slice);

// Greys of one pixel a value, black at centre - width/2 and below, white at centre + width/2 and
// above; null for an empty slice.
QImage windowed(const SlicePicture& slice, const HuWindow& window);

enum class Overlay { none, tissues, labels };

// The colour of a voxel: its grey, and over it the colour of its tissue or its label, as the looks
// say: a ghost with half the opacity, nothing where it is hidden. What was cut has neither.
class SliceColours {
 public:
  SliceColours();
  void setWindow(const HuWindow& window);
  void setTissues(const TissueSet& tissues, const TissueLooks& looks = {});
  void setOverlay(Overlay overlay, double opacity);  // opacity in [0, 1]
  // While a threshold is moved: the voxels of one tissue alone are coloured, those that it has
  // gained and lost since it was of the table `before` apart. None: as the overlay says.
  struct Mark {
    TissueTable before;
    int tissue = 0;  // of the set
    int was = 0;     // of the table
  };
  void setMark(const std::optional<Mark>& mark);
  bool marks() const { return mark_.has_value(); }
  // Whose colours its structures have; null: none.
  void setStructures(const LabelMap* labels);

  const HuWindow& window() const { return window_; }
  Overlay overlay() const { return overlay_; }
  double opacity() const { return opacity_; }
  const TissueSet& tissues() const { return tissues_; }
  // As touch classifies it: index into the tissues, or -1.
  int classOf(std::int16_t hu, std::uint8_t label) const { return lookup_.classOf(hu, label); }

  std::uint8_t greyOf(std::int16_t hu) const { return grey_[std::size_t(int(hu) + 32768)]; }
  QRgb of(std::int16_t hu, std::uint8_t label) const { return of(hu, hu, label); }
  // With the grey of another HU than the voxel's own: one that was interpolated.
  QRgb of(std::int16_t shown_hu, std::int16_t hu, std::uint8_t label) const {
    const unsigned grey = greyOf(shown_hu);
    if (overlay_ == Overlay::none && !mark_) return 0xff000000u | grey * 0x010101u;
    const Tint& tint = mark_ ? tintOfMark(hu, label)
                       : overlay_ == Overlay::tissues
                           ? of_class_[std::size_t(lookup_.classOf(hu, label) + 1)]
                           : of_label_[hu == kRemovedHu ? 0 : label];
    const auto mixed = [&](unsigned add) { return (grey * tint.keep + add) >> 8; };
    return qRgb(int(mixed(tint.red)), int(mixed(tint.green)), int(mixed(tint.blue)));
  }

 private:
  struct Tint {  // the share of the grey that stays, of 256, and what is added, times 256
    unsigned keep = 256, red = 0, green = 0, blue = 0;
  };
  Tint tintOf(const Vec3& colour, TissueLook look) const;
  static Tint tint(const Vec3& colour, double opacity);
  const Tint& tintOfMark(std::int16_t hu, std::uint8_t label) const {
    const bool is = lookup_.classOf(hu, label) == mark_->tissue;
    const bool was = before_.classOf(hu, label) == mark_->was;
    return of_mark_[std::size_t(is ? (was ? 1 : 2) : (was ? 3 : 0))];
  }
  void mix();

  HuWindow window_ = kWindowPresets[kFirstPreset].window;
  Overlay overlay_ = Overlay::none;
  double opacity_ = 0.35;
  TissueSet tissues_;
  TissueLooks looks_;
  std::vector<Structure> structures_;
  TissueLookup lookup_;
  std::optional<Mark> mark_;
  TissueLookup before_;
  std::array<Tint, 4> of_mark_{};  // of none, kept, gained, lost
  std::vector<std::uint8_t> grey_;
  std::array<Tint, kMaxTissues + 1> of_class_{};  // the first: of no tissue
  std::array<Tint, 256> of_label_{};
};

// Draws pixels `part` of slice `k` of `stack` into `image`, a pixel each, black where no voxel is.
// Where the stack's pixels are the volume's voxels, they have their greys; in an oblique grid the
// grey is of the HU between the eight voxels around the pixel's centre, without which edges would
// be stairs. Tissue and label are always those of the voxel that the centre lies in. `stack` is one
// of the volume, `labels` are fitted to it or null. Allocates nothing while `part` keeps its size.
void drawSlice(const Volume& volume, const LabelMap* labels, const GridGeometry& stack, int k,
               const QRect& part, const SliceColours& colours, QImage& image);

}  // namespace trephine
