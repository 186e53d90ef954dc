// DICOM files of every kind, made element by element: nothing of what is tested is in them.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/math.h"
#include "jpeg2000_fixture.h"

namespace trephine::test {

using Bytes = std::vector<std::uint8_t>;

// One CT file: a slice, or the frames of an enhanced image.
struct Image {
  int columns = 7, rows = 5, frames = 1;
  int bits_allocated = 16, bits_stored = 12, high_bit = 11;
  bool is_signed = false;
  std::string slope = "1", intercept = "-1024";  // "": left out
  Vec3 position_mm{-20.0, 10.5, 100.0};
  std::array<double, 6> orientation{1, 0, 0, 0, 1, 0};
  std::array<double, 2> spacing_mm{0.75, 0.5};  // between rows, between columns
  int instance = 1;
  std::vector<int> stored;  // values of all frames; they may be negative where signed

  int pixels() const { return columns * rows; }
};

// A value that differs from those beside it, in 0 .. 2^bits - 1 (less 2^(bits - 1) where signed).
int patternValue(int i, int j, int k, int bits = 12, bool is_signed = false);
// Fills `stored` with the pattern of slices k, k + 1, ...
void fillPattern(Image& image, int k);

// "1.5\\-2" with all the digits that a DS may have.
std::string decimalText(double value);
std::string positionText(const Vec3& position_mm);

// Classic CT: Series UID 1.2.3.4, SOP Instance UID 1.2.3.4.<instance>.
DcmDataset makeImage(const Image& image);

// Enhanced CT: pixel measures, orientation and rescale are shared; each frame says where it lies.
DcmDataset makeEnhanced(const Image& image, const std::vector<Vec3>& positions_mm);
// The functional group of a frame (from 0), or the shared one (-1): made where it is not there.
DcmItem& functionalGroup(DcmDataset& data, const DcmTagKey& macro, int frame);

struct Packing {
  E_TransferSyntax syntax = EXS_LittleEndianExplicit;
  int predictor = 1;          // of JPEG Lossless, 1..7
  int near_by = 0;            // of JPEG-LS near-lossless
  bool irreversible = false;  // of JPEG 2000
  int fragments = 1;          // a frame
  bool offset_table = true;   // of encapsulated pixels
  // What the file calls it; the syntax itself where unknown.
  E_TransferSyntax called = EXS_Unknown;
};

bool isEncapsulated(E_TransferSyntax syntax);

// The frames' codestreams.
std::vector<Bytes> encodeFrames(DcmDataset& data, const Packing& packing);
// The data set with these codestreams for pixels.
void saveEncapsulated(DcmDataset& data, const std::vector<Bytes>& codestreams,
                      const Packing& packing, const std::filesystem::path& file);
// Encodes where the syntax asks for it.
void save(DcmDataset& data, const std::filesystem::path& file, const Packing& packing = {});

}  // namespace trephine::test
