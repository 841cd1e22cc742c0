// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/request_host.hpp"
#include "armature/kinds/select/select.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {
namespace {

Expected<IkBranch> branch_of(const RobotModel& robot, const msg::IkSolution& solution) {
  return robot.to_independent(solution.joints_()).map([&](const JointVector& q) {
    return IkBranch{
        .label = solution.label_(),  // lives as long as the request
        .q = q,
        .redundancy = solution.redundancy_(),
        .residual = {.position_m = solution.residual_m_(), .angle_rad = solution.residual_rad_()},
        .within_limits = solution.within_limits_(),
        .singular = solution.singular_()};
  });
}

Expected<std::vector<IkBranches>> waypoints_of(const RobotModel& robot,
                                               const msg::SelectRequest& request) {
  std::vector<IkBranches> waypoints(request.waypoints_().size());
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const auto& solutions = request.waypoints_()[i].solutions_();
    if (solutions.size() > IkBranches::kCapacity) {
      return refuse(fmt::format("waypoint {} has {} solutions, at most {} are read", i + 1,
                                solutions.size(), IkBranches::kCapacity));
    }
    for (std::size_t k = 0; k < solutions.size(); ++k) {
      auto branch = branch_of(robot, solutions[k]);
      if (!branch) {
        return refuse(
            fmt::format("waypoint {}, solution {}: {}", i + 1, k + 1, branch.error().text));
      }
      waypoints[i].add() = *branch;
    }
  }
  return waypoints;
}

}  // namespace

/// The solutions of every waypoint in, one joint position for each out.
class SelectHost final : public RequestHost<msg::SelectRequest, msg::SelectResponse> {
 public:
  explicit SelectHost(Setup& setup)
      : RequestHost{setup},
        robot_{robot_of(setup)},
        selector_{setup.slot<BranchSelector>("selector", robot_)} {}

 private:
  Expected<std::vector<JointVector>> choose(const msg::SelectRequest& request) const {
    const auto start = joints_or_home(robot_, request.start_(), "the start");
    if (!start) return tl::unexpected{start.error()};
    const auto waypoints = waypoints_of(robot_, request);
    if (!waypoints) return tl::unexpected{waypoints.error()};
    return chosen_by(*selector_, robot_, *start, *waypoints);
  }

  void answer(const msg::SelectRequest& request, msg::SelectResponse& response) override {
    respond(choose(request), response, [&](const std::vector<JointVector>& chosen) {
      for (const JointVector& q : chosen) {
        const JointVector all = robot_.to_all(q);
        response.waypoints_().emplace_back().joints_().assign(all.begin(), all.end());
      }
    });
  }

  const RobotModel robot_;
  Slot<BranchSelector> selector_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::SelectHost);
