// SPDX-License-Identifier: Apache-2.0
// Orientation curves: 1. through every key, 2. rates that are their samples' derivatives, 3. as
// smooth as they say, measured by their jumps, 4. the invariances that they have and have not,
// 5. the shorter way round, 6. keys that make no curve are refused with the reason.
#include "armature/robot/orientations/orientation_curve.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "armature/robot/geometry/rotation_vector.hpp"
#include "armature/robot/orientations/orientation_probe_test.hpp"

namespace armature {
namespace {

using Interpolator = OrientationInterpolator;
using Eigen::Quaterniond;
using Keys = std::vector<Quaterniond>;
using testing::largest_jump;
using testing::total_rotation;
using testing::turn_between;

constexpr std::array kAll{Interpolator::slerp, Interpolator::squad, Interpolator::rotvec_bspline,
                          Interpolator::chart_bspline};

OrientationCurve curve_through(const Keys& keys, Interpolator interpolator,
                               const std::vector<double>& u = {}) {
  return OrientationCurve::through(keys, interpolator, u).value();
}

Quaterniond about_z(double angle) {
  return Quaterniond{Eigen::AngleAxisd{angle, Eigen::Vector3d::UnitZ()}};
}

Keys transformed(const Quaterniond& left, const Keys& keys, const Quaterniond& right) {
  Keys result;
  for (const Quaterniond& key : keys) result.push_back(left * key * right);
  return result;
}

class OrientationCurves : public ::testing::Test {
 protected:
  Keys keys(std::size_t count) { return testing::random_keys(random_, count); }
  std::vector<double> uneven(std::size_t count) {
    std::uniform_real_distribution<double> step{0.2, 1.8};
    std::vector<double> u{step(random_)};
    while (u.size() < count) u.push_back(u.back() + step(random_));
    return u;
  }
  /// The largest angle between two curves at the same parameters.
  static double difference(const OrientationCurve& a, const OrientationCurve& b,
                           const Quaterniond& left, const Quaterniond& right) {
    double largest = 0;
    for (const double u : testing::parameters_along(a, 20)) {
      largest = std::max(largest, turn_between(left * a.at(u).rotation * right, b.at(u).rotation));
    }
    return largest;
  }
  const ::testing::ScopedTrace seed_{__FILE__, __LINE__, "seed 33"};
  std::mt19937_64 random_{33};
};

TEST_F(OrientationCurves, GoThroughEveryKeyWhateverItsSign) {
  for (int i = 0; i < 100; ++i) {
    Keys some = keys(6);
    for (const Interpolator each : kAll) {
      const OrientationCurve curve = curve_through(some, each);
      ASSERT_EQ(curve.key_parameters().size(), some.size());
      EXPECT_EQ(curve.key_parameters().front(), 0);
      EXPECT_EQ(curve.key_parameters().back(), 1);
      for (std::size_t k = 0; k < some.size(); ++k) {
        EXPECT_LE(turn_between(curve.at(curve.key_parameters()[k]).rotation, some[k]), 3e-14);
      }
      Keys other_signs = some;
      for (std::size_t k = 0; k < some.size(); k += 2) other_signs[k].coeffs() *= -1;
      EXPECT_LE(difference(curve, curve_through(other_signs, each), Quaterniond::Identity(),
                           Quaterniond::Identity()),
                1e-13);
    }
  }
}

TEST_F(OrientationCurves, HaveTheVelocityAndAccelerationThatTheirSamplesShow) {
  constexpr double h = 1e-5;
  for (int i = 0; i < 20; ++i) {
    const Keys some = keys(5);
    const std::vector<double> u = uneven(5);
    for (const Interpolator each : kAll) {
      const OrientationCurve curve = curve_through(some, each, u);
      for (const double at : testing::parameters_along(curve, 7)) {
        const auto smooth = [&](double start) { return std::abs(start - at) > 2 * h; };
        const auto& starts = curve.piece_starts();
        if (!std::all_of(starts.begin(), starts.end(), smooth)) continue;
        if (at > u.back() - 2 * h) continue;
        const OrientationState before = curve.at(at - h), here = curve.at(at),
                               behind = curve.at(at + h);
        const Eigen::Vector3d turned =
            rotation_vector_of(behind.rotation * before.rotation.conjugate());
        EXPECT_LE((turned / (2 * h) - here.velocity).norm(), 1e-5);
        EXPECT_LE(((behind.velocity - before.velocity) / (2 * h) - here.acceleration).norm(),
                  1e-5 * (1 + here.acceleration.norm()));
      }
    }
  }
}

/// What the jumps across a point do when they are looked at from ten times nearer.
enum class Seen { shrinks, stays };
Seen seen(double far, double near) {
  EXPECT_TRUE(near < 0.15 * far || near > 0.85 * far) << far << " to " << near;
  return near < 0.5 * far ? Seen::shrinks : Seen::stays;
}

/// With even, uneven and proportional parameters.
TEST_F(OrientationCurves, AreAsSmoothAtTheirKeysAsTheySay) {
  struct Smoothness {
    Interpolator interpolator;
    Seen velocity, acceleration;
  };
  for (const Smoothness& expected :
       {Smoothness{Interpolator::slerp, Seen::stays, Seen::stays},
        Smoothness{Interpolator::squad, Seen::shrinks, Seen::stays},
        Smoothness{Interpolator::rotvec_bspline, Seen::shrinks, Seen::shrinks},
        Smoothness{Interpolator::chart_bspline, Seen::shrinks, Seen::shrinks}}) {
    const Keys some = keys(6);
    for (const auto& u : {std::vector<double>{}, std::vector<double>{0, 0.2, 0.4, 0.6, 0.8, 1},
                          std::vector<double>{0, 0.3, 0.4, 0.5, 0.8, 1}}) {
      const OrientationCurve curve = curve_through(some, expected.interpolator, u);
      const auto far = largest_jump(curve, 1e-4), near = largest_jump(curve, 1e-5);
      SCOPED_TRACE(static_cast<int>(expected.interpolator));
      EXPECT_EQ(seen(far.rotation, near.rotation), Seen::shrinks);
      EXPECT_EQ(seen(far.velocity, near.velocity), expected.velocity);
      if (expected.interpolator != Interpolator::slerp) {  // which has no acceleration on its arcs
        EXPECT_EQ(seen(far.acceleration, near.acceleration), expected.acceleration);
      }
    }
  }
}

TEST_F(OrientationCurves, WithoutParametersRunAtOneSpeedFromBlendToBlend) {
  const Keys some = keys(6);
  const OrientationCurve arcs = curve_through(some, Interpolator::slerp);
  const OrientationCurve blended = curve_through(some, Interpolator::chart_bspline);
  const double speed = total_rotation(arcs);
  const auto& u = blended.key_parameters();
  for (std::size_t i = 1; i < u.size(); ++i) {
    const double middle = 0.5 * (u[i - 1] + u[i]);
    EXPECT_NEAR(arcs.at(middle).velocity.norm(), speed, 1e-9);
    EXPECT_LE(arcs.at(middle).acceleration.norm(), 1e-13);
    if (i > 1 && i + 1 < u.size()) continue;  // between two blends there may be no line
    const double line = i == 1 ? 0.5 * middle : 0.5 * (middle + 1);
    EXPECT_NEAR(blended.at(line).velocity.norm(), speed, 1e-9);
    EXPECT_LE(blended.at(line).acceleration.norm(), 1e-9);
    EXPECT_LE(turn_between(blended.at(line).rotation, arcs.at(line).rotation), 1e-13);
  }
}

TEST_F(OrientationCurves, ThroughTwoKeysAreOneArcExceptInTheChartOfTheBase) {
  for (int i = 0; i < 100; ++i) {
    const Keys some = keys(2);
    const OrientationCurve arc = curve_through(some, Interpolator::slerp);
    for (const Interpolator each : {Interpolator::squad, Interpolator::chart_bspline}) {
      EXPECT_LE(difference(arc, curve_through(some, each), Quaterniond::Identity(),
                           Quaterniond::Identity()),
                1e-13);
    }
    EXPECT_GE(total_rotation(curve_through(some, Interpolator::rotvec_bspline)),
              total_rotation(arc) - 1e-6);
  }
}

TEST_F(OrientationCurves, DoNotDependOnTheFramesExceptInTheChartOfTheBase) {
  for (int i = 0; i < 100; ++i) {
    const Keys some = keys(5), turn = keys(2);
    for (const Interpolator each :
         {Interpolator::slerp, Interpolator::squad, Interpolator::chart_bspline}) {
      const OrientationCurve moved = curve_through(transformed(turn[0], some, turn[1]), each);
      EXPECT_LE(difference(curve_through(some, each), moved, turn[0], turn[1]), 1e-11);
    }
  }
}

/// R q R^-1 turns every rotation vector by R; R q alone does not.
TEST_F(OrientationCurves, InTheChartOfTheBaseDependOnTheBaseButNotOnTheNamesOfItsAxes) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 100; ++i) {
    const Keys some = keys(5);
    const Quaterniond turn = keys(1)[0], none = Quaterniond::Identity();
    const OrientationCurve curve = curve_through(some, Interpolator::rotvec_bspline);
    const OrientationCurve renamed =
        curve_through(transformed(turn, some, turn.conjugate()), Interpolator::rotvec_bspline);
    EXPECT_LE(difference(curve, renamed, turn, turn.conjugate()), 1e-12);
    const OrientationCurve moved = curve_through(
        transformed(turn, some, none), Interpolator::rotvec_bspline, curve.key_parameters());
    const OrientationCurve fixed =
        curve_through(some, Interpolator::rotvec_bspline, curve.key_parameters());
    least = std::min(least, difference(fixed, moved, turn, none));
  }
  EXPECT_GE(least, 0.1);
}

TEST_F(OrientationCurves, AcrossHalfATurnAllButTheRotationVectorsGoTheShortWay) {
  const Keys across{about_z(3.1), about_z(3.3)};
  for (const Interpolator each :
       {Interpolator::slerp, Interpolator::squad, Interpolator::chart_bspline}) {
    EXPECT_NEAR(total_rotation(curve_through(across, each)), 0.2, 1e-9);
  }
  EXPECT_NEAR(total_rotation(curve_through(across, Interpolator::rotvec_bspline)), 2 * M_PI - 0.2,
              1e-9);
}

TEST_F(OrientationCurves, HoldTheirEndsBeyondThem) {
  for (const Interpolator each : kAll) {
    const OrientationCurve curve = curve_through(keys(4), each);
    EXPECT_EQ(curve.at(-1).rotation.coeffs(), curve.at(0).rotation.coeffs());
    EXPECT_EQ(curve.at(2).rotation.coeffs(), curve.at(1).rotation.coeffs());
  }
}

TEST_F(OrientationCurves, StandStillBetweenEqualKeysWithParametersOfTheirOwn) {
  const Keys some{about_z(0), about_z(1), about_z(1), about_z(0.5)};
  for (const Interpolator each : {Interpolator::slerp, Interpolator::chart_bspline}) {
    const OrientationCurve curve = curve_through(some, each, {0, 1, 2, 3});
    EXPECT_LE(curve.at(1.5).velocity.norm(), 1e-12);
    EXPECT_LE(turn_between(curve.at(1.5).rotation, about_z(1)), 1e-12);
  }
}

std::string refusal(const Keys& keys, Interpolator interpolator = Interpolator::chart_bspline,
                    const std::vector<double>& u = {}) {
  const auto curve = OrientationCurve::through(keys, interpolator, u);
  return curve ? "a curve" : curve.error().text;
}

TEST(OrientationCurve, RefusesKeysThatMakeNoneWithTheReason) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Quaterniond here = about_z(0.3);
  for (const Interpolator each : kAll) {
    EXPECT_EQ(refusal({}, each), "an orientation curve needs two keys or more, not 0");
    EXPECT_EQ(refusal({here}, each), "an orientation curve needs two keys or more, not 1");
    EXPECT_EQ(refusal({here, {nan, 0, 0, 0}}, each), "key 2 is not finite");
    EXPECT_EQ(refusal({{0, 0, 0, 0}, here}, each), "key 1 has length 0, not 1");
    EXPECT_EQ(refusal({here, {0, 1.02, 0, 0}}, each), "key 2 has length 1.02, not 1");
    EXPECT_EQ(refusal({about_z(0), here, here}, each),
              "keys 2 and 3 are equal: they need parameters");
    EXPECT_EQ(refusal({about_z(1), here, about_z(0.3 - M_PI)}, each),
              "keys 2 and 3 are antipodal: half a turn apart, either way is as short");
    EXPECT_EQ(refusal({about_z(0), here}, each, {0, 1, 2}), "3 parameters for 2 keys");
    EXPECT_EQ(refusal({about_z(0), here}, each, {0, nan}), "parameter 2 is not finite");
    EXPECT_EQ(refusal({about_z(0), here}, each, {1, 1}),
              "the parameters do not ascend from key 1 to key 2");
  }
  EXPECT_EQ(refusal({about_z(1), about_z(M_PI)}, Interpolator::rotvec_bspline),
            "key 2 is half a turn: its rotation vector has two signs");
}

TEST(OrientationCurve, MakesKeysThatAreNearlyUnitsSuch) {
  Keys keys{about_z(0), about_z(1)};
  keys[1].coeffs() *= 1.005;
  const OrientationCurve curve = curve_through(keys, Interpolator::chart_bspline);
  EXPECT_NEAR(curve.at(1).rotation.norm(), 1, 1e-15);
}

TEST(OrientationCurve, InterpolatorsAreKnownByTheirNames) {
  EXPECT_EQ(orientation_interpolator("slerp"), Interpolator::slerp);
  EXPECT_EQ(orientation_interpolator("squad"), Interpolator::squad);
  EXPECT_EQ(orientation_interpolator("rotvec_bspline"), Interpolator::rotvec_bspline);
  EXPECT_EQ(orientation_interpolator("chart_bspline"), Interpolator::chart_bspline);
  EXPECT_FALSE(orientation_interpolator("nlerp"));
}

}  // namespace
}  // namespace armature
