// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <Eigen/Cholesky>
#include <csignal>
#include <cstdio>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/kinematics/task_error.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "ik_faulty_parameters.hpp"

namespace armature::ik::faulty {

using Fault = Parameters::Fault;

/// Damped least squares from the seed, with a fault.
class FaultyIk final : public IkSolver {
 public:
  static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& model, const Params& params) {
    const Fault fault = Parameters::read(params).fault;
    if (fault == Fault::refuse) return refuse("it serves no robot at all");
    if (fault == Fault::leak) held_ = new char[4096];
    return std::unique_ptr<IkSolver>{new FaultyIk{model, fault}};
  }

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState&) const override {
    out.clear();
    if (const char* why = invalid_input(model_, goal, seed)) {
      return {IkStatus::Code::invalid_input, 0, why};
    }
    if (fault_ == Fault::crash && goal.pose.position.x() > 0.5) std::raise(SIGSEGV);
    if (fault_ == Fault::print) std::printf("[solving\n");
    if (fault_ == Fault::crash_at_depth && goal.redundancy) std::raise(SIGSEGV);
    while (fault_ == Fault::hang && goal.pose.position.x() > 0.5) pause();
    const auto& [position_m, angle_rad] = goal.tolerance;
    JointVector q = seed;
    TaskError e = task_error(model_, q, goal.pose);
    for (int i = 0; i < 100 && !e.within(position_m, angle_rad); ++i) {
      Eigen::Matrix<double, -1, -1, 0, 6, 6> A = e.jacobian.lazyProduct(e.jacobian.transpose());
      A.diagonal().array() += 0.01 * e.error.squaredNorm() + 1e-12;
      q += e.jacobian.transpose().lazyProduct(A.llt().solve(e.error));
      e = task_error(model_, q, goal.pose);
    }
    if (!e.within(position_m, angle_rad)) {
      return {IkStatus::Code::no_convergence, e.error.norm(), "the seed leads elsewhere"};
    }
    out.add() = branch_at(model_, goal, q, "from_seed");
    if (fault_ == Fault::residual) out.branch[0].residual.position_m = 0.5;
    if (out.begin()->within_limits) return {};
    return {IkStatus::Code::joint_limit, 0, "the solution leaves the joint limits"};
  }

  bool feasible_redundancy(const IkGoal&, const JointVector&,
                           RedundancyIntervals& out) const override {
    out.clear();
    return fault_ == Fault::crash_at_depth && out.add({"from_seed", 0.125, 0.25});
  }
  bool redundancy_is_length() const override { return fault_ == Fault::crash_at_depth; }

 private:
  FaultyIk(const RobotModel& model, Fault fault) : model_{model}, fault_{fault} {}

  static char* held_;
  const RobotModel& model_;
  Fault fault_;
};
char* FaultyIk::held_ = nullptr;

}  // namespace armature::ik::faulty

ARMATURE_PLUGIN(armature::ik::faulty::FaultyIk);
