// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/path/path.hpp"
#include "swing.hpp"

namespace armature {

/// P0 -> P1 in joint space, then P1 -> P3 on a great circle round the mouth.
class MouthArc final : public PathPlanner {
 public:
  static Expected<std::unique_ptr<PathPlanner>> make(const Params& params);

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  explicit MouthArc(const Params& params);
  PathSegment along(const Swing& swing, const ToolPose& goal, double turn) const;

  double step_, near_m_, near_rad_;
};

}  // namespace armature
