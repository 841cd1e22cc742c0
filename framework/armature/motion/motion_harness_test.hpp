// SPDX-License-Identifier: Apache-2.0
// The motion component's two units on a bench, with the gantry's stages in their slots.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/motion/gantry_stages_test.hpp"
#include "armature/motion/motion_messages.hpp"
#include "armature/runtime/testing/component_harness.hpp"

namespace armature::test {

inline PluginRegistry& plugins() {
  static PluginRegistry registry = [] {
    PluginRegistry made{{ARMATURE_PLUGIN_BUILD_DIR}};
    made.add<LinePath>("{armature_plugin: 1, id: path/line, kind: path}");
    made.add<GantryIk>("{armature_plugin: 1, id: ik/gantry, kind: ik}");
    made.add<FirstBranch>("{armature_plugin: 1, id: select/first, kind: select}");
    made.add<OneQuintic>("{armature_plugin: 1, id: trajectory/one, kind: trajectory}");
    return made;
  }();
  return registry;
}

/// The gantry of gantry_stages_test.hpp, as a file.
inline config::Node gantry_file() {
  const std::string rest =
      "type: prismatic, limits_m: [-2, 2], velocity_m_s: 1, acceleration_m_s2: 2.5}";
  return config::parse_text(
      "armature_robot: 1\nname: gantry\njoints:\n"
      "  - {name: z, alpha_deg: -90, " +
          rest +
          "\n"
          "  - {name: y, theta_deg: 90, alpha_deg: 90, " +
          rest +
          "\n"
          "  - {name: x, " +
          rest +
          "\n"
          "frames: {tool: {parent: x}}\npointing_axis: z\n",
      "gantry.yaml");
}

inline ComponentHarness::Options motion_with(const std::string& params,
                                             std::string_view unit = kMainUnit,
                                             std::vector<std::string> written = {}) {
  return {.component = "{plugin: motion, params: {" + params +
                       "}, path: {plugin: path/line}, ik: {plugin: ik/gantry}, "
                       "select: {plugin: select/first}, trajectory: {plugin: trajectory/one}}",
          .robot = gantry_file(),
          .unit = std::string{unit},
          .written = std::move(written)};
}

inline msg::MotionGoal goal_message(std::uint64_t id, const Eigen::Vector3d& position) {
  msg::MotionGoal message;
  write_header(message.header_(), {}, kBaseFrame);
  message.goal_id_(id);
  assign(message.position_(), position);
  message.pointing_(true);
  assign(message.direction_(), Eigen::Vector3d{1, 0, 0});
  return message;
}

/// Both units, and an arm.
class MotionHarness {
 public:
  /// `written`: optional inputs that some other component writes.
  explicit MotionHarness(const std::vector<std::string>& written = {})
      : motion_{plugins(), motion_with("", kMainUnit, written)},
        planner_{plugins(), motion_with("", "planner")} {}

  ComponentHarness& motion() { return motion_; }
  double now_s() const { return now_s_; }
  /// Of the fastest joint that is commanded.
  double speed() const {
    double fastest = 0;
    for (const double v : servo_.back().velocity_()) fastest = std::max(fastest, std::abs(v));
    return fastest;
  }
  /// What an operator's button tells from now on, on every step; nothing: it is silent.
  void set_operator(std::optional<bool> holds) { hold_ = holds; }

  void measure(const JointVector& q, double stamp_s) {
    msg::JointState message;
    write_all_joints(model_, q, JointVector::Zero(3), Time{} + seconds(stamp_s), message);
    motion_.send("measured_js", message);
  }
  /// An arm that is where it was told to be, at 100 Hz, until `until_s`.
  void run(double until_s) {
    while (now_s_ < until_s - 1e-9) {
      now_s_ += 0.01;
      measure(arm_, now_s_);
      if (hold_) send_hold();
      step();
      for (const auto& told : motion_.take<msg::JointState>("servo_jp")) {
        servo_.push_back(told);
        arm_ = model_.to_independent(told.position_()).value();
      }
      collect();
    }
  }
  void give(const msg::MotionGoal& goal) {
    motion_.send("goal", goal);
    planner_.send("goal", goal);
  }
  /// One step of motion; when it wants a plan, that comes at once.
  void step() {
    motion_.step(now_s_);
    for (const auto& request : motion_.take<msg::MotionPlanRequest>("plan_request")) {
      planner_.send("plan_request", request);
      planner_.step(now_s_);
      for (const auto& plan : planner_.take<msg::MotionPlan>("plan")) motion_.send("plan", plan);
      if (motion_.triggered()) motion_.step(now_s_);
    }
  }
  void collect() {
    for (const auto& told : motion_.take<msg::MotionStatus>("status")) statuses_.push_back(told);
  }
  /// Changes only, as "1 executing".
  std::vector<std::string> history() const {
    const char* const kWords[] = {"accepted", "executing", "done", "superseded", "failed"};
    std::vector<std::string> told;
    for (const auto& status : statuses_) {
      const std::string word = std::to_string(status.goal_id_()) + " " + kWords[status.state_()];
      if (told.empty() || told.back() != word) told.push_back(word);
    }
    return told;
  }
  /// Which stage refused or dropped the last goal.
  std::string last_stage() const { return statuses_.back().stage_(); }

 protected:
  void send_hold() {
    msg::Bool message;
    message.data_(*hold_);
    motion_.send("hold_to_run", message);
  }

  const RobotModel model_ = gantry();
  std::optional<bool> hold_;
  ComponentHarness motion_, planner_;
  JointVector arm_ = Eigen::Vector3d{0.1, 0.2, 0.3};
  double now_s_ = 100;
  std::vector<msg::JointState> servo_;
  std::vector<msg::MotionStatus> statuses_;
};

}  // namespace armature::test
