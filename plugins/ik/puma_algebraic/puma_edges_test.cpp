// SPDX-License-Identifier: Apache-2.0
// 1000 poses at and near every singular set, on the rims of reach and at the joint limits.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "armature/robot/kinematics.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

constexpr int kPoses = 1000;
constexpr std::array<double, 4> kOffsets{0, 1e-9, 1e-7, 1e-4};

struct Subject {
  std::string name;
  ModelPtr model;
  friend void PrintTo(const Subject& subject, std::ostream* out) { *out << subject.name; }
};

class PumaEdges : public testing::TestWithParam<Subject> {
 protected:
  using Angles = std::array<double, 6>;  // t1 to t6 of PumaArm

  double any(double lower, double upper) {
    return std::uniform_real_distribution{lower, upper}(random_);
  }
  /// Away from every singular set.
  Angles regular_angles() {
    while (true) {
      Angles t;
      for (double& angle : t) angle = any(-M_PI, M_PI);
      const double psi = t[2] + arm_.beta;
      const double along = arm_.a1 + arm_.a2 * std::cos(t[1]) + arm_.forearm * std::cos(t[1] + psi);
      if (std::abs(std::sin(psi)) > 0.2 && std::abs(std::sin(t[4])) > 0.2 &&
          std::abs(along) > 0.2 * (arm_.a2 + arm_.forearm))
        return t;
    }
  }
  JointVector joints(const Angles& t) const {
    JointVector q(6);
    for (std::size_t i = 0; i < 6; ++i) {
      q[static_cast<Eigen::Index>(i)] = wrap_angle(arm_.joint(i, t[i]));
    }
    return q;
  }
  /// t3 at which the forearm makes the angle `psi` with the upper arm.
  double elbow(double psi) const { return psi - arm_.beta; }
  /// t2 that brings the wrist `along` link 1 from the axis of joint 1; false when no t2 does.
  bool put_wrist_over_axis(Angles& t, double along) {
    const double psi = t[2] + arm_.beta;
    const double x = arm_.a2 + arm_.forearm * std::cos(psi), y = arm_.forearm * std::sin(psi);
    const double cosine = (along - arm_.a1) / std::hypot(x, y);
    if (!(std::abs(cosine) < 1)) return false;
    t[1] = (any(-1, 1) < 0 ? -1 : 1) * std::acos(cosine) - std::atan2(y, x);
    return true;
  }
  IkStatus solve(const IkGoal& goal, const JointVector& seed) {
    IkState state;
    return solver_->solve(goal, seed, found_, state);
  }

  /// No branch is wrong or not a number, and each tells how exact it is.
  void expect_truth(const IkGoal& goal) const {
    for (const IkBranch& branch : found_) {
      ASSERT_TRUE(branch.q.allFinite()) << branch.label;
      const PoseResidual actual =
          residual(forward_kinematics(model(), branch.q), Eigen::Vector3d::UnitZ(), goal.pose);
      EXPECT_LE(actual.position_m, goal.tolerance.position_m) << branch.label;
      EXPECT_LE(actual.angle_rad, goal.tolerance.angle_rad) << branch.label;
      EXPECT_NEAR(branch.residual.position_m, actual.position_m, 1e-13) << branch.label;
      EXPECT_NEAR(branch.residual.angle_rad, actual.angle_rad, 1e-13) << branch.label;
    }
  }
  /// Every branch is there: four of each shoulder, and the joints that made the goal.
  void expect_whole(const JointVector& q, double tolerance) const {
    EXPECT_TRUE(found_.count == 8 || (arm_.a1 != 0 && found_.count == 4)) << found_.count;
    double nearest = 10;
    for (const IkBranch& branch : found_) {
      nearest = std::min(nearest, joint_distance(model(), branch.q, q));
    }
    EXPECT_LE(nearest, tolerance) << q.transpose();
  }
  using BringNear = std::function<bool(Angles&, double)>;
  /// `check` sees the branches of poses at each offset from a singular set, on both sides of it.
  void near_singular(const BringNear& bring_near,
                     const std::function<void(const JointVector&, double)>& check) {
    for (const double offset : kOffsets) {
      SCOPED_TRACE(::testing::Message() << "offset " << offset);
      for (int i = 0; i < kPoses; ++i) {
        const double by = i % 2 == 0 ? offset : -offset;
        Angles t = regular_angles();
        while (!bring_near(t, by)) t = regular_angles();
        const JointVector q = joints(t);
        const IkGoal goal = rotation_goal(model(), q);
        EXPECT_NE(solve(goal, q).code, IkStatus::Code::out_of_reach);
        expect_truth(goal);
        check(q, offset);
      }
    }
  }
  /// All are solved; those within 1e-7 are flagged. `tolerance` [rad] is what the rounding of a
  /// pose leaves of the joints there.
  void expect_solved(double tolerance, const BringNear& bring_near) {
    near_singular(bring_near, [&](const JointVector& q, double offset) {
      expect_whole(q, tolerance);
      if (offset > 1e-7) return;
      const auto singular = [](const IkBranch& branch) { return branch.singular; };
      EXPECT_GE(std::count_if(found_.begin(), found_.end(), singular), 2);
    });
  }
  const RobotModel& model() const { return *model_; }

  ModelPtr model_ = without_limits(*GetParam().model);
  PumaArm arm_ = puma_arm(model()).value();
  std::shared_ptr<const IkSolver> solver_ = solver_for(model());
  std::mt19937_64 random_{20260116};
  IkBranches found_;
};

TEST_P(PumaEdges, TheWristInLine) {
  expect_solved(4e-6, [](Angles& t, double by) {
    t[4] = by;
    return true;
  });
}

TEST_P(PumaEdges, TheWristFoldedBack) {
  expect_solved(4e-6, [](Angles& t, double by) {
    t[4] = M_PI + by;
    return true;
  });
}

TEST_P(PumaEdges, TheElbowStretched) {
  expect_solved(1e-6, [this](Angles& t, double by) {
    t[2] = elbow(by);
    return true;
  });
}

TEST_P(PumaEdges, TheElbowFolded) {
  // Folded, SR-1's wrist is 0.5 mm from the shoulder, next to the singular set of joint 1.
  expect_solved(1e-4, [this](Angles& t, double by) {
    t[2] = elbow(M_PI + by);
    return true;
  });
}

TEST_P(PumaEdges, TheWristOverTheShoulder) {
  expect_solved(1e-6, [this](Angles& t, double by) { return put_wrist_over_axis(t, by); });
}

TEST_P(PumaEdges, EverythingSingularAtOnce) {
  // The joints are not determined by the pose to any useful digit; what is answered must be right.
  near_singular(
      [this](Angles& t, double by) {
        t[2] = elbow(by);
        t[4] = by;
        return put_wrist_over_axis(t, by);
      },
      [this](const JointVector&, double) { EXPECT_GE(found_.count, 4); });
}

TEST_P(PumaEdges, EveryJointAtALimit) {
  model_ = GetParam().model;
  solver_ = solver_for(*model_);
  for (int i = 0; i < kPoses; ++i) {
    JointVector q = random_joints(model(), random_);
    for (Eigen::Index j = 0; j < 6; ++j) {
      if (any(0, 1) < 0.5) q[j] = any(0, 1) < 0.5 ? model().lower()[j] : model().upper()[j];
    }
    const IkGoal goal = rotation_goal(model(), q);
    EXPECT_EQ(solve(goal, q).code, IkStatus::Code::ok) << q.transpose();
    expect_truth(goal);
    expect_whole(q, 1e-6);
  }
}

/// What the lengths alone say about a wrist point: how far it is out of reach, 0 when it is within.
double shortfall_by_lengths(const PumaArm& arm, const Eigen::Vector3d& wrist) {
  const double radius = wrist.head<2>().norm();
  const double near = std::max(std::abs(arm.d2) - radius, 0.0);
  const double along = std::sqrt(std::max(radius * radius - arm.d2 * arm.d2, 0.0));
  double least = 1e9;
  for (const double side : {along, -along}) {
    const double rho = std::hypot(side - arm.a1, wrist.z());
    const double far = std::max(rho - arm.a2 - arm.forearm, 0.0);
    const double folded = std::max(std::abs(arm.a2 - arm.forearm) - rho, 0.0);
    least = std::min(least, std::hypot(near, std::max(far, folded)));
  }
  return least;
}

TEST_P(PumaEdges, AnyPoseIsSolvedOrIsOutOfReachByWhatTheLengthsSay) {
  const Eigen::Isometry3d tool_T_wrist = arm_.wrist_T_tool.inverse();
  int reached = 0;
  for (int i = 0; i < 4 * kPoses; ++i) {
    IkGoal goal;
    goal.pose.position = {any(-1.2, 1.2), any(-1.2, 1.2), any(-1.2, 1.2)};
    Eigen::Quaterniond rotation = Eigen::Quaterniond::UnitRandom();
    if (i % 4 == 1) goal.pose.position.head<2>().setZero();  // along the base axis
    if (i % 4 > 1) {                                         // straight up or down
      rotation = Eigen::AngleAxisd{any(-M_PI, M_PI), Eigen::Vector3d::UnitZ()} *
                 Eigen::AngleAxisd{i % 4 == 2 ? 0 : M_PI, Eigen::Vector3d::UnitX()};
    }
    goal.pose.orientation = rotation;
    const Eigen::Isometry3d base_T_tool = Eigen::Translation3d{goal.pose.position} * rotation;
    const Eigen::Vector3d wrist =
        (arm_.base_T_shoulder.inverse() * base_T_tool * tool_T_wrist).translation();
    const double wanted = shortfall_by_lengths(arm_, wrist);
    const IkStatus status = solve(goal, JointVector::Zero(6));
    EXPECT_EQ(status.code == IkStatus::Code::out_of_reach, wanted > 0) << describe(status);
    EXPECT_NEAR(status.shortfall, wanted, 1e-12);
    EXPECT_EQ(found_.count == 0, wanted > 0);
    expect_truth(goal);
    reached += wanted > 0 ? 0 : 1;
  }
  EXPECT_GT(reached, kPoses / 2);
}

INSTANTIATE_TEST_SUITE_P(Puma, PumaEdges,
                         testing::Values(Subject{"sr1", sr1()},
                                         Subject{"standard_puma560", standard_puma560()},
                                         Subject{"industrial_arm", industrial_arm()}),
                         testing::PrintToStringParamName());

/// SR-1 (a1 = 0) where a rim of reach goes through the wrist.
class PumaRims : public testing::Test {
 protected:
  /// Moves the goal so that the wrist moves in shoulder_T's directions, and solves.
  IkStatus solve_moved(const JointVector& q, const Eigen::Vector3d& by) {
    goal_ = rotation_goal(*sr1(), q);
    goal_.pose.position += by;
    IkState state;
    return solver_->solve(goal_, q, found_, state);
  }
  void expect_eight_right_branches() {
    EXPECT_EQ(found_.count, 8);
    for (const IkBranch& branch : found_) {
      const auto actual = residual(forward_kinematics(*sr1(), branch.q), {}, goal_.pose);
      EXPECT_LE(actual.position_m, 1e-13);
      EXPECT_LE(actual.angle_rad, 1e-13);
    }
  }
  JointVector with_elbow(double psi) {
    JointVector q = random_joints(*sr1(), random_);
    q[2] = psi - arm_.beta;
    return q;
  }
  /// Unit vector from the axis of joint 2 to the wrist, in the arm's plane.
  Eigen::Vector3d outwards(const JointVector& q, double psi) const {
    const Eigen::Vector2d reach =
        Eigen::Rotation2Dd{q[1]} *
        Eigen::Vector2d{arm_.a2 + arm_.forearm * std::cos(psi), arm_.forearm * std::sin(psi)};
    const Eigen::Vector2d u = reach.normalized();
    return {std::cos(q[0]) * u.x(), std::sin(q[0]) * u.x(), -u.y()};
  }

  PumaArm arm_ = puma_arm(*sr1()).value();
  std::shared_ptr<const IkSolver> solver_ = solver_for(*sr1());
  std::mt19937_64 random_{7};
  IkBranches found_;
  IkGoal goal_;
};

TEST_F(PumaRims, StretchedMinusANanometreHasAllBranchesAndANanometreMoreHasNone) {
  for (int i = 0; i < kPoses; ++i) {
    const JointVector q = with_elbow(0);
    EXPECT_NE(solve_moved(q, -1e-9 * outwards(q, 0)).code, IkStatus::Code::out_of_reach);
    expect_eight_right_branches();
    for (const double by : {1e-9, 0.1 * (arm_.a2 + arm_.forearm)}) {
      const IkStatus status = solve_moved(q, by * outwards(q, 0));
      EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
      EXPECT_NEAR(status.shortfall, by, 1e-14);
      EXPECT_EQ(status.detail, "the arm is stretched");
      EXPECT_EQ(found_.count, 0);
    }
  }
}

TEST_F(PumaRims, FoldedPlusANanometreHasAllBranchesAndANanometreLessHasNone) {
  const double nearest = std::abs(arm_.a2 - arm_.forearm);
  for (int i = 0; i < kPoses; ++i) {
    const JointVector q = with_elbow(M_PI);
    EXPECT_NE(solve_moved(q, 1e-9 * outwards(q, M_PI)).code, IkStatus::Code::out_of_reach);
    expect_eight_right_branches();
    for (const double by : {1e-9, 0.1 * nearest}) {
      const IkStatus status = solve_moved(q, -by * outwards(q, M_PI));
      EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
      EXPECT_NEAR(status.shortfall, by, 1e-13);  // the wrist is 0.5 mm from the shoulder
      EXPECT_EQ(status.detail, "the arm is folded");
    }
  }
}

TEST_F(PumaRims, NearTheAxisOfJoint1ANanometreDecides) {
  for (int i = 0; i < kPoses; ++i) {
    const double psi = 0.2 + 2.5 * i / kPoses;
    JointVector q = with_elbow(psi);
    q[1] =
        M_PI / 2 - std::atan2(arm_.forearm * std::sin(psi), arm_.a2 + arm_.forearm * std::cos(psi));
    // The wrist is d2 from the axis, square to link 1.
    const Eigen::Vector3d away{-std::sin(q[0]), std::cos(q[0]), 0};
    EXPECT_NE(solve_moved(q, 1e-9 * away).code, IkStatus::Code::out_of_reach);
    expect_eight_right_branches();
    for (const double by : {1e-9, 0.1 * arm_.d2}) {
      const IkStatus status = solve_moved(q, -by * away);
      EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
      EXPECT_NEAR(status.shortfall, by, 1e-14);
      EXPECT_EQ(status.detail, "too near the axis of joint 1");
    }
  }
}

TEST_F(PumaRims, AGoalAnywhereIsOutOfReachByItsDistance) {
  goal_ = rotation_goal(*sr1(), JointVector::Zero(6));
  goal_.pose.position.x() = 1e99;
  IkState state;
  const IkStatus status = solver_->solve(goal_, JointVector::Zero(6), found_, state);
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
  EXPECT_NEAR(status.shortfall / 1e99, 1, 1e-12);
}

// The rules where a joint is free.

TEST_F(PumaRims, AWristInLineKeepsTheSeedsFourthJoint) {
  JointVector q = random_joints(*sr1(), random_), seed = q;
  q[4] = 0;
  seed[3] = 0.7;
  IkState state;
  solver_->solve(rotation_goal(*sr1(), q), seed, found_, state);
  int kept = 0;
  for (const IkBranch& branch : found_) {
    if (std::abs(branch.q[4]) > 1e-6) continue;
    EXPECT_EQ(branch.q[3], 0.7);
    EXPECT_NEAR(wrap_angle(branch.q[3] + branch.q[5] - q[3] - q[5]), 0, 1e-12);
    EXPECT_TRUE(branch.singular);
    ++kept;
  }
  EXPECT_EQ(kept, 2);  // both wrists are one
}

/// SR-1 whose joints 4 and 6 have narrow limits.
RobotModel narrow_wrist() {
  auto joints = sr1()->joints();
  joints[3].lower = -1, joints[3].upper = 2;
  joints[5].lower = -0.5, joints[5].upper = 0.5;
  return arm_of(sr1()->convention(), joints, Eigen::Isometry3d::Identity(), {});
}

TEST(PumaFreeJoints, AWristInLineSharesItsRollsOutSoThatTheLimitsAreKept) {
  const RobotModel model = narrow_wrist();
  const auto solver = solver_for(model);
  std::mt19937_64 random{6};
  for (int i = 0; i < 1000; ++i) {
    JointVector q = random_joints(model, random);
    q[4] = 0;
    const JointVector seed = random_joints(model, random);
    const IkGoal goal = rotation_goal(model, q);
    IkBranches found;
    IkState state;
    EXPECT_EQ(solver->solve(goal, seed, found, state).code, IkStatus::Code::ok) << q.transpose();
    for (const IkBranch& branch : found) {
      const auto actual = residual(forward_kinematics(model, branch.q), {}, goal.pose);
      EXPECT_LE(std::max(actual.position_m, actual.angle_rad), 1e-10);  // in line is in line
      if (std::abs(branch.q[4]) > 1e-9 || !branch.within_limits) continue;
      // As near to the seed's as the limits allow: there, or one of the two is at a limit.
      const bool kept = std::abs(branch.q[3] - seed[3]) < 1e-12;
      const bool at_limit = std::abs(std::abs(branch.q[5]) - 0.5) < 1e-9;
      EXPECT_TRUE(kept || at_limit) << branch.q.transpose();
    }
  }
}

TEST(PumaFreeJoints, AWristOnTheAxisOfJoint1KeepsTheSeedsFirstJoint) {
  const ModelPtr model = industrial_arm();  // d2 = 0
  const PumaArm arm = puma_arm(*model).value();
  std::mt19937_64 random{3};
  JointVector q = random_joints(*model, random);
  const double psi = 2.5;
  q[2] = arm.joint(2, psi - arm.beta);
  const double x = arm.a2 + arm.forearm * std::cos(psi), y = arm.forearm * std::sin(psi);
  q[1] = arm.joint(1, std::acos(-arm.a1 / std::hypot(x, y)) - std::atan2(y, x));
  JointVector seed = q;
  seed[0] = -1.1;
  IkBranches found;
  IkState state;
  solver_for(*model)->solve(rotation_goal(*model, q), seed, found, state);
  ASSERT_EQ(found.count, 8);
  for (const IkBranch& branch : found) {
    EXPECT_NEAR(branch.q[0], -1.1, 1e-15);
    EXPECT_TRUE(branch.singular);
    EXPECT_LE(branch.residual.position_m, 1e-14);
  }
}

TEST(PumaFreeJoints, AFirstJointThatLeadsBeyondTheLimitsIsTriedElsewhere) {
  auto joints = narrow_wrist().joints();
  joints[1].d = 0;
  const RobotModel model = arm_of(sr1()->convention(), joints, Eigen::Isometry3d::Identity(), {});
  JointVector q(6), seed(6);
  q << 1.0, 0, -0.4, 0.9, 0.7, 0.1;
  const double psi = q[2] + std::atan2(0.4318, 0.0203), forearm = std::hypot(0.4318, 0.0203);
  q[1] = -M_PI / 2 - std::atan2(forearm * std::sin(psi), 0.4318 + forearm * std::cos(psi));
  seed << -2, 0, 0, 0, 0, 0;
  IkBranches found;
  IkState state;
  EXPECT_EQ(solver_for(model)->solve(rotation_goal(model, q), seed, found, state).code,
            IkStatus::Code::ok);
  for (const IkBranch& branch : found) EXPECT_LE(branch.residual.position_m, 1e-14);
}

TEST(PumaFreeJoints, AWristOnTheAxisOfJoint2KeepsTheSeedsSecondJoint) {
  auto joints = sr1()->joints();
  joints[3].a = 0;  // forearm as long as the upper arm: it folds onto the shoulder
  const RobotModel model = arm_of(sr1()->convention(), joints, Eigen::Isometry3d::Identity(), {});
  std::mt19937_64 random{4};
  JointVector q = random_joints(model, random);
  q[2] = M_PI / 2;
  JointVector seed = q;
  seed[1] = -2.2;
  IkBranches found;
  IkState state;
  solver_for(model)->solve(rotation_goal(model, q), seed, found, state);
  EXPECT_EQ(found.count, 8);
  for (const IkBranch& branch : found) {
    EXPECT_NEAR(branch.q[1], -2.2, 1e-15);
    EXPECT_TRUE(branch.singular);
    EXPECT_LE(branch.residual.position_m, 1e-12);
  }
}

}  // namespace
}  // namespace armature
