// SPDX-License-Identifier: Apache-2.0
// Where the tracker stands and how the body sits on the flange, from poses that both saw.
#include "armature/calibration/hand_eye.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>

#include "armature/calibration/simulated_tracker_test.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Poses = std::vector<HandEyePose>;
using testing::SimulatedTracker;

double difference(const Isometry3d& a, const Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

class HandEyeCalibration : public ::testing::Test {
 protected:
  HandEyeCalibration() { tracker_T_base_ = tracker(0).random_pose(1.5); }

  /// The same one all the time, for its random numbers.
  SimulatedTracker& tracker(double sphere_error_m) {
    tracker_.set_sphere_error(sphere_error_m);
    return tracker_;
  }
  /// A Med 7 that turns its joints by 17 degrees rms about the middle of its work.
  Poses recorded(std::size_t count, double sphere_error_m) {
    static const RobotModel med7 =
        load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml");
    const FrameId flange = *med7.find_frame("flange");
    Poses poses(count);
    for (HandEyePose& pose : poses) {
      JointVector q(7);
      q << 0, 0.5, 0, 1.2, 0, 0.5, 0;
      for (double& value : q) value += tracker_.gauss(0.3).x();
      pose.base_T_flange = forward_kinematics(med7, q, flange);
      pose.tracker_T_body =
          tracker(sphere_error_m).seen(tracker_T_base_ * pose.base_T_flange * flange_T_body_);
    }
    return poses;
  }
  /// By which a point of the base is missed that the tracker saw without error.
  double error_at(const HandEye& found, const Vector3d& point) const {
    return (found.base_T_tracker * (tracker_T_base_ * point) - point).norm();
  }

  const std::uint64_t seed_ = 20;
  ::testing::ScopedTrace trace_{__FILE__, __LINE__, "seed " + std::to_string(seed_)};
  SimulatedTracker tracker_{seed_, 0};
  Isometry3d tracker_T_base_;
  const Isometry3d flange_T_body_ = Eigen::Translation3d{0.06, -0.035, 0.08} *
                                    Eigen::AngleAxisd{0.6, Vector3d{0.3, -0.5, 0.8}.normalized()};
  const Vector3d workspace_{0.5, 0, 0.3};  // [m] a point of the base, where the patient lies
};

TEST_F(HandEyeCalibration, IsExactForPosesWithoutError) {
  for (std::size_t trial = 0; trial < 1000; ++trial) {
    const Isometry3d X = tracker_.random_pose(0.1), Z = tracker_.random_pose(1);
    Poses poses(3 + trial % 20);
    for (HandEyePose& pose : poses) pose.base_T_flange = tracker_.random_pose(0.5);
    for (int axis : {1, 2}) {  // of three random ones two may turn about nearly one axis
      Isometry3d& flange = poses[static_cast<std::size_t>(axis)].base_T_flange;
      flange.linear() =
          (poses[0].base_T_flange.rotation() * rotation_of(Vector3d::Unit(axis))).matrix();
    }
    for (HandEyePose& pose : poses) {
      pose.tracker_T_body = Z.inverse() * pose.base_T_flange * X;
    }
    const auto found = calibrate_hand_eye(poses);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT(difference(found->flange_T_body, X), 1e-9) << trial;
    EXPECT_LT(difference(found->base_T_tracker, Z), 1e-9) << trial;
    EXPECT_LT(found->residual_rms_m, 1e-9);
    EXPECT_LT(found->residual_rms_rad, 1e-9);
  }
}

// The medians of the published linear method of Li, Wang and Wu (2010), in the same scene with
// wider poses: the error at (500, 0, 300) mm for a tracker of 0.12 mm, here along each axis.
TEST_F(HandEyeCalibration, ErrsNoMoreThanTheLinearMethodOfLi) {
  struct Row {
    std::size_t poses;
    double median_m;
  };
  for (const Row& li : {Row{10, 0.20e-3}, Row{20, 0.11e-3}, Row{40, 0.08e-3}}) {
    std::vector<double> errors;
    for (int trial = 0; trial < 150; ++trial) {
      const auto found = calibrate_hand_eye(recorded(li.poses, 0.12e-3 * std::sqrt(3.0)));
      ASSERT_TRUE(found) << found.error().text;
      errors.push_back(error_at(*found, workspace_));
    }
    std::ranges::nth_element(errors, errors.begin() + 75);
    EXPECT_LE(errors[75], li.median_m) << li.poses << " poses";
  }
}

TEST_F(HandEyeCalibration, PredictsTheErrorAtAPointAndOfTheBody) {
  const Vector3d screw{0.02, 0.01, 0.03};  // [m] a point of the body
  for (const std::size_t count : {6u, 12u, 30u}) {
    double squares = 0, predicted = 0, body_squares = 0, body_predicted = 0;
    int beyond = 0;
    constexpr int kTrials = 500;
    for (int trial = 0; trial < kTrials; ++trial) {
      const auto found = calibrate_hand_eye(recorded(count, 0.12e-3));
      ASSERT_TRUE(found) << found.error().text;
      const double off = error_at(*found, workspace_);
      const PointError error = found->error_at(workspace_);
      squares += off * off;
      predicted += error.rms_m * error.rms_m;
      if (off > error.bound95_m) ++beyond;
      body_squares += (found->flange_T_body * screw - flange_T_body_ * screw).squaredNorm();
      body_predicted += std::pow(found->body_error_at(flange_T_body_ * screw).rms_m, 2);
    }
    EXPECT_NEAR(std::sqrt(squares / predicted), 1, 0.08) << count;
    EXPECT_NEAR(std::sqrt(body_squares / body_predicted), 1, 0.08) << count;
    // Few poses know their own noise badly.
    EXPECT_LT(static_cast<double>(beyond) / kTrials, count < 20 ? 0.1 : 0.07) << count;
  }
}

TEST_F(HandEyeCalibration, MeasuresTheTrackersNoise) {
  // Of a rigid fit to four spheres: a half of one sphere's noise, and by the body's size in angles.
  const auto found = calibrate_hand_eye(recorded(400, 0.12e-3));
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_NEAR(found->noise.position_m, 0.12e-3 / std::sqrt(3.0) / 2, 2e-6);
  EXPECT_NEAR(found->residual_rms_m, std::sqrt(3.0) * found->noise.position_m, 2e-6);
  EXPECT_NEAR(found->residual_rms_rad, std::sqrt(3.0) * found->noise.rotation_rad, 2e-5);
  EXPECT_NEAR(found->noise.rotation_rad, 1.5e-3, 0.2e-3);
}

TEST_F(HandEyeCalibration, WithAStatedNoiseTheErrorIsPredictedFromIt) {
  const Poses poses = recorded(20, 0.12e-3);
  const PoseNoise stated{0.1e-3, 2e-3};
  const auto once = calibrate_hand_eye(poses, {.noise = stated});
  const auto twice = calibrate_hand_eye(poses, {.noise = PoseNoise{0.2e-3, 4e-3}});
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(once->noise.position_m, stated.position_m);
  EXPECT_NEAR(twice->error_at(workspace_).rms_m / once->error_at(workspace_).rms_m, 2, 1e-9);
  EXPECT_LT(difference(once->base_T_tracker, twice->base_T_tracker), 1e-12);
  EXPECT_GT(difference(once->base_T_tracker, calibrate_hand_eye(poses)->base_T_tracker), 1e-9);
}

TEST_F(HandEyeCalibration, DoesNotDependOnWhereTheFramesStand) {
  const Poses poses = recorded(10, 0.12e-3);
  const auto found = calibrate_hand_eye(poses);
  ASSERT_TRUE(found);
  for (int trial = 0; trial < 100; ++trial) {
    const Isometry3d base = tracker_.random_pose(1), tracker = tracker_.random_pose(1),
                     flange = tracker_.random_pose(0.2);
    Poses moved = poses;
    for (HandEyePose& pose : moved) {
      pose.base_T_flange = base * pose.base_T_flange * flange;
      pose.tracker_T_body = tracker * pose.tracker_T_body;
    }
    const auto again = calibrate_hand_eye(moved);
    ASSERT_TRUE(again) << again.error().text;
    EXPECT_LT(difference(again->flange_T_body, flange.inverse() * found->flange_T_body), 1e-8);
    EXPECT_LT(difference(again->base_T_tracker, base * found->base_T_tracker * tracker.inverse()),
              1e-8);
    EXPECT_NEAR(again->residual_rms_m, found->residual_rms_m, 1e-9);
    EXPECT_NEAR(again->error_at(base * workspace_).rms_m, found->error_at(workspace_).rms_m, 1e-8);
  }
}

TEST_F(HandEyeCalibration, TellsItsWorstPoseAndTheSpread) {
  Poses poses = recorded(30, 0.12e-3);
  poses[17].tracker_T_body.translation() += Vector3d{0.00015, 0, 0};
  const auto found = calibrate_hand_eye(poses);
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_EQ(found->worst_pose, 17u);
  EXPECT_GT(found->worst_m, 0.0001);
  EXPECT_GT(found->spread_rad, 0.2);
  EXPECT_LT(found->spread_rad, 1);
}

TEST_F(HandEyeCalibration, NamesAPoseThatDoesNotFitTheOthers) {
  const std::function<void(Poses&, std::size_t)> mistakes[]{
      [&](Poses& poses, std::size_t i) {
        poses[i].tracker_T_body.translation() += 0.002 * tracker_.gauss(1).normalized();
      },
      [&](Poses& poses, std::size_t i) {
        poses[i].tracker_T_body.rotate(rotation_of(0.05 * tracker_.gauss(1).normalized()));
      },
      [&](Poses& poses, std::size_t i) { poses[i].tracker_T_body = tracker_.random_pose(1); },
      [&](Poses& poses, std::size_t i) {
        poses[i].base_T_flange = poses[(i + 1) % poses.size()].base_T_flange;
      }};
  for (std::size_t trial = 0; trial < 400; ++trial) {
    Poses poses = recorded(10 + trial % 7, 0.12e-3);
    const std::size_t wrong = trial % poses.size();
    mistakes[trial % 4](poses, wrong);
    const auto found = calibrate_hand_eye(poses);
    ASSERT_FALSE(found) << trial;
    const std::string named = "pose " + std::to_string(wrong + 1) + " does not fit the others: ";
    EXPECT_TRUE(found.error().text.starts_with(named)) << trial << ": " << found.error().text;
  }
}

TEST_F(HandEyeCalibration, DoesNotDoubtPosesThatAreAsGoodAsTheOthers) {
  for (std::size_t trial = 0; trial < 1000; ++trial) {
    HandEyeOptions options;
    if (trial % 2 == 0) options.noise = PoseNoise{0.035e-3, 1.6e-3};  // about what it is
    const auto found = calibrate_hand_eye(recorded(4 + trial % 10, 0.12e-3), options);
    if (found) continue;  // four random ones may turn about one axis only
    EXPECT_TRUE(found.error().text.starts_with("the flange turns"))
        << trial << ": " << found.error().text;
  }
}

TEST_F(HandEyeCalibration, ATrackerThatErrsInPositionOnlyIsNeitherDoubtedNorFlattered) {
  constexpr double kNoise_m = 1e-4;
  int accused = 0;
  double told = 0;
  constexpr int kTrials = 50;
  for (int trial = 0; trial < kTrials; ++trial) {
    Poses poses = recorded(20, 0);
    for (HandEyePose& pose : poses) pose.tracker_T_body.translation() += tracker_.gauss(kNoise_m);
    const auto found = calibrate_hand_eye(poses);
    if (!found) {
      ++accused;
      continue;
    }
    told += found->noise.position_m / kTrials;
    EXPECT_LT(found->noise.rotation_rad, kNoise_m) << "rotations err less than they are said to";
  }
  EXPECT_EQ(accused, 0);
  EXPECT_NEAR(told, kNoise_m, 0.1 * kNoise_m);
}

TEST_F(HandEyeCalibration, RefusesWhatDeterminesNothingWithAReason) {
  const Poses good = recorded(10, 0.12e-3);
  const auto refusal = [&](auto change) {
    Poses bad = good;
    change(bad);
    const auto found = calibrate_hand_eye(bad);
    return found ? "" : found.error().text;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal([](auto& poses) { poses.clear(); }), "0 poses, at least 3 are needed");
  EXPECT_EQ(refusal([](auto& poses) { poses.resize(2); }), "2 poses, at least 3 are needed");
  EXPECT_EQ(refusal([&](auto& poses) { poses[3].base_T_flange.translation().y() = nan; }),
            "base_T_flange of pose 4 is not finite");
  EXPECT_EQ(refusal([&](auto& poses) { poses[9].tracker_T_body.linear()(1, 1) = nan; }),
            "tracker_T_body of pose 10 is not finite");
  EXPECT_EQ(refusal([](auto& poses) { poses[0].tracker_T_body.linear() *= 1.001; }),
            "tracker_T_body of pose 1 is no rotation");
  EXPECT_EQ(refusal([](auto& poses) { poses[1].base_T_flange.linear() *= -1; }),
            "base_T_flange of pose 2 is no rotation");
  EXPECT_EQ(calibrate_hand_eye(good, {.noise = PoseNoise{0, 0.001}}).error().text,
            "the stated noise is 0 m, 0.001 rad; both must be positive");
}

TEST_F(HandEyeCalibration, RefusesOrientationsThatDoNotSpread) {
  const auto refusal = [&](const std::function<Eigen::Quaterniond()>& turn) {
    Poses poses(12);
    const Isometry3d first = tracker_.random_pose(0.5);
    for (HandEyePose& pose : poses) {
      pose.base_T_flange = first;
      pose.base_T_flange.pretranslate(tracker_.gauss(0.2));
      pose.base_T_flange.rotate(turn());
      pose.tracker_T_body =
          tracker(0.12e-3).seen(tracker_T_base_ * pose.base_T_flange * flange_T_body_);
    }
    const auto found = calibrate_hand_eye(poses);
    return found ? "" : found.error().text;
  };
  const Vector3d axis = tracker_.gauss(1).normalized();
  EXPECT_EQ(refusal([] { return Eigen::Quaterniond::Identity(); }),
            "the flange hardly turns: by 0.0 deg rms, at least 2.0 deg are needed");
  EXPECT_EQ(
      refusal([&] { return rotation_of(tracker_.gauss(3).x() * axis); }),
      "the flange turns about one axis only: by 0.0 deg rms about the next one, at least 2.0 deg "
      "are needed");
  EXPECT_EQ(
      refusal([&] { return rotation_of(tracker_.gauss(0.5).x() * axis); }),
      "the flange turns about one axis only: by 0.0 deg rms about the next one, at least 2.0 deg "
      "are needed");
  EXPECT_EQ(refusal([&] { return rotation_of(tracker_.gauss(0.5)); }), "");
}

TEST_F(HandEyeCalibration, RefusesPosesThatDoNotBelongTogether) {
  Poses turned_round = recorded(12, 0.12e-3), millimetres = turned_round;
  for (HandEyePose& pose : turned_round) pose.tracker_T_body = pose.tracker_T_body.inverse();
  for (HandEyePose& pose : millimetres) pose.tracker_T_body.translation() *= 1000;
  for (const Poses& poses : {turned_round, millimetres}) {
    const auto found = calibrate_hand_eye(poses);
    ASSERT_FALSE(found);
    EXPECT_TRUE(found.error().text.starts_with("the poses do not belong together: "))
        << found.error().text;
    EXPECT_TRUE(
        found.error().text.ends_with("is a transform the wrong way round, or a unit wrong?"));
  }
}

TEST_F(HandEyeCalibration, TellsByHowMuchTheTrackersLengthsAreNotTheArms) {
  for (const double scale : {0.98, 0.995, 1.002, 1.005, 1.02}) {
    Poses poses = recorded(20, 0.12e-3);
    for (HandEyePose& pose : poses) pose.tracker_T_body.translation() *= scale;
    for (const bool states : {false, true}) {
      HandEyeOptions options;
      if (states) options.noise = PoseNoise{0.035e-3, 1.6e-3};
      const auto found = calibrate_hand_eye(poses, options);
      ASSERT_FALSE(found)
          << scale << ": the body is off by "
          << (found->flange_T_body.translation() - flange_T_body_.translation()).norm();
      double told = 0;
      ASSERT_EQ(std::sscanf(found.error().text.c_str(),
                            "the tracker's lengths are %lf times the arm's; ", &told),
                1)
          << scale << ": " << found.error().text;
      EXPECT_NEAR(told, scale, 0.001);
    }
  }
}

TEST_F(HandEyeCalibration, NamesNoSinglePoseWhereAllErrMoreThanIsStated) {
  const Poses poses = recorded(20, 0.6e-3);
  const auto found = calibrate_hand_eye(poses, {.noise = PoseNoise{0.035e-3, 1.6e-3}});
  ASSERT_FALSE(found);
  EXPECT_TRUE(found.error().text.starts_with("all poses together show a noise of "))
      << found.error().text;
  EXPECT_TRUE(calibrate_hand_eye(poses));
}

TEST_F(HandEyeCalibration, RefusesARecordSaidTwiceButNotAPostureMeasuredTwice) {
  Poses poses = recorded(12, 0.1e-3);
  poses[5].base_T_flange = poses[2].base_T_flange;
  poses[5].tracker_T_body = poses[2].tracker_T_body;
  EXPECT_EQ(calibrate_hand_eye(poses).error().text, "poses 3 and 6 are one record, said twice");
  poses[5].tracker_T_body.translation().x() += 1e-5;
  EXPECT_TRUE(calibrate_hand_eye(poses));
}

}  // namespace
}  // namespace armature
