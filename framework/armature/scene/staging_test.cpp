// SPDX-License-Identifier: Apache-2.0
// What is staged and how it is taken: 1. a second face, 2. a shadow, 3. motion, 4. a right camera
// that is not as it is said to be.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>

#include "armature/scene/right_camera.hpp"
#include "armature/scene/scene_renderer.hpp"
#include "armature/scene/spot_photo_test.hpp"

namespace armature::scene {
namespace {

TEST(SceneRenderer, OfTwoFacesTheNearerOneHidesTheOther) {
  const ImagingSettings settings{.noise = 0, .blur_px = 0, .background = 90};
  const auto middle_of_second = [&](double deeper) {
    // A black photo with a white edge at its left: the first one's right part covers, or not, the
    // second one's left part.
    Photo photo = flat_photo(0);
    for (int v = 0; v < 500; ++v) {
      for (int u = 0; u < 100; ++u) photo.image.pixels[static_cast<std::size_t>(v * 400 + u)] = 250;
    }
    SceneRenderer renderer{photo, {.second_face = Eigen::Vector3d{0.15, 0, deeper}}, settings, 1};
    const auto picture = render(renderer, placed({0, 0, 0.6}));
    const Eigen::Vector2d at = kCamera.project_left({0.15 - 0.075, 0, 0.6 + deeper});
    return picture[static_cast<std::size_t>(240 * 640 + std::lround(at.x()))];
  };
  EXPECT_EQ(middle_of_second(0.05), 0);
  EXPECT_EQ(middle_of_second(-0.05), 250);
}

TEST(SceneRenderer, DarkensTheLowerHalfAsMuchAsTold) {
  const ImagingSettings settings{.noise = 0, .blur_px = 0, .background = 0};
  SceneRenderer renderer{flat_photo(200), {.shadow = 0.75}, settings, 1};
  const Picture picture = render(renderer, placed({0, 0, 0.5}));
  const auto at_height = [&](double y) {
    const Eigen::Vector2d at = kCamera.project_left({0, y, 0.5});
    return picture[static_cast<std::size_t>(std::lround(at.y()) * 640 + 320)];
  };
  EXPECT_EQ(at_height(-0.05), 200);  // the eyes' line
  EXPECT_EQ(at_height(0), 50);       // the mouth
}

TEST(SceneRenderer, SmearsASpotAlongTheMotionAndNotAcross) {
  const Photo photo = spot_photo({200, 250});
  const auto moments = [&](const Eigen::Vector2d& motion) {
    SceneRenderer renderer{
        photo, {}, {.noise = 0, .blur_px = 0, .background = 0, .motion_px = motion}, 1};
    const Picture picture = render(renderer, placed({0, 0, 0.5}));
    const Eigen::Vector2d middle = centroid(picture, kCamera);
    EXPECT_LT((middle - Eigen::Vector2d{kCamera.cx, kCamera.cy}).norm(), 0.05);
    Eigen::Array2d sum = Eigen::Array2d::Zero();
    double weight = 0;
    for (int v = 0; v < 480; ++v) {
      for (int u = 0; u < 640; ++u) {
        const double w = picture[static_cast<std::size_t>(v * 640 + u)];
        sum += w * (Eigen::Vector2d{u, v} - middle).array().square();
        weight += w;
      }
    }
    return Eigen::Array2d{sum / weight};
  };
  const Eigen::Array2d still = moments({0, 0}), moved = moments({9, 0}), down = moments({3, -6});
  EXPECT_NEAR(moved.x() - still.x(), 9.0 * 9.0 / 12, 1.2);  // of an even spread; tails are cut at 0
  EXPECT_NEAR(moved.y(), still.y(), 0.3);
  EXPECT_NEAR(down.x() - still.x(), 3.0 * 3.0 / 12, 0.5);
  EXPECT_NEAR(down.y() - still.y(), 6.0 * 6.0 / 12, 0.7);
}

TEST(RightCamera, ThatIsTurnedAndShiftedSeesThePointThere) {
  const StereoCamera pair{
      .width = 640, .height = 480, .focal_px = 500, .cx = 319.5, .cy = 239.5, .baseline_m = 0.12};
  const Photo photo = spot_photo({230, 200});
  const Eigen::Isometry3d left_T_face = placed({0.05, 0.01, 0.5}, 0.2, -0.1);
  const Eigen::Vector3d spot = left_T_face * Eigen::Vector3d{0.015, -0.025, 0};
  SceneRenderer renderer{photo, {}, {.noise = 0, .blur_px = 0, .background = 0}, 1};
  const auto seen = [&](const RightCamera& right) {
    return centroid(render(renderer, right.right_T_left(pair) * left_T_face, right.of(pair)), pair);
  };
  const Eigen::Vector2d principal{pair.cx, pair.cy};
  const Eigen::Vector2d sound = pair.project_right(spot);
  EXPECT_LT((seen({}) - sound).norm(), 0.05);
  EXPECT_LT((seen({.shift_px = {2, -3}}) - sound - Eigen::Vector2d{2, -3}).norm(), 0.05);
  EXPECT_LT((seen({.focal = 1.02}) - principal - 1.02 * (sound - principal)).norm(), 0.05);
  // A camera that turns clockwise as it sees it lets the picture turn the other way.
  const Eigen::Rotation2Dd back{-0.05};
  EXPECT_LT((seen({.roll = 0.05}) - principal - back * (sound - principal)).norm(), 0.05);
}

}  // namespace
}  // namespace armature::scene
