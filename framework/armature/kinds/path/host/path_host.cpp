// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdint>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/path/path.hpp"
#include "armature/kinds/request_host.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/guarded.hpp"

namespace armature {
namespace {

Expected<PathRequest> request_of(const RobotModel& robot, const msg::PathRequest& message) {
  PathRequest request{.start = tool_pose_of(message.start_()),
                      .goal = tool_pose_of(message.goal_()),
                      .forbidden = zones_of(message.forbidden_())};
  if (message.has_focus_()) request.focus = to_eigen(message.focus_());
  for (const msg::ToolPose& key : message.through_()) {
    request.through.push_back(tool_pose_of(key));
  }
  if (message.start_joints_().empty()) return request;
  return joints_or_home(robot, message.start_joints_(), "the start").map([&](const JointVector& q) {
    request.start_joints = q;
    return request;
  });
}

msg::PathSegment message_of(const RobotModel& robot, const PathSegment& segment) {
  msg::PathSegment message;
  message.space_(static_cast<std::uint8_t>(segment.space));
  message.samples_().reserve(segment.samples.size());
  for (const PathSample& sample : segment.samples) {
    auto& written = message.samples_().emplace_back();
    written.s_(sample.s);
    write_tool_pose(sample.pose, written.pose_());
    const Redundancy redundancy = sample.redundancy.value_or(Redundancy{});
    written.has_redundancy_(sample.redundancy.has_value());
    written.redundancy_(redundancy.value);
    written.redundancy_is_length_(redundancy.is_length);
    if (!sample.joints) continue;
    const JointVector all = robot.to_all(*sample.joints);
    written.joints_().assign(all.begin(), all.end());
  }
  message.stop_at_end_(segment.stop_at_end);
  message.has_duration_(segment.duration_s.has_value());
  message.duration_(segment.duration_s.value_or(0));
  return message;
}

}  // namespace

/// Start, goal and a point to look at in, the tool's path out.
class PathHost final : public RequestHost<msg::PathRequest, msg::PathResponse> {
 public:
  explicit PathHost(Setup& setup)
      : RequestHost{setup},
        robot_{robot_of(setup)},
        planner_{setup.slot<PathPlanner>("planner", robot_)} {}

 private:
  void answer(const msg::PathRequest& request, msg::PathResponse& response) override {
    respond(planned(request), response, [&](const Path& segments) {
      for (const PathSegment& segment : segments) {
        response.segments_().push_back(message_of(robot_, segment));
      }
    });
  }

  Expected<Path> planned(const msg::PathRequest& request) const {
    if (const auto wrong = in_another_frame(request)) return refuse(*wrong);
    const auto read = request_of(robot_, request);
    if (!read) return tl::unexpected{read.error()};
    auto path = guarded([&] { return planner_->plan(*read); });
    if (!path) return path;
    for (const PathSegment& segment : *path) {
      for (const PathSample& sample : segment.samples) {
        if (sample.joints && sample.joints->size() != robot_.dof()) {
          return refuse(fmt::format("the plugin answered {} joints, and the robot has {}",
                                    sample.joints->size(), robot_.dof()));
        }
        if (!sample.pose.position.allFinite() || (sample.joints && !sample.joints->allFinite())) {
          return refuse("the plugin answered a path that is not finite");
        }
      }
    }
    return path;
  }

  RobotModel robot_;
  Slot<PathPlanner> planner_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::PathHost);
