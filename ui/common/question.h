#pragma once

#include <QMessageBox>
#include <functional>

namespace trephine {

// Asks, without blocking, before something is lost: what would be, and what stays. `go_on` runs
// when the button `yes` is chosen; Return, Esc and closing the question leave all as it is. The
// question is a child of `parent` named `name` and goes away when it is answered.
QMessageBox* ask(QWidget* parent, const char* name, const QString& loses, const QString& stays,
                 const QString& yes, std::function<void()> go_on);
// One more answer beside it.
void orElse(QMessageBox& question, const char* name, const QString& words,
            std::function<void()> then);

}  // namespace trephine
