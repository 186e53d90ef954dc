// Compressed frames -> stored words.
#pragma once

#include <cstdint>
#include <span>

#include "base/result.h"
#include "imaging/dicom_file.h"
#include "imaging/transfer_syntax.h"

namespace trephine {

// Decodes one grey frame into rows * columns words in native byte order; 8-bit pixels are widened.
// The codestream's own size must be that of the header. Error: `what` says why not. Any thread.
Status decodeFrame(const TransferSyntax& syntax, std::span<const std::uint8_t> codestream,
                   const DicomHeader& header, std::int16_t* words);

}  // namespace trephine
