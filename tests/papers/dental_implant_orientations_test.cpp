// SPDX-License-Identifier: Apache-2.0
// Zhong et al.: curves through many orientations. The figures of Table 3 in
// tests/data/dental_implant_reference.yaml, and what of Table 5 holds for other keys.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "armature/robot/geometry/rotation_vector.hpp"
#include "armature/robot/orientations/corner_blend.hpp"
#include "armature/robot/orientations/orientation_curve.hpp"
#include "armature/robot/orientations/orientation_probe_test.hpp"
#include "armature/robot/orientations/rotation_at.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Interpolator = OrientationInterpolator;
using testing::turn_between;

constexpr double kDigits = 2e-12;  // the figures have 12

Quaterniond quaternion(const Figures& wxyz) {
  const Eigen::VectorXd q = wxyz.numbers();
  return Quaterniond{q[0], q[1], q[2], q[3]};
}

std::vector<Quaterniond> table3() {
  const Figures printed = dental_implant()["table3"]["quaternions"];
  std::vector<Quaterniond> keys;
  for (std::size_t i = 0; i < printed.size(); ++i) {
    keys.push_back(quaternion(printed[i]).normalized());
  }
  return keys;
}

std::vector<Vector3d> table3_vectors() {
  std::vector<Vector3d> vectors;
  for (const Quaterniond& key : table3()) vectors.push_back(rotation_vector_of(key));
  return vectors;
}

OrientationCurve curve(Interpolator interpolator, const std::vector<double>& u = {}) {
  return OrientationCurve::through(table3(), interpolator, u).value();
}

/// Sum of the turns in so many even steps of u: what a sampled reference sees.
double rotation_in_steps(const OrientationCurve& of, double from, double to, int steps) {
  double total = 0;
  for (int i = 0; i < steps; ++i) {
    const auto at = [&](int k) { return of.at(std::lerp(from, to, double(k) / steps)).rotation; };
    total += turn_between(at(i), at(i + 1));
  }
  return total;
}

Vector3d on_the_way(const Vector3d& from, const Vector3d& to, double length) {
  return from + length * (to - from).normalized();
}

/// A, B, C of Table 3 and D, E at l0 from B.
struct PaperPoints {
  std::vector<Vector3d> key = table3_vectors();
  Vector3d A = key[0], B = key[1], C = key[2];
  double l0 = 0.5 * std::min((A - B).norm(), (C - B).norm());
  Vector3d D = on_the_way(B, A, l0), E = on_the_way(B, C, l0);
  CornerControls controls = corner_controls(D, B, E, D - A, C - E);
};

TEST(DentalImplantOrientations, TheQuaternionsOfTable3AreItsRotationVectors) {
  const Figures printed = dental_implant()["table3"];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d P = printed["rotation_vectors"][i].numbers();
    const Quaterniond q = quaternion(printed["quaternions"][i]);
    EXPECT_LE((RotationAt{P}.rotation().coeffs() - q.coeffs()).norm(), kDigits);  // (3)
    EXPECT_LE((rotation_vector_of(q) - P).norm(), 2 * kDigits);                   // (2)
  }
  const auto keys = table3();
  EXPECT_NEAR(turn_between(keys[0], keys[1]), printed["geodesic_AB"].number(), 2 * kDigits);
  EXPECT_NEAR(turn_between(keys[1], keys[2]), printed["geodesic_BC"].number(), 2 * kDigits);
}

TEST(DentalImplantOrientations, TheBlendHasTheBasisOfTheQuasiUniformKnots) {
  const Eigen::VectorXd basis = dental_implant()["paper_spline"]["basis_at_half"].numbers();
  for (std::size_t i = 0; i < 7; ++i) {
    CornerControls unit;
    unit.fill(Vector3d::Zero());
    unit[i] = Vector3d::UnitX();
    const auto pieces = cubics_of(unit, 1);
    EXPECT_NEAR(pieces[1].value(0.25).x(), basis[static_cast<Eigen::Index>(i)], kDigits);
  }
}

/// (15): the second derivative at an end is 96 d0 - 144 d1 + 48 d2, the first 12 (d1 - d0).
TEST(DentalImplantOrientations, TheFactorsOfEquation15AreRight) {
  SCOPED_TRACE("seed 41");
  std::mt19937_64 random{41};
  std::normal_distribution<double> normal;
  for (int n = 0; n < 100; ++n) {
    CornerControls d;
    for (Vector3d& point : d) point = Vector3d{normal(random), normal(random), normal(random)};
    const auto pieces = cubics_of(d, 1);
    EXPECT_LE((pieces[0].first(0) - 12 * (d[1] - d[0])).norm(), 1e-13);
    EXPECT_LE((pieces[3].first(0.25) - 12 * (d[6] - d[5])).norm(), 1e-12);
    EXPECT_LE((pieces[0].second(0) - (96 * d[0] - 144 * d[1] + 48 * d[2])).norm(), 1e-11);
    EXPECT_LE((pieces[3].second(0.25) - (96 * d[6] - 144 * d[5] + 48 * d[4])).norm(), 1e-11);
  }
}

TEST(DentalImplantOrientations, TheControlPointsAreTheReferences) {
  const PaperPoints points;
  const Figures printed = dental_implant()["paper_spline"];
  EXPECT_LE((points.D - printed["D"].numbers()).norm(), 3 * kDigits);
  EXPECT_LE((points.E - printed["E"].numbers()).norm(), 3 * kDigits);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_LE((points.controls[i] - printed["control_points"][i].numbers()).norm(), 5 * kDigits);
  }
}

/// s counts pieces, u runs from 0 to 1: d/ds = 1/3 d/du. The reference's alpha is the difference of
/// omega 1e-5 before and behind s, at the ends 0.001 inside.
TEST(DentalImplantOrientations, RotationVelocityAndAccelerationOfThePapersSplineAreTheReferences) {
  const OrientationCurve spline = curve(Interpolator::rotvec_bspline);
  const auto omega = [&](double s) { return Vector3d{spline.at(s / 3).velocity / 3}; };
  const Figures samples = dental_implant()["paper_spline"]["samples"];
  ASSERT_EQ(samples.size(), 13u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double s = samples[i]["s"].number(), inside = std::clamp(s, 0.001, 2.999);
    SCOPED_TRACE(s);
    const OrientationState state = spline.at(s / 3);
    EXPECT_LE((rotation_vector_of(state.rotation) - samples[i]["P"].numbers()).norm(), 5 * kDigits);
    EXPECT_LE(turn_between(state.rotation, quaternion(samples[i]["q"]).normalized()), 5 * kDigits);
    EXPECT_LE((omega(s) - samples[i]["omega"].numbers()).norm(), 1e-10);
    const Vector3d alpha = samples[i]["alpha"].numbers();
    const Vector3d difference = (omega(inside + 1e-5) - omega(inside - 1e-5)) / 2e-5;
    EXPECT_LE((difference - alpha).norm(), 1e-9);
    EXPECT_LE((state.acceleration / 9 - alpha).norm(), 6e-4);
    const bool smooth_here = inside == s && (s < 1 || s > 2);
    if (smooth_here) {
      EXPECT_LE((state.acceleration / 9 - alpha).norm(), 1e-9);
    }
  }
}

/// Without the step lengths that a reference was sampled with its sums agree to 6e-6.
TEST(DentalImplantOrientations, TheTotalRotationsOfTable3AreTheReferences) {
  const Figures printed = dental_implant()["table3"];
  const OrientationCurve slerp = curve(Interpolator::slerp),
                         squad = curve(Interpolator::squad, {0, 0.5, 1}),
                         paper = curve(Interpolator::rotvec_bspline),
                         chart = curve(Interpolator::chart_bspline);
  EXPECT_NEAR(testing::total_rotation(slerp), printed["slerp_total"].number(), 3e-12);
  EXPECT_NEAR(rotation_in_steps(squad, 0, 1, 2000), printed["squad_total"].number(), 5e-12);
  EXPECT_NEAR(rotation_in_steps(paper, 0, 1, 3000), printed["paper_spline_total"].number(), 5e-12);
  const auto keys = table3();
  double lines = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<Quaterniond> two{keys[i], keys[i + 1]};
    lines += testing::total_rotation(
        OrientationCurve::through(two, Interpolator::rotvec_bspline).value());
  }
  EXPECT_NEAR(lines, printed["rotvec_polyline_total"].number(), 1e-6);
  EXPECT_NEAR(testing::total_rotation(chart),
              dental_implant()["chart_at_key_spline"]["total_table3"].number(), 6e-6);
}

TEST(DentalImplantOrientations, ThePeaksOfThePapersSplineAreTheReferences) {
  const OrientationCurve paper = curve(Interpolator::rotvec_bspline);
  const Figures printed = dental_implant()["paper_spline"];
  const auto peaks = testing::peaks_of(paper);
  EXPECT_NEAR(peaks.velocity / 3, printed["max_omega"].number(), 1e-6);
  // The reference's is the largest of its differences, which stay below the peak at B.
  EXPECT_GE(peaks.acceleration / 9, printed["max_alpha"].number());
  EXPECT_NEAR(peaks.acceleration / 9, printed["max_alpha"].number(), 6e-3);
}

TEST(DentalImplantOrientations, ThePapersSplineLeavesTheLinesByAsMuchAsTheReference) {
  const PaperPoints points;
  const auto to_line = [](const Vector3d& P, const Vector3d& from, const Vector3d& to) {
    const double part = std::clamp((P - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    return (P - from - part * (to - from)).norm();
  };
  const OrientationCurve paper = curve(Interpolator::rotvec_bspline);
  double largest = 0;
  for (int i = 0; i <= 3000; ++i) {
    const Vector3d P = rotation_vector_of(paper.at(i / 3000.0).rotation);
    largest =
        std::max(largest, std::min(to_line(P, points.A, points.B), to_line(P, points.B, points.C)));
  }
  EXPECT_NEAR(largest, dental_implant()["paper_spline"]["max_deviation_from_polyline"].number(),
              2e-7);
}

TEST(DentalImplantOrientations,
     ThePapersSplineIsSmoothToTheSecondDerivativeWithThreeEqualDurations) {
  const OrientationCurve paper = curve(Interpolator::rotvec_bspline);
  for (const double s : {1.0, 2.0}) {
    for (const double eps : {1e-2, 1e-3, 1e-4}) {
      const auto jump = testing::jump_at(paper, s / 3, eps / 3);
      EXPECT_NEAR(jump.acceleration / 9, 31 * eps, 0.5 * eps);
    }
    EXPECT_LE(testing::jump_at(paper, s / 3, 1e-7 / 3).velocity / 3, 1e-8);
  }
}

/// The same control points, each piece as long as its line: omega jumps at D and at E.
TEST(DentalImplantOrientations, WithDurationsInProportionThePapersSplineIsNotEvenSmoothOnce) {
  const PaperPoints points;
  const double AD = (points.D - points.A).norm(), EC = (points.C - points.E).norm();
  const double unit = (AD + 2 * points.l0 + EC) / 3;  // three units in all
  const auto jump = [&](const Vector3d& at, const Vector3d& step, double duration) {
    const Vector3d before = step / (duration / unit), in_blend = step / (2 * points.l0 / unit);
    return RotationAt{at}.velocity(before - in_blend).norm();
  };
  EXPECT_NEAR(jump(points.D, points.D - points.A, AD), 0.38, 0.005);
  EXPECT_NEAR(jump(points.E, points.C - points.E, EC), 0.39, 0.005);
}

TEST(DentalImplantOrientations, TheBlendInTheChartAtItsKeyIsTheReferences) {
  const Figures printed = dental_implant()["chart_at_key_spline"];
  const auto keys = table3();
  const Quaterniond& B = keys[1];
  const Vector3d A_in_B = rotation_vector_of(B.conjugate() * keys[0]),
                 C_in_B = rotation_vector_of(B.conjugate() * keys[2]);
  const double l0 = 0.5 * std::min(A_in_B.norm(), C_in_B.norm());
  EXPECT_NEAR(l0, printed["l0"].number(), kDigits);
  const Vector3d D = l0 * A_in_B.normalized(), E = l0 * C_in_B.normalized();
  const CornerControls controls = corner_controls(D, Vector3d::Zero(), E, -2 * D, 2 * E);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_LE((controls[i] - printed["control_points"][i].numbers()).norm(), 5 * kDigits);
  }
  const OrientationCurve chart = curve(Interpolator::chart_bspline);
  const double whole = A_in_B.norm() + C_in_B.norm();
  const Figures samples = printed["samples_q"];
  ASSERT_EQ(samples.size(), 11u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double u = (A_in_B.norm() + l0 * (0.2 * static_cast<double>(i) - 1)) / whole;
    EXPECT_LE(turn_between(chart.at(u).rotation, quaternion(samples[i]).normalized()), 5 * kDigits);
  }
}

/// The table of plugins/path/orientations/README.md: Table 3, u from 0 to 1.
TEST(DentalImplantOrientations, TheInterpolatorsCompareAsTheTableSays) {
  const auto turn = table3_vectors();
  const double AB = (turn[1] - turn[0]).norm(), BC = (turn[2] - turn[1]).norm();
  struct Row {
    OrientationCurve curve;
    double total, velocity, acceleration;
  };
  const Row rows[]{
      {curve(Interpolator::slerp), 2.3128, 2.313, 0},
      {curve(Interpolator::squad, {0, 0.5, 1}), 2.3517, 2.999, 17.1},
      {curve(Interpolator::rotvec_bspline), 2.3305, 5.502, 175.7},
      {curve(Interpolator::rotvec_bspline, {0, AB / (AB + BC), 1}), 2.3248, 2.922, 52.4},
      {curve(Interpolator::chart_bspline), 2.3249, 2.896, 51.9},
  };
  for (const Row& row : rows) {
    EXPECT_NEAR(testing::total_rotation(row.curve), row.total, 5.1e-5);
    const auto peaks = testing::peaks_of(row.curve);
    EXPECT_NEAR(peaks.velocity, row.velocity, 5.1e-4);
    EXPECT_NEAR(peaks.acceleration, row.acceleration, 0.051);
  }
  EXPECT_NEAR(testing::largest_jump(rows[0].curve, 1e-9).velocity, 4.314, 5.1e-4);
  EXPECT_NEAR(testing::largest_jump(rows[1].curve, 1e-7).acceleration, 1.362, 5.1e-4);
}

/// "Shorter than SQUAD" holds for Table 3. For rotations at random the rotation vectors lose.
TEST(DentalImplantOrientations, OfAThousandKeysAtRandomTheChartsAreTheShortest) {
  SCOPED_TRACE("seed 42");
  std::mt19937_64 random{42};
  const auto keys = testing::random_keys(random, 1000);
  std::vector<double> even(keys.size());
  for (std::size_t i = 0; i < even.size(); ++i) even[i] = static_cast<double>(i);
  const auto total = [&](Interpolator interpolator, const std::vector<double>& u = {}) {
    return testing::total_rotation(OrientationCurve::through(keys, interpolator, u).value(), 40);
  };
  const double slerp = total(Interpolator::slerp);
  EXPECT_NEAR(total(Interpolator::squad, even) / slerp, 1.051, 0.002);
  EXPECT_NEAR(total(Interpolator::rotvec_bspline) / slerp, 1.29, 0.02);
  EXPECT_NEAR(total(Interpolator::chart_bspline) / slerp, 1.008, 0.001);
}

/// Table 5 sums over n - 1 arcs; uniform over all rotations one has pi/2 + 2/pi in the mean.
TEST(DentalImplantOrientations, TheArcsOfTable5AreThoseOfKeysAtRandom) {
  const Figures printed = dental_implant()["paper_tables"];
  const double haar = printed["mean_haar_geodesic"].number();
  EXPECT_NEAR(haar, M_PI / 2 + 2 / M_PI, kDigits);
  SCOPED_TRACE("seed 43");
  std::mt19937_64 random{43};
  const auto keys = testing::random_keys(random, 100'001);
  double sum = 0;
  for (std::size_t i = 1; i < keys.size(); ++i) sum += turn_between(keys[i - 1], keys[i]);
  EXPECT_NEAR(sum / 100'000, haar, 0.01);
  EXPECT_NEAR(printed["table5_rad"]["1000"][0].number() / 999, haar, 0.02);
  const double row_of_three = printed["table5_rad"]["3"][0].number();
  EXPECT_NEAR(row_of_three / 2, 2.27, 0.005);
  EXPECT_GT(row_of_three, 1.9 * dental_implant()["table3"]["slerp_total"].number());  // not Table 3
}

/// The base turned by 1, 2 and 3 rad about z: the same keys have another path in its chart.
TEST(DentalImplantOrientations, ThePapersPathDependsOnTheBase) {
  const OrientationCurve here = curve(Interpolator::rotvec_bspline);
  struct Row {
    double turn, difference, total;
  };
  for (const Row& row : {Row{1, 0.030, 2.336}, Row{2, 0.066, 2.352}, Row{3, 3.141, 6.768}}) {
    const Quaterniond R{Eigen::AngleAxisd{row.turn, Vector3d::UnitZ()}};
    auto keys = table3();
    for (Quaterniond& key : keys) key = R * key;
    const auto turned = OrientationCurve::through(keys, Interpolator::rotvec_bspline).value();
    double largest = 0;
    for (int i = 0; i <= 3000; ++i) {
      const double u = i / 3000.0;
      largest = std::max(largest, turn_between(R * here.at(u).rotation, turned.at(u).rotation));
    }
    EXPECT_NEAR(largest, row.difference, 5.1e-4);
    EXPECT_NEAR(testing::total_rotation(turned), row.total, 5.1e-4);
  }
}

}  // namespace
}  // namespace armature::paper
