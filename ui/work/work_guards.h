// What can be lost while no file has it, and who guards it. Errors are said. Window's thread.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <utility>
#include <vector>

#include "ui/work/messages.h"
#include "ui/work/workstation.h"

namespace trephine {

enum class UnsavedWork { structures, measures, cuts, tissues };

class WorkGuards {
 public:
  using Next = std::function<void()>;
  // Calls Next at once where nothing would be lost, else once a person has decided to go on; never
  // where a person stays.
  using Guard = std::function<void(Next)>;

  WorkGuards(Workstation& workstation, Messages& messages)
      : workstation_(workstation), messages_(messages) {}

  void setGuard(UnsavedWork loss, Guard guard) { guards_[std::size_t(loss)] = std::move(guard); }
  // Goes on once all of these guards did, asked one after the other in this order. A kind without a
  // guard goes on. What is being typed is taken first.
  void unlessLost(const std::vector<UnsavedWork>& losses, Next go_on);
  // What goes with the case: all but the exercise.
  static std::vector<UnsavedWork> ofTheCase() {
    return {UnsavedWork::structures, UnsavedWork::measures, UnsavedWork::cuts};
  }
  // What is being typed counts as entered.
  void takeTyped();
  // What has to be settled before an exercise starts.
  void setBeforeStart(Guard guard) { before_start_ = std::move(guard); }
  void beforeStart(Next go_on) { before_start_ ? before_start_(std::move(go_on)) : go_on(); }
  // False, and said, where writing there would take a file of the case.
  bool keepsTheCase(const std::filesystem::path& target);
  // Of the case that is open, as far as it was read by this window.
  const std::filesystem::path& caseSource() const { return case_source_; }
  void setCaseSource(const std::filesystem::path& source) { case_source_ = source; }

 private:
  Workstation& workstation_;
  Messages& messages_;
  std::array<Guard, 4> guards_;
  Guard before_start_;
  std::filesystem::path case_source_;
};

}  // namespace trephine
