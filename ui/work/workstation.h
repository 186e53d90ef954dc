// The desk in the window: what it says, as signals, and its long work, by the event loop. What a
// person opened to import lies beside it. No widget; window's thread.
#pragma once

#include <QObject>
#include <QTimer>

#include "desk/desk.h"
#include "ui/common/words.h"
#include "ui/work/import_task.h"

namespace trephine {

class Workstation : public QObject, public Desk, private DeskEvents {
  Q_OBJECT
 public:
  // What the workstation locks for who practises at it.
  explicit Workstation(const Policy& policy = {}, QObject* parent = nullptr);
  ~Workstation() override;

  // An exercise brings its own case; any other folder or file is scanned for import().
  void openPath(const std::filesystem::path& path);
  ImportTask& import() { return import_; }

  // As the desk's, with what is said once it is written in a person's language.
  void save(const QString& said, std::function<Status(const Progress&)> write,
            std::function<void()> then = {}, std::function<void()> afterwards = {});
  void saveTissues(const std::filesystem::path& file, std::function<void()> then);
  void saveVolume(const std::filesystem::path& file, std::function<void()> then = {});

 signals:
  // DeskChange, each by its name.
  void exerciseChanged();
  void editsChanged();
  void locksChanged();
  void controllerChanged();
  void armsAnswered();
  void caseOpened();
  void caseNamed();
  void structuresChanged();
  void placingFailed();
  void openingEnded();
  void phaseChanged();
  void sessionStarted();
  void startFailed();
  void savingEnded();

  // As DeskEvents has them.
  void openingProgressed(double fraction, const QString& step);
  void savingProgressed(double fraction, const QString& step);
  void exerciseOpening(const trephine::Exercise& exercise, const std::filesystem::path& file);
  void asked(const trephine::StructureQuestion& question);
  void recordingFailed(const trephine::Error& error);
  void sessionEnded(trephine::Session& session);
  void exerciseReported(const trephine::RunReport& report);
  void saved(const QString& said);
  void failed(const trephine::Error& error);

 private:
  void takeSoon();
  void takeNow();

  void onChange(DeskChange change) override;
  void onOpeningProgress(double fraction, const std::string& step) override {
    emit openingProgressed(fraction, toQt(step));
  }
  void onSavingProgress(double fraction, const std::string& step) override {
    emit savingProgressed(fraction, toQt(step));
  }
  void onExerciseOpening(const Exercise& exercise, const std::filesystem::path& file) override {
    emit exerciseOpening(exercise, file);
  }
  void onQuestion(const StructureQuestion& question) override { emit asked(question); }
  void onRecordingFailed(const Error& error) override { emit recordingFailed(error); }
  void onSessionEnded(Session& session) override { emit sessionEnded(session); }
  void onReport(const RunReport& report) override { emit exerciseReported(report); }
  void onSaved(const std::string& said) override { emit saved(toQt(said)); }
  void onFailure(const Error& error) override { emit failed(error); }

  QTimer look_again_;  // while the desk waits for what wakes nobody
  ImportTask import_;
};

}  // namespace trephine
