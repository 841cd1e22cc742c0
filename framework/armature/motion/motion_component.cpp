// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/motion_component.hpp"

#include <fmt/core.h>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/pose_in_base.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/motion/motion_messages.hpp"
#include "armature/motion/motion_params.hpp"
#include "armature/motion/planner_component.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {
namespace {

constexpr Duration kStatusPeriod = seconds(0.1);
constexpr Duration kTimeout = seconds(0.5);

/// Why a plugin in slot `ik` must not be called on a control thread, or "".
std::string unfit_to_track(const PluginManifest& plugin) {
  const char* says = plugin.allocates ? "allocates: true" : plugin.pure ? "" : "pure: false";
  if (*says == '\0') return "";
  return fmt::format("'{}' cannot track a target: its plugin.yaml says '{}'", plugin.id, says);
}

/// Messages of the size that they will have: what is filled later needs no memory then.
msg::JointState joints_with_room(const RobotModel& model) {
  const JointVector zero = JointVector::Zero(model.dof());
  msg::JointState message;
  write_all_joints(model, zero, zero, {}, message);
  return message;
}

msg::JointReference reference_with_room(const RobotModel& model) {
  const JointVector zero = JointVector::Zero(model.dof());
  msg::JointReference message;
  write_reference(model, {zero, zero, zero}, {}, message);
  return message;
}

msg::PoseStamped pose_with_room() {
  msg::PoseStamped message;
  write_header(message.header_(), {}, kBaseFrame);
  return message;
}

msg::MotionStatus status_with_room() {
  const ReasonText longest{std::string(1000, ' ')};
  msg::MotionStatus message;
  write_status({.stage = longest.view(), .reason = longest}, {}, message);
  return message;
}

msg::MotionPlanRequest request_of(const RobotModel& model) {
  const JointVector zero = JointVector::Zero(model.dof());
  msg::MotionPlanRequest message;
  write_request({.goal_id = 0, .continues = 0, .start = {}, .from = {zero, zero, zero}}, message);
  return message;
}

}  // namespace

Motion::Motion(Setup& setup)
    : Component(setup),
      parameters_{motion::Parameters::read(setup.params())},
      model_{robot_of(setup)},
      solver_model_{solver_model_of(setup.params(), model_)},
      no_tracker_{unfit_to_track(setup.slot_manifest("ik"))},
      ik_{no_tracker_.empty() ? setup.slot<IkSolver>("ik", solver_model_) : Slot<IkSolver>{}},
      goals_{setup.input<msg::MotionGoal>("goal")},
      plans_{setup.input<msg::MotionPlan>("plan")},
      measured_js_{setup.input<msg::JointState>("measured_js")},
      incision_{setup.input<msg::PointStamped>("incision")},
      stops_{setup, seconds(parameters_.operator_timeout)},
      plan_request_{setup.output<msg::MotionPlanRequest>("plan_request")},
      servo_jp_{setup.output<msg::JointState>("servo_jp")},
      setpoint_cp_{setup.output<msg::PoseStamped>("setpoint_cp")},
      reference_{setup.output<msg::JointReference>("reference")},
      status_{setup.output<msg::MotionStatus>("status")},
      tracker_{ik_ ? std::optional<Tracker>{std::in_place, model_,
                                            limits_of(setup.params(), model_), ik_,
                                            tracking_of(setup.params(), model_)}
                   : std::nullopt},
      execution_{model_, limits_of(setup.params(), model_), execution_of(parameters_),
                 tracker_ ? &*tracker_ : nullptr, no_tracker_} {
  check_stop(setup.params(), model_, setup.stop_within());
  if (ik_) ik_.object_to(unfit_to_track);
  if (parameters_.remote_centre && !tracker_) {
    setup.params().refuse({"remote_centre"}, "'remote_centre' is for tracked targets only, and " +
                                                 no_tracker_ +
                                                 "; choose another 'ik', for example ik/numeric");
  }
  if (parameters_.remote_centre && !setup.is_written("incision")) {
    setup.params().refuse({"remote_centre"},
                          "'remote_centre' needs an incision, and no component writes 'incision'; "
                          "add one that does, for example sim/surgeon with incision_mm");
  }
  servo_jp_.prepare(joints_with_room(model_));
  setpoint_cp_.prepare(pose_with_room());
  reference_.prepare(reference_with_room(model_));
  status_.prepare(status_with_room());
  plan_request_.prepare(request_of(model_));
  setup.activate_every(seconds(1 / parameters_.rate));
}

void Motion::step(Time now) {
  const auto measured = read_measured();
  read_incision();
  execution_.update(now, measured);
  const bool may_rearm = heed_stops(now);
  if (plans_.fresh()) {
    execution_.take(read_answer(model_, *plans_.latest(), plans_.sample(0)), now);
  }
  // Whoever gave a goal is stopping, too: that the goal is dropped is no failure of his.
  if (!stopping_) {
    read_goals(now);
    // After them: a goal of this step was given while the arm was stopped.
    if (may_rearm && stops_.rearmed()) execution_.rearm(now);
    publish_request();
    publish_statuses(now);
  }
  if (execution_.reference().started()) publish_reference(now);
  see_waiting(now);
  show_health(now);
  stopped_ = execution_.at_rest(now);
}

void Motion::begin_stop(Time now) {
  stopping_ = true;
  execution_.halt("the run is stopping", now);
  stopped_ = execution_.at_rest(now);
}

bool Motion::heed_stops(Time now) {
  const StopCause cause = stops_.cause(now);
  execution_.set_follows(cause.follows);
  if (cause.why.empty()) return true;
  const auto why = ReasonText::format("stopped until it is rearmed: {}", cause.why.view());
  if (cause.wants_operator) {
    execution_.halt_before_operator(why, now);
  } else {
    execution_.halt(why, now);
  }
  return false;
}

std::optional<MeasuredJoints> Motion::read_measured() {
  const msg::JointState* message = measured_js_.latest();
  if (!message) return std::nullopt;
  MeasuredJoints measured{.stamp = stamp_of(message->header_().stamp_()), .q = {}};
  const ReasonText wrong = read_joints(model_, *message, measured.q);
  bad_measurement_ =
      wrong.empty() ? ReasonText{} : ReasonText::format("measured_js: {}", wrong.view());
  if (!wrong.empty()) return std::nullopt;
  // Only a reference that begins asks whether the arm moves; drivers need not tell.
  const bool tells = !execution_.reference().started() && !message->velocity_().empty();
  if (tells && !read_joint_rates(model_, *message, measured.v).empty()) measured.v.resize(0);
  return measured;
}

void Motion::read_incision() {
  if (!parameters_.remote_centre || !tracker_ || !incision_.fresh()) return;
  const msg::PointStamped& message = *incision_.latest();
  const Eigen::Vector3d point = to_eigen(message.point_());
  bad_incision_ = defect_of_point(message.header_(), point, "the incision");
  // Until a good one comes the shaft is where it was: in the incision, if it was in one.
  if (bad_incision_.empty()) tracker_->pivot()->set_incision(point);
}

ReasonText Motion::pivot_refusal(const MotionGoal& goal, Time now) const {
  if (!parameters_.remote_centre || !tracker_) return {};
  const bool pivots = tracker_->pivots();
  const bool is_planned = goal.mode == MotionMode::planned || goal.mode == MotionMode::resume ||
                          goal.mode == MotionMode::retrace;
  if (is_planned && pivots) {
    return "the shaft is in an incision, about which no planned path pivots: track a target";
  }
  if (goal.mode != MotionMode::tracking) return {};
  if (!bad_incision_.empty()) return bad_incision_;
  if (!pivots) return "the incision is not registered: nothing was told on topic incision";
  if (!std::holds_alternative<Eigen::Quaterniond>(goal.pose.orientation)) {
    return "a direction leaves the roll of the shaft open: give the goal a rotation";
  }
  if (!execution_.reference().started()) return {};
  return tracker_->pivot()->refusal(execution_.reference().at(now).q);
}

void Motion::see_waiting(Time now) {
  const bool tracks = tracked_at_ && now - *tracked_at_ < kTimeout;
  if (!tracks || tracker_->waits_for().empty()) {
    waits_since_.reset();
    return waits_for_.clear();
  }
  if (!waits_since_) waits_since_ = now;
  // A target that is only far away is come to; the first words stay, whose numbers change.
  if (now - *waits_since_ < kTimeout || !waits_for_.empty()) return;
  const char* how = tracker_->pivots() ? "the tip waits before" : "the tool keeps only near";
  waits_for_ = ReasonText::format("{} its target: {}", how, tracker_->waits_for().view());
}

void Motion::read_goals(Time now) {
  // Of the targets of one step only the newest is worth a search.
  std::optional<std::uint64_t> newest;
  for (std::size_t i = goals_.size(); tracker_ && !newest && i-- > 0;) {
    const bool usable = read_goal_head(goals_[i], goal_).empty();
    if (usable && goal_.mode == MotionMode::tracking) newest = goal_.id;
  }
  for (std::size_t i = 0; i < goals_.size(); ++i) {
    ReasonText wrong = read_goal_head(goals_[i], goal_);
    if (wrong.empty()) wrong = pivot_refusal(goal_, now);
    const bool tracked = newest && wrong.empty() && goal_.mode == MotionMode::tracking;
    if (tracked) tracked_at_ = now;
    if (tracked && is_newer(*newest, goal_.id)) {
      execution_.pass_over(goal_);
    } else {
      execution_.take(goal_, wrong, now);
    }
  }
}

void Motion::publish_request() {
  const auto request = execution_.take_request();
  if (!request) return;
  auto message = plan_request_.loan();
  write_request(*request, *message);
  message.publish();
}

void Motion::publish_statuses(Time now) {
  for (const GoalStatus& status : execution_.take_statuses()) {
    publish_status(status, now);
    // What is refused because the arm is stopped, as tasks ask again and again, is no news.
    if (status.state == GoalStatus::State::failed && !execution_.halted()) {
      log(InlineText<300>::format("goal {} failed in {}: {}", status.goal_id, status.stage.view(),
                                  status.reason.view()));
    }
  }
  if (now - last_status_ < kStatusPeriod) return;
  if (const auto current = execution_.current(now)) publish_status(*current, now);
}

void Motion::publish_status(const GoalStatus& status, Time now) {
  auto loan = status_.loan();
  write_status(status, now, *loan);
  loan.publish();
  last_status_ = now;
}

void Motion::publish_reference(Time now) {
  const JointState state = execution_.reference().at(now);
  auto servo = servo_jp_.loan();
  write_all_joints(model_, state.q, state.v, now, *servo);
  servo.publish();
  if (setpoint_cp_.has_subscribers()) {
    auto setpoint = setpoint_cp_.loan();
    write_header(setpoint->header_(), now, kBaseFrame);
    assign(setpoint->pose_(), forward_kinematics(model_, state.q));
    setpoint.publish();
  }
  auto reference = reference_.loan();
  write_reference(model_, state, now, *reference);
  reference.publish();
}

void Motion::show_health(Time now) {
  if (stopping_) return;  // of which everybody knows
  // That an arm has not spoken yet is worth a word only when it takes long.
  if (!first_step_) first_step_ = now;
  if (!execution_.reference().started() && now - *first_step_ < kTimeout) return;
  const ReasonText& mild = stops_.unknown_word().empty() ? waits_for_ : stops_.unknown_word();
  const ReasonText& standing = execution_.trouble().empty() ? mild : execution_.trouble();
  const ReasonText& trouble = bad_measurement_.empty() ? standing : bad_measurement_;
  if (trouble == shown_trouble_) return;
  shown_trouble_ = trouble;
  if (trouble.empty()) {
    healthy();
  } else {
    degraded(trouble);
  }
}

namespace {

/// The plugin `motion`: one entry in a deployment, two units at run time.
struct MotionUnits {
  static constexpr std::string_view kKind = Component::kKind;
  using Factory = Component::Factory;

  static std::unique_ptr<Component> make(Setup& setup) {
    if (setup.unit() == kMainUnit) return std::make_unique<Motion>(setup);
    return std::make_unique<MotionPlanner>(setup);
  }
};

}  // namespace
}  // namespace armature

ARMATURE_PLUGIN(armature::MotionUnits);
