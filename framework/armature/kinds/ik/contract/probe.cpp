// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/contract/probe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "armature/kinds/ik/lines/asking.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/singular_values.hpp"
#include "armature/robot/kinematics/task_error.hpp"

namespace armature::ik_contract {
namespace {

constexpr std::size_t kShown = 3;
constexpr double kTold = 1e-12;            // [m], [rad] by which a told residual may be off
constexpr double kRegular = 1e-3;          // smallest singular value of what is surely not singular
constexpr double kRegularVolume = 1e-4;    // and its manipulability
constexpr double kSingularVolume = 1e-12;  // manipulability of what surely is

}  // namespace

Probe::Probe(const IkSubject& subject, const IkLawTools& tools)
    : subject_{subject}, tools_{tools}, random_{subject.seed} {}

bool Probe::redundant() const { return model().dof() > task_rows(model()); }

JointVector Probe::random_joints() {
  JointVector q(model().dof());
  for (int i = 0; i < model().dof(); ++i) {
    double lower = model().lower()[i], upper = model().upper()[i];
    if (!std::isfinite(lower) || !std::isfinite(upper)) {
      lower = -std::numbers::pi, upper = std::numbers::pi;
    }
    q[i] = std::uniform_real_distribution{lower, upper}(random_);
  }
  return q;
}

IkGoal Probe::goal_at(const JointVector& q) const { return {.pose = task_pose(model(), q)}; }

PoseResidual Probe::residual_of(const JointVector& q, const IkGoal& goal) const {
  const Eigen::Vector3d axis = model().pointing_axis().value_or(Eigen::Vector3d::UnitX());
  return residual(forward_kinematics(model(), q), axis, goal.pose);
}

double Probe::distance(const JointVector& a, const JointVector& b) const {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (int i = 0; i < model().dof(); ++i) {
    const double d = turns_freely(model(), i) ? wrap_angle(a[i] - b[i]) : a[i] - b[i];
    largest = std::max(largest, std::abs(d));
  }
  return largest;
}

void Probe::begin(const IkGoal& goal, const JointVector& seed) {
  goal_ = goal;
  seed_ = seed;
  counted_ = false;
  ++report_.questions;
  if (tools_.before_solve) tools_.before_solve(goal, seed);
}

const IkStatus& Probe::solve(const IkGoal& goal, const JointVector& seed) {
  begin(goal, seed);
  IkState state;
  status_ = solver().solve(goal, seed, found_, state);
  return status_;
}

bool Probe::feasible_redundancy(const IkGoal& goal, const JointVector& seed,
                                RedundancyIntervals& out) {
  begin(goal, seed);
  return solver().feasible_redundancy(goal, seed, out);
}

double Probe::nearest(const JointVector& q) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const IkBranch& branch : found_) nearest = std::min(nearest, distance(branch.q, q));
  return nearest;
}

void Probe::violated(std::string what) { note(std::move(what), true); }
void Probe::violated_by(const IkGoal& goal, const JointVector& seed, std::string what) {
  goal_ = goal, seed_ = seed, counted_ = false;
  note(std::move(what), true);
}
void Probe::violated_without_line(std::string what) { note(std::move(what), false); }

void Probe::note(std::string what, bool with_question) {
  if (!std::exchange(counted_, true)) ++report_.failed;
  if (report_.violations.size() >= kShown) return;
  const IkQuestion question{.goal = goal_,
                            .seed = seed_,
                            .redundancy_is_length = solver().redundancy_is_length(),
                            .id = {}};
  report_.violations.push_back(
      {std::move(what), with_question ? question_line(model(), question) : ""});
}

void expect_true_residuals(Probe& probe) {
  for (const IkBranch& branch : probe.found()) {
    if (branch.q.size() != probe.model().dof() || !branch.q.allFinite()) {
      return probe.violated(fmt::format("branch {} has joints that are no numbers, or not {}",
                                        branch.label, probe.model().dof()));
    }
    const PoseResidual actual = probe.residual_of(branch.q, probe.goal());
    const auto& [position_m, angle_rad] = probe.goal().tolerance;
    if (!(actual.position_m <= position_m) || !(actual.angle_rad <= angle_rad)) {
      probe.violated(fmt::format("branch {} misses the goal by {:.3g} m and {:.3g} rad",
                                 branch.label, actual.position_m, actual.angle_rad));
    }
    if (!(std::abs(branch.residual.position_m - actual.position_m) <= kTold) ||
        !(std::abs(branch.residual.angle_rad - actual.angle_rad) <= kTold)) {
      probe.violated(fmt::format(
          "branch {} tells a residual of {:.3g} m and {:.3g} rad, it is {:.3g} m and {:.3g} rad",
          branch.label, branch.residual.position_m, branch.residual.angle_rad, actual.position_m,
          actual.angle_rad));
    }
  }
}

namespace {

void expect_true_singular(Probe& probe, const IkBranch& branch) {
  const double smallest = smallest_singular_value_at(probe.model(), branch.q);
  const double volume = manipulability(probe.model(), branch.q);
  const bool wide = probe.model().dof() >= task_rows(probe.model());
  if (!branch.singular && (wide ? volume <= kSingularVolume : smallest <= kSingularVolume)) {
    probe.violated(fmt::format("branch {} is singular (manipulability {:.3g}) and not flagged",
                               branch.label, volume));
  }
  if (branch.singular && wide && smallest > kRegular && volume > kRegularVolume) {
    probe.violated(fmt::format("branch {} is flagged singular, its manipulability is {:.3g}",
                               branch.label, volume));
  }
}

void expect_true_limits(Probe& probe, const IkBranch& branch) {
  JointVector turned = branch.q;
  const bool inside = unwind(probe.model(), branch.q, turned);
  if (branch.within_limits != inside) {
    probe.violated(fmt::format("branch {} says it is {} the limits and is not", branch.label,
                               branch.within_limits ? "within" : "beyond"));
  }
  for (int j = 0; j < probe.model().dof(); ++j) {
    if (!turns_freely(probe.model(), j)) continue;
    if (!(branch.q[j] >= -std::numbers::pi && branch.q[j] < std::numbers::pi)) {
      probe.violated(fmt::format("branch {}: joint {} is {} and not wrapped into [-pi, pi)",
                                 branch.label, j + 1, branch.q[j]));
    }
  }
}

/// The status that belongs to what was found.
void expect_true_status(Probe& probe) {
  using Code = IkStatus::Code;
  const auto& [found, status] = std::pair{probe.found(), probe.status()};
  const bool within =
      std::any_of(found.begin(), found.end(), [](auto& branch) { return branch.within_limits; });
  if (within != (status.code == Code::ok)) {
    probe.violated(fmt::format("the answer is '{}', {} of {} branches is within limits",
                               describe(status), within ? "one" : "none", found.count));
  }
  if (status.code == Code::invalid_input) {
    probe.violated("a good goal is refused: " + describe(status));
  }
  if (!std::isfinite(status.shortfall)) probe.violated("the shortfall is not finite");
}

}  // namespace

void expect_true_flags(Probe& probe) {
  if (probe.found().count < 0 || probe.found().count > IkBranches::kCapacity) {
    return probe.violated(fmt::format("{} branches were counted", probe.found().count));
  }
  expect_true_status(probe);
  for (const IkBranch& branch : probe.found()) {
    if (branch.q.size() != probe.model().dof() || !branch.q.allFinite()) {
      return probe.violated(fmt::format("branch {} has joints that are no numbers", branch.label));
    }
    if (branch.label.empty()) probe.violated("a branch has no label");
    expect_true_limits(probe, branch);
    expect_true_singular(probe, branch);
    const bool twice = std::count_if(probe.found().begin(), probe.found().end(),
                                     [&](auto& other) { return other.label == branch.label; }) > 1;
    if (twice && probe.subject().closed_form && !probe.redundant()) {
      probe.violated(fmt::format("two branches are labelled {}", branch.label));
    }
  }
}

int task_rows(const RobotModel& model) { return model.pointing_axis() ? 5 : 6; }

double smallest_singular_value_at(const RobotModel& model, const JointVector& q) {
  return smallest_singular_value(task_jacobian(model, q));
}

}  // namespace armature::ik_contract
