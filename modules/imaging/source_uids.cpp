#include "imaging/source_uids.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "base/codes.h"
#include "base/memory.h"
#include "base/tr.h"
#include "imaging/codes.h"
#include "imaging/common/source_ids.h"
#include "imaging/series/detail/scan.h"
#include "imaging/series/detail/series.h"

namespace trephine {

namespace {

Error badSource(const std::string& what, const std::string& next) {
  return {code::kBadSource, what, "", next};
}

bool isOf(const DicomHeader& slice, const SourceIds& ids) {
  return slice.series_key.empty() && ids.standsFor(ids.series, hashOrNone(slice.series_uid)) &&
         ids.standsFor(ids.study, hashOrNone(slice.study_uid)) &&
         ids.standsFor(ids.frame_of_reference, hashOrNone(slice.frame_of_reference));
}

// Whether the slice lies along the grid's own, within half a step of one of them.
bool liesIn(const DicomHeader& slice, const GridGeometry& g) {
  if (!slice.position_mm || !slice.orientation) return false;
  const auto& o = *slice.orientation;
  const Vec3 normal = glm::cross(Vec3(o[0], o[1], o[2]), Vec3(o[3], o[4], o[5]));
  constexpr double kAlong = 0.85;  // cosine; a tilted gantry leans by up to 30 degrees
  if (std::abs(glm::dot(normal, g.direction[2])) < kAlong) return false;
  const double at = glm::dot(*slice.position_mm - g.origin_mm, g.direction[2]) / g.spacing_mm.z;
  return at > -0.5 - 1e-6 && at < g.size[2] - 0.5 + 1e-6;
}

}  // namespace

Result<RawSourceUids> sourceUids(const std::filesystem::path& source, const Provenance& of,
                                 const GridGeometry& on, const Progress& progress) {
  const SourceIds& ids = of.source_ids;
  if (ids.unreadable) {
    return badSource(tr("Which CT the case is of cannot be checked: this account may not read it"),
                     tr("Ask whoever imported the case"));
  }
  if (of.source != "DICOM" || ids.series.empty() || ids.study.empty() ||
      ids.frame_of_reference.empty()) {
    return badSource(tr("The case is of no DICOM series whose UIDs are known"),
                     tr("Write the CT anew with the structures, or give the CT's DICOM folder"));
  }
  try {
    Result<ScannedFiles> files = scanFiles(source, progress, nullptr);
    if (!files) return files.error();
    std::erase_if(files->headers, [&](const DicomHeader& slice) { return !isOf(slice, ids); });
    // One UID may be that of several stacks: the case's is the one that lies on its grid.
    std::vector<DicomHeader> best;
    for (Series& series : groupSeries(std::move(files->headers), progress)) {
      const SeriesPlan plan = assessSeries(series, of.answers);
      std::vector<DicomHeader> used;
      for (const std::size_t n : plan.sources) {
        if (liesIn(series.slices[n], on)) used.push_back(series.slices[n]);
      }
      if (used.size() > best.size()) best = std::move(used);
    }
    if (progress.cancelled())
      return Error{code::kCancelled, tr("Reading the CT was cancelled"), "", ""};
    if (best.empty()) {
      return badSource(tr("The CT of the case is not in this folder"),
                       tr("Give the DICOM folder that the case was made from"));
    }
    RawSourceUids uids{best.front().study_uid, best.front().series_uid,
                       best.front().frame_of_reference};
    for (const DicomHeader& slice : best) {
      uids.slices.push_back({slice.sop_class, slice.sop_instance,
                             slice.frames > 1 ? slice.frame + 1 : 0, *slice.position_mm});
    }
    return uids;
  } catch (const std::bad_alloc&) {
    return outOfMemory(tr("to look at the CT"), "");
  }
}

}  // namespace trephine
