// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace armature::bench {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point start, Clock::time_point end);

/// What reading the clock twice takes by itself [s].
double clock_seconds();

}  // namespace armature::bench
