// SPDX-License-Identifier: Apache-2.0
// A surface: 1. the ray to a place of the photo meets that place, 2. lengths stay as they were on
// the flat photo, 3. what lies behind is hidden.
#include "armature/scene/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace armature::scene {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr Surface kSurfaces[] = {{Surface::Shape::plane, 0.09},
                                 {Surface::Shape::cylinder, 0.09},
                                 {Surface::Shape::sphere, 0.09},
                                 {Surface::Shape::cylinder, 0.15}};

TEST(Surface, IsMetByTheRayToAPlaceOfThePhotoAtThatPlace) {
  std::mt19937_64 random{20210813};
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  for (const Surface& surface : kSurfaces) {
    for (int i = 0; i < 1000; ++i) {
      const Vector2d flat{draw(-0.07, 0.07), draw(-0.09, 0.06)};
      const Vector3d eye{draw(-0.1, 0.1), draw(-0.1, 0.1), draw(-1.2, -0.3)};
      const Vector3d at = surface.point(flat);
      const auto met = surface.met_by({eye, at - eye});
      ASSERT_TRUE(met);
      // Near the rim of a sphere the eye may see another place before this one.
      const Vector3d seen = surface.point(*met);
      EXPECT_LE((seen - eye).norm(), (at - eye).norm() + 1e-12);
      if ((seen - at).norm() < 1e-3) {
        EXPECT_LT((*met - flat).norm(), 1e-6);
      }
      EXPECT_LT((seen - eye).cross(at - eye).norm(), 1e-12) << "it lies on the ray";
    }
  }
}

TEST(Surface, KeepsLengthsOfTheFlatPhoto) {
  constexpr double h = 1e-6;
  for (const Surface& surface : kSurfaces) {
    for (const Vector2d& flat : {Vector2d{0.03, -0.05}, {-0.06, 0.02}, {0.05, 0.07}}) {
      // On the sphere only along the line to the mouth; on the others in every direction.
      const bool is_sphere = surface.shape == Surface::Shape::sphere;
      for (const Vector2d& along :
           {flat.normalized(), is_sphere ? flat.normalized() : Vector2d::UnitX().eval(),
            is_sphere ? flat.normalized() : Vector2d::UnitY().eval()}) {
        const Vector3d step = surface.point(flat + h * along) - surface.point(flat - h * along);
        EXPECT_NEAR(step.norm() / (2 * h), 1, 1e-6);
      }
    }
    EXPECT_TRUE(surface.point({0, 0}).isZero());
    EXPECT_LT((surface.point({h, 0}) - Vector3d{h, 0, 0}).norm(), 1e-10) << "it touches z = 0";
  }
}

TEST(Surface, IsNotMetByRaysThatPassOrComeFromBehind) {
  for (const Surface& surface : kSurfaces) {
    EXPECT_FALSE(surface.met_by({{0, 0, -0.5}, {0, 0, -1}}));
    if (surface.shape == Surface::Shape::plane) {
      EXPECT_FALSE(surface.met_by({{0, 0, 0.5}, {0, 0, -1}}));
      EXPECT_FALSE(surface.met_by({{0, 0, -0.5}, {1, 0, 0}}));
    } else {
      EXPECT_FALSE(surface.met_by({{0.2, 0, -0.5}, {0, 0, 1}}));
      // From behind it meets the back of the head, which is half a turn away from the mouth.
      const auto back = surface.met_by({{0.001, 0, 0.9}, {0, 0, -1}});
      ASSERT_TRUE(back);
      EXPECT_GT(back->norm(), 0.9 * M_PI * surface.radius_m);
    }
  }
}

TEST(Surface, HidesWhatLiesBehindItsOwnRim) {
  const Surface cylinder{Surface::Shape::cylinder, 0.08};
  const Vector3d eye{-0.5, 0, -0.2};
  const Vector2d behind{0.10, 0};  // on the other side of the head
  const auto met = cylinder.met_by({eye, cylinder.point(behind) - eye});
  ASSERT_TRUE(met);
  EXPECT_LT(met->x(), 0);
}

TEST(FacePoints, HaveTheNormalOfThePaperWhichComesOutOfTheFace) {
  const FacePoints flat{{-0.03, -0.06, 0}, {0.03, -0.06, 0}, {0, 0, 0}};
  EXPECT_TRUE(flat.normal().isApprox(Vector3d{0, 0, -1}));
  const Eigen::Isometry3d turned{Eigen::AngleAxisd{0.3, Vector3d::UnitY()}};
  EXPECT_TRUE(flat.in(turned).normal().isApprox(turned.linear() * Vector3d{0, 0, -1}));
}

}  // namespace
}  // namespace armature::scene
