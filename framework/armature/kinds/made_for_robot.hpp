// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/config/params.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

class RobotModel;

/// How a plugin of a kind that belongs to one arm is made: for a robot and checked parameters, or
/// refused with a reason. The robot outlives what was made. Not real-time safe.
template <class Kind>
using MadeForRobot = Expected<std::unique_ptr<Kind>> (*)(const RobotModel&, const Params&);

/// How a plugin of a kind that knows no robot is made.
template <class Kind>
using MadeFromParams = Expected<std::unique_ptr<Kind>> (*)(const Params&);

}  // namespace armature
