// SPDX-License-Identifier: Apache-2.0
#include "numeric.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "armature/robot/kinematics.hpp"
#include "armature/runtime/plugin.hpp"
#include "pose_error.hpp"

namespace armature {
namespace {

// Levenberg-Marquardt: the damping falls with the error, below kNear with its square, so that the
// end is Newton's quadratic one; next to a singular pose anything more keeps it from the goal.
constexpr double kDamping = 1e-2, kLeastDamping = 1e-14, kNear = 0.1;
constexpr double kLongestStep = 1.0;  // [rad] or [m], of any joint
constexpr int kPatience = 6;          // iterations in which the error must fall ...
constexpr double kEnoughGain = 0.7;   // ... to this part, or the start is given up
constexpr int kPolish = 3;            // further iterations below the tolerance, while they help
constexpr double kSame = 1e-6;        // [rad] or [m]: two solutions are one
constexpr double kSingular = 1e-6;    // manipulability

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

template <int Rows>
double size_of(const PoseError<Rows>& e) {
  return e.error.norm();
}

template <int Rows>
bool within(const PoseError<Rows>& e, const IkGoal::Tolerance& tolerance) {
  return e.position_m() <= tolerance.position_m && e.angle_rad() <= tolerance.angle_rad;
}

/// J^T (J J^T + damping)^-1 e, no longer than a step may be.
template <int Rows>
JointVector step(const PoseError<Rows>& e) {
  using Square = Eigen::Matrix<double, Rows, Rows>;
  Square A = e.jacobian.lazyProduct(e.jacobian.transpose());
  const double size = size_of(e);
  A.diagonal().array() += kDamping * size * std::min(1.0, size / kNear) + kLeastDamping;
  const Eigen::Matrix<double, Rows, 1> y = Eigen::LLT<Square>{A}.solve(e.error);
  JointVector dq = e.jacobian.transpose().lazyProduct(y);
  const double longest = dq.cwiseAbs().maxCoeff();
  if (longest > kLongestStep) dq *= kLongestStep / longest;
  return dq;
}

/// What one start came to.
struct Descent {
  JointVector q;
  double error = std::numeric_limits<double>::infinity();
  bool reached = false;
};

/// Further iterations below the tolerance: the tolerance is a bound, not an aim.
template <int Rows>
void polish(const RobotModel& model, const ToolPose& goal, PoseError<Rows> e, Descent& descent) {
  for (int i = 0; i < kPolish && descent.error > 0; ++i) {
    const JointVector q = descent.q + step(e);
    e = pose_error<Rows>(model, goal, q);
    if (!(size_of(e) < descent.error)) return;
    descent.q = q;
    descent.error = size_of(e);
  }
}

/// Goes down from `q`; `budget` counts down with every iteration.
template <int Rows>
Descent descend(const RobotModel& model, const IkGoal& goal, JointVector q, int& budget) {
  Descent descent{q};
  double to_beat = std::numeric_limits<double>::infinity();
  for (int i = 0; budget > 0; ++i, --budget) {
    const PoseError<Rows> e = pose_error<Rows>(model, goal.pose, q);
    const double error = size_of(e);
    if (error < descent.error) descent.q = q, descent.error = error;
    if (within(e, goal.tolerance)) {
      descent = {q, error, true};
      polish(model, goal.pose, e, descent);
      return descent;
    }
    if (i % kPatience == 0) {
      if (!(descent.error < kEnoughGain * to_beat)) return descent;
      to_beat = descent.error;
    }
    q += step(e);
  }
  return descent;
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

/// Adds `q`, wrapped; true when it keeps the limits.
bool add_branch(const RobotModel& model, const IkGoal& goal, JointVector q, std::string_view label,
                IkBranches& out) {
  for (int i = 0; i < model.dof(); ++i) {
    if (turns_freely(model, i)) q[i] = wrap_angle(q[i]);
  }
  if (is_among(model, out, q)) return false;
  JointVector turned = q;
  const bool inside = unwind(model, q, turned);
  if (!inside && out.count == IkBranches::kCapacity - 1) return false;  // one place is kept
  IkBranch& branch = out.add();
  branch.label = label;
  branch.q = q;
  branch.redundancy = 0;
  branch.within_limits = inside;
  branch.singular = manipulability(model, q) < kSingular;
  const Eigen::Vector3d axis = model.pointing_axis().value_or(Eigen::Vector3d::UnitX());
  branch.residual = residual(forward_kinematics(model, q), axis, goal.pose);
  return inside;
}

/// The goal with its direction or rotation made unit.
IkGoal normalized(IkGoal goal) {
  if (auto* direction = std::get_if<Direction>(&goal.pose.orientation)) {
    direction->unit.normalize();
  } else {
    std::get<Eigen::Quaterniond>(goal.pose.orientation).normalize();
  }
  return goal;
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
      reach_{reach_of(model)} {
  for (int i = 0; i < max_restarts * candidates; ++i) samples_.push_back(halton(model, i + 1));
}

template <int Rows>
const JointVector& Numeric::best_sample(const IkGoal& goal, int restart) const {
  const JointVector* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < candidates_; ++i) {
    const auto& sample = samples_[static_cast<std::size_t>(restart * candidates_ + i)];
    const double error = size_of(pose_error<Rows>(*model_, goal.pose, sample));
    if (!best || error < least) best = &sample, least = error;
  }
  return *best;
}

template <int Rows>
IkStatus Numeric::search(const IkGoal& goal, const JointVector& seed, IkBranches& out) const {
  int budget = goal.max_iterations;
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start <= max_restarts_ && budget > 0; ++start) {
    const JointVector& from = start == 0 ? seed : best_sample<Rows>(goal, start - 1);
    const Descent descent = descend<Rows>(*model_, goal, from, budget);
    least = std::min(least, descent.error);
    if (!descent.reached) continue;
    const char* label = start == 0 ? "from_seed" : "restart";
    if (add_branch(*model_, goal, descent.q, label, out)) return {};
  }
  if (out.count > 0) {
    return {IkStatus::Code::joint_limit, 0, "every solution found leaves the joint limits"};
  }
  return {IkStatus::Code::no_convergence, least, "no start led to the goal"};
}

IkStatus Numeric::solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                        IkState&) const {
  out.clear();
  if (const char* why = invalid_input(*model_, goal, seed)) {
    return {IkStatus::Code::invalid_input, 0, why};
  }
  const double beyond = (goal.pose.position - reach_.centre).norm() - reach_.radius;
  if (beyond > 0) return {IkStatus::Code::out_of_reach, beyond, "longer than the arm"};
  const IkGoal unit = normalized(goal);
  const bool pointing = std::holds_alternative<Direction>(goal.pose.orientation);
  return pointing ? search<kPointingRows>(unit, seed, out) : search<kRotationRows>(unit, seed, out);
}

}  // namespace armature

ARMATURE_PLUGIN(armature::Numeric);
