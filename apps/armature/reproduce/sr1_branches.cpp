// SPDX-License-Identifier: Apache-2.0
// SR-1, the arm alone: forward kinematics, all branches of the inverse, and both after each other.
#include <algorithm>
#include <numbers>
#include <random>
#include <string>

#include "armature/robot/kinematics/kinematics.hpp"
#include "reproduce/results.hpp"
#include "reproduce/sr1_arm.hpp"
#include "reproduce/sr1_parts.hpp"

namespace armature::reproduce::sr1 {
namespace {

void add_pose(const std::string& name, const Numbers& pose, Results& results) {
  Arm arm{with_lengths({.d6 = pose["d6_m"].number()})};
  const Eigen::Isometry3d base_T_tool = forward_kinematics(arm.model(), pose["q"].numbers());
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      results.value("forward_kinematics",
                    name + " T[" + std::to_string(row) + "][" + std::to_string(column) + "]",
                    base_T_tool(row, column));
    }
  }
  for (const IkBranch& branch : arm.branches(base_T_tool)) {
    for (Eigen::Index i = 0; i < branch.q.size(); ++i) {
      results.value("branches",
                    name + " " + std::string{branch.label} + " theta" + std::to_string(i + 1),
                    branch.q[i]);
    }
  }
}

/// Of joints that may be anywhere all the way round.
struct RoundTrips {
  double position_m = 0, angle_rad = 0;  // largest errors of all branches
  double recovered_rad = 0;              // how far the nearest branch is from the joints, at most
  int full = 0;                          // poses with eight branches
  int half = 0;                          // poses with four
};

RoundTrips round_trips(Arm& arm, int poses) {
  std::mt19937_64 random{2005};
  std::uniform_real_distribution<double> angle{-std::numbers::pi, std::numbers::pi};
  RoundTrips trips;
  for (int n = 0; n < poses; ++n) {
    JointVector q(6);
    for (double& value : q) value = angle(random);
    const Eigen::Isometry3d wanted = forward_kinematics(arm.model(), q);
    const ToolPose goal{wanted.translation(), Eigen::Quaterniond{wanted.linear()}};
    const IkBranches found = arm.branches(goal);
    double nearest = 10;
    for (const IkBranch& branch : found) {
      const PoseResidual off =
          residual(forward_kinematics(arm.model(), branch.q), Eigen::Vector3d::UnitZ(), goal);
      trips.position_m = worst(trips.position_m, off.position_m);
      trips.angle_rad = worst(trips.angle_rad, off.angle_rad);
      nearest = std::min(nearest, largest_turn(branch.q, q));
    }
    trips.recovered_rad = worst(trips.recovered_rad, nearest);
    trips.full += found.count == 8;
    trips.half += found.count == 4;
  }
  return trips;
}

}  // namespace

void add_poses(const Numbers& numbers, Results& results) {
  const Numbers poses = numbers["poses"];
  for (std::size_t n = 0; n < poses.size(); ++n) {
    add_pose("pose " + std::to_string(n + 1), poses[n], results);
  }
}

void add_round_trips(Results& results) {
  constexpr int kPoses = 100000;
  struct Case {
    const char* name;
    Lengths lengths;
  };
  for (const auto& [name, lengths] :
       {Case{"no tool", {}}, Case{"tool and column", {.d1 = 0.3, .d6 = 0.25}},
        Case{"shoulder offset", {.a1 = 0.08, .a3 = -0.0203, .d6 = 0.12}}}) {
    Arm arm{with_lengths(lengths)};
    const RoundTrips trips = round_trips(arm, kPoses);
    const std::string row = std::string{name} + ": ";
    results.value("round_trips", row + "largest position error", trips.position_m);
    results.value("round_trips", row + "largest angle error", trips.angle_rad);
    results.value("round_trips", row + "joints found again", trips.recovered_rad);
    results.value("round_trips", row + "eight branches", 100.0 * trips.full / kPoses);
    results.value("round_trips", row + "four branches", 100.0 * trips.half / kPoses);
  }
}

}  // namespace armature::reproduce::sr1
