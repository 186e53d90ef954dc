// No thread can be started while one lives: none gets the stack that it would have.
#pragma once

#include <pthread.h>

#include <cstddef>

namespace trephine::test {

class WithoutThreads {
 public:
  WithoutThreads() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t more = before_;
    pthread_attr_setstacksize(&more, std::size_t(1) << 48);  // beyond what a process can address
    pthread_setattr_default_np(&more);
  }
  ~WithoutThreads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }
  WithoutThreads(const WithoutThreads&) = delete;
  WithoutThreads& operator=(const WithoutThreads&) = delete;

 private:
  pthread_attr_t before_{};
};

}  // namespace trephine::test
