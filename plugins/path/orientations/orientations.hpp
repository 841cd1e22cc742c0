// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/path/path.hpp"
#include "armature/robot/orientation_curve.hpp"
#include "key_poses.hpp"

namespace armature {

/// One cartesian segment from the start through all key poses to the goal.
class Orientations final : public PathPlanner {
 public:
  static Expected<std::unique_ptr<PathPlanner>> make(const Params& params);

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  explicit Orientations(const Params& params);
  Expected<PathSegment> along(const KeyPoses& keys, const OrientationCurve& curve) const;

  OrientationInterpolator interpolator_;
  double step_rad_, step_m_;
};

}  // namespace armature
