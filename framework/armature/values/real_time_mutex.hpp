// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

namespace armature ARMATURE_EXPORT {

/// A mutex for what a control thread shares with others. Whoever holds it runs with the priority
/// of the most urgent thread that waits for it (priority inheritance), so that a thread of normal
/// priority is not pushed aside while a control thread waits. Locking is real-time safe as long as
/// no holder blocks. Lockable: for std::scoped_lock and std::unique_lock.
class RealTimeMutex {
 public:
  RealTimeMutex() {
    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
    pthread_mutex_init(&mutex_, &attributes);
    pthread_mutexattr_destroy(&attributes);
  }
  ~RealTimeMutex() { pthread_mutex_destroy(&mutex_); }
  RealTimeMutex(const RealTimeMutex&) = delete;
  RealTimeMutex& operator=(const RealTimeMutex&) = delete;

  // NOLINTBEGIN: the names that the standard's locks call
  void lock() { pthread_mutex_lock(&mutex_); }
  bool try_lock() { return pthread_mutex_trylock(&mutex_) == 0; }
  void unlock() { pthread_mutex_unlock(&mutex_); }
  // NOLINTEND

 private:
  pthread_mutex_t mutex_;
};

}  // namespace armature
