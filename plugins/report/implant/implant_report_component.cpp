// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/chain_messages.hpp"
#include "armature/kinds/registration_messages.hpp"
#include "armature/kinds/setup_flange.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"
#include "bore_monitor.hpp"
#include "drill_error.hpp"
#include "smoothness.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

constexpr Duration kPeriod = seconds(0.02);
constexpr double kDegrees = 180 / std::numbers::pi, kMillimetres = 1e3;

double rms(const std::vector<Vector3d>& errors) {
  double sum = 0;
  for (const Vector3d& error : errors) sum += error.squaredNorm();
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

}  // namespace

class ImplantReport final : public Component {
 public:
  explicit ImplantReport(Setup& setup)
      : Component{setup},
        robot_{robot_of(setup)},
        flange_{flange_of(robot_).frame},
        depth_m_{setup.params().number("depth_mm")},
        still_for_{seconds(setup.params().number("still_for_s"))},
        plan_{setup.input<msg::ImplantPlan>("plan")},
        truth_{setup.input<msg::TFMessage>("truth")},
        estimate_{setup.input<msg::TFMessage>("estimate")},
        registration_{setup.input<msg::RegistrationResponse>("registration")},
        measured_js_{setup.input<msg::JointState>("measured_js")},
        task_state_{setup.input<msg::TaskState>("task_state")} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    for (std::size_t i = 0; i < registration_.size(); ++i) {
      if (registration_[i].valid_()) jaw_T_image_ = robot_T_image_of(registration_[i]);
    }
    read_chains();
    for (std::size_t i = 0; i < task_state_.size(); ++i) read(task_state_[i], now);
    for (std::size_t i = 0; i < measured_js_.size(); ++i) read(measured_js_[i]);
    finished_ = ended_at_ && now - *ended_at_ >= still_for_;
  }

  bool finished() const override { return finished_; }

  void summarize(Summary& summary) const override {
    if (state_ == "refused") summary.failed("refused");
    if (state_ == "drilled") tell_drilling(summary);
    summary.metric("final_speed_rad_s", "speed of the fastest joint at the end [rad/s]", speed_);
  }

 private:
  void tell_drilling(Summary& summary) const {
    summary.metric("time_to_drilled_s", "time until all sites are drilled [s]",
                   to_seconds(*ended_at_ - *start_));
    tell_errors(summary);
    tell_smoothness(summary);
  }

  void read_chains() {
    if (!truth_.latest() || !estimate_.latest() || !plan_.latest() || !jaw_T_image_) return;
    const auto truth = chain_of(*truth_.latest()), estimate = chain_of(*estimate_.latest());
    if (!truth) return degraded("truth: " + truth.error().text);
    if (!estimate) return degraded("estimate: " + estimate.error().text);
    true_chain_ = *truth;
    chain_ = *estimate;
    chain_->patient_T_image = *jaw_T_image_;
    if (!bores_.empty()) return;
    for (const msg::Pose& site : plan_.latest()->sites_()) {
      bores_.emplace_back(to_eigen(site), depth_m_);
    }
  }

  void read(const msg::TaskState& state, Time now) {
    state_ = state.state_();
    const bool ended = state_ == "drilled" || state_ == "refused";
    if (ended && !ended_at_) ended_at_ = now;
  }

  void read(const msg::JointState& state) {
    const auto q = robot_.contract(state.position_());
    const auto v = robot_.contract_rates(state.velocity_());
    if (!q || !v) return degraded("measured_js: " + (q ? v : q).error().text);
    healthy();
    speed_ = v->cwiseAbs().maxCoeff();
    if (!chain_) return;
    const PoseAndJacobian flange = forward_kinematics_with_jacobian(robot_, *q, flange_);
    for (BoreMonitor& bore : bores_) bore.see(flange.base_T_frame, *chain_, true_chain_);
    if (state_ != "drilling") return;
    const Eigen::VectorXd twist = flange.jacobian * *v;
    smoothness_.see(stamp_of(state.header_().stamp_()), twist.tail<3>());
  }

  void tell_errors(Summary& summary) const {
    std::string each;
    std::vector<Vector3d> errors, registration, hand_eye, tool, tracker;
    double worst = 0, angle = 0, unexplained = 0, off = 0, tilt = 0;
    for (const BoreMonitor& bore : bores_) {
      if (!bore.error()) return;
      const ErrorBudget budget = error_budget(*chain_, true_chain_, bore.image_T_site());
      errors.push_back(*bore.error());
      registration.push_back(budget.registration);
      hand_eye.push_back(budget.hand_eye);
      tool.push_back(budget.tool);
      tracker.push_back(budget.tracker);
      each += fmt::format("{}{:.3f}", each.empty() ? "" : ", ", 1e3 * errors.back().norm());
      worst = std::max(worst, errors.back().norm());
      angle = std::max(angle, bore.axis_error_rad());
      unexplained = std::max(unexplained, (errors.back() - budget.sum()).norm());
      off = std::max(off, bore.line_deviation_m());
      tilt = std::max(tilt, bore.line_tilt_rad());
    }
    const auto millimetres = [&](const char* key, const char* title, double metres) {
      summary.metric(key, title, kMillimetres * metres);
    };
    summary.text("site_errors_mm", "error of the tip at each site [mm]", each);
    millimetres("site_error_mm", "  at the worst [mm]", worst);
    millimetres("site_error_rms_mm", "  rms over the sites [mm]", rms(errors));
    summary.metric("site_angle_deg", "  angle of the drill at the worst [deg]", kDegrees * angle);
    millimetres("registration_error_mm", "  by the registration, rms [mm]", rms(registration));
    millimetres("hand_eye_error_mm", "  by the hand-eye calibration [mm]", rms(hand_eye));
    millimetres("tool_error_mm", "  by the tool calibration [mm]", rms(tool));
    millimetres("tracker_error_mm", "  by the tracker [mm]", rms(tracker));
    millimetres("unexplained_error_mm", "  not explained, worst [mm]", unexplained);
    millimetres("line_deviation_mm", "farthest off the registered axis inside [mm]", off);
    summary.metric("line_tilt_deg", "most tilted against it [deg]", kDegrees * tilt);
  }

  void tell_smoothness(Summary& summary) const {
    const auto degrees = [&](const char* key, const char* title, double radians) {
      summary.metric(key, title, kDegrees * radians);
    };
    degrees("total_rotation_deg", "total rotation through the sites [deg]",
            smoothness_.total_rad());
    degrees("peak_angular_velocity_deg_s", "peak angular velocity [deg/s]",
            smoothness_.peak_velocity());
    degrees("peak_angular_acceleration_deg_s2", "peak angular acceleration [deg/s2]",
            smoothness_.peak_acceleration());
    summary.metric("acceleration_jump_of_peak", "its largest step as a part of that",
                   smoothness_.acceleration_jump_of_peak());
  }

  RobotModel robot_;
  FrameId flange_;
  double depth_m_;
  Duration still_for_;
  std::optional<Time> start_, ended_at_;
  std::optional<Eigen::Affine3d> jaw_T_image_;
  GuidedChain true_chain_;
  std::optional<GuidedChain> chain_;
  std::vector<BoreMonitor> bores_;
  Smoothness smoothness_;
  std::string state_;
  double speed_ = 0;
  bool finished_ = false;
  Input<msg::ImplantPlan> plan_;
  Input<msg::TFMessage> truth_, estimate_;
  Input<msg::RegistrationResponse> registration_;
  Input<msg::JointState> measured_js_;
  Input<msg::TaskState> task_state_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::ImplantReport);
