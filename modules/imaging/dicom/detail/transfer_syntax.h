// Which transfer syntaxes can be read, and by what. Anything that is not in the list is refused by
// its name and UID.
#pragma once

#include <string>
#include <string_view>

namespace trephine {

enum class Codec {
  none,      // words as they stand, in the data set's byte order
  deflated,  // the whole data set through zlib
  dcmtk,     // RLE, JPEG, JPEG-LS: decoders that are registered with DCMTK
  jpeg2000,  // JPEG 2000 and HTJ2K through OpenJPEG
};

enum class Loss {
  never,
  named,   // by name only: the codestream tells, and is taken for lossless where it does not
  may_be,  // the codestream tells, and is taken for lossy where it does not
  always,
};

struct TransferSyntax {
  std::string_view uid;
  std::string_view name;
  Codec codec;
  Loss loss;
};

// Null for a syntax that cannot be read.
const TransferSyntax* findTransferSyntax(std::string_view uid);

// "JPEG 2000 (Lossless only)"; "unknown" for a UID that nobody published.
std::string transferSyntaxName(const std::string& uid);

}  // namespace trephine
