// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <string>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/request_host.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/locked_joints.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/guarded.hpp"

namespace armature {
namespace {

msg::IkSolution solution_of(const RobotModel& robot, const IkBranch& branch) {
  const JointVector all = robot.to_all(branch.q);
  msg::IkSolution solution;
  solution.label_(std::string{branch.label});
  solution.joints_().assign(all.begin(), all.end());
  solution.residual_m_(branch.residual.position_m);
  solution.residual_rad_(branch.residual.angle_rad);
  solution.redundancy_(branch.redundancy);
  solution.within_limits_(branch.within_limits);
  solution.singular_(branch.singular);
  return solution;
}

/// A branch that keeps the limits has its joints turned by whole turns into them, as near to `seed`
/// as they allow; how far it is from the goal is what forward kinematics says.
void examine(const RobotModel& robot, const IkGoal& goal, const JointVector& seed,
             IkBranch& branch) {
  JointVector q = branch.q;
  branch.within_limits = branch.within_limits && unwind(robot, seed, q);
  if (branch.within_limits) branch.q = q;
  const Eigen::Vector3d axis = robot.pointing_axis().value_or(Eigen::Vector3d::UnitX());
  branch.residual = residual(forward_kinematics(robot, branch.q), axis, goal.pose);
}

/// The first defect of a solver's answer, or nullopt.
std::optional<std::string> defect(const RobotModel& robot, const IkBranches& branches) {
  for (const IkBranch& branch : branches) {
    if (branch.q.size() != robot.dof()) {
      return fmt::format("the plugin answered {} joints, and the robot has {}", branch.q.size(),
                         robot.dof());
    }
    if (!branch.q.allFinite()) return "the plugin answered joints that are not finite";
  }
  return std::nullopt;
}

}  // namespace

/// Poses in, every branch of every pose out.
class IkHost final : public RequestHost<msg::IkRequest, msg::IkResponse> {
 public:
  explicit IkHost(Setup& setup)
      : RequestHost{setup},
        robot_{robot_of(setup)},
        solver_model_{without_locked_joints(robot_)},
        solver_{setup.slot<IkSolver>("solver", solver_model_)} {}

 private:
  void answer(const msg::IkRequest& request, msg::IkResponse& response) override;
  IkStatus solve(const msg::IkRequest& request, std::string& reason);

  const RobotModel robot_, solver_model_;
  Slot<IkSolver> solver_;
  IkBranches branches_;
};

IkStatus IkHost::solve(const msg::IkRequest& request, std::string& reason) {
  const IkStatus invalid{IkStatus::Code::invalid_input, 0, {}};
  if (const auto wrong = in_another_frame(request)) {
    reason = *wrong;
    return invalid;
  }
  const auto seed = joints_or_home(robot_, request.seed_(), "the seed");
  if (!seed) {
    reason = seed.error().text;
    return invalid;
  }
  const auto pose = checked(tool_pose_of(request), "the goal's");
  if (!pose) {
    reason = pose.error().text;
    return invalid;
  }
  IkGoal goal;
  goal.pose = *pose;
  if (request.has_redundancy_()) goal.redundancy = request.redundancy_();
  // Anyone asks, so what was chosen last is where the seed is.
  const auto status = guarded([&] {
    IkState state{.last_redundancy = solver_->redundancy_of(*seed)};
    return solver_->solve(goal, *seed, branches_, state);
  });
  const auto wrong = status ? defect(robot_, branches_) : status.error().text;
  if (wrong) {
    branches_.clear();
    reason = *wrong;
    return {IkStatus::Code::no_convergence, 0, {}};
  }
  for (int i = 0; i < branches_.count; ++i) {
    examine(robot_, goal, *seed, branches_.branch[static_cast<std::size_t>(i)]);
  }
  if (status->code != IkStatus::Code::ok) reason = describe(*status);
  return *status;
}

void IkHost::answer(const msg::IkRequest& request, msg::IkResponse& response) {
  branches_.clear();
  std::string reason;
  const IkStatus status = solve(request, reason);
  response.status_(std::string{to_string(status.code)});
  response.reason_(reason);
  for (const IkBranch& branch : branches_) {
    response.solutions_().push_back(solution_of(robot_, branch));
  }
}

}  // namespace armature

ARMATURE_PLUGIN(armature::IkHost);
