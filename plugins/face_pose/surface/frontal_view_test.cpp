// SPDX-License-Identifier: Apache-2.0
#include "frontal_view.hpp"

#include <gtest/gtest.h>

#include "face_fit.hpp"
#include "posed_faces_test.hpp"

namespace armature::face_pose::surface {
namespace {

struct Seen {
  PosedFace face;
  Features features;
  Alignment aligned;
  FrontalView view;
};

Seen frontal(const Circumstances& how, std::uint64_t seed) {
  Seen seen{.face = posed_face(how, seed), .view = {}};
  const auto& truth = seen.face.truth;
  const StereoCamera& camera = seen.face.camera;
  seen.features = {camera.project_left(truth.left_eye), camera.project_left(truth.right_eye),
                   camera.project_left(truth.mouth)};
  FaceFit fit;
  fit.look_at(seen.face.left.view(), seen.face.right.view());
  DisparitySurface start{.middle = seen.features.mouth, .reach = 100};
  start.c[0] = camera.focal_px * camera.baseline_m / truth.mouth.z();
  seen.aligned = fit.align(seen.features, {start}).value();
  seen.view.render(seen.face.left.view(), seen.face.right.view(), seen.aligned, seen.features,
                   camera);
  return seen;
}

double correlation(const ImageView& a, const ImageView& b) {
  double n = 0, sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
  for (int v = 60; v < a.height - 60; ++v) {
    for (int u = 60; u < a.width - 60; ++u) {
      const double x = a.data[static_cast<std::size_t>(v) * a.stride + static_cast<std::size_t>(u)];
      const double y = b.data[static_cast<std::size_t>(v) * b.stride + static_cast<std::size_t>(u)];
      n += 1;
      sa += x;
      sb += y;
      aa += x * x;
      bb += y * y;
      ab += x * y;
    }
  }
  return (ab - sa * sb / n) / std::sqrt((aa - sa * sa / n) * (bb - sb * sb / n));
}

TEST(FrontalView, ShowsATurnedFaceAsOneThatLooksStraightAtTheCamera) {
  Seen turned = frontal({.landmark_error = 0, .max_turn_deg = 40}, 6);
  Seen straight = frontal({.landmark_error = 0, .max_turn_deg = 0}, 6);
  EXPECT_GT(correlation(turned.view.image(), straight.view.image()), 0.97);
}

TEST(FrontalView, KnowsWhereInTheLeftPictureAPointOfItIs) {
  // Of a face that is turned far, the middle between its eyes is not where it is in the picture.
  const Seen seen = frontal({.landmark_error = 0, .max_turn_deg = 8}, 2);
  const double eyes = seen.view.eye_distance();
  const PixelBox a = seen.view.face_boxes()[0][0], b = seen.view.face_boxes()[0][1];
  const Eigen::Vector2d middle{0.25 * (a.left + a.right() + b.left + b.right()),
                               0.25 * (a.top + a.bottom() + b.top + b.bottom())};
  const Eigen::Vector2d between_eyes{middle.x(), middle.y() - 0.36 * eyes};
  EXPECT_LT((seen.view.in_left(between_eyes) - seen.features.between_eyes()).norm(), 0.6);
  const auto& truth = seen.face.truth;
  const double down = (truth.mouth - 0.5 * (truth.left_eye + truth.right_eye)).norm();
  const double apart = (truth.right_eye - truth.left_eye).norm();
  const Eigen::Vector2d mouth = between_eyes + Eigen::Vector2d{0, eyes * down / apart};
  EXPECT_LT((seen.view.in_left(mouth) - seen.features.mouth).norm(), 0.6);
}

TEST(FrontalView, ShowsTheMouthOfARoundFaceAsFarBelowItsEyesAsItIs) {
  const scene::Staging round{.surface = {scene::Surface::Shape::sphere, 0.09}};
  const Seen seen = frontal({.staging = round, .landmark_error = 0, .max_turn_deg = 0}, 3);
  ASSERT_FALSE(seen.aligned.surface.is_plane());
  const double eyes = seen.view.eye_distance();
  const auto& truth = seen.face.truth;
  const double down = (truth.mouth - 0.5 * (truth.left_eye + truth.right_eye)).norm() /
                      (truth.right_eye - truth.left_eye).norm();
  const Eigen::Vector2d between_eyes{209.5, 209.5 - 0.36 * eyes};
  const Eigen::Vector2d mouth = between_eyes + Eigen::Vector2d{0, eyes * down};
  // A plane that touches the sphere between the eyes would show it 40 px farther down.
  EXPECT_LT((seen.view.in_left(mouth) - seen.features.mouth).norm(), 4);
}

TEST(FrontalView, IsAsBrightAsFindersExpectOfADarkPicture) {
  Seen dark = frontal({.brightness = 0.1, .noise = 0.5, .landmark_error = 0}, 2);
  const ImageView view = dark.view.image();
  EXPECT_GT(*std::max_element(view.data, view.data + view.stride * 420), 250);
}

}  // namespace
}  // namespace armature::face_pose::surface
