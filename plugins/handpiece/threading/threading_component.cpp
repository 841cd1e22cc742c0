// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/thread_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "gearing.hpp"
#include "handpiece_threading_parameters.hpp"
#include "handpiece_threading_ports.hpp"

namespace armature::handpiece::threading {

class Threading final : public Component {
 public:
  explicit Threading(Setup& setup) : Component{setup}, robot_{robot_of(setup)}, ports_{setup} {
    q_ = v_ = JointVector::Zero(robot_.dof());
    msg::JointState room;
    room.position_().resize(1);
    room.velocity_().resize(1);
    ports_.servo_jp.prepare(room);
    setup.activate_every(seconds(1 / Parameters::read(setup.params()).rate));
  }

  void step(Time now) override {
    const msg::JointState* handpiece = ports_.handpiece_js.latest();
    if (!handpiece || handpiece->position_().empty()) return;
    const double angle = handpiece->position_().front();
    if (!std::isfinite(angle)) return degraded("the angle of the handpiece is no number");
    follow_thread(angle);
    if (!ports_.measured_js.latest()) return;
    ReasonText wrong = read_joints(robot_, *ports_.measured_js.latest(), q_);
    if (wrong.empty()) wrong = read_joint_rates(robot_, *ports_.measured_js.latest(), v_);
    if (wrong.empty() && defect_) wrong = defect_;
    if (!wrong.empty()) return degraded(wrong.view());
    healthy();
    const PoseAndJacobian tool = forward_kinematics_with_jacobian(robot_, q_, robot_.tool());
    const Eigen::Vector3d velocity = tool.jacobian.topRows<3>() * v_;
    const Turn turn = gearing_.follow(tool.base_T_frame.translation(), velocity);
    auto loan = ports_.servo_jp.loan();
    write_header(loan->header_(), now, "");
    loan->position_().assign(1, turn.angle);
    loan->velocity_().assign(1, turn.velocity);
    loan.publish();
  }

 private:
  /// A thread begins, or ends; before the first the handpiece stays where it was found.
  void follow_thread(double angle) {
    if (!found_) gearing_.stay(angle);
    found_ = true;
    const auto thread = ports_.thread.latest() ? thread_of(*ports_.thread.latest()) : std::nullopt;
    if (thread.has_value() == wanted_) return;
    wanted_ = thread.has_value();
    gearing_.release();
    defect_ = thread ? defect(*thread) : nullptr;
    if (thread && !defect_) gearing_.engage(*thread, angle);
  }

  RobotModel robot_;
  JointVector q_, v_;
  Gearing gearing_;
  bool found_ = false, wanted_ = false;
  const char* defect_ = nullptr;  // of the thread that is wanted
  Ports ports_;
};

}  // namespace armature::handpiece::threading

ARMATURE_PLUGIN(armature::handpiece::threading::Threading);
