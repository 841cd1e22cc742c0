// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/target/target_messages.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/task/task_ports.hpp"
#include "lamp_alignment.hpp"
#include "search_coverage.hpp"
#include "search_poses.hpp"
#include "task_lamp_alignment_ports.hpp"

namespace armature::task::lamp_alignment {
namespace {

constexpr Duration kPeriod = seconds(0.02);

Parameters parameters_of(const Params& params) {
  Parameters parameters = Parameters::read(params);
  if (parameters.search_yaw.empty() || parameters.search_pitch.empty()) {
    params.refuse({"search_yaw_deg", "search_pitch_deg"},
                  "'search_yaw_deg' and 'search_pitch_deg' need at least one angle each");
  }
  using Corner = std::array<double, 3>;
  const auto refuse_above = [&](const char* low_name, const Corner& low, const char* high_name,
                                const Corner& high) {
    for (std::size_t i = 0; i < low.size(); ++i) {
      if (low[i] <= high[i]) continue;
      params.refuse({low_name, high_name},
                    fmt::format("'{}' is above '{}' in {}: {:g} m and {:g} m", low_name, high_name,
                                std::string_view{"xyz"}.substr(i, 1), low[i], high[i]));
    }
  };
  refuse_above("min_mouth_m", parameters.min_mouth, "max_mouth_m", parameters.max_mouth);
  refuse_above("min_patient_m", parameters.min_patient, "min_mouth_m", parameters.min_mouth);
  refuse_above("max_mouth_m", parameters.max_mouth, "max_patient_m", parameters.max_patient);
  return parameters;
}

Verdict verdict_of(const msg::FacePose& face) {
  const bool is_bad_input = face.code_() == static_cast<std::uint8_t>(FaceRefusal::bad_input);
  return {.stamp = stamp_of(face.header_().stamp_()),
          .refusal = face.valid_() ? std::string{} : face.reason_(),
          .can_be_used = face.valid_() || !is_bad_input};
}

/// What the cameras see from the search poses, when the deployment has cameras.
std::optional<SearchCoverage> coverage_of(Setup& setup, const Parameters& parameters) {
  const auto rig = optional_rig_of(setup);
  if (!rig) return std::nullopt;
  const RobotModel robot = robot_of(setup);
  return SearchCoverage::make(parameters, robot, *rig,
                              search_poses(parameters, robot.joints().back().a));
}

}  // namespace

class LampAlignmentComponent : public Component {
 public:
  explicit LampAlignmentComponent(Setup& setup)
      : Component(setup),
        task_{parameters_of(setup.params()), robot_of(setup).joints().back().a},
        coverage_{coverage_of(setup, parameters_of(setup.params()))},
        ports_{setup},
        task_ports_{ports_.operator_, ports_.state} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    const auto obey = [&](const auto& command) { return task_.hear(command, now); };
    for (const std::string& line : task_ports_.hear(now, task_.procedure(), obey)) log(line);
    read(now);
    task_.step(now);
    send(task_.outgoing_goal(now), now, ports_.goal);
    send_light_and_capture(now);
    publish_state(now);
  }

  std::vector<std::string> notes_for_check() const override {
    return coverage_ ? coverage_->lines() : std::vector<std::string>{};
  }

 private:
  void read(Time now) {
    for (std::size_t i = 0; i < ports_.motion_status.size(); ++i) {
      task_.hear(report_of(ports_.motion_status[i]), now);
    }
    for (std::size_t i = 0; i < ports_.landmarks.size(); ++i) {
      const msg::FaceLandmarks& seen = ports_.landmarks[i];
      task_.see(Picture{.stamp = stamp_of(seen.header_().stamp_()),
                        .face = seen.valid_(),
                        .image_intensity = seen.image_intensity_(),
                        .face_intensity = seen.face_intensity_()},
                now);
    }
    for (std::size_t i = 0; i < ports_.face.size(); ++i) task_.see(verdict_of(ports_.face[i]));
    for (std::size_t i = 0; i < ports_.target.size(); ++i) {
      const auto face = estimate_of(ports_.target[i]);
      if (!face) {
        task_.see_no_estimate(face.error().text);
        continue;
      }
      task_.see({.stamp = face->stamp,
                 .mouth = face->position,
                 .normal = face->normal,
                 .velocity = face->velocity,
                 .normal_rate = face->normal_rate,
                 .measurements = face->measurements});
    }
  }

  void send_light_and_capture(Time now) {
    if (const auto level = task_.take_light_level()) {
      auto loan = ports_.light_level.loan();
      write_header(loan->header_(), now);
      loan->level_(*level);
      loan.publish();
      log(fmt::format("light level {:.0f} %", *level * 100));
    }
    if (sent_capture_ == task_.capture()) return;
    sent_capture_ = task_.capture();
    auto loan = ports_.capture.loan();
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
    const auto said = task_ports_.publish(now, report, line, task_.procedure());
    if (said) log(*said);
  }

  LampAlignment task_;
  std::optional<SearchCoverage> coverage_;
  Ports ports_;
  TaskPorts task_ports_;
  std::optional<bool> sent_capture_;
};

}  // namespace armature::task::lamp_alignment

ARMATURE_PLUGIN(armature::task::lamp_alignment::LampAlignmentComponent);
