// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "track.hpp"

namespace armature::report::teleoperation {

/// Mean square distance [m^2] of the part of a motion whose frequencies lie between `from_hz` and
/// `to_hz`: its Fourier sum at their multiples of 1 / duration, under a Hann window, so that a slow
/// motion beside it does not leak in. A motion longer than 5 s is the mean of windows of 5 s, each
/// of which overlaps the next one by half or more (Welch): its time goes with its length, and every
/// part of it counts. 0 for fewer than three points.
double band_power(std::span<const TrackPoint> track, double from_hz, double to_hz);

}  // namespace armature::report::teleoperation
