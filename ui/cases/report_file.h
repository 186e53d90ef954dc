// The import report as a file to hand on: the page of imaging/report/report_page.h, which names no
// patient.
#pragma once

#include <filesystem>

#include "imaging/importer.h"

namespace trephine {

// HTML, or for a name ending in .pdf an A4 page of the same text; it is printed smaller, down to
// 60 %, before it takes a second page. `only`: as of reportPage(). Any thread, with a
// QGuiApplication. Errors: CANNOT_WRITE.
Status writeReport(const ImportReport& report, const std::filesystem::path& file,
                   const std::optional<std::string>& only = {});

}  // namespace trephine
