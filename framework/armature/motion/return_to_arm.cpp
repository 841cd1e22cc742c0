// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/return_to_arm.hpp"

#include <algorithm>

namespace armature {
namespace {

constexpr double kFirstPart = 10;  // of what a joint that rests may be told off by
constexpr double kGently = 0.1;    // of the accelerations, on that part
constexpr double kNoWay = 1e-6;    // [rad] or [m]
// Within this a drive that is on has gone where the reference came.
constexpr Duration kAnswer = seconds(1);
constexpr Duration kListens = seconds(0.3);  // behind the first part

}  // namespace

ReturnToArm::ReturnToArm(const RobotModel& model, const MotionLimits& limits,
                         const JointVector& rest_tolerance)
    : model_{model}, limits_{limits}, first_part_{kFirstPart * rest_tolerance} {}

std::optional<ShortTrajectory> ReturnToArm::next_part(const JointVector& from, const JointVector& q,
                                                      Time now) {
  arm_goes_along_ = arm_goes_along_ || went_along(q, now);
  if (arm_goes_along_ || (last_ && now - last_->end <= kListens)) return std::nullopt;
  const JointVector way = q.cwiseMax(model_.lower()).cwiseMin(model_.upper()) - from;
  if (way.isZero(kNoWay)) return std::nullopt;
  const double share = share_to_go(way, now);
  const JointVector to = from + share * way;
  const JointVector max_acceleration = (share < 1 ? kGently : 1) * limits_.max_acceleration;
  const ShortTrajectory part = short_move(from, to, limits_.max_velocity, max_acceleration, now, 0);
  last_ = {.from = from, .to = to, .rested = q, .end = part.view().end()};
  return part;
}

/// By half of the last part at least, and by twice at most: farther it was pushed.
bool ReturnToArm::went_along(const JointVector& q, Time now) const {
  if (!last_ || now - last_->end > kAnswer) return false;
  const JointVector part = last_->to - last_->from, went = q - last_->rested;
  Eigen::Index most = 0;
  part.cwiseAbs().maxCoeff(&most);
  const double share = went[most] / part[most];
  return share > 0.5 && share < 2;
}

/// Little of the way, until the arm has not answered.
double ReturnToArm::share_to_go(const JointVector& way, Time now) const {
  const bool has_listened = last_ && now - last_->end <= kAnswer;
  if (has_listened) return 1;
  return std::min(1.0, 1 / way.cwiseQuotient(first_part_).cwiseAbs().maxCoeff());
}

}  // namespace armature
