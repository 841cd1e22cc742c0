// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/motion_params.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "armature/motion/limit_margin.hpp"
#include "armature/motion/rest_watch.hpp"
#include "armature/robot/kinematics/locked_joints.hpp"

namespace armature {
namespace {

using motion::Parameters;

/// A limit for joints that turn or for those that slide, and how it is written.
struct Limit {
  double value;
  const char *name, *unit;
};

/// The same limit for every joint of a kind, 0: the robot's own. Where the robot's own is lower, a
/// limit that was written is a problem, told with the first such joint, and a default gives way.
JointVector limits_from(const Limit& turning, const Limit& sliding, const Params& params,
                        const RobotModel& model, const JointVector& robot_limit,
                        config::Problems& problems) {
  JointVector limits = robot_limit;
  std::set<std::string_view> told;
  for (int i = 0; i < model.dof(); ++i) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(model.independent_joint(i))];
    const Limit& limit = joint.type == Joint::Type::prismatic ? sliding : turning;
    if (limit.value == 0) continue;
    if (limit.value > robot_limit[i] && params.is_written(limit.name) &&
        told.insert(limit.name).second) {
      problems.add(params.origin(limit.name),
                   fmt::format("{} is {}, above the {} {} of joint {} of robot {}", limit.name,
                               limit.value, robot_limit[i], limit.unit, joint.name, model.name()));
    }
    limits[i] = std::min(limit.value, robot_limit[i]);
  }
  return limits;
}

/// A limit for joints that slide would limit nothing where none does, as if the tool were meant.
void check_idle_limits(const Parameters& parameters, const Params& params, const RobotModel& model,
                       config::Problems& problems) {
  const auto slides = [](const Joint& joint) { return joint.type == Joint::Type::prismatic; };
  if (std::ranges::any_of(model.joints(), slides)) return;
  for (const Limit& limit : {Limit{parameters.max_velocity_m_s, "max_velocity_m_s", ""},
                             Limit{parameters.max_acceleration_m_s2, "max_acceleration_m_s2", ""},
                             Limit{parameters.max_jerk_m_s3, "max_jerk_m_s3", ""}}) {
    if (limit.value == 0) continue;
    problems.add(params.origin(limit.name),
                 fmt::format("{} is for joints that slide, and robot {} has none", limit.name,
                             model.name()));
  }
}

/// Where 0 stands for no limit of its own, a number beside it would let nothing move.
void check_tiny_limits(const Parameters& parameters, const Params& params,
                       config::Problems& problems) {
  constexpr double kMinTurning = 1e-3, kMinSliding = 1e-6;
  const auto check = [&](const char* name, double value, double min) {
    if (value == 0 || value >= min) return;
    problems.add(params.origin(name),
                 fmt::format("{} is {:g}, and must be at least {:g}, or 0 for no limit of its own: "
                             "nothing would move",
                             name, value, min));
  };
  check("max_jerk_rad_s3", parameters.max_jerk_rad_s3, kMinTurning);
  check("max_jerk_m_s3", parameters.max_jerk_m_s3, kMinSliding);
  check("max_velocity_m_s", parameters.max_velocity_m_s, kMinSliding);
  check("max_acceleration_m_s2", parameters.max_acceleration_m_s2, kMinSliding);
  check("max_tracking_velocity_m_s", parameters.max_tracking_velocity, kMinSliding);
}

/// Empty when neither kind of joint has a limit.
JointVector max_jerk_of(const Parameters& parameters, const RobotModel& model) {
  const double turning = parameters.max_jerk_rad_s3, sliding = parameters.max_jerk_m_s3;
  if (turning == 0 && sliding == 0) return {};
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return each({turning > 0 ? turning : kAny, sliding > 0 ? sliding : kAny}, model);
}

}  // namespace

MotionLimits limits_of(const Params& params, const RobotModel& model) {
  const auto parameters = Parameters::read(params);
  config::Problems problems;
  check_idle_limits(parameters, params, model, problems);
  check_tiny_limits(parameters, params, problems);
  MotionLimits limits{
      limits_from({parameters.max_velocity_rad_s, "max_velocity_rad_s", "rad/s"},
                  {parameters.max_velocity_m_s, "max_velocity_m_s", "m/s"}, params, model,
                  model.max_velocity(), problems),
      limits_from({parameters.max_acceleration_rad_s2, "max_acceleration_rad_s2", "rad/s2"},
                  {parameters.max_acceleration_m_s2, "max_acceleration_m_s2", "m/s2"}, params,
                  model, model.max_acceleration(), problems),
      max_jerk_of(parameters, model)};
  problems.throw_if_any();
  return limits;
}

/// A stop heeds no limit of jerk, but its acceleration swells and ebbs, and on a curved way the
/// curve takes a part of it: a stop takes up to `kSwells` times as long as with all of the
/// acceleration from its first instant on.
void check_stop(const Params& params, const RobotModel& model, Duration within) {
  constexpr double kSwells = 2;
  const MotionLimits limits = limits_of(params, model);
  for (int i = 0; i < model.dof(); ++i) {
    const double brakes = limits.max_acceleration[i], range = model.upper()[i] - model.lower()[i];
    // From rest at one end of its range to rest at the other one it comes to this.
    const double speed = std::min(limits.max_velocity[i], std::sqrt(brakes * range));
    const double takes_s = kSwells * speed / brakes + RestWatch::kRests_s;
    if (takes_s <= to_seconds(within)) continue;
    const Joint& joint = model.joints()[static_cast<std::size_t>(model.independent_joint(i))];
    const bool slides = joint.type == Joint::Type::prismatic;
    const char *const velocity = slides ? "max_velocity_m_s" : "max_velocity_rad_s",
                      *const acceleration =
                          slides ? "max_acceleration_m_s2" : "max_acceleration_rad_s2";
    const bool is_robots_own = brakes >= model.max_acceleration()[i];
    params.refuse(
        {acceleration, velocity},
        fmt::format("joint {} of robot {} takes {:.3g} s to stop from {:.3g} {} with {:.3g} {}, "
                    "and 'run: {{stop_within_s}}' is {:g}; raise that, or {}lower {}",
                    joint.name, model.name(), takes_s, speed, slides ? "m/s" : "rad/s", brakes,
                    slides ? "m/s2" : "rad/s2", to_seconds(within),
                    is_robots_own ? "" : fmt::format("{}, or ", acceleration), velocity));
  }
}

/// The robot as the solver has it: narrower, and without what is locked.
RobotModel solver_model_of(const Params& params, const RobotModel& model) {
  const auto parameters = Parameters::read(params);
  auto narrow = narrowed(
      model, {.turning_rad = parameters.limit_margin_rad, .sliding_m = parameters.limit_margin_m});
  if (!narrow) params.refuse({"limit_margin_deg", "limit_margin_mm"}, narrow.error().text);
  return without_locked_joints(*narrow);
}

PlanningOptions planning_of(const Parameters& parameters) {
  return {.path_only = parameters.path_only,
          .narrow_solver = parameters.limit_margin_rad > 0 || parameters.limit_margin_m > 0,
          .min_link_clearance = parameters.min_link_clearance,
          .max_path_deviation = {.position_m = parameters.max_path_deviation_m,
                                 .angle_rad = parameters.max_path_deviation_rad}};
}

namespace {

/// None where no shaft shall pivot.
std::optional<PivotOptions> pivot_of(const Parameters& parameters, const Params& params,
                                     const RobotModel& model) {
  if (!parameters.remote_centre) return std::nullopt;
  if (!model.shaft()) {
    params.refuse({"remote_centre"},
                  fmt::format("'remote_centre' needs a shaft, and robot {} names none; state in "
                              "its file, for example, shaft: {{axis: z, length_mm: 250}}",
                              model.name()));
  }
  return PivotOptions{.max_deviation = parameters.max_incision_deviation,
                      .max_offset = parameters.max_incision_offset,
                      .min_depth = parameters.min_depth};
}

}  // namespace

TrackingOptions tracking_of(const Params& params, const RobotModel& model) {
  const auto parameters = Parameters::read(params);
  const double speed = parameters.max_tracking_velocity;
  return {.shortest_horizon_s = parameters.tracking_horizon,
          .max_jerk = max_jerk_of(parameters, model),
          .max_tool_speed = speed > 0 ? speed : std::numeric_limits<double>::infinity(),
          .pivot = pivot_of(parameters, params, model)};
}

ExecutionOptions execution_of(const Parameters& parameters) {
  return {
      .following = {.period = seconds(1 / parameters.rate),
                    .max_deviation = {parameters.max_deviation_rad, parameters.max_deviation_m},
                    .max_tip_deviation = parameters.max_tip_deviation,
                    .goal_tolerance = {parameters.goal_tolerance_rad, parameters.goal_tolerance_m},
                    .rest_tolerance = {parameters.rest_tolerance_rad, parameters.rest_tolerance_m},
                    .measured_max_age = seconds(parameters.measured_max_age),
                    .max_lateness = seconds(parameters.max_lateness)},
      .plan_budget = seconds(parameters.plan_budget),
      .goal_time = seconds(parameters.goal_time)};
}

}  // namespace armature
