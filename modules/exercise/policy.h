// What the workstation locks for those who practise at it, and where it keeps its cases: a file
// that its users cannot write. resources/schemas/settings.md.
//
// Locks hold for who uses the programs of this workstation. Who may run programs of his own on it
// can run another Trephine.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/pin.h"
#include "base/result.h"
#include "exercise/exercise.h"

namespace trephine {

inline constexpr const char* kPolicyFile = "/etc/trephine/settings.json";

struct Policy {
  Locks locks;
  // Where these are locked to a value: every exercise has to have it, also the product's own.
  std::optional<ControllerKind> controller;
  std::optional<double> rate_hz;
  std::filesystem::path storage;  // where cases are kept; empty: as the user's settings say
  std::optional<Pin> pin;         // takes the locks off for one session; none: nothing does
  std::filesystem::path folder;   // of the file; exercises in it are the workstation's own
  std::optional<Error> problem;   // why everything is locked, and there is no PIN

  bool isLocked(Lock lock) const { return locks.contains(lock); }
};

// Without the file nothing is locked. Everything is, with a `problem` that says why, where the file
// is there and cannot be read (POLICY_UNREADABLE, or the error of its content), or where this user
// could have written it or its folder (POLICY_UNSAFE): a mistake must not open what was locked.
Policy readPolicy(const std::filesystem::path& file);
// Errors: BAD_FIELD (file, field and value named).
Result<Policy> parsePolicy(const Json& json, const std::filesystem::path& file);

// The same, for a program as the first thing that it does, before it has threads: where anything is
// locked, the environment no longer says where exercises and plugins are (keepToOwnFolders).
Policy policyAtStart(const std::filesystem::path& file = kPolicyFile);

// Who takes off what the workstation locks, or why nobody does; without a stop, as Error::next.
std::string unlocking(const Policy& policy);

// What is locked while this exercise is practised.
Locks locksOf(const Policy& policy, const Exercise& exercise);

// The exercises of this workstation: the product's exercises, `for_research` also those that are
// for comparison with others' work, then those below the policy's folder that this user could not
// have written, each in the order of their names. Of what is no exercise: none.
std::vector<std::filesystem::path> exercisesOfWorkstation(const Policy& policy,
                                                          bool for_research = false);

// LOCKED where the exercise would bring what the workstation locks: a controller or a rate other
// than the one that is prescribed, or, from a file that is neither the product's (resourceFolder())
// nor in the policy's folder, tissues, a controller or a rate of its own. A file of that folder
// which this user could have written is not of it. An empty name is an exercise of nobody's.
Status checkExercise(const Policy& policy, const Exercise& exercise,
                     const std::filesystem::path& exercise_file);

// Whether what has this owner and these permission bits may be changed by others than an
// administrator. Nothing is kept from root (user 0).
bool couldChange(unsigned user, unsigned owner, unsigned mode);

}  // namespace trephine
