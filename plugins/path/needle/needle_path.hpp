// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/path/path.hpp"
#include "path_needle_parameters.hpp"

namespace armature::path::needle {

/// The straight way of a needle, in and out. A request's goal is where the tip shall be, its focus
/// the entry; the needle's axis is the goal's pointing direction, or the z of its rotation.
class NeedlePath final : public PathPlanner {
 public:
  explicit NeedlePath(const Parameters& parameters) : parameters_{parameters} {}
  NeedlePath(const RobotModel&, const Params& params) : NeedlePath{Parameters::read(params)} {}

  Expected<Path> plan(const PathRequest& request) const override;

 private:
  struct Line;
  Expected<Line> line_of(const PathRequest& request) const;
  bool is_on(const Line& line, const ToolPose& pose) const;
  std::optional<std::string> obstacle(const Line& line, double from, double to,
                                      const PathRequest& request) const;
  /// The stand-off is in a zone that the needle enters on its line, or near it.
  std::optional<std::string> near_stand_off(const Line& line, const PathRequest& request) const;
  /// The needle comes into such a zone, or near it, between `from` and the entry.
  std::optional<std::string> entered_before(const Line& line, double from,
                                            const PathRequest& request) const;
  PathSample sample(const Line& line, double at, double s, const ToolPose& goal) const;
  PathSegment straight(const Line& line, double from, double to, const ToolPose& goal) const;

  Parameters parameters_;
};

}  // namespace armature::path::needle
