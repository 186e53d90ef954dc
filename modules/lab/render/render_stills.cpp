// Still pictures by both mappers.
#include <algorithm>
#include <cmath>
#include <map>

#include "lab/render/render_parts.h"

namespace trephine {

namespace {

using Renderer = std::unique_ptr<SceneRenderer>;

// Nothing of ours on, for a subject that is shown without labels: VTK's shader alone.
void setStock(SceneRenderer& renderer, bool stock) {
  UploadProbe::setLeaping(renderer, !stock);
  renderer.setShading({false, false});
}

double dB(const Picture& a, const Picture& b) {
  return std::min(kEqual_dB, psnr_dB(a, b));
}

struct Timed {
  Picture picture;
  double ms = 0.0;
};

// Of all rays anew, though the last picture was the same.
Timed timedPicture(SceneRenderer& renderer, double distance) {
  renderer.setSampleDistance(distance);
  const auto start = RenderClock::now();
  Picture picture = renderer.picture();
  return {std::move(picture), msSince(start)};
}

// A shader that was just asked for is compiled with its first picture, whatever that picture's
// size.
void warmUp(SceneRenderer& renderer, const std::array<int, 2>& size) {
  renderer.resize(64, 48);
  renderer.picture();
  renderer.resize(size[0], size[1]);
}

// A way to draw, its times and its last picture, by sample distance.
struct Series {
  std::map<double, std::vector<double>> ms;
  std::map<double, Picture> picture;
  void add(double distance, Timed timed) {
    ms[distance].push_back(timed.ms);
    picture[distance] = std::move(timed.picture);
  }
};

RenderRow rowOf(const RenderSubject& subject, const std::array<int, 2>& size, const char* mode,
                const char* mapper, double distance) {
  RenderRow row;
  row.of_case = subject.name;
  row.preset = subject.preset;
  row.width = size[0];
  row.height = size[1];
  row.mode = mode;
  row.mapper = mapper;
  row.sample_distance_voxels = distance;
  return row;
}

// Levels by our own mapper, against the same mapper at the reference distance.
void measureLevels(const RenderSubject& subject, const RenderOptions& options,
                   SceneRenderer& renderer, RenderMeasurement& result) {
  renderer.resize(options.moving[0], options.moving[1]);
  renderer.setSampleDistance(kReferenceDistance);
  const Picture reference = renderer.picture();
  const double distance = options.sample_distances.front();
  renderer.setSampleDistance(distance);
  std::vector<double> levels{1.0};
  levels.insert(levels.end(), options.levels.begin(), options.levels.end());
  for (const double level : levels) {
    RenderRow row = rowOf(subject, options.moving, "still", "trephine", distance);
    std::vector<double> ms;
    Picture picture = UploadProbe::pictureAt(renderer, level);
    for (int repeat = 0; repeat < options.repeats; ++repeat) {
      const auto start = RenderClock::now();
      picture = UploadProbe::pictureAt(renderer, level);
      ms.push_back(msSince(start));
    }
    row.level = level;
    row.ms_median = medianOf(ms);
    row.psnr_dB = dB(reference, picture);
    row.ssim = ssim(reference, picture);
    result.rows.push_back(row);
  }
}

}  // namespace

Status measureStills(const RenderSubject& subject, const RenderOptions& options,
                     const std::filesystem::path& out, const Progress& progress,
                     RenderMeasurement& result) {
  // Two renderers, so that neither sends its volume again when the other is asked: `ours` has the
  // labels, `other` has none and is stock or plain.
  Result<Renderer> ours_made = SceneRenderer::offscreen(options.still[0], options.still[1]);
  if (!ours_made) return ours_made.error();
  Result<Renderer> other_made = SceneRenderer::offscreen(options.still[0], options.still[1]);
  if (!other_made) return other_made.error();
  SceneRenderer &ours = **ours_made, &other = **other_made;
  result.renderer = ours.openGlDescription();
  show(subject, true, ours);
  show(subject, false, other);
  warmUp(ours, options.still);
  for (const bool stock : {false, true}) {
    setStock(other, stock);
    warmUp(other, options.still);
  }

  std::vector<double> distances = options.sample_distances;
  if (std::find(distances.begin(), distances.end(), kReferenceDistance) == distances.end()) {
    distances.push_back(kReferenceDistance);
  }
  Series best, plain, stock;
  for (std::size_t n = 0; n < distances.size(); ++n) {
    for (int turn = 0; turn < (n == 0 ? options.repeats : 1); ++turn) {
      if (progress.cancelled()) return renderCancelled();
      progress.at(double(n) / double(distances.size()), subject.name + ", " + subject.preset);
      for (int repeat = 0; repeat < (n == 0 ? 3 : 2); ++repeat) {
        best.add(distances[n], timedPicture(ours, distances[n]));
      }
      setStock(other, false);
      timedPicture(other, distances[n]);  // the first one since the shader was another
      for (int repeat = 0; repeat < (n == 0 ? 3 : 2); ++repeat) {
        plain.add(distances[n], timedPicture(other, distances[n]));
      }
      setStock(other, true);
      stock.add(distances[n], timedPicture(other, distances[n]));
    }
  }
  for (const double distance : options.sample_distances) {
    for (const bool is_stock : {false, true}) {
      Series& of = is_stock ? stock : best;
      RenderRow row =
          rowOf(subject, options.still, "still", is_stock ? "stock" : "trephine", distance);
      row.ms_median = medianOf(of.ms[distance]);
      const Picture &reference = of.picture[kReferenceDistance], &drawn = of.picture[distance];
      row.psnr_dB = dB(reference, drawn);
      row.ssim = ssim(reference, drawn);
      if (!is_stock) {
        row.ms_plain_median = medianOf(plain.ms[distance]);
        row.psnr_to_stock_dB = dB(stock.picture[distance], plain.picture[distance]);
      }
      result.rows.push_back(row);
    }
  }
  std::string stem = subject.preset + "-" + subject.name;
  std::replace(stem.begin(), stem.end(), ':', '-');
  const double first = distances.front();
  for (const auto& [name, series] :
       {std::pair("trephine", &best), std::pair("plain", &plain), std::pair("stock", &stock)}) {
    const Status written = writePng(series->picture[first], out / (stem + "-" + name + ".png"));
    if (!written) return written;
  }
  measureLevels(subject, options, ours, result);
  return {};
}

}  // namespace trephine
