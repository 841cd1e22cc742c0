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
#include "armature/robot/frame_buffer.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"
#include "line_of_sight.hpp"
#include "operating_room.hpp"
#include "sphere_body.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;

constexpr std::size_t kHistory = 512;  // samples of the arm: half a second at 1 kHz
constexpr const char* kTrackerFrame = "tracker";

LineOfSight sight_of(const Params& params, const char* hidden) {
  LineOfSight sight{.nearest_m = params.number("nearest_mm"),
                    .farthest_m = params.number("farthest_mm"),
                    .hidden_s = params.numbers(hidden)};
  if (const auto wrong = defect(sight.hidden_s)) {
    params.refuse({hidden}, fmt::format("'{}': {}", hidden, *wrong));
  }
  if (sight.nearest_m >= sight.farthest_m) {
    params.refuse({"nearest_mm", "farthest_mm"},
                  fmt::format("'nearest_mm' is {:g} and 'farthest_mm' is {:g}: no body would be "
                              "seen",
                              1e3 * sight.nearest_m, 1e3 * sight.farthest_m));
  }
  return sight;
}

std::vector<Eigen::Vector3d> spheres_of(const Params& params) {
  const auto spheres = points_of(params, "spheres_mm", 3, "at least three spheres");
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
        room_{operating_room(setup.params(), mount_.flange_T_tool)},
        history_{robot_, kHistory},
        spheres_{spheres_of(setup.params())},
        sphere_error_m_{setup.params().number("sphere_error_mm")},
        marker_error_m_{setup.params().number("marker_error_mm")},
        flange_sight_{sight_of(setup.params(), "flange_hidden_s")},
        jaw_sight_{sight_of(setup.params(), "jaw_hidden_s")},
        latency_{seconds(setup.params().number("latency_s"))},
        pivot_s_{setup.params().number("pivot_s")},
        pivot_cone_rad_{setup.params().number("pivot_cone_deg")},
        jaw_shift_{vector_of(setup.params(), "jaw_shift_mm")},
        jaw_shift_at_s_{setup.params().number("jaw_shift_at_s")},
        random_{setup.seed()},
        measured_js_{setup.input<msg::JointState>("measured_js")},
        flange_{setup.output<msg::TrackedBody>("flange")},
        jaw_{setup.output<msg::TrackedBody>("jaw")},
        pivot_{setup.output<msg::TrackedBody>("pivot")},
        plan_{setup.output<msg::ImplantPlan>("plan")},
        markers_{setup.output<msg::MeasuredMarkers>("markers")},
        truth_{setup.output<msg::TFMessage>("truth")} {
    setup.activate_every(seconds(1 / setup.params().number("rate_hz")));
  }

  void step(Time now) override {
    for (std::size_t i = 0; i < measured_js_.size(); ++i) remember(measured_js_[i]);
    if (!start_) {
      start_ = now;
      tell_plan(now);
      tell_truth(now);
    }
    const Time light = now - latency_;
    const double elapsed_s = to_seconds(light - *start_);
    if (elapsed_s < 0) return;  // the shutter had not been open yet
    if (jaw_shift_ != Eigen::Vector3d::Zero() && elapsed_s >= jaw_shift_at_s_) shift_jaw(now);
    look(jaw_, "jaw", room_.chain.tracker_T_patient, jaw_sight_, elapsed_s, light);
    if (elapsed_s < pivot_s_) {
      look(pivot_, "drill", in_hand(elapsed_s), flange_sight_, elapsed_s, light);
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
             scattered(room_.chain.patient_T_image * marker, marker_error_m_, random_));
    }
    for (const Isometry3d& site : room_.sites) assign(plan.sites_().emplace_back(), site);
    plan_.publish(plan);
    markers_.publish(markers);
  }

  void tell_truth(Time now) {
    msg::TFMessage truth;
    write_chain(room_.chain, now, truth);
    truth_.publish(truth);
  }

  void shift_jaw(Time now) {
    room_.chain.tracker_T_patient.translate(jaw_shift_);
    jaw_shift_.setZero();
    tell_truth(now);
  }

  Isometry3d in_hand(double elapsed_s) const {
    return turned_about_tip(room_.chain.tip, room_.chain.tracker_T_patient.translation(),
                            pivot_cone_rad_, elapsed_s);
  }

  void look_at_flange(double elapsed_s, Time light) {
    const auto base_T_flange = history_.base_T(mount_.frame, light);
    if (!base_T_flange) {
      return blind(flange_, "flange", base_T_flange.error().text, light);
    }
    look(flange_, "flange",
         room_.chain.base_T_tracker.inverse() * *base_T_flange * room_.chain.flange_T_body,
         flange_sight_, elapsed_s, light);
  }

  void look(Output<msg::TrackedBody>& output, const char* body, const Isometry3d& tracker_T_body,
            const LineOfSight& sight, double elapsed_s, Time light) {
    const double distance_m = tracker_T_body.translation().norm();
    if (const auto obstacle = sight.obstacle(elapsed_s, distance_m)) {
      return blind(output, body, *obstacle, light);
    }
    const SeenBody seen = seen_body(spheres_, tracker_T_body, sphere_error_m_, random_);
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
  OperatingRoom room_;
  FrameBuffer history_;
  std::vector<Eigen::Vector3d> spheres_;
  double sphere_error_m_, marker_error_m_;
  LineOfSight flange_sight_, jaw_sight_;
  Duration latency_;
  double pivot_s_, pivot_cone_rad_;
  Eigen::Vector3d jaw_shift_;  // still to come
  double jaw_shift_at_s_;
  std::mt19937_64 random_;
  std::optional<Time> start_;
  Input<msg::JointState> measured_js_;
  Output<msg::TrackedBody> flange_, jaw_, pivot_;
  Output<msg::ImplantPlan> plan_;
  Output<msg::MeasuredMarkers> markers_;
  Output<msg::TFMessage> truth_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::OpticalTracker);
