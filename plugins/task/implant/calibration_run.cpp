// SPDX-License-Identifier: Apache-2.0
#include "calibration_run.hpp"

#include <fmt/format.h>

#include "armature/robot/kinematics/kinematics.hpp"
#include "calibration_poses.hpp"

namespace armature::task::implant {

CalibrationRun::CalibrationRun(const Parameters& parameters, const RobotModel& robot)
    : parameters_{parameters}, watch_{"the flange", seconds(parameters.timeout)} {
  for (const JointVector& q :
       calibration_poses(robot, parameters.calibration_poses, parameters.calibration_spread)) {
    const Eigen::Isometry3d base_T_tool = forward_kinematics(robot, q);
    goals_.push_back({base_T_tool.translation(), Eigen::Quaterniond{base_T_tool.linear()}});
  }
}

std::optional<ToolPose> CalibrationRun::destination() const {
  if (at_ == count()) return std::nullopt;
  return goals_[static_cast<std::size_t>(at_)];
}

void CalibrationRun::arrive(Time now) {
  if (arrived_) return;
  arrived_ = now;
  watch_.begin(now);
}

void CalibrationRun::see(const Sighting& sighting, const Eigen::Isometry3d& base_T_flange,
                         const Stillness& still) {
  if (!arrived_ || sighting.stamp < *arrived_) return;
  const bool moved = still.is_left(base_T_flange_, base_T_flange);
  if (!watch_.see(sighting, !moved)) return;
  if (moved && sighting.stamp - *arrived_ > kRestsWithin) {
    return leave_out(restless(base_T_flange_, base_T_flange));
  }
  if (average_.count() == 0 || moved) {
    average_.clear();
    base_T_flange_ = base_T_flange;
  }
  average_.add(*sighting.tracker_T_body);
  if (average_.count() < parameters_.samples_per_pose) return;
  poses_.push_back({base_T_flange, average_.mean()});
  next();
}

void CalibrationRun::update(Time now) {
  if (!arrived_) return;
  if (const auto blind = watch_.blind(now)) leave_out(*blind);
}

void CalibrationRun::leave_out(const std::string& why) {
  left_out_ = fmt::format("pose {}: {}", number(), why);
  next();
  const int most = static_cast<int>(poses_.size()) + count() - at_;
  if (most < parameters_.min_poses) {
    trouble_ = fmt::format("{} of {} poses at most, {} are needed; {}", most, count(),
                           parameters_.min_poses, left_out_);
  }
}

void CalibrationRun::next() {
  arrived_.reset();
  average_.clear();
  ++at_;
}

}  // namespace armature::task::implant
