// A plot as a picture.
#pragma once

#include <QImage>
#include <QRectF>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "plot/plot.h"
#include "plot/theme.h"

namespace trephine::plot {

// In pixels of the picture, y down.
struct PlacedText {
  std::string text;  // as drawn: one that had no room ends in an ellipsis
  QRectF rect;
};

struct Drawing {
  QImage image;
  QRectF area;  // within the axes: Axis::share runs along it, of y from the bottom
  std::vector<PlacedText> texts;
};

// Texts that are too long become smaller, then shorter, but for those of ticks; none leaves the
// picture. Any thread, see plot/fonts.h. Errors: BAD_ARGUMENT for a size below 200 or above 8192
// pixels or too small for the texts, an axis whose ends do not ascend, lie beyond 1e300 or have
// their first 12 digits in common, widths, dashes, columns or rows other than plot/plot.h says, or
// a cell outside of the axes or of a level that there is not; CANNOT_DRAW; OUT_OF_MEMORY.
Result<Drawing> draw(const Plot& plot, Theme theme = Theme::light);

// The file is whole or not touched. Errors: those of draw, WRITE_FAILED, CANNOT_WRITE.
Status writePng(const Plot& plot, Theme theme, const std::filesystem::path& file);

}  // namespace trephine::plot
