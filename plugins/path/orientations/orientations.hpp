// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/path/path.hpp"
#include "armature/robot/orientations/orientation_curve.hpp"
#include "key_poses.hpp"
#include "path_orientations_parameters.hpp"

namespace armature::path::orientations {

/// One cartesian segment from the start through all key poses to the goal.
class Orientations final : public PathPlanner {
 public:
  explicit Orientations(const Parameters& parameters) : parameters_{parameters} {}
  Orientations(const RobotModel&, const Params& params) : Orientations{Parameters::read(params)} {}

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  Expected<PathSegment> along(const KeyPoses& keys, const OrientationCurve& curve) const;

  Parameters parameters_;
};

}  // namespace armature::path::orientations
