#include "ui/commission/commission_page.h"

#include <QFile>
#include <QHBoxLayout>
#include <QJsonDocument>
#include <QJsonObject>
#include <QVBoxLayout>

#include "base/file.h"
#include "base/system.h"
#include "machine/commission/start_check.h"
#include "ui/common/making.h"
#include "ui/common/pdf_page.h"
#include "ui/common/placing.h"
#include "ui/common/words.h"

namespace trephine {

namespace {

constexpr QSize kPageSize(900, 720);
constexpr int kSteps = 1000;
constexpr int kPatience_ms = 3000;  // after it was asked to end

}  // namespace

CommissionPage::CommissionPage(std::filesystem::path storage,
                               const std::filesystem::path& own_folder,
                               const std::filesystem::path& hospital_folder, QWidget* parent)
    : QDialog(parent), storage_(std::move(storage)) {
  setObjectName("commissionPage");
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowTitle(tr("Commission this workstation"));
  words_ = wrapped(named(
      new QLabel(tr(
          "Measures in a minute or two whether this machine keeps the time that touch "
          "needs, how fast it draws, its disk, memory and devices, and says for each what to do. "
          "End other programs first. If there are arms, hold each by its tip and move it a little "
          "when you are asked to: it pushes back gently, by a few millimetres. Esc cancels.")),
      "commissionWords"));
  step_ = named(new ElidedLabel, "commissionStep");
  progress_ = named(new QProgressBar, "commissionProgress");
  progress_->setRange(0, kSteps);
  page_ = named(new QTextBrowser, "commissionResult");
  page_->setOpenLinks(false);
  QPalette paper = page_->palette();  // it is a page to be printed, in either theme
  paper.setColor(QPalette::Base, Qt::white);
  paper.setColor(QPalette::Text, QColor(0x22, 0x22, 0x22));
  page_->setPalette(paper);
  begin_ = named(new QPushButton(tr("&Begin")), "beginCommission");
  begin_->setDefault(true);
  cancel_ = named(new QPushButton(tr("&Cancel")), "cancelCommission");
  save_ = named(new QPushButton(tr("&Save to print\u2026")), "saveCommission");
  close_ = named(new QPushButton(tr("C&lose")), "closeCommission");
  auto* row = new QHBoxLayout;
  addAll(*row, {begin_, cancel_, save_});
  row->addStretch(1);
  row->addWidget(close_);
  auto* layout = new QVBoxLayout(this);
  addAll(*layout, {words_, progress_, step_});
  layout->addWidget(page_, 1);
  layout->addStretch(0);
  layout->addLayout(row);

  connect(begin_, &QPushButton::clicked, this, [this] { begin(); });
  connect(cancel_, &QPushButton::clicked, this, &CommissionPage::cancel);
  connect(save_, &QPushButton::clicked, this, &CommissionPage::saveWanted);
  connect(close_, &QPushButton::clicked, this, &QDialog::reject);
  connect(&lab_, &QProcess::readyReadStandardError, this, &CommissionPage::takeProgress);
  kill_.setSingleShot(true);
  connect(&kill_, &QTimer::timeout, &lab_, &QProcess::kill);
  connect(&lab_, &QProcess::finished, this, &CommissionPage::finish);
  connect(&lab_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
    if (error == QProcess::FailedToStart) finish();
  });
  progress_->hide();
  step_->hide();
  cancel_->hide();
  save_->setEnabled(false);
  page_->hide();
  if (const auto last = lastCommissioning(own_folder, hospital_folder)) {
    showResult(toQt(toHtml(*last, {})));
  }
  setMinimumSize(480, 360);
  resize(sizeOnScreen(kPageSize, *parent));
}

// A child that is still at work goes with it.
CommissionPage::~CommissionPage() {
  if (lab_.state() == QProcess::NotRunning) return;
  lab_.disconnect(this);
  lab_.kill();
  lab_.waitForFinished();
  emit ended();
}

void CommissionPage::begin(double seconds) {
  if (lab_.state() != QProcess::NotRunning) return;
  emit begun();
  cancelled_ = false;
  unread_.clear();
  begin_->setEnabled(false);
  save_->setEnabled(false);
  cancel_->setEnabled(true);
  for (QWidget* one : {static_cast<QWidget*>(progress_), static_cast<QWidget*>(step_),
                       static_cast<QWidget*>(cancel_)}) {
    one->show();
  }
  page_->hide();
  progress_->setValue(0);
  step_->setText(tr("Beginning"));
  cancel_->setFocus();
  lab_.start(toQt(labProgram().string()),
             {"commission", "--json", "--progress", "--out", folder_.path(), "--storage",
              toQt(storage_.string()), "--seconds", QString::number(seconds)});
}

// Lines of "0.2500 step".
void CommissionPage::takeProgress() {
  unread_ += lab_.readAllStandardError();
  for (qsizetype end; (end = unread_.indexOf('\n')) >= 0; unread_.remove(0, end + 1)) {
    const QString line = QString::fromUtf8(unread_.left(end));
    bool is_number = false;
    const double share = line.section(' ', 0, 0).toDouble(&is_number);
    if (!is_number || cancelled_) continue;  // a line of the log
    progress_->setValue(std::max(progress_->value(), int(share * kSteps)));
    step_->setText(line.section(' ', 1));
  }
}

void CommissionPage::finish() {
  kill_.stop();
  progress_->hide();
  cancel_->hide();
  begin_->setEnabled(true);
  begin_->setDefault(false);
  begin_->setAutoDefault(false);
  emit ended();
  QFile file(folder_.filePath("commission.html"));
  const bool good = lab_.error() != QProcess::FailedToStart &&
                    lab_.exitStatus() == QProcess::NormalExit && lab_.exitCode() == 0 &&
                    file.open(QIODevice::ReadOnly);
  if (good) {
    step_->hide();
    showResult(QString::fromUtf8(file.readAll()));
    close_->setFocus();  // Return does not begin anew
    return emit commissioned();
  }
  save_->setEnabled(!html_.isEmpty());
  page_->setVisible(!html_.isEmpty());
  if (cancelled_) {
    return step_->setText(html_.isEmpty() ? tr("Cancelled; nothing was kept.")
                                          : tr("Cancelled; what was measured before stands."));
  }
  const QJsonObject error =
      QJsonDocument::fromJson(lab_.readAllStandardOutput()).object().value("error").toObject();
  const QString what = error.value("what").toString();
  step_->setText(what.isEmpty() ? tr("It did not come to its end. In a terminal, trephine-lab "
                                     "commission --out FOLDER says more.")
                                : what + ". " + error.value("next").toString());
}

void CommissionPage::showResult(const QString& html) {
  html_ = html;
  page_->setHtml(html);
  page_->show();
  save_->setEnabled(true);
}

void CommissionPage::cancel() {
  if (lab_.state() == QProcess::NotRunning) return;
  cancelled_ = true;
  cancel_->setEnabled(false);
  step_->setText(tr("Ending"));
  lab_.terminate();
  kill_.start(kPatience_ms);
}

Status CommissionPage::save(const std::filesystem::path& file) const {
  if (!toQt(file.string()).endsWith(".pdf", Qt::CaseInsensitive)) {
    return writeTextFile(file, html_.toStdString());
  }
  const QByteArray bytes = pdfOf(html_);
  return writeTextFile(file, std::string_view(bytes.constData(), std::size_t(bytes.size())));
}

// Esc while it is measured cancels, and does not close.
void CommissionPage::reject() {
  if (lab_.state() != QProcess::NotRunning) return cancel();
  QDialog::reject();
}

}  // namespace trephine
