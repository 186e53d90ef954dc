#include "headset/picture_exchange.h"

#include <utility>

namespace trephine {

void PictureExchange::ask(const PictureRequest& request) {
  std::lock_guard lock(mutex_);
  request_ = request;
}

SharedPicture* PictureExchange::newest(PictureRequest::Of kind) {
  SharedPicture* found = nullptr;
  for (SharedPicture& each : pictures_) {
    if (stateOf(each) != State::ready || each.request.of != kind) continue;
    if (!found || each.request.number > found->request.number) found = &each;
  }
  return found;
}

SharedPicture* PictureExchange::take(PictureRequest::Of kind, std::uint64_t number,
                                     std::chrono::microseconds patience) {
  std::unique_lock lock(mutex_);
  drawn_.wait_for(lock, patience, [&] {
    const SharedPicture* picture = newest(kind);
    return cancelled_ || (picture && picture->request.number >= number);
  });
  SharedPicture* picture = newest(kind);
  if (picture) stateOf(*picture) = State::shown;
  return picture;
}

void PictureExchange::giveBack(SharedPicture& picture) {
  std::lock_guard lock(mutex_);
  stateOf(picture) = State::free;
}

void PictureExchange::cancelWaiting() {
  std::lock_guard lock(mutex_);
  cancelled_ = true;
  drawn_.notify_all();
}

std::optional<PictureRequest> PictureExchange::asked() {
  std::lock_guard lock(mutex_);
  return std::exchange(request_, std::nullopt);
}

SharedPicture* PictureExchange::begin(PictureRequest::Of kind) {
  std::lock_guard lock(mutex_);
  SharedPicture* found = nullptr;
  for (SharedPicture& each : pictures_) {
    if (stateOf(each) != State::free) continue;
    if (!found || each.request.of == kind) found = &each;
    if (found->request.of == kind && found->width > 0) break;
  }
  if (found) stateOf(*found) = State::drawing;
  return found;
}

void PictureExchange::finish(SharedPicture& picture, const PictureRequest& request, void* drawn) {
  std::lock_guard lock(mutex_);
  for (SharedPicture& other : pictures_) {  // never shown: the newer one takes its place
    if (stateOf(other) == State::ready && other.request.of == request.of) {
      stateOf(other) = State::free;
    }
  }
  picture.request = request;
  picture.drawn = drawn;
  picture.finished_ns = monotonic_ns();
  stateOf(picture) = State::ready;
  drawn_.notify_all();
}

void PictureExchange::giveUp(SharedPicture& picture) {
  std::lock_guard lock(mutex_);
  stateOf(picture) = State::free;
}

}  // namespace trephine
