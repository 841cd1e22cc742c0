// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "armature/kinds/chain_messages.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/measured_markers.hpp"
#include "armature/kinds/registration_dialogue.hpp"
#include "armature/kinds/registration_messages.hpp"
#include "armature/kinds/setup_flange.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/thread_messages.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/task/task_ports.hpp"
#include "body_input.hpp"
#include "implant.hpp"
#include "plan_messages.hpp"
#include "task_implant_ports.hpp"

namespace armature::task::implant {
namespace {

constexpr Duration kPeriod = seconds(0.02);
constexpr const char* kJawFrame = "jaw";

/// A path's blends reach half-way to the next key pose: what is left of the stand-off is straight.
Parameters parameters_of(const Params& params) {
  const Parameters parameters = Parameters::read(params);
  const double stand_off = parameters.stand_off, depth = parameters.depth;
  if (stand_off < 2 * depth) {
    params.refuse({"stand_off_mm", "depth_mm"},
                  fmt::format("'stand_off_mm' is {:g}, but the drill goes straight only along the "
                              "last half of it, and the bone is 'depth_mm' = {:g} deep there; make "
                              "it at least {:g}",
                              1e3 * stand_off, 1e3 * depth, 2e3 * depth));
  }
  return parameters;
}

RegisteredJaw jaw_of(const msg::RegistrationResponse& response) {
  RegisteredJaw jaw{
      .jaw_T_image = robot_T_image_of(response), .fiducial_error_m = response.fre_(), .sites = {}};
  for (const msg::RegisteredTarget& target : response.targets_()) {
    jaw.sites.push_back({.error_rms_m = target.error_rms_(), .error_95_m = target.error_95_()});
  }
  return jaw;
}

/// [m] over the sites.
double rms_of(const std::vector<ErrorForecast>& sites, double (*error_of)(const ErrorForecast&)) {
  double sum = 0;
  for (const ErrorForecast& site : sites) sum += std::pow(error_of(site), 2);
  return std::sqrt(sum / static_cast<double>(sites.size()));
}

}  // namespace

class ImplantComponent final : public Component {
 public:
  explicit ImplantComponent(Setup& setup)
      : Component{setup},
        parameters_{parameters_of(setup.params())},
        robot_{robot_of(setup)},
        mount_{flange_of(robot_)},
        task_{parameters_, robot_, mount_.flange_T_tool},
        ports_{setup},
        flange_{ports_.flange, parameters_.flange_body, parameters_.max_fit_error},
        jaw_{ports_.jaw, parameters_.jaw_body, parameters_.max_fit_error},
        pivot_{ports_.pivot, parameters_.pivot_body, parameters_.max_fit_error},
        registration_{ports_.request, ports_.registration, parameters_.marker_error,
                      parameters_.match_tolerance},
        task_ports_{ports_.operator_, ports_.state} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!begun_) task_.begin(now);
    begun_ = true;
    const auto obey = [&](const auto& command) { return task_.hear(command, now); };
    for (const std::string& line : task_ports_.hear(now, task_.procedure(), obey)) log(line);
    read_arm();
    const msg::JointState* handpiece = ports_.handpiece_js.latest();
    if (handpiece && !handpiece->position_().empty()) {
      task_.see_handpiece(handpiece->position_().front(), stamp_of(handpiece->header_().stamp_()));
    }
    read(now);
    task_.update(now);
    if (ports_.markers.latest() && task_.wants_registration() && registration_.due(now)) ask(now);
    send(task_.outgoing_goal(now), now, ports_.goal);
    for (const std::string& line : task_.take_news()) log(line);
    publish_estimate(now);
    publish_thread(now);
    publish_state(now);
  }

  void summarize(Summary& summary) const override {
    const auto& sites = task_.guidance().forecasts();
    if (sites.empty()) return;
    const auto metric = [&](const char* key, const char* title, auto error_of) {
      summary.metric(key, title, 1e3 * rms_of(sites, error_of));
    };
    using Site = const ErrorForecast&;
    metric("expected_registration_error_mm", "expected of the registration, rms [mm]",
           [](Site site) { return site.registration.rms_m; });
    metric("expected_hand_eye_error_mm", "expected of the hand-eye calibration [mm]",
           [](Site site) { return site.hand_eye.rms_m; });
    metric("expected_tool_error_mm", "expected of the tool calibration [mm]",
           [](Site site) { return site.tool.rms_m; });
    metric("expected_tracker_error_mm", "expected of the tracker [mm]",
           [](Site site) { return site.tracker.rms_m; });
    metric("expected_error_rms_mm", "expected in all [mm]", [](Site site) { return site.rms_m(); });
  }

 private:
  void read_arm() {
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) {
      const auto q = joints_of(robot_, ports_.measured_js[i]);
      if (!q) return degraded("measured_js: " + q.error().text);
      healthy();
      task_.see_arm(forward_kinematics(robot_, *q, mount_.frame));
    }
  }

  void read(Time now) {
    read_plan();
    for (std::size_t i = 0; i < ports_.motion_status.size(); ++i) {
      task_.hear(report_of(ports_.motion_status[i]), now);
    }
    for (std::size_t i = 0; i < pivot_.size(); ++i) {
      task_.see_drill_in_hand(pivot_[i]);
      task_.see_driver_in_hand(pivot_.as(i, parameters_.driver_body));
    }
    for (std::size_t i = 0; i < flange_.size(); ++i) task_.see_flange(flange_[i], now);
    for (std::size_t i = 0; i < jaw_.size(); ++i) task_.see_jaw(jaw_[i]);
    registration_.listen([&](const msg::RegistrationResponse& response) {
      if (response.valid_()) {
        task_.see_registration(jaw_of(response), now);
      } else {
        task_.see_refused_registration(response.reason_());
      }
    });
  }

  /// Markers and sites that belong together are those of one plan.
  void read_plan() {
    if (!ports_.plan.latest()) return;
    if (!begun_with_) {
      begun_with_ = *ports_.plan.latest();
      if (const auto wrong = not_in_frame(begun_with_->header_(), kImageFrame, "the plan is")) {
        task_.see_refused_plan(*wrong);
      } else {
        task_.see_plan(sites_of(*begun_with_), implants_of(*begun_with_));
      }
    }
    if (told_other_plan_ || !is_other(*ports_.plan.latest(), *begun_with_)) return;
    told_other_plan_ = true;
    log("another plan has come; this procedure goes on with the one that it began with");
  }

  void ask(Time now) {
    const msg::MeasuredMarkers& markers = *ports_.markers.latest();
    if (const auto wrong = wrong_with(markers, kJawFrame)) {
      return task_.see_refused_registration(*wrong);
    }
    std::vector<msg::Point> sites;
    for (const msg::Pose& site : begun_with_->sites_()) sites.push_back(site.position_());
    registration_.ask({.robot_frame = markers.header_().frame_id_(),
                       .image_markers = begun_with_->markers_(),
                       .robot_markers = markers.points_(),
                       .targets = sites,
                       .marker_error = markers.error_()},
                      now);
  }

  void publish_estimate(Time now) {
    const bool known = !task_.guidance().forecasts().empty();
    if (std::exchange(published_, known) || !known) return;
    msg::TFMessage estimate;
    write_chain(task_.guidance().chain(), now, estimate);
    if (const auto driver = task_.guidance().driver_chain())
      write_tool(*driver, kDriver, now, estimate);
    ports_.estimate.publish(estimate);
  }

  void publish_thread(Time now) {
    const bool engaged = task_.thread().has_value();
    if (std::exchange(engaged_, engaged) == engaged) return;
    msg::ThreadAxis message;
    write_header(message.header_(), now, kBaseFrame);
    write_thread(task_.thread(), message);
    ports_.thread.publish(message);
  }

  void publish_state(Time now) {
    const bool calibrating = task_.phase() == Implant::Phase::calibrating;
    const CalibrationRun& calibration = task_.guidance().calibration();
    const TaskReport report{
        .state = to_string(task_.phase()),
        .step = calibrating ? static_cast<std::size_t>(calibration.number()) : 0,
        .steps = calibrating ? static_cast<std::size_t>(calibration.count()) : 0,
        .detail = task_.trouble()};
    const auto said = task_ports_.publish(now, report, report.line(), task_.procedure());
    if (said) log(*said);
  }

  Parameters parameters_;
  RobotModel robot_;
  Flange mount_;
  Implant task_;
  bool begun_ = false, published_ = false, engaged_ = false;
  Ports ports_;
  BodyInput flange_, jaw_, pivot_;
  std::optional<msg::ImplantPlan> begun_with_;
  bool told_other_plan_ = false;
  RegistrationDialogue registration_;
  TaskPorts task_ports_;
};

}  // namespace armature::task::implant

ARMATURE_PLUGIN(armature::task::implant::ImplantComponent);
