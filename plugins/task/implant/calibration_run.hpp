// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arm_rest.hpp"
#include "armature/calibration/hand_eye.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "pose_average.hpp"
#include "sighting.hpp"
#include "task_implant_parameters.hpp"

namespace armature::task::implant {

/// The arm goes from pose to pose; at each the tracker's samples of the body on its flange are
/// averaged. A pose that the arm cannot reach, at which it does not stand still, or at which the
/// body is not seen, is left out.
class CalibrationRun {
 public:
  CalibrationRun(const Parameters& parameters, const RobotModel& robot);

  /// The pose to go to, of the tool as the robot file has it; none when all are done.
  std::optional<ToolPose> destination() const;
  int number() const { return at_ + 1; }
  int count() const { return static_cast<int>(goals_.size()); }

  /// The arm stands at the destination since `now`.
  void arrive(Time now);
  /// The arm cannot go there.
  void leave_out(const std::string& why);
  /// With where the flange is as the arm says, and how still one is that stands.
  void see(const Sighting& sighting, const Eigen::Isometry3d& base_T_flange,
           const Stillness& still);
  void update(Time now);

  const std::vector<HandEyePose>& poses() const { return poses_; }
  /// The last pose left out and why, or "".
  const std::string& left_out() const { return left_out_; }
  /// That too few poses can be had, with the reason of the last one left out, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  void next();

  Parameters parameters_;
  std::vector<ToolPose> goals_;
  int at_ = 0;
  std::optional<Time> arrived_;
  BodyWatch watch_;
  PoseAverage average_;
  Eigen::Isometry3d base_T_flange_ = Eigen::Isometry3d::Identity();  // since the average began
  std::vector<HandEyePose> poses_;
  std::string left_out_, trouble_;
};

}  // namespace armature::task::implant
