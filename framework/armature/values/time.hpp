// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace armature ARMATURE_EXPORT {

/// A length of time, in nanoseconds.
using Duration = std::chrono::nanoseconds;

/// An instant of the deployment's clock, in nanoseconds since that clock's epoch (the Unix epoch
/// on the system clock, the start of the run on the simulated one).
struct Time {
  std::int64_t ns = 0;

  friend constexpr auto operator<=>(Time, Time) = default;
  friend constexpr Time operator+(Time t, Duration d) { return {t.ns + d.count()}; }
  friend constexpr Time operator-(Time t, Duration d) { return {t.ns - d.count()}; }
  friend constexpr Duration operator-(Time a, Time b) { return Duration{a.ns - b.ns}; }
};

/// Seconds as a Duration, rounded to the nearest nanosecond; what is longer than a century is a
/// century, which an instant of either clock can be moved by.
constexpr Duration seconds(double s) {
  constexpr double kCentury_s = 100 * 365.25 * 86400;
  if (s > kCentury_s) s = kCentury_s;
  if (s < -kCentury_s) s = -kCentury_s;
  return Duration{static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5))};
}

/// A Duration in seconds.
constexpr double to_seconds(Duration d) { return static_cast<double>(d.count()) * 1e-9; }

}  // namespace armature
