// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "armature/robot/model/robot_model.hpp"

// Postures at the edges of what an arm can do, found numerically: no word of what the arm is built
// like is needed.
namespace armature {
namespace ik_contract ARMATURE_EXPORT {

using Random = std::mt19937_64;

/// A posture within limits that is singular because of the value of one joint.
struct SingularPosture {
  JointVector q;
  int joint = 0;
};
/// Up to `count` of them, every joint that can make the arm singular alike often: minima of the
/// smallest singular value along that joint, the others anywhere. Where a multiple of 45 degrees is
/// as singular, it is taken exactly.
std::vector<SingularPosture> singular_postures(const RobotModel& model, int count, Random& random);

/// The line about which everything turns: of the first joint, or z of the base when that slides.
struct BaseAxis {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};
BaseAxis base_axis(const RobotModel& model);

/// A ball that the tool cannot leave and whose surface it reaches: around a point of the base axis.
/// Limits of joints that turn are not looked at, those of slides are, and of joints that no whole
/// turn brings back to the same.
struct ReachBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;                // [m]
  std::vector<JointVector> at_rim;  // postures there
};
ReachBall reach_ball(const RobotModel& model, int count, Random& random);

/// Postures within limits whose tool is as far from (or as near to) the centre of the reach ball as
/// it gets around there.
enum class Extreme { farthest, nearest };
std::vector<JointVector> extreme_postures(const RobotModel& model, Extreme extreme, int count,
                                          Random& random);

/// Postures within limits whose tool is on the base axis; fewer than `count` when there are few.
std::vector<JointVector> postures_on_base_axis(const RobotModel& model, int count, Random& random);

/// Postures within limits whose pointing axis (or tool z) is along `up` times the base's z.
std::vector<JointVector> upright_postures(const RobotModel& model, double up, int count,
                                          Random& random);

}  // namespace ik_contract
}  // namespace armature
