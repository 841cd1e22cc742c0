// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/pose_in_base.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature {
namespace {

msg::PoseStamped stamped_pose() {
  msg::PoseStamped message;
  write_header(message.header_(), Time{}, kBaseFrame);
  assign(message.pose_().position_(), Eigen::Vector3d{1, 2, 3});
  assign(message.pose_().orientation_(), Eigen::Quaterniond{0.6, 0, 0.8, 0});
  return message;
}

TEST(PoseInBase, IsReadFromPosesAndTransforms) {
  const Eigen::Isometry3d wanted =
      Eigen::Translation3d{1, 2, 3} * Eigen::Quaterniond{0.6, 0, 0.8, 0};
  EXPECT_TRUE(pose_in_base(stamped_pose(), "it")->isApprox(wanted, 1e-15));
  msg::TransformStamped transform;
  write_header(transform.header_(), Time{}, kBaseFrame);
  assign(transform.transform_(), wanted);
  EXPECT_TRUE(pose_in_base(transform, "it")->isApprox(wanted, 1e-15));
}

TEST(PoseInBase, AQuaternionThatIsNearlyAUnitIsMadeOne) {
  msg::PoseStamped message = stamped_pose();
  message.pose_().orientation_().w_(0.602);
  EXPECT_NEAR(pose_in_base(message, "it")->linear().determinant(), 1, 1e-15);
}

TEST(PoseInBase, IsRefusedByName) {
  msg::PoseStamped message = stamped_pose();
  message.header_().frame_id_() = "camera";
  EXPECT_EQ(pose_in_base(message, "the leader").error().text,
            "the leader is stated in frame 'camera', not in 'base'");
  message = stamped_pose();
  message.pose_().position_().y_(NAN);
  EXPECT_EQ(pose_in_base(message, "the leader").error().text,
            "the leader's position is not finite");
  message = stamped_pose();
  message.pose_().orientation_() = {};
  EXPECT_EQ(pose_in_base(message, "the leader").error().text,
            "the leader's quaternion has length 0, not 1");
}

}  // namespace
}  // namespace armature
