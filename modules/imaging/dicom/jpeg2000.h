// One grey frame in JPEG 2000 (ISO/IEC 15444-1) or HTJ2K (15444-15) -> stored pixel words. The only
// file of this room that knows OpenJPEG.
//
// Both functions take a bare codestream or one in a JP2 file, as some writers store it, and ignore
// what follows its end (padding). Pure; any number of calls may run at once, each decoding on its
// own thread alone; nothing is printed.
#pragma once

#include <cstdint>
#include <span>

#include "base/result.h"

namespace trephine {

// What the DICOM header says of a frame.
struct Jpeg2000Expectation {
  int rows = 0, columns = 0;
  int bits_allocated = 16;  // 8 or 16
  int bits_stored = 16;     // 1 .. bits_allocated
  bool is_signed = false;   // Pixel Representation 1
};

// Decodes into `words`, rows * columns of them: each sample as a 16-bit word of native order in its
// low bits (high bit = bits stored - 1), sign-extended where `expected` is signed. A codestream may
// have fewer bits than are stored, or more (some writers code whole 16-bit words of 12-bit CT).
//
// PS3.5 8.2.4 wants codestream and header to agree on the sign. Where they do not, the header is
// right and the coded bits are read modulo 2^precision in its sense, as pydicom reads them.
//
// Sizes, sample format, tiles and packets are compared with `expected` and with the bytes given
// before anything is allocated, and the memory used grows with rows * columns alone. Errors,
// UNREADABLE: it is no such frame; it is cut short, damaged or of another size; or it is of a kind
// that no scanner is known to write (over 8192x8192 pixels or 4096 tiles, tiles of several kinds,
// HTJ2K in several layers or with packet markers). JPEG 2000 has no checksum: spoilt bytes may also
// decode to other values. `words` is undefined after an error.
Status decodeJpeg2000(std::span<const std::uint8_t> bytes, const Jpeg2000Expectation& expected,
                      std::int16_t* words);

// Whether the wavelet is the irreversible 9-7, so that the frame was compressed with loss. A
// reversible one can have lost detail too, if its writer left some out; the DICOM header alone
// tells. Reads only the main header, so the first kilobytes of a frame will do.
Result<bool> isIrreversibleJpeg2000(std::span<const std::uint8_t> bytes);

}  // namespace trephine
