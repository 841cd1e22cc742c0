// SPDX-License-Identifier: Apache-2.0
// A library to be preloaded: the system clock of the program is ahead by as many seconds as stand
// in the file that STEPPED_CLOCK names, from the moment when it stands there. Its monotonic clock
// is the machine's. Waits until an instant of the system clock end when that clock says so.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <ctime>

namespace {

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

int real_clock(clockid_t clock, timespec* time) {
  static auto* const real = next<int(clockid_t, timespec*)>("clock_gettime");
  return real(clock, time);
}

/// Read again every few milliseconds.
long shift_s() {
  constexpr long kEvery_ns = 5'000'000;
  static std::atomic<long> shift{0}, read_at{0};
  timespec now{};
  real_clock(CLOCK_MONOTONIC, &now);
  const long now_ns = now.tv_sec * 1'000'000'000 + now.tv_nsec;
  long last = read_at;
  if (now_ns - last < kEvery_ns || !read_at.compare_exchange_strong(last, now_ns)) return shift;
  const char* name = std::getenv("STEPPED_CLOCK");
  const int file = name ? open(name, O_RDONLY | O_CLOEXEC) : -1;
  if (file < 0) return shift;
  char text[32] = {};
  if (read(file, text, sizeof text - 1) > 0) shift = std::atol(text);
  close(file);
  return shift;
}

/// An instant of the stepped clock as the kernel has it. One of the monotonic clock stays.
timespec as_real(const timespec* until) {
  constexpr time_t kSince2001 = 1'000'000'000;
  timespec real = *until;
  if (real.tv_sec > kSince2001) real.tv_sec -= shift_s();
  return real;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const int result = real_clock(clock, time);
  if (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE) time->tv_sec += shift_s();
  return result;
}

int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  *time = {.tv_sec = now.tv_sec, .tv_usec = now.tv_nsec / 1000};
  return 0;
}

time_t time(time_t* out) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (out) *out = now.tv_sec;
  return now.tv_sec;
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                           const timespec* until) {
  static auto* const real =
      next<int(pthread_cond_t*, pthread_mutex_t*, const timespec*)>("pthread_cond_timedwait");
  const timespec at = as_real(until);
  return real(condition, mutex, &at);
}

int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* until) noexcept {
  static auto* const real = next<int(pthread_mutex_t*, const timespec*)>("pthread_mutex_timedlock");
  const timespec at = as_real(until);
  return real(mutex, &at);
}

int sem_timedwait(sem_t* semaphore, const timespec* until) {
  static auto* const real = next<int(sem_t*, const timespec*)>("sem_timedwait");
  const timespec at = as_real(until);
  return real(semaphore, &at);
}

}  // extern "C"
