// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/path/path.hpp"
#include "path_mouth_points_parameters.hpp"

namespace armature::path::mouth_points {

/// P0 -> P1 -> P2 -> P3 in joint space, a stop at each.
class MouthPoints final : public PathPlanner {
 public:
  explicit MouthPoints(const Parameters& parameters) : parameters_{parameters} {}
  MouthPoints(const RobotModel&, const Params& params) : MouthPoints{Parameters::read(params)} {}

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  PathSegment move_to(const ToolPose& end) const;

  Parameters parameters_;
};

}  // namespace armature::path::mouth_points
