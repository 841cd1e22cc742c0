// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/measured_markers.hpp"
#include "armature/kinds/registration_dialogue.hpp"
#include "armature/kinds/registration_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/task/task_ports.hpp"
#include "biopsy.hpp"
#include "task_biopsy_ports.hpp"

namespace armature::task::biopsy {
namespace {

constexpr Duration kPeriod = seconds(0.02);

NeedleLine line_of(const msg::NeedlePlan& plan) {
  return {.entry = to_eigen(plan.entry_()),
          .target = to_eigen(plan.target_()),
          .forbidden = armature::zones_of(plan.forbidden_()),
          .head = armature::zones_of(plan.head_())};
}

std::vector<Eigen::Vector3d> points_of(const std::vector<msg::Point>& messages) {
  std::vector<Eigen::Vector3d> points;
  for (const msg::Point& message : messages) points.push_back(to_eigen(message));
  return points;
}

/// Whatever their stamps.
bool is_other(const msg::NeedlePlan& plan, const msg::NeedlePlan& than) {
  return plan.header_().frame_id_() != than.header_().frame_id_() ||
         plan.markers_() != than.markers_() || plan.entry_() != than.entry_() ||
         plan.target_() != than.target_() || plan.forbidden_() != than.forbidden_() ||
         plan.head_() != than.head_();
}

RegisteredHead head_of(const msg::RegistrationResponse& response) {
  RegisteredHead head;
  head.robot_T_image = robot_T_image_of(response);
  head.fiducial_error_m = response.fre_();
  head.target_error95_m = response.targets_().front().error_95_();
  return head;
}

}  // namespace

class BiopsyComponent final : public Component {
 public:
  explicit BiopsyComponent(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        robot_{robot_of(setup)},
        task_{parameters_, robot_},
        ports_{setup},
        task_ports_{ports_.operator_, ports_.state},
        registration_{ports_.request, ports_.registration, parameters_.marker_error,
                      parameters_.match_tolerance} {
    if (!parameters_.touch_markers && !setup.is_written("markers")) {
      throw SetupError(
          "nobody writes its input 'markers': add a component that measures markers, or have them "
          "touched (touch_markers: true)");
    }
    if (robot_.capsules().empty()) {
      throw SetupError(fmt::format(
          "robot {} states no bodies of its links, and nothing would keep them out of the vessels "
          "and the head; state them in its file under capsules (docs/robot_file.md)",
          robot_.name()));
    }
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    for (const std::string& line :
         task_ports_.hear(now, task_.procedure(),
                          [&](const auto& command) { return task_.hear(command, now); })) {
      log(line);
    }
    read(now);
    task_.update(now);
    publish_touches(now);
    if (task_.wants_registration() && registration_.due(now)) ask(now);
    send(task_.outgoing_goal(now), now, ports_.goal);
    publish_state(now);
  }

 private:
  void read(Time now) {
    if (parameters_.touch_markers) read_tip();
    const bool is_ready =
        parameters_.touch_markers ? sees_tip_ : ports_.markers.latest() != nullptr;
    if (!begun_with_ && ports_.plan.latest() && is_ready) {
      begun_with_ = *ports_.plan.latest();
      if (const auto wrong = not_in_frame(begun_with_->header_(), kImageFrame, "the plan is")) {
        task_.see_refused_plan(*wrong);
      } else {
        task_.see_head(line_of(*begun_with_), points_of(begun_with_->markers_()), now);
      }
    }
    if (begun_with_ && !told_other_plan_ && is_other(*ports_.plan.latest(), *begun_with_)) {
      told_other_plan_ = true;
      log("another plan has come; this procedure goes on with the one that it began with");
    }
    registration_.listen([&](const msg::RegistrationResponse& response) {
      if (!response.valid_()) {
        task_.see_refused_registration(response.reason_(), now);
      } else if (!response.targets_().empty()) {
        tell(response);
        task_.see_registration(head_of(response), now);
      }
    });
    for (std::size_t i = 0; i < ports_.motion_status.size(); ++i) {
      task_.hear(report_of(ports_.motion_status[i]), now);
    }
  }

  void read_tip() {
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) {
      const auto q = joints_of(robot_, ports_.measured_js[i]);
      if (!q) return degraded("measured_js: " + q.error().text);
      healthy();
      sees_tip_ = true;
      task_.see_tip(forward_kinematics(robot_, *q).translation(),
                    stamp_of(ports_.measured_js[i].header_().stamp_()));
    }
  }

  void publish_touches(Time now) {
    const auto& places = task_.touching().places();
    const std::size_t before = std::exchange(told_touches_, task_.touching().version());
    if (before == told_touches_) return;
    registration_.forget();  // of other places
    if (before > 0)
      log(fmt::format("{} of {} markers touched", places.size(), task_.touching().count()));
    touches_.points_().clear();
    for (const Eigen::Vector3d& place : places) assign(touches_.points_().emplace_back(), place);
    touches_.error_(parameters_.touch_error);
    write_header(touches_.header_(), now, kBaseFrame);
    ports_.touched.publish(touches_);
  }

  void tell(const msg::RegistrationResponse& response) {
    const auto& used = response.used_();
    log(fmt::format("{} of {} markers fit to {:.2f} mm, the target is known to {:.2f} mm (95 %)",
                    std::count(used.begin(), used.end(), true), used.size(), 1e3 * response.fre_(),
                    1e3 * response.targets_().front().error_95_()));
  }

  void ask(Time now) {
    const msg::NeedlePlan& plan = *begun_with_;
    const msg::MeasuredMarkers& markers =
        parameters_.touch_markers ? touches_ : *ports_.markers.latest();
    if (const auto wrong = wrong_with(markers, kBaseFrame)) {
      return task_.see_refused_registration(*wrong, now);
    }
    registration_.ask({.robot_frame = std::string{kBaseFrame},
                       .image_markers = plan.markers_(),
                       .robot_markers = markers.points_(),
                       .targets = {plan.target_(), plan.entry_()},
                       .marker_error = markers.error_()},
                      now);
  }

  void publish_state(Time now) {
    const Procedure& procedure = task_.procedure();
    const bool moving = task_.phase() == Biopsy::Phase::moving;
    const TaskReport report{
        .state = moving ? procedure.steps()[procedure.step()].name : to_string(task_.phase()),
        .step = task_.touching().places().size(),
        .steps = task_.touching().count(),
        .detail = task_.trouble()};
    if (const auto said = task_ports_.publish(now, report, report.line(), procedure)) log(*said);
  }

  Parameters parameters_;
  RobotModel robot_;
  Biopsy task_;
  Ports ports_;
  TaskPorts task_ports_;
  RegistrationDialogue registration_;
  msg::MeasuredMarkers touches_;
  std::size_t told_touches_ = 0;
  bool sees_tip_ = false;
  std::optional<msg::NeedlePlan> begun_with_;
  bool told_other_plan_ = false;
};

}  // namespace armature::task::biopsy

ARMATURE_PLUGIN(armature::task::biopsy::BiopsyComponent);
