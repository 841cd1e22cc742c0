// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/kinematics/held_arm.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "hand_motion.hpp"
#include "sim_surgeon_ports.hpp"

namespace armature::sim::surgeon {
namespace {

constexpr Duration kPeriod = seconds(0.001);
constexpr double kComesToRestIn_s = 0.3;
constexpr std::size_t kMostPoses = 5000;  // of a path, which is made on the control thread
constexpr const char* kLeaderFrame = "leader_base";

Parameters parameters_of(const Params& params) {
  const Parameters parameters = Parameters::read(params);
  const std::size_t count = parameters.incision.size();
  if (count != 0 && count != 3) {
    params.refuse({"incision_mm"},
                  fmt::format("'incision_mm' has {} numbers; a point has 3, x, y and z", count));
  }
  return parameters;
}

std::optional<PosePath> path_of(const Parameters& parameters, const Params& params) {
  if (parameters.path.empty()) return std::nullopt;
  auto path = load_pose_path(parameters.path);
  if (!path) params.refuse({"path"}, path.error().text);
  return std::move(*path);
}

}  // namespace

class Surgeon final : public Component {
 public:
  explicit Surgeon(Setup& setup)
      : Component{setup},
        robot_{robot_of(setup)},
        parameters_{parameters_of(setup.params())},
        seed_{setup.seed()},
        hand_{parameters_, seed_, path_of(parameters_, setup.params())},
        ports_{setup} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!console_told_) tell_console(now);
    if (ports_.path.fresh()) take_path(*ports_.path.latest());
    if (is_told("waiting") || is_told("aligning")) taken_at_.reset();
    if (!taken_at_) take_hold(now);
    if (!taken_at_) return;
    const double t = to_seconds(now - *taken_at_);
    silent_ = parameters_.silent_after > 0 && t >= parameters_.silent_after;
    if (silent_) return;
    pause(now);
    const double hand_t = t - paused_s_;
    move(hand_t, now);
    auto clutch = ports_.clutch.loan();
    // The clutch goes with the hand's way; what is held waits for it to open while the hand rests.
    clutch->data_(hand_.clutch_closed(is_told("held") ? t : hand_t));
    clutch.publish();
    auto intended = ports_.intended_cp.loan();
    write_header(intended->header_(), now, kBaseFrame);
    assign(intended->pose_(), hand_.intended(hand_t, start_));
    intended.publish();
  }

  void begin_stop(Time) override { stopping_ = true; }
  bool stopped() const override { return !taken_at_ || silent_ || pace_ == 0; }

 private:
  bool is_told(std::string_view state) const {
    return ports_.task_state.latest() && ports_.task_state.latest()->state_() == state;
  }

  /// Nobody goes on moving a leader while the console is held, tells trouble, or stops.
  void pause(Time now) {
    const msg::TaskState* task = ports_.task_state.latest();
    const bool held = is_told("held") || (task && !task->detail_().empty());
    const double passed_s = to_seconds(now - moved_at_);
    const double change = passed_s / kComesToRestIn_s;
    pace_ = std::clamp(held || stopping_ ? pace_ - change : pace_ + change, 0.0, 1.0);
    paused_s_ += (1 - pace_) * passed_s;
  }

  void tell_console(Time now) {
    console_told_ = true;
    auto loan = ports_.console.loan();
    write_header(loan->header_(), now, kBaseFrame);
    loan->child_frame_id_(kLeaderFrame);
    assign(loan->transform_(), pose_of(parameters_.console, parameters_.console_rpy));
    loan.publish();
    if (!parameters_.incision.empty()) tell_incision(now);
  }

  void tell_incision(Time now) {
    auto loan = ports_.incision.loan();
    write_header(loan->header_(), now, kBaseFrame);
    assign(loan->point_(), Eigen::Vector3d{parameters_.incision.data()});
    loan.publish();
  }

  void take_path(const msg::PoseArray& poses) {
    const auto path = path_from(poses);
    if (path) {
      hand_ = HandMotion{parameters_, seed_, *path};
      log("the hand follows the path of the topic");
    } else {
      log(path.error().text + "; the hand goes its way");
    }
  }

  Expected<PosePath> path_from(const msg::PoseArray& poses) const {
    constexpr std::string_view kName = "the path of the topic";
    if (auto wrong = not_in_frame(poses.header_(), kBaseFrame, "the path of the topic is")) {
      return refuse(*wrong);
    }
    if (taken_at_) return refuse(fmt::format("{} came when the leader was taken", kName));
    if (poses.poses_().size() > kMostPoses) {
      return refuse(fmt::format("{} has {} poses, and {} at most are taken", kName,
                                poses.poses_().size(), kMostPoses));
    }
    return pose_path_through(poses, parameters_.path_speed, kName);
  }

  void take_hold(Time now) {
    if (!is_told("aligned") || !ports_.measured_js.latest()) return;
    const auto q = joints_of(robot_, *ports_.measured_js.latest());
    if (!q) return degraded("measured_js: " + q.error().text);
    q_ = *q;
    start_ = forward_kinematics(robot_, q_);
    taken_at_ = moved_at_ = now;
    pace_ = 1;
    paused_s_ = 0;
  }

  /// A hand that the leader cannot follow stays where the leader is.
  void move(double t, Time now) {
    const Eigen::Isometry3d pose = hand_.actual(t, start_);
    const auto q =
        joints_of_held_arm(robot_, {pose.translation(), Eigen::Quaterniond{pose.linear()}}, q_,
                           JointVector::Ones(robot_.dof()));
    if (q) {
      healthy();
    } else {
      degraded("the hand stops: " + q.error().text);
    }
    const JointVector next = q.value_or(q_);
    const double dt = to_seconds(now - moved_at_);
    auto loan = ports_.hand_js.loan();
    write_all_joints(robot_, next, JointVector{(next - q_) / (dt > 0 ? dt : 1)}, now, *loan);
    loan.publish();
    q_ = next;
    moved_at_ = now;
  }

  RobotModel robot_;
  Parameters parameters_;
  std::uint64_t seed_;
  HandMotion hand_;
  bool console_told_ = false;
  std::optional<Time> taken_at_;
  Time moved_at_;
  bool stopping_ = false, silent_ = false;
  double pace_ = 1, paused_s_ = 0;                           // of the hand's own time
  Eigen::Isometry3d start_ = Eigen::Isometry3d::Identity();  // leader_T_hand when it took hold
  JointVector q_;
  Ports ports_;
};

}  // namespace armature::sim::surgeon

ARMATURE_PLUGIN(armature::sim::surgeon::Surgeon);
