// SPDX-License-Identifier: Apache-2.0
// Rules proved here:
//  1. composed along tf, every frame is where forward kinematics puts it at the joint sample
//  2. the cameras are where the rig says
//  3. it is one tree: a parent each, one root; a prefix goes before every name, a world above base
//  4. names that tf2 cannot take are refused
#include "frame_tree.hpp"

#include <gtest/gtest.h>

#include "armature/messages/stamp.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "every_robot_test.hpp"
#include "tf_listener_test.hpp"

namespace armature::monitor::rviz {
namespace {

using testing::TfListener;
using Convention = RobotModel::Convention;

constexpr double kSamePose = 1e-12;

FrameTree tree_of(const RobotModel& model, const std::optional<StereoRig>& rig = {},
                  const Parameters& parameters = {}) {
  return FrameTree::make(model, rig, parameters).value();
}

TfListener heard(const FrameTree& tree, const JointVector& q) {
  TfListener listener;
  msg::TFMessage moving, fixed;
  tree.write_moving(q, Time{}, moving);
  tree.write_fixed(Time{}, fixed);
  listener.hear(moving);
  listener.hear(fixed);
  return listener;
}

StereoRig lamp_rig() {
  return load_stereo_rig(std::filesystem::path{ARMATURE_SOURCE_DIR} / "configs/rigs/default.yaml");
}

using FramesOfEveryRobot = testing::EveryRobot;

TEST_P(FramesOfEveryRobot, HasItsFramesWhereForwardKinematicsPutsThem) {
  const RobotModel model = robot();
  const FrameTree tree = tree_of(model);
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random{seed};
  for (int k = 0; k < 200; ++k) {
    const JointVector q = testing::random_joints(model, random);
    const TfListener tf = heard(tree, q);
    for (std::size_t i = 0; i < model.frames().size(); ++i) {
      const Eigen::Isometry3d expected = forward_kinematics(model, q, FrameId{static_cast<int>(i)});
      EXPECT_TRUE(tf.transform("base", model.frames()[i].name).isApprox(expected, kSamePose))
          << model.frames()[i].name;
    }
  }
}

TEST_P(FramesOfEveryRobot, HasOneChainOfJointsFromTheBase) {
  const RobotModel model = robot();
  const TfListener tf = heard(tree_of(model), JointVector::Zero(model.dof()));
  std::string parent = "base";
  std::size_t moved_frames = 0;  // of joints that are away from their axis
  for (int i = 0; i < model.joint_count(); ++i) {
    const std::string& joint = model.joints()[static_cast<std::size_t>(i)].name;
    EXPECT_EQ(tf.parent(joint), parent);
    parent = joint;
    if (!joint_place(model, i).moved_T_joint) continue;
    EXPECT_EQ(tf.parent(joint + "_moved"), joint);
    ++moved_frames;
  }
  EXPECT_EQ(tf.size(), model.joints().size() + model.frames().size() + moved_frames);
}

INSTANTIATE_TEST_SUITE_P(FrameTree, FramesOfEveryRobot, testing::kEveryRobot,
                         [](const auto& test) { return std::string{test.param}; });

TEST(FrameTree, HangsTheCamerasOnTheFrameThatTheRigIsMountedOn) {
  const RobotModel lamp = testing::dental_lamp();
  const StereoRig rig = lamp_rig();
  const JointVector q = *lamp.to_independent(*lamp.home());
  const TfListener tf = heard(tree_of(lamp, rig), q);
  EXPECT_EQ(tf.parent("left_camera_optical"), "tool");
  const Eigen::Isometry3d base_T_left = forward_kinematics(lamp, q) * rig.mount_T_left;
  EXPECT_TRUE(tf.transform("base", "left_camera_optical").isApprox(base_T_left, kSamePose));
  // 60 mm to both sides of the tool, along the light's right, which is the tool's z.
  const auto tool_T = [&](const char* camera) -> Eigen::Vector3d {
    return tf.transform("tool", camera).translation();
  };
  EXPECT_TRUE(tool_T("left_camera_optical").isApprox(Eigen::Vector3d{0, 0, -0.06}, kSamePose));
  EXPECT_TRUE(tool_T("right_camera_optical").isApprox(Eigen::Vector3d{0, 0, 0.06}, kSamePose));
}

/// Two joints; links as a URDF file may call them: as the joint that moves them, or as another.
RobotModel robot_with_links(const std::vector<NamedFrame>& links) {
  std::vector<Joint> joints(2);
  joints[0].name = "link1", joints[0].a = 0.3;
  joints[1].name = "wrist", joints[1].a = 0.2;
  return {{"urdf", Convention::modified, joints, links, FrameId{0}, std::nullopt, std::nullopt}};
}

TEST(FrameTree, LeavesALinkThatIsCalledAsAJointItsName) {
  Eigen::Isometry3d row_T_link{Eigen::AngleAxisd{1, Eigen::Vector3d::UnitX()}};
  row_T_link.translation() = Eigen::Vector3d{0.1, 0.2, 0.3};
  const RobotModel robot = robot_with_links(
      {{"hand", 1, row_T_link}, {"link1", 0, row_T_link}, {"wrist", 0, row_T_link}});
  const FrameTree tree = tree_of(robot, {}, {.frame_prefix = "left/"});
  const JointVector q = Eigen::Vector2d{0.4, -0.7};
  const TfListener tf = heard(tree, q);
  EXPECT_EQ(tree.joint_frame(0), "left/link1_axis");
  EXPECT_EQ(tf.parent("left/link1"), "left/link1_axis");
  EXPECT_EQ(tf.parent("left/wrist_axis"), "left/link1_axis");
  for (int i = 0; i < 3; ++i) {
    const std::string& link = robot.frames()[static_cast<std::size_t>(i)].name;
    EXPECT_TRUE(tf.transform("left/base", "left/" + link)
                    .isApprox(forward_kinematics(robot, q, FrameId{i}), kSamePose))
        << link;
  }
}

TEST(FrameTree, StampsEveryFrameWithTheSample) {
  const RobotModel lamp = testing::dental_lamp();
  msg::TFMessage message;
  tree_of(lamp).write_moving(JointVector::Zero(lamp.dof()), Time{12'345'678'901}, message);
  for (const auto& edge : message.transforms_()) {
    EXPECT_EQ(stamp_of(edge.header_().stamp_()).ns, 12'345'678'901);
  }
}

TEST(FrameTree, PutsAPrefixBeforeItsOwnNamesAndAWorldAboveTheBase) {
  const RobotModel lamp = testing::dental_lamp();
  const Parameters parameters{
      .frame_prefix = "left/", .world_frame = "room", .base_position = {1, 2, 3}};
  const JointVector q = *lamp.to_independent(*lamp.home());
  const TfListener tf = heard(tree_of(lamp, lamp_rig(), parameters), q);
  EXPECT_EQ(tf.parent("left/base"), "room");
  EXPECT_EQ(tf.parent("left/j1"), "left/base");
  EXPECT_EQ(tf.parent("left/left_camera_optical"), "left/tool");
  const Eigen::Isometry3d room_T_tool = Eigen::Translation3d{1, 2, 3} * forward_kinematics(lamp, q);
  EXPECT_TRUE(tf.transform("room", "left/tool").isApprox(room_T_tool, kSamePose));
}

TEST(FrameTree, RefusesNamesThatTf2CannotTake) {
  const RobotModel lamp = testing::dental_lamp();
  const auto reason = [&](const RobotModel& model, const Parameters& parameters) {
    const auto tree = FrameTree::make(model, lamp_rig(), parameters);
    return tree ? std::string{"taken"} : tree.error().text;
  };
  EXPECT_EQ(reason(lamp, {.frame_prefix = "/left/"}),
            "'/left/' begins with '/', which no tf2 frame may");
  EXPECT_EQ(reason(lamp, {.world_frame = "tool"}), "two frames would be called 'tool'");
  EXPECT_EQ(reason(lamp, {.world_frame = "base"}), "two frames would be called 'base'");
  const RobotModel camera_robot{{"r",
                                 Convention::standard,
                                 lamp.joints(),
                                 {{"tool", 5, Eigen::Isometry3d::Identity()},
                                  {"left_camera_optical", 5, Eigen::Isometry3d::Identity()}},
                                 FrameId{0},
                                 std::nullopt,
                                 std::nullopt}};
  EXPECT_EQ(reason(camera_robot, {}), "two frames would be called 'left_camera_optical'");
}

}  // namespace
}  // namespace armature::monitor::rviz
