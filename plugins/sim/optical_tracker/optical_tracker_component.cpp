// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "armature/kinds/chain_messages.hpp"
#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/registration/registration.hpp"
#include "armature/kinds/setup_flange.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/frame_buffer.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "line_of_sight.hpp"
#include "operating_room.hpp"
#include "sim_optical_tracker_ports.hpp"
#include "sphere_body.hpp"

namespace armature::sim::optical_tracker {
namespace {

using Eigen::Isometry3d;

constexpr std::size_t kHistory = 512;  // samples of the arm: half a second at 1 kHz
constexpr const char* kTrackerFrame = "tracker";

LineOfSight sight_of(const Parameters& parameters, const std::vector<double>& hidden_s,
                     const Params& params, const char* name) {
  if (const auto wrong = defect(hidden_s)) {
    params.refuse({name}, fmt::format("'{}': {}", name, *wrong));
  }
  return {.min_distance_m = parameters.min_distance,
          .max_distance_m = parameters.max_distance,
          .hidden_s = hidden_s};
}

std::vector<Eigen::Vector3d> spheres_of(const Parameters& parameters, const Params& params) {
  const auto spheres =
      points_of(parameters.spheres, params, "spheres_mm", 3, "at least three spheres");
  constexpr double kNearlyOneLine = 20;  // as of the markers of a registration
  const double condition = condition_of_line(spheres);
  if (condition > kNearlyOneLine) {
    params.refuse({"spheres_mm"},
                  fmt::format("'spheres_mm' lie nearly on one line, about which nobody could see "
                              "the body turn: condition {:.4g}, at most {:g} is allowed",
                              condition, kNearlyOneLine));
  }
  return spheres;
}

}  // namespace

class OpticalTracker final : public Component {
 public:
  explicit OpticalTracker(Setup& setup)
      : Component{setup},
        robot_{robot_of(setup)},
        mount_{flange_of(robot_)},
        parameters_{Parameters::read(setup.params())},
        room_{operating_room(parameters_, setup.params(), mount_.flange_T_tool)},
        history_{robot_, kHistory},
        spheres_{spheres_of(parameters_, setup.params())},
        flange_sight_{
            sight_of(parameters_, parameters_.flange_hidden, setup.params(), "flange_hidden_s")},
        jaw_sight_{sight_of(parameters_, parameters_.jaw_hidden, setup.params(), "jaw_hidden_s")},
        jaw_shift_{vector_of(parameters_.jaw_shift)},
        stand_shift_{vector_of(parameters_.stand_shift)},
        random_{setup.seed()},
        ports_{setup} {
    setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) remember(ports_.measured_js[i]);
    if (!start_) {
      start_ = now;
      tell_plan(now);
      tell_truth(now);
    }
    const Time light = now - seconds(parameters_.latency);
    const double elapsed_s = to_seconds(light - *start_);
    if (elapsed_s < 0) return;  // the shutter had not been open yet
    if (jaw_shift_ != Eigen::Vector3d::Zero() && elapsed_s >= parameters_.jaw_shift_at) {
      shift_jaw(now);
    }
    if (stand_shift_ != Eigen::Vector3d::Zero() && elapsed_s >= parameters_.stand_shift_at) {
      shift_stand(now);
    }
    look(ports_.jaw, "jaw", room_.chain.tracker_T_patient, jaw_sight_, elapsed_s, light);
    const bool driver_follows = !room_.implants.empty();
    if (elapsed_s < parameters_.pivot) {
      look(ports_.pivot, "drill", in_hand(room_.chain.tip, elapsed_s), flange_sight_, elapsed_s,
           light);
    } else if (driver_follows && elapsed_s < 2 * parameters_.pivot) {
      look(ports_.pivot, "driver", in_hand(room_.driver_tip, elapsed_s - parameters_.pivot),
           flange_sight_, elapsed_s, light);
    } else {
      look_at_flange(elapsed_s, light);
    }
  }

 private:
  void remember(const msg::JointState& state) {
    const auto q = joints_of(robot_, state);
    if (!q) return degraded("measured_js: " + q.error().text);
    healthy();
    history_.add(stamp_of(state.header_().stamp_()), *q);
  }

  void tell_plan(Time now) {
    msg::ImplantPlan plan;
    write_header(plan.header_(), now, "image");
    msg::MeasuredMarkers markers;
    write_header(markers.header_(), now, "jaw");
    for (const Eigen::Vector3d& marker : room_.markers) {
      assign(plan.markers_().emplace_back(), marker);
      assign(markers.points_().emplace_back(),
             scattered(room_.chain.patient_T_image * marker, parameters_.marker_error, random_));
    }
    for (const Isometry3d& site : room_.sites) assign(plan.sites_().emplace_back(), site);
    for (const PlannedImplant& implant : room_.implants) {
      msg::Implant& planned = plan.implants_().emplace_back();
      planned.above_bottom_(implant.above_bottom_m);
      planned.length_(implant.length_m);
      planned.pitch_(implant.pitch_m);
    }
    ports_.plan.publish(plan);
    ports_.markers.publish(markers);
  }

  void tell_truth(Time now) {
    msg::TFMessage truth;
    write_chain(room_.chain, now, truth);
    if (!room_.implants.empty()) {
      GuidedChain driver = room_.chain;
      driver.tip = room_.driver_tip;
      write_tool(driver, kDriver, now, truth);
    }
    ports_.truth.publish(truth);
  }

  void shift_jaw(Time now) {
    room_.chain.tracker_T_patient.translate(jaw_shift_);
    jaw_shift_.setZero();
    tell_truth(now);
  }

  /// Arm and jaw stay where they are.
  void shift_stand(Time now) {
    GuidedChain& chain = room_.chain;
    const Isometry3d base_T_jaw = chain.base_T_tracker * chain.tracker_T_patient;
    chain.base_T_tracker.pretranslate(stand_shift_);
    chain.tracker_T_patient = chain.base_T_tracker.inverse() * base_T_jaw;
    stand_shift_.setZero();
    tell_truth(now);
  }

  Isometry3d in_hand(const Eigen::Vector3d& tip, double elapsed_s) const {
    return turned_about_tip(tip, room_.chain.tracker_T_patient.translation(),
                            parameters_.pivot_cone, elapsed_s);
  }

  void look_at_flange(double elapsed_s, Time light) {
    const auto base_T_flange = history_.base_T(mount_.frame, light);
    if (!base_T_flange) {
      return blind(ports_.flange, "flange", base_T_flange.error().text, light);
    }
    look(ports_.flange, "flange",
         room_.chain.base_T_tracker.inverse() * *base_T_flange * room_.chain.flange_T_body,
         flange_sight_, elapsed_s, light);
  }

  void look(Output<msg::TrackedBody>& output, const char* body, const Isometry3d& tracker_T_body,
            const LineOfSight& sight, double elapsed_s, Time light) {
    const double distance_m = tracker_T_body.translation().norm();
    if (const auto obstacle = sight.obstacle(elapsed_s, distance_m)) {
      return blind(output, body, *obstacle, light);
    }
    const SeenBody seen = seen_body(spheres_, tracker_T_body, parameters_.sphere_error, random_);
    publish(output, body, {}, seen, light);
  }

  void blind(Output<msg::TrackedBody>& output, const char* body, const std::string& reason,
             Time light) {
    publish(output, body, reason, {}, light);
  }

  static void publish(Output<msg::TrackedBody>& output, const char* body, const std::string& reason,
                      const SeenBody& seen, Time light) {
    auto loan = output.loan();
    write_header(loan->header_(), light, kTrackerFrame);
    loan->body_() = body;
    loan->valid_(reason.empty());
    loan->reason_() = reason;
    assign(loan->pose_(), seen.tracker_T_body);
    loan->fit_error_(seen.fit_error_m);
    loan.publish();
  }

  RobotModel robot_;
  Flange mount_;
  Parameters parameters_;
  OperatingRoom room_;
  FrameBuffer history_;
  std::vector<Eigen::Vector3d> spheres_;
  LineOfSight flange_sight_, jaw_sight_;
  Eigen::Vector3d jaw_shift_, stand_shift_;  // still to come
  std::mt19937_64 random_;
  std::optional<Time> start_;
  Ports ports_;
};

}  // namespace armature::sim::optical_tracker

ARMATURE_PLUGIN(armature::sim::optical_tracker::OpticalTracker);
