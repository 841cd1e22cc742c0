// SPDX-License-Identifier: Apache-2.0
// The drawn robot is the one that forward kinematics moves.
#include "robot_shape.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "armature/robot/kinematics/kinematics.hpp"
#include "every_robot_test.hpp"

namespace armature::monitor::rviz {
namespace {

using Convention = RobotModel::Convention;
using Eigen::Vector3d;

constexpr double kExact = 1e-12;  // [m]

/// The parts by id, in the base frame.
std::map<int, Segment> placed(const RobotModel& model, const JointVector& q) {
  std::array<Eigen::Isometry3d, kMaxJoints> base_T_joint;
  joint_frames(model, q, base_T_joint);
  std::map<int, Segment> parts;
  for (const RobotPart& part : robot_shape(model, q)) {
    const Eigen::Isometry3d base_T_frame = part.frame < 0
                                               ? Eigen::Isometry3d::Identity()
                                               : base_T_joint[static_cast<std::size_t>(part.frame)];
    const bool is_new = parts
                            .emplace(part.id, Segment{base_T_frame * part.segment.from,
                                                      base_T_frame * part.segment.to})
                            .second;
    EXPECT_TRUE(is_new) << "two parts with the id " << part.id;
  }
  return parts;
}

using ShapeOfEveryRobot = testing::EveryRobot;

void expect_unbroken(const RobotModel& model) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random{seed};
  for (int k = 0; k < 50; ++k) {
    const JointVector q = testing::random_joints(model, random);
    std::array<Eigen::Isometry3d, kMaxJoints> base_T_joint;
    joint_frames(model, q, base_T_joint);
    const auto parts = placed(model, q);
    Vector3d at = Vector3d::Zero();
    const auto follow = [&](int id) {
      const auto part = parts.find(id);
      if (part == parts.end()) return;  // it has no length
      EXPECT_LT((part->second.from - at).norm(), kExact) << "part " << id;
      at = part->second.to;
    };
    for (int i = 0; i < model.joint_count(); ++i) {
      const bool d_first = model.convention() == Convention::standard;
      follow(4 * i + 3);
      follow(4 * i + (d_first ? 0 : 1));
      follow(4 * i + (d_first ? 1 : 0));
      EXPECT_LT((base_T_joint[static_cast<std::size_t>(i)].translation() - at).norm(), kExact);
    }
  }
}

TEST_P(ShapeOfEveryRobot, IsOneUnbrokenLineThroughTheFramesOfAllJoints) {
  expect_unbroken(robot());
}

TEST(RobotShape, IsUnbrokenWherePlacementsStandInFrontOfRows) {
  for (const Convention convention : {Convention::standard, Convention::modified})
    expect_unbroken(testing::placed_robot(convention, 4));
}

TEST_P(ShapeOfEveryRobot, HasEveryJointsBodyOnItsAxis) {
  const RobotModel model = robot();
  std::mt19937 random{5};
  const JointVector q = testing::random_joints(model, random);
  for (int i = 0; i < model.dof(); ++i) {
    // What moves when the joint alone does leaves its axis where it was.
    const int joint = model.independent_joint(i);
    JointVector moved = q;
    moved[i] += 0.1;
    const Segment before = placed(model, q).at(4 * joint + 2);
    const Segment after = placed(model, moved).at(4 * joint + 2);
    EXPECT_LT((before.from - after.from).norm(), kExact);
    EXPECT_LT((before.to - after.to).norm(), kExact);
    EXPECT_NEAR((before.to - before.from).norm(), 1, kExact);
    const auto [pose, jacobian] = forward_kinematics_with_jacobian(model, q, model.tool());
    if (model.joints()[static_cast<std::size_t>(joint)].coupling) continue;
    const Vector3d axis = (before.to - before.from).normalized();
    const Vector3d on_axis = 0.5 * (before.from + before.to);
    bool leads = false;  // a joint that others follow has their columns too
    for (const Joint& other : model.joints())
      leads |= other.coupling && other.coupling->to == joint;
    if (leads) continue;
    const Vector3d expected =
        model.is_revolute(i) ? Vector3d{axis.cross(pose.translation() - on_axis)} : axis;
    EXPECT_LT((jacobian.col(i).head<3>() - expected).norm(), 1e-9) << "joint " << joint;
  }
}

INSTANTIATE_TEST_SUITE_P(RobotShape, ShapeOfEveryRobot, testing::kEveryRobot,
                         [](const auto& test) { return std::string{test.param}; });

TEST(RobotShape, KeepsTheIdsOfItsPartsWhereverTheJointsAre) {
  const RobotModel robot = testing::synthetic_robot(Convention::standard, 9);
  std::mt19937 random{9};
  const auto ids = [&](const JointVector& q) {
    std::vector<int> all;
    for (const RobotPart& part : robot_shape(robot, q)) all.push_back(part.id);
    return all;
  };
  EXPECT_EQ(ids(testing::random_joints(robot, random)), ids(JointVector::Zero(robot.dof())));
}

TEST(RobotShape, IsAsThickAsTheTableOfTheLampIsLong) {
  EXPECT_NEAR(link_radius(testing::dental_lamp()), 0.012 * 2.59407, 1e-11);
}

}  // namespace
}  // namespace armature::monitor::rviz
