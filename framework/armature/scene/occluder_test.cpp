// SPDX-License-Identifier: Apache-2.0
// An occluder: 1. it hides what its name says and leaves the rest, 2. it stands in front of the
// face at a depth of its own, 3. it has a texture.
#include "armature/scene/occluder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "armature/scene/generated_face.hpp"

namespace armature::scene {
namespace {

using Eigen::Vector3d;

struct Hidden {
  Occluder which;
  bool left_eye, right_eye, mouth;
};
constexpr Hidden kHidden[] = {{Occluder::none, false, false, false},
                              {Occluder::instrument_over_mouth, false, false, true},
                              {Occluder::hand_over_mouth, false, false, true},
                              {Occluder::hand_over_eye, false, true, false},
                              {Occluder::mask, false, false, true}};

TEST(OccluderBody, HidesWhatItsNameSays) {
  const Vector3d eye{0.02, 0.01, -0.6};
  for (const std::uint64_t seed : {1, 6}) {
    const Photo photo = generated_face(seed, 0.063);
    const FacePoints face = face_points(photo, {});
    for (const auto& [which, left_eye, right_eye, mouth] : kHidden) {
      SCOPED_TRACE(static_cast<int>(which));
      const OccluderBody body{which, photo};
      EXPECT_EQ(body.empty(), which == Occluder::none);
      const auto hides = [&](const Vector3d& point) {
        return body.grey({eye, point - eye}).has_value();
      };
      EXPECT_EQ(hides(face.left_eye), left_eye);
      EXPECT_EQ(hides(face.right_eye), right_eye);
      EXPECT_EQ(hides(face.mouth), mouth);
    }
  }
}

TEST(OccluderBody, StandsInFrontOfTheFaceWithinItsBox) {
  const Photo photo = generated_face(1, 0.063);
  std::mt19937_64 random{20210814};
  std::uniform_real_distribution<double> aside{-0.3, 0.3};
  for (const auto& [which, left_eye, right_eye, mouth] : kHidden) {
    if (which == Occluder::none) continue;
    SCOPED_TRACE(static_cast<int>(which));
    const OccluderBody body{which, photo};
    const auto [low, high] = body.box();
    EXPECT_LE(high.z(), 0.0);
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
      // Rays along z: what lies outside of the box is never met.
      const Vector3d from{aside(random), aside(random), -0.5};
      const bool is_beside =
          from.x() < low.x() || from.x() > high.x() || from.y() < low.y() || from.y() > high.y();
      const auto grey = body.grey({from, Vector3d::UnitZ()});
      EXPECT_FALSE(is_beside && grey);
      met += grey.has_value();
    }
    EXPECT_GT(met, 50);
  }
  const OccluderBody mask{Occluder::mask, photo};
  EXPECT_NEAR(mask.box().first.z(), -0.032, 1e-12);
  EXPECT_TRUE(mask.grey({{-0.2, 0, -0.01}, Vector3d::UnitX()}));
  EXPECT_FALSE(mask.grey({{-0.2, 0, 0.01}, Vector3d::UnitX()})) << "it has no half in the head";
}

TEST(OccluderBody, GrowsWithTheFace) {
  const OccluderBody usual{Occluder::hand_over_eye, generated_face(1, 0.063)};
  const OccluderBody large{Occluder::hand_over_eye, generated_face(1, 0.126)};
  EXPECT_TRUE(large.box().first.isApprox(2 * usual.box().first, 1e-9));
  EXPECT_TRUE(large.box().second.isApprox(2 * usual.box().second, 1e-9));
}

TEST(OccluderBody, HasATextureThatADisparityCanBeFoundBy) {
  const Photo photo = generated_face(1, 0.063);
  for (const Occluder which :
       {Occluder::instrument_over_mouth, Occluder::hand_over_mouth, Occluder::mask}) {
    const OccluderBody body{which, photo};
    double sum = 0, squares = 0;
    int count = 0;
    for (int i = -40; i <= 40; ++i) {
      const auto grey = body.grey({{i * 2e-4, 0.0, -0.5}, Vector3d::UnitZ()});
      if (!grey) continue;
      sum += *grey;
      squares += *grey * *grey;
      ++count;
    }
    ASSERT_GT(count, 20);
    EXPECT_GT(std::sqrt(squares / count - sum / count * sum / count), 3);
  }
}

}  // namespace
}  // namespace armature::scene
