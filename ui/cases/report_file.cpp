#include "ui/cases/report_file.h"

#include "base/file.h"
#include "imaging/report/report_page.h"
#include "ui/common/pdf_page.h"
#include "ui/common/words.h"

namespace trephine {

Status writeReport(const ImportReport& report, const std::filesystem::path& file,
                   const std::optional<std::string>& only) {
  const std::string html = reportPage(report, only);
  if (toQt(file).endsWith(".pdf", Qt::CaseInsensitive)) {
    const QByteArray bytes = pdfOf(QString::fromStdString(html));
    return writeTextFile(file, std::string_view(bytes.constData(), std::size_t(bytes.size())));
  }
  return writeTextFile(file, html);
}

}  // namespace trephine
