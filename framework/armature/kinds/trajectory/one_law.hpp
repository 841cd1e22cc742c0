// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "armature/kinds/trajectory/joint_curve.hpp"
#include "armature/kinds/trajectory/time_law.hpp"
#include "armature/kinds/trajectory/timing.hpp"

namespace armature ARMATURE_EXPORT {

/// Quintics (piece-major) that follow `curve` under `law` from each of `knots` to the next; every
/// waypoint's time is one of them.
using PiecesAlong = std::vector<Quintic> (*)(const JointCurve& curve, const TimeLaw& law,
                                             std::span<const double> knots);

/// q, v, a of a motion along `curve` under `law` at time `t` (chain rule).
JointState state_along(const JointCurve& curve, const TimeLaw& law, double t);

/// Legs that are followed under one time law each. From a moving start the law takes over the
/// velocity along the path; what points elsewhere fades out in a quintic that is added (`spliced`).
LegShaper under_one_law(PiecesAlong pieces_along);

}  // namespace armature
