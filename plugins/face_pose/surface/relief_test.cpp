// SPDX-License-Identifier: Apache-2.0
// Faces with a nose of 20 mm and eyes that lie 5 mm deep, on a round head: the normal is that of
// mouth and eyes themselves, not of their surroundings, and its uncertainty says how well it is
// known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "posed_faces_test.hpp"
#include "surface.hpp"

namespace armature::face_pose::surface {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double kNose_m = 0.02, kSocket_m = 0.005, kHead_m = 0.09;

/// A drawn face on a head; its frame: origin at the mouth before the nose is added, x to the right,
/// y down, z into the face.
class Head {
 public:
  explicit Head(std::uint64_t seed) : photo_{scene::generated_face(seed, 0.063)} {}

  double z(double x, double y) const {
    const Vector2d eye = flat(photo_.right_eye);
    const auto bump = [&](double at_x, double at_y, double half_width, double half_height) {
      return std::exp(
          -0.5 * (std::pow((x - at_x) / half_width, 2) + std::pow((y - at_y) / half_height, 2)));
    };
    return x * x / (2 * kHead_m) - kNose_m * bump(0, 0.42 * eye.y(), 0.009, 0.014) +
           kSocket_m *
               (bump(-eye.x(), eye.y(), 0.012, 0.009) + bump(eye.x(), eye.y(), 0.012, 0.009));
  }
  scene::FacePoints points() const {
    const auto at = [&](const Vector2d& pixel) {
      const Vector2d p = flat(pixel);
      return Vector3d{p.x(), p.y(), z(p.x(), p.y())};
    };
    return {at(photo_.left_eye), at(photo_.right_eye), at(photo_.mouth)};
  }
  /// The grey value at a place of the face, or that of the wall beside it.
  double grey(double x, double y) const {
    const Vector2d pixel = photo_.mouth + Vector2d{x, y} / photo_.m_per_px;
    const int u = static_cast<int>(std::floor(pixel.x()));
    const int v = static_cast<int>(std::floor(pixel.y()));
    const scene::GrayImage& image = photo_.image;
    if (u < 0 || v < 0 || u + 1 >= image.width || v + 1 >= image.height) return 120;
    const double a = pixel.x() - u, b = pixel.y() - v;
    return (1 - b) * ((1 - a) * image.at(u, v) + a * image.at(u + 1, v)) +
           b * ((1 - a) * image.at(u, v + 1) + a * image.at(u + 1, v + 1));
  }

 private:
  Vector2d flat(const Vector2d& pixel) const { return (pixel - photo_.mouth) * photo_.m_per_px; }

  scene::Photo photo_;
};

/// Where a ray from `origin` meets the head: the height is found again where it led to. Noses hide
/// nothing from cameras that stand before them.
double grey_along(const Head& head, const Vector3d& origin, const Vector3d& direction) {
  constexpr int kSteps = 8;
  double t = -origin.z() / direction.z();
  Vector3d at = origin + t * direction;
  for (int step = 0; step < kSteps; ++step) {
    t += 0.9 * (head.z(at.x(), at.y()) - at.z()) / direction.z();
    at = origin + t * direction;
  }
  return head.grey(at.x(), at.y());
}

/// What lies within 0.2 m of the mouth, and the wall around it, with noise of two grey values.
void draw(const Head& head, const Eigen::Isometry3d& camera_T_face, const StereoCamera& camera,
          std::mt19937_64& random, Picture& picture) {
  constexpr double kAround_m = 0.2;
  std::normal_distribution<double> noise{0, 2};
  const Eigen::Isometry3d face_T_camera = camera_T_face.inverse();
  const Vector2d mouth = camera.project_left(camera_T_face.translation());
  const double around_px = kAround_m * camera.focal_px / camera_T_face.translation().z();
  auto* pixel = picture.pixels.data();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const bool is_near = (Vector2d{u, v} - mouth).cwiseAbs().maxCoeff() < around_px;
      const Vector3d direction{(u - camera.cx) / camera.focal_px, (v - camera.cy) / camera.focal_px,
                               1};
      const double grey = is_near ? grey_along(head, face_T_camera.translation(),
                                               face_T_camera.linear() * direction)
                                  : 120;
      *pixel++ = static_cast<std::uint8_t>(std::clamp(std::lround(grey + noise(random)), 0L, 255L));
    }
  }
}

PosedFace relief_face(std::uint64_t seed, double yaw_deg) {
  const Head head{seed};
  const StereoCamera& camera = kDefaultRig;
  std::mt19937_64 random{seed};
  const Eigen::Isometry3d left_T_face =
      Eigen::Translation3d{0.06, 0.03, 0.55} *
      (Eigen::AngleAxisd{yaw_deg * std::numbers::pi / 180, Vector3d::UnitY()} *
       Eigen::AngleAxisd{0.05, Vector3d::UnitX()});
  const Eigen::Translation3d right_T_left{-camera.baseline_m, 0, 0};
  const Picture black = Picture::of_one_grey(0, camera.width, camera.height);
  PosedFace face{.left = black,
                 .right = black,
                 .landmarks = {},
                 .camera = camera,
                 .truth = head.points().in(left_T_face)};
  draw(head, left_T_face, camera, random, face.left);
  draw(head, right_T_left * left_T_face, camera, random, face.right);
  const std::array points{face.truth.left_eye, face.truth.right_eye, face.truth.mouth};
  std::array<Vector2d, 3> in_left, in_right;
  for (std::size_t i = 0; i < points.size(); ++i) {
    in_left[i] = camera.project_left(points[i]);
    in_right[i] = camera.project_right(points[i]);
  }
  face.landmarks = {landmarks_at(in_left), landmarks_at(in_right)};
  return face;
}

TEST(SurfaceOfARelief, KnowsTheNormalOfMouthAndEyesAndHowWell) {
  for (const std::uint64_t seed : {1, 3}) {
    for (const double yaw_deg : {2.0, -18.0}) {
      PluginState state;
      const PosedFace face = relief_face(seed, yaw_deg);
      const auto found = Surface{Parameters{}}.estimate(face.input(), state);
      ASSERT_TRUE(found) << "seed " << seed << ", " << yaw_deg << ": " << found.error().text;
      const double error_deg = error_of(*found, face).normal_deg;
      const double stated_deg =
          std::sqrt(found->normal_covariance.trace()) * 180 / std::numbers::pi;
      EXPECT_LT(error_deg, 1) << "seed " << seed << ", " << yaw_deg;
      EXPECT_LT(error_deg, 2.5 * stated_deg) << "seed " << seed << ", " << yaw_deg;
    }
  }
}

}  // namespace
}  // namespace armature::face_pose::surface
