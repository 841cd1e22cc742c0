// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/joint_inertia.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

RobotModel loaded(const char* file, std::vector<LinkMass> masses) {
  RobotParts parts =
      load_robot_model(std::string{ARMATURE_SOURCE_DIR "/configs/robots/"} + file).parts();
  parts.masses = std::move(masses);
  return parts;
}

Vector3d place(const RobotModel& model, const LinkMass& mass, const JointVector& q) {
  std::array<Eigen::Isometry3d, kMaxJoints> frames;
  joint_frames(model, q, frames);
  return frames[static_cast<std::size_t>(mass.parent_joint)] * mass.centre;
}

/// Half m v^2 of every mass by differences, and of the drives.
double energy(const RobotModel& model, const JointVector& q, const JointVector& dq) {
  constexpr double kStep_s = 1e-6;
  double sum = 0;
  for (const LinkMass& mass : model.masses()) {
    const Vector3d way =
        place(model, mass, q + kStep_s * dq) - place(model, mass, q - kStep_s * dq);
    sum += 0.5 * mass.mass * (way / (2 * kStep_s)).squaredNorm();
  }
  const JointVector rates = model.to_all(dq) - model.to_all(JointVector::Zero(dq.size()));
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    const double rate = rates[static_cast<Eigen::Index>(i)];
    sum += 0.5 * model.joints()[i].drive_inertia * rate * rate;
  }
  return sum;
}

/// Standard rows with couplings, and modified ones with a slide.
TEST(JointInertia, HalfTheSquareOfTheRatesInItIsTheKineticEnergy) {
  constexpr unsigned kSeed = 1986;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random{kSeed};
  for (const char* file : {"dental_lamp.yaml", "sr1_needle.yaml"}) {
    SCOPED_TRACE(file);
    RobotParts parts = loaded(file, {{"upper", 1, {0.2, 0, 0.1}, 17.4},
                                     {"fore", 3, {0, 0.1, 0}, 4.8},
                                     {"hand", 5, {0.01, 0.02, 0.03}, 0.8}})
                           .parts();
    parts.joints[0].drive_inertia = 1.14;
    const RobotModel model = parts;
    for (int i = 0; i < 100; ++i) {
      const JointVector q = testing::random_joints(model, random),
                        dq = testing::random_joints(model, random);
      const double by_inertia = 0.5 * dq.dot(joint_inertia(model, q) * dq);
      EXPECT_NEAR(by_inertia, energy(model, q, dq), 1e-6 * (1 + by_inertia));
    }
  }
}

TEST(JointInertia, WhatAFileDoesNotStateWeighsNothing) {
  const RobotModel model = loaded("med7.yaml", {});
  EXPECT_EQ(joint_inertia(model, resting_position(model)).norm(), 0);
}

/// Joints 4 and 6 of one axis turn against each other; the sum of what they feel rounds below 0.
TEST(JointInertia, AMoveThatTurnsNothingHasNoLength) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random{kSeed};
  std::uniform_real_distribution<double> any{-2, 2};
  RobotParts parts = loaded("sr1.yaml", {{"hand", 5, {0.07, 0.013, 0.1}, 1.3}}).parts();
  for (Joint& joint : parts.joints) joint.drive_inertia = 0;
  const RobotModel model = parts;
  for (int i = 0; i < 1000; ++i) {
    JointVector to = testing::random_joints(model, random), way = JointVector::Zero(6);
    to[4] = 0;
    way[3] = any(random);
    way[5] = -way[3];
    ASSERT_NEAR(felt_length(model, way, to), 0, 1e-7);
  }
}

}  // namespace
}  // namespace armature
