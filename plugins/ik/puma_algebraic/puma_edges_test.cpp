// SPDX-License-Identifier: Apache-2.0
// 1000 poses at and near every singular set, and on the rims of reach, where a nanometre decides.
#include <cmath>

#include "armature/kinds/ik/contract/postures.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

constexpr int kPoses = 1000;

class PumaEdges : public PumaTest, public testing::WithParamInterface<std::string> {
 protected:
  PumaEdges() {
    const ModelPtr arm = GetParam() == "sr1"              ? sr1()
                         : GetParam() == "industrial_arm" ? industrial_arm()
                                                          : standard_puma560();
    use(without_limits(*arm));
  }
  void expect_reached(const JointVector& q) {
    EXPECT_NE(solve(rotation_goal(q), q).code, IkStatus::Code::out_of_reach);
    expect_right(probe_->goal().tolerance.position_m);
  }
  /// Every branch of the goal that `q` reaches is there and right, and two are flagged.
  void expect_all_at(const JointVector& q, bool flagged) {
    expect_reached(q);
    // With a1 one shoulder may not reach.
    EXPECT_TRUE(found_.count == 8 || (arm_.a1 != 0 && found_.count == 4)) << found_.count;
    const auto singular = [](const IkBranch& branch) { return branch.singular; };
    EXPECT_TRUE(!flagged || std::count_if(found_.begin(), found_.end(), singular) >= 2);
  }
};

// That the joints which made the goal are found there is a law of the kind.
TEST_P(PumaEdges, EveryBranchIsThereAtAndNextToASingularSet) {
  for (const auto& [at, joint] : ik_contract::singular_postures(model(), kPoses, random_)) {
    for (const double offset : {0.0, 1e-9, -1e-9, 1e-7, -1e-7, 1e-4, -1e-4}) {
      SCOPED_TRACE(testing::Message() << "joint " << joint + 1 << ", offset " << offset);
      JointVector q = at;
      q[joint] += offset;
      expect_all_at(q, std::abs(offset) < 1e-6);
    }
  }
}

TEST_P(PumaEdges, EveryBranchIsThereWhereEverythingIsSingularAtOnce) {
  for (int i = 0; i < kPoses; ++i) {
    for (const double by : {0.0, 1e-9, 1e-7, 1e-4}) {
      SCOPED_TRACE(testing::Message() << "offset " << by);
      std::array<double, 6> t;
      for (double& angle : t) angle = any(-M_PI, M_PI);
      t[2] = by - arm_.beta;  // stretched
      t[1] =
          std::acos((by - arm_.a1) / (arm_.a2 + arm_.forearm)) - by / 2;  // to the axis of joint 1
      t[4] = by;
      JointVector q(6);
      for (std::size_t k = 0; k < 6; ++k) q.data()[k] = wrap_angle(arm_.joint(k, t[k]));
      expect_reached(q);
      EXPECT_GE(found_.count, 4);
    }
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
    const IkGoal at_rim = rotation_goal(q);
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
  IkGoal goal = rotation_goal(JointVector::Zero(6));
  goal.pose.position.x() = 1e99;
  const IkStatus status = solve(goal, JointVector::Zero(6));
  EXPECT_EQ(status.code, IkStatus::Code::out_of_reach);
  EXPECT_NEAR(status.shortfall / 1e99, 1, 1e-12);
}

}  // namespace
}  // namespace armature
