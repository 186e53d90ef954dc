#include "ui/cases/import_bar.h"

#include <QHBoxLayout>

#include "ui/common/making.h"
#include "ui/common/placing.h"

namespace trephine {

namespace {
constexpr int kProgressSteps = 1000;
}

ImportBar::ImportBar(QWidget* parent) : QWidget(parent) {
  status_ = new ElidedLabel;
  status_->setObjectName("importStatus");
  status_->setProperty("quiet", true);
  progress_ = thinProgress("importProgress", kProgressSteps);
  auto* row = tight(new QHBoxLayout(this));
  row->addWidget(status_);
  row->addWidget(progress_, 1);
  row->addStretch(1);
  const auto add = [&](const char* name, const QString& text, void (ImportBar::*wanted)(),
                       bool primary = false) {
    QPushButton* made = namedButton(name, text, primary);
    made->setMinimumWidth(110);
    row->addWidget(made);
    connect(made, &QPushButton::clicked, this, wanted);
    return made;
  };
  report_ = add("saveReport", tr("Save &report\u2026"), &ImportBar::reportWanted);
  back_ = add("importBack", tr("&Back"), &ImportBar::backWanted);
  take_found_ = add("takeFound", tr("Use this &series"), &ImportBar::foundTaken);
  take_found_->setToolTip(
      tr("Look only at the files beside those of this series, and at no others"));
  cancel_ = add("cancelImport", tr("&Cancel"), &ImportBar::cancelWanted);
  close_ = add("closeImport", tr("&Close"), &ImportBar::closeWanted);
  import_ = add("import", tr("&Import"), &ImportBar::importWanted, true);
  open_case_ = add("openCase", tr("&Open the case"), &ImportBar::openCaseWanted, true);
}

void ImportBar::show(ImportStep step, bool has_report) {
  step_ = step;
  const bool working = isWorking(step), asking = step == ImportStep::asking;
  take_found_->setVisible(step == ImportStep::scanning);
  status_->setVisible(working);
  progress_->setVisible(working);
  cancel_->setVisible(working);
  close_->setVisible(!working && !asking);
  // Also while it cannot be used: what follows Cancel at its place is Close, never Import.
  import_->setVisible(!asking);
  report_->setVisible(step == ImportStep::choosing && has_report);
  back_->setVisible(asking);
  open_case_->setVisible(asking);
  if (step == ImportStep::scanning) showProgress(0.0, tr("Looking through the files"));
}

void ImportBar::say(const QString& words) {
  status_->setText(words);
  status_->show();
}

void ImportBar::showProgress(double fraction, const QString& step) {
  status_->setText(step);
  progress_->setValue(int(fraction * kProgressSteps));
}

void ImportBar::setImportable(bool may, const QString& why) {
  import_->setEnabled(may);
  import_->setToolTip(why);
}

void ImportBar::goOn() {
  (step_ == ImportStep::asking ? open_case_ : import_)->click();
}

}  // namespace trephine
