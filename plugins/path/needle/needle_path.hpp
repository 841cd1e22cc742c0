// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/kinds/path/path.hpp"

namespace armature {

/// The straight way of a needle, in and out. A request's goal is where the tip shall be, its focus
/// the entry; the needle's axis is the goal's pointing direction, or the z of its rotation.
class NeedlePath final : public PathPlanner {
 public:
  static Expected<std::unique_ptr<PathPlanner>> make(const Params& params);

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  struct Line;
  explicit NeedlePath(const Params& params);
  Expected<Line> line_of(const PathRequest& request) const;
  bool is_on(const Line& line, const ToolPose& pose) const;
  std::optional<std::string> obstacle(const Line& line, double from, double to,
                                      const PathRequest& request) const;
  PathSample sample(const Line& line, double at, double s, const ToolPose& goal) const;
  PathSegment straight(const Line& line, double from, double to, const ToolPose& goal) const;

  double stand_off_m_, step_m_, needle_radius_m_, margin_m_, on_line_m_, on_line_rad_;
  double needle_at_entry_m_;
};

}  // namespace armature
