// SPDX-License-Identifier: Apache-2.0
// The law of many goals in one call.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <limits>
#include <vector>

#include "armature/kinds/ik/batch.hpp"
#include "armature/kinds/ik/contract/laws.hpp"
#include "armature/kinds/ik/contract/postures.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::ik_contract {
namespace {

/// Goals as a batch wants them.
struct Arrays {
  std::array<std::vector<double>, 3> position;
  std::array<std::vector<double>, 4> rotation;
  std::array<std::vector<double>, 3> direction;

  explicit Arrays(const std::vector<IkGoal>& goals) {
    for (const IkGoal& goal : goals) {
      for (std::size_t k = 0; k < 3; ++k) {
        position[k].push_back(goal.pose.position[static_cast<Eigen::Index>(k)]);
      }
      if (const auto* line = std::get_if<Direction>(&goal.pose.orientation)) {
        for (std::size_t k = 0; k < 3; ++k) {
          direction[k].push_back(line->unit[static_cast<Eigen::Index>(k)]);
        }
      } else {
        const auto& q = std::get<Eigen::Quaterniond>(goal.pose.orientation);
        const std::array wxyz{q.w(), q.x(), q.y(), q.z()};
        for (std::size_t k = 0; k < 4; ++k) rotation[k].push_back(wxyz[k]);
      }
    }
  }
  IkBatch batch() const {
    IkBatch batch;
    batch.count = position[0].size();
    const auto point = [](auto& to, const auto& from) {
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[k].data();
    };
    point(batch.position, position);
    if (direction[0].empty()) {
      point(batch.rotation, rotation);
    } else {
      point(batch.direction, direction);
    }
    return batch;
  }
};

/// As the robot's goals are, or with the rotation of the posture that made them.
enum class Asked { task, rotation };
/// Reachable goals, singular ones, goals out of reach and bad ones, none by itself.
std::vector<IkGoal> goals_for_a_batch(Probe& probe, Asked asked) {
  constexpr int kEach = 50;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::vector<IkGoal> goals;
  const auto goal_at = [&](const JointVector& q) {
    IkGoal goal = probe.goal_at(q);
    if (asked == Asked::task) return goal;
    goal.pose.orientation = Eigen::Quaterniond{forward_kinematics(probe.model(), q).linear()};
    return goal;
  };
  const auto singular = singular_postures(probe.model(), kEach, probe.random());
  for (int i = 0; i < kEach; ++i) {
    const IkGoal goal = goal_at(probe.random_joints());
    goals.insert(goals.end(), 5, goal);
    IkGoal* const last = &goals.back();
    last[-1].pose.position *= i % 2 == 0 ? 2 : 100;
    last[-2].pose.position[i % 3] = kNan;
    if (!singular.empty()) {
      last[-3] = goal_at(singular[static_cast<std::size_t>(i) % singular.size()].q);
    }
    if (i % 7 != 0) continue;
    if (std::holds_alternative<Direction>(goal.pose.orientation)) {
      last[-4].pose.orientation = Direction{Eigen::Vector3d::Zero()};
    } else {
      last[-4].pose.orientation = Eigen::Quaterniond{0, 0, 0, 0};
    }
  }
  return goals;
}

bool reaches(const Probe& probe, const JointVector& q) {
  const PoseResidual residual = probe.residual_of(q, probe.goal());
  const IkGoal::Tolerance& tolerance = probe.goal().tolerance;
  return residual.position_m <= tolerance.position_m && residual.angle_rad <= tolerance.angle_rad;
}

/// What differs between the answer of the `i`th goal and what was found for it alone; empty:
/// nothing.
std::string difference(const Probe& probe, const IkBatchAnswers& answers, std::size_t i) {
  const IkBranches& alone = probe.found();
  if (answers.code[i] != probe.status().code) {
    return fmt::format("'{}' instead of '{}'", to_string(answers.code[i]),
                       to_string(probe.status().code));
  }
  const int count = std::popcount(answers.found[i]);
  if (count != alone.count) return fmt::format("{} branches instead of {}", count, alone.count);
  const IkBranch* branch = alone.begin();
  JointVector q(probe.model().dof());
  for (int slot = 0; slot < answers.slots(); ++slot) {
    const unsigned bit = 1U << slot;
    if ((answers.found[i] & bit) == 0) continue;
    for (int k = 0; k < q.size(); ++k) q[k] = answers.joint(slot, k)[i];
    // Of a singular posture the pose tells the joints less exactly than that.
    const double away = probe.distance(q, branch->q);
    if (!(away < kOnePosture) && !(branch->singular && reaches(probe, q))) {
      return fmt::format("branch {} stands {:.3g} rad or m elsewhere", branch->label, away);
    }
    if (((answers.within_limits[i] & bit) != 0) != branch->within_limits ||
        ((answers.singular[i] & bit) != 0) != branch->singular) {
      return fmt::format("branch {} has other flags", branch->label);
    }
    const std::string_view label = answers.label[static_cast<std::size_t>(slot)];
    if (!label.empty() && label != branch->label) {
      return fmt::format("branch {} stands in the slot of {}", branch->label, label);
    }
    ++branch;
  }
  const IkGoal& goal = probe.goal();
  const bool near = !(answers.position_m[i] > goal.tolerance.position_m) &&
                    !(answers.angle_rad[i] > goal.tolerance.angle_rad);
  if (count > 0 && !near) {
    return fmt::format("a residual of {:.3g} m and {:.3g} rad", answers.position_m[i],
                       answers.angle_rad[i]);
  }
  return {};
}

void ask_batch(Probe& probe, Asked asked) {
  const std::vector<IkGoal> goals = goals_for_a_batch(probe, asked);
  const Arrays arrays{goals};
  const JointVector seed = probe.random_joints();
  IkBatch batch = arrays.batch();
  batch.tolerance = goals.front().tolerance;
  IkBatchAnswers answers;
  probe.solver().solve_batch(batch, seed, answers);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    probe.solve(goals[i], seed);
    const std::string what = difference(probe, answers, i);
    if (!what.empty()) probe.violated("in a batch the answer is another one: " + what);
  }
  if (probe.subject().allocates || !probe.tools().allocations) return;
  const std::size_t before = probe.tools().allocations();
  probe.solver().solve_batch(batch, seed, answers);
  const std::size_t made = probe.tools().allocations() - before;
  if (made > 0) {
    probe.violated_without_line(fmt::format("{} allocations in a batch that had room", made));
  }
}

}  // namespace

void batch_is_one_by_one(Probe& probe) {
  ask_batch(probe, Asked::task);
  if (probe.model().pointing_axis()) ask_batch(probe, Asked::rotation);
}

}  // namespace armature::ik_contract
