// SPDX-License-Identifier: Apache-2.0
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/kinematics/task_error.hpp"
#include "armature/robot/model/axis_steps.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "ik_kdl_parameters.hpp"
namespace armature::ik::kdl {

KDL::Frame frame_of(const Eigen::Isometry3d& T) {
  const KDL::Vector x{T(0, 0), T(1, 0), T(2, 0)}, y{T(0, 1), T(1, 1), T(2, 1)};
  return {KDL::Rotation{x, y, x * y}, KDL::Vector{T(0, 3), T(1, 3), T(2, 3)}};
}

KDL::Chain chain_of(const RobotModel& model) {
  KDL::Chain chain;
  const auto steps = axis_steps(model, model.tool());
  chain.addSegment(KDL::Segment{KDL::Joint{KDL::Joint::Fixed}, frame_of(steps[0])});
  for (std::size_t i = 0; const Joint& row : model.joints()) {
    const auto type = row.type == Joint::Type::revolute ? KDL::Joint::RotZ : KDL::Joint::TransZ;
    chain.addSegment(KDL::Segment{KDL::Joint{type}, frame_of(steps[++i])});
  }
  return chain;
}

/// Orocos KDL's iterative solvers: one answer, from the seed.
struct Kdl final : IkSolver {
  static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& model, const Params& params) {
    if (model.dof() < model.joint_count()) return refuse("KDL knows no coupled joints");
    if (model.pointing_axis()) return refuse("KDL solves for rotations, not for directions");
    if (model.frame(model.tool()).parent_joint + 1 < model.joint_count())
      return refuse("its tool must hang on the last joint");
    return std::make_unique<Kdl>(model, Parameters::read(params));
  }
  Kdl(const RobotModel& robot, const Parameters& parameters)
      : model{robot}, chain{chain_of(robot)}, lma{parameters.method == Parameters::Method::lma} {}

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState&) const override {
    out.clear();
    if (const char* wrong = invalid_input(model, goal, seed))
      return {IkStatus::Code::invalid_input, 0, wrong};
    if (goal.redundancy)
      return {IkStatus::Code::invalid_input, 0, "KDL holds no redundancy; leave it out"};
    const auto [position_m, angle_rad] = goal.tolerance;
    const auto R = std::get<Eigen::Quaterniond>(goal.pose.orientation).normalized();
    const KDL::Frame pose = frame_of(Eigen::Translation3d{goal.pose.position} * R);
    JointVector q = ask(seed, pose, std::min(position_m, angle_rad));
    const TaskError left = task_error(model, q, goal.pose);
    // KDL takes turns of less than 1e-6 rad for none: where that is too much, one step is ours.
    if (left.within(2e-6, 2e-6) && !left.within(position_m, angle_rad)) q += left.min_step();
    const IkBranch end = branch_at(model, goal, q, "from_seed");
    if (!(end.residual.position_m <= position_m && end.residual.angle_rad <= angle_rad))
      return {IkStatus::Code::no_convergence, left.error.norm(), "the seed leads elsewhere"};
    out.add() = end;
    if (end.within_limits) return {};
    return {IkStatus::Code::joint_limit, 0, "the solution leaves the joint limits"};
  }

  /// KDL's solvers work in their own members: one for every call, so that threads do not meet.
  JointVector ask(const JointVector& seed, const KDL::Frame& pose, double eps) const {
    KDL::JntArray from{chain.getNrOfJoints()}, to{from}, lower{from}, upper{from};
    from.data = seed, lower.data = model.lower(), upper.data = model.upper();
    const auto weights = Eigen::Matrix<double, 6, 1>::Ones();
    if (lma)
      return KDL::ChainIkSolverPos_LMA{chain, weights, eps}.CartToJnt(from, pose, to), to.data;
    KDL::ChainFkSolverPos_recursive fk{chain};
    KDL::ChainIkSolverVel_pinv ik{chain};
    KDL::ChainIkSolverPos_NR_JL{chain, lower, upper, fk, ik, 100, eps}.CartToJnt(from, pose, to);
    return to.data;
  }
  const RobotModel& model;
  const KDL::Chain chain;
  const bool lma;
};
}  // namespace armature::ik::kdl
ARMATURE_PLUGIN(armature::ik::kdl::Kdl);
