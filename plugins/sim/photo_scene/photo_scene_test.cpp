// SPDX-License-Identifier: Apache-2.0
// The scene: 1. the patient moves as told, 2. where the cameras were is known for a while, 3.
// photos are read from files. What draws them is tested in framework/armature/scene.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "armature/values/angles.hpp"
#include "patient.hpp"
#include "photo_file.hpp"
#include "pose_history.hpp"

namespace armature::sim::photo_scene {
namespace {

constexpr const char* kAstronaut =
    "/usr/lib/python3/dist-packages/imageio/resources/images/astronaut.png";

TEST(Patient, TurnsTheFaceNormalFromMinusXUpAndAside) {
  EXPECT_TRUE(face_normal({}).isApprox(Eigen::Vector3d{-1, 0, 0}));
  EXPECT_TRUE(face_normal({.mouth = {}, .tilt_up = 30 * kRadPerDegree, .tilt_side = 0})
                  .isApprox(Eigen::Vector3d{-std::cos(30 * kRadPerDegree), 0, 0.5}, 1e-12));
  EXPECT_TRUE(face_normal({.mouth = {}, .tilt_up = 0, .tilt_side = 30 * kRadPerDegree})
                  .isApprox(Eigen::Vector3d{-std::cos(30 * kRadPerDegree), 0.5, 0}, 1e-12));
}

TEST(Patient, KeepsThePhotoUprightAtEveryTilt) {
  for (double up = -90; up <= 90; up += 15) {
    for (double side = -180; side <= 180; side += 30) {
      const HeadPose pose{
          .mouth = {1, 2, 3}, .tilt_up = up * kRadPerDegree, .tilt_side = side * kRadPerDegree};
      const Eigen::Isometry3d frame = base_T_photo(pose);
      EXPECT_TRUE(frame.linear().isUnitary(1e-12));
      EXPECT_NEAR(frame.linear().determinant(), 1, 1e-12);
      EXPECT_TRUE(frame.linear().col(2).isApprox(-face_normal(pose)));
      EXPECT_NEAR(frame.linear()(2, 0), 0, 1e-12);  // eyes level
      EXPECT_LE(frame.linear()(2, 1), 1e-12);       // its down is not up
      EXPECT_TRUE(frame.translation().isApprox(pose.mouth));
    }
  }
}

TEST(Patient, MovesWithTheVelocityThatItTellsAndStopsWhereItWasTold) {
  const Parameters parameters{.mouth = {1.5, 0, 0.4},
                              .tilt_up = 0.1,
                              .tilt_side = -0.2,
                              .move_at = 2,
                              .move_duration = 1,
                              .move = {0.03, 0.04, 0},
                              .move_tilt_up = 0.1,
                              .move_tilt_side = 0.15};
  EXPECT_TRUE(at(parameters, 1.9).pose.mouth.isApprox(Eigen::Vector3d{1.5, 0, 0.4}));
  EXPECT_TRUE(at(parameters, 99).pose.mouth.isApprox(Eigen::Vector3d{1.53, 0.04, 0.4}));
  EXPECT_DOUBLE_EQ(at(parameters, 99).pose.tilt_side, -0.05);
  EXPECT_TRUE(at(parameters, 99).velocity.isZero());
  constexpr double h = 1e-6;
  for (double t = 2.05; t < 3; t += 0.1) {
    const MovingHead before = at(parameters, t - h), now = at(parameters, t),
                     after = at(parameters, t + h);
    EXPECT_TRUE(now.velocity.isApprox((after.pose.mouth - before.pose.mouth) / (2 * h), 1e-6));
    EXPECT_TRUE(now.normal_rate.isApprox(
        (face_normal(after.pose) - face_normal(before.pose)) / (2 * h), 1e-6));
  }
}

TEST(Patient, KeepsOneSpeedBetweenTwoRamps) {
  const Parameters parameters{.mouth = {1.5, 0, 0.4},
                              .move_at = 2,
                              .move_duration = 3.2,
                              .move_ramp = 0.2,
                              .move = {0, 0.15, 0},
                              .move_tilt_side = 0.3};
  constexpr double h = 1e-6;
  for (double t = 2.03; t < 5.2; t += 0.05) {
    const MovingHead before = at(parameters, t - h), now = at(parameters, t),
                     after = at(parameters, t + h);
    EXPECT_TRUE(now.velocity.isApprox((after.pose.mouth - before.pose.mouth) / (2 * h), 1e-5));
    if (t < 2.2 || t > 5) continue;
    EXPECT_NEAR(now.velocity.y(), 0.05, 1e-12) << t;
    EXPECT_NEAR(now.normal_rate.norm(), 0.1, 1e-12) << t;
  }
  EXPECT_NEAR(at(parameters, 5.2).pose.mouth.y(), 0.15, 1e-12);
  EXPECT_TRUE(at(parameters, 5.2).velocity.isZero());
}

TEST(PoseHistory, TellsPosesBetweenThoseThatItWasGivenAsFarBackAsAsked) {
  PoseHistory history{0.3};
  const auto pose = [](double t_s) {
    Eigen::Isometry3d at{Eigen::AngleAxisd{t_s, Eigen::Vector3d::UnitZ()}};
    at.translation() = Eigen::Vector3d{2 * t_s, 0, -t_s};
    return at;
  };
  const auto at = [](double t_s) { return Time{} + seconds(t_s); };
  for (int i = 0; i <= 10; ++i) history.add(at(0.1 * i), pose(0.1 * i));
  for (const double t : {0.7, 0.75, 0.92, 1.0}) {
    EXPECT_TRUE(history.at(at(t)).isApprox(pose(t), 1e-9)) << t;
  }
  EXPECT_TRUE(history.at(at(0.1)).isApprox(pose(0.7), 1e-9)) << "it is not kept for ever";
  EXPECT_TRUE(history.at(at(5)).isApprox(pose(1), 1e-9));
}

TEST(PhotoFile, OfTheAstronautIsPrintedAtItsScale) {
  ASSERT_TRUE(std::filesystem::exists(kAstronaut)) << "install python3-imageio";
  const auto photo = read_photo(kAstronaut, {203.6, 101.8}, {246.9, 104.0}, {223.1, 144.4}, 0.063);
  ASSERT_TRUE(photo) << photo.error().text;
  EXPECT_EQ(photo->image.width, 512);
  EXPECT_EQ(photo->image.height, 512);
  EXPECT_NEAR(photo->m_per_px * 1e3, 1.453, 0.001);
}

TEST(PhotoFile, ThatCannotBeReadIsRefusedByName) {
  const auto missing = read_photo("no/such.png", {0, 0}, {1, 0}, {0, 1}, 0.063);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().text, "cannot open the photo no/such.png: No such file or directory");

  const std::string broken = testing::TempDir() + "broken.png";
  std::ofstream{broken} << "\x89PNG\r\n\x1a\n and then no chunk";
  const auto unreadable = read_photo(broken, {0, 0}, {1, 0}, {0, 1}, 0.063);
  ASSERT_FALSE(unreadable);
  EXPECT_EQ(
      unreadable.error().text,
      broken +
          " is not an image that can be read: its beginning does not say how many pixels it has");
}

}  // namespace
}  // namespace armature::sim::photo_scene
