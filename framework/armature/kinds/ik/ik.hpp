// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "armature/kinds/made_for_robot.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/joint_vector.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/inline_text.hpp"

namespace armature ARMATURE_EXPORT {

/// What an inverse kinematics solver is asked for: a pose of the tool frame in the base frame.
struct IkGoal {
  ToolPose pose;
  /// What the pose leaves free: arm angle [rad], or needle depth [m]; none: the solver's choice.
  std::optional<double> redundancy;
  struct Tolerance {
    double position_m = 1e-9;
    double angle_rad = 1e-9;
  } tolerance;
  int max_iterations = 1000;  // of iterative solvers, restarts included
};

/// One joint position that reaches the goal.
struct IkBranch {
  /// Stable name of the branch, "tilt0/balance0/elbow0": it does not shift when another vanishes.
  /// Points to static storage of the plugin, which the runtime keeps to the end of the run.
  std::string_view label;
  JointVector q;               // independent joints, freely turning ones in [-pi, pi)
  double redundancy = 0;       // arm angle [rad] or needle depth [m] where the goal leaves it free
  PoseResidual residual;       // of forward kinematics at q
  bool within_limits = false;  // q, or the same posture whole turns away, keeps the limits
  bool singular = false;       // at or numerically at a singular set of the arm
};

/// All branches of one goal, in the solver's fixed order. Never allocates.
struct IkBranches {
  static constexpr int kCapacity = 16;
  std::array<IkBranch, kCapacity> branch;
  int count = 0;

  const IkBranch* begin() const { return branch.data(); }
  const IkBranch* end() const { return branch.data() + count; }
  void clear() { count = 0; }
  /// Throws std::length_error when there is no more room.
  IkBranch& add() {
    if (count == kCapacity) throw std::length_error{"the solver adds more than 16 branches"};
    return branch[static_cast<std::size_t>(count++)];
  }
};

/// Values of the redundancy, from `lower` to `upper`, at which one branch keeps the joint limits.
struct RedundancyInterval {
  std::string_view label;       // of the branch, static storage
  double lower = 0, upper = 0;  // arm angle [rad] within [-pi, pi], or needle depth [m]
};

/// All of them, branch by branch in the solver's fixed order, rising within a branch; a circle of
/// arm angles is cut at pi. Never allocates.
struct RedundancyIntervals {
  static constexpr int kCapacity = 160;
  std::array<RedundancyInterval, kCapacity> interval;
  int count = 0;

  const RedundancyInterval* begin() const { return interval.data(); }
  const RedundancyInterval* end() const { return interval.data() + count; }
  void clear() { count = 0; }
  /// False, and nothing is added, when there is no more room.
  bool add(const RedundancyInterval& another) {
    if (count == kCapacity) return false;
    interval[static_cast<std::size_t>(count++)] = another;
    return true;
  }
};

/// Outcome of one solve.
struct IkStatus {
  enum class Code { ok, out_of_reach, joint_limit, singular, no_convergence, invalid_input };
  Code code = Code::ok;
  /// out_of_reach: how far beyond reach [m], 0 when it is not the position that cannot be reached;
  /// no_convergence: the residual.
  double shortfall = 0;
  std::string_view detail;  // static text: which test failed, or which input is wrong
};
/// "ok", "out_of_reach", "joint_limit", ...
std::string_view to_string(IkStatus::Code code);
/// "out_of_reach: 0.0341 m beyond reach (horizontal distance)".
std::string describe(const IkStatus& status);
/// The same, real-time safe.
ReasonText reason_of(const IkStatus& status);
/// Whether some branch reaches the goal, within limits or not.
inline bool reaches(const IkStatus& status) {
  return status.code == IkStatus::Code::ok || status.code == IkStatus::Code::singular;
}

/// What is remembered between calls; the caller owns it (start: value-initialised). A solver
/// answers every branch and is not told which one is taken.
struct IkState {
  /// Arm angle [rad] or needle depth [m] of the joints that were taken; the caller sets it
  /// (`redundancy_of`).
  std::optional<double> last_redundancy;
};

struct IkBatch;  // batch.hpp
class IkBatchAnswers;

/// Inverse kinematics for one robot. Made by `make`, which refuses a robot that the solver cannot
/// serve with a reason.
class IkSolver {
 public:
  static constexpr std::string_view kKind = "ik";
  using Factory = MadeForRobot<IkSolver>;

  virtual ~IkSolver() = default;

  /// Finds every branch of `goal`; all that were found go to `out` even when none is within limits
  /// (then the code is joint_limit). `seed` (dof() entries) is where iterative solvers start and
  /// what free angles at singular sets keep to. Same input, same bits, from any thread.
  /// Real-time safe unless the plugin's manifest says `allocates: true`: no allocation, no lock.
  /// Bad input (NaN, wrong length, zero direction) answers invalid_input.
  virtual IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                         IkState& state) const = 0;

  /// The redundancy of `q` (dof() entries), arm angle [rad] or needle depth [m]: with it as
  /// goal.redundancy, `solve` finds q again. None when the arm, or the solver, has none. Real-time
  /// safe as `solve` is.
  virtual std::optional<double> redundancy_of([[maybe_unused]] const JointVector& q) const {
    return std::nullopt;
  }
  /// Every redundancy at which a branch of `goal` keeps the joint limits (goal.redundancy is not
  /// looked at); `seed` is what it is for `solve`. False, and nothing in `out`, when the solver
  /// does not tell, or when the goal is bad input or out of reach. Real-time safe as `solve` is.
  virtual bool feasible_redundancy([[maybe_unused]] const IkGoal& goal,
                                   [[maybe_unused]] const JointVector& seed,
                                   RedundancyIntervals& out) const {
    out.clear();
    return false;
  }
  /// Whether the redundancy is a length [m] and not an angle [rad].
  virtual bool redundancy_is_length() const { return false; }
  /// What `solve` answers to each goal of `batch` by itself, with `seed` and nothing remembered, up
  /// to rounding; one by one where the solver knows no shorter way. Bad input spoils its own answer
  /// only. Real-time safe as `solve` is, once `out` had room for as many.
  virtual void solve_batch(const IkBatch& batch, const JointVector& seed,
                           IkBatchAnswers& out) const;
};

/// nullptr, or why `goal` and `seed` cannot be solved for at all: not finite, further away than
/// squares of it could be added, zero direction, wrong length. The first lines of every solver.
const char* invalid_input(const RobotModel& model, const IkGoal& goal, const JointVector& seed);

/// The branch that stands at joints `q`: wrapped, its residual, limits and singular flag worked out
/// by forward kinematics. For solvers that know no shorter way. `label` points to static storage.
/// Real-time safe.
IkBranch branch_at(const RobotModel& model, const IkGoal& goal, const JointVector& q,
                   std::string_view label);

/// The branch within limits, whole turns included, that is nearest to `near`; nullptr: none is.
/// Real-time safe.
const IkBranch* nearest_branch(const IkBranches& branches, const JointVector& near,
                               const RobotModel& model);

/// True when a whole turn of independent joint `i` changes nothing: it is revolute, and so is what
/// is coupled to it, with whole ratios.
bool turns_freely(const RobotModel& model, int i);

/// Turns the freely turning joints of `q` by whole turns as near to `near` as the limits allow;
/// false when some joint keeps its limits at no turn. Real-time safe.
bool unwind(const RobotModel& model, const JointVector& near, JointVector& q);

}  // namespace armature
