// The folder that is being imported, and all work on it: scan, read, slices, thumbnails, one after
// the other on one background thread, because a CtFolder is used by one thread at a time. Every
// method is called, and every signal sent, on the window's thread.
#pragma once

#include <QImage>
#include <QObject>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/memory.h"
#include "imaging/importer.h"
#include "imaging/steps/couch.h"
#include "ui/common/background_task.h"

namespace trephine {

class ImportTask : public QObject {
  Q_OBJECT
 public:
  // `given_back_mb`: what the case that is open leaves to the next.
  explicit ImportTask(std::function<double()> given_back_mb = [] { return 0.0; },
                      QObject* parent = nullptr);
  ~ImportTask() override;

  // Finds the series of a folder or file. The folder scanned before stays until this one is there.
  void scan(const std::filesystem::path& path);
  // Reads a series of the folder; volume() has it after readDone(). What it will need of memory, as
  // the open window counts it, is asked for before.
  void read(const std::string& uid, const ImportRequest& request, double needed_mb = 0.0);
  // What may be had for that, with what the case that is open leaves to the next.
  double roomMb() const { return usableMemoryMb() + given_back_mb_(); }
  // While it scans: one of the series that were found so far is enough. scanned() follows once the
  // files of its folders are looked at; bestSeries() is then this one.
  void takeFound(const std::string& uid);
  // Ends the scan or read; stopped() follows.
  void cancel();
  bool isWorking() const { return working_; }

  bool hasFolder() const { return folder_ != nullptr; }
  const ImportReport& report() const { return report_; }  // as scan or the last read left it
  const std::optional<std::string>& bestSeries() const { return best_; }
  const std::filesystem::path& source() const { return source_; }  // of the folder
  // Whom and what its series are of, by uid. For the screen alone.
  const std::map<std::string, ScreenNames>& names() const { return names_; }
  const std::vector<CtFolder::LabelFile>& labelFiles() const { return label_files_; }
  // Of the series that was read last: to be compared with what its case is called, never written.
  const SourceIdentity& identity() const { return identity_; }
  const std::shared_ptr<const Volume>& volume() const { return volume_; }
  // The couch in volume(), where the series asks about it and that is not answered yet.
  const CouchFinding& couch() const { return couch_; }
  std::shared_ptr<const Volume> takeVolume() { return std::exchange(volume_, {}); }

  // The slice to look at. Only the last one wanted is read; what was wanted before is dropped.
  void wantSlice(const std::string& uid, int index);
  // The middle slices of these series as small pictures, in this order, while nothing else waits.
  void wantThumbnails(const std::vector<std::string>& uids);
  // These slices of a series as small pictures, before any thumbnail that waits.
  void wantPictures(const std::string& uid, const std::vector<int>& slices);
  // No slices and thumbnails any more.
  void wantNothing();

 signals:
  void scanBegan();
  void progressed(double fraction, const QString& step);
  void found(const std::vector<trephine::FoundSeries>& series);  // so far; the scan goes on
  void scanned();
  void readDone();
  void stopped();  // scan or read failed or was cancelled
  void failed(const trephine::Error& error);
  // A slice, or in its place why there is none.
  void sliceReady(const QString& uid, int index,
                  const trephine::Result<trephine::SlicePicture>& picture);
  void thumbnailReady(const QString& uid, const QImage& picture);  // null: there is none
  void pictureReady(const QString& uid, int slice, const QImage& picture);

 private:
  struct Wanted {
    std::string uid;
    int index;
  };
  void begin(std::function<void()> work);
  void step();
  void end(void (ImportTask::*done)());
  template <class Outcome>
  void endWithout(const Outcome& outcome);
  void readSlice(const Wanted& wanted);
  void makePicture(const Wanted& wanted);

  std::function<double()> given_back_mb_;
  std::shared_ptr<CtFolder> folder_;
  ImportReport report_;
  std::optional<std::string> best_;
  std::filesystem::path source_;
  std::map<std::string, ScreenNames> names_;
  std::vector<CtFolder::LabelFile> label_files_;
  std::shared_ptr<ScanGuide> guide_;  // of the scan that was asked for last, while it runs
  int scans_ = 0;
  std::shared_ptr<const Volume> volume_;
  SourceIdentity identity_;
  CouchFinding couch_;
  bool cancelled_ = false;      // even where the work came to its end first
  bool working_ = false;        // a scan or read is under way or waits for a slice to end
  std::function<void()> next_;  // starts it
  std::optional<Wanted> wanted_;
  std::deque<Wanted> pictures_;  // of an index below 0, the middle one
  BackgroundTask task_;          // last, so that it is joined before what it works on goes
};

}  // namespace trephine
