// SPDX-License-Identifier: Apache-2.0
// Face pose from the pixels: 1. the laws of its kind, 2. how near it comes to the truth on flat and
// on round faces, and that it says so, 3. it is right or says no, whatever is wrong, 4. what it
// asks of a landmark finder.
#include "surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "armature/config/problems.hpp"
#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/face_pose/contract.hpp"
#include "posed_faces_test.hpp"

namespace armature::face_pose::surface {

INSTANTIATE_TEST_SUITE_P(Surface, FacePoseLaws,
                         testing::Values(FacePoseSubject{"default",
                                                         std::make_shared<Surface>(Parameters{})}));

namespace {

using scene::Occluder;

Expected<FacePose> estimated(const PosedFace& face, LandmarkFinder* finder = nullptr) {
  PluginState state;
  return Surface{Parameters{}}.estimate(face.input(finder), state);
}

struct Errors {
  std::vector<double> normal_deg, mouth_depth_mm;
};

Errors errors_of(const Circumstances& how, int pairs) {
  Errors errors;
  for (int i = 0; i < pairs; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const PosedFace face = posed_face(how, seed);
    const auto found = estimated(face);
    if (!found) {
      ADD_FAILURE() << "seed " << seed << ": " << found.error().text;
      continue;
    }
    const PoseError error = error_of(*found, face);
    errors.normal_deg.push_back(error.normal_deg);
    errors.mouth_depth_mm.push_back(error.mouth_depth_mm);
  }
  return errors;
}

TEST(Surface, KnowsTheNormalOfAFlatFaceToAFewHundredthsOfADegree) {
  const Errors errors = errors_of({}, 30);
  EXPECT_LT(quantile(errors.normal_deg, 0.5), 0.05);
  EXPECT_LT(quantile(errors.normal_deg, 0.95), 0.12);
}

TEST(Surface, KnowsItToATenthWithThePapersCamerasWhichAre24MillimetresApart) {
  const Errors errors = errors_of({.camera = kPapersRig}, 30);
  EXPECT_LT(quantile(errors.normal_deg, 0.5), 0.15);
  EXPECT_LT(quantile(errors.normal_deg, 0.95), 0.35);
}

TEST(Surface, LosesLittleBetweenThePixelsOfPicturesWithoutNoise) {
  const Errors errors = errors_of({.camera = kPapersRig, .noise = 0, .max_turn_deg = 12}, 30);
  EXPECT_LT(quantile(errors.normal_deg, 0.5), 0.025);
  EXPECT_LT(quantile(errors.normal_deg, 0.95), 0.05);
}

TEST(Surface, KnowsTheThreePointsOfARoundFace) {
  for (const double radius : {0.08, 0.15}) {
    const scene::Staging round{.surface = {scene::Surface::Shape::cylinder, radius}};
    const Errors errors = errors_of({.staging = round, .landmark_error = 0.7}, 10);
    EXPECT_LT(quantile(errors.normal_deg, 0.5), 1) << radius;
    EXPECT_LT(quantile(errors.normal_deg, 0.95), 2) << radius;
    EXPECT_LT(quantile(errors.mouth_depth_mm, 0.95), 2.5) << radius;
  }
}

TEST(Surface, StatesTheUncertaintyOfTheNormalThatItHas) {
  constexpr int kPairs = 30;
  double square = 0, stated = 0;
  for (std::uint64_t seed = 0; seed < kPairs; ++seed) {
    const PosedFace face = posed_face({.camera = kPapersRig}, seed);
    const auto found = estimated(face);
    ASSERT_TRUE(found) << "seed " << seed << ": " << found.error().text;
    square += (found->normal - face.truth.normal()).squaredNorm() / kPairs;
    stated += found->normal_covariance.trace() / kPairs;
  }
  EXPECT_GT(std::sqrt(square / stated), 0.5);
  EXPECT_LT(std::sqrt(square / stated), 2);
}

TEST(Surface, StartsWhereTheLastPairEndedWhenTheLandmarksAreFarOff) {
  const PosedFace face = posed_face({.landmark_error = 0.3, .max_turn_deg = 35}, 3);
  Surface estimator{Parameters{}};
  PluginState state;
  ASSERT_TRUE(estimator.estimate(face.input(), state));
  // Disparities that would begin the search 70 px aside, beyond what a start covers.
  PosedFace far = face;
  for (Landmark& landmark : far.landmarks.right.points) landmark.point.x() -= 70;
  EXPECT_FALSE(estimated(far));
  const auto found = estimator.estimate(far.input(), state);
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_LT(error_of(*found, face).normal_deg, 0.15);
}

struct Fault {
  std::string name;
  Circumstances how;
  std::string reason;  // of which every refusal is
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class SurfaceWith : public testing::TestWithParam<Fault> {};

// More than 5 mm or 3 degrees off is wrong.
TEST_P(SurfaceWith, IsRightOrSaysNo) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const PosedFace face = posed_face(GetParam().how, seed);
    const auto found = estimated(face);
    if (!found) {
      EXPECT_THAT(found.error().text, testing::ContainsRegex(GetParam().reason)) << seed;
      EXPECT_NE(found.error().code, 0) << "a program can tell, too: " << found.error().text;
      continue;
    }
    const PoseError error = error_of(*found, face);
    EXPECT_LT(error.normal_deg, 3) << "seed " << seed;
    EXPECT_LT(error.mouth_mm, 5) << "seed " << seed;
  }
}

constexpr double kDegree = std::numbers::pi / 180;
const std::string kCovered =
    "looks different to both|covers it|hollow|agree in|no .*compared|shows too little";
const std::string kNotRectified = "not rectified";

INSTANTIATE_TEST_SUITE_P(
    Faults, SurfaceWith,
    testing::Values(
        Fault{"nothing", {}, "never"}, Fault{"noise", {.noise = 8}, "never"},
        Fault{"dark", {.brightness = 0.15}, "never"},
        Fault{"over_exposed", {.brightness = 1.8}, "never"},
        Fault{"over_exposed_behind_a_mask",
              {.staging = {.occluder = Occluder::mask}, .brightness = 1.8},
              "too little of the mouth"},
        Fault{"over_exposed_behind_an_instrument",
              {.staging = {.occluder = Occluder::instrument_over_mouth}, .brightness = 1.8},
              "too little of the mouth|" + kCovered},
        Fault{"over_exposed_behind_a_hand",
              {.staging = {.occluder = Occluder::hand_over_eye}, .brightness = 1.8},
              "too little of the right eye|" + kCovered},
        Fault{"far_away", {.landmark_error = 0.7, .depth = 1.1}, "never"},
        Fault{"sphere",
              {.staging = {.surface = {scene::Surface::Shape::sphere, 0.1}}, .landmark_error = 0.7},
              kCovered},
        Fault{"instrument_over_the_mouth",
              {.staging = {.occluder = Occluder::instrument_over_mouth}},
              kCovered},
        Fault{"hand_over_the_mouth",
              {.staging = {.occluder = Occluder::hand_over_mouth}},
              kCovered + "|" + kNotRectified},
        Fault{"hand_over_an_eye",
              {.staging = {.occluder = Occluder::hand_over_eye}},
              kCovered + "|" + kNotRectified},
        Fault{"one_camera_darker", {.right = {.gain = 0.6}}, "never"},
        Fault{"one_camera_nearly_black", {.right = {.gain = 0.2}}, "times as bright"},
        Fault{"turned_camera", {.right = {.roll = 0.3 * kDegree}}, kNotRectified},
        Fault{"longer_focal_length", {.right = {.focal = 1.01}}, kNotRectified},
        Fault{"nothing_and_far_aside", {.depth = 1, .aside = 0.5}, "never"},
        Fault{"noise_and_far_aside", {.noise = 8, .depth = 1, .aside = 0.5}, kNotRectified},
        Fault{"longer_focal_length_far_aside",
              {.right = {.focal = 1.0012}, .depth = 1, .aside = 0.5},
              kNotRectified},
        Fault{"shorter_focal_length_far_aside",
              {.right = {.focal = 0.998}, .depth = 1, .aside = -0.35},
              kNotRectified},
        Fault{"lower_camera", {.right = {.shift_px = {0, 1}}}, kNotRectified}),
    [](const auto& test) { return test.param.name; });

TEST(SurfaceGuards, RefuseAFaceThatIsTooFarTooSmallOrTooMuchAside) {
  const auto refusal = [](const Circumstances& how, const Parameters& parameters) {
    PluginState state;
    const auto found = Surface{parameters}.estimate(posed_face(how, 2).input(), state);
    return found ? "accepted" : found.error().text;
  };
  Parameters near;
  near.max_depth = 0.3;
  EXPECT_THAT(refusal({}, near), testing::ContainsRegex("the mouth would be 0.[0-9]* m away"));
  Parameters wide;
  wide.min_eye_distance = 0.07;
  EXPECT_THAT(refusal({}, wide), testing::HasSubstr("mm apart, outside 70 to 90 mm"));
  Parameters straight;
  straight.max_tilt = 3 * kDegree;
  EXPECT_THAT(refusal({}, straight), testing::HasSubstr("degrees aside, more than 3"));
  Parameters exact;
  exact.max_normal_sigma = 1e-5;
  EXPECT_THAT(refusal({}, exact), testing::HasSubstr("the normal would be known to"));
  EXPECT_EQ(refusal({}, {}), "accepted");
}

TEST(SurfaceGuards, RefuseAFaceWhoseEyeTurnsTooFarAwayOnANarrowHead) {
  const auto refused = [](double radius_m) {
    const scene::Staging head{.surface = {scene::Surface::Shape::cylinder, radius_m}};
    int count = 0;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const auto found =
          estimated(posed_face({.staging = head, .landmark_error = 0.7, .max_turn_deg = 35}, seed));
      if (!found && found.error().text.find("on a head so narrow") != std::string::npos) ++count;
    }
    return count;
  };
  EXPECT_GT(refused(0.045), 0);
  EXPECT_EQ(refused(0.1), 0);
}

TEST(SurfaceGuards, RefusePicturesThatAreNoneOrOfAnotherCamera) {
  const PosedFace face = posed_face({}, 1);
  const auto refusal = [&](auto spoil) {
    FacePoseInput input = face.input();
    spoil(input);
    PluginState state;
    const auto found = Surface{Parameters{}}.estimate(input, state);
    return found ? "accepted" : found.error().text;
  };
  EXPECT_EQ(refusal([](FacePoseInput& i) { i.left = {}; }), "empty image");
  EXPECT_EQ(refusal([](FacePoseInput& i) { i.camera.width = 640; }),
            "a picture of 1280 x 720 pixels of a camera with 640 x 720");
  EXPECT_THAT(refusal([](FacePoseInput& i) { std::swap(i.left, i.right); }),
              testing::Not("accepted"));
}

TEST(SurfaceGuards, RefuseLandmarksOutsideThePictureAndFacesOfAFewPixelsAtOnce) {
  const PosedFace face = posed_face({}, 1);
  const auto refusal = [&](auto moved) {
    PosedFace elsewhere = face;
    for (FaceLandmarks* in : {&elsewhere.landmarks.left, &elsewhere.landmarks.right}) {
      for (Landmark& landmark : in->points) landmark.point = moved(landmark.point);
    }
    const auto found = estimated(elsewhere);
    return found ? "accepted" : found.error().text;
  };
  using Eigen::Vector2d;
  EXPECT_THAT(refusal([](const Vector2d& p) { return Vector2d{p * 1e6}; }),
              testing::HasSubstr("is not in the picture"));
  EXPECT_THAT(refusal([](const Vector2d& p) {
                return Vector2d{p - Vector2d{1200, 0}};
              }),
              testing::HasSubstr("the left eye at (-"));
  const Vector2d mouth = face.landmarks.left.feature(FaceFeature::mouth).point;
  EXPECT_THAT(refusal([&](const Vector2d& p) { return Vector2d{mouth + 0.02 * (p - mouth)}; }),
              testing::HasSubstr("too few for a face"));
}

/// Finds a face in its box, where detectors' boxes have it; or `aside` [px], in part with the box.
class FakeFinder final : public LandmarkFinder {
 public:
  Eigen::Vector2d aside = Eigen::Vector2d::Zero();
  bool moves_with_box = false, fails = false;
  int asked = 0;

  LandmarkScheme scheme() const override { return LandmarkScheme::five; }
  Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& box) override {
    ++asked;
    if (fails) return refuse("no nose");
    const double eyes = 290 / 2.4;
    Eigen::Vector2d middle{0.5 * (image.width - 1), 0.5 * (image.height - 1) - 0.36 * eyes};
    if (moves_with_box) {
      middle.x() += box.left + 0.5 * box.width - 0.5 * (image.width - 1);
    }
    const auto at = [&](double x, double y) {
      return Landmark{.point = middle + eyes * Eigen::Vector2d{x, y} + aside, .sigma = 0.3};
    };
    return std::vector{at(-0.5, 0), at(0.5, 0), at(0, 0.7), at(-0.3, 65.0 / 63),
                       at(0.3, 65.0 / 63)};
  }
};

TEST(SurfaceAndFinder, TheFeaturesAreThoseOfTheFrontalView) {
  const PosedFace face = posed_face({.landmark_error = 2}, 4);
  FakeFinder finder;
  const auto found = estimated(face, &finder), without = estimated(face);
  ASSERT_TRUE(found) << found.error().text;
  ASSERT_TRUE(without);
  EXPECT_EQ(finder.asked, 2);
  // Where the eyes are taken to be decides where the view's eyes are; the mouth's place follows.
  EXPECT_NEAR((found->mouth - 0.5 * (found->left_eye + found->right_eye)).norm() /
                  (found->right_eye - found->left_eye).norm(),
              65.0 / 63, 1e-3);
  EXPECT_EQ(found->normal, without->normal);
}

TEST(SurfaceAndFinder, AFeatureThatMovesWithTheBoxIsNotToBeSeen) {
  FakeFinder finder;
  finder.moves_with_box = true;
  const auto found = estimated(posed_face({}, 1), &finder);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().text, testing::HasSubstr("is not to be seen"));
}

TEST(SurfaceAndFinder, AFeatureThatIsElsewhereInTheFrontalViewIsRefused) {
  FakeFinder finder;
  finder.aside = {25, 0};
  const auto found = estimated(posed_face({}, 1), &finder);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().text, testing::HasSubstr("is elsewhere in a frontal view"));
}

TEST(SurfaceAndFinder, WhatTheFinderRefusesIsTheReason) {
  FakeFinder finder;
  finder.fails = true;
  const auto found = estimated(posed_face({}, 1), &finder);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().text, "frontal view: no nose");
}

TEST(SurfaceParams, RefuseLimitsThatExcludeEachOther) {
  const auto refusal = [](const char* given) {
    try {
      Surface::make(
          declared_params(ARMATURE_SOURCE_DIR "/plugins/face_pose/surface/plugin.yaml", given))
          .value();
    } catch (const config::ConfigError& error) {
      return std::string{error.what()};
    }
    return std::string{};
  };
  EXPECT_EQ(refusal("{min_depth_m: 0.3, max_depth_m: 0.5}"), "");
  EXPECT_THAT(refusal("min_depth_m: 3"), testing::HasSubstr("no face would be seen"));
  EXPECT_THAT(refusal("max_eye_distance_mm: 20"), testing::HasSubstr("no eyes would do"));
}

}  // namespace
}  // namespace armature::face_pose::surface
