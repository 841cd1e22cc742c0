// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/target/target_messages.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/frame_buffer.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/guarded.hpp"
#include "host_target_parameters.hpp"
#include "host_target_ports.hpp"
#include "view_agreement.hpp"

namespace armature::host::target {
namespace {

/// The samples of the arm that its history holds.
std::size_t samples_of(const Parameters& parameters) {
  return static_cast<std::size_t>(parameters.history * parameters.arm_rate) + 1;
}

}  // namespace

/// Face poses of a moving camera in, the filtered target in the base frame out. Cameras that have a
/// face elsewhere from near than from afar are told in the state.
class TargetHost final : public Component {
 public:
  explicit TargetHost(Setup& setup);
  void step(Time now) override;

 private:
  void remember(const msg::JointState& arm);
  void tell_trouble();
  Expected<Eigen::Isometry3d> base_T_mount(Time stamp);
  Expected<TargetMeasurement> measurement(const msg::FacePose& face);
  Expected<TargetEstimate> updated(const msg::FacePose& face);
  void publish(Time stamp, const Expected<TargetEstimate>& estimate);

  RobotModel robot_;
  StereoRig rig_;
  FrameId mount_;
  FrameBuffer history_;
  Slot<TargetFilter> filter_;
  PluginState state_;
  ViewAgreement views_;
  std::string arm_trouble_, history_trouble_;
  Ports ports_;
};

TargetHost::TargetHost(Setup& setup)
    : Component{setup},
      robot_{robot_of(setup)},
      rig_{rig_of(setup)},
      mount_{mount_of(rig_, robot_)},
      history_{robot_, samples_of(Parameters::read(setup.params()))},
      filter_{setup.slot<TargetFilter>("target")},
      views_{rig_.camera.baseline_m},
      ports_{setup} {}

void TargetHost::step(Time) {
  for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) remember(ports_.measured_js[i]);
  for (std::size_t i = 0; i < ports_.face.size(); ++i) {
    publish(stamp_of(ports_.face[i].header_().stamp_()), updated(ports_.face[i]));
  }
  tell_trouble();
}

void TargetHost::remember(const msg::JointState& arm) {
  const auto q = joints_of(robot_, arm);
  arm_trouble_ = q ? "" : "measured_js: " + q.error().text;
  if (!q) return;
  if (history_.empty()) history_trouble_.clear();
  history_.add(stamp_of(arm.header_().stamp_()), *q);
}

void TargetHost::tell_trouble() {
  const std::string& arm_or_history = arm_trouble_.empty() ? history_trouble_ : arm_trouble_;
  const std::string& trouble = arm_or_history.empty() ? views_.warning() : arm_or_history;
  if (trouble.empty()) return healthy();
  degraded(trouble);
}

/// Where the cameras hung when a picture was taken. While the history does not reach there, its
/// first refusal is the component's trouble: the numbers of the next ones only differ.
Expected<Eigen::Isometry3d> TargetHost::base_T_mount(Time stamp) {
  auto pose = history_.base_T(mount_, stamp);
  if (pose) {
    history_trouble_.clear();
  } else if (history_trouble_.empty()) {
    history_trouble_ = pose.error().text;
  }
  return pose;
}

Expected<TargetMeasurement> TargetHost::measurement(const msg::FacePose& face) {
  if (!face.valid_()) return refuse(face.reason_());
  const Time stamp = stamp_of(face.header_().stamp_());
  return base_T_mount(stamp).map([&](const Eigen::Isometry3d& pose) {
    const Eigen::Isometry3d base_T_camera = pose * rig_.mount_T_left;
    const Eigen::Matrix3d turn = base_T_camera.linear();
    const auto turned = [&](const std::array<double, 9>& covariance) -> Eigen::Matrix3d {
      return turn * to_eigen(covariance) * turn.transpose();
    };
    const TargetMeasurement seen{.stamp = stamp,
                                 .position = base_T_camera * to_eigen(face.mouth_()),
                                 .normal = turn * to_eigen(face.normal_()),
                                 .position_covariance = turned(face.mouth_covariance_()),
                                 .normal_covariance = turned(face.normal_covariance_())};
    views_.add(base_T_camera, seen);
    return seen;
  });
}

/// The new estimate. Without a good measurement the filter predicts over the gap, for as long as it
/// trusts itself; then what is missing is told.
Expected<TargetEstimate> TargetHost::updated(const msg::FacePose& face) {
  auto estimate = measurement(face).and_then([&](const TargetMeasurement& m) {
    return guarded(state_, [&](PluginState& state) { return filter_->update(m, state); });
  });
  if (estimate) return estimate;
  auto predicted =
      guarded([&] { return filter_->predict(stamp_of(face.header_().stamp_()), state_); });
  return predicted ? predicted : estimate;
}

void TargetHost::publish(Time stamp, const Expected<TargetEstimate>& estimate) {
  auto target = ports_.target.loan();
  if (estimate) {
    write_estimate(*estimate, *target);
  } else {
    write_no_estimate(stamp, estimate.error(), *target);
  }
  target.publish();
}

}  // namespace armature::host::target

ARMATURE_PLUGIN(armature::host::target::TargetHost);
