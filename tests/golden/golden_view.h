// A line of the table as the product draws it, and as it must not be taken for.
#pragma once

#include <QImage>

#include "golden_line.h"
#include "render/picture.h"

namespace trephine::test {

enum class Change {
  none,
  driver,   // another graphics driver, another font: the same picture
  view,     // from beside; another slice
  tissue,   // without the one that the picture is to show
  window,   // another HU window; of slices
  colours,  // without the overlay or the outline; of what has one
};

// Errors: those of cases and of SceneRenderer::offscreen.
Result<Picture> drawn(const GoldenLine& line, Change change = Change::none);

// The least structural similarity of the red, the green and the blue.
double likeness(const Picture& a, const Picture& b);

Picture pictureOf(const QImage& image);
Picture mirrored(const Picture& picture);

}  // namespace trephine::test
