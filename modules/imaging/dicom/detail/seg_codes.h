// What a structure is, in the codes that DICOM segmentations say it with (SNOMED CT). Pure.
#pragma once

#include <string>

namespace trephine {

struct SegmentCode {
  const char* value;
  const char* meaning;
};
struct SegmentCodes {
  SegmentCode category;
  SegmentCode type;
};

// By the end of its name, but for sides and numbers: "Left_Kidney" and "kidney left" are kidneys,
// "liver vessels" are vessels. English names alone; of any other, that it is tissue.
SegmentCodes segmentCodesOf(const std::string& name);

}  // namespace trephine
