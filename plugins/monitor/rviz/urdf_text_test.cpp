// SPDX-License-Identifier: Apache-2.0
// The written robot, read again by urdfdom, is the one that forward kinematics moves.
#include "urdf_text.hpp"

#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <filesystem>
#include <map>
#include <random>

#include "armature/robot/files/urdf_robot.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "every_robot_test.hpp"

namespace armature::monitor::rviz {
namespace {

using Eigen::Isometry3d;

constexpr double kSameAsText = 1e-9;

std::string urdf_of(const RobotModel& model, const Parameters& parameters = {}) {
  return urdf_text(model, FrameTree::make(model, std::nullopt, parameters).value());
}

Isometry3d isometry(const urdf::Pose& pose) {
  Isometry3d result = Isometry3d::Identity();
  result.translation() << pose.position.x, pose.position.y, pose.position.z;
  const urdf::Rotation& r = pose.rotation;
  result.linear() = Eigen::Quaterniond{r.w, r.x, r.y, r.z}.toRotationMatrix();
  return result;
}

/// Where urdfdom's tree has a link, with these values of its joints.
Isometry3d root_T_link(const urdf::ModelInterface& urdf, const std::string& name,
                       const std::map<std::string, double>& values) {
  Isometry3d root_T_link = Isometry3d::Identity();
  for (auto link = urdf.getLink(name); link->parent_joint; link = link->getParent()) {
    const urdf::Joint& joint = *link->parent_joint;
    Isometry3d motion = Isometry3d::Identity();
    const Eigen::Vector3d axis{joint.axis.x, joint.axis.y, joint.axis.z};
    if (joint.type == urdf::Joint::PRISMATIC) {
      motion.translation() = values.at(joint.name) * axis;
    } else if (joint.type != urdf::Joint::FIXED) {
      motion.linear() = Eigen::AngleAxisd{values.at(joint.name), axis}.toRotationMatrix();
    }
    root_T_link = isometry(joint.parent_to_joint_origin_transform) * motion * root_T_link;
  }
  return root_T_link;
}

void expect_same_frames(const RobotModel& model) {
  const auto urdf = urdf::parseURDF(urdf_of(model));
  ASSERT_TRUE(urdf);
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random{seed};
  for (int k = 0; k < 50; ++k) {
    const JointVector q = testing::random_joints(model, random);
    const JointVector all = model.to_all(q);
    std::map<std::string, double> values;
    for (int i = 0; i < model.joint_count(); ++i) {
      values[model.joints()[static_cast<std::size_t>(i)].name] = all[i];
    }
    for (std::size_t i = 0; i < model.frames().size(); ++i) {
      const std::string& frame = model.frames()[i].name;
      EXPECT_TRUE(
          root_T_link(*urdf, frame, values)
              .isApprox(forward_kinematics(model, q, FrameId{static_cast<int>(i)}), kSameAsText))
          << frame;
    }
  }
}

using UrdfOfEveryRobot = testing::EveryRobot;

TEST_P(UrdfOfEveryRobot, HasItsFramesWhereForwardKinematicsPutsThem) {
  expect_same_frames(robot());
}

TEST(UrdfText, HasTheFramesOfRobotsWithPlacements) {
  for (const auto convention : {RobotModel::Convention::standard, RobotModel::Convention::modified})
    expect_same_frames(testing::placed_robot(convention, 4));
}

TEST(UrdfText, HasTheFramesOfEveryShippedRobot) {
  const std::filesystem::path folder{ARMATURE_SOURCE_DIR "/configs/robots"};
  int robots = 0;
  for (const auto& file : std::filesystem::directory_iterator{folder}) {
    if (file.path().extension() != ".yaml") continue;
    SCOPED_TRACE(file.path().filename());
    expect_same_frames(load_robot_model(file.path()));
    ++robots;
  }
  EXPECT_GT(robots, 5);
}

TEST_P(UrdfOfEveryRobot, TellsLimitsAndCouplings) {
  const RobotModel model = robot();
  const auto urdf = urdf::parseURDF(urdf_of(model));
  ASSERT_TRUE(urdf);
  for (const Joint& joint : model.joints()) {
    SCOPED_TRACE(joint.name);
    const auto told = urdf->getJoint(joint.name);
    ASSERT_TRUE(told);
    EXPECT_EQ(bool{told->mimic}, joint.coupling.has_value());
    if (joint.coupling) {
      EXPECT_DOUBLE_EQ(told->mimic->multiplier, joint.coupling->ratio);
      EXPECT_DOUBLE_EQ(told->mimic->offset, joint.coupling->offset);
    }
    if (!std::isfinite(joint.lower)) continue;
    EXPECT_DOUBLE_EQ(told->limits->lower, joint.lower);
    EXPECT_DOUBLE_EQ(told->limits->upper, joint.upper);
  }
}

TEST(UrdfText, PutsAPrefixBeforeLinksAndTheWorldAboveTheBase) {
  Parameters parameters;
  parameters.frame_prefix = "left/";
  parameters.world_frame = "hall";
  parameters.base_position = {1, 2, 3};
  const auto urdf = urdf::parseURDF(urdf_of(testing::dental_lamp(), parameters));
  ASSERT_TRUE(urdf);
  EXPECT_EQ(urdf->getRoot()->name, "hall");
  ASSERT_TRUE(urdf->getLink("left/base"));
  EXPECT_TRUE(isometry(urdf->getLink("left/base")->parent_joint->parent_to_joint_origin_transform)
                  .translation()
                  .isApprox(Eigen::Vector3d{1, 2, 3}));
}

INSTANTIATE_TEST_SUITE_P(UrdfText, UrdfOfEveryRobot, testing::kEveryRobot,
                         [](const auto& test) { return std::string{test.param}; });

}  // namespace
}  // namespace armature::monitor::rviz
