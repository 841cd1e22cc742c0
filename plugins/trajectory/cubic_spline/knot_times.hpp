// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "armature/kinds/trajectory/legs.hpp"

namespace armature::trajectory::cubic_spline {

/// How long a motion needs with the waypoints at these shares of its time (from 0 to 1).
using KnotTimesNeed = std::function<double(const std::vector<double>& share)>;

/// When the spline of a leg passes its waypoints, as shares of its time: the better one of
///   even    the slowest joint of each step at its full speed,
///   eased   along the waypoints under s = 10 x^3 - 15 x^4 + 6 x^5,
/// and from there, with up to `tries` further choices, the shortest motion that one interval made
/// longer or shorter after the other leads to (a pattern search: steps of a quarter, halved until
/// they are below a thousandth). Deterministic.
std::vector<double> best_knot_times(const Leg& leg, const TrajectoryRequest& request, int tries,
                                    const KnotTimesNeed& need);

}  // namespace armature::trajectory::cubic_spline
