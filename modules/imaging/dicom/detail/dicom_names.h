// Whom and what a file is of: for the screen, and to be compared; neither is ever written.
#pragma once

#include <array>
#include <string>

#include "imaging/common/source_identity.h"
#include "imaging/dicom/detail/dicom_values.h"

namespace trephine {

// "FAMILY, GIVEN (ID, born 1970-12-31)"
std::string patientText(const DicomItem& data);

// "Head, 2024-05-03": what a study is called, and its day.
std::string studyText(const DicomItem& data);

// All names of the patient, IDs, accession number and the study's own ID, as they stand there.
SourceIdentity identityOf(const DicomItem& data);

// Name, ID and birth date, each hashed, empty where absent. Nobody can be found by them outside of
// this process: what is hashed along differs in each.
std::array<std::string, 4> patientOf(const DicomItem& data);

}  // namespace trephine
