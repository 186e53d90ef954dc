// Volumes as files, through VTK's readers and writers, with the full affine both ways.
//
// MetaImage (.mha, .mhd + .raw) is LPS, as we are. NIfTI (.nii, .nii.gz) is RAS: converted here,
// and only here. VTK 9.1's MetaImage writer drops the direction; we see to it that the file has it.
#pragma once

#include <filesystem>

#include "base/result.h"
#include "volume/volume.h"

namespace trephine {

// MetaImage's TransformMatrix is read and written as ITK and 3D Slicer do (meta_image_header.h).
// NIfTI: the sform where there is one, else the qform; its unit of length, rescale slope and
// intercept are honoured, and values are rounded to whole HU. Direction comes out right-handed: the
// slices of a left-handed file are reversed, and every voxel stays where it was in the patient.

// Chooses the format by extension, not by content. Header and file size are compared before
// anything large is allocated. Errors: MISSING_FILE, UNKNOWN_FORMAT, UNREADABLE, BAD_GEOMETRY (a
// direction that is not orthonormal, a spacing that is not positive), TOO_LARGE, NOT_HU (a pixel
// type or range that does not fit int16).
Result<Volume> readVolume(const std::filesystem::path& file);

// .mha (uncompressed), .nii or .nii.gz by extension; written beside the target and renamed, so a
// full disk loses nothing. NIfTI keeps the affine as float. Errors: UNKNOWN_FORMAT, BAD_GEOMETRY,
// BAD_SIZE, TOO_LARGE, CANNOT_WRITE.
// checkVolumeFileName says before a long run whether the name can be written at all.
Status checkVolumeFileName(const std::filesystem::path& file);
Status writeVolume(const Volume& volume, const std::filesystem::path& file);

}  // namespace trephine
