// SPDX-License-Identifier: Apache-2.0
// Pictures of a photo: 1. they are where projective geometry puts them, whatever it is glued to, 2.
// what must not be seen is not drawn, 3. light and noise do what they say, 4. same arguments, same
// bytes.
#include "armature/scene/scene_renderer.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>

#include "armature/scene/generated_face.hpp"
#include "armature/scene/spot_photo_test.hpp"

namespace armature::scene {
namespace {

TEST(SceneRenderer, PutsASpotWhereTheCameraProjectsItsPoint) {
  std::mt19937_64 random{20210811};
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  for (int i = 0; i < 25; ++i) {
    SCOPED_TRACE(i);
    const Eigen::Vector2d pixel{draw(120, 280), draw(180, 320)};
    const Photo photo = spot_photo(pixel);
    SceneRenderer renderer{photo, {}, {.noise = 0, .blur_px = 0, .background = 0}, 1};
    const Eigen::Isometry3d pose = placed({draw(-0.05, 0.05), draw(-0.05, 0.05), draw(0.25, 0.9)},
                                          draw(-0.5, 0.5), draw(-0.5, 0.5));
    const Eigen::Vector2d on_plane = (pixel - photo.mouth) * photo.m_per_px;
    const Eigen::Vector2d expected =
        kCamera.project_left(pose * Eigen::Vector3d{on_plane.x(), on_plane.y(), 0});
    // The centre of gravity of a spot's image is not the image of its centre: perspective moves it
    // by a few hundredths of a pixel.
    EXPECT_LT((centroid(render(renderer, pose), kCamera) - expected).norm(), 0.05);
  }
}

TEST(SceneRenderer, PutsASpotOnARoundHeadWhereTheCameraProjectsItsPoint) {
  std::mt19937_64 random{20210812};
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  for (const auto shape : {Surface::Shape::cylinder, Surface::Shape::sphere}) {
    for (int i = 0; i < 12; ++i) {
      SCOPED_TRACE(i);
      const Eigen::Vector2d pixel{draw(130, 270), draw(190, 310)};
      const Surface surface{.shape = shape, .radius_m = draw(0.07, 0.12)};
      const Photo photo = spot_photo(pixel);
      SceneRenderer renderer{
          photo, {.surface = surface}, {.noise = 0, .blur_px = 0, .background = 0}, 1};
      const Eigen::Isometry3d pose = placed({draw(-0.05, 0.05), draw(-0.05, 0.05), draw(0.25, 0.9)},
                                            draw(-0.4, 0.4), draw(-0.4, 0.4));
      const Eigen::Vector2d expected =
          kCamera.project_left(pose * surface.point((pixel - photo.mouth) * photo.m_per_px));
      EXPECT_LT((centroid(render(renderer, pose), kCamera) - expected).norm(), 0.06);
    }
  }
}

TEST(SceneRenderer, TellsWhereEyesAndMouthCameToLie) {
  const Photo photo = flat_photo(120);
  const ImagingSettings settings{.noise = 0, .blur_px = 0, .background = 0};
  const SceneRenderer flat{photo, {}, settings, 1};
  EXPECT_TRUE(flat.truth().left_eye.isApprox(Eigen::Vector3d{-0.025, -0.05, 0}));
  EXPECT_TRUE(flat.truth().right_eye.isApprox(Eigen::Vector3d{0.025, -0.05, 0}));
  EXPECT_TRUE(flat.truth().mouth.isZero());
  EXPECT_TRUE(flat.truth().normal().isApprox(Eigen::Vector3d{0, 0, -1}));
  const SceneRenderer round{photo, {.surface = {Surface::Shape::cylinder, 0.08}}, settings, 1};
  const double depth = 0.08 * (1 - std::cos(0.025 / 0.08));
  EXPECT_NEAR(round.truth().left_eye.z(), depth, 1e-12);
  // The eyes stand back, and the paper's normal looks up.
  const Eigen::Vector3d normal = round.truth().normal();
  EXPECT_NEAR(std::atan2(-normal.y(), -normal.z()), std::atan2(depth, 0.05), 1e-12);
}

TEST(SceneRenderer, ShowsBothCamerasTheDisparityOfTheDepth) {
  SceneRenderer renderer{
      spot_photo({200, 250}), {}, {.noise = 0, .blur_px = 0, .background = 0}, 1};
  for (const double depth : {0.3, 0.5, 0.8}) {
    const Eigen::Isometry3d left_T_photo = placed({0.05, 0.01, depth});
    Eigen::Isometry3d right_T_photo = left_T_photo;
    right_T_photo.pretranslate(Eigen::Vector3d{-kCamera.baseline_m, 0, 0});
    const Eigen::Vector2d left = centroid(render(renderer, left_T_photo), kCamera);
    const Eigen::Vector2d right = centroid(render(renderer, right_T_photo), kCamera);
    EXPECT_NEAR(left.x() - right.x(), kCamera.focal_px * kCamera.baseline_m / depth, 0.02);
    EXPECT_NEAR(left.y(), right.y(), 0.01);
  }
}

TEST(SceneRenderer, KeepsTheMeanOfAFinePatternFarAway) {
  Photo photo = flat_photo(0);
  for (std::size_t i = 0; i < photo.image.pixels.size(); ++i) {
    const bool white = (i % 400 + i / 400) % 2 == 0;
    photo.image.pixels[i] = white ? 200 : 0;
  }
  SceneRenderer renderer{photo, {}, {.noise = 0, .blur_px = 0, .background = 100}, 1};
  const Picture picture = render(renderer, placed({0, 0, 2.0}));
  for (int v = 230; v < 250; ++v) {
    for (int u = 310; u < 330; ++u) {
      EXPECT_NEAR(picture[static_cast<std::size_t>(v * 640 + u)], 100, 12);
    }
  }
}

TEST(SceneRenderer, DrawsNothingOfAPhotoSeenFromBehindOrBehindTheCamera) {
  SceneRenderer renderer{flat_photo(250), {}, {.noise = 0, .blur_px = 0.5, .background = 90}, 1};
  const Picture empty(640 * 480, 90);
  EXPECT_EQ(render(renderer, placed({0, 0, 0.5}, std::numbers::pi)), empty);
  EXPECT_EQ(render(renderer, placed({0, 0, -0.5})), empty);
  EXPECT_EQ(render(renderer, placed({0, 0, -0.5}, std::numbers::pi)), empty);
  EXPECT_EQ(render(renderer, placed({2.0, 0, 0.5})), empty);
  EXPECT_NE(render(renderer, placed({0, 0, 0.5})), empty);
}

TEST(SceneRenderer, DrawsAPlaneThatCrossesTheCamerasOwnPlaneOnlyInFront) {
  SceneRenderer renderer{flat_photo(250), {}, {.noise = 0, .blur_px = 0, .background = 0}, 1};
  // Edge on beside the camera, from 4 cm behind it to 16 cm in front.
  const Picture picture = render(renderer, placed({0.03, 0, 0.06}, 85 * kDegree));
  EXPECT_GT(mean(picture), 1);
  for (int v = 0; v < 480; ++v) EXPECT_EQ(picture[static_cast<std::size_t>(v * 640)], 0);
}

TEST(SceneRenderer, DrawsNothingOfARoundHeadSeenFromBehind) {
  for (const auto shape : {Surface::Shape::cylinder, Surface::Shape::sphere}) {
    SceneRenderer renderer{flat_photo(250),
                           {.surface = {shape, 0.09}},
                           {.noise = 0, .blur_px = 0.5, .background = 90},
                           1};
    const Picture empty(640 * 480, 90);
    EXPECT_EQ(render(renderer, placed({0, 0, 0.6}, std::numbers::pi)), empty);
    EXPECT_EQ(render(renderer, placed({0, 0, -0.5})), empty);
    EXPECT_NE(render(renderer, placed({0, 0, 0.5})), empty);
  }
}

TEST(SceneRenderer, DrawsNoOccluderOfAFaceSeenFromBehind) {
  for (const auto occluder : {Occluder::mask, Occluder::hand_over_mouth}) {
    SceneRenderer renderer{
        flat_photo(120), {.occluder = occluder}, {.noise = 0, .blur_px = 0, .background = 90}, 1};
    EXPECT_EQ(render(renderer, placed({0, 0, 0.6}, std::numbers::pi)), Picture(640 * 480, 90));
    EXPECT_NE(render(renderer, placed({0, 0, 0.6})),
              render(renderer, placed({0, 0, 0.6}, std::numbers::pi)));
  }
}

TEST(SceneRenderer, MultipliesByTheBrightnessAndClamps) {
  SceneRenderer renderer{flat_photo(120), {}, {.noise = 0, .blur_px = 0.5, .background = 120}, 1};
  for (const auto& [brightness, expected] :
       {std::pair{0.3, 36}, {1.0, 120}, {1.2, 144}, {4.0, 255}, {0.0, 0}}) {
    EXPECT_EQ(render(renderer, placed({0, 0, 0.5}), kCamera, brightness),
              Picture(640 * 480, static_cast<std::uint8_t>(expected)));
  }
}

TEST(SceneRenderer, AddsNoiseOfTheStatedDeviationWithoutAShift) {
  SceneRenderer renderer{flat_photo(120), {}, {.noise = 5, .blur_px = 0, .background = 120}, 7};
  const Picture picture = render(renderer, placed({0, 0, 0.5}));
  double square = 0;
  for (const auto value : picture) square += (value - 120.0) * (value - 120.0);
  EXPECT_NEAR(mean(picture), 120, 0.1);
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(picture.size())), 5, 0.1);
}

TEST(SceneRenderer, GivesTheSameBytesForTheSameSeedAndPictureNumber) {
  const ImagingSettings settings{.noise = 2, .blur_px = 0.5, .background = 120};
  const Photo photo = generated_face(1, 0.063);
  SceneRenderer a{photo, {}, settings, 3}, b{photo, {}, settings, 3}, other{photo, {}, settings, 4};
  const Eigen::Isometry3d pose = placed({0.02, 0.01, 0.5}, 0.2, -0.1);
  const Picture first = render(a, pose, kCamera, 1, 5);
  render(a, placed({0, 0, 0.3}), kCamera, 1, 6);
  EXPECT_EQ(render(a, pose, kCamera, 1, 5), first);
  EXPECT_EQ(render(b, pose, kCamera, 1, 5), first);
  EXPECT_NE(render(b, pose, kCamera, 1, 6), first);
  EXPECT_NE(render(other, pose, kCamera, 1, 5), first);
}

}  // namespace
}  // namespace armature::scene
