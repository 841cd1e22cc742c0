// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <numbers>
#include <string>
#include <vector>

#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/task/task_ports.hpp"
#include "task_waypoints_ports.hpp"
#include "tour.hpp"

namespace armature::task::waypoints {
namespace {

using Eigen::Vector3d;

constexpr Duration kPeriod = seconds(0.01);

/// A robot with a pointing axis is told where that shall point, one without the whole rotation.
Orientation orientation_of(const RobotModel& robot, const Eigen::Matrix3d& base_R_tool) {
  if (const auto& axis = robot.pointing_axis()) return Direction{base_R_tool * *axis};
  return Eigen::Quaterniond{base_R_tool};
}

std::vector<ToolPose> waypoints_of(const Parameters& parameters, const Params& params,
                                   const RobotModel& robot) {
  const auto positions =
      points_of(parameters.positions, params, "positions_mm", 1, "one waypoint or more");
  const auto rpy = points_of(parameters.rpy, params, "rpy_deg", 0, "the waypoints");
  if (!rpy.empty() && rpy.size() != positions.size()) {
    params.refuse({"rpy_deg", "positions_mm"}, "'rpy_deg' turns " + std::to_string(rpy.size()) +
                                                   " waypoints, and 'positions_mm' has " +
                                                   std::to_string(positions.size()));
  }
  const Eigen::Matrix3d at_home = forward_kinematics(robot, resting_position(robot)).linear();
  std::vector<ToolPose> waypoints;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Matrix3d base_R_tool = rpy.empty() ? at_home : rotation_from_rpy(rpy[i]);
    waypoints.push_back({positions[i], orientation_of(robot, base_R_tool)});
  }
  return waypoints;
}

Tour tour_of(const Params& params, const RobotModel& robot) {
  const Parameters parameters = Parameters::read(params);
  return {parameters, waypoints_of(parameters, params, robot)};
}

}  // namespace

class WaypointsComponent final : public Component {
 public:
  explicit WaypointsComponent(Setup& setup)
      : Component{setup},
        robot_{robot_of(setup)},
        tour_{tour_of(setup.params(), robot_)},
        ports_{setup},
        task_ports_{ports_.operator_, ports_.state} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    for (std::size_t i = 0; i < ports_.motion_status.size(); ++i) {
      tour_.hear(report_of(ports_.motion_status[i]), now);
    }
    for (const std::string& line : task_ports_.hear(
             now, tour_.procedure(), [this](const auto& command) { return tour_.hear(command); })) {
      log(line);
    }
    see_arm();
    send(tour_.outgoing_goal(now), now, ports_.goal);
    publish_state(now);
  }

  bool finished() const override {
    const Tour::Phase phase = tour_.phase();
    return phase == Tour::Phase::done || phase == Tour::Phase::aborted ||
           phase == Tour::Phase::refused;
  }

  void summarize(Summary& summary) const override {
    if (tour_.done_at()) {
      summary.metric("time_to_done_s", "time until the last rest is over [s]",
                     to_seconds(*tour_.done_at() - *start_));
    }
    if (const auto& worst = tour_.worst()) {
      summary.metric("tool_error_mm", "most that the tool was off a waypoint [mm]",
                     1e3 * worst->position_m);
      summary.metric("tool_error_deg", "the same of its rotation [deg]",
                     worst->angle_rad * 180 / std::numbers::pi);
    }
    if (tour_.phase() == Tour::Phase::aborted) summary.failed("aborted", "by the operator");
    if (tour_.phase() == Tour::Phase::refused) summary.failed("refused", tour_.trouble());
  }

 private:
  void see_arm() {
    if (!ports_.measured_js.fresh()) return;
    const auto q = joints_of(robot_, *ports_.measured_js.latest());
    if (!q) return degraded("measured_js: " + q.error().text);
    healthy();
    const Vector3d axis = robot_.pointing_axis().value_or(Vector3d::UnitZ());
    tour_.see(residual(forward_kinematics(robot_, *q), axis, tour_.waypoint()));
  }

  void publish_state(Time now) {
    const TaskReport report{.state = to_string(tour_.phase()),
                            .step = tour_.number() + 1,
                            .steps = tour_.count(),
                            .detail = tour_.trouble()};
    const bool under_way =
        tour_.phase() == Tour::Phase::moving || tour_.phase() == Tour::Phase::resting;
    const std::string line = under_way
                                 ? fmt::format("{} {}/{}", report.state, report.step, report.steps)
                                 : report.line();
    if (const auto said = task_ports_.publish(now, report, line, tour_.procedure())) log(*said);
  }

  RobotModel robot_;
  Tour tour_;
  Ports ports_;
  TaskPorts task_ports_;
  std::optional<Time> start_;
};

}  // namespace armature::task::waypoints

ARMATURE_PLUGIN(armature::task::waypoints::WaypointsComponent);
