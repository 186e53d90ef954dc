#include "exercise/policy.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "base/descriptor.h"
#include "base/system.h"
#include "base/tr.h"
#include "exercise/codes.h"
#include "exercise/exercise_fields.h"

namespace trephine {

namespace fs = std::filesystem;

namespace {

constexpr off_t kMostBytes = off_t{1} << 20;

Policy allLocked(const fs::path& file, Error why) {
  Policy policy;
  for (const auto& [name, lock] : kLockNames) policy.locks.insert(lock);
  policy.folder = file.parent_path();
  why.what = tr("Everything is locked: {}", why.what);
  policy.problem = std::move(why);
  return policy;
}

Error unreadable(const fs::path& file, const std::string& why) {
  return {code::kPolicyUnreadable, tr("The workstation's settings cannot be read: {}", why),
          file.string(), tr("An administrator must correct the file or take it away")};
}

Error unsafe(const fs::path& path) {
  return {
      code::kPolicyUnsafe,
      tr("Others than an administrator could change the workstation's settings"), path.string(),
      tr("An administrator must make it root's own, and take from group and others the right to "
         "write (chown root, chmod go-w)")};
}

bool safe(const struct stat& of) {
  return !couldChange(::geteuid(), of.st_uid, of.st_mode);
}

// What is asked of the file and what is read is one file, whatever happens to its name.
Result<std::string> contentOf(const fs::path& file) {
  // A link is not followed: it would lead to where nobody looked who may write. A pipe would wait.
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!in.ok()) {
    return unreadable(file, errno == ELOOP ? tr("it is a link") : std::strerror(errno));
  }
  struct stat of {};
  if (::fstat(in.get(), &of) != 0) return unreadable(file, std::strerror(errno));
  if (!S_ISREG(of.st_mode))
    return unreadable(file, tr("it is no file but a folder, a pipe or a device"));
  if (!safe(of)) return unsafe(file);
  if (of.st_size > kMostBytes) return unreadable(file, tr("it is larger than 1 MB"));
  std::string text(std::size_t(of.st_size), '\0');
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t got = ::read(in.get(), text.data() + done, text.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(file, std::strerror(errno));
    if (got == 0) break;
    done += std::size_t(got);
  }
  text.resize(done);
  return text;
}

// `true`, `false`, or a value to which it is locked: then `value` reads it.
template <class Value>
void readLock(JsonReader& locks, const char* key, Lock lock, Policy& policy, const Value& value) {
  if (!locks.has(key)) return;
  const bool flag = locks.raw(key).is_boolean();
  if (flag && !locks.boolean(key, false)) return;
  policy.locks.insert(lock);
  if (!flag) value();
}

// Whether a file lies below a folder, links followed.
bool isBelow(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

// Also all folders between the two, and the folder itself.
bool safeBelow(fs::path file, const fs::path& folder) {
  if (!isBelow(file, folder)) return false;
  struct stat of {};
  for (; isBelow(file, folder); file = file.parent_path()) {
    if (::stat(file.c_str(), &of) != 0 || !safe(of)) return false;
    if (file == file.root_path()) break;
  }
  return true;
}

bool isOfTheWorkstation(const Policy& policy, const fs::path& exercise_file) {
  std::error_code ec;
  const fs::path file = fs::canonical(exercise_file, ec);
  if (ec || exercise_file.empty()) return false;
  const fs::path own = fs::canonical(resourceFolder() / "scenes", ec);
  if (!ec && isBelow(file, own)) return true;
  const fs::path folder = fs::canonical(policy.folder, ec);
  return !ec && !policy.folder.empty() && safeBelow(file, folder);
}

}  // namespace

bool couldChange(unsigned user, unsigned owner, unsigned mode) {
  const bool own = owner == user && user != 0;  // who owns it can give himself the right
  return own || (mode & (S_IWGRP | S_IWOTH)) != 0;
}

Result<Policy> parsePolicy(const Json& json, const fs::path& file) {
  JsonReader reader(json, file.string());
  reader.format("trephine.settings", 1);
  Policy policy;
  policy.folder = file.parent_path();
  policy.storage = reader.text("storage", "");
  if (!policy.storage.empty() && !policy.storage.is_absolute()) {
    reader.fail("storage",
                tr("The folder '{}' is not given from the root", policy.storage.string()),
                tr("Let it begin with /"));
  }
  if (reader.has("locks")) {
    JsonReader locks = reader.object("locks");
    readLock(locks, "controller", Lock::controller, policy, [&] {
      const std::string name = locks.text("controller");
      policy.controller = kindOf(kControllerNames, name);
      if (locks.ok() && !policy.controller) {
        locks.fail("controller", tr("Unknown controller '{}'", name),
                   tr("{}, true, false", choices(kControllerNames)));
      }
    });
    readLock(locks, "tissues", Lock::tissues, policy,
             [&] { locks.fail("tissues", tr("Expected true or false")); });
    readLock(locks, "rate", Lock::rate, policy,
             [&] { policy.rate_hz = locks.number("rate", kRate_hz); });
  }
  if (reader.has("pin")) policy.pin = readPin(reader.object("pin"));
  if (Status status = reader.finish(); !status) return status.error();
  return policy;
}

Policy readPolicy(const fs::path& file) {
  struct stat of {};
  const fs::path folder = file.parent_path();
  if (::stat(folder.c_str(), &of) == 0 && !safe(of)) return allLocked(file, unsafe(folder));
  if (::lstat(file.c_str(), &of) != 0 && errno == ENOENT) {
    Policy open;
    open.folder = folder;
    return open;
  }
  const Result<std::string> text = contentOf(file);
  if (!text) return allLocked(file, text.error());
  const Result<Json> json = parseJson(*text, file.string());
  if (!json) return allLocked(file, json.error());
  Result<Policy> policy = parsePolicy(*json, file);
  return policy ? *std::move(policy) : allLocked(file, policy.error());
}

Policy policyAtStart(const fs::path& file) {
  Policy policy = readPolicy(file);
  if (!policy.locks.empty()) keepToOwnFolders();
  return policy;
}

std::vector<fs::path> exercisesOfWorkstation(const Policy& policy, bool for_research) {
  std::vector<fs::path> all;
  const auto add = [&](auto entries) {
    const auto first = std::ptrdiff_t(all.size());
    std::error_code ec;
    for (; entries != decltype(entries)(); entries.increment(ec)) {
      if (entries->path().extension() == ".json") all.push_back(entries->path());
    }
    std::sort(all.begin() + first, all.end());
  };
  std::error_code ec;
  add(fs::directory_iterator(resourceFolder() / "scenes", ec));
  if (for_research) add(fs::directory_iterator(resourceFolder() / "scenes" / "research", ec));
  const auto own = std::ptrdiff_t(all.size());
  add(fs::recursive_directory_iterator(policy.folder, fs::directory_options::skip_permission_denied,
                                       ec));
  all.erase(std::remove_if(all.begin() + own, all.end(),
                           [&](const fs::path& file) { return !isOfTheWorkstation(policy, file); }),
            all.end());
  return all;
}

std::string unlocking(const Policy& policy) {
  if (const std::optional<Error>& why = policy.problem) {
    return why->what + " (" + why->where + "): " + why->next;
  }
  return policy.pin ? tr("An educator can unlock it with a PIN (menu File)")
                    : tr("Nothing at this workstation unlocks it");
}

Locks locksOf(const Policy& policy, const Exercise& exercise) {
  Locks locks = policy.locks;
  locks.insert(exercise.locks.begin(), exercise.locks.end());
  return locks;
}

Status checkExercise(const Policy& policy, const Exercise& exercise,
                     const fs::path& exercise_file) {
  const auto locked = [&](const std::string& what) {
    return Error{code::kLocked, what, exercise_file.string(),
                 policy.problem ? policy.problem->what + ": " + policy.problem->next
                 : policy.pin   ? tr("Choose an exercise of the workstation, or ask an educator to "
                                       "unlock it")
                                : tr("Choose an exercise of the workstation")};
  };
  const auto name = [](ControllerKind kind) { return std::string(controllerName(kind)); };
  if (policy.controller && exercise.controller != *policy.controller) {
    return locked(tr("The exercise has the controller '{}', and this workstation allows '{}' alone",
                     name(exercise.controller), name(*policy.controller)));
  }
  if (policy.rate_hz && exercise.rate_hz != *policy.rate_hz) {
    return locked(tr("The exercise has a rate of {} Hz, and this workstation allows {} Hz alone",
                     plainNumber(exercise.rate_hz), plainNumber(*policy.rate_hz)));
  }
  std::string own;
  const auto add = [&](Lock lock, bool prescribed, const char* what) {
    if (policy.isLocked(lock) && !prescribed) own += (own.empty() ? "" : ", ") + std::string(what);
  };
  add(Lock::tissues, false, "tissues");
  add(Lock::controller, policy.controller.has_value(), "a controller");
  add(Lock::rate, policy.rate_hz.has_value(), "a rate");
  if (own.empty() || isOfTheWorkstation(policy, exercise_file)) return {};
  return locked(tr(
      "The exercise is not one of the workstation's, and would bring what is locked: {} of its own",
      own));
}

}  // namespace trephine
