// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/pose_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/robot/kinematics/held_arm.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "leading_hand.hpp"
#include "sim_leading_hand_ports.hpp"

namespace armature::sim::leading_hand {
namespace {

constexpr Duration kPeriod = seconds(0.001);

Parameters parameters_of(const Params& params) {
  const Parameters parameters = Parameters::read(params);
  for (const double number : parameters.order) {
    if (number == std::round(number)) continue;
    params.refuse({"order"},
                  fmt::format("'order' has {:g}, and markers are counted 1, 2, 3", number));
  }
  return parameters;
}

}  // namespace

class LeadingHandComponent final : public Component {
 public:
  explicit LeadingHandComponent(Setup& setup)
      : Component{setup},
        robot_{robot_of(setup)},
        parameters_{parameters_of(setup.params())},
        hand_{parameters_, setup.seed()},
        ports_{setup} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!ports_.task_state.latest() || has_let_go(now)) return;
    const msg::TaskState& task = *ports_.task_state.latest();
    const bool over = task.state_() == "aborted" || task.state_() == "refused";
    const bool halted = stopping_ || over || task.paused_();
    const Touches touches{.wanted = task.state_() == "touching" && !halted,
                          .taken = task.step_(),
                          .by_itself = task.auto_confirm_()};
    if (!hand_.holds() && hand_.has_more(touches)) take_hold(now);
    if (hand_.holds()) move(hand_.lead(touches, halted, now), now);
  }

  void begin_stop(Time) override { stopping_ = true; }
  bool stopped() const override { return !hand_.holds(); }

 private:
  bool has_let_go(Time now) {
    const bool for_good = held_since_ && parameters_.lets_go > 0 &&
                          now - *held_since_ >= seconds(parameters_.lets_go);
    if (for_good) hand_.let_go();
    return for_good;
  }

  void take_hold(Time now) {
    if (!ports_.plan.latest() || !ports_.truth.latest() || !ports_.measured_js.latest()) return;
    const auto q = joints_of(robot_, *ports_.measured_js.latest());
    if (!q) return degraded("measured_js: " + q.error().text);
    const auto base_T_image = pose_of(ports_.truth.latest()->transform_(), "the truth's");
    if (!base_T_image) return degraded(base_T_image.error().text);
    std::vector<Eigen::Vector3d> markers;
    for (const auto& marker : ports_.plan.latest()->markers_()) {
      markers.push_back(*base_T_image * to_eigen(marker));
    }
    if (markers.empty()) return degraded("the plan has no markers");
    for (const double number : parameters_.order) {
      if (number <= static_cast<double>(markers.size())) continue;
      return degraded(
          fmt::format("'order' names marker {:g}, and the plan has {}", number, markers.size()));
    }
    q_ = *q;
    const Eigen::Isometry3d base_T_tool = forward_kinematics(robot_, q_);
    pose_ = {base_T_tool.translation(), Eigen::Quaterniond{base_T_tool.linear()}};
    if (robot_.pointing_axis()) {
      pose_.orientation = Direction{base_T_tool.linear() * *robot_.pointing_axis()};
    }
    hand_.take_hold(markers, pose_.position, now);
    moved_at_ = now;
    if (!held_since_) held_since_ = now;
  }

  /// The tool keeps its orientation. A joint goes along as readily as it is fast: a needle that
  /// slides slowly is held where it is. A hand that the arm cannot follow stays where it is.
  void move(const Eigen::Vector3d& tip, Time now) {
    pose_.position = tip;
    const auto q = joints_of_held_arm(robot_, pose_, q_, robot_.max_velocity());
    if (q) {
      healthy();
    } else {
      degraded("the hand stops: " + q.error().text);
    }
    const JointVector next = q.value_or(q_);
    const double passed_s = to_seconds(now - std::exchange(moved_at_, now));
    auto loan = ports_.hand_js.loan();
    write_all_joints(robot_, next, JointVector{(next - q_) / (passed_s > 0 ? passed_s : 1)}, now,
                     *loan);
    loan.publish();
    q_ = next;
  }

  RobotModel robot_;
  Parameters parameters_;
  LeadingHand hand_;
  std::optional<Time> held_since_;
  Time moved_at_;
  bool stopping_ = false;
  JointVector q_;
  ToolPose pose_;  // of the tool in the hand
  Ports ports_;
};

}  // namespace armature::sim::leading_hand

ARMATURE_PLUGIN(armature::sim::leading_hand::LeadingHandComponent);
