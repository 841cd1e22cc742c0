// SPDX-License-Identifier: Apache-2.0
// Three points: 1. the laws of its kind, 2. the paper's figures, 3. the stated
// uncertainty is what noise produces, 4. every guard says what is wrong.
#include "three_point.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "armature/config/problems.hpp"
#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/face_pose/contract.hpp"

namespace armature::face_pose::three_point {

INSTANTIATE_TEST_SUITE_P(ThreePoint, FacePoseLaws,
                         testing::Values(FacePoseSubject{
                             "default", std::make_shared<ThreePoint>(Parameters{})}));

namespace {

using Eigen::Vector2d, Eigen::Vector3d;

const StereoCamera kDefault{
    .width = 1280, .height = 720, .focal_px = 914, .cx = 639.5, .cy = 359.5, .baseline_m = 0.12};
const StereoCamera kPaper{.width = 1000,
                          .height = 1000,
                          .focal_px = 787.4015748,
                          .cx = 500,
                          .cy = 500,
                          .baseline_m = 0.024};

struct Features {
  Vector2d left_eye, right_eye, mouth;
};

FaceLandmarks landmarks(const Features& features, double sigma = 0.3) {
  FaceLandmarks face;
  face.points.assign(68, {.point = Vector2d::Zero(), .sigma = sigma});
  for (std::size_t i = 36; i <= 41; ++i) face.points[i].point = features.left_eye;
  for (std::size_t i = 42; i <= 47; ++i) face.points[i].point = features.right_eye;
  for (const std::size_t i : {60, 62, 64, 66}) face.points[i].point = features.mouth;
  return face;
}

Eigen::Isometry3d placed(const Vector3d& position, double yaw, double pitch) {
  return Eigen::Translation3d{position} *
         (Eigen::AngleAxisd{yaw, Vector3d::UnitY()} * Eigen::AngleAxisd{pitch, Vector3d::UnitX()});
}

TEST(ThreePoint, RecoversTheExactPoseFromExactLandmarks) {
  ThreePoint estimator{{}};
  std::mt19937_64 random{4711};
  std::uniform_real_distribution<double> unit{-1, 1};
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Isometry3d pose =
        placed({0.1 * unit(random), 0.1 * unit(random), 0.6 + 0.3 * unit(random)},
               0.8 * unit(random), 0.8 * unit(random));
    PluginState state;
    const auto face = estimator.estimate(exact_face(kDefault, pose), state);
    ASSERT_TRUE(face) << "seed 4711, round " << i << ": " << face.error().text;
    EXPECT_LT((face->mouth - pose.translation()).norm(), 1e-10) << "seed 4711, round " << i;
    EXPECT_LT((face->normal + pose.linear().col(2)).norm(), 1e-9) << "seed 4711, round " << i;
  }
}

TEST(ThreePoint, AveragesLandmarksWithoutRounding) {
  ThreePoint estimator{{}};
  PluginState state;
  FacePoseInput in = exact_face(kDefault, placed({0, 0, 0.5}, 0, 0));
  in.landmarks.left.points[60].point.x() += 0.8;  // one of four
  const auto face = estimator.estimate(in, state);
  ASSERT_TRUE(face);
  const double disparity = 914 * 0.12 / 0.5 + 0.2;
  EXPECT_NEAR(face->mouth.z(), 914 * 0.12 / disparity, 1e-12);
}

// Section 5: pixels as printed; frame 7 has x along the view, y up, z to the image's right, and its
// origin between the cameras.
TEST(ThreePoint, GivesThePapersCoordinatesAndNormal) {
  ThreePoint estimator{{}};
  PluginState state;
  const FacePoseInput in{.left = {},
                         .right = {},
                         .landmarks = {landmarks({{438, 353}, {603, 351}, {523, 498}}),
                                       landmarks({{400, 353}, {565, 350}, {484, 498}})},
                         .camera = kPaper};
  const auto face = estimator.estimate(in, state);
  ASSERT_TRUE(face) << face.error().text;
  const auto frame7 = [](const Vector3d& p) {
    return Vector3d{p.z(), -p.y(), p.x() - 0.5 * kPaper.baseline_m};
  };
  const auto near = [&](const Vector3d& p, const Vector3d& printed_mm) {
    return (frame7(p) * 1e3 - printed_mm).cwiseAbs().maxCoeff() < 1e-4;
  };
  EXPECT_TRUE(near(face->left_eye, {497.3063, 92.8421, -51.1579}));
  EXPECT_TRUE(near(face->right_eye, {497.3063, 94.4211, 53.0526}));  // 41.0526 is a misprint
  EXPECT_TRUE(near(face->mouth, {484.5548, 1.2308, 2.1538}));
  const Vector3d normal{face->normal.z(), -face->normal.y(), face->normal.x()};
  EXPECT_LT((normal - Vector3d{-0.9906132, 0.1366790, -0.0020709}).norm(), 1e-6);
}

TEST(ThreePoint, StatesTheUncertaintyThatNoiseProduces) {
  for (const StereoCamera& camera : {kDefault, kPaper}) {
    ThreePoint estimator{{}};
    PluginState state;
    std::mt19937_64 random{99};
    std::normal_distribution<double> noise{0, 0.1};
    const auto pose = placed({0.1, 0.05, 0.5}, 0.3, 0.2);
    Eigen::Matrix3d mouth = Eigen::Matrix3d::Zero(), normal = Eigen::Matrix3d::Zero();
    FacePoseInput still = exact_face(camera, pose);
    for (FaceLandmarks* face : {&still.landmarks.left, &still.landmarks.right}) {
      for (Landmark& landmark : face->points) landmark.sigma = 0.1;
    }
    const FacePose exact = estimator.estimate(still, state).value();
    constexpr int kRuns = 4000;
    for (int i = 0; i < kRuns; ++i) {
      const auto noisy = [&](const Vector2d& p) {
        return Vector2d{p.x() + noise(random), p.y() + noise(random)};
      };
      const auto features = [&](const FaceLandmarks& f) {
        return landmarks(
            {noisy(f.points[36].point), noisy(f.points[42].point), noisy(f.points[60].point)});
      };
      FacePoseInput in = exact_face(camera, pose);
      in.landmarks = {features(in.landmarks.left), features(in.landmarks.right)};
      const auto face = estimator.estimate(in, state);
      ASSERT_TRUE(face) << face.error().text;
      const Vector3d mouth_error = face->mouth - exact.mouth, turn = face->normal - exact.normal;
      mouth += mouth_error * mouth_error.transpose() / kRuns;
      normal += turn * turn.transpose() / kRuns;
    }
    EXPECT_LT((mouth - exact.mouth_covariance).norm(), 0.1 * exact.mouth_covariance.norm());
    EXPECT_LT((normal - exact.normal_covariance).norm(), 0.15 * exact.normal_covariance.norm());
  }
}

TEST(ThreePoint, TellsByHowManyRowsThePicturesDiffer) {
  ThreePoint estimator{{}};
  PluginState state;
  FacePoseInput in = exact_face(kDefault, placed({0, 0, 0.5}, 0, 0));
  EXPECT_NEAR(estimator.estimate(in, state).value().residual_px, 0, 1e-9);
  for (Landmark& landmark : in.landmarks.right.points) landmark.point.y() += 2;
  EXPECT_NEAR(estimator.estimate(in, state).value().residual_px, 2, 1e-9);
}

struct Guard {
  std::string name;
  std::function<void(FacePoseInput&)> spoil;
  FaceRefusal code;
  std::string reason;
};

class ThreePointGuards : public testing::TestWithParam<Guard> {};

TEST_P(ThreePointGuards, RefuseWithTheReason) {
  ThreePoint estimator{{}};
  PluginState state;
  FacePoseInput in = exact_face(kDefault, placed({0, 0, 0.5}, 0, 0));
  GetParam().spoil(in);
  const auto face = estimator.estimate(in, state);
  ASSERT_FALSE(face);
  EXPECT_THAT(face.error().text, testing::HasSubstr(GetParam().reason));
  EXPECT_EQ(face.error().code, static_cast<int>(GetParam().code));
}

void shift_mouth(FacePoseInput& in, double du, double dv) {
  for (const std::size_t i : {60, 62, 64, 66})
    in.landmarks.right.points[i].point += Vector2d{du, dv};
}

INSTANTIATE_TEST_SUITE_P(
    All, ThreePointGuards,
    testing::Values(
        Guard{"disparity", [](FacePoseInput& in) { shift_mouth(in, 230, 0); },
              FaceRefusal::implausible,
              "the mouth has a disparity of -10.64 px, not a positive one: are the left and the "
              "right "
              "camera exchanged?"},
        Guard{"near", [](FacePoseInput& in) { shift_mouth(in, -500, 0); }, FaceRefusal::implausible,
              "the mouth would be 0.152 m away, outside 0.2 to 2 m"},
        Guard{"rows", [](FacePoseInput& in) { shift_mouth(in, 0, 8); }, FaceRefusal::not_rectified,
              "the mouth differs by 8.0 rows between the images, more than 6.0"},
        Guard{"not_finite", [](FacePoseInput& in) { shift_mouth(in, NAN, 0); },
              FaceRefusal::bad_input, "landmark 60 is not finite"},
        Guard{"tiny_face",
              [](FacePoseInput& in) {
                in.camera.baseline_m = 0.05;
                in.camera.focal_px *= 1.2;
              },
              FaceRefusal::implausible, "the eyes would be 26.2 mm apart, outside 30 to 150 mm"},
        Guard{"mirrored",
              [](FacePoseInput& in) {
                for (auto* face : {&in.landmarks.left, &in.landmarks.right}) {
                  for (std::size_t i = 36; i <= 41; ++i)
                    std::swap(face->points[i], face->points[i + 6]);
                }
              },
              FaceRefusal::implausible,
              "the face would be seen from 180 degrees aside, or from behind"}),
    [](const auto& test) { return test.param.name; });

TEST(ThreePointParams, RefuseLimitsThatExcludeEachOther) {
  const auto refusal = [](const char* given) {
    try {
      ThreePoint::make(
          declared_params(ARMATURE_SOURCE_DIR "/plugins/face_pose/three_point/plugin.yaml", given))
          .value();
    } catch (const config::ConfigError& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };
  EXPECT_EQ(refusal("{min_depth_m: 0.3, max_depth_m: 0.5}"), "");
  EXPECT_EQ(
      refusal("min_depth_m: 3"),
      "given:1:14: 'min_depth_m' is 3, not below 'max_depth_m', which is 2: no face would be seen");
  EXPECT_EQ(refusal("max_eye_distance_mm: 20"),
            "given:1:22: 'min_eye_distance_mm' is 30, not below 'max_eye_distance_mm', which is "
            "20: no eyes would do");
}

}  // namespace
}  // namespace armature::face_pose::three_point
