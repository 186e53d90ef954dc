#include "ui/import_task.h"

#include <algorithm>

#include "ui/hu_window.h"
#include "ui/words.h"

namespace trephine {

namespace {
constexpr int kThumbnailPixels = 160;  // sharp at twice the size it is shown at
}

ImportTask::ImportTask(QObject* parent) : QObject(parent) {
  connect(&task_, &BackgroundTask::progressed, this, &ImportTask::progressed);
}

ImportTask::~ImportTask() = default;

void ImportTask::begin(std::function<void()> work) {
  if (task_.busy()) task_.cancel();
  working_ = true;
  next_ = std::move(work);
  step();
}

void ImportTask::scan(const std::filesystem::path& path) {
  wantNothing();
  emit scanBegan();
  begin([this, path] {
    task_.run([path](const Progress& progress) { return CtFolder::scan(path, progress); },
              [this](Result<CtFolder> scanned) {
                if (!scanned) return end(scanned.error(), nullptr);
                folder_ = std::make_shared<CtFolder>(*std::move(scanned));
                report_ = folder_->report();
                best_ = folder_->bestSeries();
                volume_.reset();
                end({}, &ImportTask::scanned);
              });
  });
}

void ImportTask::read(const std::string& uid, const ImportRequest& request) {
  if (!folder_) return;
  wanted_.reset();
  volume_.reset();  // there is room for one
  begin([this, uid, request] {
    task_.run([folder = folder_, uid, request](
                  const Progress& progress) { return folder->read(uid, request, progress); },
              [this](Result<Volume> read) {
                report_ = folder_->report();  // a refusal is told there too
                if (!read) return end(read.error(), nullptr);
                volume_ = std::make_shared<const Volume>(*std::move(read));
                end({}, &ImportTask::readDone);
              });
  });
}

void ImportTask::end(const std::optional<Error>& error, void (ImportTask::*done)()) {
  if (next_) return step();  // something else is wanted by now
  working_ = false;
  if (!error) {
    emit(this->*done)();
  } else {
    emit stopped();
    if (error->code != "CANCELLED") emit failed(*error);
  }
  step();
}

void ImportTask::cancel() {
  if (!working_) return;
  if (!next_) return task_.cancel();
  next_ = {};
  working_ = false;
  emit stopped();
}

void ImportTask::wantSlice(const std::string& uid, int index) {
  wanted_ = {uid, index};
  step();
}

void ImportTask::wantThumbnails(const std::vector<std::string>& uids) {
  thumbnails_.assign(uids.begin(), uids.end());
  step();
}

void ImportTask::wantNothing() {
  wanted_.reset();
  thumbnails_.clear();
}

void ImportTask::step() {
  if (task_.busy()) return;
  if (next_) {
    std::exchange(next_, {})();
  } else if (folder_ && wanted_) {
    readSlice(*std::exchange(wanted_, {}));
  } else if (folder_ && !thumbnails_.empty()) {
    const std::string uid = std::move(thumbnails_.front());
    thumbnails_.pop_front();
    makeThumbnail(uid);
  }
}

void ImportTask::readSlice(const Wanted& wanted) {
  task_.run([folder = folder_, wanted](
                const Progress&) { return folder->slice(wanted.uid, wanted.index); },
            [this, wanted](const Result<SlicePicture>& picture) {
              emit sliceReady(toQt(wanted.uid), wanted.index, picture);
              step();
            });
}

void ImportTask::makeThumbnail(const std::string& uid) {
  const auto series = std::ranges::find(report_.series, uid, &SeriesReport::uid);
  if (series == report_.series.end()) return step();
  task_.run(
      [folder = folder_, uid, middle = series->slices / 2,
       is_ct = series->modality == "CT"](const Progress&) -> Result<QImage> {
        const Result<SlicePicture> slice = folder->slice(uid, middle);
        if (!slice) return slice.error();
        const HuWindow window = is_ct ? kWideWindow : wholeRange(*slice);
        const double tall = double(slice->rows) * slice->spacing_mm.y;
        const double wide = double(slice->columns) * slice->spacing_mm.x;
        const double scale = kThumbnailPixels / std::max(tall, wide);
        return windowed(*slice, window)
            .scaled(std::max(1, int(wide * scale)), std::max(1, int(tall * scale)),
                    Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
      },
      [this, uid](const Result<QImage>& picture) {
        emit thumbnailReady(toQt(uid), picture ? *picture : QImage());
        step();
      });
}

}  // namespace trephine
