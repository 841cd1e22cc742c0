// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/motion_params.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "armature/motion/limit_margin.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {
namespace {

/// A limit for joints that turn and one for joints that slide.
struct LimitParams {
  const char *turning, *sliding;
  const char *turning_unit, *sliding_unit;
};

/// The same limit for every joint of a kind, refused where the robot's own is lower; 0: the robot's
/// own.
JointVector limits_from(const Setup& setup, const LimitParams& params, const RobotModel& model,
                        const JointVector& robot_limit) {
  JointVector limits = robot_limit;
  for (int i = 0; i < model.dof(); ++i) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(model.independent_joint(i))];
    const bool slides = joint.type == Joint::Type::prismatic;
    const char* param = slides ? params.sliding : params.turning;
    const double value = setup.params().number(param);
    if (value == 0) continue;
    if (value > robot_limit[i]) {
      throw SetupError(fmt::format(
          "{} is {}, above the {} {} of joint {} of robot {}", param, value, robot_limit[i],
          slides ? params.sliding_unit : params.turning_unit, joint.name, model.name()));
    }
    limits[i] = value;
  }
  return limits;
}

/// A limit for joints that slide would limit nothing where none does, as if the tool were meant.
void refuse_idle_limits(const Params& params, const RobotModel& model) {
  const auto slides = [](const Joint& joint) { return joint.type == Joint::Type::prismatic; };
  if (std::ranges::any_of(model.joints(), slides)) return;
  for (const char* name : {"max_velocity_m_s", "max_acceleration_m_s2", "max_jerk_m_s3"}) {
    if (params.number(name) == 0) continue;
    params.refuse({name}, fmt::format("{} is for joints that slide, and robot {} has none", name,
                                      model.name()));
  }
}

/// Empty when neither kind of joint has a limit.
JointVector max_jerk_of(const Params& params, const RobotModel& model) {
  const double turning = params.number("max_jerk_rad_s3"), sliding = params.number("max_jerk_m_s3");
  if (turning == 0 && sliding == 0) return {};
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return each({turning > 0 ? turning : kAny, sliding > 0 ? sliding : kAny}, model);
}

}  // namespace

MotionLimits limits_of(const Setup& setup, const RobotModel& model) {
  refuse_idle_limits(setup.params(), model);
  return {limits_from(setup, {"max_velocity_rad_s", "max_velocity_m_s", "rad/s", "m/s"}, model,
                      model.max_velocity()),
          limits_from(setup, {"max_acceleration_rad_s2", "max_acceleration_m_s2", "rad/s2", "m/s2"},
                      model, model.max_acceleration())};
}

/// The robot as the solver has it.
RobotModel solver_model_of(const Params& params, const RobotModel& model) {
  auto narrow = narrowed(model, {.turning_rad = params.number("limit_margin_deg"),
                                 .sliding_m = params.number("limit_margin_mm")});
  if (!narrow) params.refuse({"limit_margin_deg", "limit_margin_mm"}, narrow.error().text);
  return std::move(*narrow);
}

PlanningOptions planning_of(const Params& params) {
  return {.path_only = params.flag("path_only"),
          .narrow_solver =
              params.number("limit_margin_deg") > 0 || params.number("limit_margin_mm") > 0};
}

TrackingOptions tracking_of(const Params& params, const RobotModel& model) {
  const double speed = params.number("max_tracking_velocity_m_s");
  return {.shortest_horizon_s = params.number("tracking_horizon_s"),
          .max_jerk = max_jerk_of(params, model),
          .max_tool_speed = speed > 0 ? speed : std::numeric_limits<double>::infinity()};
}

ExecutionOptions execution_of(const Params& params) {
  return {
      .period = seconds(1 / params.number("rate_hz")),
      .plan_budget = seconds(params.number("plan_budget_s")),
      .max_deviation = {params.number("max_deviation_rad"), params.number("max_deviation_m")},
      .goal_tolerance = {params.number("goal_tolerance_rad"), params.number("goal_tolerance_m")},
      .rest_tolerance = {params.number("rest_tolerance_rad"), params.number("rest_tolerance_m")},
      .goal_time = seconds(params.number("goal_time_s")),
      .measured_max_age = seconds(params.number("measured_max_age_s")),
      .max_lateness = seconds(params.number("max_lateness_s"))};
}

}  // namespace armature
