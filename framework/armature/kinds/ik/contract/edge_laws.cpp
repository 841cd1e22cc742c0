// SPDX-License-Identifier: Apache-2.0
// The laws of what is found at the edges of what an arm can do.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "armature/kinds/ik/contract/edges.hpp"
#include "armature/kinds/ik/contract/laws.hpp"
#include "armature/kinds/ik/contract/postures.hpp"
#include "armature/kinds/ik/contract/search.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::ik_contract {
namespace {

/// `q` with joint `k` moved by `offset`, to the side where it stays within limits.
JointVector moved(const RobotModel& model, JointVector q, int k, double offset) {
  const auto [lower, upper] = range_of(model, k);
  q[k] += q[k] + offset <= upper || q[k] - offset < lower ? offset : -offset;
  return q;
}

/// `q` with one joint moved so little that the tool comes `by` nearer to `centre`.
JointVector nearer(const RobotModel& model, const JointVector& q, const Eigen::Vector3d& centre,
                   double by) {
  const auto distance = [&](const JointVector& at) {
    return (forward_kinematics(model, at).translation() - centre).norm();
  };
  const double wanted = distance(q) - by;
  JointVector best = q;
  for (int k = 0; k < model.dof(); ++k) {
    for (const double side : {1e-3, -1e-3}) {
      const auto gap = [&](double way) {
        JointVector at = q;
        at[k] += side * way;
        return std::abs(distance(at) - wanted);
      };
      const double way = golden_section(0, 1, gap);
      JointVector at = q;
      at[k] += side * way;
      if (model.within_limits(at) && gap(way) < 1e-3 * by) best = at;
    }
  }
  return best;
}

}  // namespace

void singular_postures(Probe& probe) {
  const auto postures =
      singular_postures(probe.model(), probe.subject().edge_poses, probe.random());
  if (postures.empty()) {
    probe.report().skipped = "no singular posture is within limits";
    return;
  }
  for (const double offset : {0.0, 1e-9, 1e-7, 1e-4}) {
    EdgeSet set{probe, fmt::format("singular to {:.0g}", offset)};
    for (const auto& [q, joint] : postures) set.ask(moved(probe.model(), q, joint, offset));
    set.close();
  }
}

void postures_at_limits(Probe& probe) {
  EdgeSet set{probe, "at joint limits"};
  std::uniform_int_distribution<int> third{0, 2};
  for (int i = 0; i < probe.subject().edge_poses; ++i) {
    JointVector q = probe.random_joints();
    const int surely =
        std::uniform_int_distribution<int>{0, probe.model().dof() - 1}(probe.random());
    for (int k = 0; k < probe.model().dof(); ++k) {
      const auto [lower, upper] = range_of(probe.model(), k);
      const int end = third(probe.random());
      if (end == 0 || (k == surely && end == 2)) q[k] = lower;
      if (end == 1) q[k] = upper;
    }
    set.ask(q);
  }
  set.close();
}

void extreme_postures(Probe& probe) {
  const RobotModel& model = probe.model();
  const int count = probe.subject().edge_poses;
  const auto stretched = extreme_postures(model, Extreme::farthest, count, probe.random());
  const Eigen::Vector3d centre = reach_ball(model, 1, probe.random()).centre;
  EdgeSet at_rim{probe, "stretched"}, inside{probe, "stretched less 1e-9 m"},
      folded{probe, "folded"};
  for (const JointVector& q : stretched) at_rim.ask(q);
  for (const JointVector& q : stretched) inside.ask(nearer(model, q, centre, 1e-9));
  for (const auto& q : extreme_postures(model, Extreme::nearest, count, probe.random())) {
    folded.ask(q);
  }
  for (EdgeSet* set : {&at_rim, &inside, &folded}) set->close();
}

void goals_on_base_axis(Probe& probe) {
  const auto postures =
      postures_on_base_axis(probe.model(), probe.subject().edge_poses, probe.random());
  if (postures.empty()) {
    probe.report().skipped = "no posture within limits brings the tool onto the base axis";
    return;
  }
  EdgeSet set{probe, "on the base axis"};
  for (const JointVector& q : postures) {
    IkGoal goal = probe.goal_at(q);
    for (double& value : goal.pose.position) {
      if (std::abs(value) < 1e-12) value = 0;  // on the z axis exactly
    }
    set.ask(goal, q);
  }
  set.close();
}

void upright_goals(Probe& probe) {
  bool any = false;
  for (const double up : {1.0, -1.0}) {
    EdgeSet set{probe, up > 0 ? "straight up" : "straight down"};
    for (const JointVector& q :
         upright_postures(probe.model(), up, probe.subject().edge_poses / 2, probe.random())) {
      IkGoal goal = probe.goal_at(q);
      if (auto* direction = std::get_if<Direction>(&goal.pose.orientation)) {
        direction->unit = {0, 0, up};
      }
      set.ask(goal, q);
      any = true;
    }
    set.close();
  }
  if (!any) probe.report().skipped = "no posture within limits points straight up or down";
}

namespace {

/// Some joint slides, or is never as before however far it turns: the reach ball keeps its limits,
/// and a solver may answer beyond them.
bool limits_bound_the_reach(const RobotModel& model) {
  return std::ranges::any_of(model.chain(), [&](const ChainLink& link) {
    return turns_until_same(model, link.independent) == 0;
  });
}

/// The answer to a goal that is `beyond` further away than anything the tool reaches.
void expect_refused(Probe& probe, double beyond, bool far) {
  using Code = IkStatus::Code;
  const IkStatus& status = probe.status();
  const bool surely = probe.subject().closed_form || (far && probe.subject().any_seed);
  if (limits_bound_the_reach(probe.model()) && status.code == Code::joint_limit) {
    expect_true_residuals(probe);
    return expect_true_flags(probe);
  }
  if (probe.found().count > 0) {
    probe.violated(
        fmt::format("{} branches for a goal {:.3g} m out of reach", probe.found().count, beyond));
  }
  if (status.code != Code::out_of_reach && (surely || status.code != Code::no_convergence)) {
    probe.violated(fmt::format("a goal {:.3g} m out of reach: {}", beyond, describe(status)));
  } else if (!(status.shortfall > 0) || !std::isfinite(status.shortfall)) {
    probe.violated(fmt::format("a goal {:.3g} m out of reach is said to miss by {}", beyond,
                               status.shortfall));
  }
}

/// Beyond the rim, the pose otherwise that of the stretched arm, which nothing else comes nearer.
void expect_refused_at_rim(Probe& probe, const ReachBall& ball, double beyond) {
  for (const JointVector& q : ball.at_rim) {
    IkGoal goal = probe.goal_at(q);
    goal.tolerance = {.position_m = 0.1 * beyond, .angle_rad = 1e-10};
    goal.tolerance.position_m = std::min(goal.tolerance.position_m, 1e-9);
    const Eigen::Vector3d out = (goal.pose.position - ball.centre).normalized();
    goal.pose.position = ball.centre + (ball.radius + beyond) * out;
    const IkStatus status = probe.solve(goal, probe.random_joints());
    expect_refused(probe, beyond, false);
    if (status.code != IkStatus::Code::out_of_reach) continue;
    // A solver may measure along its own way, the lamp's horizontally: twice as far is wrong.
    const bool too_little = probe.subject().closed_form && status.shortfall < 0.5 * beyond;
    if (too_little || status.shortfall > 2 * beyond) {
      probe.violated(fmt::format("a goal {:.6g} m out of reach is said to be {:.6g} m out of reach",
                                 beyond, status.shortfall));
    }
  }
}

}  // namespace

void out_of_reach(Probe& probe) {
  const ReachBall ball = reach_ball(probe.model(), probe.subject().edge_poses, probe.random());
  // A joint may go beyond its limits by 1e-9 and is within them: that is the kind's tolerance.
  expect_refused_at_rim(probe, ball, limits_bound_the_reach(probe.model()) ? 1e-7 : 1e-9);
  expect_refused_at_rim(probe, ball, 0.1 * ball.radius);
  std::normal_distribution<double> normal;
  for (int i = 0; i < probe.subject().edge_poses / 10; ++i) {
    IkGoal goal = probe.goal_at(probe.random_joints());
    const Eigen::Vector3d out =
        Eigen::Vector3d{normal(probe.random()), normal(probe.random()), normal(probe.random())}
            .normalized();
    double told[2] = {};
    for (const int further : {0, 1}) {
      const double distance = 4 * ball.radius + 1 + 10 * further;
      goal.pose.position = ball.centre + distance * out;
      told[further] = probe.solve(goal, probe.random_joints()).shortfall;
      expect_refused(probe, distance - ball.radius, true);
    }
    if (probe.status().code != IkStatus::Code::out_of_reach) continue;
    if (told[0] < 1 || std::abs(told[1] - told[0] - 10) > 1) {
      probe.violated(
          fmt::format("{:.3g} m out of reach, then 10 m further away {:.3g} m", told[0], told[1]));
    }
  }
}

}  // namespace armature::ik_contract
