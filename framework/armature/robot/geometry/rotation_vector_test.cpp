// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/geometry/rotation_vector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "armature/robot/orientations/rotation_at.hpp"

namespace armature {
namespace {

class RotationVectors : public ::testing::Test {
 protected:
  Eigen::Vector3d vector_of_length(double length) {
    return length *
           Eigen::Vector3d{normal_(random_), normal_(random_), normal_(random_)}.normalized();
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random_);
  }
  const ::testing::ScopedTrace seed_{__FILE__, __LINE__, "seed 31"};
  std::mt19937_64 random_{31};
  std::normal_distribution<double> normal_;
};

TEST_F(RotationVectors, GoToQuaternionsAndBack) {
  double largest = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Eigen::Vector3d P = vector_of_length(between(0, M_PI));
    const Eigen::Quaterniond q = RotationAt{P}.rotation();
    ASSERT_NEAR(q.norm(), 1, 1e-15);
    largest = std::max(largest, (rotation_vector_of(q) - P).norm());
  }
  EXPECT_LE(largest, 4e-15);
}

TEST_F(RotationVectors, KeepAllDigitsOfTheSmallestTurns) {
  for (const double length : {1e-3, 1e-8, 1e-9, 1e-30, 1e-150}) {
    const Eigen::Vector3d P = vector_of_length(length);
    const Eigen::Vector3d back = rotation_vector_of(RotationAt{P}.rotation());
    EXPECT_LE((back - P).norm(), 1e-15 * length) << length;
  }
  EXPECT_EQ(rotation_vector_of(RotationAt{Eigen::Vector3d::Zero()}.rotation()),
            Eigen::Vector3d::Zero());
}

TEST_F(RotationVectors, AreThoseOfTheShorterWayWhateverTheSignOfTheQuaternion) {
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d P = vector_of_length(between(0.01, M_PI - 0.01));
    const Eigen::Quaterniond q = RotationAt{P}.rotation(), minus{-q.coeffs()};
    EXPECT_LE((rotation_vector_of(minus) - P).norm(), 1e-13);
    EXPECT_LE((double_logarithm(q) - P).norm(), 1e-13);
    const Eigen::Vector3d other_way = (P.norm() - 2 * M_PI) * P.normalized();
    EXPECT_LE((double_logarithm(minus) - other_way).norm(), 1e-12);
  }
}

TEST_F(RotationVectors, OfHalfATurnHaveTheLengthPiAndEitherSign) {
  const Eigen::Vector3d axis = vector_of_length(1);
  const Eigen::Quaterniond q{0, axis.x(), axis.y(), axis.z()}, minus{-q.coeffs()};
  EXPECT_LE((rotation_vector_of(q) - M_PI * axis).norm(), 1e-15);
  EXPECT_LE((rotation_vector_of(minus) + M_PI * axis).norm(), 1e-15);
}

TEST_F(RotationVectors, TurnWithTheVelocityAndAccelerationThatDifferencesShow) {
  constexpr double h = 1e-5;
  for (const double length : {0.0, 1e-9, 1e-3, 0.3, 0.4999, 0.5001, 1.0, 3.1, 5.0, 6.2}) {
    const Eigen::Vector3d P = vector_of_length(length), dP = vector_of_length(1.3),
                          ddP = vector_of_length(0.7);
    const auto at = [&](double x) { return RotationAt{P + x * dP + 0.5 * x * x * ddP}; };
    const auto rate = [&](double x) { return Eigen::Vector3d{dP + x * ddP}; };
    const Eigen::Quaterniond step = at(h).rotation() * at(-h).rotation().conjugate();
    EXPECT_LE((at(0).velocity(dP) - rotation_vector_of(step) / (2 * h)).norm(), 1e-9) << length;
    const Eigen::Vector3d change = at(h).velocity(rate(h)) - at(-h).velocity(rate(-h));
    EXPECT_LE((at(0).acceleration(dP, ddP) - change / (2 * h)).norm(), 1e-9) << length;
  }
}

TEST_F(RotationVectors, HaveNoStepWhereTheSeriesEnds) {
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d axis = vector_of_length(1), dP = vector_of_length(1),
                          ddP = vector_of_length(1);
    const RotationAt below{(0.5 - 1e-15) * axis}, above{(0.5 + 1e-15) * axis};
    EXPECT_LE((below.velocity(dP) - above.velocity(dP)).norm(), 1e-14);
    EXPECT_LE((below.acceleration(dP, ddP) - above.acceleration(dP, ddP)).norm(), 1e-13);
    EXPECT_LE((below.rate_of(dP) - above.rate_of(dP)).norm(), 1e-14);
  }
}

TEST_F(RotationVectors, RatesAreFoundFromTheAngularVelocity) {
  for (int i = 0; i < 10'000; ++i) {
    const RotationAt at{vector_of_length(between(0, 6))};
    const Eigen::Vector3d dP = vector_of_length(1);
    EXPECT_LE((at.rate_of(at.velocity(dP)) - dP).norm(), 1e-12);
  }
}

TEST_F(RotationVectors, DoNotChangeWithTheAngularVelocityButAlongIt) {
  const RotationAt at{Eigen::Vector3d{0, 0, 1}};
  EXPECT_LE((at.velocity(Eigen::Vector3d::UnitZ()) - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
  // J_l about z by 1 rad turns a small turn about x by half of it, and shortens it.
  const Eigen::Vector3d omega = at.velocity(Eigen::Vector3d::UnitX());
  EXPECT_LE((omega - Eigen::Vector3d{std::sin(1.0), 1 - std::cos(1.0), 0}).norm(), 1e-15);
}

}  // namespace
}  // namespace armature
