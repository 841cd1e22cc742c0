// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/trajectory/trajectory_messages.hpp"
#include "armature/motion/limit_margin.hpp"
#include "armature/motion/motion_messages.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {
namespace {

constexpr Duration kStatusPeriod = seconds(0.1);
constexpr Duration kPatience = seconds(0.5);

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

/// Empty when neither kind of joint has a limit.
JointVector max_jerk_of(const Params& params, const RobotModel& model) {
  const double turning = params.number("max_jerk_rad_s3"), sliding = params.number("max_jerk_m_s3");
  if (turning == 0 && sliding == 0) return {};
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return each({turning > 0 ? turning : kAny, sliding > 0 ? sliding : kAny}, model);
}

PlanningOptions planning_of(const Params& params) {
  return {.path_only = params.flag("path_only"),
          .narrow_solver =
              params.number("limit_margin_deg") > 0 || params.number("limit_margin_mm") > 0};
}

/// 0 stands for any.
double max_tool_speed_of(const Params& params) {
  const double speed = params.number("max_tracking_velocity_m_s");
  return speed > 0 ? speed : std::numeric_limits<double>::infinity();
}

ExecutionOptions options_of(const Params& params, const RobotModel& model) {
  return {
      .plan_budget = seconds(params.number("plan_budget_s")),
      .max_deviation = {params.number("max_deviation_rad"), params.number("max_deviation_m")},
      .goal_tolerance = {params.number("goal_tolerance_rad"), params.number("goal_tolerance_m")},
      .goal_time = seconds(params.number("goal_time_s")),
      .measured_max_age = seconds(params.number("measured_max_age_s")),
      .tracking = {.shortest_horizon_s = params.number("tracking_horizon_s"),
                   .max_jerk = max_jerk_of(params, model),
                   .max_tool_speed = max_tool_speed_of(params)}};
}

}  // namespace

class Motion : public Component {
 public:
  explicit Motion(Setup& setup)
      : Component(setup),
        model_{robot_of(setup)},
        solver_model_{solver_model_of(setup.params(), model_)},
        path_{setup.slot<PathPlanner>("path")},
        ik_{setup.slot<IkSolver>("ik", solver_model_)},
        select_{setup.slot<BranchSelector>("select", model_)},
        trajectory_{setup.slot<TrajectoryPlanner>("trajectory")},
        goals_{setup.input<msg::MotionGoal>("goal")},
        measured_js_{setup.input<msg::JointState>("measured_js")},
        servo_jp_{setup.output<msg::JointState>("servo_jp")},
        reference_js_{setup.output<msg::JointState>("reference")},
        status_{setup.output<msg::MotionStatus>("status")},
        path_out_{setup.output<msg::ToolPath>("path")},
        joint_path_out_{setup.output<msg::JointTrajectory>("joint_path")},
        joint_trajectory_out_{setup.output<msg::JointTrajectory>("joint_trajectory")},
        trajectory_out_{setup.output<msg::QuinticTrajectory>("trajectory")},
        execution_{GoalPlanner{model_,
                               {*path_, *ik_, *select_, *trajectory_},
                               limits_of(setup, model_),
                               planning_of(setup.params())},
                   options_of(setup.params(), model_)} {
    setup.activate_every(seconds(1 / setup.params().number("rate_hz")));
  }

  void step(Time now) override {
    const auto measured = read_measured();
    execution_.update(now, measured);
    for (std::size_t i = 0; i < goals_.size(); ++i) {
      execution_.take(read_goal(goals_[i]), goals_[i].goal_id_(), now);
    }
    publish_statuses(now);
    publish_plan();
    if (execution_.reference().started()) publish_reference(now);
    show_health(now);
  }

 private:
  std::optional<MeasuredJoints> read_measured() {
    const msg::JointState* message = measured_js_.latest();
    if (!message) return std::nullopt;
    const auto q = joints_of(model_, *message);
    if (!q) {
      bad_measurement_ = "measured_js: " + q.error().text;
      return std::nullopt;
    }
    bad_measurement_.clear();
    return MeasuredJoints{stamp_of(message->header_().stamp_()), *q};
  }

  void publish_statuses(Time now) {
    for (const GoalStatus& status : execution_.take_statuses()) {
      publish_status(status, now);
      if (status.state == GoalStatus::State::failed) {
        say(fmt::format("goal {} failed in {}: {}", status.goal_id, status.stage, status.reason));
      }
    }
    if (now - last_status_ < kStatusPeriod) return;
    if (const auto current = execution_.current(now)) publish_status(*current, now);
  }

  void publish_status(const GoalStatus& status, Time now) {
    auto loan = status_.loan();
    write_status(status, now, *loan);
    loan.publish();
    last_status_ = now;
  }

  void publish_plan() {
    const auto plan = execution_.take_plan();
    if (!plan) return;
    auto path = path_out_.loan();
    write_path(*plan, model_, *path);
    path.publish();
    auto joint_path = joint_path_out_.loan();
    write_joint_path(*plan, model_, *joint_path);
    joint_path.publish();
    auto trajectory = trajectory_out_.loan();
    write_trajectory(plan->trajectory, model_, *trajectory);
    trajectory.publish();
    auto points = joint_trajectory_out_.loan();
    write_trajectory_points(plan->trajectory, model_, *points);
    points.publish();
  }

  void publish_reference(Time now) {
    const JointState state = execution_.reference().at(now);
    auto servo = servo_jp_.loan();
    write_all_joints(model_, state.q, state.v, now, *servo);
    servo.publish();
    auto reference = reference_js_.loan();
    write_independent_joints(model_, state, now, *reference);
    reference.publish();
  }

  void show_health(Time now) {
    // That an arm has not spoken yet is worth a word only when it takes long.
    if (!first_step_) first_step_ = now;
    if (!execution_.reference().started() && now - *first_step_ < kPatience) return;
    const std::string& trouble = bad_measurement_.empty() ? execution_.trouble() : bad_measurement_;
    if (trouble == shown_trouble_) return;
    shown_trouble_ = trouble;
    if (trouble.empty()) {
      healthy();
    } else {
      degraded(trouble);
    }
  }

  RobotModel model_, solver_model_;
  PluginPtr<PathPlanner> path_;
  PluginPtr<IkSolver> ik_;
  PluginPtr<BranchSelector> select_;
  PluginPtr<TrajectoryPlanner> trajectory_;
  Input<msg::MotionGoal> goals_;
  Input<msg::JointState> measured_js_;
  Output<msg::JointState> servo_jp_, reference_js_;
  Output<msg::MotionStatus> status_;
  Output<msg::ToolPath> path_out_;
  Output<msg::JointTrajectory> joint_path_out_, joint_trajectory_out_;
  Output<msg::QuinticTrajectory> trajectory_out_;
  GoalExecution execution_;
  Time last_status_;
  std::optional<Time> first_step_;
  std::string bad_measurement_, shown_trouble_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::Motion);
