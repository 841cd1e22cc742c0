#include <Eigen/Cholesky>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/kinematics/task_error.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "@TARGET@_parameters.hpp"  // made from plugin.yaml

namespace @NAMESPACE@ {
/// Damped least squares from the seed (Wampler 1986; Nakamura and Hanafusa 1986).
class @CLASS@ final : public IkSolver {
 public:
  @CLASS@(const RobotModel& robot, const Params& params)
      : robot_{robot}, parameters_{Parameters::read(params)} {}

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState&) const override {
    out.clear();
    if (const char* wrong = invalid_input(robot_, goal, seed))
      return {IkStatus::Code::invalid_input, 0, wrong};
    const auto [position_m, angle_rad] = goal.tolerance;
    JointVector q = seed;
    TaskError e = task_error(robot_, q, goal.pose);
    for (int i = 0; i < goal.max_iterations && !e.within(position_m, angle_rad); ++i) {
      Eigen::Matrix<double, -1, -1, 0, 6, 6> A = e.jacobian.lazyProduct(e.jacobian.transpose());
      A.diagonal().array() += parameters_.damping * e.error.squaredNorm() + 1e-12;
      q += e.jacobian.transpose().lazyProduct(A.llt().solve(e.error));
      e = task_error(robot_, q, goal.pose);
    }
    if (!e.within(position_m, angle_rad))
      return {IkStatus::Code::no_convergence, e.error.norm(), "the seed leads elsewhere"};
    out.add() = branch_at(robot_, goal, q, "from_seed");
    if (out.begin()->within_limits) return {};
    return {IkStatus::Code::joint_limit, 0, "the solution leaves the joint limits"};
  }

 private:
  const RobotModel& robot_;
  Parameters parameters_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
