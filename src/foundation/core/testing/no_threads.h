#pragma once

#include <pthread.h>

#include <cstddef>

namespace trocar::testing {

/// While an object exists, no thread of this process can start: the default stack is larger than the address space, and
/// pthread_create() returns EAGAIN, as under a limit on processes. Threads that run are not affected, nor those that a
/// library starts with a stack size of its own (TBB).
class NoThreads {
 public:
  NoThreads() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t none;
    pthread_getattr_default_np(&none);
    pthread_attr_setstacksize(&none, std::size_t{1} << 50);
    pthread_setattr_default_np(&none);
    pthread_attr_destroy(&none);
  }
  ~NoThreads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }
  NoThreads(const NoThreads&) = delete;
  NoThreads& operator=(const NoThreads&) = delete;

 private:
  pthread_attr_t before_{};
};

}  // namespace trocar::testing
