// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "armature/robot/model/robot_model.hpp"

namespace armature::test {

/// Fails where an arm that was at `q` at `time_s` of each of `steps` has left a limit of `robot`.
/// Its steps may be as long as they like: a velocity is the mean of one, and what lies between two
/// of them is the time from middle to middle.
template <class Step>
void expect_arm_limits(const RobotModel& robot, const std::vector<Step>& steps) {
  constexpr double kTolerated = 1 + 1e-6, kNanosecond_s = 1e-9, kPeriod_s = 0.001;
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();  // of positions
  JointVector v_before = JointVector::Zero(robot.dof());
  double dt_before = kPeriod_s;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const Step &step = steps[i], &before = steps[i - 1];
    const double dt = std::round((step.time_s - before.time_s) / kNanosecond_s) * kNanosecond_s;
    const double apart = 0.5 * (dt + dt_before);
    const JointVector v = (step.q - before.q) / dt, change = v - v_before;
    const JointVector rounded = kRounding * step.q.cwiseAbs() / std::min(dt, dt_before);
    const auto keeps = [&](const JointVector& value, const JointVector& limit) {
      return (value.cwiseAbs().array() <= kTolerated * limit.array() + rounded.array()).all();
    };
    ASSERT_TRUE(robot.within_limits(step.q)) << step.time_s << " s: " << step.q.transpose();
    ASSERT_TRUE(keeps(v, robot.max_velocity())) << step.time_s << " s: " << v.transpose();
    ASSERT_TRUE(keeps(change, robot.max_acceleration() * apart))
        << step.time_s << " s, steps of " << dt_before << " and " << dt
        << " s: " << change.transpose() / apart;
    v_before = v;
    dt_before = dt;
  }
}

}  // namespace armature::test
