#include "ui/common/background_task.h"

namespace trephine {

BackgroundTask::BackgroundTask(QObject* parent)
    : QObject(parent), job_([this] {
        QMetaObject::invokeMethod(this, [this] { job_.take(); }, Qt::QueuedConnection);
      }) {
  job_.began = [this] { emit began(); };
  job_.progressed = [this](double fraction, const std::string& step) {
    emit progressed(fraction, QString::fromStdString(step));
  };
  job_.ended = [this] { emit ended(); };
}

}  // namespace trephine
