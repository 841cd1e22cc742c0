// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "armature/kinds/path/path.hpp"

namespace armature {

/// P0 -> P1 -> P2 -> P3 in joint space, a stop at each.
class MouthPoints final : public PathPlanner {
 public:
  static Expected<std::unique_ptr<PathPlanner>> make(const Params& params);

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  explicit MouthPoints(std::optional<double> segment_s) : segment_s_{segment_s} {}
  PathSegment move_to(const ToolPose& end) const;

  std::optional<double> segment_s_;
};

}  // namespace armature
