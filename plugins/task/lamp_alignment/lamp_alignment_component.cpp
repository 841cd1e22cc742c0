// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <string>

#include "armature/config/reader.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/target/target_messages.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/motion/task_state_publisher.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"
#include "lamp_alignment.hpp"

namespace armature {
namespace {

constexpr Duration kPeriod = seconds(0.02);

SearchSettings search_settings(const Params& params, const RobotModel& model) {
  const auto point = params.numbers("search_point_m");
  SearchSettings search{.joint_6 = {point[0], point[1], point[2]},
                        .joint_6_to_lamp_m = model.joints().back().a,
                        .yaw = params.numbers("search_yaw_deg"),
                        .pitch = params.numbers("search_pitch_deg")};
  if (search.yaw.empty() || search.pitch.empty()) {
    params.refuse({"search_yaw_deg", "search_pitch_deg"},
                  "'search_yaw_deg' and 'search_pitch_deg' need at least one angle each");
  }
  return search;
}

/// A parameter that must be below another one, in words of the file.
void check_below(const Params& params, const std::string& lower, const std::string& upper,
                 const char* else_what) {
  const double unit = config::si_factor(lower);
  if (params.number(lower) < params.number(upper)) return;
  params.refuse({lower, upper}, fmt::format("'{}' is {:g}, not below '{}', which is {:g}: {}",
                                            lower, params.number(lower) / unit, upper,
                                            params.number(upper) / unit, else_what));
}

/// What is a hysteresis must leave something between its ends.
void check_hystereses(const Params& params) {
  for (const std::string of : {"position_mm", "angle_deg"}) {
    check_below(params, "settled_" + of, "replan_" + of, "what is aligned would be aligned again");
    check_below(params, "replan_" + of, "moved_" + of, "noise would be a patient that moves");
  }
  check_below(params, "dark", "bright", "the lamp would never stop changing its light");
}

AlignmentSettings settings_of(const Params& params, const RobotModel& model) {
  check_hystereses(params);
  return {.distance_m = params.number("distance_m"),
          .search = search_settings(params, model),
          .frames_per_view = static_cast<int>(params.integer("frames_per_view")),
          .settle_frames = static_cast<int>(params.integer("settle_frames")),
          .settled = {params.number("settled_position_mm"), params.number("settled_angle_deg")},
          .still = {params.number("replan_position_mm"), params.number("replan_angle_deg")},
          .moved = {params.number("moved_position_mm"), params.number("moved_angle_deg")},
          .moved_frames = static_cast<int>(params.integer("moved_frames")),
          .replan_interval_s = params.number("replan_interval_s"),
          .lost_s = params.number("lost_s"),
          .light = {.dark = params.number("dark"),
                    .bright = params.number("bright"),
                    .step = params.number("light_step"),
                    .level = params.number("light_level")}};
}

}  // namespace

class LampAlignmentComponent : public Component {
 public:
  explicit LampAlignmentComponent(Setup& setup)
      : Component(setup),
        task_{settings_of(setup.params(), robot_of(setup))},
        target_{setup.input<msg::Target>("target")},
        landmarks_{setup.input<msg::FaceLandmarks>("landmarks")},
        motion_status_{setup.input<msg::MotionStatus>("motion_status")},
        goal_{setup.output<msg::MotionGoal>("goal")},
        light_level_{setup.output<msg::LightLevel>("light_level")},
        capture_{setup.output<msg::Capture>("capture")},
        state_{setup} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    read(now);
    task_.step(now);
    send_goal(now);
    send_light_and_capture(now);
    publish_state(now);
  }

 private:
  void read(Time now) {
    for (std::size_t i = 0; i < motion_status_.size(); ++i) {
      task_.hear(report_of(motion_status_[i]), now);
    }
    for (std::size_t i = 0; i < landmarks_.size(); ++i) {
      const msg::FaceLandmarks& seen = landmarks_[i];
      task_.see(Picture{.stamp = stamp_of(seen.header_().stamp_()),
                        .face = seen.valid_(),
                        .image_intensity = seen.image_intensity_(),
                        .face_intensity = seen.face_intensity_()},
                now);
    }
    for (std::size_t i = 0; i < target_.size(); ++i) {
      const auto face = estimate_of(target_[i]);
      if (!face) {
        task_.see_no_estimate(face.error().text);
        continue;
      }
      task_.see({.stamp = face->stamp, .mouth = face->position, .normal = face->normal});
    }
  }

  void send_goal(Time now) {
    const auto goal = task_.outgoing_goal(now);
    if (!goal) return;
    auto loan = goal_.loan();
    write_goal(*goal, now, *loan);
    loan.publish();
  }

  void send_light_and_capture(Time now) {
    if (const auto level = task_.take_light_level()) {
      auto loan = light_level_.loan();
      write_header(loan->header_(), now);
      loan->level_(*level);
      loan.publish();
      say(fmt::format("light level {:.0f} %", *level * 100));
    }
    if (sent_capture_ == task_.capture()) return;
    sent_capture_ = task_.capture();
    auto loan = capture_.loan();
    write_header(loan->header_(), now);
    loan->on_(*sent_capture_);
    loan.publish();
  }

  void publish_state(Time now) {
    const bool searching = task_.phase() == LampAlignment::Phase::searching;
    std::string line = to_string(task_.phase());
    if (searching) line += fmt::format(" {}/{}", task_.view(), task_.views());
    if (!task_.trouble().empty()) line += ": " + task_.trouble();
    const TaskReport report{.state = to_string(task_.phase()),
                            .step = searching ? task_.view() : 0,
                            .steps = searching ? task_.views() : 0,
                            .detail = task_.trouble()};
    if (state_.publish(now, report, line)) say(line);
  }

  LampAlignment task_;
  Input<msg::Target> target_;
  Input<msg::FaceLandmarks> landmarks_;
  Input<msg::MotionStatus> motion_status_;
  Output<msg::MotionGoal> goal_;
  Output<msg::LightLevel> light_level_;
  Output<msg::Capture> capture_;
  TaskStatePublisher state_;
  std::optional<bool> sent_capture_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::LampAlignmentComponent);
