// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <string>

#include "armature/kinds/registration_dialogue.hpp"
#include "armature/kinds/registration_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/task/task_ports.hpp"
#include "biopsy.hpp"

namespace armature::task::biopsy {
namespace {

constexpr Duration kPeriod = seconds(0.02);

NeedleLine line_of(const msg::NeedlePlan& plan) {
  return {to_eigen(plan.entry_()), to_eigen(plan.target_()), zones_of(plan.forbidden_())};
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
        plan_{setup.input<msg::NeedlePlan>("plan")},
        markers_{setup.input<msg::MeasuredMarkers>("markers")},
        ports_{setup},
        registration_{setup, parameters_.marker_error, parameters_.match_tolerance},
        motion_status_{setup.input<msg::MotionStatus>("motion_status")},
        goal_{setup.output<msg::MotionGoal>("goal")} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    for (const std::string& line : ports_.hear(
             task_.procedure(), [this](const auto& command) { return task_.hear(command); })) {
      log(line);
    }
    read(now);
    task_.update(now);
    if (task_.wants_registration() && registration_.due(now)) ask(now);
    if (const auto goal = task_.outgoing_goal(now)) {
      auto loan = goal_.loan();
      write_goal(*goal, now, *loan);
      loan.publish();
    }
    publish_state(now);
  }

 private:
  void read(Time now) {
    if (plan_.latest() && markers_.latest()) task_.see_head(line_of(*plan_.latest()));
    registration_.listen([&](const msg::RegistrationResponse& response) {
      if (!response.valid_()) {
        task_.see_refused_registration(response.reason_());
      } else if (!response.targets_().empty()) {
        tell(response);
        task_.see_registration(head_of(response));
      }
    });
    for (std::size_t i = 0; i < motion_status_.size(); ++i) {
      task_.hear(report_of(motion_status_[i]), now);
    }
  }

  void tell(const msg::RegistrationResponse& response) {
    const auto& used = response.used_();
    log(fmt::format("{} of {} markers fit to {:.2f} mm, the target is known to {:.2f} mm (95 %)",
                    std::count(used.begin(), used.end(), true), used.size(), 1e3 * response.fre_(),
                    1e3 * response.targets_().front().error_95_()));
  }

  void ask(Time now) {
    const msg::NeedlePlan& plan = *plan_.latest();
    registration_.ask({.robot_frame = std::string{kBaseFrame},
                       .image_markers = plan.markers_(),
                       .robot_markers = markers_.latest()->points_(),
                       .targets = {plan.target_(), plan.entry_()}},
                      now);
  }

  void publish_state(Time now) {
    const Procedure& procedure = task_.procedure();
    const bool moving = task_.phase() == Biopsy::Phase::moving;
    const TaskReport report{
        .state = moving ? procedure.steps()[procedure.step()].name : to_string(task_.phase()),
        .detail = task_.trouble()};
    if (const auto said = ports_.publish(now, report, report.line(), procedure)) log(*said);
  }

  Parameters parameters_;
  RobotModel robot_;
  Biopsy task_;
  Input<msg::NeedlePlan> plan_;
  Input<msg::MeasuredMarkers> markers_;
  TaskPorts ports_;
  RegistrationDialogue registration_;
  Input<msg::MotionStatus> motion_status_;
  Output<msg::MotionGoal> goal_;
};

}  // namespace armature::task::biopsy

ARMATURE_PLUGIN(armature::task::biopsy::BiopsyComponent);
