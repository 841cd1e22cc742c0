// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "armature/kinds/chain_messages.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/registered_plan.hpp"
#include "armature/kinds/registration_messages.hpp"
#include "armature/kinds/setup_flange.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/thread_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/angles.hpp"
#include "bore_monitor.hpp"
#include "drill_error.hpp"
#include "planned_turn.hpp"
#include "report_implant_ports.hpp"
#include "smoothness.hpp"
#include "thread_monitor.hpp"

namespace armature::report::implant {
namespace {

using Eigen::Vector3d;

constexpr Duration kPeriod = seconds(0.02);
constexpr double kMillimetres = 1e3;

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
        parameters_{Parameters::read(setup.params())},
        robot_{robot_of(setup)},
        flange_{flange_of(robot_)},
        ports_{setup},
        plan_{ports_.plan, ports_.request, ports_.registration} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    read_plan();
    read_chains();
    for (std::size_t i = 0; i < ports_.task_state.size(); ++i) read(ports_.task_state[i], now);
    for (std::size_t i = 0; i < ports_.thread.size(); ++i) {
      threads_.engage(thread_of(ports_.thread[i]));
    }
    handpiece_read_ = 0;
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) read(ports_.measured_js[i]);
    for (std::size_t i = 0; i < ports_.goal.size(); ++i) read(ports_.goal[i]);
    for (std::size_t i = 0; i < ports_.path.size(); ++i) read(ports_.path[i]);
    finished_ = ended_at_ && now - *ended_at_ >= seconds(parameters_.still_for);
  }

  bool finished() const override { return finished_; }

  void summarize(Summary& summary) const override {
    if (state_ == "refused") summary.failed("refused", trouble_);
    if (state_ == "aborted") summary.failed("aborted", "by the operator");
    // Holes that were drilled are there, whatever became of the implants.
    if (drilled_at_ || state_ == "drilled" || state_ == "placed") tell_drilling(summary);
    if (state_ == "placed") tell_placing(summary);
    constexpr const char *kSpeed = "final_speed_rad_s",
                         *kTitle = "speed of the fastest joint at the end [rad/s]";
    if (speed_) return summary.metric(kSpeed, kTitle, *speed_);
    summary.not_measured(kSpeed, kTitle, "no sample of the arm came");
  }

 private:
  void tell_drilling(Summary& summary) const {
    constexpr const char *kTime = "time_to_drilled_s",
                         *kTimeTitle = "time until all sites are drilled [s]";
    if (drilled_at_) {
      summary.metric(kTime, kTimeTitle, to_seconds(*drilled_at_ - *start_));
    } else {
      summary.not_measured(kTime, kTimeTitle, "they were drilled before this report began");
    }
    if (const std::string why = without_errors(bores_, "drill"); !why.empty()) {
      summary.not_measured("site_error_mm", "error of the tip at the worst site [mm]", why);
    } else if (bores_) {
      tell_errors(summary);
    }
    tell_smoothness(summary);
  }

  void tell_placing(Summary& summary) const {
    summary.metric("time_to_placed_s", "time until all implants are placed [s]",
                   to_seconds(*ended_at_ - *start_));
    constexpr const char *kError = "implant_error_mm",
                         *kTitle = "error of the implant's end at the worst site [mm]";
    if (const std::string why = without_errors(implants_, "implant"); !why.empty()) {
      summary.not_measured(kError, kTitle, why);
    } else if (implants_) {
      double worst_m = 0, off_m = 0;
      for (const Bore& bore : implants_->bores()) {
        worst_m = std::max(worst_m, bore.error->norm());
        off_m = std::max(off_m, bore.line_deviation_m);
      }
      summary.metric(kError, kTitle, kMillimetres * worst_m);
      summary.metric("implant_deviation_mm", "  farthest off the registered axis [mm]",
                     kMillimetres * off_m);
    }
    constexpr const char *kThread = "thread_error_mm",
                         *kThreadTitle = "  most ahead of its turns, or behind them [mm]";
    if (const auto& error_m = threads_.max_error_m()) {
      summary.metric(kThread, kThreadTitle, kMillimetres * *error_m);
    } else {
      summary.not_measured(kThread, kThreadTitle,
                           "no handpiece told how far it turned, or not in numbers");
    }
  }

  /// Why the errors at the sites cannot be told, or "".
  std::string without_errors(const std::optional<BoreMonitor>& monitor, const char* tool) const {
    if (!monitor) return "";
    if (const auto both = monitor->one_axis()) {
      return fmt::format("sites {} and {} have one axis, so at which the {} is cannot be told",
                         both->first + 1, both->second + 1, tool);
    }
    const auto& bores = monitor->bores();
    const auto missed = std::ranges::find_if(bores, [](const Bore& bore) { return !bore.error; });
    if (missed == bores.end()) return "";
    const bool as_set = missed->near_m == parameters_.near;
    return fmt::format("the {} was never within {:.4g} mm of the axis of site {}, {}", tool,
                       kMillimetres * missed->near_m, missed - bores.begin() + 1,
                       as_set ? "'near_mm'" : "half of what it is from the next site's");
  }

  void read_plan() {
    plan_.read();
    const msg::ImplantPlan *own = plan_.plan(), *newest = ports_.plan.latest();
    const bool is_other =
        own && newest && plan_.registration() &&
        (newest->sites_() != own->sites_() || newest->implants_() != own->implants_());
    if (!is_other || std::exchange(told_other_plan_, true)) return;
    log("another plan has come; errors are measured against the one that was registered");
  }

  void read_chains() {
    if (!ports_.truth.latest() || !ports_.estimate.latest() || !plan_.registration()) return;
    const Eigen::Affine3d jaw_T_image = robot_T_image_of(*plan_.registration());
    const auto truth = chain_of(*ports_.truth.latest());
    auto estimate = chain_of(*ports_.estimate.latest());
    if (!truth) return degraded("truth: " + truth.error().text);
    if (!estimate) return degraded("estimate: " + estimate.error().text);
    estimate->patient_T_image = jaw_T_image;
    true_chain_ = *truth;
    if (!bores_) bores_.emplace(sites(), *estimate, parameters_);
    bores_->believe(*estimate);
    auto driver = chain_of(*ports_.estimate.latest(), kDriver);
    const auto true_driver = chain_of(*ports_.truth.latest(), kDriver);
    if (!driver || !true_driver) return;
    driver->patient_T_image = jaw_T_image;
    true_driver_ = *true_driver;
    if (!implants_) implants_.emplace(places(), *driver, parameters_);
    implants_->believe(*driver);
  }

  std::vector<Site> sites() const {
    std::vector<Site> sites;
    for (const msg::Pose& site : plan_.plan()->sites_()) sites.push_back({to_eigen(site)});
    return sites;
  }

  /// Of the implants' ends.
  std::vector<Site> places() const {
    std::vector<Site> places = sites();
    const auto& implants = plan_.plan()->implants_();
    places.resize(std::min(places.size(), implants.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
      places[i].image_T_site.translate(Vector3d{0, 0, -implants[i].above_bottom_()});
      places[i].longer_m = implants[i].length_();
    }
    return places;
  }

  /// How far the handpiece had turned at an instant, when it says so.
  std::optional<double> handpiece_at(Time stamp) {
    std::optional<double> angle;
    for (; handpiece_read_ < ports_.handpiece_js.size(); ++handpiece_read_) {
      const msg::JointState& state = ports_.handpiece_js[handpiece_read_];
      if (stamp_of(state.header_().stamp_()) > stamp) break;
      if (!state.position_().empty()) angle = state.position_().front();
    }
    return angle;
  }

  void read(const msg::TaskState& state, Time now) {
    state_ = state.state_();
    trouble_ = state.detail_();
    if (state_ == "changing tool" || state_ == "placing") has_driver_ = true;
    const bool out = state_ == "withdrawing" || state_ == "drilled";
    if (out && !drilled_at_ && !has_driver_) drilled_at_ = now;
    const bool ended =
        state_ == "drilled" || state_ == "placed" || state_ == "aborted" || state_ == "refused";
    if (ended && !ended_at_) ended_at_ = now;
  }

  void read(const msg::MotionGoal& goal) {
    has_goals_ = true;
    if (goal.through_().empty()) return;
    keyed_goal_ = goal.goal_id_();
    keyed_path_seen_ = false;
    keys_.clear();
    for (const msg::ToolPose& key : goal.through_()) {
      keys_.push_back({to_eigen(key.position_()), to_eigen(key.orientation_())});
    }
  }

  /// The path of the newest goal with key poses. Its samples hold the keys in their order.
  void read(const msg::ToolPath& path) {
    const std::size_t count = path.s_().size();
    if (path.goal_id_() != keyed_goal_ || path.orientation_().size() != count ||
        path.position_().size() != count) {
      return;
    }
    constexpr double kSame = 1e-9;  // [m] and [rad]
    std::vector<TurnSample> samples;
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < count; ++i) {
      samples.push_back({path.s_()[i], to_eigen(path.orientation_()[i])});
      if (at.size() == keys_.size()) continue;
      const bool is_next =
          (to_eigen(path.position_()[i]) - keys_[at.size()].position).norm() <= kSame &&
          samples.back().rotation.angularDistance(keys_[at.size()].rotation) <= kSame;
      if (is_next) at.push_back(i);
    }
    const PlannedTurn turn{samples, at};
    keyed_path_seen_ = true;
    planned_turn_ = std::max(planned_turn_, turn.total_rad());
    if (turn.total_rad() < parameters_.min_turn || turn.keys_seen() == 0) return;
    planned_jump_ = std::max(planned_jump_.value_or(0), turn.jump_of_peak());
  }

  void read(const msg::JointState& state) {
    const auto q = joints_of(robot_, state);
    const auto v = joint_rates_of(robot_, state);
    if (!q || !v) return degraded("measured_js: " + (q ? v : q).error().text);
    healthy();
    speed_ = v->cwiseAbs().maxCoeff();
    if (!bores_) return;
    const PoseAndJacobian flange = forward_kinematics_with_jacobian(robot_, *q, flange_.frame);
    if (has_driver_ && implants_) {
      implants_->see(flange.base_T_frame, true_driver_);
      const auto angle = handpiece_at(stamp_of(state.header_().stamp_()));
      if (angle) threads_.see((flange.base_T_frame * flange_.flange_T_tool).translation(), *angle);
    } else {
      bores_->see(flange.base_T_frame, true_chain_);
    }
    if (state_ != "drilling") return;
    const Eigen::VectorXd twist = flange.jacobian * *v;
    smoothness_.see(stamp_of(state.header_().stamp_()), twist.tail<3>());
  }

  void tell_errors(Summary& summary) const {
    std::vector<double> each_mm;
    std::vector<Vector3d> errors, registration, hand_eye, tool, tracker;
    double angle = 0, unexplained = 0, off = 0, tilt = 0;
    for (const Bore& bore : bores_->bores()) {
      const ErrorBudget budget = error_budget(bore.estimate, bore.truth, bore.image_T_site);
      errors.push_back(*bore.error);
      registration.push_back(budget.registration);
      hand_eye.push_back(budget.hand_eye);
      tool.push_back(budget.tool);
      tracker.push_back(budget.tracker);
      each_mm.push_back(kMillimetres * bore.error->norm());
      angle = std::max(angle, bore.axis_error_rad);
      unexplained = std::max(unexplained, (*bore.error - budget.sum()).norm());
      off = std::max(off, bore.line_deviation_m);
      tilt = std::max(tilt, bore.line_tilt_rad);
    }
    const auto millimetres = [&](const char* key, const char* title, double metres) {
      summary.metric(key, title, kMillimetres * metres);
    };
    const double worst_mm = std::ranges::max(each_mm);
    summary.series("site_errors_mm", "error of the tip at each site [mm]", std::move(each_mm));
    summary.metric("site_error_mm", "  at the worst [mm]", worst_mm);
    millimetres("site_error_rms_mm", "  rms over the sites [mm]", rms(errors));
    summary.metric("site_angle_deg", "  angle of the drill at the worst [deg]",
                   kDegreesPerRad * angle);
    millimetres("registration_error_mm", "  by the registration, rms [mm]", rms(registration));
    millimetres("hand_eye_error_mm", "  by the hand-eye calibration [mm]", rms(hand_eye));
    millimetres("tool_error_mm", "  by the tool calibration [mm]", rms(tool));
    millimetres("tracker_error_mm", "  by the tracker [mm]", rms(tracker));
    millimetres("unexplained_error_mm", "  not explained, worst [mm]", unexplained);
    millimetres("line_deviation_mm", "farthest off the registered axis inside [mm]", off);
    summary.metric("line_tilt_deg", "most tilted against it [deg]", kDegreesPerRad * tilt);
  }

  void tell_smoothness(Summary& summary) const {
    tell_planned_turn(summary);
    constexpr const char* kNoSample = "no sample of the arm came while it drilled";
    const auto degrees = [&](const char* key, const char* title, double radians) {
      if (!smoothness_.has_samples()) return summary.not_measured(key, title, kNoSample);
      summary.metric(key, title, kDegreesPerRad * radians);
    };
    degrees("total_rotation_deg", "total rotation through the sites [deg]",
            smoothness_.total_rad());
    degrees("peak_angular_velocity_deg_s", "peak angular velocity [deg/s]",
            smoothness_.peak_velocity());
    degrees("peak_angular_acceleration_deg_s2", "peak angular acceleration [deg/s2]",
            smoothness_.peak_acceleration());
    constexpr const char *kJump = "acceleration_jump_of_peak",
                         *kTitle = "its largest step as a part of that";
    if (smoothness_.total_rad() >= parameters_.min_turn) {
      return summary.metric(kJump, kTitle, smoothness_.acceleration_jump_of_peak());
    }
    if (!smoothness_.has_samples()) {
      return summary.not_measured(kJump, kTitle, kNoSample);
    }
    summary.does_not_apply(
        kJump, kTitle,
        fmt::format("the drill turned by {:.2g} degrees in all, 'min_turn_deg' is {:g}",
                    kDegreesPerRad * smoothness_.total_rad(),
                    kDegreesPerRad * parameters_.min_turn));
  }

  void tell_planned_turn(Summary& summary) const {
    constexpr const char *kKey = "planned_turn_jump",
                         *kTitle = "jump of the planned turn at a key pose, as a part of its peak";
    if (planned_jump_) return summary.metric(kKey, kTitle, *planned_jump_);
    if (has_goals_ && keys_.empty()) {
      return summary.does_not_apply(kKey, kTitle, "no way goes through key poses");
    }
    if (keyed_path_seen_ && planned_turn_ < parameters_.min_turn) {
      return summary.does_not_apply(
          kKey, kTitle,
          fmt::format("the ways through key poses turn by {:.2g} degrees at most, 'min_turn_deg' "
                      "is {:g}",
                      kDegreesPerRad * planned_turn_, kDegreesPerRad * parameters_.min_turn));
    }
    summary.not_measured(kKey, kTitle,
                         keyed_path_seen_ ? "no key pose has three samples on both sides"
                                          : "the path through the last key poses was never seen");
  }

  struct KeyPose {
    Vector3d position;
    Eigen::Quaterniond rotation;
  };

  Parameters parameters_;
  RobotModel robot_;
  Flange flange_;
  std::optional<Time> start_, drilled_at_, ended_at_;
  bool told_other_plan_ = false;
  GuidedChain true_chain_, true_driver_;
  std::optional<BoreMonitor> bores_, implants_;
  bool has_driver_ = false;  // in the drill's place
  ThreadMonitor threads_;
  std::size_t handpiece_read_ = 0;  // of its samples
  Smoothness smoothness_;
  std::uint64_t keyed_goal_ = 0;
  std::vector<KeyPose> keys_;
  bool has_goals_ = false, keyed_path_seen_ = false;
  double planned_turn_ = 0;  // [rad] the greatest of a path with key poses
  std::optional<double> planned_jump_;
  std::string state_, trouble_;
  std::optional<double> speed_;  // [rad/s] of the fastest joint, last
  bool finished_ = false;
  Ports ports_;
  RegisteredPlan<msg::ImplantPlan> plan_;
};

}  // namespace armature::report::implant

ARMATURE_PLUGIN(armature::report::implant::ImplantReport);
