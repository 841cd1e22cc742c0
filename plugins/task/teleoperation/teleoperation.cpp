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
constexpr Duration kTrailsFor = seconds(0.1);      // an instrument, before that counts
constexpr Duration kTellsWithin = seconds(1.0);    // who has not told anything yet
constexpr const char* kClosedEarly =
    "the clutch was closed before the follower could go: open it and close it again";
constexpr double kLongestGap_s = 0.1;  // between two poses of the hand
constexpr double kDegrees = 180 / std::numbers::pi;

ToolPose tool_pose_of(const Eigen::Isometry3d& base_T_tool) {
  return {.position = base_T_tool.translation(),
          .orientation = Eigen::Quaterniond{base_T_tool.linear()}};
}

}  // namespace

void Teleoperation::see(const ConsoleView& view, Time now) {
  const bool leader_waits = procedure_.paused() && phase_ == Phase::waiting;
  if (leader_waits) return;
  switch (phase_) {
    case Phase::waiting: return align(view, now);
    case Phase::aligning: return judge_alignment(view, now);
    case Phase::aborted:
    case Phase::refused: return;
    default: return follow_hand(view, filter_hand(view, now), now);
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
  const Eigen::Isometry3d leader_T_instrument =
      view.follower_T_leader->inverse(Eigen::Isometry) * *view.follower_T_tool;
  leader_goal_.set({.pose = tool_pose_of(leader_T_instrument)});
  phase_ = Phase::aligning;
}

void Teleoperation::judge_alignment(const ConsoleView& view, Time now) {
  using State = PursuedGoal::State;
  name_missing(silent(view), now);
  if (leader_goal_.state() == State::failed) {
    return refuse("the leader cannot come to the instrument: " + leader_goal_.reason());
  }
  if (leader_goal_.state() != State::done || !view.is_whole()) return;
  const PoseResidual off = residual(*view.follower_T_leader * *view.leader_T_hand,
                                    Eigen::Vector3d::UnitX(), tool_pose_of(*view.follower_T_tool));
  if (off.position_m <= parameters_.aligned_m && off.angle_rad <= parameters_.aligned_rad) {
    leader_goal_.set({.mode = MotionMode::guided, .pose = {}});
    phase_ = Phase::aligned;
    procedure_.enter_next();
  } else if (now - leader_goal_.done_at() > kSettlesWithin) {
    refuse(fmt::format("the leader stands {:.3f} mm and {:.3f} degrees off the instrument",
                       1e3 * off.position_m, kDegrees * off.angle_rad));
  }
}

int Teleoperation::filter_hand(const ConsoleView& view, Time now) {
  jump_.clear();
  if (!view.leader_T_hand) {
    hand_.reset();
    return 0;
  }
  const double passed_s = to_seconds(view.hand_stamp - hand_stamp_);
  if (hand_) jump_ = jump(*view.leader_T_hand, passed_s);
  const bool begins = !hand_ || !jump_.empty();
  const int periods = begins ? 0 : static_cast<int>(std::lround(passed_s / kHandPeriod_s));
  if (!begins && periods == 0) return 0;
  if (begins) {
    filter_.start(*view.leader_T_hand);
    hand_ = view.leader_T_hand;
  } else {
    hand_ = filter_.step(*view.leader_T_hand, periods);
  }
  told_ = *view.leader_T_hand;
  hand_stamp_ = view.hand_stamp;
  hand_went_on_ = now;
  return periods;
}

std::string Teleoperation::jump(const Eigen::Isometry3d& hand, double passed_s) const {
  if (passed_s < 0 || passed_s > kLongestGap_s) return "the leader's stamps jump";
  const double way_m = (hand.translation() - told_.translation()).norm();
  const double turn_rad =
      Eigen::Quaterniond{hand.linear()}.angularDistance(Eigen::Quaterniond{told_.linear()});
  const double time_s = std::max(passed_s, kHandPeriod_s);
  // Not a number is a jump.
  const bool can_be = way_m <= parameters_.max_hand_speed * time_s &&
                      turn_rad <= parameters_.max_hand_turn * time_s;
  if (can_be) return "";
  return fmt::format("the leader jumped by {:.1f} mm and {:.1f} degrees within {:.1f} ms",
                     1e3 * way_m, kDegrees * turn_rad, 1e3 * time_s);
}

std::string Teleoperation::silent(const ConsoleView& view) {
  if (!view.follower_T_leader) return "where the console stands is not known";
  if (!view.leader_T_hand) return "the leader tells nothing";
  if (!view.follower_T_tool) return "the follower tells nothing";
  return "";
}

std::string Teleoperation::missing(const ConsoleView& view, Time now) const {
  if (std::string silent = this->silent(view); !silent.empty()) return silent;
  if (leader_goal_.state() != PursuedGoal::State::moving) {
    const std::string& why = leader_goal_.reason();
    return "the leader is not free for the hand" + (why.empty() ? "" : ": " + why);
  }
  if (!view.follower_T_setpoint) return "the follower's motion tells nothing";
  if (!view.clutch_closed) return "the clutch tells nothing";
  if (now - hand_went_on_ > seconds(kLongestGap_s)) return "the leader's stamps stand still";
  return "";
}

void Teleoperation::follow_hand(const ConsoleView& view, int periods, Time now) {
  const std::string missing = this->missing(view, now);
  if (phase_ != Phase::teleoperating) return await_clutch(view, missing, now);
  if (!missing.empty()) return stop_follower(Phase::held, missing);
  if (!*view.clutch_closed) return stop_follower(Phase::clutch_open, "");
  if (!jump_.empty()) return stop_follower(Phase::held, jump_);
  if (periods == 0) return;
  const FollowerTarget target = motion_.follow(*hand_, periods);
  follower_goal_ = MotionGoal{.mode = MotionMode::tracking,
                              .pose = tool_pose_of(target.pose),
                              .velocity = target.velocity,
                              .angular_velocity = target.angular_velocity};
  judge_following((target.pose.translation() - view.follower_T_tool->translation()).norm(), now);
}

void Teleoperation::judge_following(double behind_m, Time now) {
  if (behind_m <= parameters_.trailing / 2) {
    trails_since_.reset();
    trails_ = false;
  }
  if (behind_m > parameters_.trailing && !trails_since_) trails_since_ = now;
  if (trails_since_ && now - *trails_since_ >= kTrailsFor) trails_ = true;
}

void Teleoperation::await_clutch(const ConsoleView& view, const std::string& missing, Time now) {
  const bool closed = view.clutch_closed && *view.clutch_closed;
  const bool is_open = view.clutch_closed && !closed;
  // The leader, to the hand: also where a stop kept it from that.
  const bool was_given = leader_goal_.has_moved() || !leader_goal_.may_move();
  awaits_opening_ = !is_open && (awaits_opening_ || (was_given && !missing.empty()));
  if (phase_ != Phase::held) {
    const bool only_early = awaits_opening_ && missing.empty();
    name_missing(only_early ? kClosedEarly : missing, now);
  }
  if (!missing.empty()) return;
  if (phase_ == Phase::held) {
    if (closed) return;
    phase_ = Phase::clutch_open;
    trouble_.clear();
  }
  if (closed && !awaits_opening_ && procedure_.may_act()) engage(view);
}

void Teleoperation::engage(const ConsoleView& view) {
  motion_.engage(*view.follower_T_setpoint, *hand_, view.follower_T_leader->linear(),
                 view.incision);
  missing_since_.reset();
  first_engaged_id_ = last_follower_id_ + 1;
  phase_ = Phase::teleoperating;
}

void Teleoperation::hear_follower(const GoalReport& report) {
  // A task that starts late, or again, goes on counting where the goals are.
  if (is_newer(report.goal_id, last_follower_id_)) last_follower_id_ = report.goal_id;
  const bool mine = is_newer(report.goal_id, first_engaged_id_ - 1);
  if (report.state != GoalReport::State::failed || !mine) return;
  if (phase_ == Phase::teleoperating) {
    stop_follower(Phase::held,
                  "the follower cannot follow: " + report.stage + ": " + report.reason);
  }
}

Expected<void> Teleoperation::hear(const OperatorCommand& command) {
  const auto word = procedure_.hear(command);
  if (!word) return tl::unexpected{word.error()};
  const bool leader_moves = phase_ == Phase::waiting || phase_ == Phase::aligning;
  switch (*word) {
    case OperatorWord::confirm: break;
    case OperatorWord::pause:
      if (leader_moves) leader_goal_.pause();
      if (phase_ == Phase::teleoperating) stop_follower(Phase::held, "");
      break;
    case OperatorWord::resume:
      if (leader_moves) leader_goal_.resume();
      break;
    case OperatorWord::back:
      if (leader_moves) return armature::refuse("there is no step before this one");
      procedure_.turn_back();
      stop_follower(Phase::waiting, "");
      procedure_.enter(0);
      break;
    case OperatorWord::abort:
      stop_follower(Phase::aborted, "");
      if (leader_moves) leader_goal_.set({.mode = MotionMode::hold, .pose = {}});
      procedure_.end(Procedure::StepState::broken_off);
      break;
  }
  return {};
}

std::optional<MotionGoal> Teleoperation::outgoing_follower_goal() {
  if (follower_goal_) follower_goal_->id = ++last_follower_id_;
  return std::exchange(follower_goal_, std::nullopt);
}

void Teleoperation::stop_follower(Phase phase, std::string trouble) {
  follower_goal_ = MotionGoal{.mode = MotionMode::hold, .pose = {}};
  phase_ = phase;
  trouble_ = std::move(trouble);
  trails_since_.reset();
  trails_ = false;
}

void Teleoperation::refuse(std::string why) {
  phase_ = Phase::refused;
  trouble_ = std::move(why);
  procedure_.end(Procedure::StepState::broken_off);
}

const char* to_string(Teleoperation::Phase phase) {
  switch (phase) {
    case Teleoperation::Phase::waiting: return "waiting";
    case Teleoperation::Phase::aligning: return "aligning";
    case Teleoperation::Phase::aligned: return "aligned";
    case Teleoperation::Phase::teleoperating: return "teleoperating";
    case Teleoperation::Phase::clutch_open: return "clutch open";
    case Teleoperation::Phase::held: return "held";
    case Teleoperation::Phase::aborted: return "aborted";
    case Teleoperation::Phase::refused: return "refused";
  }
  return "";
}

}  // namespace armature::task::teleoperation
