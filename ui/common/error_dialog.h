#pragma once

#include <QMessageBox>

#include "base/result.h"

namespace trephine {

// Shows an Error in plain words without blocking: what went wrong, where, what to do next. The
// dialog is a child of `parent` named "errorDialog" and goes away when it is closed.
QMessageBox* showError(QWidget* parent, const Error& error);

}  // namespace trephine
