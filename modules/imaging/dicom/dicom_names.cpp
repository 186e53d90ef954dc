#include "imaging/dicom/detail/dicom_names.h"

#include <random>

#include "base/sha256.h"
#include "imaging/common/detail/text.h"

namespace trephine {

namespace {

// A person's name means the same with and without empty parts at its end.
std::string bareName(std::string name) {
  while (!name.empty() && (name.back() == '^' || name.back() == '=' || name.back() == ' ')) {
    name.pop_back();
  }
  return name;
}

// "FAMILY^GIVEN^MIDDLE=..." as one reads it: "FAMILY, GIVEN MIDDLE". Of several ways of writing it
// the first.
std::string personName(std::string name) {
  name = bareName(name.substr(0, name.find('=')));
  std::string text;
  for (std::size_t at = 0, parts = 0; at < name.size(); ++parts) {
    const std::size_t end = std::min(name.find('^', at), name.size());
    if (end > at) text += (parts == 0 ? "" : parts == 1 ? ", " : " ") + name.substr(at, end - at);
    at = end + 1;
  }
  return cleanUtf8(text);
}

std::string dayText(const std::string& day) {
  if (day.size() != 8 || !parseInteger(day)) return "";
  return day.substr(0, 4) + '-' + day.substr(4, 2) + '-' + day.substr(6);
}

// Without what writers of one name differ in: case, blanks, and other ways of writing it.
std::string plainName(const std::string& name) {
  std::string plain;
  for (const char c : bareName(name.substr(0, name.find('=')))) {
    if (c != ' ') plain += char(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  }
  return plain;
}

}  // namespace

std::string patientText(const DicomItem& data) {
  std::string text = personName(decodedText(data, DCM_PatientName));
  std::string more = decodedText(data, DCM_PatientID);
  if (const std::string day = dayText(trimmedText(data, DCM_PatientBirthDate)); !day.empty()) {
    more += (more.empty() ? "born " : ", born ") + day;
  }
  if (more.empty()) return text;
  return text.empty() ? more : text + " (" + more + ")";
}

std::string studyText(const DicomItem& data) {
  std::string text = decodedText(data, DCM_StudyDescription);
  const std::string day = dayText(trimmedText(data, DCM_StudyDate));
  if (!day.empty()) text += (text.empty() ? "" : ", ") + day;
  return text;
}

SourceIdentity identityOf(const DicomItem& data) {
  SourceIdentity identity;
  const auto add = [&](IdentityKind kind, const DicomItem& item, const DcmTagKey& tag) {
    for (const std::string& value : splitValues(decodedText(item, tag, data))) {
      identity.add(kind, value);
    }
  };
  for (const DcmTagKey& tag : {DCM_PatientName, DCM_PatientBirthName, DCM_OtherPatientNames}) {
    add(IdentityKind::patient_name, data, tag);
  }
  for (const DcmTagKey& tag : {DCM_PatientID, DCM_RETIRED_OtherPatientIDs}) {
    add(IdentityKind::patient_id, data, tag);
  }
  for (DcmItem* other : data.items(DCM_OtherPatientIDsSequence)) {
    add(IdentityKind::patient_id, DicomItem(other), DCM_PatientID);
  }
  add(IdentityKind::accession, data, DCM_AccessionNumber);
  add(IdentityKind::study_id, data, DCM_StudyID);
  return identity;
}

std::array<std::string, 4> patientOf(const DicomItem& data) {
  static const std::string salt =
      std::to_string(std::random_device{}()) + std::to_string(std::random_device{}());
  // "O" is other, or not told.
  const std::string sex = trimmedText(data, DCM_PatientSex);
  std::array<std::string, 4> who{plainName(decodedText(data, DCM_PatientName)),
                                 trimmedText(data, DCM_PatientID),
                                 trimmedText(data, DCM_PatientBirthDate),
                                 sex == "M" || sex == "F" ? sex : ""};
  for (std::string& one : who) {
    if (one.empty()) continue;
    const std::string salted = salt + one;
    one = sha256Hex(salted.data(), salted.size());
  }
  return who;
}

}  // namespace trephine
