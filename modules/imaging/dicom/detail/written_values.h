// Values as they are written into a DICOM file.
#pragma once

#include <initializer_list>
#include <string>

namespace trephine {

// A DS value: the shortest text that reads back as `value`, or as near as 16 characters allow.
std::string decimalText(double value);
// Several, with backslashes between.
std::string decimalsText(std::initializer_list<double> values);

// A UID under 2.25 (PS3.5 B.2) from the first 128 bits of a SHA-256: the same for equal content.
std::string uidOf(const std::string& content);

}  // namespace trephine
