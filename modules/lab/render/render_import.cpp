// From an import's end to the first picture of what was imported.
#include "base/locked_folder.h"
#include "lab/import/import_series.h"
#include "lab/render/render_parts.h"

namespace trephine {

Status measureFirstPicture(const RenderOptions& options, const std::filesystem::path& out,
                           const Progress& progress, RenderMeasurement& result) {
  const Result<LockedFolder> folder = LockedFolder::make(out, ".render-", out);
  if (!folder) return folder.error();
  ImportSeries series;
  series.names = {"int16"};
  series.size = {options.import_size[0], options.import_size[1], options.import_size[2]};
  series.scan_series = 0;
  const auto known = writeOwnSeries(series, folder->path(), Progress(progress, 0.0, 0.6));
  if (!known) return known.error();
  const Result<TissueSet> tissues = shippedTissues("cranium");
  if (!tissues) return tissues.error();
  // The window is there before the import.
  auto made = SceneRenderer::offscreen(options.moving[0], options.moving[1]);
  if (!made) return made.error();
  SceneRenderer& renderer = **made;
  renderer.setTissues(*tissues);
  const Result<Case> of =
      readCase((folder->path() / "int16").string(), Progress(progress, 0.6, 1.0));
  if (!of) return of.error();
  const auto start = RenderClock::now();
  auto mirror = std::make_shared<VolumeMirror>();  // as in the window
  mirror->show(copyOf(*of->volume), nullptr, of->volume);
  renderer.setMirror(std::move(mirror));
  renderer.setMoving(true);  // as the window draws what is new
  do {                       // the first sends the volume, and no more
    renderer.paint(0, 50.0);
  } while (renderer.stale());
  result.first_picture_ms = msSince(start);
  return {};
}

}  // namespace trephine
