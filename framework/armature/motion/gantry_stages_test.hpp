// SPDX-License-Identifier: Apache-2.0
// A robot whose kinematics can be checked by eye, and the four stages for it: three prismatic
// joints that move along z, y and x, so that the tool is at (q3, q2, q1).
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "armature/motion/goal_planner.hpp"
#include "armature/motion/tracking.hpp"

namespace armature::test {

inline RobotModel gantry() {
  constexpr double kQuarterTurn = std::numbers::pi / 2;
  const auto joint = [](const char* name, double theta, double alpha) {
    Joint made;
    made.name = name;
    made.type = Joint::Type::prismatic;
    made.theta = theta;
    made.alpha = alpha;
    made.lower = -2;
    made.upper = 2;
    made.max_velocity = 1;
    made.max_acceleration = 2.5;
    return made;
  };
  std::vector<Joint> joints{joint("z", 0, -kQuarterTurn), joint("y", kQuarterTurn, kQuarterTurn),
                            joint("x", 0, 0)};
  std::vector<NamedFrame> frames{{.name = "tool", .parent_joint = 2}};
  return RobotModel{{"gantry", RobotModel::Convention::standard, joints, frames, FrameId{0},
                     Eigen::Vector3d::UnitZ(), std::nullopt}};
}

/// Throws when it is told to.
struct Moody {
  bool throws = false;

  void may_throw() const {
    if (throws) throw std::runtime_error{"no more of this"};
  }
};

/// Remembers what it was told of the last redundancy; that of joints is their sum.
class GantryIk : public IkSolver, public Moody {
 public:
  mutable std::vector<std::optional<double>> told;
  IkStatus::Code beyond = IkStatus::Code::out_of_reach;
  double beside_m = 0;  // of joint z, beside the goal

  std::optional<double> redundancy_of(const JointVector& q) const override { return q.sum(); }
  IkStatus solve(const IkGoal& goal, const JointVector&, IkBranches& out,
                 IkState& state) const override {
    may_throw();
    told.push_back(state.last_redundancy);
    out.clear();
    const Eigen::Vector3d& p = goal.pose.position;
    IkBranch& branch = out.add();
    branch.label = "only";
    branch.q = Eigen::Vector3d{p.z() + beside_m, p.y(), p.x()};
    branch.within_limits = p.cwiseAbs().maxCoeff() <= 2;
    if (branch.within_limits) return {};
    return {.code = beyond, .shortfall = p.cwiseAbs().maxCoeff() - 2, .detail = "gantry"};
  }
};

class FirstBranch : public BranchSelector, public Moody {
 public:
  Expected<std::vector<JointVector>> choose(const JointVector&,
                                            std::span<const IkBranches> waypoints) const override {
    may_throw();
    std::vector<JointVector> chosen;
    for (const IkBranches& branches : waypoints) chosen.push_back(branches.branch[0].q);
    return chosen;
  }
};

/// One joint segment to the goal; with a focus a cartesian line whose middle lies on the focus;
/// with key poses a cartesian line through them.
class LinePath : public PathPlanner, public Moody {
 public:
  mutable PathRequest last_request;

  Expected<Path> plan(const PathRequest& request) const override {
    may_throw();
    last_request = request;
    if (request.goal.position.x() > 1.5) return refuse("x beyond 1.5 m");
    if (!request.through.empty()) {
      PathSegment line{.space = PathSegment::Space::cartesian, .samples = {{0, request.start}}};
      const double count = static_cast<double>(request.through.size()) + 1;
      for (const ToolPose& key : request.through) {
        line.samples.push_back({static_cast<double>(line.samples.size()) / count, key});
      }
      line.samples.push_back({1, request.goal});
      return Path{line};
    }
    if (!request.focus) {
      return Path{{.space = PathSegment::Space::joint, .samples = {{1, request.goal}}}};
    }
    ToolPose middle = request.goal;
    middle.position = *request.focus;
    return Path{{.space = PathSegment::Space::cartesian,
                 .samples = {{0, request.start}, {0.5, middle}, {1, request.goal}}}};
  }
};

/// One quintic to the end of the last segment, as long as the limits want it.
class OneQuintic : public TrajectoryPlanner, public Moody {
 public:
  mutable TrajectoryRequest last_request;
  bool jumps = false;
  double ends_off_m = 0;  // of the last waypoint

  Expected<Trajectory> plan(const TrajectoryRequest& request) const override {
    may_throw();
    last_request = request;
    const JointVector end = request.segments.back().q.back().array() + ends_off_m;
    for (double duration = 0.05; duration < 30; duration *= 1.1) {
      Trajectory trajectory{.goal_id = request.goal_id,
                            .dof = static_cast<int>(end.size()),
                            .start = request.start,
                            .knots = {0, duration},
                            .pieces = {}};
      for (int i = 0; i < trajectory.dof; ++i) {
        trajectory.pieces.push_back(Quintic::between(
            {request.from.q[i], jumps ? 0 : request.from.v[i], jumps ? 0 : request.from.a[i]},
            {end[i], 0, 0}, duration));
      }
      const LimitUse use = limit_use(trajectory, request.max_velocity, request.max_acceleration);
      if (use.velocity <= 1 && use.acceleration <= 1) return trajectory;
    }
    return refuse("no duration keeps the limits");
  }
};

struct Gantry {
  RobotModel model = gantry();
  LinePath path;
  GantryIk ik;
  FirstBranch select;
  OneQuintic trajectory;
  MotionLimits limits{JointVector::Constant(3, 1.0), JointVector::Constant(3, 2.5)};

  GoalPlanner planner(const PlanningOptions& options = {}) const {
    return {model, {path, ik, select, trajectory}, limits, options};
  }
  Tracker tracker(const TrackingOptions& options) const { return {model, limits, ik, options}; }
};

inline MotionGoal goal_at(std::uint64_t id, double x, double y, double z) {
  MotionGoal goal;
  goal.id = id;
  goal.pose = {.position = {x, y, z}, .orientation = Direction{Eigen::Vector3d::UnitX()}};
  return goal;
}

inline JointState rest_at(double q1, double q2, double q3) {
  return {
      .q = Eigen::Vector3d{q1, q2, q3}, .v = Eigen::Vector3d::Zero(), .a = Eigen::Vector3d::Zero()};
}

/// Largest jump of q, v and a between neighbouring samples `step_s` apart, less what v, a and the
/// largest jerk in between explain.
inline ::testing::AssertionResult no_jump(const JointState& before, const JointState& after,
                                          double step_s) {
  for (int i = 0; i < before.q.size(); ++i) {
    const double q = std::abs(after.q[i] - before.q[i] - before.v[i] * step_s);
    const double v = std::abs(after.v[i] - before.v[i] - before.a[i] * step_s);
    const double a = std::abs(after.a[i] - before.a[i]);
    constexpr double kMaxJerk = 400;
    if (q > 3 * step_s * step_s || v > kMaxJerk * step_s * step_s || a > kMaxJerk * step_s) {
      return ::testing::AssertionFailure()
             << "joint " << i << " jumps by " << q << ", " << v << ", " << a;
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace armature::test
