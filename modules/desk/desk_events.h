// What a desk says to who shows it, on its owner's thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "desk/opening.h"
#include "exercise/exercise.h"
#include "session/session.h"

namespace trephine {

enum class DeskChange {
  exercise,
  edits,           // Desk::edits()
  locks,           // what may be changed
  controller,      // Desk::controllerInForce()
  arms,            // what the arms of the exercise can show
  case_opened,     // `exercise` came before
  case_named,      // the library has it under another name
  structures,      // of the open case, from a file or made here; `exercise` came before
  placing_failed,  // the case stays as it was; onFailure() follows unless it was cancelled
  opening_ended,   // however it ended; what came of it follows
  phase,           // Desk::phase() or isOpening()
  session_started,
  start_failed,  // what the view shows of a session before is gone; onFailure() says why none runs
  saving_ended,  // onSaved() or onFailure() follows, neither where it was cancelled
};

class DeskEvents {
 public:
  virtual void onChange(DeskChange change) = 0;
  // Of what is being opened or saved; `fraction` in [0, 1], which never falls.
  virtual void onOpeningProgress(double fraction, const std::string& step) = 0;
  virtual void onSavingProgress(double fraction, const std::string& step) = 0;
  // Another exercise is being opened, where that is known before the case is read;
  // Desk::exercise() is still the one before.
  virtual void onExerciseOpening(const Exercise& exercise, const std::filesystem::path& file) = 0;
  // Desk::answer() goes on with the answer, within this call or later; without one nothing has
  // changed.
  virtual void onQuestion(const StructureQuestion& question) = 0;
  // Once a session, which goes on; its end does not say it again.
  virtual void onRecordingFailed(const Error& error) = 0;
  // The session's last state; `session` goes away after it.
  virtual void onSessionEnded(Session& session) = 0;
  // After onSessionEnded(), what it came to; not of a poke.
  virtual void onReport(const RunReport& report) = 0;
  // `said`: a sentence for a person, as Desk::save() was given it.
  virtual void onSaved(const std::string& said) = 0;
  virtual void onFailure(const Error& error) = 0;

 protected:
  ~DeskEvents() = default;
};

}  // namespace trephine
