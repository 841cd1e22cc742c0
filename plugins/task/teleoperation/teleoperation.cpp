// SPDX-License-Identifier: Apache-2.0
#include "teleoperation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hand_period.hpp"

namespace armature::task::teleoperation {
namespace {

constexpr Duration kSettlesWithin = seconds(1.0);  // an arm that lags behind its reference
constexpr Duration kTellsWithin = seconds(1.0);    // who has not told anything yet
constexpr double kLongestGap_s = 0.1;              // between two poses of the hand
constexpr int kBroken = -1;                        // the gap is longer, or time went back
constexpr double kDegrees = 180 / std::numbers::pi;

ToolPose tool_pose_of(const Eigen::Isometry3d& base_T_tool) {
  return {.position = base_T_tool.translation(),
          .orientation = Eigen::Quaterniond{base_T_tool.linear()}};
}

}  // namespace

void Teleoperation::see(const ConsoleView& view, Time now) {
  switch (phase_) {
    case Phase::waiting:
      return align(view, now);
    case Phase::aligning:
      return judge_alignment(view, now);
    case Phase::refused:
      return;
    default:
      return follow_hand(view, filter_hand(view), now);
  }
}

void Teleoperation::name_missing(const std::string& what, Time now) {
  if (what.empty()) {
    missing_since_.reset();
    return trouble_.clear();
  }
  if (!missing_since_) missing_since_ = now;
  if (now - *missing_since_ > kTellsWithin) trouble_ = what;
}

void Teleoperation::align(const ConsoleView& view, Time now) {
  name_missing(silent(view), now);
  if (!view.is_whole()) return;
  const Eigen::Isometry3d master_T_instrument =
      view.slave_T_master->inverse(Eigen::Isometry) * *view.slave_T_tool;
  master_goal_.set({.pose = tool_pose_of(master_T_instrument)});
  phase_ = Phase::aligning;
}

void Teleoperation::judge_alignment(const ConsoleView& view, Time now) {
  using State = PursuedGoal::State;
  name_missing(silent(view), now);
  if (master_goal_.state() == State::failed) {
    return refuse("the master cannot come to the instrument: " + master_goal_.reason());
  }
  if (master_goal_.state() != State::done || !view.is_whole()) return;
  const PoseResidual off = residual(*view.slave_T_master * *view.master_T_hand,
                                    Eigen::Vector3d::UnitX(), tool_pose_of(*view.slave_T_tool));
  if (off.position_m <= parameters_.aligned_m && off.angle_rad <= parameters_.aligned_rad) {
    master_goal_.set({.mode = MotionMode::guided, .pose = {}});
    phase_ = Phase::aligned;
  } else if (now - master_goal_.done_at() > kSettlesWithin) {
    refuse(fmt::format("the master stands {:.3f} mm and {:.3f} degrees off the instrument",
                       1e3 * off.position_m, kDegrees * off.angle_rad));
  }
}

int Teleoperation::filter_hand(const ConsoleView& view) {
  if (!view.master_T_hand) {
    hand_.reset();
    return 0;
  }
  const double passed_s = to_seconds(view.hand_stamp - hand_stamp_);
  hand_stamp_ = view.hand_stamp;
  const bool unbroken = hand_ && passed_s >= 0 && passed_s <= kLongestGap_s;
  if (!unbroken) {
    const int broken = hand_ ? kBroken : 0;
    filter_.start(*view.master_T_hand);
    hand_ = view.master_T_hand;
    return broken;
  }
  const int periods = static_cast<int>(std::lround(passed_s / kHandPeriod_s));
  if (periods > 0) hand_ = filter_.step(*view.master_T_hand, periods);
  return periods;
}

std::string Teleoperation::silent(const ConsoleView& view) {
  if (!view.slave_T_master) return "where the console stands is not known";
  if (!view.master_T_hand) return "the master tells nothing";
  if (!view.slave_T_tool) return "the slave tells nothing";
  return "";
}

std::string Teleoperation::missing(const ConsoleView& view) const {
  if (std::string silent = this->silent(view); !silent.empty()) return silent;
  if (master_goal_.state() != PursuedGoal::State::moving) {
    const std::string& why = master_goal_.reason();
    return "the master is not free for the hand" + (why.empty() ? "" : ": " + why);
  }
  if (!view.clutch_closed) return "the clutch tells nothing";
  return "";
}

void Teleoperation::follow_hand(const ConsoleView& view, int periods, Time now) {
  const std::string missing = this->missing(view);
  if (phase_ != Phase::teleoperating) return await_clutch(view, missing, now);
  if (!missing.empty()) return stop_slave(Phase::held, missing);
  if (!*view.clutch_closed) return stop_slave(Phase::clutch_open, "");
  if (periods == kBroken) return stop_slave(Phase::held, "the master's stamps jump");
  if (periods == 0) return;
  const SlaveTarget target = motion_.follow(*hand_, periods);
  slave_goal_ = MotionGoal{.mode = MotionMode::tracking,
                           .pose = tool_pose_of(target.pose),
                           .velocity = target.velocity,
                           .angular_velocity = target.angular_velocity};
}

void Teleoperation::await_clutch(const ConsoleView& view, const std::string& missing, Time now) {
  if (phase_ != Phase::held) name_missing(missing, now);
  if (!missing.empty()) return;
  if (phase_ == Phase::held) {
    if (*view.clutch_closed) return;
    phase_ = Phase::clutch_open;
    trouble_.clear();
  }
  if (*view.clutch_closed) engage(view);
}

void Teleoperation::engage(const ConsoleView& view) {
  motion_.engage(*view.slave_T_tool, *hand_, view.slave_T_master->linear());
  missing_since_.reset();
  first_engaged_id_ = last_slave_id_ + 1;
  phase_ = Phase::teleoperating;
}

void Teleoperation::hear_slave(const GoalReport& report) {
  // A task that starts late, or again, goes on counting where the goals are.
  if (is_newer(report.goal_id, last_slave_id_)) last_slave_id_ = report.goal_id;
  const bool mine = is_newer(report.goal_id, first_engaged_id_ - 1);
  if (report.state != GoalReport::State::failed || !mine) return;
  if (phase_ == Phase::teleoperating) {
    stop_slave(Phase::held, "the slave cannot follow: " + report.stage + ": " + report.reason);
  }
}

std::optional<MotionGoal> Teleoperation::outgoing_slave_goal() {
  if (slave_goal_) slave_goal_->id = ++last_slave_id_;
  return std::exchange(slave_goal_, std::nullopt);
}

void Teleoperation::stop_slave(Phase phase, std::string trouble) {
  slave_goal_ = MotionGoal{.mode = MotionMode::hold, .pose = {}};
  phase_ = phase;
  trouble_ = std::move(trouble);
}

void Teleoperation::refuse(std::string why) {
  phase_ = Phase::refused;
  trouble_ = std::move(why);
}

const char* to_string(Teleoperation::Phase phase) {
  switch (phase) {
    case Teleoperation::Phase::waiting:
      return "waiting";
    case Teleoperation::Phase::aligning:
      return "aligning";
    case Teleoperation::Phase::aligned:
      return "aligned";
    case Teleoperation::Phase::teleoperating:
      return "teleoperating";
    case Teleoperation::Phase::clutch_open:
      return "clutch open";
    case Teleoperation::Phase::held:
      return "held";
    case Teleoperation::Phase::refused:
      return "refused";
  }
  return "";
}

}  // namespace armature::task::teleoperation
