// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <random>
#include <string>

#include "armature/kinds/trajectory/trajectory_planner.hpp"

// The laws that every `trajectory` plugin keeps. In the plugin's test, in one source file:
//
//   INSTANTIATE_TEST_SUITE_P(Quintic, TrajectoryLaws, testing::Values(...));
namespace armature {

struct TrajectorySubject {
  std::string name;
  std::shared_ptr<const TrajectoryPlanner> planner;
  bool offers_time_law = true;  // as its plugin.yaml says

  friend void PrintTo(const TrajectorySubject& subject, std::ostream* out) { *out << subject.name; }
};

class TrajectoryLaws : public testing::TestWithParam<TrajectorySubject> {
 protected:
  static constexpr int kDof = 3;
  const TrajectoryPlanner& planner() const { return *GetParam().planner; }

  JointVector random_vector(double size);
  /// A smooth random curve from `q` with `n` parts; one part is a straight line.
  JointSegment curve_from(const JointVector& q, int n, double size);
  TrajectoryRequest request(double start_speed);
  void expect_keeps_limits(const Trajectory& trajectory, const TrajectoryRequest& request);
  void expect_joins_start_and_goal(const Trajectory& trajectory, const TrajectoryRequest& request);
  void expect_has_no_jump(const Trajectory& trajectory);
  void expect_good(const Expected<Trajectory>& planned, const TrajectoryRequest& request);

  std::mt19937_64 random_{11};
  std::normal_distribution<double> normal_;
};

}  // namespace armature
