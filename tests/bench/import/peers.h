// Other people's programs that read a folder of CT, beside ours.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/import/import_measurement.h"

namespace trephine::bench {

// With those that write a NIfTI volume from a folder (wall time of the whole command, from just
// before it gets its namespace) and the one that reads headers, "gdcmscanner".
ImportSubjects withPeers(ImportSubjects subjects, double limit_s);

// The command in a namespace of its own, without any network; util-linux' unshare makes it and
// becomes the program.
std::vector<std::string> offline(std::vector<std::string> words);

// Whether a volume file holds the known voxels, each in its place in the patient: slices, rows and
// columns may run either way.
bool holdsKnownVoxels(const std::filesystem::path& file, const KnownVolume& known);

}  // namespace trephine::bench
