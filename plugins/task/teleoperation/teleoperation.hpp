// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "armature/task/procedure.hpp"
#include "armature/task/pursued_goal.hpp"
#include "scaled_motion.hpp"
#include "task_teleoperation_parameters.hpp"
#include "tremor_filter.hpp"

namespace armature::task::teleoperation {

/// What is known at one instant; what is silent is not there.
struct ConsoleView {
  std::optional<Eigen::Isometry3d> follower_T_leader;  // where the console stands
  std::optional<Eigen::Isometry3d> leader_T_hand, follower_T_tool, follower_T_setpoint;
  Time hand_stamp;  // of leader_T_hand
  std::optional<bool> clutch_closed;
  std::optional<Eigen::Vector3d> incision;  // [m] in the follower's base frame; none: none is there

  bool is_whole() const { return follower_T_leader && leader_T_hand && follower_T_tool; }
};

/// The scenario of a leader-follower robot. The leader comes to the pose of the instrument by
/// itself (never the other way round, which would move the instrument in the body); then a hand may
/// take it, and while the clutch is closed the follower goes with the hand. Call `see` once a
/// period.
class Teleoperation {
 public:
  enum class Phase {
    waiting,        // for the console and both arms
    aligning,       // the leader comes to the instrument
    aligned,        // the hand may take the leader; the clutch has not been closed yet
    teleoperating,  // the follower goes with the hand
    clutch_open,    // the follower stands, the hand is free to move
    held,           // the follower stands for a reason, until the clutch is opened
    aborted,        // the follower stands, for good
    refused,        // the leader does not come to the instrument
  };

  explicit Teleoperation(const Parameters& parameters)
      : parameters_{parameters},
        procedure_{{{.name = "alignment"}, {.name = "teleoperation", .asks = true}},
                   parameters.auto_confirm},
        filter_{parameters},
        motion_{parameters} {}

  void see(const ConsoleView& view, Time now);
  void hear_leader(const GoalReport& report, Time now) { leader_goal_.hear(report, now); }
  void hear_follower(const GoalReport& report);
  /// A pause, a way back and an abort stop the follower where it is: the way out of the body is the
  /// surgeon's.
  Expected<void> hear(const OperatorCommand& command);

  std::optional<MotionGoal> outgoing_leader_goal(Time now) { return leader_goal_.outgoing(now); }
  /// A target that moves, once a period while the follower moves, and `hold` when it ends.
  std::optional<MotionGoal> outgoing_follower_goal();

  Phase phase() const { return phase_; }
  const Procedure& procedure() const { return procedure_; }
  /// Why it does not go on, or "".
  const std::string& trouble() const { return trouble_; }
  /// Whether the instrument is farther behind its target than `trailing_mm`.
  bool trails() const { return trails_; }
  const TremorFilter& filter() const { return filter_; }

 private:
  void align(const ConsoleView& view, Time now);
  void judge_alignment(const ConsoleView& view, Time now);
  void follow_hand(const ConsoleView& view, int periods, Time now);
  /// `behind_m`: from the tool to its target.
  void judge_following(double behind_m, Time now);
  /// What of the console and the arms is silent, or "".
  static std::string silent(const ConsoleView& view);
  /// What is missing for the follower to follow, or "".
  std::string missing(const ConsoleView& view, Time now) const;
  /// Of a follower that does not follow yet: nothing is wrong with what begins a moment later.
  void name_missing(const std::string& what, Time now);
  /// For how many periods the hand has moved on: 0 when nothing new is told of it, or when it
  /// begins anew, as it does after a jump.
  int filter_hand(const ConsoleView& view, Time now);
  /// Why no hand comes there from where it was last told, `passed_s` later by its stamps, or "".
  std::string jump(const Eigen::Isometry3d& hand, double passed_s) const;
  /// Not following: until the clutch is closed. What comes back while it is closed, as a leader
  /// behind a rearm, or comes back closed, as the clutch itself, moves nothing.
  void await_clutch(const ConsoleView& view, const std::string& missing, Time now);
  void engage(const ConsoleView& view);
  void stop_follower(Phase phase, std::string trouble);
  void refuse(std::string why);

  Parameters parameters_;
  Procedure procedure_;
  TremorFilter filter_;
  ScaledMotion motion_;
  std::optional<Eigen::Isometry3d> hand_;                   // filtered
  Eigen::Isometry3d told_ = Eigen::Isometry3d::Identity();  // the hand, not filtered
  Time hand_stamp_, hand_went_on_;  // of told_; when it was seen that the stamp had gone on
  std::string jump_;                // of the hand since the last step, or ""
  PursuedGoal leader_goal_;
  std::optional<MotionGoal> follower_goal_;
  std::uint64_t last_follower_id_ = 0, first_engaged_id_ = 0;
  Phase phase_ = Phase::waiting;
  std::optional<Time> missing_since_, trails_since_;
  bool trails_ = false;
  bool awaits_opening_ = false;  // of the clutch: something was missing while it was not told open
  std::string trouble_;
};

/// "waiting", "aligning", "aligned", "teleoperating", "clutch open", "held", "aborted",
/// "refused".
const char* to_string(Teleoperation::Phase phase);

}  // namespace armature::task::teleoperation
