// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "armature/kinds/select/select.hpp"

// The laws that every `select` plugin keeps, for any robot. In the plugin's test, in one source
// file:
//
//   INSTANTIATE_TEST_SUITE_P(Nearest, SelectLaws, testing::Values(...));
namespace armature {

/// A selector made for a robot.
struct SelectSubject {
  std::string name;
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const BranchSelector> selector;

  friend void PrintTo(const SelectSubject& subject, std::ostream* out) { *out << subject.name; }
};

class SelectLaws : public testing::TestWithParam<SelectSubject> {
 protected:
  static constexpr double kTurn = 2 * std::numbers::pi;
  static constexpr double kStep = 0.3;  // [rad] or [m] between two postures of a random path
  const RobotModel& model() const { return *GetParam().model; }
  const BranchSelector& selector() const { return *GetParam().selector; }

  double between(double low, double high);
  JointVector random_posture();
  JointVector random_neighbour(const JointVector& q);
  /// As a solver tells it: freely turning joints in [-pi, pi).
  IkBranch branch_at(JointVector q) const;
  /// A posture beyond the limits of one joint at every turn; nothing when every joint turns all
  /// round.
  std::optional<IkBranch> branch_outside();
  /// The posture among others, some of them outside the limits, in any order.
  IkBranches waypoint_with(const JointVector& q, int others);
  bool is_branch(const JointVector& q, const IkBranches& branches) const;
  /// More than half a turn apart only where the nearer turn is outside the limits.
  void expect_near(const JointVector& before, const JointVector& q) const;
  void expect_sound(const std::vector<JointVector>& chosen, const JointVector& start,
                    const std::vector<IkBranches>& waypoints) const;

  std::mt19937_64 random_{23};
};

}  // namespace armature
