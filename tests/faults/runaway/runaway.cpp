// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {

class Runaway final : public Component {
 public:
  explicit Runaway(Setup& setup)
      : Component{setup},
        robot_{robot_of(setup)},
        jumps_{setup.params().flag("jumps")},
        stands_after_s_{setup.params().number("stands_after_s")},
        measured_js_{setup.output<msg::JointState>("measured_js")} {
    setup.activate_every(seconds(0.001));
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    constexpr double kSwing = 0.1;  // [rad], and [rad/s]
    const double passed_s = to_seconds(now - *start_);
    const bool stands = stands_after_s_ > 0 && passed_s > stands_after_s_;
    const double phase = stands ? stands_after_s_ : passed_s;
    JointVector q = resting_position(robot_), v = JointVector::Zero(robot_.dof());
    if (jumps_ && stopping_) {
      q[0] -= 1;
    } else {  // round a circle, so that one of the two joints always moves
      q.head<2>() += kSwing * Eigen::Vector2d{std::sin(phase), std::cos(phase)};
      if (!stands) v.head<2>() = kSwing * Eigen::Vector2d{std::cos(phase), -std::sin(phase)};
    }
    auto measured = measured_js_.loan();
    write_all_joints(robot_, q, v, now, *measured);
    measured.publish();
  }
  void begin_stop(Time) override { stopping_ = true; }

 private:
  RobotModel robot_;
  bool jumps_;
  double stands_after_s_;
  Output<msg::JointState> measured_js_;
  std::optional<Time> start_;
  bool stopping_ = false;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::Runaway);
