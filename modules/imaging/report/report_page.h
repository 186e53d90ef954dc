// The report card as one printable page.
#pragma once

#include <optional>
#include <string>

#include "imaging/report/report.h"

namespace trephine {

// HTML that stands alone, in the subset that Qt's text documents print too; one A4 page for all but
// the largest folders. It names no patient, path, description or UID, so that it may leave the
// room: series are numbered as in the report. Of `only` (a uid), else of the series that was
// read, it says all, and how many others there are; without either it tells of every series.
std::string reportPage(const ImportReport& report, const std::optional<std::string>& only = {});

}  // namespace trephine
