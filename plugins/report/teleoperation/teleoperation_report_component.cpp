// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "alignment_monitor.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/pose_in_base.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/angles.hpp"
#include "follow_monitor.hpp"
#include "report_teleoperation_ports.hpp"

namespace armature::report::teleoperation {
namespace {

constexpr Duration kPeriod = seconds(0.02);

Parameters parameters_of(const Params& params, const RobotModel& robot) {
  const Parameters parameters = Parameters::read(params);
  const std::vector<double>& speeds = parameters.peak_speeds;
  if (speeds.empty()) return parameters;
  if (static_cast<int>(speeds.size()) != robot.dof()) {
    params.refuse({"peak_speeds"}, fmt::format("'peak_speeds' has {} numbers; robot {} has {} "
                                               "joints",
                                               speeds.size(), robot.name(), robot.dof()));
  }
  const auto zero = std::ranges::find(speeds, 0.0);
  if (zero != speeds.end()) {
    params.refuse({"peak_speeds"},
                  fmt::format("'peak_speeds' item {} is 0, of which nothing can be a part; it "
                              "must be more",
                              zero - speeds.begin() + 1));
  }
  return parameters;
}

}  // namespace

class TeleoperationReport final : public Component {
 public:
  explicit TeleoperationReport(Setup& setup)
      : Component{setup},
        leader_{robot_of(setup)},
        parameters_{parameters_of(setup.params(), leader_)},
        follow_{parameters_},
        ports_{setup} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    complaint_.clear();
    for (std::size_t i = 0; i < ports_.task_state.size(); ++i) read(ports_.task_state[i]);
    if (ports_.console.latest()) read(*ports_.console.latest());
    for (std::size_t i = 0; i < ports_.leader_js.size(); ++i) read_rates(ports_.leader_js[i]);
    for (std::size_t i = 0; i < ports_.leader_cp.size(); ++i) read_leader(ports_.leader_cp[i]);
    for (std::size_t i = 0; i < ports_.follower_cp.size(); ++i) {
      read_follower(ports_.follower_cp[i]);
    }
    for (std::size_t i = 0; i < ports_.intended_cp.size(); ++i) {
      read_intended(ports_.intended_cp[i]);
    }
    show_health();
    const bool watched = closed_at_ && now - *closed_at_ >= seconds(parameters_.watch);
    held_ = held_since_ && (watched || now - *held_since_ >= seconds(parameters_.held_for));
    finished_ = refused_ || aborted_ || held_ || watched;
  }

  bool finished() const override { return finished_; }

  void summarize(Summary& summary) const override {
    if (refused_) summary.failed("refused", trouble_);
    if (aborted_) summary.failed("aborted", "by the operator");
    if (held_) summary.failed("held", trouble_);
    const auto metric = [&](const char* key, const char* title, std::optional<double> value,
                            double unit = 1) {
      if (value) summary.metric(key, title, *value * unit);
    };
    if (first_aligned_at_) {
      metric("time_to_align_s", "time to align [s]", to_seconds(*first_aligned_at_ - *start_));
      if (const auto off = worst_alignment()) {
        metric("alignment_error_mm", "leader off the instrument [mm]", off->position_m, 1e3);
        metric("alignment_error_deg", "its rotation [deg]", off->angle_rad, kDegreesPerRad);
      }
      metric("peak_speed_error_percent", "peak joint speeds off the reference [%]",
             alignment_.peak_speed_error(parameters_.peak_speeds), 100);
    }
    if (const auto following = follow_.following()) {
      metric("tracking_error_mm", "follower off the hand, later, rms [mm]", following->rms_m, 1e3);
      metric("tracking_worst_mm", "the largest [mm]", following->worst_m, 1e3);
      tell_lag(summary, following->lag_s);
    }
    if (has_closed_) tell_tremor(summary);
    metric("tip_speed_mm_s", "top speed of the follower's tip [mm/s]", follow_.top_speed_m_s(),
           1e3);
    metric("stopping_mm", "stops after the clutch opens within [mm]", follow_.stopping_m(), 1e3);
    metric("clutch_motion_mm", "moves with the clutch open [mm]", follow_.open_motion_m(), 1e3);
    metric("closing_step_mm", "longest step when it closes [mm]", follow_.closing_step_m(), 1e3);
  }

 private:
  /// Of a hand that does not tremble, what the follower has of it would be a ratio of noise.
  void tell_tremor(Summary& summary) const {
    constexpr const char *kHand = "hand_tremor_mm", *kHandTitle = "tremor of the hand, rms [mm]";
    constexpr const char *kTip = "follower_tremor_mm",
                         *kTipTitle = "tremor of the follower's tip, rms [mm]";
    constexpr const char *kLeft = "tremor_db", *kLeftTitle = "what is left of it, scaled [dB]";
    constexpr double kStands_db = -100;  // nothing that moves is as quiet
    const auto tremor = follow_.tremor();
    if (!tremor) {
      for (const auto& [key, title] : {std::pair{kHand, kHandTitle}, std::pair{kTip, kTipTitle},
                                       std::pair{kLeft, kLeftTitle}}) {
        summary.not_measured(key, title, tremor.error().text);
      }
      return;
    }
    summary.metric(kHand, kHandTitle, 1e3 * tremor->hand_m);
    summary.metric(kTip, kTipTitle, 1e3 * tremor->follower_m);
    if (tremor->hand_m < parameters_.min_tremor) {
      return summary.does_not_apply(
          kLeft, kLeftTitle,
          fmt::format("the hand trembles by {:.2g} mm only, 'min_tremor_mm' is {:g}",
                      1e3 * tremor->hand_m, 1e3 * parameters_.min_tremor));
    }
    if (tremor->left_db > kStands_db) {
      return summary.metric(kLeft, kLeftTitle, tremor->left_db);
    }
    summary.not_measured(kLeft, kLeftTitle, "the follower stood still");
  }

  static void tell_lag(Summary& summary, const Expected<double>& lag_s) {
    constexpr const char *kKey = "measured_lag_ms", *kTitle = "best lag [ms]";
    if (lag_s) return summary.metric(kKey, kTitle, 1e3 * *lag_s);
    summary.not_measured(kKey, kTitle, lag_s.error().text);
  }

  void complain(const std::string& what) { complaint_ = what; }
  void show_health() {
    if (complaint_.empty()) {
      healthy();
    } else {
      degraded(complaint_);
    }
  }

  double since_start(const msg::Header& header) const {
    return to_seconds(stamp_of(header.stamp_()) - *start_);
  }
  /// Before the task's word the leader moves by itself, afterwards in the hand.
  bool is_aligning(const msg::Header& header) const {
    return !aligned_at_ || stamp_of(header.stamp_()) <= *aligned_at_;
  }

  void read(const msg::TaskState& state) {
    const std::string& phase = state.state_();
    const Time at = stamp_of(state.header_().stamp_());
    const bool closed = phase == "teleoperating";
    follow_.see_clutch(closed, since_start(state.header_()));
    if (aligned_at_ && (phase == "waiting" || phase == "aligning")) align_again();
    if (phase == "aligned" && !aligned_at_) aligned_at_ = at;
    if (!first_aligned_at_) first_aligned_at_ = aligned_at_;
    if (closed && !closed_at_) closed_at_ = at;
    has_closed_ = has_closed_ || closed;
    trouble_ = state.detail_();
    if (trouble_.empty()) held_since_.reset();
    if (!trouble_.empty() && !held_since_) held_since_ = at;
    refused_ = phase == "refused";
    aborted_ = phase == "aborted";
  }

  /// After `back`: what is watched begins anew when the hand closes the clutch the next time.
  void align_again() {
    earlier_alignment_ = worst_alignment();
    aligned_at_.reset();
    closed_at_.reset();
    alignment_error_.reset();
  }
  std::optional<PoseResidual> worst_alignment() const {
    if (!aligned_at_ || !alignment_error_) return earlier_alignment_;
    const PoseResidual earlier = earlier_alignment_.value_or(PoseResidual{});
    return PoseResidual{std::max(earlier.position_m, alignment_error_->position_m),
                        std::max(earlier.angle_rad, alignment_error_->angle_rad)};
  }

  void read(const msg::TransformStamped& console) {
    const auto pose = pose_in_base(console, "the console");
    if (!pose) return complain(pose.error().text);
    follower_T_leader_ = *pose;
  }

  void read_rates(const msg::JointState& state) {
    if (first_aligned_at_ && stamp_of(state.header_().stamp_()) > *first_aligned_at_) return;
    const auto v = joint_rates_of(leader_, state);
    if (!v) return complain("leader_js: " + v.error().text);
    alignment_.see_rates(*v);
  }

  void read_leader(const msg::PoseStamped& message) {
    const auto pose = pose_in_base(message, "the leader");
    if (!pose) return complain(pose.error().text);
    if (is_aligning(message.header_())) alignment_.see_leader(*pose);
    follow_.see_hand({since_start(message.header_()), pose->translation()});
  }

  void read_intended(const msg::PoseStamped& message) {
    const auto pose = pose_in_base(message, "the intended pose");
    if (!pose) return complain(pose.error().text);
    follow_.see_intended({since_start(message.header_()), pose->translation()});
  }

  void read_follower(const msg::PoseStamped& message) {
    const auto pose = pose_in_base(message, "the follower's tool");
    if (!pose) return complain(pose.error().text);
    if (!follower_T_leader_) return;
    if (is_aligning(message.header_())) {
      alignment_error_ = alignment_.error(*follower_T_leader_, *pose);
    }
    const Eigen::Matrix3d leader_R_follower = follower_T_leader_->linear().transpose();
    follow_.see_follower({since_start(message.header_()), leader_R_follower * pose->translation()});
  }

  RobotModel leader_;
  Parameters parameters_;
  AlignmentMonitor alignment_;
  FollowMonitor follow_;
  std::optional<PoseResidual> alignment_error_, earlier_alignment_;  // the worst before `back`
  std::optional<Eigen::Isometry3d> follower_T_leader_;
  std::optional<Time> start_, first_aligned_at_, aligned_at_, closed_at_, held_since_;
  bool has_closed_ = false;  // the hand, the clutch, at any time
  std::string complaint_, trouble_;
  bool refused_ = false, aborted_ = false, held_ = false, finished_ = false;
  Ports ports_;
};

}  // namespace armature::report::teleoperation

ARMATURE_PLUGIN(armature::report::teleoperation::TeleoperationReport);
