#include "imaging/dicom/detail/transfer_syntax.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcxfer.h>

#include <algorithm>

namespace trephine {

namespace {

constexpr TransferSyntax kReadable[] = {
    {"1.2.840.10008.1.2", "Implicit VR Little Endian", Codec::none, Loss::never},
    {"1.2.840.10008.1.2.1", "Explicit VR Little Endian", Codec::none, Loss::never},
    {"1.2.840.10008.1.2.2", "Explicit VR Big Endian", Codec::none, Loss::never},
    {"1.2.840.10008.1.2.1.99", "Deflated Explicit VR Little Endian", Codec::deflated, Loss::never},
    {"1.2.840.10008.1.2.5", "RLE Lossless", Codec::dcmtk, Loss::never},
    {"1.2.840.10008.1.2.4.50", "JPEG Baseline (Process 1)", Codec::dcmtk, Loss::always},
    {"1.2.840.10008.1.2.4.51", "JPEG Extended (Process 2 and 4)", Codec::dcmtk, Loss::always},
    {"1.2.840.10008.1.2.4.57", "JPEG Lossless (Process 14)", Codec::dcmtk, Loss::named},
    {"1.2.840.10008.1.2.4.70", "JPEG Lossless (Process 14, first-order prediction)", Codec::dcmtk,
     Loss::named},
    {"1.2.840.10008.1.2.4.80", "JPEG-LS Lossless", Codec::dcmtk, Loss::named},
    {"1.2.840.10008.1.2.4.81", "JPEG-LS Near-lossless", Codec::dcmtk, Loss::always},
    {"1.2.840.10008.1.2.4.90", "JPEG 2000 (Lossless only)", Codec::jpeg2000, Loss::named},
    {"1.2.840.10008.1.2.4.91", "JPEG 2000", Codec::jpeg2000, Loss::may_be},
    {"1.2.840.10008.1.2.4.201", "High-Throughput JPEG 2000 (Lossless only)", Codec::jpeg2000,
     Loss::named},
    {"1.2.840.10008.1.2.4.202", "High-Throughput JPEG 2000 with RPCL (Lossless only)",
     Codec::jpeg2000, Loss::named},
    {"1.2.840.10008.1.2.4.203", "High-Throughput JPEG 2000", Codec::jpeg2000, Loss::may_be},
};

}  // namespace

const TransferSyntax* findTransferSyntax(std::string_view uid) {
  const auto it = std::ranges::find(kReadable, uid, &TransferSyntax::uid);
  return it == std::end(kReadable) ? nullptr : &*it;
}

std::string transferSyntaxName(const std::string& uid) {
  if (const TransferSyntax* known = findTransferSyntax(uid)) return std::string(known->name);
  const DcmXfer syntax(uid.c_str());
  return syntax.getXfer() == EXS_Unknown ? "unknown" : syntax.getXferName();
}

}  // namespace trephine
