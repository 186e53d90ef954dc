// How several files make one input: a byte of modes, then the files, each a byte for its name and
// its contents, with kNextFile between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "imaging/codes.h"
#include "imaging/importer.h"
#include "volume/codes.h"

namespace trephine::fuzz {

enum Mode : std::uint8_t {
  kOpenFirstFile = 1,  // not the folder
  kReduce = 2,
  kCrop = 4,
  kOtherAnswers = 8,
};

constexpr std::string_view kNextFile = "\nNEXT\n";

// The first is numbered, so that a series has any number of slices; of the others one each.
enum Name : std::uint8_t {
  kSlice,
  kDicomDir,
  kNifti,
  kNiftiGz,
  kNrrd,
  kNhdr,
  kMha,
  kMhd,
  kRaw,
  kJson,
  kNames
};
constexpr const char* kFileNames[kNames] = {"IM",     "DICOMDIR", "v.nii", "v.nii.gz", "v.nrrd",
                                            "v.nhdr", "v.mha",    "v.mhd", "v.raw",    "v.json"};

// To every question; the second where the input asks for it.
inline const Answers kAnswers{{code::kMissingSlices, "fill"},
                              {code::kUnevenSpacing, "resample"},
                              {code::kPhases, "1"},
                              {code::kDuplicatePositions, "first"},
                              {code::kLossySource, "accept"},
                              {code::kLocationMismatch, "positions"},
                              {code::kMixedSlices, "accept"},
                              {code::kDerivedImages, "accept"},
                              {code::kValueMap, "accept"},
                              {code::kImplausibleHu, "accept"},
                              {code::kParts, "join"},
                              {code::kSparseSlices, "accept"},
                              {code::kCouch, "remove"},
                              {code::kFormsDiffer, "sform"},
                              {code::kHighBits, "use"},
                              {code::kIncomplete, "accept"},
                              {code::kOneLocation, "locations"},
                              {code::kSlopesDiffer, "accept"},
                              {code::kFace, "deface"},
                              {code::kFaceTakesMore, "accept"},
                              {code::kFaceRemains, "keep"}};
inline const Answers kOther{{code::kMissingSlices, "part"},
                            {code::kUnevenSpacing, "part"},
                            {code::kPhases, "2"},
                            {code::kDuplicatePositions, "last"},
                            {code::kLossySource, "accept"},
                            {code::kLocationMismatch, "positions"},
                            {code::kMixedSlices, "accept"},
                            {code::kDerivedImages, "accept"},
                            {code::kValueMap, "accept"},
                            {code::kImplausibleHu, "accept"},
                            {code::kFormsDiffer, "qform"},
                            {code::kHighBits, "mask"},
                            {code::kParts, "1"},
                            {code::kSparseSlices, "accept"}};

struct File {
  std::string name;
  std::string_view bytes;
};

inline std::string fileName(std::uint8_t name, std::size_t number) {
  const std::uint8_t known = name % kNames;
  return known == kSlice ? kFileNames[kSlice] + std::to_string(number) : kFileNames[known];
}

inline std::vector<File> filesIn(std::string_view input) {
  std::vector<File> files;
  while (!input.empty()) {
    const std::size_t end = input.find(kNextFile);
    const std::string_view part = input.substr(0, end);
    if (!part.empty()) {
      files.push_back({fileName(std::uint8_t(part[0]), files.size()), part.substr(1)});
    }
    if (end == input.npos) break;
    input.remove_prefix(end + kNextFile.size());
  }
  return files;
}

}  // namespace trephine::fuzz
