#include "ui/work/workstation.h"

#include "ui/work/arms_of_place.h"

namespace trephine {

Workstation::Workstation(const Policy& policy, QObject* parent)
    : QObject(parent),
      Desk(policy, *this, armSettings, [this] { takeSoon(); }),
      import_([this] { return givenBack_mb(); }) {
  connect(&import_, &ImportTask::failed, this, &Workstation::failed);
  constexpr int kLookAgain_ms = 10;
  look_again_.setInterval(kLookAgain_ms);
  connect(&look_again_, &QTimer::timeout, this, &Workstation::takeNow);
}

Workstation::~Workstation() = default;

// Any thread.
void Workstation::takeSoon() {
  QMetaObject::invokeMethod(this, &Workstation::takeNow, Qt::QueuedConnection);
}

void Workstation::takeNow() {
  take();
  waits() ? look_again_.start() : look_again_.stop();
}

void Workstation::openPath(const std::filesystem::path& path) {
  if (isExercise(path)) return openExercise(path);
  if (mayOpen()) import_.scan(path);
}

void Workstation::save(const QString& said, std::function<Status(const Progress&)> write,
                       std::function<void()> then, std::function<void()> afterwards) {
  Desk::save(said.toStdString(), std::move(write), std::move(then), std::move(afterwards));
}

void Workstation::saveTissues(const std::filesystem::path& file, std::function<void()> then) {
  const QString said =
      tr("The tissues are saved. A scene uses them where it names that file under 'tissues'.");
  Desk::saveTissues(file, said.toStdString(), std::move(then));
}

void Workstation::saveVolume(const std::filesystem::path& file, std::function<void()> then) {
  Desk::saveVolume(file, tr("The volume is saved.").toStdString(), std::move(then));
  if (waits()) look_again_.start();
}

// --- What the desk says ---

void Workstation::onChange(DeskChange change) {
  switch (change) {
    case DeskChange::exercise:
      return emit exerciseChanged();
    case DeskChange::edits:
      return emit editsChanged();
    case DeskChange::locks:
      return emit locksChanged();
    case DeskChange::controller:
      return emit controllerChanged();
    case DeskChange::arms:
      return emit armsAnswered();
    case DeskChange::case_opened:
      return emit caseOpened();
    case DeskChange::case_named:
      return emit caseNamed();
    case DeskChange::structures:
      return emit structuresChanged();
    case DeskChange::placing_failed:
      return emit placingFailed();
    case DeskChange::opening_ended:
      return emit openingEnded();
    case DeskChange::phase:
      return emit phaseChanged();
    case DeskChange::session_started:
      return emit sessionStarted();
    case DeskChange::start_failed:
      return emit startFailed();
    case DeskChange::saving_ended:
      return emit savingEnded();
  }
}

}  // namespace trephine
