// Compressed frames -> stored words.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "base/result.h"
#include "imaging/dicom/detail/dicom_file.h"
#include "imaging/dicom/detail/transfer_syntax.h"

namespace trephine {

// Whether a codestream of this syntax lost something, by its first bytes: a DCT, a JPEG-LS that is
// near, a point transform, the irreversible wavelet. Nothing where they do not tell. Any thread.
std::optional<bool> isLossyCodestream(const TransferSyntax& syntax,
                                      std::span<const std::uint8_t> first_bytes);

// The bits of a value that a codestream of JPEG, JPEG-LS or JPEG 2000 says it has, by its first
// bytes; nothing where they do not tell, and of RLE. Any thread.
std::optional<int> bitsOfCodestream(const TransferSyntax& syntax,
                                    std::span<const std::uint8_t> first_bytes);

// Decodes one grey frame into rows * columns words in native byte order; 8-bit pixels are widened.
// The codestream's own size must be that of the header. Error: `what` says why not. Any thread.
Status decodeFrame(const TransferSyntax& syntax, std::span<const std::uint8_t> codestream,
                   const DicomHeader& header, std::int16_t* words);

}  // namespace trephine
