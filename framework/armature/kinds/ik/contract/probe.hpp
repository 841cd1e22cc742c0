// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>

#include "armature/kinds/ik/contract/law.hpp"

namespace armature {
namespace ik_contract ARMATURE_EXPORT {

inline constexpr double kOnePosture = 1e-6;  // [rad] or [m]: two nearer than that are one

/// Asks a solver and keeps the book: what every law is written with.
class Probe {
 public:
  Probe(const IkSubject& subject, const IkLawTools& tools);

  const IkSubject& subject() const { return subject_; }
  const RobotModel& model() const { return *subject_.model; }
  const IkSolver& solver() const { return *subject_.solver; }
  const IkLawTools& tools() const { return tools_; }
  std::mt19937_64& random() { return random_; }
  LawReport& report() { return report_; }
  /// The arm has more joints than the task needs.
  bool redundant() const;

  /// Uniform within limits.
  JointVector random_joints();
  /// The goal that `q` reaches: a direction where the robot has a pointing axis, else a rotation.
  IkGoal goal_at(const JointVector& q) const;
  PoseResidual residual_of(const JointVector& q, const IkGoal& goal) const;
  /// Largest joint difference, whole turns aside.
  double distance(const JointVector& a, const JointVector& b) const;

  /// Asks with a fresh state; `violated` is about the last question.
  const IkStatus& solve(const IkGoal& goal, const JointVector& seed);
  /// Asks for the intervals of the redundancy; `violated` is about this question.
  bool feasible_redundancy(const IkGoal& goal, const JointVector& seed, RedundancyIntervals& out);
  const IkGoal& goal() const { return goal_; }
  const IkStatus& status() const { return status_; }
  const IkBranches& found() const { return found_; }
  /// From the branch nearest to `q`; infinite without one.
  double nearest(const JointVector& q) const;

  /// The last answer breaks the law; counts once per question.
  void violated(std::string what);
  /// The answers to a set of questions break the law together; this one is an example.
  void violated_by(const IkGoal& goal, const JointVector& seed, std::string what);
  /// A violation that no line for `armature ik` can show.
  void violated_without_line(std::string what);

 private:
  void begin(const IkGoal& goal, const JointVector& seed);
  void note(std::string what, bool with_question);

  const IkSubject& subject_;
  const IkLawTools& tools_;
  std::mt19937_64 random_;
  LawReport report_;
  IkGoal goal_;
  JointVector seed_;
  IkStatus status_;
  IkBranches found_;
  bool counted_ = false;
};

// What is true of any answer; each notes violations.

/// Finite numbers, forward kinematics of every branch within the goal's tolerance, and the residual
/// that is told is the one that is there.
void expect_true_residuals(Probe& probe);
/// Limits, singular flags, status, wrapping and labels are what they say.
void expect_true_flags(Probe& probe);

/// How many rows the robot's task has: 5 with a pointing axis, else 6.
int task_rows(const RobotModel& model);

/// How near to singular `q` is: the smallest singular value of the rows that the task uses.
double smallest_singular_value_at(const RobotModel& model, const JointVector& q);

}  // namespace ik_contract
}  // namespace armature
