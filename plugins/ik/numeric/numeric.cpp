// SPDX-License-Identifier: Apache-2.0
#include "numeric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "armature/runtime/plugin.hpp"

namespace armature {
namespace {

constexpr double kSame = 1e-6;      // [rad] or [m]: two solutions are one
constexpr double kSingular = 1e-6;  // manipulability
constexpr int kUnbounded = 6;       // restarts of an arm without spare joints
constexpr int kAnywhere = 8;        // every so manieth start may end beyond all limits
constexpr int kJumps = 2;           // over gaps between limits, in one start

/// The i-th number of the van der Corput sequence in `base`: in (0, 1), evenly spread.
double radical_inverse(int i, int base) {
  double result = 0, digit = 1.0 / base;
  for (; i > 0; i /= base, digit /= base) result += digit * (i % base);
  return result;
}

/// A Halton point of the joint space within limits.
JointVector halton(const RobotModel& model, int i) {
  constexpr std::array<int, kMaxJoints> kPrimes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  JointVector q(model.dof());
  for (int j = 0; j < model.dof(); ++j) {
    double lower = model.lower()[j], upper = model.upper()[j];
    if (turns_freely(model, j)) {  // more than a turn is the same again
      lower = std::max(lower, upper - 2 * std::numbers::pi);
      if (!std::isfinite(lower)) lower = -std::numbers::pi, upper = std::numbers::pi;
    }
    q[j] = lower + radical_inverse(i, kPrimes[static_cast<std::size_t>(j)]) * (upper - lower);
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

Expected<std::unique_ptr<IkSolver>> Numeric::make(const RobotModel& model, const Params& params) {
  return std::unique_ptr<IkSolver>{new Numeric{model,
                                               static_cast<int>(params.integer("max_restarts")),
                                               static_cast<int>(params.integer("candidates"))}};
}

Numeric::Numeric(const RobotModel& model, int max_restarts, int candidates)
    : model_{&model},
      max_restarts_{max_restarts},
      candidates_{candidates},
      chain_{descent::chain_of(model)},
      reach_{model, chain_},
      kernel_{descent::kernel()},
      resting_{resting_position(model)} {
  for (int i = 0; i < model.dof(); ++i) {
    if (turns_freely(model, i)) turning_ |= descent::JointSet{1} << i;
  }
  for (int i = 0; i < max_restarts * candidates; ++i) samples_.push_back(halton(model, i + 1));
}

const JointVector& Numeric::best_sample(const descent::Goal& goal, int restart) const {
  const JointVector* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < candidates_; ++i) {
    const auto& sample = samples_[static_cast<std::size_t>(restart * candidates_ + i)];
    const double error = kernel_.measure(chain_, goal, sample.data());
    if (!best || error < least) best = &sample, least = error;
  }
  return *best;
}

int Numeric::spare(const descent::Goal& goal) const {
  return model_->dof() - (goal.pointing ? 5 : 6);
}

descent::JointSet Numeric::bounded(const descent::Goal& goal, int start) const {
  if (start % kAnywhere == 0) return 0;
  if (spare(goal) > 0 || (start > kUnbounded && start % 2 == 1)) return descent::kAllJoints;
  return ~turning_;
}

bool Numeric::jump(descent::End& end) const {
  const descent::JointSet pressing = end.pressing & turning_;
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

int Numeric::worst_joint(const JointVector& q) const {
  Eigen::Index worst = 0;
  (model_->lower() - q).cwiseMax(q - model_->upper()).maxCoeff(&worst);
  return static_cast<int>(worst);
}

void Numeric::bring_inside(const descent::Goal& goal, int& budget, descent::End& end) const {
  descent::End tried = end;
  for (int i = 0; i < spare(goal) && budget > 0; ++i) {
    JointVector q = Eigen::Map<const Eigen::VectorXd>(tried.q.data(), model_->dof());
    if (unwind(*model_, resting_, q)) return;
    const int worst = worst_joint(q);
    q[worst] = std::clamp(q[worst], model_->lower()[worst], model_->upper()[worst]);
    std::copy(q.begin(), q.end(), tried.q.begin());
    tried.locked |= 1U << worst;
    kernel_.descend(chain_, goal, budget, tried);
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
  branch.redundancy = 0;
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
  if (const auto miss = reach_.miss_of(goal)) {
    return {IkStatus::Code::out_of_reach, miss->by, miss->why};
  }
  const descent::Goal target = descent::goal_of(goal);
  int budget = goal.max_iterations;
  double least = std::numeric_limits<double>::infinity();
  descent::End end;
  for (int start = 0; start <= max_restarts_ && budget > 0; ++start) {
    const JointVector& from = start == 0 ? seed : best_sample(target, start - 1);
    std::copy(from.begin(), from.end(), end.q.begin());
    end.locked = 0;
    end.bounded = bounded(target, start);
    kernel_.descend(chain_, target, budget, end);
    for (int i = 0; i < kJumps && !end.reached && jump(end); ++i) {
      least = std::min(least, end.error);
      kernel_.descend(chain_, target, budget, end);
    }
    least = std::min(least, end.error);
    if (!end.reached) continue;
    bring_inside(target, budget, end);
    if (add_branch(end, start == 0 ? "from_seed" : "restart", out)) return {};
  }
  if (out.count > 0) {
    return {IkStatus::Code::joint_limit, 0, "every solution found leaves the joint limits"};
  }
  return {IkStatus::Code::no_convergence, least, "no start led to the goal"};
}

}  // namespace armature

ARMATURE_PLUGIN(armature::Numeric);
