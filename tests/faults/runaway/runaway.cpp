// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "test_runaway_parameters.hpp"

namespace armature::test::runaway {

class Runaway final : public Component {
 public:
  explicit Runaway(Setup& setup)
      : Component{setup},
        robot_{robot_of(setup)},
        parameters_{Parameters::read(setup.params())},
        measured_js_{setup.output<msg::JointState>("measured_js")} {
    setup.activate_every(seconds(0.001));
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    constexpr double kSwing = 0.1;  // [rad], and [rad/s]
    const double passed_s = to_seconds(now - *start_);
    const bool stands = parameters_.stands_after > 0 && passed_s > parameters_.stands_after;
    const double phase = stands ? parameters_.stands_after : passed_s;
    JointVector q = resting_position(robot_), v = JointVector::Zero(robot_.dof());
    if (parameters_.jumps && stopping_) {
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
  Parameters parameters_;
  Output<msg::JointState> measured_js_;
  std::optional<Time> start_;
  bool stopping_ = false;
};

}  // namespace armature::test::runaway

ARMATURE_PLUGIN(armature::test::runaway::Runaway);
