// Imports a folder of CT with its couch and without it, finds the skull and writes all three: for
// comparing with what others make of the same voxels.
//
//   skull_of FOLDER OUT    (writes OUT/whole.nii, OUT/ct.nii and OUT/skull.nii)
#include <filesystem>
#include <iostream>
#include <string>

#include "base/json.h"
#include "imaging/codes.h"
#include "imaging/importer.h"
#include "structures/skull.h"
#include "volume/volume_files.h"

namespace trephine {

namespace {

Status make(const std::filesystem::path& folder, const std::filesystem::path& out) {
  auto ct = CtFolder::scan(folder, Progress());
  if (!ct) return ct.error();
  const std::optional<std::string> series = ct->bestSeries();
  if (!series) return Error{code::kNoCt, "There is no CT", folder.string(), ""};
  for (const std::string answer : {"keep", "remove"}) {
    ImportRequest request;
    request.answers = {{code::kCouch, answer}};
    const Result<Volume> volume = ct->read(*series, request, Progress());
    if (!volume) return volume.error();
    const bool whole = answer == "keep";
    if (Status written = writeVolume(*volume, out / (whole ? "whole.nii" : "ct.nii")); !written) {
      return written;
    }
    if (whole) continue;
    const Result<Skull> skull = skullOf(*volume);
    if (!skull) return skull.error();
    if (Status written = writeLabelMap(skull->mask, out / "skull.nii"); !written) return written;
    std::cout << Json{{"hu", skull->hu},
                      {"voxels", skull->voxels},
                      {"ml", skull->ml},
                      {"steps", skull->steps}}
                     .dump()
              << "\n";
  }
  return {};
}

}  // namespace

}  // namespace trephine

int main(int count, char** arguments) {
  if (count != 3) {
    std::cerr << "usage: skull_of FOLDER OUT\n";
    return 2;
  }
  const trephine::Status made = trephine::make(arguments[1], arguments[2]);
  if (!made) std::cerr << made.error().sentence() << "\n";
  return made ? 0 : 1;
}
