// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace armature::bench {

/// An orientation interpolator on random keys, in one line. Medians over all curves; a curve's
/// parameter runs from 0 to 1.
struct InterpolatorRow {
  std::string name;
  double build_s = 0;
  double sample_s = 0;  // rotation and angular velocity
  double with_acceleration_s = 0;
  double turn = 0;               // the way, as a multiple of that of the great arcs
  double peak_acceleration = 0;  // [rad]
  double velocity_jump = 0;      // [rad] the largest at a place where pieces meet
  double acceleration_jump = 0;  // [rad]
};

/// Every interpolator on the same `curves` curves through `keys` random rotations, the keys of all
/// uniform over all rotations. Times: the least of `repetitions`.
std::vector<InterpolatorRow> measure_interpolators(int curves, int keys, std::uint64_t seed,
                                                   int repetitions);

}  // namespace armature::bench
