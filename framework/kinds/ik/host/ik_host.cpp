// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {
namespace {

IkGoal goal_of(const msg::IkRequest& request) {
  IkGoal goal;
  goal.pose.position = to_eigen(request.position_());
  if (request.pointing_()) {
    goal.pose.orientation = Direction{to_eigen(request.direction_())};
  } else {
    goal.pose.orientation = to_eigen(request.orientation_());
  }
  if (request.has_redundancy_()) goal.redundancy = request.redundancy_();
  return goal;
}

Expected<JointVector> seed_of(const RobotModel& robot, const std::vector<double>& joints) {
  if (joints.empty()) return resting_position(robot);
  if (joints.size() != static_cast<std::size_t>(robot.joint_count())) {
    return refuse("the seed has " + std::to_string(joints.size()) + " joints, the robot has " +
                  std::to_string(robot.joint_count()));
  }
  return robot.contract(
      Eigen::Map<const Eigen::VectorXd>(joints.data(), static_cast<Eigen::Index>(joints.size())));
}

msg::IkSolution solution_of(const RobotModel& robot, const IkBranch& branch) {
  const JointVector all = robot.expand(branch.q);
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

}  // namespace

/// Requests in, every branch of every request out; each request is answered once, in order.
class IkHost final : public Component {
 public:
  explicit IkHost(Setup& setup)
      : Component{setup},
        robot_{robot_of(setup)},
        solver_{setup.slot<IkSolver>("solver", robot_)},
        requests_{setup.input<msg::IkRequest>("request")},
        responses_{setup.output<msg::IkResponse>("response")} {}

  void step(Time) override {
    for (std::size_t i = 0; i < requests_.size(); ++i) answer(requests_[i]);
  }

 private:
  void answer(const msg::IkRequest& request);

  const RobotModel robot_;
  PluginPtr<IkSolver> solver_;
  IkState state_;
  IkBranches branches_;
  Input<msg::IkRequest> requests_;
  Output<msg::IkResponse> responses_;
};

void IkHost::answer(const msg::IkRequest& request) {
  branches_.clear();
  IkStatus status{IkStatus::Code::invalid_input, 0, {}};
  std::string reason;
  if (const auto seed = seed_of(robot_, request.seed_())) {
    status = solver_->solve(goal_of(request), *seed, branches_, state_);
    if (status.code != IkStatus::Code::ok) reason = describe(status);
  } else {
    reason = seed.error().text;
  }
  auto response = responses_.loan();
  response->header_() = request.header_();
  response->request_id_(request.request_id_());
  response->status_(std::string{to_string(status.code)});
  response->reason_(reason);
  response->solutions_().clear();
  for (const IkBranch& branch : branches_) {
    response->solutions_().push_back(solution_of(robot_, branch));
  }
  response.publish();
}

}  // namespace armature

ARMATURE_PLUGIN(armature::IkHost);
