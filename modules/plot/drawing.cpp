#include "plot/drawing.h"

#include <QPointF>
#include <QString>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/codes.h"
#include "base/file.h"
#include "base/purpose.h"
#include "base/tr.h"
#include "plot/canvas.h"
#include "plot/checks.h"
#include "plot/clip.h"
#include "plot/fonts.h"
#include "plot/label_placing.h"
#include "plot/legend.h"

namespace trephine::plot {

namespace {

constexpr double kMargin = 24.0;
constexpr double kTickText = 26.0, kAxisTitle = 34.0;  // the heights below the axes
constexpr double kTickRow = 20.0;  // to a row of ticks, clear of the lowest one beside the axes
constexpr double kLeader = 22.0;                       // from a line's end to its name
constexpr double kNameRow = 21.0;
constexpr double kLeastWidth = 100.0, kLeastHeight = 60.0;  // of the axes
constexpr Font kTitle{26.0, true}, kNote{16.0}, kAxis{18.0}, kTick{16.0}, kLabel{16.0};

class Sheet {
 public:
  Sheet(const Plot& plot, QImage& image, Theme theme) : plot_(plot), canvas_(image, theme) {}

  Result<Drawing> drawn(QImage& image) {
    if (Status has_room = layOut(); !has_room) return has_room.error();
    grid();
    bands();
    cells();
    guideLines();
    lines();
    discs();
    canvas_.frame(area_, canvas_.colours().edge);
    axisTexts();
    const std::string cells_bear = cellTexts();
    labels();
    names();
    headings();
    drawLegend(canvas_, plot_, area_.bottom() + kTickText + kAxisTitle + 22.0, plot_.width_px,
               cells_bear, seen_);
    return Drawing{image, area_, canvas_.texts()};
  }

 private:
  double x(double value) const { return area_.left() + plot_.x.share(value) * area_.width(); }
  double y(double value) const { return area_.bottom() - plot_.y.share(value) * area_.height(); }
  QPointF at(const Point& point) const { return {x(point.x), y(point.y)}; }
  static double crisp(double pixel) { return std::floor(pixel) + 0.5; }

  // From the top and bottom, which texts of fixed height take, to left and right, which are as wide
  // as theirs.
  Status layOut() {
    double top = kMargin;
    if (!plot_.title.empty()) top += 30.0;
    for (const std::string& note : plot_.notes) top += note.empty() ? 0.0 : 23.0;
    top += 14.0;
    const double legend = legendHeight(plot_);
    const double below = kTickText + kAxisTitle + (legend > 0.0 ? legend + kMargin : 0.0);
    const double bottom = plot_.height_px - 12.0 - below;
    const auto names = std::count_if(plot_.lines.begin(), plot_.lines.end(),
                                     [](const Line& line) { return !line.name.empty(); });
    const double least = std::max(kLeastHeight, kNameRow * double(names - 1));
    if (bottom - top < least) return tooSmall("high", top + least + 12.0 + below);

    ticks_y_ = ticksOf(plot_.y, std::min(0.5, 22.0 / (bottom - top)));
    double widest = 0.0;
    for (const Tick& tick : ticks_y_.ticks) {
      widest = std::max(widest, canvas_.sizeOf(tick.text, kTick).width());
    }
    const double left = std::ceil(kMargin + 30.0 + widest + 10.0);
    double name = 0.0;
    for (const Line& line : plot_.lines) {
      name = std::max(name, canvas_.sizeOf(line.name, kLabel).width());
    }
    name_room_ = std::min(name, 0.4 * plot_.width_px - kLeader - 29.0);
    const double right = name > 0.0 ? std::ceil(kLeader + 5.0 + name_room_ + kMargin) : 40.0;
    area_ = {left, std::floor(top), plot_.width_px - right - left, std::floor(bottom - top)};
    if (area_.width() < kLeastWidth) return tooSmall("wide", left + kLeastWidth + right);

    double room = 44.0;  // pixels that the text of a tick needs
    for (int attempt = 0; attempt < 5; ++attempt) {
      ticks_x_ = ticksOf(plot_.x, std::min(1.0, room / area_.width()));
      double wide = 0.0;
      for (const Tick& tick : ticks_x_.ticks) {
        wide = std::max(wide, canvas_.sizeOf(tick.text, kTick).width());
      }
      if (wide + 16.0 <= room) break;
      room = wide + 16.0;
    }
    return {};
  }

  static Error tooSmall(const char* how, double least_px) {
    return {code::kBadArgument,
            tr("The picture has no room for its texts and axes: it must be {} pixels {}",
               number(std::ceil(least_px)), how),
            tr("the plot"), ""};
  }

  void grid() {
    for (const Tick& tick : ticks_x_.ticks) {
      const double across = crisp(area_.left() + tick.share * area_.width());
      canvas_.line({{across, area_.top()}, {across, area_.bottom()}}, canvas_.colours().grid, 1.0);
    }
    for (const Tick& tick : ticks_y_.ticks) {
      const double down = crisp(area_.bottom() - tick.share * area_.height());
      canvas_.line({{area_.left(), down}, {area_.right(), down}}, canvas_.colours().grid, 1.0);
    }
  }

  void bands() {
    for (const Band& band : plot_.bands) {
      const QColor fill = bandFill(canvas_.colour(band.tone));
      bool seen = false;
      std::vector<QPointF> low, high;  // of the spans since the last gap
      const auto fillSpans = [&] {
        if (low.size() == 1) {  // alone, it is as wide as can be seen
          const QPointF pixel(1.0, 0.0);
          low = {low[0] - pixel, low[0] + pixel};
          high = {high[0] - pixel, high[0] + pixel};
        }
        low.insert(low.end(), high.rbegin(), high.rend());
        const std::vector<QPointF> outline = clippedArea(std::move(low), area_);
        seen = seen || !outline.empty();
        canvas_.area(outline, fill);
        low.clear();
        high.clear();
      };
      for (const Band::Span& span : band.spans) {
        if (std::isfinite(span.x) && std::isfinite(span.low) && std::isfinite(span.high)) {
          low.push_back(at({span.x, span.low}));
          high.push_back(at({span.x, span.high}));
        } else {
          fillSpans();
        }
      }
      fillSpans();
      seen_.bands.push_back(seen);
    }
  }

  // As large as the closest columns and rows allow.
  QSizeF cellSize() const {
    double across = area_.width(), down = area_.height();
    const auto& columns = plot_.heat_map->columns;
    const auto& rows = plot_.heat_map->rows;
    for (std::size_t i = 1; i < columns.size(); ++i) {
      across = std::min(across, x(columns[i]) - x(columns[i - 1]));
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
      down = std::min(down, y(rows[i - 1]) - y(rows[i]));
    }
    return {std::min(84.0, 0.84 * across), std::min(30.0, 0.8 * down)};
  }

  QRectF rectOf(const HeatMap::Cell& cell, const QSizeF& size) const {
    return {at(cell.at) - QPointF(0.5 * size.width(), 0.5 * size.height()), size};
  }

  void cells() {
    if (!plot_.heat_map) return;
    const QSizeF size = cellSize();
    for (const HeatMap::Cell& cell : plot_.heat_map->cells) {
      const HeatMap::Level& level = plot_.heat_map->levels[cell.level];
      canvas_.cell(rectOf(cell, size), level.shape, canvas_.colour(level.tone));
    }
  }

  // What the texts are: the full ones where every cell has room for its own, else the brief ones,
  // else none.
  std::string cellTexts() {
    if (!plot_.heat_map) return {};
    const QSizeF size = cellSize();
    for (const auto words : {&Words::full, &Words::brief}) {
      for (Font font{words == &Words::full ? 16.0 : 14.0}; font.size_px >= 10.0; --font.size_px) {
        if (!fit(words, font, size)) continue;
        for (const HeatMap::Cell& cell : plot_.heat_map->cells) {
          const std::string& text = cell.text.*words;
          if (text.empty()) continue;
          const QColor fill = canvas_.colour(plot_.heat_map->levels[cell.level].tone);
          const QRectF rect = rectOf(cell, size);
          // A plate, so that no line runs through the text.
          QRectF plate(QPointF(), QSizeF(canvas_.sizeOf(text, font).width() + 4.0,
                                         std::min(font.size_px, size.height() - 3.0)));
          plate.moveCenter(rect.center());
          canvas_.plate(plate, fill);
          canvas_.text(rect.center(), Side::centre, text, font, inkOn(fill));
        }
        return plot_.heat_map->heading.*words;
      }
    }
    return {};
  }

  bool fit(std::string Words::*words, const Font& font, const QSizeF& size) const {
    if (font.size_px > size.height() - 4.0) return false;
    for (const HeatMap::Cell& cell : plot_.heat_map->cells) {
      if (canvas_.sizeOf(cell.text.*words, font).width() > size.width() - 6.0) return false;
    }
    return true;
  }

  void guideLines() {
    for (const Guide& guide : plot_.guides) {
      if (!(guide.across ? plot_.y : plot_.x).holds(guide.at)) continue;
      const double p = guide.across ? y(guide.at) : x(guide.at);
      canvas_.line(guide.across ? std::vector<QPointF>{{area_.left(), p}, {area_.right(), p}}
                                : std::vector<QPointF>{{p, area_.top()}, {p, area_.bottom()}},
                   canvas_.colour(guide.tone), 1.5, {8.0, 6.0});
    }
  }

  void lines() {
    for (const Line& line : plot_.lines) {
      std::vector<QPointF> points;
      for (const Point& point : line.points) points.push_back(at(point));
      pieces_.push_back(clipped(points, area_));
      for (std::vector<QPointF>& piece : pieces_.back()) {
        piece = thinned(piece);
        // Over cells, lines need an edge to be seen; between dashes the cells go on.
        if (plot_.heat_map) {
          canvas_.line(piece, canvas_.colours().background, line.width_px + 2.0, line.dashes_px);
        }
      }
      seen_.lines.push_back(!pieces_.back().empty());
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Line& line = plot_.lines[i];
      for (const auto& piece : pieces_[i]) {
        canvas_.line(piece, canvas_.colour(line.tone), line.width_px, line.dashes_px);
      }
    }
  }

  static double radiusOf(const Mark& mark) { return mark.strong ? 10.0 : 6.0; }
  bool holds(const Mark& mark) const {
    return plot_.x.holds(mark.at.x) && plot_.y.holds(mark.at.y);
  }

  // The strong ones first: a small one that lies on one of them stays in sight.
  void discs() {
    for (const bool strong : {true, false}) {
      for (const Mark& mark : plot_.marks) {
        if (mark.strong != strong || !holds(mark)) continue;
        canvas_.disc(at(mark.at), radiusOf(mark) + 1.0, canvas_.colours().background);
        canvas_.disc(at(mark.at), radiusOf(mark), canvas_.colour(mark.tone));
      }
    }
  }

  void axisTexts() {
    const QColor ink = canvas_.colour(Tone::ink);
    for (const Tick& tick : ticks_x_.ticks) {
      canvas_.text({area_.left() + tick.share * area_.width(), area_.bottom() + kTickRow},
                   Side::centre, tick.text, kTick, ink);
    }
    for (const Tick& tick : ticks_y_.ticks) {
      canvas_.text({area_.left() - 8.0, area_.bottom() - tick.share * area_.height()}, Side::right,
                   tick.text, kTick, ink);
    }
    canvas_.text({area_.center().x(), area_.bottom() + kTickText + 0.5 * kAxisTitle}, Side::centre,
                 ticks_x_.title, canvas_.fitting(ticks_x_.title, kAxis, area_.width()), ink,
                 plot_.width_px - 2.0 * kMargin);
    canvas_.turnedText({kMargin + 8.0, area_.center().y()}, ticks_y_.title,
                       canvas_.fitting(ticks_y_.title, kAxis, area_.height()), ink,
                       area_.height() + 40.0);
  }

  // What the texts of guides and marks keep clear of.
  std::vector<QRectF> obstacles() const {
    std::vector<QRectF> taken;
    for (const Mark& mark : plot_.marks) {
      const double r = radiusOf(mark);
      if (holds(mark)) taken.push_back({at(mark.at) - QPointF(r, r), QSizeF(2.0 * r, 2.0 * r)});
    }
    for (const Guide& guide : plot_.guides) {
      if (!(guide.across ? plot_.y : plot_.x).holds(guide.at)) continue;
      taken.push_back(guide.across ? QRectF(area_.left(), y(guide.at) - 1.0, area_.width(), 2.0)
                                   : QRectF(x(guide.at) - 1.0, area_.top(), 2.0, area_.height()));
    }
    for (const auto& line : pieces_) {
      for (const std::vector<QPointF>& piece : line) {
        for (std::size_t i = 1; i < piece.size(); ++i) {
          const QPointF way = piece[i] - piece[i - 1];
          const int steps = int(std::hypot(way.x(), way.y()) / 4.0) + 1;
          for (int n = 0; n <= steps; ++n) {
            const QPointF on = piece[i - 1] + way * (double(n) / steps);
            taken.push_back({on - QPointF(2.0, 2.0), QSizeF(4.0, 4.0)});
          }
        }
      }
    }
    return taken;
  }

  void labels() {
    if (plot_.marks.empty() && plot_.guides.empty()) return;
    std::vector<QRectF> taken = obstacles();
    const auto put = [&](const std::vector<QRectF>& candidates, const std::string& text,
                         const Font& font, const QColor& colour) {
      const QRectF rect = placed(candidates, taken, area_);
      taken.push_back(rect);
      canvas_.plate(rect, canvas_.colours().background);
      canvas_.text({rect.left() + 2.0, rect.center().y()}, Side::left, text, font, colour);
      return rect;
    };
    const auto sizeOf = [&](const std::string& text, const Font& font) {
      const QSizeF size = canvas_.sizeOf(text, font);
      return QSizeF(size.width() + 4.0, size.height());
    };
    for (const Guide& guide : plot_.guides) {
      if (guide.text.empty() || !(guide.across ? plot_.y : plot_.x).holds(guide.at)) continue;
      const Font font{14.0};
      put(along(guide, sizeOf(guide.text, font)), guide.text, font, canvas_.colour(guide.tone));
    }
    std::vector<const Mark*> marks;
    for (const Mark& mark : plot_.marks) {
      if (holds(mark) && !mark.text.empty()) marks.push_back(&mark);
    }
    std::stable_sort(marks.begin(), marks.end(),
                     [](const Mark* a, const Mark* b) { return a->strong && !b->strong; });
    for (const Mark* mark : marks) {
      const Font font = canvas_.fitting(mark->text, {16.0, mark->strong}, 0.5 * area_.width());
      const QPointF centre = at(mark->at);
      const QColor colour = canvas_.colour(mark->strong ? mark->tone : Tone::ink);
      const QRectF rect =
          put(around(centre, radiusOf(*mark), sizeOf(mark->text, font)), mark->text, font, colour);
      const QPointF nearest(std::clamp(centre.x(), rect.left(), rect.right()),
                            std::clamp(centre.y(), rect.top(), rect.bottom()));
      const QPointF way = nearest - centre;
      const double length = std::hypot(way.x(), way.y());
      if (length > radiusOf(*mark) + 8.0) {
        canvas_.line({centre + way * (radiusOf(*mark) / length), nearest},
                     canvas_.colour(Tone::quiet), 1.0);
      }
    }
  }

  // Beside the guide, from its start on.
  std::vector<QRectF> along(const Guide& guide, const QSizeF& size) const {
    std::vector<QRectF> candidates;
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      if (guide.across) {
        const double left = area_.left() + 6.0 + share * (area_.width() - 12.0 - size.width());
        candidates.push_back({{left, y(guide.at) - 3.0 - size.height()}, size});
        candidates.push_back({{left, y(guide.at) + 3.0}, size});
      } else {
        const double top = area_.top() + 6.0 + share * (area_.height() - 12.0 - size.height());
        candidates.push_back({{x(guide.at) - 6.0 - size.width(), top}, size});
        candidates.push_back({{x(guide.at) + 6.0, top}, size});
      }
    }
    return candidates;
  }

  // Beside the right ends of lines that reach them, moved apart where these lie together.
  void names() {
    struct Name {
      const Line* line;
      double end;
    };
    std::vector<Name> names;
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) {
      if (!seen_.lines[i] || plot_.lines[i].name.empty()) continue;
      const QPointF end = pieces_[i].back().back();
      if (end.x() > area_.right() - 1.0) names.push_back({&plot_.lines[i], end.y()});
    }
    std::stable_sort(names.begin(), names.end(),
                     [](const Name& a, const Name& b) { return a.end < b.end; });
    std::vector<double> rows;
    for (const Name& name : names) rows.push_back(name.end);
    spread(rows, kNameRow, area_.bottom());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const QColor colour = canvas_.colour(names[i].line->tone);
      canvas_.line({{area_.right(), names[i].end}, {area_.right() + kLeader, rows[i]}}, colour,
                   1.0);
      const std::string& text = names[i].line->name;
      canvas_.text({area_.right() + kLeader + 5.0, rows[i]}, Side::left, text,
                   canvas_.fitting(text, kLabel, name_room_), colour, name_room_ + 1.0);
    }
  }

  void headings() {
    const double room = plot_.width_px - 2.0 * kMargin;
    double row = kMargin + 6.0;
    if (!plot_.title.empty()) {
      canvas_.text({kMargin, row}, Side::left, plot_.title,
                   canvas_.fitting(plot_.title, kTitle, room), canvas_.colour(Tone::ink), room);
      row += 30.0;
    }
    Font font = kNote;
    for (const std::string& note : plot_.notes) font = canvas_.fitting(note, font, room);
    for (const std::string& note : plot_.notes) {
      if (note.empty()) continue;
      canvas_.text({kMargin, row}, Side::left, note, font, canvas_.colour(Tone::quiet), room);
      row += 23.0;
    }
  }

  const Plot& plot_;
  Canvas canvas_;
  QRectF area_;
  Ticks ticks_x_, ticks_y_;
  double name_room_ = 0.0;
  std::vector<std::vector<std::vector<QPointF>>> pieces_;  // of each line what lies within the axes
  Seen seen_;
};

}  // namespace

Result<Drawing> draw(const Plot& plot, Theme theme) {
  if (Status possible = checked(plot); !possible) return possible.error();
  if (Status ready = readyFonts(); !ready) return ready.error();
  QImage image(plot.width_px, plot.height_px, QImage::Format_RGB32);
  if (image.isNull()) {
    return Error{code::kOutOfMemory, tr("There is no memory for a picture"), tr("the plot"),
                 tr("Close other programs")};
  }
  return Sheet(plot, image, theme).drawn(image);
}

Status writePng(const Plot& plot, Theme theme, const std::filesystem::path& file) {
  Result<Drawing> drawing = draw(plot, theme);
  if (!drawing) return drawing.error();
  drawing->image.setText("Description", kPurpose);
  return replaceFile(file, [&](const std::filesystem::path& target) -> Status {
    if (drawing->image.save(QString::fromStdString(target.string()), "PNG")) return {};
    return Error{code::kWriteFailed, tr("The picture could not be written"), file.string(),
                 tr("Check the folder's rights and the space left on the disk")};
  });
}

}  // namespace trephine::plot
