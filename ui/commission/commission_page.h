// Whether this workstation is fit, in a window of its own: measured by trephine-lab, which draws
// and ticks as the product does, with progress and cancel; its page can be saved to be printed.
#pragma once

#include <QDialog>
#include <QLabel>
#include <QProcess>
#include <QProgressBar>
#include <QPushButton>
#include <QTemporaryDir>
#include <QTextBrowser>
#include <QTimer>
#include <filesystem>
#include <functional>

#include "base/result.h"

namespace trephine {

class CommissionPage : public QDialog {
  Q_OBJECT
 public:
  // `storage`: the folder of cases, whose disk is looked at. `own_folder` and `hospital_folder`:
  // where the last one is, as lastCommissioning() has them.
  CommissionPage(std::filesystem::path storage, const std::filesystem::path& own_folder,
                 const std::filesystem::path& hospital_folder, QWidget* parent);
  ~CommissionPage() override;

  // Seconds of each row of lateness.
  void begin(double seconds = 5.0);
  // HTML, or PDF for a name that ends so.
  Status save(const std::filesystem::path& file) const;

 signals:
  void begun();  // it wants the arms for itself
  void ended();  // and has let go of them; also where it was cancelled
  void commissioned();
  void saveWanted();

 protected:
  void reject() override;

 private:
  void takeProgress();
  void finish();
  void showResult(const QString& html);
  void cancel();

  std::filesystem::path storage_;
  QTemporaryDir folder_;
  QProcess lab_;
  QTimer kill_;        // where it does not end when it is asked to
  QByteArray unread_;  // of its progress
  QString html_;
  bool cancelled_ = false;
  QLabel *words_, *step_;
  QProgressBar* progress_;
  QTextBrowser* page_;
  QPushButton *begin_, *cancel_, *save_, *close_;
};

}  // namespace trephine
