// SPDX-License-Identifier: Apache-2.0
// The way from P1 to P3 in two seconds: the paper's plan and better ones, as figures.
#include <gtest/gtest.h>

#include "armature/kinds/trajectory/joint_curve.hpp"
#include "armature/kinds/trajectory/one_law.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/trajectories/quintic_spline.hpp"
#include "paper_lamp.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

constexpr double kDuration_s = 2;

Figures goal_row(std::string_view option) {
  const Figures rows = dental_lamp()["planner_goals"];
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i]["option"].text().find(option) != std::string::npos) return rows[i];
  }
  throw std::out_of_range("no planner goal " + std::string{option});
}

void expect_row(const Trajectory& trajectory, std::string_view option) {
  SCOPED_TRACE(std::string{option});
  const Figures row = goal_row(option);
  const LampExample::Largest errors = paper_lamp().largest_errors(trajectory, 0, kDuration_s, 1e-3);
  EXPECT_NEAR(errors.distance_error_mm, row["max_dist_err_mm"].number(), 1e-3);
  EXPECT_NEAR(errors.aim_deg, row["max_dir_err_deg"].number(), 1e-4);
  const Peaks peaks = peaks_of(trajectory);
  EXPECT_NEAR(peaks.velocity, row["peak_vel"].number(), 1e-4);
  EXPECT_NEAR(peaks.acceleration, row["peak_acc"].number(), 2e-4);
}

ToolPose point(std::size_t i) { return paper_lamp().mouth_points()[i - 1]; }
JointVector joints_at(std::size_t i) {
  return paper_lamp().joints(point(i).position, direction_of(point(i)));
}

JointSegment straight(std::size_t from, std::size_t to, double duration_s) {
  return {{0, 1}, {joints_at(from), joints_at(to)}, true, duration_s};
}

/// Joints on the arc at the times 0, T/n, ..., T of one quintic time law.
std::vector<JointVector> arc_joints(const std::vector<double>& times) {
  const Eigen::Vector3d u1 = direction_of(point(1)), u3 = direction_of(point(3));
  const double angle = std::atan2(u1.cross(u3).norm(), u1.dot(u3));
  const Eigen::Vector3d axis = u1.cross(u3).normalized();
  const TimeLaw law{kDuration_s};
  std::vector<JointVector> joints;
  for (const double t : times) {
    const Eigen::Vector3d u = Eigen::AngleAxisd{law.s(t) * angle, axis} * u1;
    joints.push_back(paper_lamp().joints(paper_lamp().mouth - LampExample::kDistance_m * u, u));
  }
  return joints;
}

std::vector<double> even_times(int parts) {
  std::vector<double> times;
  for (int i = 0; i <= parts; ++i) times.push_back(kDuration_s * i / parts);
  return times;
}

TEST(DentalLampPlanning, ThePapersTwoQuinticsStrayFromTheMouth) {
  expect_row(paper_lamp().timed("trajectory/quintic", {straight(1, 2, 1), straight(2, 3, 1)}),
             "paper: joint quintics");
}

TEST(DentalLampPlanning, OneJointQuinticStraysEvenFurther) {
  expect_row(paper_lamp().timed("trajectory/quintic", {straight(1, 3, 2)}), "single joint quintic");
}

TEST(DentalLampPlanning, TheArcWithAStopInTheMiddleStaysOnTheMouth) {
  expect_row(
      paper_lamp().timed("trajectory/quintic", {paper_lamp().arc_segment(point(1), point(2), 1),
                                                paper_lamp().arc_segment(point(2), point(3), 1)}),
      "Cartesian arc, quintic per half");
}

TEST(DentalLampPlanning, TheArcUnderOneQuinticStaysOnTheMouthAndIsGentlest) {
  const JointSegment arc = paper_lamp().arc_segment(point(1), point(3), kDuration_s);
  expect_row(paper_lamp().timed("trajectory/quintic", {arc}), "Cartesian arc, one quintic");
  expect_row(paper_lamp().timed("trajectory/quintic_spline", {arc}), "Cartesian arc, one quintic");
}

TEST(DentalLampPlanning, TheProposedPlannerMeetsItsGoals) {
  for (const char* id : {"trajectory/quintic", "trajectory/quintic_spline"}) {
    SCOPED_TRACE(id);
    const Trajectory plan =
        paper_lamp().timed(id, {paper_lamp().arc_segment(point(1), point(3), kDuration_s)});
    const LampExample::Largest errors = paper_lamp().largest_errors(plan, 0, kDuration_s, 1e-3);
    EXPECT_LT(errors.distance_error_mm, 0.01);
    EXPECT_LT(errors.aim_deg, 0.0005);
    const Peaks paper =
        peaks_of(paper_lamp().timed("trajectory/quintic", {straight(1, 2, 1), straight(2, 3, 1)}));
    EXPECT_LE(peaks_of(plan).acceleration, 0.65 * paper.acceleration);
  }
}

TEST(DentalLampPlanning, TheArcGoesThroughTheReferencePoints) {
  const Figures rows = dental_lamp()["arc_reference"];
  ASSERT_EQ(rows.size(), 9u);
  const Trajectory plan = paper_lamp().timed(
      "trajectory/quintic", {paper_lamp().arc_segment(point(1), point(3), kDuration_s)});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const JointVector q = plan.at(plan.start + seconds(rows[i]["t"].number())).q;
    const Eigen::Isometry3d pose = forward_kinematics(paper_lamp().model(), q);
    const Eigen::Vector3d x7 = rows[i]["x7"].numbers().head<3>();
    EXPECT_LE((pose.translation() - rows[i]["P"].point_m()).norm(), 1e-6);
    EXPECT_LE((pose.linear().col(0) - x7).norm(), 1e-6);
    EXPECT_LE((paper_lamp().all_joints(q) - rows[i]["q"].numbers()).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(DentalLampPlanning, InverseKinematicsEvery10msWithStraightLinesBetweenIsAsGoodAsSaid) {
  const Figures row = goal_row("IK every 10 ms");
  const std::vector<JointVector> joints = arc_joints(even_times(200));
  LampExample::Largest largest;
  for (std::size_t i = 1; i < joints.size(); ++i) {
    for (double part = 0; part < 1; part += 0.1) {
      const LampExample::Standing here =
          paper_lamp().standing_at((1 - part) * joints[i - 1] + part * joints[i]);
      largest.distance_error_mm = std::max(
          largest.distance_error_mm, std::abs(here.distance_mm - 1e3 * LampExample::kDistance_m));
      largest.aim_deg = std::max(largest.aim_deg, here.aim_deg);
    }
  }
  EXPECT_NEAR(largest.distance_error_mm, row["max_dist_err_mm"].number(), 1e-4);
  EXPECT_NEAR(largest.aim_deg, row["max_dir_err_deg"].number(), 1e-5);
}

TEST(DentalLampPlanning, FewPointsOnTheArcAreEnoughForAQuinticSpline) {
  const JointVector zero = JointVector::Zero(5);
  for (const int vias : {2, 3, 6, 8}) {
    const std::vector<double> times = even_times(vias + 1);
    const std::vector<JointVector> joints = arc_joints(times);
    const Trajectory spline{.goal_id = 1,
                            .dof = 5,
                            .start = {},
                            .knots = times,
                            .pieces = quintic_spline(times, joints, {joints.front(), zero, zero},
                                                     {joints.back(), zero, zero})};
    expect_row(spline, "C4 quintic spline through " + std::to_string(vias));
  }
}

TEST(DentalLampPlanning, FourPointsWithTheirVelocitiesAndAccelerationsAreEnoughForQuintics) {
  const JointSegment arc = paper_lamp().arc_segment(point(1), point(3), kDuration_s);
  const JointCurve curve{arc.s, arc.q};
  const TimeLaw law{kDuration_s};
  const std::vector<double> times = even_times(5);
  Trajectory hermite{.goal_id = 1, .dof = 5, .start = {}, .knots = times, .pieces = {}};
  for (std::size_t i = 1; i < times.size(); ++i) {
    const JointState from = state_along(curve, law, times[i - 1]);
    const JointState to = state_along(curve, law, times[i]);
    for (Eigen::Index j = 0; j < 5; ++j) {
      hermite.pieces.push_back(Quintic::between(
          {from.q[j], from.v[j], from.a[j]}, {to.q[j], to.v[j], to.a[j]}, times[i] - times[i - 1]));
    }
  }
  expect_row(hermite, "quintic Hermite");
}

}  // namespace
}  // namespace armature::paper
