// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "armature/robot/kinematics/frame_buffer.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"
#include "armature/robot/orientations/corner_blend.hpp"
#include "armature/robot/orientations/orientation_probe_test.hpp"
#include "armature/robot/trajectories/trajectory.hpp"
#include "armature/values/allocation_count.hpp"

namespace armature {
namespace {

class NoAllocation : public ::testing::Test {
 protected:
  void SetUp() override {
#ifndef ARMATURE_COUNTS_ALLOCATIONS
    GTEST_SKIP() << "the sanitizer's malloc cannot be counted";
#endif
    // The counter must see both ways of allocating, or it proves nothing.
    ASSERT_GT(allocations_of([] { ::operator delete(::operator new(8)); }), 0U);
    Eigen::VectorXd vector;
    ASSERT_GT(allocations_of([&] { vector.resize(100); }), 0U);
  }

  const RobotModel lamp = testing::dental_lamp();
  const JointVector q = *lamp.to_independent(*lamp.home());
  double sum = 0;
};

TEST_F(NoAllocation, InKinematics) {
  EXPECT_EQ(allocations_of([&] {
              sum += forward_kinematics(lamp, q).translation().x();
              sum += forward_kinematics_with_jacobian(lamp, q, lamp.tool()).jacobian.sum();
              sum += manipulability(lamp, q);
              sum += lamp.to_all(q).sum() + lamp.to_independent(*lamp.home())->sum();
              sum += lamp.within_limits(q) ? 1 : 0;
            }),
            0U);
}

TEST_F(NoAllocation, InEvaluatingATrajectory) {
  const JointState from{q, JointVector::Ones(5), JointVector::Zero(5)};
  const Trajectory trajectory =
      spliced(stop_from(from, lamp.max_velocity(), lamp.max_acceleration(), Time{}, 1), from, 0.1);
  EXPECT_EQ(allocations_of([&] {
              for (double t = -1; t < 3; t += 0.01) {
                sum += trajectory.at(Time{} + seconds(t)).q.sum();
                sum += trajectory.jerk_at(Time{} + seconds(t)).sum();
              }
              sum += limit_use(trajectory, lamp.max_velocity(), lamp.max_acceleration()).velocity;
            }),
            0U);
}

TEST_F(NoAllocation, InEvaluatingAnOrientationCurveOrABlendedPolyline) {
  std::mt19937_64 random{1};
  const auto keys = testing::random_keys(random, 6);
  const std::vector<Eigen::Vector3d> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const BlendedPolyline line{points, std::vector<double>{0, 0.5, 1}};
  for (const auto interpolator :
       {OrientationInterpolator::slerp, OrientationInterpolator::squad,
        OrientationInterpolator::rotvec_bspline, OrientationInterpolator::chart_bspline}) {
    const OrientationCurve curve = OrientationCurve::through(keys, interpolator).value();
    EXPECT_EQ(allocations_of([&] {
                for (double u = -0.1; u < 1.1; u += 0.01) {
                  sum += curve.at(u).acceleration.sum() + line.at(u).sum();
                }
              }),
              0U);
  }
}

TEST_F(NoAllocation, InTheFrameBuffer) {
  FrameBuffer buffer{lamp, 100};
  EXPECT_EQ(allocations_of([&] {
              for (int i = 0; i < 1000; ++i) {
                buffer.add(Time{i * 1'000'000}, q);
                sum += buffer.base_T(lamp.tool(), buffer.newest())->translation().x();
              }
            }),
            0U);
}

}  // namespace
}  // namespace armature
