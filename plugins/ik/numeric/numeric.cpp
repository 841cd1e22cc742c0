// SPDX-License-Identifier: Apache-2.0
#include "numeric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "armature/runtime/plugins/plugin.hpp"
#include "fold.hpp"

namespace armature::ik::numeric {
namespace {

constexpr double kSame = 1e-6;            // [rad] or [m]: two solutions are one
constexpr double kSingular = 1e-6;        // manipulability
constexpr double kLimitTolerance = 1e-9;  // [rad] or [m] that of the kind
constexpr int kUnbounded = 6;             // restarts of an arm without spare joints
constexpr int kAnywhere = 8;              // every so manieth start may end beyond all limits
constexpr int kFolds = 12;                // steps to a fold, in one start
constexpr double kNearly = 1e-3;          // [m], [rad]: an error from which folds are looked for
constexpr double kSettling = 0.7;         // to this part each of them must lower the error

struct Range {
  double lower, upper;
};

/// Where starts of a joint lie: within its limits, and within a few turns or metres where it has
/// none. A joint that another one follows by half its angle is the same again after two turns.
Range start_range(const RobotModel& model, int joint) {
  constexpr double kTurn = 2 * std::numbers::pi;
  double lower = model.lower()[joint], upper = model.upper()[joint];
  if (turns_freely(model, joint)) lower = std::max(lower, upper - kTurn);
  const double longest = turns_freely(model, joint) ? kTurn : 2 * kTurn;
  if (!std::isfinite(lower) && !std::isfinite(upper)) return {-0.5 * longest, 0.5 * longest};
  return {std::isfinite(lower) ? lower : upper - longest,
          std::isfinite(upper) ? upper : lower + longest};
}

/// The points i = 1, 2, ... of the joint space within limits are evenly spread, and so is every
/// third of them: joint j goes on by a part of its range that is a power of the root of
/// x^(n + 1) = x + 1 (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
JointVector spread_point(const RobotModel& model, int i) {
  constexpr int kEnough = 60;  // iterations to the root
  double root = 2;
  for (int k = 0; k < kEnough; ++k) root = std::pow(1 + root, 1.0 / (model.dof() + 1));
  JointVector q(model.dof());
  double part = 1;
  for (int j = 0; j < model.dof(); ++j) {
    part /= root;
    const auto [lower, upper] = start_range(model, j);
    const double parts = 0.5 + i * part;
    q[j] = lower + (parts - std::floor(parts)) * (upper - lower);
  }
  return q;
}

bool is_among(const RobotModel& model, const IkBranches& known, const JointVector& q) {
  return std::any_of(known.begin(), known.end(), [&](const IkBranch& branch) {
    for (int i = 0; i < model.dof(); ++i) {
      const double d = branch.q[i] - q[i];
      if (std::abs(turns_freely(model, i) ? wrap_angle(d) : d) > kSame) return false;
    }
    return true;
  });
}

}  // namespace

Numeric::Numeric(const RobotModel& model, const Parameters& parameters)
    : model_{&model},
      parameters_{parameters},
      chain_{descent::chain_of(model)},
      reach_{model, chain_},
      free_joint_{free_joint_of(model)},
      kernel_{descent::kernel()},
      resting_{resting_position(model)} {
  for (int i = 0; i < model.dof(); ++i) {
    if (!turns_freely(model, i)) continue;
    turning_ |= descent::JointSet{1} << i;
    const bool all_around = model.upper()[i] - model.lower()[i] >= 2 * std::numbers::pi;
    if (all_around) everywhere_ |= descent::JointSet{1} << i;
  }
  const int samples = parameters.max_restarts * parameters.candidates;
  for (int i = 1; i <= samples; ++i) samples_.push_back(spread_point(model, i));
}

const JointVector& Numeric::best_sample(const descent::Goal& goal, int restart) const {
  const JointVector* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < parameters_.candidates; ++i) {
    const auto& sample = samples_[static_cast<std::size_t>(restart * parameters_.candidates + i)];
    const double error = kernel_.measure(chain_, goal, sample.data());
    if (!best || error < least) best = &sample, least = error;
  }
  return *best;
}

std::optional<double> Numeric::redundancy_of(const JointVector& q) const {
  if (!free_joint_) return std::nullopt;
  const double value = q[free_joint_->index];
  return turning_ >> free_joint_->index & 1 ? wrap_angle(value) : value;
}

const char* Numeric::unheld_redundancy(const IkGoal& goal) const {
  if (!goal.redundancy) return nullptr;
  if (!std::isfinite(*goal.redundancy)) return "the redundancy is not finite";
  const bool pointing = std::holds_alternative<Direction>(goal.pose.orientation);
  if (model_->dof() <= (pointing ? 5 : 6)) return "the goal leaves this arm nothing redundant";
  if (pointing && free_joint_) return nullptr;
  return "ik/numeric holds no arm angle, only a last joint along the pointing axis; leave the "
         "redundancy out or take a solver for this arm (S-R-S: ik/srs_arm_angle)";
}

bool Numeric::is_within_limits(double value) const {
  const double lower = model_->lower()[free_joint_->index];
  const double upper = model_->upper()[free_joint_->index];
  if (!std::isfinite(upper - lower)) return value >= lower && value <= upper;
  const double from_middle = value - std::midpoint(lower, upper);
  const bool turns = turning_ >> free_joint_->index & 1;
  return std::abs(turns ? wrap_angle(from_middle) : from_middle) <=
         0.5 * (upper - lower) + kLimitTolerance;
}

Numeric::Task Numeric::task_of(const IkGoal& goal) const {
  Task task{.goal = descent::goal_of(goal), .free_value = goal.redundancy};
  if (goal.redundancy) task.locked = descent::JointSet{1} << free_joint_->index;
  task.spare = model_->dof() - (task.goal.pointing ? 5 : 6) - (goal.redundancy ? 1 : 0);
  return task;
}

descent::End Numeric::started(const Task& task, int start, const JointVector& from) const {
  descent::End end;
  std::copy(from.begin(), from.end(), end.q.begin());
  if (task.free_value) end.q[static_cast<std::size_t>(free_joint_->index)] = *task.free_value;
  end.locked = task.locked;
  end.bounded = bounded(task, start);
  return end;
}

descent::JointSet Numeric::bounded(const Task& task, int start) const {
  if (start % kAnywhere == 0) return 0;
  if (task.spare > 0 || (start > kUnbounded && start % 2 == 1)) return ~everywhere_;
  return ~turning_;
}

bool Numeric::jump(descent::End& end) const {
  const descent::JointSet pressing = end.pressing & turning_ & ~end.locked;
  for (int i = 0; i < model_->dof(); ++i) {
    const double lower = model_->lower()[i], upper = model_->upper()[i];
    const bool gap = std::isfinite(upper - lower) && upper - lower > std::numbers::pi;
    if (!gap || !(pressing >> i & 1)) continue;
    double& q = end.q[static_cast<std::size_t>(i)];
    q = q > 0.5 * (lower + upper) ? lower : upper;
    return true;
  }
  return false;
}

void Numeric::settle(const IkGoal& goal, const Task& task, int& budget, descent::End& end) const {
  for (int i = 0; i < kFolds && !end.reached && end.error < kNearly && budget > 0; ++i, --budget) {
    JointVector q = Eigen::Map<const Eigen::VectorXd>(end.q.data(), model_->dof());
    const auto step = fold_step(*model_, goal, end.locked | end.pressing, q);
    if (!step) return;
    descent::End tried = end;
    q += *step;
    for (int j = 0; j < model_->dof(); ++j) {
      if (end.bounded >> j & 1) q[j] = std::clamp(q[j], model_->lower()[j], model_->upper()[j]);
    }
    std::copy(q.begin(), q.end(), tried.q.begin());
    kernel_.descend(chain_, task.goal, budget, tried);
    if (!tried.reached && !(tried.error < kSettling * end.error)) return;
    end = tried;
  }
}

int Numeric::worst_joint(const JointVector& q) const {
  Eigen::Index worst = 0;
  (model_->lower() - q).cwiseMax(q - model_->upper()).maxCoeff(&worst);
  return static_cast<int>(worst);
}

void Numeric::bring_inside(const Task& task, int& budget, descent::End& end) const {
  descent::End tried = end;
  for (int i = 0; i < task.spare && budget > 0; ++i) {
    JointVector q = Eigen::Map<const Eigen::VectorXd>(tried.q.data(), model_->dof());
    if (unwind(*model_, resting_, q)) return;
    const int worst = worst_joint(q);
    if (task.locked >> worst & 1) return;
    q[worst] = std::clamp(q[worst], model_->lower()[worst], model_->upper()[worst]);
    std::copy(q.begin(), q.end(), tried.q.begin());
    tried.locked |= 1U << worst;
    kernel_.descend(chain_, task.goal, budget, tried);
    if (!tried.reached) return;
    q = Eigen::Map<const Eigen::VectorXd>(tried.q.data(), model_->dof());
    if (unwind(*model_, resting_, q)) end = tried;
  }
}

bool Numeric::add_branch(const descent::End& end, std::string_view label, IkBranches& out) const {
  JointVector q = Eigen::Map<const Eigen::VectorXd>(end.q.data(), model_->dof());
  for (int i = 0; i < model_->dof(); ++i) {
    if (turns_freely(*model_, i)) q[i] = wrap_angle(q[i]);
  }
  if (is_among(*model_, out, q)) return false;
  JointVector turned = q;
  const bool inside = unwind(*model_, q, turned);
  if (!inside && out.count == IkBranches::kCapacity - 1) return false;  // one place is kept
  IkBranch& branch = out.add();
  branch.label = label;
  branch.q = q;
  branch.redundancy = redundancy_of(q).value_or(0);
  branch.within_limits = inside;
  branch.singular = !(end.gram >= kSingular * kSingular);
  branch.residual = {end.position_m, end.angle_rad};
  return inside;
}

IkStatus Numeric::solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                        IkState&) const {
  out.clear();
  if (const char* why = invalid_input(*model_, goal, seed)) {
    return {IkStatus::Code::invalid_input, 0, why};
  }
  if (const char* why = unheld_redundancy(goal)) return {IkStatus::Code::invalid_input, 0, why};
  if (const auto miss = reach_.miss_of(goal)) {
    return {IkStatus::Code::out_of_reach, miss->by, miss->why};
  }
  if (goal.redundancy && !is_within_limits(*goal.redundancy)) {
    return {IkStatus::Code::joint_limit, 0,
            "the redundancy asked for is beyond the limits of the last joint"};
  }
  const Task task = task_of(goal);
  int budget = goal.max_iterations;
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start <= parameters_.max_restarts && budget > 0; ++start) {
    descent::End end = started(task, start, start == 0 ? seed : best_sample(task.goal, start - 1));
    kernel_.descend(chain_, task.goal, budget, end);
    if (!end.reached && jump(end)) {
      least = std::min(least, end.error);
      kernel_.descend(chain_, task.goal, budget, end);
    }
    settle(goal, task, budget, end);
    least = std::min(least, end.error);
    if (!end.reached) continue;
    bring_inside(task, budget, end);
    if (add_branch(end, start == 0 ? "from_seed" : "restart", out)) return {};
  }
  if (out.count > 0) {
    return {IkStatus::Code::joint_limit, 0, "every solution found leaves the joint limits"};
  }
  return {IkStatus::Code::no_convergence, least, "no start led to the goal"};
}

}  // namespace armature::ik::numeric

ARMATURE_PLUGIN(armature::ik::numeric::Numeric);
