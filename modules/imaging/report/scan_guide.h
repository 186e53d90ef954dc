// What is shown of a scan and its series on the screen and nowhere else: who the patient is, and
// what has been found while the scan still runs.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trephine {

// Whom and what a series is of. For the screen alone: never in a file, log or picture.
struct ScreenNames {
  std::string patient_key, study_key;  // equal for series of one patient, of one study; not shown
  std::string patient, study;          // valid UTF-8; empty where nothing is known
};

// A series that a scan has come upon so far.
struct FoundSeries {
  std::string uid, description, modality;
  int slices = 0;
  ScreenNames names;
};

// Between a scan and a person who watches it. Any thread.
class ScanGuide {
 public:
  // `found` gets the series so far, in the order in which they were found, a few times a second:
  // on any thread, one call at a time.
  explicit ScanGuide(std::function<void(const std::vector<FoundSeries>&)> found)
      : found_(std::move(found)) {}

  void tell(const std::vector<FoundSeries>& found) const { found_(found); }

  // This series is enough: of the files that are still to be read only those in the folders in
  // which it was found are. What is no series that was found changes nothing.
  void choose(const std::string& uid) {
    const std::lock_guard lock(mutex_);
    chosen_ = uid;
  }
  std::optional<std::string> chosen() const {
    const std::lock_guard lock(mutex_);
    return chosen_;
  }

 private:
  std::function<void(const std::vector<FoundSeries>&)> found_;
  mutable std::mutex mutex_;
  std::optional<std::string> chosen_;
};

}  // namespace trephine
