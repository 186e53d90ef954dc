// The report card as one printable page.
#pragma once

#include <string>

#include "imaging/report/report.h"

namespace trephine {

// HTML that stands alone, in the subset that Qt's text documents print too; one A4 page for all but
// the largest folders. It names no patient, path, description or UID, so that it may leave the
// room: series are numbered as in the report.
std::string reportPage(const ImportReport& report);

}  // namespace trephine
