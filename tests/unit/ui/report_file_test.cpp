#include "ui/cases/report_file.h"

#include <gtest/gtest.h>

#include <QFile>
#include <QTemporaryDir>

#include "imaging/report/report_page.h"
#include "import_support.h"
#include "qt_support.h"
#include "ui/common/words.h"

namespace trephine {
namespace {

class ReportFileTest : public ::testing::Test {
 protected:
  ReportFileTest() {
    report_.path = "/somewhere/Doe^Jane";
    report_.files_seen = 12;
    report_.series = {test::fakeSeries("1.2.3", Verdict::pass), test::askingSeries("1.2.4")};
  }
  QByteArray written(const char* name) {
    const QString file = folder_.filePath(name);
    const Status status = writeReport(report_, toPath(file));
    EXPECT_TRUE(status.ok());
    QFile in(file);
    return in.open(QIODevice::ReadOnly) ? in.readAll() : QByteArray();
  }
  QApplication& application_ = test::application();
  QTemporaryDir folder_;
  ImportReport report_;
};

TEST_F(ReportFileTest, IsThePageItselfAsHtml) {
  EXPECT_EQ(written("report.html").toStdString(), reportPage(report_));
}

TEST_F(ReportFileTest, IsOneA4PageAsPdf) {
  const QByteArray pdf = written("report.PDF");
  EXPECT_TRUE(pdf.startsWith("%PDF-"));
  EXPECT_TRUE(pdf.contains("/Count 1\n")) << "one page";
  EXPECT_TRUE(pdf.contains("/MediaBox [0 0 595.000000 842.000000]")) << "A4 in points";
  EXPECT_FALSE(pdf.contains("Doe"));
}

TEST_F(ReportFileTest, IsPrintedSmallerBeforeItTakesASecondPage) {
  SeriesReport long_one = test::fakeSeries("1.2.5", Verdict::repaired);
  for (int i = 0; i < 45; ++i) {
    long_one.findings.push_back(
        {Code("X"), Severity::repair, "Something was found", {}, "It was put right"});
  }
  report_.series = {long_one};
  EXPECT_TRUE(written("report.pdf").contains("/Count 1\n"));
}

TEST_F(ReportFileTest, AFolderThatIsNotThereIsSaid) {
  const Status status = writeReport(report_, toPath(folder_.filePath("no/report.pdf")));
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code.str(), "CANNOT_WRITE");
}

}  // namespace
}  // namespace trephine
