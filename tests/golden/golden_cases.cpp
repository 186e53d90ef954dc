// DCMTK's configuration comes before its other headers.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
//
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "base/codes.h"
#include "base/system.h"
#include "golden_cases.h"
#include "imaging/dicom/ct_writer.h"
#include "support.h"
#include "volume/phantom.h"

namespace trephine::test {

namespace {

// Coarse, so that it is made in a moment.
constexpr double kPixel_mm = 2.5, kSlice_mm = 3.0;

// Around the phantom's own box, with these axes.
GridGeometry gridAround(const GridGeometry& phantom, const Mat3& direction) {
  GridGeometry g;
  g.spacing_mm = Vec3(kPixel_mm, kPixel_mm, kSlice_mm);
  g.direction = direction;
  Vec3 reach(0.0);  // of the box's corners along each of these axes
  const Vec3 centre = phantom.centre_mm();
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at(corner & 1 ? phantom.size[0] - 1 : 0, corner & 2 ? phantom.size[1] - 1 : 0,
                  corner & 4 ? phantom.size[2] - 1 : 0);
    reach =
        glm::max(reach, glm::abs(glm::transpose(direction) * (phantom.toPatient_mm(at) - centre)));
  }
  for (int axis = 0; axis < 3; ++axis) {
    g.size[std::size_t(axis)] = 1 + int(2.0 * reach[axis] / g.spacing_mm[axis]);
  }
  g.origin_mm =
      centre - direction * (0.5 * g.spacing_mm * Vec3(g.size[0] - 1, g.size[1] - 1, g.size[2] - 1));
  return g;
}

Result<Volume> oblique(const std::string& phantom) {
  const Mat3 turned(glm::rotate(glm::dmat4(1.0), 0.45, glm::normalize(Vec3(1.0, 0.6, -0.4))));
  return makePhantomOn(*phantomTruth(phantom), gridAround(*phantomGeometry(phantom), turned),
                       kPhantomNoiseHu);
}

// As a scanner with a tilted gantry makes it: inclined slices, one above the other along the table.
Result<Volume> tilted(const std::string& phantom) {
  constexpr double kTilt = 18.0 * M_PI / 180.0;
  const double c = std::cos(kTilt), s = std::sin(kTilt);
  const PhantomTruth truth = *phantomTruth(phantom);
  Volume scanned{gridAround(*phantomGeometry(phantom), Mat3(1, 0, 0, 0, c, s, 0, -s, c)), {}};
  const GridGeometry& all = scanned.geometry;
  const Vec3 along_table(0.0, 0.0, all.spacing_mm.z / c);
  const Vec3 middle = all.toPatient_mm(0.5 * Vec3(0, 0, all.size[2] - 1));
  std::vector<Vec3> positions;
  for (int k = 0; k < all.size[2]; ++k) {
    GridGeometry slice = all;
    slice.size[2] = 1;
    slice.origin_mm = middle + along_table * (k - 0.5 * (all.size[2] - 1));
    const Volume made = makePhantomOn(truth, slice, 0.0);
    scanned.hu.insert(scanned.hu.end(), made.hu.begin(), made.hu.end());
    positions.push_back(slice.origin_mm);
  }
  // Its files say where the slices lie, and it is imported as any series is.
  const TemporaryFolder folder;
  if (Status written = writeCtSeries(scanned, {"tilted", "HEAD"}, folder / "ct"); !written) {
    return written.error();
  }
  for (std::size_t k = 0; k < positions.size(); ++k) {
    char name[32], position[64];
    std::snprintf(name, sizeof name, "IM%04zu.dcm", k + 1);
    std::snprintf(position, sizeof position, "%.6f\\%.6f\\%.6f", positions[k].x, positions[k].y,
                  positions[k].z);
    const std::string file = (folder / "ct" / name).string();
    DcmFileFormat slice;
    if (slice.loadFile(file.c_str()).bad() || slice.loadAllDataIntoMemory().bad() ||
        slice.getDataset()->putAndInsertString(DCM_ImagePositionPatient, position).bad() ||
        slice.saveFile(file.c_str()).bad()) {
      return Error{code::kCannotWrite, "A slice could not be moved", file, ""};
    }
  }
  Result<Case> imported = readCase((folder / "ct").string());
  if (!imported) return imported.error();
  return Volume(*imported->volume);
}

Result<GoldenCase> made(const GoldenLine& line) {
  Result<Exercise> exercise = readExercise(resourceFolder() / "scenes" / (line.exercise + ".json"));
  if (!exercise) return exercise.error();
  if (line.grid == CaseGrid::exercise) {
    Result<Placement> opened = openCase(*exercise);
    if (!opened) return opened.error();
    if (opened->error) return *opened->error;
    exercise->tissues = opened->exercise.tissues;  // with their labels
    return GoldenCase{std::move(*exercise), std::move(*opened)};
  }
  const std::string phantom = phantomNamed(exercise->case_source).value_or("");
  Result<Volume> volume = line.grid == CaseGrid::oblique ? oblique(phantom) : tilted(phantom);
  if (!volume) return volume.error();
  *exercise = onCase(*exercise, "");
  Result<Placement> placed =
      place(*exercise, caseOf(std::make_shared<const Volume>(std::move(*volume))));
  if (!placed) return placed.error();
  exercise->tissues = placed->exercise.tissues;
  return GoldenCase{std::move(*exercise), std::move(*placed)};
}

}  // namespace

Result<GoldenCase> goldenCase(const GoldenLine& line) {
  static std::string name;
  static std::optional<GoldenCase> kept;
  const std::string wanted = line.exercise + "/" + std::to_string(int(line.grid));
  if (name != wanted) {
    kept.reset();
    name.clear();
    Result<GoldenCase> fresh = made(line);
    if (!fresh) return fresh.error();
    kept = std::move(*fresh);
    name = wanted;
  }
  return *kept;
}

}  // namespace trephine::test
