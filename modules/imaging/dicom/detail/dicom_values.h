// Values of a DICOM item as plain types, whatever stands in it. For the files of this room that
// know DCMTK.
#pragma once

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "imaging/common/detail/text.h"

namespace trephine {

// No output from DCMTK, decoders registered, its dictionary loaded. Any thread; done once.
void setUpDcmtk();

// The elements of an item or data set, to look up: DCMTK walks a list for each. The item must
// outlive it, unchanged.
class DicomItem {
 public:
  DicomItem() = default;              // without elements
  explicit DicomItem(DcmItem* item);  // the same for null

  // Null where it is absent.
  DcmElement* find(const DcmTagKey& tag) const;
  // The items of a sequence; none where it is absent or no sequence.
  std::vector<DcmItem*> items(const DcmTagKey& sequence) const;
  bool empty() const { return elements_.empty(); }

 private:
  using Entry = std::pair<std::uint32_t, DcmElement*>;
  std::vector<Entry> elements_;  // by group and element
};

// The raw text of an element; empty where it is absent or longer than any attribute that we read.
std::string valueText(const DicomItem& item, const DcmTagKey& tag);
// The same as one trimmed line of valid UTF-8.
std::string trimmedText(const DicomItem& item, const DcmTagKey& tag);
// Decoded by the item's Specific Character Set; never fails.
std::string decodedText(const DicomItem& item, const DcmTagKey& tag);
// The same of an item that lies in `whole`, whose character set it has unless it names its own.
std::string decodedText(const DicomItem& item, const DcmTagKey& tag, const DicomItem& whole);
// A UID, or nothing where it holds what no UID can.
std::string uidText(const DicomItem& item, const DcmTagKey& tag);
// A count: `fallback` where absent, 0 where it is negative or more than `most`, so that products of
// counts fit 64 bit.
int countOr(const DicomItem& item, const DcmTagKey& tag, int fallback, int most);
// A date and time (DT, or a TM alone) as a number that grows with time.
std::optional<double> timeNumber(const DicomItem& item, const DcmTagKey& tag);

template <std::size_t kCount>
std::optional<std::array<double, kCount>> decimals(const DicomItem& item, const DcmTagKey& tag) {
  const auto values = parseDecimals(valueText(item, tag));
  if (!values || values->size() != kCount) return std::nullopt;
  std::array<double, kCount> array;
  std::ranges::copy(*values, array.begin());
  return array;
}

}  // namespace trephine
