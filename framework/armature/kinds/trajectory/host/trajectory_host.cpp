// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/kinds/request_host.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/trajectory/trajectory_messages.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/robot/trajectories/trajectory_check.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/guarded.hpp"

namespace armature {
namespace {

constexpr double kRounding = 1e-9;  // of a limit

Expected<JointVector> rates_or_rest(const RobotModel& robot, std::span<const double> all,
                                    std::string_view what) {
  if (all.empty()) return JointVector{JointVector::Zero(robot.dof())};
  auto rates = robot.contract_rates(all);
  if (!rates) return refuse(fmt::format("{}: {}", what, rates.error().text));
  return rates;
}

/// Limits of all joints as limits of the independent ones: a joint that follows binds its leader,
/// one that is locked binds nothing.
Expected<JointVector> limits_or(const JointVector& robots_own, const RobotModel& robot,
                                std::span<const double> all, std::string_view what) {
  if (all.empty()) return robots_own;
  if (all.size() != robot.joints().size()) {
    return refuse(fmt::format("{}: {} joint values; {} has {} joints", what, all.size(),
                              robot.name(), robot.joint_count()));
  }
  JointVector limits = robots_own;
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (robot.joints()[j].locked) continue;
    const ChainLink& link = robot.chain()[j];
    const double gear = std::abs(link.ratio);
    const double own = robots_own[link.independent] * gear;
    if (!(all[j] > 0 && all[j] <= own * (1 + kRounding))) {
      if (std::isinf(own)) {
        return refuse(
            fmt::format("{}: {} = {:.6g} is not above 0", what, robot.joints()[j].name, all[j]));
      }
      return refuse(fmt::format("{}: {} = {:.6g} is not above 0 and at most the robot's {:.6g}",
                                what, robot.joints()[j].name, all[j], own));
    }
    limits[link.independent] = std::min(limits[link.independent], all[j] / gear);
  }
  return limits;
}

Expected<JointSegment> segment_of(const RobotModel& robot, const msg::JointSegment& message) {
  JointSegment segment{
      .s = message.s_(), .q = {}, .stop_at_end = message.stop_at_end_(), .duration_s = {}};
  if (message.has_duration_()) segment.duration_s = message.duration_();
  for (const msg::JointPosition& waypoint : message.waypoints_()) {
    auto q = robot.to_independent(waypoint.joints_());
    if (!q) {
      return refuse(fmt::format("waypoint {}: {}", segment.q.size() + 1, q.error().text));
    }
    segment.q.push_back(*q);
  }
  return segment;
}

Expected<std::vector<JointSegment>> segments_of(const RobotModel& robot,
                                                const msg::TrajectoryRequest& request) {
  std::vector<JointSegment> segments;
  for (const msg::JointSegment& message : request.segments_()) {
    auto segment = segment_of(robot, message);
    if (!segment) {
      return refuse(fmt::format("segment {}, {}", segments.size() + 1, segment.error().text));
    }
    segments.push_back(std::move(*segment));
  }
  if (segments.empty() || segments.front().q.empty()) return refuse("there is no waypoint");
  return segments;
}

Expected<TrajectoryRequest> request_of(const RobotModel& robot,
                                       const msg::TrajectoryRequest& message) {
  auto segments = segments_of(robot, message);
  if (!segments) return tl::unexpected{segments.error()};
  const auto v = rates_or_rest(robot, message.start_velocity_(), "start_velocity");
  if (!v) return tl::unexpected{v.error()};
  const auto a = rates_or_rest(robot, message.start_acceleration_(), "start_acceleration");
  if (!a) return tl::unexpected{a.error()};
  const auto max_velocity =
      limits_or(robot.max_velocity(), robot, message.max_velocity_(), "max_velocity");
  if (!max_velocity) return tl::unexpected{max_velocity.error()};
  const auto max_acceleration =
      limits_or(robot.max_acceleration(), robot, message.max_acceleration_(), "max_acceleration");
  if (!max_acceleration) return tl::unexpected{max_acceleration.error()};
  JointVector max_jerk;
  if (!message.max_jerk_().empty()) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    const auto limits =
        limits_or(JointVector::Constant(robot.dof(), kAny), robot, message.max_jerk_(), "max_jerk");
    if (!limits) return tl::unexpected{limits.error()};
    max_jerk = *limits;
  }
  const JointVector start = segments->front().q.front();
  return TrajectoryRequest{.goal_id = message.request_id_(),
                           .start = stamp_of(message.header_().stamp_()),
                           .from = {.q = start, .v = *v, .a = *a},
                           .segments = std::move(*segments),
                           .max_velocity = *max_velocity,
                           .max_acceleration = *max_acceleration,
                           .max_jerk = max_jerk};
}

}  // namespace

/// Joint paths in, trajectories out.
class TrajectoryHost final : public RequestHost<msg::TrajectoryRequest, msg::TrajectoryResponse> {
 public:
  explicit TrajectoryHost(Setup& setup)
      : RequestHost{setup},
        robot_{robot_of(setup)},
        planner_{setup.slot<TrajectoryPlanner>("planner")} {}

 private:
  /// What the plugin answers, held to what was asked for, as the motion component does.
  Expected<Trajectory> checked(const TrajectoryRequest& asked) const {
    auto planned = guarded([&] { return planner_->plan(asked); });
    if (!planned) return planned;
    const MotionLimits limits{asked.max_velocity, asked.max_acceleration};
    ReasonText wrong = trajectory_defect(planned->view(), robot_, limits, asked.from, asked.start);
    if (wrong.empty()) wrong = missed_goal(planned->view(), robot_, asked.segments.back().q.back());
    if (!wrong.empty()) return refuse(std::string{wrong.view()});
    return planned;
  }

  void answer(const msg::TrajectoryRequest& request, msg::TrajectoryResponse& response) override {
    const auto planned =
        request_of(robot_, request).and_then([this](const auto& asked) { return checked(asked); });
    respond(planned, response, [&](const Trajectory& found) {
      write_trajectory(found, robot_, response.trajectory_());
    });
  }

  const RobotModel robot_;
  Slot<TrajectoryPlanner> planner_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::TrajectoryHost);
