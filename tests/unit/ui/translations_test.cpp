#include "ui/common/translations.h"

#include <gtest/gtest.h>

#include <QProcess>
#include <QTranslator>

#include "base/file.h"
#include "base/tr.h"
#include "qt_support.h"
#include "support.h"
#include "ui/common/words.h"

namespace trephine {
namespace {

constexpr const char* kGerman = R"(<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS><TS version="2.1" language="de"><context><name>trephine</name>
<message><source>{} of the rooms</source><translation>{} der Räume</translation></message>
<message numerus="yes"><source>{} slices of {}</source><translation>
<numerusform>{} Schicht von {}</numerusform><numerusform>{} Schichten von {}</numerusform>
</translation></message>
</context><context><name>trephine::Window</name>
<message><source>A title</source><translation>Ein Titel</translation></message>
</context></TS>)";

class Translations : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(writeTextFile(folder_ / "trephine_de.ts", kGerman));
    QProcess release;
    release.start(TREPHINE_LRELEASE, {"-silent", toQt((folder_ / "trephine_de.ts").string())});
    ASSERT_TRUE(release.waitForFinished());
    ASSERT_EQ(release.exitCode(), 0);
  }
  void TearDown() override {
    setTranslator(nullptr);
    for (QTranslator* one : application_.findChildren<QTranslator*>()) delete one;
  }

  QApplication& application_ = test::application();
  test::TemporaryFolder folder_;
};

TEST_F(Translations, AreOfTheWindowAndOfTheRooms) {
  ASSERT_TRUE(installTranslations(application_, folder_.path(), QLocale("de_CH")));
  EXPECT_EQ(tr("{} of the rooms", 2), "2 der Räume");
  EXPECT_EQ(trCount(1, "{} slice of {}", "{} slices of {}", 2), "1 Schicht von 2");
  EXPECT_EQ(trCount(2, "{} slice of {}", "{} slices of {}", 2), "2 Schichten von 2");
  EXPECT_EQ(QCoreApplication::translate("trephine::Window", "A title"), "Ein Titel");
  EXPECT_EQ(fromRoom("{} of the rooms"), "{} der Räume");
  EXPECT_EQ(tr("Not translated"), "Not translated");
}

TEST_F(Translations, OfALanguageThatIsNotThereAreEnglish) {
  EXPECT_FALSE(installTranslations(application_, folder_.path(), QLocale("fi_FI")));
  EXPECT_EQ(tr("{} of the rooms", 2), "2 of the rooms");
}

}  // namespace
}  // namespace trephine
