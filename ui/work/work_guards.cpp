#include "ui/work/work_guards.h"

#include <QAbstractSpinBox>
#include <QLineEdit>
#include <QPlainTextEdit>

#include "library/stored_case.h"

namespace trephine {

// A field takes what was typed when the focus leaves it.
void WorkGuards::takeTyped() {
  QWidget* typed = messages_.window()->focusWidget();
  const bool field = qobject_cast<QLineEdit*>(typed) || qobject_cast<QPlainTextEdit*>(typed) ||
                     qobject_cast<QAbstractSpinBox*>(typed);
  if (!field) return;
  typed->clearFocus();
  typed->setFocus();
}

void WorkGuards::unlessLost(const std::vector<UnsavedWork>& losses, Next go_on) {
  if (losses.empty()) return go_on();
  takeTyped();
  const Guard& first = guards_[std::size_t(losses.front())];
  const std::vector<UnsavedWork> rest(losses.begin() + 1, losses.end());
  const Next next = [this, rest, go_on = std::move(go_on)] { unlessLost(rest, go_on); };
  first ? first(next) : next();
}

bool WorkGuards::keepsTheCase(const std::filesystem::path& target) {
  const Case* open = workstation_.currentCase();
  for (const std::string& source : {case_source_.string(), open ? open->source : std::string()}) {
    const Status kept = keepsCase(target, source);
    if (kept) continue;
    messages_.report(kept.error());
    return false;
  }
  return true;
}

}  // namespace trephine
