// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "armature/kinds/path/path.hpp"
#include "armature/kinds/request_host.hpp"
#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/values/guarded.hpp"

namespace armature {
namespace {

PathRequest request_of(const msg::PathRequest& message) {
  PathRequest request{.start = tool_pose_of(message.start_()),
                      .goal = tool_pose_of(message.goal_()),
                      .focus = {},
                      .forbidden = zones_of(message.forbidden_())};
  if (message.has_focus_()) request.focus = to_eigen(message.focus_());
  for (const msg::ToolPose& key : message.through_()) {
    request.through.push_back(tool_pose_of(key));
  }
  return request;
}

msg::PathSegment message_of(const PathSegment& segment) {
  msg::PathSegment message;
  message.space_(static_cast<std::uint8_t>(segment.space));
  message.samples_().reserve(segment.samples.size());
  for (const PathSample& sample : segment.samples) {
    auto& written = message.samples_().emplace_back();
    written.s_(sample.s);
    write_tool_pose(sample.pose, written.pose_());
    written.has_redundancy_(sample.needle_depth_m.has_value());
    written.redundancy_(sample.needle_depth_m.value_or(0));
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
      : RequestHost{setup}, planner_{setup.slot<PathPlanner>("planner")} {}

 private:
  void answer(const msg::PathRequest& request, msg::PathResponse& response) override {
    const auto wrong = in_another_frame(request);
    const Expected<Path> path = wrong
                                    ? Expected<Path>{refuse(*wrong)}
                                    : guarded([&] { return planner_->plan(request_of(request)); });
    response.valid_(path.has_value());
    response.reason_() = path ? "" : path.error().text;
    response.segments_().clear();
    if (!path) return;
    for (const PathSegment& segment : *path) response.segments_().push_back(message_of(segment));
  }

  PluginPtr<PathPlanner> planner_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::PathHost);
