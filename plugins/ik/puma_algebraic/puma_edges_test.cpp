// SPDX-License-Identifier: Apache-2.0
// 1000 poses at and near every singular set, and on the rims of reach, where a nanometre decides.
#include <cmath>
#include <functional>

#include "armature/robot/kinematics.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

constexpr int kPoses = 1000;

class PumaEdges : public PumaTest, public testing::WithParamInterface<std::string> {
 protected:
  using Angles = std::array<double, 6>;  // t1 to t6 of PumaArm
  /// Brings angles near to a singular set; false where they cannot be.
  using BringNear = std::function<bool(Angles&, double by)>;

  PumaEdges() { use(without_limits(*arm())); }
  static ModelPtr arm() {
    return GetParam() == "sr1"              ? sr1()
           : GetParam() == "industrial_arm" ? industrial_arm()
                                            : standard_puma560();
  }
  double reach() const { return arm_.a2 + arm_.forearm; }
  /// Away from every singular set.
  Angles regular_angles() {
    while (true) {
      Angles t;
      for (double& angle : t) angle = any(-M_PI, M_PI);
      const double psi = t[2] + arm_.beta;
      const double along = arm_.a1 + arm_.a2 * std::cos(t[1]) + arm_.forearm * std::cos(t[1] + psi);
      if (std::abs(std::sin(psi)) > 0.2 && std::abs(std::sin(t[4])) > 0.2 &&
          std::abs(along) > 0.2 * reach())
        return t;
    }
  }
  /// t2 that brings the wrist `along` link 1 from the axis of joint 1; false when no t2 does.
  bool put_wrist_over_axis(Angles& t, double along) {
    const double psi = t[2] + arm_.beta;
    const double x = arm_.a2 + arm_.forearm * std::cos(psi), y = arm_.forearm * std::sin(psi);
    const double cosine = (along - arm_.a1) / std::hypot(x, y);
    if (!(std::abs(cosine) < 1)) return false;
    t[1] = (any(-1, 1) < 0 ? -1 : 1) * std::acos(cosine) - std::atan2(y, x);
    return true;
  }
  /// At each offset from a singular set, on both sides of it: the branches are right, at least
  /// `branches`, and those within 1e-7 are flagged. The joints that made the goal are among them,
  /// to within the `tolerance` [rad] that the rounding of a pose leaves of them there.
  void expect_solved(const char* what, int branches, double tolerance,
                     const BringNear& bring_near) {
    for (const double offset : {0.0, 1e-9, 1e-7, 1e-4}) {
      SCOPED_TRACE(testing::Message() << what << ", offset " << offset);
      for (int i = 0; i < kPoses && !HasFailure(); ++i) {
        Angles t = regular_angles();
        while (!bring_near(t, i % 2 == 0 ? offset : -offset)) t = regular_angles();
        JointVector q(6);
        for (int k = 0; k < 6; ++k) q[k] = wrap_angle(arm_.joint(k, t[k]));
        const IkGoal goal = rotation_goal(model(), q);
        EXPECT_NE(solve(goal, q).code, IkStatus::Code::out_of_reach);
        expect_right(goal.tolerance.position_m);
        EXPECT_GE(found_.count, branches);
        EXPECT_EQ(found_.count % 4, 0);
        EXPECT_LE(nearest_to(q), tolerance) << q.transpose();
        const auto singular = [](const IkBranch& branch) { return branch.singular; };
        const auto flagged = std::count_if(found_.begin(), found_.end(), singular);
        EXPECT_TRUE(flagged >= 2 || offset > 1e-7) << flagged;
      }
    }
  }
};

TEST_P(PumaEdges, EveryBranchIsThereNextToASingularSet) {
  const int all = arm_.a1 == 0 ? 8 : 4;  // of a shoulder; with a1 the other one may not reach
  const auto elbow = [this](Angles& t, double psi) {
    t[2] = psi - arm_.beta;
    return true;
  };
  const auto fifth = [](Angles& t, double t5) {
    t[4] = t5;
    return true;
  };
  const auto over_axis = [this](Angles& t, double by) { return put_wrist_over_axis(t, by); };
  expect_solved("the wrist in line", all, 4e-6, fifth);
  expect_solved("the wrist folded back", all, 4e-6,
                [&](Angles& t, double by) { return fifth(t, M_PI + by); });
  expect_solved("the elbow stretched", all, 1e-6, elbow);
  // Folded, SR-1's wrist is 0.5 mm from the shoulder, next to the singular set of joint 1.
  expect_solved("the elbow folded", all, 1e-4,
                [&](Angles& t, double by) { return elbow(t, M_PI + by); });
  expect_solved("the wrist over the shoulder", all, 1e-6, over_axis);
  // There the joints are not determined by the pose to any useful digit.
  expect_solved("everything at once", 4, 10, [&](Angles& t, double by) {
    return elbow(t, by) && fifth(t, by) && over_axis(t, by);
  });
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
  int reached = 0;
  for (int i = 0; i < 4 * kPoses; ++i) {
    IkGoal goal;
    goal.pose.position = {any(-1.2, 1.2), any(-1.2, 1.2), any(-1.2, 1.2)};
    if (i % 4 == 1) goal.pose.position.head<2>().setZero();  // along the base axis
    Eigen::Quaterniond rotation = Eigen::Quaterniond::UnitRandom();
    if (i % 4 > 1) {  // straight up or down
      rotation = Eigen::AngleAxisd{any(-M_PI, M_PI), Eigen::Vector3d::UnitZ()} *
                 Eigen::AngleAxisd{i % 4 == 2 ? 0 : M_PI, Eigen::Vector3d::UnitX()};
    }
    goal.pose.orientation = rotation;
    const Eigen::Isometry3d base_T_tool = Eigen::Translation3d{goal.pose.position} * rotation;
    const double wanted = shortfall_by_lengths(
        arm_,
        (arm_.base_T_shoulder.inverse() * base_T_tool * arm_.wrist_T_tool.inverse()).translation());
    const IkStatus status = solve(goal, JointVector::Zero(6));
    EXPECT_EQ(status.code == IkStatus::Code::out_of_reach, wanted > 0) << describe(status);
    EXPECT_NEAR(status.shortfall, wanted, 1e-12);
    EXPECT_EQ(found_.count == 0, wanted > 0);
    expect_right(goal.tolerance.position_m);
    reached += wanted > 0 ? 0 : 1;
  }
  EXPECT_GT(reached, kPoses / 2);
}

TEST_P(PumaEdges, JointsAtTheirLimitsAreFoundWithEveryBranch) {
  use(arm());
  for (int i = 0; i < kPoses; ++i) {
    JointVector q = random_joints();
    for (int k = 0; k < 6; ++k) {
      if (any(0, 1) < 0.5) q[k] = any(0, 1) < 0.5 ? model().lower()[k] : model().upper()[k];
    }
    EXPECT_EQ(solve(rotation_goal(model(), q), q).code, IkStatus::Code::ok) << q.transpose();
    expect_right(goal_.tolerance.position_m);
    EXPECT_TRUE(found_.count == 8 || (arm_.a1 != 0 && found_.count == 4)) << found_.count;
    EXPECT_LE(nearest_to(q), 1e-6) << q.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Puma, PumaEdges,
                         testing::Values("sr1", "standard_puma560", "industrial_arm"),
                         [](const auto& arm) { return arm.param; });

/// SR-1 (a1 = 0) where a rim of reach goes through the wrist.
class PumaRims : public PumaTest {
 protected:
  /// A nanometre on the side of `inside` (a direction, at joints `q`) all branches are there; a
  /// nanometre, or `far`, on the other side none is, for the reason that is told.
  void expect_rim(const JointVector& q, const Eigen::Vector3d& inside, double far,
                  std::string_view why, double rounding = 1e-14) {
    const IkGoal at_rim = rotation_goal(model(), q);
    const auto solve_moved = [&](double by) {
      IkGoal goal = at_rim;
      goal.pose.position += by * inside;
      return solve(goal, q);
    };
    EXPECT_NE(solve_moved(1e-9).code, IkStatus::Code::out_of_reach);
    EXPECT_EQ(found_.count, 8);
    expect_right(1e-13);
    for (const double by : {1e-9, far}) {
      const IkStatus status = solve_moved(-by);
      EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
      EXPECT_NEAR(status.shortfall, by, rounding);
      EXPECT_EQ(status.detail, why);
      EXPECT_EQ(found_.count, 0);
    }
  }
  /// The wrist seen from the axis of joint 2, in the arm's plane.
  Eigen::Vector2d wrist_in_plane(double psi) const {
    return {arm_.a2 + arm_.forearm * std::cos(psi), arm_.forearm * std::sin(psi)};
  }
  JointVector with_elbow(double psi) {
    JointVector q = random_joints();
    q[2] = psi - arm_.beta;
    return q;
  }
  /// From the axis of joint 2 to the wrist.
  Eigen::Vector3d outwards(const JointVector& q, double psi) const {
    const Eigen::Vector2d u = Eigen::Rotation2Dd{q[1]} * wrist_in_plane(psi).normalized();
    return {std::cos(q[0]) * u.x(), std::sin(q[0]) * u.x(), -u.y()};
  }
};

TEST_F(PumaRims, ANanometreDecidesWhereTheArmIsStretchedOrFolded) {
  for (int i = 0; i < kPoses && !HasFailure(); ++i) {
    const JointVector stretched = with_elbow(0), folded = with_elbow(M_PI);
    expect_rim(stretched, -outwards(stretched, 0), 0.1 * (arm_.a2 + arm_.forearm),
               "the arm is stretched");
    expect_rim(folded, outwards(folded, M_PI), 0.1 * std::abs(arm_.a2 - arm_.forearm),
               "the arm is folded", 1e-13);  // the wrist is 0.5 mm from the shoulder
  }
}

TEST_F(PumaRims, ANanometreDecidesNearTheAxisOfJoint1) {
  for (int i = 0; i < kPoses && !HasFailure(); ++i) {
    const double psi = 0.2 + 2.5 * i / kPoses;
    JointVector q = with_elbow(psi);
    const Eigen::Vector2d wrist = wrist_in_plane(psi);
    q[1] = M_PI / 2 - std::atan2(wrist.y(), wrist.x());
    // The wrist is d2 from the axis, square to link 1.
    expect_rim(q, {-std::sin(q[0]), std::cos(q[0]), 0}, 0.1 * arm_.d2,
               "too near the axis of joint 1");
  }
}

TEST_F(PumaRims, AGoalAnywhereIsOutOfReachByItsDistance) {
  IkGoal goal = rotation_goal(model(), JointVector::Zero(6));
  goal.pose.position.x() = 1e99;
  const IkStatus status = solve(goal, JointVector::Zero(6));
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
  EXPECT_NEAR(status.shortfall / 1e99, 1, 1e-12);
}

}  // namespace
}  // namespace armature
