// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/path/path.hpp"
#include "path_joint_move_parameters.hpp"

namespace armature::path::joint_move {

/// One joint segment, rest to rest.
class JointMove final : public PathPlanner {
 public:
  explicit JointMove(const Parameters& parameters) : parameters_{parameters} {}
  JointMove(const RobotModel&, const Params& params) : JointMove{Parameters::read(params)} {}

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  Parameters parameters_;
};

}  // namespace armature::path::joint_move
