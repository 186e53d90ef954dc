// What can go wrong while a case is kept: its tissues gone or spoilt, a full disk, a kill in the
// middle, an arm that goes away. The window says it in words, and nothing that was there is lost.
#include <QDirIterator>
#include <QFrame>
#include <QLabel>
#include <QListWidget>
#include <QMessageBox>
#include <QProcess>
#include <QPushButton>
#include <QSignalSpy>
#include <QtTest>
#include <cstdio>
#include <random>

#include "file_size_limit.h"
#include "gui_support.h"
#include "training/replay.h"
#include "training/session_reader.h"

using namespace trephine;

namespace {

constexpr double kMore = 1.0;  // N s/m that an edit adds
const char* const kChild = "--child";

void setDamping(MainWindow& window, double add) {
  TissueSet set = window.workstation().exercise()->tissues;
  for (Tissue& tissue : set.tissues) {
    if (tissue.id == "bone") tissue.damping_Ns_per_m.value += add;
  }
  window.workstation().setTissues(set);
}

}  // namespace

class OddSavesGuiTest : public test::WindowTest {
  Q_OBJECT

 public:
  // A window that saves a case and then its tissues, and says what it has begun and done: to be
  // killed in between.
  static int saveInAWindow(int argc, char** argv, const QString& storage, const QString& volume) {
    QApplication application(argc, argv);
    QStandardPaths::setTestModeEnabled(true);
    QApplication::setApplicationName("trephine-test-killed");
    const auto say = [](const char* words) {
      std::printf("%s\n", words);
      std::fflush(stdout);
    };
    MainWindow window(toPath(storage + "/sessions"));
    show(window);
    Workstation& workstation = window.workstation();
    Result<Volume> read = readVolume(toPath(volume));
    if (!read) return 1;
    workstation.openImported(caseOf(std::make_shared<const Volume>(*std::move(read))));
    if (!QTest::qWaitFor([&] { return workstation.phase() == Workstation::Phase::ready; },
                         kLong_ms))
      return 1;
    say("saving");
    window.findChild<QPushButton*>("saveCase")->click();
    if (!QTest::qWaitFor([&] { return !workstation.currentCase()->stored.empty(); }, kLong_ms))
      return 1;
    say("saved");
    setDamping(window, kMore);
    QSignalSpy saved(&workstation, &Workstation::saved);
    window.findChild<QAction*>("saveInCase")->trigger();
    if (saved.isEmpty() && !saved.wait(kLong_ms)) return 1;
    say("changed");
    return 0;
  }

 private:
  static void show(MainWindow& window) {
    window.resize(1000, 700);
    window.show();
  }
  QString storage() { return temporary_.filePath("storage"); }
  void open() {
    window_ = newWindow(toPath(storage() + "/sessions"));
    show(*window_);
    QVERIFY(QTest::qWaitForWindowExposed(window_.get()));
    QApplication::setActiveWindow(window_.get());
  }
  // What the window said in a dialog, which goes.
  QString said() {
    if (!QTest::qWaitFor([&] { return window_->findChild<QMessageBox*>("errorDialog"); },
                         kLong_ms)) {
      return {};
    }
    auto* dialog = find<QMessageBox>("errorDialog");
    const QString words = dialog->text() + ' ' + dialog->informativeText();
    dialog->close();
    rest();
    return words;
  }
  void openVolume() {
    workstation().openImported(caseOf(std::make_shared<const Volume>(test::coarseCranium(4))));
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
  }
  void prepareMine(const QString& id) {
    window_->show(Place::cases);
    auto* cards = find<QListWidget>("cases");
    const auto row = [&] {
      for (int i = 0; i < cards->count(); ++i) {
        if (cards->item(i)->data(Qt::UserRole).toString() == id) return i;
      }
      return -1;
    };
    QTRY_VERIFY_WITH_TIMEOUT(row() >= 0, kLong_ms);
    cards->setCurrentRow(row());
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    QTest::mouseClick(find<QPushButton>("prepareCase"), Qt::LeftButton);
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
  }
  static double damping(const TissueSet& set) { return set.find("bone")->damping_Ns_per_m.value; }
  double dampingNow() { return damping(workstation().exercise()->tissues); }
  static std::map<QString, QByteArray> filesOf(const QString& folder) {
    std::map<QString, QByteArray> files;
    QDirIterator it(folder, QDir::Files | QDir::Hidden, QDirIterator::Subdirectories);
    while (it.hasNext()) {
      QFile file(it.next());
      if (file.open(QIODevice::ReadOnly)) files[file.fileName()] = file.readAll();
    }
    return files;
  }
  QString onlyCase() {
    return QDir(storage() + "/cases").entryList(QDir::Dirs | QDir::NoDotAndDotDot).value(0);
  }

 private slots:
  void init() { open(); }
  void cleanup() {
    window_.reset();
    QDir(storage()).removeRecursively();
    QFile::remove(windowSettings().fileName());
  }

  void aDiskThatIsFullWhileACaseIsSavedIsSaidAndTheCaseStaysOpen() {
    openVolume();
    window_->show(Place::cases);
    QVERIFY(find<QPushButton>("saveCase")->isVisible());
    {
      const test::FileSizeLimit full(100000);
      find<QPushButton>("saveCase")->click();
      const QString words = said();
      QVERIFY2(words.contains("space") || words.contains("room"), qPrintable(words));
      QVERIFY2(words.contains("What to do"), qPrintable(words));
    }
    QVERIFY(onlyCase().isEmpty());
    QCOMPARE(QDir(storage() + "/.parts").entryList(QDir::AllEntries | QDir::NoDotAndDotDot).size(),
             0);
    QVERIFY(workstation().currentCase()->stored.empty());
    QVERIFY(find<QPushButton>("saveCase")->isVisible());
    QVERIFY(find<QLabel>("nextStepTitle")->text().contains("not saved"));
    find<QPushButton>("saveCase")->click();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().currentCase()->stored.empty(), kLong_ms);
    QVERIFY(CaseLibrary(toPath(storage())).load(onlyCase().toStdString()));
  }

  void aDiskThatIsFullWhileItIsSavedInTheCaseLosesNeitherTheOldNorTheNew() {
    openVolume();
    window_->show(Place::cases);
    find<QPushButton>("saveCase")->click();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().currentCase()->stored.empty(), kLong_ms);
    const QString folder = storage() + "/cases/" + onlyCase();
    const auto before = filesOf(folder);
    const double old = dampingNow();
    setDamping(*window_, kMore);
    {
      const test::FileSizeLimit full(100);
      find<QAction>("saveInCase")->trigger();
      const QString words = said();
      QVERIFY2(words.contains("space") || words.contains("room"), qPrintable(words));
    }
    QVERIFY(filesOf(folder) == before);
    QVERIFY(workstation().tissuesEdited());
    QCOMPARE(dampingNow(), old + kMore);
    find<QAction>("saveInCase")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().tissuesEdited(), kLong_ms);
    QVERIFY(filesOf(folder) != before);
  }

  void aCaseWithoutItsTissuesOpensWithTheExercisesAndSaysSo() {
    openVolume();
    window_->show(Place::cases);
    find<QPushButton>("saveCase")->click();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().currentCase()->stored.empty(), kLong_ms);
    const double old = dampingNow();
    setDamping(*window_, kMore);
    find<QAction>("saveInCase")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().tissuesEdited(), kLong_ms);
    const QString id = onlyCase(), file = storage() + "/cases/" + id + "/tissues.json";
    QFile kept(file);
    QVERIFY(kept.open(QIODevice::ReadOnly));
    const QByteArray whole = kept.readAll();
    kept.close();
    const QByteArray wrong = QByteArray(whole).replace("\"opacity\": ", "\"opacity\": -1");
    for (const QByteArray& spoilt : {QByteArray(), QByteArray("{\"format\":"),
                                     whole.left(whole.size() / 2), QByteArray("[]"), wrong}) {
      window_.reset();
      QFile::remove(windowSettings().fileName());
      QVERIFY(QFile::remove(file));
      if (!spoilt.isEmpty()) {
        QFile written(file);
        QVERIFY(written.open(QIODevice::WriteOnly));
        written.write(spoilt);
      }
      open();
      prepareMine(id);
      const QString words = said();
      qInfo("%s", qPrintable(words));
      QVERIFY2(words.contains("own tissues cannot be used") && words.contains("tissues.json") &&
                   words.contains("What to do"),
               qPrintable(words));
      QVERIFY(workstation().currentCase() &&
              workstation().currentCase()->stored == id.toStdString());
      QCOMPARE(dampingNow(), old);
      QCOMPARE(QFile(file).exists(), !spoilt.isEmpty());  // it is left for who can mend it
      if (spoilt.isEmpty()) {
        QFile written(file);
        QVERIFY(written.open(QIODevice::WriteOnly));
      }
    }
    // Mended as the words say: set, and saved in the case.
    setDamping(*window_, 2.0 * kMore);
    find<QAction>("saveInCase")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(!workstation().tissuesEdited(), kLong_ms);
    window_.reset();
    open();
    prepareMine(id);
    QCOMPARE(dampingNow(), old + 2.0 * kMore);
    QVERIFY(!window_->findChild<QMessageBox*>("errorDialog"));
  }

  void aWindowThatIsKilledWhileItSavesLeavesWholeCasesAlone() {
    const QString volume = temporary_.filePath("head.mha");
    const Volume head = test::coarseCranium(4);
    QVERIFY(writeVolume(head, toPath(volume)));
    const std::string sha = volumeSha256(head);
    window_.reset();
    std::optional<double> old;
    double whole_ms = 0.0;
    int ended = 0, there = 0;
    std::mt19937 random(20);
    for (int n = 0; n <= 20; ++n) {  // the first is not killed
      QProcess child;
      child.start(QCoreApplication::applicationFilePath(), {kChild, storage(), volume});
      QByteArray out;
      const auto waitFor = [&](const char* words) {
        QElapsedTimer since;
        since.start();
        while (!out.contains(words) && since.elapsed() < kLong_ms) {
          if (!child.waitForReadyRead(1000) && child.state() == QProcess::NotRunning) break;
          out += child.readAllStandardOutput();
        }
        return out.contains(words);
      };
      QVERIFY2(waitFor("saving"), child.readAllStandardError().constData());
      QElapsedTimer since;
      since.start();
      if (n == 0) {
        QVERIFY(waitFor("changed"));
        whole_ms = double(since.nsecsElapsed()) * 1e-6;
      } else {
        // The true clock is the matter: it is killed at any moment of what it does.
        QTest::qSleep(int(whole_ms * 1.8 * double(random() % 1000) / 1000.0));
        child.kill();
      }
      QVERIFY(child.waitForFinished(kLong_ms));
      out += child.readAllStandardOutput();
      ended += n > 0 && out.contains("changed");
      CaseLibrary library(toPath(storage()));
      QCOMPARE(
          QDir(storage() + "/.parts").entryList(QDir::AllEntries | QDir::NoDotAndDotDot).size(), 0);
      const auto cases = library.list();
      QVERIFY(int(cases.size()) == there || int(cases.size()) == there + 1);
      QVERIFY(!out.contains("saved") || int(cases.size()) == there + 1);
      there = int(cases.size());
      for (const ListedCase& one : cases) {
        QVERIFY2(!one.problem, one.problem ? one.problem->sentence().c_str() : "");
        const auto loaded = library.load(one.id);
        QVERIFY2(loaded.ok(), loaded ? "" : loaded.error().sentence().c_str());
        QCOMPARE(loaded->record.volume_sha256, sha);
        const auto set = parseTissueSet(loaded->tissues, "tissues.json");
        QVERIFY(set.ok());
        if (!old) old = damping(*set) - kMore;
        QVERIFY2(damping(*set) == *old || damping(*set) == *old + kMore,
                 qPrintable(QString::number(damping(*set))));
      }
    }
    qInfo("a save and a change take %.0f ms; of 20, %d ended before they were killed, %d cases",
          whole_ms, ended, there);
    QVERIFY(ended < 20);
    open();
    auto* cards = find<QListWidget>("cases");
    QTRY_COMPARE_WITH_TIMEOUT(cards->count(), there + 2, kLong_ms);
    for (int i = 0; i < cards->count(); ++i) {
      QVERIFY2(!cards->item(i)->text().contains("Cannot be opened"),
               qPrintable(cards->item(i)->text()));
    }
  }

  void anArmThatGoesAwayIsSaidWithWhatToDoAndNothingIsLost() {
    const std::filesystem::path folder = toPath(temporary_.path());
    const std::filesystem::path file =
        test::exerciseOn(test::coarseCranium(2), folder, "vanishing");
    Json device = *readJsonFile(resourceFolder() / "devices" / "omni.json");
    device["vanish_after_s"] = 1.5;
    QVERIFY(writeTextFile(folder / "vanishing-arm.json", device.dump()));
    const std::string config = (folder / "vanishing-arm.json").string();
    workstation().setArms({{"left", {kSimulated, 0, config}}, {"right", {kSimulated, 1, config}}});
    QSignalSpy opened(&workstation(), &Workstation::caseOpened);
    window_->open(file);
    QVERIFY(opened.count() == 1 || opened.wait(kLong_ms));
    QSignalSpy started(&workstation(), &Workstation::sessionStarted);
    find<QAction>("start")->trigger();
    QVERIFY(started.count() == 1 || started.wait(kLong_ms));
    auto* notice = find<QFrame>("forceNotice");
    QTRY_VERIFY_WITH_TIMEOUT(notice->isVisible(), kLong_ms);
    auto* title = find<QLabel>("forceNoticeTitle");
    auto* why = find<QLabel>("forceNoticeWhy");
    QVERIFY2(title->text().contains("NO FORCE"), qPrintable(title->text()));
    QVERIFY2(why->text().contains("cable") || why->text().contains("connect"),
             qPrintable(why->text()));
    auto* mend = find<QPushButton>("forceOn");
    QVERIFY(mend->isVisible());
    QVERIFY2(mend->text().contains("Try again"), qPrintable(mend->text()));
    QVERIFY(window_->grab().save(TREPHINE_ARTEFACTS "/odd-arm-gone.png"));
    const std::uint64_t ticks = workstation().session()->state().ticks;
    QTest::mouseClick(mend, Qt::LeftButton);
    QTRY_VERIFY_WITH_TIMEOUT(workstation().session()->state().ticks > ticks + 500, kLong_ms);
    QVERIFY(notice->isVisible());  // it is still away
    for (const ArmRecord& arm : workstation().session()->state().record.arms) {
      QVERIFY(glm::length(arm.sent_N) == 0.0);
    }
    find<QAction>("stop")->trigger();
    QTRY_VERIFY_WITH_TIMEOUT(workstation().phase() == Workstation::Phase::ready, kLong_ms);
    const QStringList recordings = QDir(storage() + "/sessions").entryList({"*.h5"});
    QCOMPARE(recordings.size(), 1);
    const auto reader = SessionReader::open(toPath(storage() + "/sessions/" + recordings.front()));
    QVERIFY(reader.ok());
    const auto again = replay(**reader, *workstation().currentCase()->volume);
    QVERIFY2(again.ok(), again ? "" : again.error().sentence().c_str());
    QVERIFY(again->identical);
  }
};

int main(int argc, char** argv) {
  if (argc == 4 && QString(argv[1]) == kChild) {
    if (!prepareDisplay()) return 77;
    return OddSavesGuiTest::saveInAWindow(argc, argv, argv[2], argv[3]);
  }
  return test::runInWindow<OddSavesGuiTest>(argc, argv);
}

#include "odd_saves_gui_test.moc"
