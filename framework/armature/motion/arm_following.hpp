// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "armature/motion/joint_bound.hpp"
#include "armature/motion/reference.hpp"
#include "armature/motion/rest_watch.hpp"
#include "armature/motion/return_to_arm.hpp"

namespace armature ARMATURE_EXPORT {

/// The joint positions that the arm reports.
struct MeasuredJoints {
  Time stamp;
  JointVector q;       // independent joints
  JointVector v = {};  // as the arm tells it; empty where it does not
};

struct FollowingOptions {
  Duration period;            // of the steps
  JointBound max_deviation;   // of the arm from the reference
  double max_tip_deviation;   // [m] of its tip, or its shaft's end, from where that has it
  JointBound goal_tolerance;  // of an arm that has come to where the reference rests
  JointBound rest_tolerance;  // of an arm that rests, around one place
  Duration measured_max_age;
  Duration max_lateness;  // of a step; later the driver has stopped the arm
};

/// Whether an arm is heard and follows its reference, and where the reference begins, comes and
/// stays by what the arm says. Knows nothing of goals: what they are told of it, and the stop, are
/// its caller's. Real-time safe.
class ArmFollowing {
 public:
  /// Keeps references to `model` and `reference`.
  ArmFollowing(const RobotModel& model, const MotionLimits& limits, const FollowingOptions& options,
               Reference& reference);

  /// Whether the arm follows, by its own word; nothing: it does not say. To an arm that is halted
  /// and does not follow the reference comes however near it is. To one that follows the reference
  /// never comes: it goes where it is told to, so that what it measures elsewhere is its encoders'
  /// word, or a push that ends.
  void set_follows(std::optional<bool> follows) { follows_ = follows; }
  std::optional<bool> follows() const { return follows_; }

  /// Once a step, first. True after a standstill of this unit or of the whole machine: the
  /// reference, which must not be where it would have come to meanwhile, is forgotten.
  bool comes_late(Time now);
  /// Of a reference that has not started: it does where the arm rests, and not where it is just
  /// passing.
  void begin(Time now, const std::optional<MeasuredJoints>& measured);
  /// Takes what the arm has told. True in the step in which it falls silent.
  bool falls_silent(Time now, const std::optional<MeasuredJoints>& measured);
  /// The last one, while the arm is heard.
  const std::optional<MeasuredJoints>& measured() const { return measured_; }
  /// Of an arm that a hand moves: the reference is where it is.
  void go_along(Time now);
  /// Of an arm that is halted, or follows nothing: where it rests elsewhere, or was pushed to, is
  /// where the reference comes. Why it stays beside the arm, or empty.
  std::string_view stay_with(Time now);
  /// True in the step in which the arm is found away from the reference; to one that stays so, and
  /// is not `halted`, the reference comes.
  bool strays(Time now, bool halted);
  /// The reference begins again from where the arm is, or stays where it must not come to it.
  void begin_again(Time now);

  bool rests() const { return rest_.rests(); }
  /// Whether the reference stands, and the arm by its own samples as well. An arm that is silent
  /// cannot say so, and counts as resting.
  bool at_rest(Time now) const;
  /// Why the arm is not driven, or empty.
  const ReasonText& trouble() const { return trouble_; }

 private:
  /// Why the arm is not heard, or empty.
  ReasonText silence(Time now, const std::optional<MeasuredJoints>& measured) const;
  /// To an arm that rests, and does not say that it follows.
  void return_to_arm(Time now);

  const RobotModel& model_;
  FollowingOptions options_;
  Reference& reference_;
  RestWatch rest_;
  ReturnToArm return_;
  std::optional<MeasuredJoints> measured_;
  std::optional<bool> follows_;
  std::optional<Time> stepped_at_;
  Time begin_after_;     // a reference begins from a sample of the arm that is not older
  bool astray_ = false;  // the arm is not where the reference is
  ReasonText trouble_ = "no joint state of the arm yet";
};

}  // namespace armature
