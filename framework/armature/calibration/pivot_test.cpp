// SPDX-License-Identifier: Apache-2.0
// The tip of a tool that was turned about it.
#include "armature/calibration/pivot.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "armature/calibration/simulated_tracker_test.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

class PivotCalibration : public ::testing::Test {
 protected:
  /// The tool leans by up to `cone_deg` and turns about itself, its tip on `point_`.
  std::vector<Isometry3d> turned(std::size_t count, double cone_deg, double sphere_error_m) {
    tracker_.set_sphere_error(sphere_error_m);
    std::uniform_real_distribution<double> unit{0, 1};
    const auto any = [&] { return unit(tracker_.random()); };
    const double half_cone = cone_deg * std::numbers::pi / 180;
    std::vector<Isometry3d> poses(count);
    for (Isometry3d& pose : poses) {
      const double towards = 2 * std::numbers::pi * any(), turn = 2 * std::numbers::pi * any();
      const double lean = half_cone * std::sqrt(any());
      pose = Eigen::AngleAxisd{towards, Vector3d::UnitZ()} *
             Eigen::AngleAxisd{lean, Vector3d::UnitY()} *
             Eigen::AngleAxisd{turn, Vector3d::UnitZ()};
      pose.translation() = point_ - pose.linear() * tip_;
      pose = tracker_.seen(pose);
    }
    return poses;
  }

  const std::uint64_t seed_ = 21;
  ::testing::ScopedTrace trace_{__FILE__, __LINE__, "seed " + std::to_string(seed_)};
  testing::SimulatedTracker tracker_{seed_, 0};
  const Vector3d tip_{0, 0, -0.15}, point_{0.3, 0.2, 1.5};  // [m]
};

TEST_F(PivotCalibration, IsExactForPosesWithoutError) {
  for (std::size_t trial = 0; trial < 1000; ++trial) {
    const Vector3d tip = tracker_.gauss(0.1), point = tracker_.gauss(1);
    std::vector<Isometry3d> poses(3 + trial % 20);
    for (Isometry3d& pose : poses) {
      pose = tracker_.random_pose(0);
      pose.translation() = point - pose.linear() * tip;
    }
    const auto found = calibrate_pivot(poses);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT((found->tip - tip).norm(), 1e-9);
    EXPECT_LT((found->point - point).norm(), 1e-9);
    EXPECT_LT(found->residual_rms_m, 1e-9);
  }
}

// A tip 150 mm from a body of four spheres, each seen with an error of 0.12 mm rms.
TEST_F(PivotCalibration, ErrsAsLittleAsItShouldAndSaysByHowMuch) {
  struct Row {
    std::size_t poses;
    double cone_deg, rms_m;
  };
  for (const Row& expected :
       {Row{30, 20, 0.28e-3}, Row{30, 45, 0.13e-3}, Row{100, 45, 0.07e-3}, Row{10, 20, 0.55e-3}}) {
    double squares = 0, predicted = 0;
    int beyond = 0;
    constexpr int kTrials = 1000;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto found = calibrate_pivot(turned(expected.poses, expected.cone_deg, 0.12e-3));
      ASSERT_TRUE(found) << found.error().text;
      squares += (found->tip - tip_).squaredNorm();
      predicted += found->tip_error.rms_m * found->tip_error.rms_m;
      if ((found->tip - tip_).norm() > found->tip_error.bound95_m) ++beyond;
    }
    SCOPED_TRACE(expected.poses);
    EXPECT_LE(std::sqrt(squares / kTrials), expected.rms_m);
    EXPECT_NEAR(std::sqrt(squares / predicted), 1, 0.07);
    // Few poses know their own noise badly.
    EXPECT_LT(static_cast<double>(beyond) / kTrials, expected.poses < 20 ? 0.14 : 0.08);
  }
}

TEST_F(PivotCalibration, NamesAPoseWhoseTipSlipped) {
  for (std::size_t trial = 0; trial < 200; ++trial) {
    std::vector<Isometry3d> poses = turned(10 + trial % 7, 45, 0.12e-3);
    const std::size_t wrong = trial % poses.size();
    poses[wrong].pretranslate(0.005 * tracker_.gauss(1).normalized());
    const auto found = calibrate_pivot(poses);
    ASSERT_FALSE(found) << trial;
    const std::string named =
        "pose " + std::to_string(wrong + 1) + " does not fit the others: its tip is ";
    EXPECT_TRUE(found.error().text.starts_with(named)) << trial << ": " << found.error().text;
  }
}

TEST_F(PivotCalibration, DoesNotDoubtPosesThatAreAsGoodAsTheOthers) {
  for (std::size_t trial = 0; trial < 2000; ++trial) {
    const auto found = calibrate_pivot(turned(6 + trial % 20, 45, 0.12e-3));
    ASSERT_TRUE(found) << trial << ": " << found.error().text;
  }
}

TEST_F(PivotCalibration, TellsItsWorstPose) {
  std::vector<Isometry3d> poses = turned(30, 45, 0.12e-3);
  poses[11].pretranslate(Vector3d{0, 0, 0.0008});
  const auto found = calibrate_pivot(poses);
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->worst_pose, 11u);
  EXPECT_NEAR(found->worst_m, 0.0008, 0.0003);
}

TEST_F(PivotCalibration, RefusesWhatDeterminesNothingWithAReason) {
  const std::vector<Isometry3d> good = turned(10, 45, 0.12e-3);
  const auto refusal = [&](auto change) {
    std::vector<Isometry3d> bad = good;
    change(bad);
    const auto found = calibrate_pivot(bad);
    return found ? "" : found.error().text;
  };
  EXPECT_EQ(refusal([](auto& poses) { poses.resize(2); }), "2 poses, at least 3 are needed");
  EXPECT_EQ(refusal([](auto& poses) {
              poses[4].translation().z() = std::numeric_limits<double>::infinity();
            }),
            "pose 5 is not finite");
  EXPECT_EQ(refusal([](auto& poses) { poses[9].linear().setZero(); }), "pose 10 is no rotation");
  const std::string narrow =
      "the body hardly turns, or about one axis only: by 0.0 deg rms about the others, at least "
      "2.0 deg are needed";
  EXPECT_EQ(refusal([](auto& poses) {
              for (Isometry3d& pose : poses) pose.linear().setIdentity();
            }),
            narrow);
  EXPECT_EQ(
      refusal([](auto& poses) {
        double angle = 0;
        for (Isometry3d& pose : poses) {
          pose.linear() = Eigen::AngleAxisd{angle += 0.5, Vector3d{1, 2, 3}.normalized()}.matrix();
        }
      }),
      narrow);
}

TEST_F(PivotCalibration, RefusesATipThatDidNotStandStill) {
  std::vector<Isometry3d> poses = turned(12, 45, 0.12e-3);
  for (Isometry3d& pose : poses) pose.pretranslate(tracker_.gauss(0.02));
  const auto found = calibrate_pivot(poses);
  ASSERT_FALSE(found);
  EXPECT_TRUE(found.error().text.starts_with("the tip did not stand still: "))
      << found.error().text;
}

TEST_F(PivotCalibration, RefusesPosesThatAreTheWrongWayRoundOrInMillimetres) {
  std::vector<Isometry3d> turned_round = turned(12, 45, 0), millimetres = turned_round;
  for (Isometry3d& pose : turned_round) pose = pose.inverse();
  for (Isometry3d& pose : millimetres) pose.translation() *= 1000;
  EXPECT_EQ(calibrate_pivot(turned_round).error().text,
            "the tip lies 1.54 m from the body's origin, at most 1 m; is a transform the wrong way "
            "round, or a unit wrong?");
  EXPECT_EQ(calibrate_pivot(millimetres).error().text,
            "the tip lies 150 m from the body's origin, at most 1 m; is a transform the wrong way "
            "round, or a unit wrong?");
}

TEST_F(PivotCalibration, RefusesARecordSaidTwice) {
  std::vector<Isometry3d> poses(12);
  for (Isometry3d& pose : poses) pose = tracker_.random_pose(0);
  poses[7] = poses[2];
  EXPECT_EQ(calibrate_pivot(poses).error().text, "poses 3 and 8 are one record, said twice");
}

}  // namespace
}  // namespace armature
