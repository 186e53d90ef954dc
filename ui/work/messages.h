// How something is said or asked over the window: lines, errors as dialogs, dialogs for files.
// Window's thread.
#pragma once

#include <QFileDialog>
#include <QObject>
#include <filesystem>
#include <functional>
#include <map>

#include "base/result.h"

namespace trephine {

class Messages : public QObject {
  Q_OBJECT
 public:
  explicit Messages(QWidget& window) : QObject(&window), window_(window) {}

  // What questions of a person stand over.
  QWidget* window() const { return &window_; }
  // One line that goes by itself; one that stays, of what mouse and keys do; an error as a dialog.
  void say(const QString& text) { emit said(text); }
  void hint(const QString& text) { emit hinted(text); }
  void report(const Error& error);
  // The window, or the dialog over it that is open.
  QWidget* asking() const;

  // A dialog over the window that goes away by itself and leaves no names on disk.
  QFileDialog* fileDialog(const char* name, const QString& title, const QString& filter = {});
  QFileDialog* saveDialog(const QString& title, const QString& suggestion, const QString& filter);
  // Asks for a file of that kind; nothing comes where a person gives none.
  using GotPath = std::function<void(const std::filesystem::path&)>;
  void askForFile(const char* name, const QString& title, const QString& filter, GotPath then);
  // The same for a folder that will be made.
  void askForNewFolder(const char* name, const QString& title, const QString& suggestion,
                       GotPath then);

 signals:
  void said(const QString& text);
  void hinted(const QString& text);
  void failed(const trephine::Error& error);  // beside the dialog that is shown

 private:
  QWidget& window_;
  std::map<QString, QString> folders_;  // by kind of dialog; in memory alone
};

}  // namespace trephine
