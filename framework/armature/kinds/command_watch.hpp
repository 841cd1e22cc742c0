// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "armature/kinds/servo_command.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/inline_text.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// Tells the driver of an arm whether to follow its newest command, or to bring the arm to rest by
/// itself. Real-time safe.
/// A command has ceased when it is older than `timeout` (one that is stamped ahead of now does not
/// get here). A driver that was late itself judges one period later, since the command that it
/// misses may lie there unread.
/// After such a stop the arm follows again when a command comes that is near to it, within
/// `kNear_rad` or `kNear_m`: a reference that went on must come back first.
class CommandWatch {
 public:
  static constexpr double kNear_rad = 0.1, kNear_m = 0.05;  // as motion's max_deviation is

  /// `period`: how often `follows` is asked. The model outlives the watch.
  CommandWatch(const RobotModel& model, Duration timeout, Duration period)
      : model_{model}, timeout_{timeout}, period_{period} {}

  /// Once per step; `command`: the newest one, if there was one; `q`: where the arm is set to.
  bool follows(Time now, const std::optional<ServoCommand>& command, const JointVector& q);

  /// Why the arm does not follow, for people; empty while it does, and before the first command.
  const ReasonText& why() const { return why_; }
  /// How often commands have ceased.
  std::uint64_t stops() const { return stops_; }

 private:
  enum class State { uncommanded, following, ceased, far };
  State judge(Time now, const std::optional<ServoCommand>& command, const JointVector& q) const;
  std::optional<int> far_joint(const JointVector& command, const JointVector& q) const;
  void tell_ceased(Duration age);
  void tell_far(const JointVector& command, const JointVector& q);

  const RobotModel& model_;
  Duration timeout_, period_;
  std::optional<Time> last_;
  Duration late_{0}, late_before_{0};  // of the driver itself, in this step and in the last one
  State state_ = State::uncommanded;
  std::uint64_t stops_ = 0;
  ReasonText why_;
};

}  // namespace armature
