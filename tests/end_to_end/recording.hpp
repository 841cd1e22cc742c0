// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "deployment_run.hpp"
#include "reference_check.hpp"

namespace armature::test {

struct GoalChange {
  static constexpr int kAccepted = 0;
  double time_s = 0;
  std::uint64_t goal_id = 0;
  int state = 0;
};

struct PlannedPose {
  Eigen::Vector3d position, direction;
};

/// What the motion component decided during a run, from the files of test/recorder.
struct Recording {
  std::vector<ReferenceSample> reference;
  std::vector<GoalChange> goals;
  std::map<std::uint64_t, std::vector<PlannedPose>> path;            // by goal
  std::map<std::uint64_t, std::vector<Eigen::VectorXd>> joint_path;  // all joints, the start first
  double greatest_jerk = 0;                                          // [rad/s3] of all plans
};

/// Runs the lamp with the recorder beside it.
Recording record_lamp(DeploymentStart start, DeploymentRun& run);

}  // namespace armature::test
