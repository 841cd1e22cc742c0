// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <optional>
#include <string>

#include "armature/kinds/pose_in_base.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/task/task_ports.hpp"
#include "hand_period.hpp"
#include "task_teleoperation_ports.hpp"
#include "teleoperation.hpp"

namespace armature::task::teleoperation {
namespace {

constexpr Duration kPeriod = seconds(kHandPeriod_s);
constexpr Duration kCalm = seconds(0.1);        // without trouble: it is over
constexpr Duration kOtherWords = seconds(1.0);  // of trouble that goes on, from the ones before

}  // namespace

class TeleoperationComponent final : public Component {
 public:
  explicit TeleoperationComponent(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        task_{parameters_},
        trails_{fmt::format("the instrument trails its target by more than {:g} mm",
                            1e3 * parameters_.trailing)},
        ports_{setup},
        task_ports_{ports_.operator_, ports_.state} {
    setup.activate_every(kPeriod);
    const TremorFilter& filter = task_.filter();
    log(fmt::format("the follower trails {:.1f} ms behind the hand; 10 Hz is down by {:.1f} dB",
                    1e3 * filter.lag_s(), -20 * std::log10(filter.gain(10))));
  }

  void step(Time now) override {
    for (std::size_t i = 0; i < ports_.leader_status.size(); ++i) {
      task_.hear_leader(report_of(ports_.leader_status[i]), now);
    }
    for (std::size_t i = 0; i < ports_.follower_status.size(); ++i) {
      task_.hear_follower(report_of(ports_.follower_status[i]));
    }
    for (const std::string& line : task_ports_.hear(
             now, task_.procedure(), [this](const auto& command) { return task_.hear(command); })) {
      log(line);
    }
    task_.see(view(), now);
    show_health(now);
    send(task_.outgoing_leader_goal(now), now, ports_.leader_goal);
    send(task_.outgoing_follower_goal(), now, ports_.follower_goal);
    publish_state(now);
  }

 private:
  /// What is told badly is not told.
  ConsoleView view() {
    std::string bad;
    const auto pose_of = [&](const auto& input, const char* what) {
      std::optional<Eigen::Isometry3d> found;
      if (!input.latest()) return found;
      const auto pose = pose_in_base(*input.latest(), what);
      if (pose) {
        found = *pose;
      } else {
        bad = pose.error().text;
      }
      return found;
    };
    ConsoleView view{
        .follower_T_leader = pose_of(ports_.console, "the console"),
        .leader_T_hand = pose_of(ports_.leader_cp, "the leader"),
        .follower_T_tool = pose_of(ports_.follower_cp, "the follower's tool"),
        .follower_T_setpoint = pose_of(ports_.follower_setpoint, "the follower's setpoint")};
    if (view.leader_T_hand) {
      view.hand_stamp = stamp_of(ports_.leader_cp.latest()->header_().stamp_());
    }
    if (ports_.clutch.latest()) view.clutch_closed = ports_.clutch.latest()->data_();
    if (const msg::PointStamped* incision = ports_.incision.latest()) {
      const Eigen::Vector3d point = to_eigen(incision->point_());
      const ReasonText wrong = defect_of_point(incision->header_(), point, "the incision");
      if (wrong.empty()) {
        view.incision = point;
      } else {
        bad = wrong.view();
      }
    }
    bad_ = bad;
    return view;
  }

  /// What is wrong with one sample and not with the next is told as one, and so is that whose
  /// numbers change.
  void show_health(Time now) {
    const std::string wrong = !bad_.empty() ? bad_ : task_.trails() ? trails_ : "";
    if (!wrong.empty()) wrong_at_ = now;
    if (wrong == shown_wrong_) return;
    const bool goes_on = wrong.empty() ? now - wrong_at_ < kCalm : now - shown_at_ < kOtherWords;
    if (!shown_wrong_.empty() && goes_on) return;
    shown_wrong_ = wrong;
    shown_at_ = now;
    if (wrong.empty()) {
      healthy();
    } else {
      degraded(wrong);
    }
  }

  void publish_state(Time now) {
    const TaskReport report{.state = to_string(task_.phase()), .detail = task_.trouble()};
    const auto said = task_ports_.publish(now, report, report.line(), task_.procedure());
    if (said) log(*said);
  }

  Parameters parameters_;
  Teleoperation task_;
  std::string trails_;             // what is said of an instrument that does
  std::string bad_, shown_wrong_;  // what was told badly
  Time wrong_at_, shown_at_;
  Ports ports_;
  TaskPorts task_ports_;
};

}  // namespace armature::task::teleoperation

ARMATURE_PLUGIN(armature::task::teleoperation::TeleoperationComponent);
