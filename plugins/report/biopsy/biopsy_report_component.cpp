// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/pose_messages.hpp"
#include "armature/kinds/registered_plan.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/geometry/point_error.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/angles.hpp"
#include "insertion_monitor.hpp"
#include "report_biopsy_ports.hpp"

namespace armature::report::biopsy {
namespace {

constexpr Duration kPeriod = seconds(0.02);
constexpr double kMoves_m = 1e-4;              // more than the noise of a tip that rests
constexpr Duration kRested = seconds(0.1);     // since the last motion
constexpr Duration kLongestRamp = seconds(3);  // an arm in a hand need not rest

}  // namespace

class BiopsyReport final : public Component {
 public:
  explicit BiopsyReport(Setup& setup)
      : Component{setup},
        robot_{robot_of(setup)},
        needle_axis_{robot_.pointing_axis().value_or(Eigen::Vector3d::UnitZ())},
        ports_{setup},
        plan_{ports_.plan, ports_.request, ports_.registration} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    plan_.read();
    if (plan_.any_registration()) read(*plan_.any_registration());
    see_vessels();
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) read(ports_.measured_js[i], now);
    for (std::size_t i = 0; i < ports_.task_state.size(); ++i) read(ports_.task_state[i], now);
    // What the tip does after its task was cut off counts: the arm ramps down.
    const bool rests = !moved_at_ || now - *moved_at_ >= kRested;
    finished_ = ended_at_ && (rests || now - *ended_at_ >= kLongestRamp);
  }

  bool finished() const override { return finished_; }

  void summarize(Summary& summary) const override {
    if (ended_as_ == "refused") summary.failed("refused", trouble_);
    if (ended_as_ == "aborted") summary.failed("aborted", "by the operator");
    const auto metric = [&](const char* key, const char* title, std::optional<double> value,
                            double unit = 1) {
      if (value) summary.metric(key, title, *value * unit);
    };
    metric("time_to_target_s", "time to the target [s]", time_to_target_s_);
    metric("touch_error_mm", "touches off their markers, rms [mm]", touch_error_m(), 1e3);
    const auto error = target_error_m();
    metric("target_error_mm", "error of the tip at the true target [mm]", error, 1e3);
    if (const auto& needle = monitor_.needle()) {
      metric("predicted_target_error_rms_mm", "its expected rms [mm]", needle->error_rms_m, 1e3);
      metric("predicted_target_error_95_mm", "95 of 100 are below [mm]", needle->error_95_m, 1e3);
      if (error) tell_parts(summary, *error, *needle);
      metric("fiducial_error_mm", "the markers' fit, rms [mm]", needle->fiducial_error_m, 1e3);
    }
    metric("line_deviation_mm", "farthest off the line inside [mm]", monitor_.line_deviation_m(),
           1e3);
    metric("line_tilt_deg", "most tilted against it [deg]", monitor_.line_tilt_rad(),
           kDegreesPerRad);
    metric("other_joints_deg", "most that a turning joint moved inside [deg]",
           monitor_.turned_rad(), kDegreesPerRad);
    metric("true_vessel_distance_mm", "its axis nearest to a vessel in truth [mm]",
           monitor_.vessel_distance_m(), 1e3);
  }

 private:
  /// A bound of rounding errors makes no ratio.
  static void tell_parts(Summary& summary, double error_m, const RegisteredNeedle& needle) {
    constexpr double kMinBound_m = 1e-6;
    const auto part = [&](const char* key, const char* title, double bound_m) {
      if (needle.error_95_m >= kMinBound_m) return summary.metric(key, title, error_m / bound_m);
      summary.not_measured(key, title,
                           fmt::format("the registration expects an error of {:.1g} mm, which is "
                                       "none",
                                       1e3 * needle.error_95_m));
    };
    part("target_error_of_bound", "error as a part of that", needle.error_95_m);
    part("target_error_of_bound_999", "error as a part of what 999 of 1000 are below",
         radius_of_999_in_1000(needle.error_rms_m, needle.error_95_m));
  }

  /// How the image lies in truth; none while nobody has said it.
  std::optional<Eigen::Isometry3d> truth() const {
    if (!ports_.truth.latest()) return {};
    const auto robot_T_image = pose_of(ports_.truth.latest()->transform_(), "the truth's");
    return robot_T_image ? std::optional{*robot_T_image} : std::nullopt;
  }

  void see_vessels() {
    const auto robot_T_image = truth();
    if (!plan_.plan() || !robot_T_image) return;
    std::vector<ForbiddenZone> vessels = zones_of(plan_.plan()->forbidden_());
    for (ForbiddenZone& vessel : vessels) {
      vessel.from = *robot_T_image * vessel.from;
      vessel.to = *robot_T_image * vessel.to;
    }
    monitor_.see_vessels(std::move(vessels));
  }

  /// None until the task said that the needle is there.
  std::optional<double> target_error_m() const {
    const auto robot_T_image = truth();
    if (!tip_at_target_ || !plan_.plan() || !robot_T_image) return {};
    return (*tip_at_target_ - *robot_T_image * to_eigen(plan_.plan()->target_())).norm();
  }

  /// Rms distance of the touched places to the true markers that they are nearest to; none when
  /// nothing was touched.
  std::optional<double> touch_error_m() const {
    if (!ports_.touched.latest() || ports_.touched.latest()->points_().empty()) return {};
    const auto robot_T_image = truth();
    if (!plan_.plan() || !robot_T_image) return {};
    double squares = 0;
    for (const msg::Point& place : ports_.touched.latest()->points_()) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const msg::Point& marker : plan_.plan()->markers_()) {
        const Eigen::Vector3d off = to_eigen(place) - *robot_T_image * to_eigen(marker);
        nearest = std::min(nearest, off.squaredNorm());
      }
      squares += nearest;
    }
    return std::sqrt(squares / static_cast<double>(ports_.touched.latest()->points_().size()));
  }

  void read(const msg::RegistrationResponse& response) {
    if (response.targets_().size() < 2) return;
    const msg::RegisteredTarget& target = response.targets_()[0];
    monitor_.see_registration({.entry = to_eigen(response.targets_()[1].position_()),
                               .target = to_eigen(target.position_()),
                               .error_rms_m = target.error_rms_(),
                               .error_95_m = target.error_95_(),
                               .fiducial_error_m = response.fre_()});
  }

  void read(const msg::JointState& state, Time now) {
    const auto q = joints_of(robot_, state);
    if (!q) return degraded("measured_js: " + q.error().text);
    healthy();
    const Eigen::Isometry3d base_T_tool = forward_kinematics(robot_, *q);
    if (!rested_at_ || (base_T_tool.translation() - *rested_at_).norm() > kMoves_m) {
      if (rested_at_) moved_at_ = now;
      rested_at_ = base_T_tool.translation();
    }
    monitor_.see_tip(base_T_tool.translation(), base_T_tool.linear() * needle_axis_, turning(*q));
  }

  JointVector turning(const JointVector& q) const {
    JointVector values(robot_.dof());
    Eigen::Index count = 0;
    for (int i = 0; i < robot_.dof(); ++i) {
      const auto joint = static_cast<std::size_t>(robot_.independent_joint(i));
      if (robot_.joints()[joint].type == Joint::Type::revolute) values[count++] = q[i];
    }
    return values.head(count);
  }

  void read(const msg::TaskState& state, Time now) {
    for (const char* end : {"withdrawn", "aborted", "refused"}) {
      if (state.state_() == end) ended_as_ = end;
    }
    if (!ended_as_.empty() && !ended_at_) ended_at_ = now;
    trouble_ = state.detail_();
    if (state.state_() != "at target") return;
    tip_at_target_ = monitor_.tip();
    if (!time_to_target_s_) time_to_target_s_ = to_seconds(now - *start_);
  }

  RobotModel robot_;
  Eigen::Vector3d needle_axis_;
  InsertionMonitor monitor_;
  std::optional<Time> start_;
  std::optional<Eigen::Vector3d> tip_at_target_;
  std::optional<Eigen::Vector3d> rested_at_;  // the tip, when it moved last
  std::optional<Time> moved_at_, ended_at_;   // the tip, the task
  bool finished_ = false;
  std::optional<double> time_to_target_s_;
  std::string trouble_, ended_as_;
  Ports ports_;
  RegisteredPlan<msg::NeedlePlan> plan_;
};

}  // namespace armature::report::biopsy

ARMATURE_PLUGIN(armature::report::biopsy::BiopsyReport);
