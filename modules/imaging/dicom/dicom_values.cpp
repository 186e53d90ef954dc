#include "imaging/dicom/detail/dicom_values.h"

#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <dcmtk/oflog/oflog.h>
#include <dcmtk/ofstd/ofchrenc.h>

#include <mutex>

#include "imaging/dicom/detail/dicom_stream.h"

namespace trephine {

namespace {

std::uint32_t tagNumber(const DcmTagKey& tag) {
  return std::uint32_t(tag.getGroup()) << 16 | tag.getElement();
}

// Japanese text of several sets (ISO 2022) as EUC-JP, which holds them all and which iconv knows,
// as it does not JIS X 0208 alone. A set is chosen by an escape and lasts until the next.
std::string eucJpOf(std::string_view text) {
  struct Set {
    std::string_view escape;
    std::string_view prefix;  // of each character
    int bytes;
  };
  constexpr Set kSets[] = {{"(B", "", 0}, {"(J", "", 0}, {"(I", "\x8E", 1},
                           {"$@", "", 2}, {"$B", "", 2}, {"$(D", "\x8F", 2}};
  constexpr char kEscape = 0x1B, kHigh = char(0x80);
  const Set* set = &kSets[0];
  std::string euc;
  while (!text.empty()) {
    if (text.front() == kEscape) {
      text.remove_prefix(1);
      const auto next =
          std::ranges::find_if(kSets, [&](const Set& one) { return text.starts_with(one.escape); });
      if (next == std::end(kSets)) continue;
      set = next;
      text.remove_prefix(set->escape.size());
      continue;
    }
    // Half-width katakana (JIS X 0201) has the high bit beside Latin letters.
    if (set->bytes == 0 || std::size_t(set->bytes) > text.size()) {
      if (text.front() & kHigh) euc += '\x8E';
      euc += text.front();
      text.remove_prefix(1);
      continue;
    }
    euc += set->prefix;
    for (int n = 0; n < set->bytes; ++n) euc += char(text[std::size_t(n)] | kHigh);
    text.remove_prefix(std::size_t(set->bytes));
  }
  return euc;
}

bool isJapanese(const std::string& charset) {
  return charset.find("ISO 2022 IR 87") != charset.npos ||
         charset.find("ISO 2022 IR 159") != charset.npos;
}

std::optional<std::string> japaneseUtf8(const std::string& raw) {
  const std::string euc = eucJpOf(raw);
  OFCharacterEncoding iconv;
  OFString utf8;
  if (iconv.selectEncoding("EUC-JP", "UTF-8").bad() ||
      iconv.convertString(OFString(euc.data(), euc.size()), utf8).bad()) {
    return std::nullopt;
  }
  return std::string(utf8.c_str(), utf8.length());
}

}  // namespace

void setUpDcmtk() {
  static std::once_flag once;
  std::call_once(once, [] {
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);
    dcmEnableUnknownVRConversion.set(OFTrue);  // known attributes sent as VR UN
    DcmRLEDecoderRegistration::registerCodecs();
    DJDecoderRegistration::registerCodecs();
    DJLSDecoderRegistration::registerCodecs();
    dcmDataDict.rdlock();  // loads the dictionary
    dcmDataDict.rdunlock();
  });
}

DicomItem::DicomItem(DcmItem* item) {
  if (!item) return;
  elements_.reserve(item->card());
  for (DcmObject* at = item->nextInContainer(nullptr); at; at = item->nextInContainer(at)) {
    elements_.emplace_back(tagNumber(at->getTag()), static_cast<DcmElement*>(at));
  }
  if (!std::ranges::is_sorted(elements_, {}, &Entry::first)) {
    std::ranges::stable_sort(elements_, {}, &Entry::first);
  }
}

DcmElement* DicomItem::find(const DcmTagKey& tag) const {
  const auto it = std::ranges::lower_bound(elements_, tagNumber(tag), {}, &Entry::first);
  return it != elements_.end() && it->first == tagNumber(tag) ? it->second : nullptr;
}

std::vector<DcmItem*> DicomItem::items(const DcmTagKey& sequence) const {
  std::vector<DcmItem*> items;
  DcmElement* element = find(sequence);
  if (!element || element->ident() != EVR_SQ) return items;
  auto* list = static_cast<DcmSequenceOfItems*>(element);
  for (DcmObject* at = list->nextInContainer(nullptr); at; at = list->nextInContainer(at)) {
    items.push_back(static_cast<DcmItem*>(at));
  }
  return items;
}

std::string valueText(const DicomItem& item, const DcmTagKey& tag) {
  DcmElement* element = item.find(tag);
  // getLength() would load it.
  if (!element || element->getLengthField() > kLongestValue) return "";
  OFString text;
  if (element->getOFStringArray(text).bad()) return "";
  return std::string(text.c_str(), text.length());
}

std::string trimmedText(const DicomItem& item, const DcmTagKey& tag) {
  return cleanUtf8(valueText(item, tag));
}

std::string decodedText(const DicomItem& item, const DcmTagKey& tag) {
  return decodedText(item, tag, item);
}

std::string decodedText(const DicomItem& item, const DcmTagKey& tag, const DicomItem& whole) {
  const std::string raw = valueText(item, tag);
  const bool plain = std::ranges::all_of(raw, [](char c) { return c >= 0x20 && c < 0x7F; });
  if (plain) return cleanUtf8(raw);
  std::string charset = valueText(item, DCM_SpecificCharacterSet);
  if (charset.empty()) charset = valueText(whole, DCM_SpecificCharacterSet);
  DcmSpecificCharacterSet converter;
  OFString utf8;
  if (!charset.empty() &&
      converter.selectCharacterSet(OFString(charset.data(), charset.size()), "ISO_IR 192").good() &&
      converter.convertString(OFString(raw.data(), raw.size()), utf8).good()) {
    return cleanUtf8(std::string_view(utf8.c_str(), utf8.length()));
  }
  if (isJapanese(charset)) {
    if (const auto japanese = japaneseUtf8(raw)) return cleanUtf8(*japanese);
  }
  return guessUtf8(raw);
}

std::string uidText(const DicomItem& item, const DcmTagKey& tag) {
  const std::string text = trimmedText(item, tag);
  const bool valid = text.size() <= 64 && std::ranges::all_of(text, [](char c) {
                       return c == '.' || (c >= '0' && c <= '9');
                     });
  return valid ? text : "";
}

int countOr(const DicomItem& item, const DcmTagKey& tag, int fallback, int most) {
  const int count = parseInteger(valueText(item, tag)).value_or(fallback);
  return count >= 0 && count <= most ? count : 0;
}

std::optional<double> timeNumber(const DicomItem& item, const DcmTagKey& tag) {
  std::string text = trimmedText(item, tag);
  text = text.substr(0, text.find_first_of("+-"));  // the offset from UTC is the same for all
  // A time may end after its hours or minutes, and so may one behind a date.
  constexpr std::size_t kDate = 8, kTime = 6;
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::size_t of_time = digits > kDate ? digits - kDate : digits;
  if (digits == text.size() && (of_time == 2 || of_time == 4)) text.append(kTime - of_time, '0');
  return parseDecimal(text);
}

}  // namespace trephine
