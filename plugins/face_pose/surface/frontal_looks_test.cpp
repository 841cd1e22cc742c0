// SPDX-License-Identifier: Apache-2.0
// Looks at a frontal view from boxes that lie differently: 1. two suffice when they agree, 2. one
// that goes astray is outvoted, 3. what moves with the box moves as far, however many there are.
#include "frontal_looks.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "face_fit.hpp"
#include "posed_faces_test.hpp"

namespace armature::face_pose::surface {
namespace {

constexpr double kMaxUnsteadiness = 0.06;
const std::array<Eigen::Vector2d, 3> kWhere{{{150, 165}, {270, 165}, {210, 290}}};

/// Finds the features where they are, all but one that is elsewhere in one look, or that moves by a
/// part of what the box moves.
class UnsureFinder final : public LandmarkFinder {
 public:
  std::size_t astray_in = 99;  // this look
  double with_box = 0;         // part of the box's motion
  std::size_t asked = 0;

  LandmarkScheme scheme() const override { return LandmarkScheme::ibug68; }
  Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& box) override {
    std::array<Eigen::Vector2d, 3> at = kWhere;
    if (asked++ == astray_in) at[1] += Eigen::Vector2d{5, 25};
    const Eigen::Vector2d moved{box.left + 0.5 * box.width - 0.5 * (image.width - 1),
                                box.top + 0.5 * box.height - 0.5 * (image.height - 1)};
    at[2] += with_box * moved;
    return landmarks_at(at).points;
  }
};

std::array<SeenFeature, 3> looked_at(LandmarkFinder& finder) {
  const PosedFace face = posed_face({.landmark_error = 0, .max_turn_deg = 0}, 1);
  const Features features{face.camera.project_left(face.truth.left_eye),
                          face.camera.project_left(face.truth.right_eye),
                          face.camera.project_left(face.truth.mouth)};
  Alignment flat;
  flat.surface.c[0] = face.camera.focal_px * face.camera.baseline_m / face.truth.mouth.z();
  FrontalView view;
  view.render(face.left.view(), face.right.view(), flat, features, face.camera);
  return look_at_features(view, finder, kMaxUnsteadiness, true).value();
}

TEST(FrontalLooks, AreTwoWhenTheyAgree) {
  UnsureFinder finder;
  const auto seen = looked_at(finder);
  EXPECT_EQ(finder.asked, 2U);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_LT((seen[i].at - kWhere[i]).norm(), 1e-9);
    EXPECT_EQ(seen[i].moved, 0);
    EXPECT_EQ(seen[i].sigma, 0.3);
  }
}

TEST(FrontalLooks, OutvoteOneThatGoesAstray) {
  for (const std::size_t look : {0U, 1U}) {
    UnsureFinder finder;
    finder.astray_in = look;
    const auto seen = looked_at(finder);
    EXPECT_EQ(finder.asked, 4U);
    EXPECT_LT((seen[1].at - kWhere[1]).norm(), 1e-9);
    EXPECT_EQ(seen[1].moved, 0);
  }
}

TEST(FrontalLooks, SeeAFeatureMoveWithTheBoxAsFarInEightAsInTwo) {
  // Opposite corners are 2 sqrt(2) x 0.06 of a box of 2.4 distances of the eyes apart.
  const double apart = 2 * std::sqrt(2) * 0.06 * 2.4;
  for (const double part : {0.16, 0.5, 1.0}) {
    UnsureFinder finder;
    finder.with_box = part;
    const auto seen = looked_at(finder);
    EXPECT_EQ(finder.asked, 8U) << part;
    EXPECT_NEAR(seen[2].moved, part * apart, 1e-3) << part;
    EXPECT_GT(seen[2].moved, kMaxUnsteadiness) << part;
  }
}

}  // namespace
}  // namespace armature::face_pose::surface
