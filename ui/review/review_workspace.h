// Review: what was recorded, and whether it replays. Between its page and the recordings.
#pragma once

#include "ui/common/background_task.h"
#include "ui/review/review_page.h"
#include "ui/work/app_context.h"

namespace trephine {

class ReviewWorkspace : public Workspace {
  Q_OBJECT
 public:
  // `app` is its parent.
  explicit ReviewWorkspace(AppContext& app);

  QString title() const override { return tr("Review"); }
  Symbol symbol() const override { return Symbol::review; }
  Parts parts() override;
  void enter() override {
    if (!replaying_.busy()) page_->showOutcome({});  // of the last time
    page_->showOnly(app_.takeReviewed());
    list();
  }
  // One that a person has opened, wherever it lies: from the next enter() on it stands in the list,
  // chosen.
  void choose(const std::filesystem::path& file);
  // By its ending, ".h5"; nothing is read.
  static bool isRecording(const std::filesystem::path& path);
  // Once the list is there: called before or after enter(). Nothing while one is being replayed.
  void replayNewest() { replay_newest_ = true; }

 private:
  void list();
  void show(const std::vector<ListedRecording>& rows, bool all,
            const std::map<std::string, QString>& cases);
  void replay(const ListedRecording& of);

  AppContext& app_;
  ReviewPage* page_;
  bool replay_newest_ = false;
  bool choose_opened_ = false, list_again_ = false;
  std::filesystem::path opened_;  // not of the workstation's own
  BackgroundTask listing_, replaying_;
};

}  // namespace trephine
