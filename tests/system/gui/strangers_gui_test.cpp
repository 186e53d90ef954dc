// Names, pages and pictures that a stranger may have made: they are shown as they are, and open
// nothing. What each would open is a pipe, which keeps for ever whoever opens it.
#include <sys/stat.h>

#include <QDialog>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QPushButton>
#include <QTextBrowser>
#include <QToolTip>
#include <QTreeWidget>
#include <QtTest>
#include <algorithm>

#include "base/codes.h"
#include "base/file.h"
#include "gui_support.h"
#include "library/case_library.h"
#include "train_support.h"
#include "training/codes.h"
#include "ui/cases/cases_page.h"
#include "ui/common/error_dialog.h"
#include "ui/common/question.h"
#include "ui/review/review_page.h"

using namespace trephine;

class StrangersGuiTest : public test::TrainTest {
  Q_OBJECT

  QString pipe_;
  // Markup of every kind, and what a person can still read in it.
  std::string name() const {
    return "<b>x</b><img src='" + pipe_.toStdString() + "'><a href='file:///etc/passwd'>y</a>";
  }
  std::filesystem::path storage() const { return toPath(temporary_.filePath("storage")); }

  // No label takes text for markup by itself, and those that do so on purpose are known.
  void allLabelsArePlain(const QWidget& of) {
    const QStringList on_purpose{"reportCard", "exerciseSteps",   "exerciseRemoved", "resultRows",
                                 "tradeView",  "structureReport", "controllerTrade",
                                 "startCardSteps"};
    for (const QLabel* label : of.findChildren<QLabel*>()) {
      if (!label->testAttribute(Qt::WA_WState_Polished)) continue;
      const QString what = label->objectName() + " \"" + label->text().left(60) + '"';
      QVERIFY2(label->textFormat() != Qt::AutoText, qPrintable(what));
      QVERIFY2(!label->openExternalLinks(), qPrintable(what));
      if (label->textFormat() != Qt::RichText) continue;
      const bool known = std::ranges::any_of(
          on_purpose, [&](const QString& one) { return label->objectName().startsWith(one); });
      QVERIFY2(known || label->objectName().startsWith("trade:") ||
                   label->objectName().contains("Trade"),
               qPrintable(what));
    }
  }

 private slots:
  void initTestCase() {
    QVERIFY(QDir().mkpath(TREPHINE_ARTEFACTS));
    pipe_ = temporary_.filePath("pipe");
    QCOMPARE(::mkfifo(qPrintable(pipe_), 0600), 0);
  }
  void init() { open(); }
  void cleanup() { window_.reset(); }

  void theNameGoalAndStepsOfAnExerciseAreShownAsTheyAre() {
    const std::filesystem::path file =
        test::exerciseOn(test::coarseCranium(2), toPath(temporary_.path()), "strange");
    Json json = *readJsonFile(file);
    json["name"] = name();
    for (auto& [language, card] : json["card"].items()) {
      card["goal"] = card["hands"] = name();
      card["steps"] = {name(), name()};
    }
    QVERIFY(writeTextFile(file, json.dump()).ok());
    openExercise(file);
    QTRY_VERIFY(find<QWidget>("startCard")->isVisible());
    rest();
    QCOMPARE(find<QLabel>("startCardGoal")->text(), toQt(name()));
    auto* steps = find<QLabel>("startCardSteps");  // a numbered list of ours
    QCOMPARE(steps->textFormat(), Qt::RichText);
    QVERIFY(steps->text().contains(toQt(name()).toHtmlEscaped()));
    QVERIFY(!steps->text().contains(toQt(name())));
    for (const char* label : {"startCardTitle", "startCardGoal", "startCardHands"}) {
      if (auto* shown = window_->findChild<QLabel*>(label)) {
        QCOMPARE(shown->textFormat(), Qt::PlainText);
      }
    }
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/strange-card.png"));
    for (const Place place : {Place::cases, Place::prepare, Place::train, Place::review}) {
      window_->show(place);
      rest();
      allLabelsArePlain(*window_);
    }
    window_->show(Place::train);
    startTraining();
    pass(0.5);
    allLabelsArePlain(*window_);
    workstation().stop();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().session(), kLong_ms);
    rest();
    allLabelsArePlain(*window_);
  }

  void dialogsTooltipsAndQuestionsShowTextAsItIs() {
    const Error error{code::kBadField, name(), name(), name()};
    const QPointer<QMessageBox> box = showError(window_.get(), error);
    rest();
    for (const QLabel* label : box->findChildren<QLabel*>()) {
      if (label->text().isEmpty()) continue;
      QCOMPARE(label->textFormat(), Qt::PlainText);
    }
    allLabelsArePlain(*box);
    QVERIFY(box->grab().save(TREPHINE_ARTEFACTS "/strange-error.png"));
    box->close();
    const QPointer<QMessageBox> question =
        ask(window_.get(), "strange", toQt(name()), toQt(name()), "Go on", [] {});
    rest();
    allLabelsArePlain(*question);
    question->close();
    QToolTip::showText(window_->mapToGlobal(QPoint(100, 100)), toQt(name()), window_.get());
    rest();
    QLabel* tip = nullptr;
    for (QWidget* each : QApplication::topLevelWidgets()) {
      if (each->inherits("QTipLabel")) tip = qobject_cast<QLabel*>(each);
    }
    QVERIFY(tip);
    QCOMPARE(tip->textFormat(), Qt::PlainText);
    QToolTip::hideText();
  }

  void aCasesNamePictureAndPageOpenNothing() {
    CaseLibrary library(storage());
    NewCase of;
    auto volume = std::make_shared<Volume>();
    volume->geometry.size = {16, 16, 16};
    volume->hu.assign(volume->geometry.voxelCount(), 40);
    of.volume = volume;
    const auto saved = library.save(of);
    QVERIFY(saved.ok());
    const std::filesystem::path folder = saved->record.folder;
    Json record = *readJsonFile(folder / "case.json");
    record["name"] = "<img src='/p'><b>z</b>";
    record["verdict"] = "pass";
    QVERIFY(writeTextFile(folder / "case.json", record.dump()).ok());
    QVERIFY(writeTextFile(folder / "report.html", "<h1>Report</h1><img src='" +
                                                      pipe_.toStdString() + "'><a href='" +
                                                      pipe_.toStdString() + "'>more</a>")
                .ok());
    std::filesystem::remove(folder / "picture.png");
    QVERIFY(writeTextFile(folder / "picture.png",
                          "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'/>")
                .ok());
    window_.reset();
    open();
    auto* cards = find<QListWidget>("cases");
    const auto row = [&]() -> QListWidgetItem* {
      for (int i = 0; i < cards->count(); ++i) {
        if (cards->item(i)->data(Qt::UserRole).toString() == toQt(saved->record.id)) {
          return cards->item(i);
        }
      }
      return nullptr;
    };
    QTRY_VERIFY_WITH_TIMEOUT(row(), kLong_ms);
    cards->setCurrentItem(row());
    rest();
    allLabelsArePlain(*window_);
    auto* report = find<QPushButton>("caseReport");
    QTRY_VERIFY(report->isEnabled());
    report->click();
    QTRY_VERIFY(window_->findChild<QDialog*>("reportDialog"));
    auto* page = find<QDialog>("reportDialog")->findChild<QTextBrowser*>();
    rest();
    QVERIFY(page->toPlainText().contains("Report"));
    QVERIFY(!page->openLinks());
    find<QDialog>("reportDialog")->close();
  }

  // A folder of damaged recordings takes its time: nobody is told meanwhile that there are none.
  void listsSayThatTheyAreStillReadAndShowWhatIsThere() {
    ListedRecording bad;
    bad.file = "/r/bad.h5";
    bad.volume_sha256 = "s";
    bad.problem = Error{code::kBadRecording, "The recording is damaged", "/r/bad.h5", ""};
    ReviewPage review;
    review.show();
    const auto* none = review.findChild<QLabel*>("noRecordings");
    const auto* reading = review.findChild<QLabel*>("readingRecordings");
    const auto* rows = review.findChild<QTreeWidget*>("recordings");
    QVERIFY(reading->isVisible() && none->text().isEmpty());
    review.showRecordings({bad}, false, "", {});
    QVERIFY(reading->isVisible());
    QCOMPARE(rows->topLevelItemCount(), 1);
    review.showRecordings({bad}, true, "", {});
    QVERIFY(!reading->isVisible());
    review.showRecordings({}, true, "", {});
    QVERIFY(none->isVisible() && none->text().contains("No exercise has been recorded"));
    review.showRecordings({bad}, false, "", {});
    review.showNoRecordings("The recordings cannot be listed.");
    QVERIFY(reading->isVisible() && rows->isVisible());
    QCOMPARE(reading->text(), QString("The recordings cannot be listed."));
    // What a replay came to stays while the list grows.
    ListedRecording good = bad;
    good.file = "/r/good.h5";
    good.problem.reset();
    review.showRecordings({good}, false, "s", {});
    review.showOutcome("It replays bit for bit.");
    review.showRecordings({good, bad}, true, "s", {});
    QCOMPARE(review.findChild<QLabel*>("replayOutcome")->text(), QString("It replays bit for bit."));

    CasesPage cases;
    cases.show();
    CaseEntry entry;
    entry.id = entry.record.name = "a";
    entry.record.volume_sha256 = "s";
    cases.showCases({entry});
    const auto* done = cases.findChild<QLabel*>("caseExercises");
    QVERIFY2(done->text().contains("Reading"), qPrintable(done->text()));
    cases.showRecordings({}, true);
    QVERIFY(done->text().contains("No exercise has been done"));
    cases.showNoRecordings("The recordings cannot be listed.");
    QCOMPARE(done->text(), QString("The recordings cannot be listed."));
    cases.showRecordings({bad}, false);
    cases.showNoRecordings("The recordings cannot be listed.");
    QVERIFY(done->text().contains("cannot be listed") && done->text().contains("0:00"));
    cases.showRecordings({bad, bad}, false);
    QVERIFY(!cases.allRecordingsRead());
    QCOMPARE(cases.exercisesOn(entry).size(), 2u);
    cases.showRecordings({bad}, false);
    QCOMPARE(cases.exercisesOn(entry).size(), 2u);  // while they are read anew
    cases.showRecordings({bad}, true);
    QCOMPARE(cases.exercisesOn(entry).size(), 1u);
  }

  void noDialogLeavesBehindWhereItHasBeen() {
    const QString secret = "Mueller Hans";
    QVERIFY(QDir(temporary_.path()).mkpath(secret));
    test::prefer([](Preferences& of) { of.language = Language::zh_TW; });  // so that there is a file
    find<QAction>("settings")->trigger();
    QTRY_VERIFY(window_->findChild<QDialog*>("settingsDialog"));
    find<QPushButton>("chooseStorage")->click();
    QTRY_VERIFY(window_->findChild<QFileDialog*>("storageDialog"));
    const auto choose = [&](QFileDialog* of) {
      const QPointer<QFileDialog> dialog = of;
      dialog->setDirectory(temporary_.filePath(secret));
      dialog->setSidebarUrls({QUrl::fromLocalFile(temporary_.filePath(secret))});
      rest();
      static_cast<QDialog*>(dialog.data())->accept();
      QTRY_VERIFY(!dialog);
    };
    choose(find<QFileDialog>("storageDialog"));
    find<QDialog>("settingsDialog")->reject();
    rest();
    find<QAction>("open")->trigger();
    choose(find<QFileDialog>("folderDialog"));
    window_.reset();
    QDirIterator files(qEnvironmentVariable("XDG_CONFIG_HOME"), QDir::Files | QDir::Hidden,
                       QDirIterator::Subdirectories);
    int read = 0;
    while (files.hasNext()) {
      QFile file(files.next());
      QVERIFY(file.open(QIODevice::ReadOnly));
      const QByteArray bytes = file.readAll();
      QVERIFY2(!bytes.contains("Mueller"), qPrintable(file.fileName() + ": " + bytes));
      ++read;
    }
    QVERIFY2(read > 0, "nothing was kept at all: the test looks in the wrong place");
  }
};

int main(int argc, char** argv) {
  return test::runInWindow<StrangersGuiTest>(argc, argv);
}

#include "strangers_gui_test.moc"
