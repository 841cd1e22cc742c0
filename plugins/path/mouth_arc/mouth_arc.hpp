// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/path/path.hpp"
#include "path_mouth_arc_parameters.hpp"
#include "swing.hpp"

namespace armature::path::mouth_arc {

/// P0 -> P1 in joint space, then P1 -> P3 on a great circle round the mouth.
class MouthArc final : public PathPlanner {
 public:
  explicit MouthArc(const Parameters& parameters) : parameters_{parameters} {}
  MouthArc(const RobotModel&, const Params& params) : MouthArc{Parameters::read(params)} {}

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  PathSegment along(const Swing& swing, const ToolPose& goal, double turn) const;

  Parameters parameters_;
};

}  // namespace armature::path::mouth_arc
