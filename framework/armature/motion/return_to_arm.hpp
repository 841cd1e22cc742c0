// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/robot/model/robot_model.hpp"
#include "armature/robot/trajectories/short_trajectory.hpp"
#include "armature/robot/trajectories/trajectory_check.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// How a reference that rests comes to an arm that rests elsewhere: from rest to rest, within
/// limits. Not to an arm whose drive is on all the same, and which measures itself beside where it
/// is told to be (an encoder that slipped, a load that a weak drive does not hold): the reference
/// would come to it for ever, and take it along. So it comes by little first, 1 mm or 1 mrad, and
/// the rest of the way when the arm has not gone along. Real-time safe.
class ReturnToArm {
 public:
  /// Keeps a reference to `model`. `rest_tolerance`: [rad] or [m] by which each joint of an arm
  /// that rests may be told off.
  ReturnToArm(const RobotModel& model, const MotionLimits& limits,
              const JointVector& rest_tolerance);

  /// The next part of the way to an arm that rests at `q`, from where the reference rests; nothing
  /// while it waits for the arm's answer, is there, or `arm_goes_along`.
  std::optional<ShortTrajectory> next_part(const JointVector& from, const JointVector& q, Time now);
  /// Whether the arm went along with the last part: the reference stays where it is.
  bool arm_goes_along() const { return arm_goes_along_; }
  /// The arm is where the reference is, or somebody moves it: it may be returned to again.
  void allow_again() { arm_goes_along_ = false; }
  void forget() {
    last_.reset();
    arm_goes_along_ = false;
  }

 private:
  struct Part {
    JointVector from, to;
    JointVector rested;  // where the arm did
    Time end;
  };
  bool went_along(const JointVector& q, Time now) const;
  double share_to_go(const JointVector& way, Time now) const;

  const RobotModel& model_;
  MotionLimits limits_;
  JointVector first_part_;
  std::optional<Part> last_;
  bool arm_goes_along_ = false;
};

}  // namespace armature
