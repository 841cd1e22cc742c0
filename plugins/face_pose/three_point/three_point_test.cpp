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
    .width = 1280, .height = 720, .focal_px = 914, .cu = 639.5, .cv = 359.5, .baseline_m = 0.12};
const StereoCamera kPaper{.width = 1000,
                          .height = 1000,
                          .focal_px = 787.4015748,
                          .cu = 500,
                          .cv = 500,
                          .baseline_m = 0.024};

struct Features {
  Vector2d left_eye, right_eye, mouth;
};

FaceLandmarks landmarks(const Features& features) {
  FaceLandmarks face;
  face.points.fill(Vector2d::Zero());
  for (std::size_t i = 36; i <= 41; ++i) face.points[i] = features.left_eye;
  for (std::size_t i = 42; i <= 47; ++i) face.points[i] = features.right_eye;
  for (const std::size_t i : {60, 62, 64, 66}) face.points[i] = features.mouth;
  return face;
}

Eigen::Isometry3d placed(const Vector3d& position, double yaw, double pitch) {
  return Eigen::Translation3d{position} *
         (Eigen::AngleAxisd{yaw, Vector3d::UnitY()} * Eigen::AngleAxisd{pitch, Vector3d::UnitX()});
}

double angle(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(ThreePoint, AveragesLandmarksWithoutRounding) {
  ThreePoint estimator{{}};
  FacePoseInput in = exact_face(kDefault, placed({0, 0, 0.5}, 0, 0));
  in.landmarks.left.points[60].x() += 0.8;  // one of four
  const auto face = estimator.estimate(in);
  ASSERT_TRUE(face);
  const double disparity = 914 * 0.12 / 0.5 + 0.2;
  EXPECT_NEAR(face->mouth.z(), 914 * 0.12 / disparity, 1e-12);
}

// Section 5: pixels as printed; frame 7 has x along the view, y up, z to the image's right, and its
// origin between the cameras.
TEST(ThreePoint, GivesThePapersCoordinatesAndNormal) {
  ThreePoint estimator{{}};
  const FacePoseInput in{.left = {},
                         .right = {},
                         .landmarks = {landmarks({{438, 353}, {603, 351}, {523, 498}}),
                                       landmarks({{400, 353}, {565, 350}, {484, 498}})},
                         .camera = kPaper};
  const auto face = estimator.estimate(in);
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
    ThreePoint estimator{{.landmark_sigma = 0.1}};
    std::mt19937_64 random{99};
    std::normal_distribution<double> noise{0, 0.1};
    const auto pose = placed({0, 0, 0.5}, 0, 0);
    double mouth = 0, normal = 0;
    FacePose last{};
    constexpr int kRuns = 4000;
    for (int i = 0; i < kRuns; ++i) {
      const auto noisy = [&](const Vector2d& p) {
        return Vector2d{p.x() + noise(random), p.y() + noise(random)};
      };
      const auto features = [&](const FaceLandmarks& f) {
        return landmarks({noisy(f.points[36]), noisy(f.points[42]), noisy(f.points[60])});
      };
      FacePoseInput in = exact_face(camera, pose);
      in.landmarks = {features(in.landmarks.left), features(in.landmarks.right)};
      const auto face = estimator.estimate(in);
      ASSERT_TRUE(face) << face.error().text;
      last = *face;
      mouth += std::pow(face->mouth.z() - 0.5, 2);
      normal += std::pow(angle(face->normal, -Vector3d::UnitZ()), 2);
    }
    EXPECT_NEAR(std::sqrt(mouth / kRuns) / last.mouth_sigma_m, 1, 0.1);
    EXPECT_NEAR(std::sqrt(normal / kRuns) / last.normal_sigma_rad, 1, 0.15);
  }
}

struct Guard {
  std::string name;
  std::function<void(FacePoseInput&)> spoil;
  std::string reason;
};

class ThreePointGuards : public testing::TestWithParam<Guard> {};

TEST_P(ThreePointGuards, RefuseWithTheReason) {
  ThreePoint estimator{{}};
  FacePoseInput in = exact_face(kDefault, placed({0, 0, 0.5}, 0, 0));
  GetParam().spoil(in);
  const auto face = estimator.estimate(in);
  ASSERT_FALSE(face);
  EXPECT_THAT(face.error().text, testing::HasSubstr(GetParam().reason));
}

void shift_mouth(FacePoseInput& in, double du, double dv) {
  for (const std::size_t i : {60, 62, 64, 66}) in.landmarks.right.points[i] += Vector2d{du, dv};
}

INSTANTIATE_TEST_SUITE_P(
    All, ThreePointGuards,
    testing::Values(Guard{"disparity", [](FacePoseInput& in) { shift_mouth(in, 230, 0); },
                          "the mouth has a disparity of -10.64 px, not a positive one"},
                    Guard{"near", [](FacePoseInput& in) { shift_mouth(in, -500, 0); },
                          "the mouth would be 0.152 m away, outside 0.2 to 2 m"},
                    Guard{"rows", [](FacePoseInput& in) { shift_mouth(in, 0, 8); },
                          "the mouth differs by 8.0 rows between the images, more than 6.0"},
                    Guard{"not_finite", [](FacePoseInput& in) { shift_mouth(in, NAN, 0); },
                          "the mouth has no finite pixel"},
                    Guard{"tiny_face",
                          [](FacePoseInput& in) {
                            in.camera.baseline_m = 0.05;
                            in.camera.focal_px *= 1.2;
                          },
                          "the eyes would be 26.2 mm apart, outside 30 to 150 mm"},
                    Guard{"mirrored",
                          [](FacePoseInput& in) {
                            for (auto* face : {&in.landmarks.left, &in.landmarks.right}) {
                              for (std::size_t i = 36; i <= 41; ++i)
                                std::swap(face->points[i], face->points[i + 6]);
                            }
                          },
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
  EXPECT_EQ(refusal("{nearest_m: 0.3, farthest_m: 0.5}"), "");
  EXPECT_EQ(
      refusal("nearest_m: 3"),
      "given:1:12: 'nearest_m' is 3, not below 'farthest_m', which is 2: no face would be seen");
  EXPECT_EQ(refusal("most_eye_distance_mm: 20"),
            "given:1:23: 'least_eye_distance_mm' is 30, not below 'most_eye_distance_mm', which is "
            "20: no eyes would do");
}

}  // namespace
}  // namespace armature::face_pose::three_point
