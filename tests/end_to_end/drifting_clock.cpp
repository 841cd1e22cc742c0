// SPDX-License-Identifier: Apache-2.0
// A library to be preloaded: from its first question on, the monotonic clock of the program goes
// faster by DRIFT_PPM. Waits until an instant of it end later by what it is ahead.
#include <dlfcn.h>

#include <cstdint>
#include <cstdlib>
#include <ctime>

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using Function = int(clockid_t, timespec*);
  static auto* const real = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = real(clock, time);
  if (clock != CLOCK_MONOTONIC) return result;
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t now = time->tv_sec * kSecond + time->tv_nsec;
  static const std::int64_t begin = now;
  const char* drift = std::getenv("DRIFT_PPM");
  const std::int64_t told = now + (now - begin) / 1000 * (drift ? std::atol(drift) : 0) / 1000;
  *time = {.tv_sec = told / kSecond, .tv_nsec = told % kSecond};
  return result;
}
