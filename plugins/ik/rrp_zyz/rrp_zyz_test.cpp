// SPDX-License-Identifier: Apache-2.0
#include "rrp_zyz.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/ik/contract.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "rrp_test_arms.hpp"

namespace armature {
namespace {

using testing::another_master;
using testing::changed_master;
using testing::goal_at;
using testing::joints;
using testing::master;
using testing::solver_for;

IkSubject subject(std::shared_ptr<const RobotModel> model) {
  return {.model = model, .solver = solver_for(*model), .closed_form = true};
}

// The arms that ship, with the parameters that it ships with, are asked by tests/contracts.
INSTANTIATE_TEST_SUITE_P(AnotherMaster, IkLaws,
                         ::testing::Values(IkLawCase{"other_arm",
                                                     [] { return subject(another_master()); }}),
                         ::testing::PrintToStringParamName());

class RrpZyzTest : public ::testing::Test {
 protected:
  IkStatus solve(const JointVector& q, const JointVector& seed) {
    IkState state;
    return solver_->solve(goal_at(*master(), q), seed, found_, state);
  }
  std::shared_ptr<const IkSolver> solver_ = solver_for(*master());
  IkBranches found_;
};

TEST_F(RrpZyzTest, BranchesComeInAFixedOrderWithTheirNames) {
  const JointVector q = joints({0.8886, 0.9597, 0.1206296, 0.8326, 0.6482, 1.2461});
  EXPECT_EQ(solve(q, JointVector::Zero(6)).code, IkStatus::Code::ok);
  ASSERT_EQ(found_.count, 4);
  EXPECT_EQ(found_.branch[0].label, "base0/wrist0");
  EXPECT_EQ(found_.branch[1].label, "base0/wrist1");
  EXPECT_EQ(found_.branch[2].label, "base1/wrist0");
  EXPECT_EQ(found_.branch[3].label, "base1/wrist1");
  EXPECT_LE((found_.branch[0].q - q).cwiseAbs().maxCoeff(), 1e-12);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found_.branch[i].q[1] >= 0, i < 2) << i;
    EXPECT_EQ(found_.branch[i].q[4] >= 0, i % 2 == 0) << i;
  }
}

TEST_F(RrpZyzTest, OnTheBaseAxisTheFirstJointIsTheSeeds) {
  const JointVector q = joints({0.3, 0, 0.1, 0.4, 0.5, 0.6});
  EXPECT_EQ(solve(q, joints({-0.7, 1, 0, 0, 0, 0})).code, IkStatus::Code::joint_limit);
  ASSERT_EQ(found_.count, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found_.branch[i].q[0], i < 2 ? -0.7 : M_PI - 0.7, 1e-15);
    EXPECT_EQ(found_.branch[i].q[1], 0);
    EXPECT_TRUE(found_.branch[i].singular);
  }
}

TEST_F(RrpZyzTest, WithAStraightWristTheFourthJointIsTheSeeds) {
  const JointVector q = joints({0.3, 1.2, 0.1, 0.4, 0, 0.6});
  EXPECT_EQ(solve(q, joints({0, 1, 0, -0.9, 0, 0})).code, IkStatus::Code::ok);
  ASSERT_EQ(found_.count, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found_.branch[i].q[3], i % 2 == 0 ? -0.9 : M_PI - 0.9, 1e-15);
    EXPECT_TRUE(found_.branch[i].singular);
  }
  EXPECT_EQ(found_.branch[0].q[4], 0);
  EXPECT_EQ(std::abs(found_.branch[2].q[4]), M_PI);  // the turned base looks the other way
  EXPECT_NEAR(found_.branch[0].q[5], 0.4 + 0.6 + 0.9, 1e-14);
}

TEST_F(RrpZyzTest, AGoalBeyondTheSlideSaysHowFarAndWhichEnd) {
  JointVector q = joints({0.3, 1.2, 0.201, 0.4, 0.5, 0.6});
  EXPECT_EQ(describe(solve(q, q)), "out_of_reach: 0.001 m beyond reach (the slide is too short)");
  EXPECT_EQ(found_.count, 0);
  q[2] = -0.02;  // the arm's centre itself
  EXPECT_EQ(describe(solve(q, q)),
            "out_of_reach: 0.02 m beyond reach (the slide does not go in so far)");
}

TEST_F(RrpZyzTest, BranchesBeyondTheLimitsAreGivenAndMarked) {
  const JointVector q = joints({0.3, 0.1, 0.1, 0.4, 0.5, 0.6});  // joint 2 begins at 10 degrees
  const IkStatus status = solve(q, q);
  EXPECT_EQ(describe(status), "joint_limit: every branch leaves the joint limits");
  ASSERT_EQ(found_.count, 4);
  for (const IkBranch& branch : found_) EXPECT_FALSE(branch.within_limits);
}

TEST(RrpStructure, ALockedJointIsRefused) {
  RobotParts parts = master()->parts();
  parts.joints[4].locked = true;
  parts.home = JointVector::Zero(6);
  EXPECT_EQ(RrpZyz::make(RobotModel{parts}, Params{}).error().text,
            "not a polar arm with a ZYZ wrist: joint 'j5' is locked");
}

/// Why the solver refuses the master with some rows changed.
template <class Change>
std::string refusal(Change change) {
  const auto made = RrpZyz::make(*changed_master(change), Params{});
  return made ? "" : made.error().text;
}

TEST(RrpStructure, TheFirstMismatchIsNamed) {
  const std::string begin = "not a polar arm with a ZYZ wrist: ";
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[1].alpha = 1; }),
            begin + "joint 'j2': alpha_deg must be 90 or -90, it is 57.29577951");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[3].alpha = 0.1; }),
            begin + "joint 'j4': alpha_deg must be a multiple of 90, it is 5.729577951");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[4].a = 0.02; }),
            begin + "joint 'j5': a_m must be 0, it is 0.02");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[5].d = 0.02; }),
            begin + "joint 'j6': d_m must be 0, it is 0.02");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[2].type = Joint::Type::revolute; }),
            begin + "joint 'j3' must be prismatic");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[3].type = Joint::Type::prismatic; }),
            begin + "joint 'j4' must be revolute");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[5].coupling = Joint::Coupling{.to = 4}; }),
            begin + "joint 'j6' is coupled");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows[2].lower = -0.02; }),
            begin + "joint 'j3': d_m plus the lower limit must be positive, it is 0");
  EXPECT_EQ(refusal([](auto& rows, auto&) { rows.push_back(rows[5]); }),
            begin + "6 joints needed, 'changed' has 7");
  const RobotModel& m = *master();
  const auto made = [&](RobotModel::Convention convention, std::vector<NamedFrame> frames,
                        std::optional<Eigen::Vector3d> axis) {
    const RobotModel other{{"other", convention, m.joints(), frames, FrameId{0}, axis, {}}};
    return RrpZyz::make(other, Params{}).error().text;
  };
  EXPECT_EQ(made(RobotModel::Convention::standard, m.frames(), {}),
            begin + "its Denavit-Hartenberg convention is not modified");
  EXPECT_EQ(made(m.convention(), {{"tool", 4, Eigen::Isometry3d::Identity()}}, {}),
            begin + "its tool must hang on joint 'j6'");
  EXPECT_EQ(made(m.convention(), m.frames(), Eigen::Vector3d{1, 0, 0}),
            begin + "it has a pointing axis, and six joints leave the turn about it open");
}

/// Every arm of the pattern: signs of the right angles from the bits, axis 4 across or along.
std::shared_ptr<const RobotModel> variant(unsigned bits, bool across) {
  return changed_master([&](auto& rows, auto&) {
    for (unsigned i = 0; i < 6; ++i) {
      const bool set = (bits >> i) % 2 == 1;
      rows[i].alpha = set ? M_PI / 2 : -M_PI / 2;
      if (i == 3 && !across) rows[i].alpha = set ? M_PI : 0;
    }
    testing::turn_all_the_way(rows);
  });
}

TEST(RrpZyzRandom, EverySignOfTheRightAnglesIsReadFromTheRobot) {
  SCOPED_TRACE("seed 8");
  std::mt19937_64 random{8};
  for (unsigned bits = 0; bits < 128; ++bits) {
    const auto model = variant(bits % 64, bits < 64);
    const auto solver = solver_for(*model);
    for (int n = 0; n < 100; ++n) {
      const JointVector q = testing::random_joints(*model, random);
      const IkGoal goal = goal_at(*model, q);
      IkBranches found;
      IkState state;
      ASSERT_EQ(solver->solve(goal, JointVector::Zero(6), found, state).code, IkStatus::Code::ok);
      ASSERT_EQ(found.count, 4);
      double nearest = 10;
      for (const IkBranch& branch : found) {
        const auto error = residual(forward_kinematics(*model, branch.q), {}, goal.pose);
        ASSERT_LE(error.position_m, 1e-14) << "signs " << bits << " " << branch.label;
        ASSERT_LE(error.angle_rad, 1e-14) << "signs " << bits << " " << branch.label;
        nearest = std::min(nearest, testing::distance(*model, branch.q, q));
      }
      ASSERT_LE(nearest, 1e-9) << "signs " << bits << ", q " << q.transpose();
    }
  }
}

}  // namespace
}  // namespace armature
