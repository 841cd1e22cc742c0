// SPDX-License-Identifier: Apache-2.0
// A planned path from a file or a topic: 1. it goes through its poses, from rest to rest, 2. the
// exact text of each error.
#include "pose_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/messages/geometry.hpp"

namespace armature::sim::surgeon {
namespace {

using Eigen::Vector3d;

const std::string kPath =
    "t, x, y, z, qx, qy, qz, qw\n"
    "# into the tissue\n"
    "10, 0.1, 0.2, 0.3, 0, 0, 0, 1\n"
    "10.5, 0.11, 0.2, 0.29, 0, 0, 0.0998334, 0.9950042\n"
    "\n"
    "12, 0.12, 0.21, 0.28, 0, 0, 0.1986693, 0.9800666\n";

std::string error_of(const std::string& text) {
  const auto path = read_pose_path(text, "knife.csv");
  return path ? "" : path.error().text;
}

TEST(PosePath, GoesThroughItsPosesFromRestToRest) {
  const PosePath path = read_pose_path(kPath, "knife.csv").value();
  EXPECT_NEAR(path.duration_s(), 2, 1e-12);
  const auto way = [&](double t) { return Vector3d{path.moved(t).translation()}; };
  EXPECT_LT(way(0).norm(), 1e-12);
  EXPECT_LT((way(0.5) - Vector3d{0.01, 0, -0.01}).norm(), 1e-9);
  EXPECT_LT((way(2) - Vector3d{0.02, 0.01, -0.02}).norm(), 1e-9);
  EXPECT_LT((way(3) - way(2)).norm(), 1e-12) << "it stays at its end";
  EXPECT_LT((way(1e-3) - way(0)).norm(), 1e-6) << "from rest";
  EXPECT_LT((way(2) - way(2 - 1e-3)).norm(), 1e-6) << "to rest";
  for (double t = 0; t < 2; t += 1e-3) ASSERT_LT((way(t + 1e-3) - way(t)).norm(), 1e-4) << t;
  EXPECT_NEAR(Eigen::AngleAxisd{path.moved(0.5).linear()}.angle(), 0.2, 1e-6);
  EXPECT_NEAR(Eigen::AngleAxisd{path.moved(1.25).linear()}.angle(), 0.3, 1e-6);
}

TEST(PosePath, WhatIsNoPathIsToldWithLineAndValue) {
  const std::string first = "0, 0, 0, 0, 0, 0, 0, 1\n";
  EXPECT_EQ(error_of(first + "1, 0, nan, 0, 0, 0, 0, 1\n"),
            "knife.csv:2: y is nan, not a finite number");
  EXPECT_EQ(error_of(first + "1, 0, inf, 0, 0, 0, 0, 1\n"),
            "knife.csv:2: y is inf, not a finite number");
  EXPECT_EQ(error_of(first + "1, 0, here, 0, 0, 0, 0, 1\n"),
            "knife.csv:2: y is 'here', not a number");
  EXPECT_EQ(error_of(first + "1, 0, 0, 0, 0, 0, 1\n"),
            "knife.csv:2: 7 values; a row has 8: t, x, y, z, qx, qy, qz, qw");
  EXPECT_EQ(error_of(first + "0, 0, 0, 0, 0, 0, 0, 1\n"),
            "knife.csv:2: t is 0, not after the 0 of the row before");
  EXPECT_EQ(error_of(first + "1, 0, 0, 0, 0, 0, 0, 0.5\n"),
            "knife.csv:2: the quaternion has length 0.5, not 1");
  EXPECT_EQ(error_of(first), "knife.csv has 1 rows of poses; a path has two at least");
  EXPECT_EQ(load_pose_path("/nowhere/knife.csv").error().text,
            "cannot read '/nowhere/knife.csv': No such file or directory");
  EXPECT_EQ(load_pose_path("/usr").error().text, "cannot read '/usr': it is a folder");
  EXPECT_EQ(load_pose_path("/dev/zero").error().text,
            "cannot read '/dev/zero': it is a device or a pipe, not a file");
}

msg::PoseArray poses_at(std::initializer_list<Vector3d> positions) {
  msg::PoseArray poses;
  for (const Vector3d& position : positions) {
    assign(poses.poses_().emplace_back(), Eigen::Isometry3d{Eigen::Translation3d{position}});
  }
  return poses;
}

std::string error_of(const msg::PoseArray& poses) {
  const auto path = pose_path_through(poses, 0.01, "the path");
  return path ? "" : path.error().text;
}

TEST(PosesWithoutTimes, TakeAsLongAsTheirWaysAtTheMeanSpeedOrTheirTurns) {
  msg::PoseArray poses = poses_at({{0, 0, 0}, {0.01, 0, 0}, {0.01, 0, 0}, {0.01, 0.02, 0}});
  poses.poses_().push_back(poses.poses_().back());
  assign(poses.poses_().back().orientation_(),
         Eigen::Quaterniond{Eigen::AngleAxisd{0.25, Vector3d::UnitZ()}});
  const PosePath path = pose_path_through(poses, 0.01, "the path").value();
  EXPECT_NEAR(path.duration_s(), 1 + 2 + 0.5, 1e-9);
  EXPECT_LT((path.moved(1).translation() - Vector3d{0.01, 0, 0}).norm(), 1e-9);
  EXPECT_LT((path.moved(3).translation() - Vector3d{0.01, 0.02, 0}).norm(), 1e-9);
  EXPECT_NEAR(Eigen::AngleAxisd{path.moved(9).linear()}.angle(), 0.25, 1e-9);
}

TEST(PosesWithoutTimes, ThatAreNoPathAreRefusedWithTheirNumber) {
  EXPECT_EQ(error_of(poses_at({})), "the path has 0 different poses; a path has two at least");
  EXPECT_EQ(error_of(poses_at({{1, 2, 3}, {1, 2, 3}})),
            "the path has 1 different poses; a path has two at least");
  EXPECT_EQ(error_of(poses_at({{0, 0, 0}, {0, std::nan(""), 0}})),
            "pose 2 of the path: a number is not finite");
  EXPECT_EQ(error_of(poses_at({{0, 0, 0}, {0, 1e200, 0}})),
            "pose 2 of the path: the way there has no length");
  msg::PoseArray poses = poses_at({{0, 0, 0}, {0.1, 0, 0}});
  poses.poses_()[0].orientation_().w_(0);
  EXPECT_EQ(error_of(poses), "pose 1 of the path: the quaternion has length 0, not 1");
}

}  // namespace
}  // namespace armature::sim::surgeon
