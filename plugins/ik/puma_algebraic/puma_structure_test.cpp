// SPDX-License-Identifier: Apache-2.0
#include "puma_structure.hpp"

#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"
#include "puma_algebraic.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

using PumaStructure = PumaTest;

/// The product of transforms that PumaArm is documented with.
Eigen::Isometry3d canonical_pose(const PumaArm& arm, const JointVector& q) {
  using Eigen::AngleAxisd;
  using Eigen::Translation3d;
  const auto x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();
  const auto t = [&](std::size_t i) {
    return AngleAxisd{arm.canonical(i, q[static_cast<Eigen::Index>(i)]), z};
  };
  const AngleAxisd down{-M_PI / 2, x}, up{M_PI / 2, x};
  Eigen::Isometry3d pose = arm.base_T_shoulder * t(0);
  pose = pose * down * Translation3d{arm.a1, 0, 0} * t(1) * Translation3d{0, 0, arm.d2};
  pose = pose * Translation3d{arm.a2, 0, 0} * t(2);
  pose = pose * down * Translation3d{arm.a3, 0, 0} * t(3) * Translation3d{0, 0, arm.d4};
  pose = pose * up * t(4) * down;
  if (arm.needle) {
    pose = pose * Translation3d{0, 0, arm.sign[5] * q[5]};
  } else {
    pose = pose * t(5);
  }
  return pose * arm.wrist_T_tool;
}

TEST_F(PumaStructure, EveryArmOfThePatternHasTheSameForwardKinematicsInTheOneForm) {
  for (int i = 0; i < 500; ++i) {
    use(random_arm(random_));
    if (i % 3 == 0) {  // joint 6 slides
      auto joints = model().joints();
      joints[5].type = Joint::Type::prismatic;
      joints[5].lower = -0.2, joints[5].upper = 0.4;
      use(arm_of(model().convention(), joints, model().frame(model().tool()).parent_T_frame));
    }
    EXPECT_GT(arm_.a2, 0);
    const JointVector q = random_joints();
    EXPECT_TRUE(canonical_pose(arm_, q).isApprox(forward_kinematics(model(), q), 1e-12));
  }
}

TEST_F(PumaStructure, EveryArmOfThePatternIsSolved) {
  for (int i = 0; i < 500; ++i) {
    use(random_arm(random_));
    for (int k = 0; k < 10; ++k) {
      const JointVector q = random_joints();
      ASSERT_EQ(solve(rotation_goal(q), random_joints()).code, IkStatus::Code::ok);
      expect_right(1e-13);
      EXPECT_LE(probe_->nearest(q), 1e-6);
      EXPECT_EQ(found_.count % 4, 0);
    }
  }
}

TEST_F(PumaStructure, Sr1IsReadAsTheThesisWritesIt) {
  const PumaArm& arm = arm_;
  EXPECT_EQ(arm.a1, 0);
  EXPECT_EQ(arm.d2, 0.15005);
  EXPECT_EQ(arm.a2, 0.4318);
  EXPECT_EQ(arm.a3, 0.0203);
  EXPECT_EQ(arm.d4, 0.4318);
  EXPECT_FALSE(arm.needle);
  EXPECT_FALSE(arm.pointing);
  EXPECT_TRUE(arm.base_T_shoulder.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_EQ(arm.wrist_T_tool.translation(), Eigen::Vector3d(0, 0, 0.2));
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(arm.sign[i], 1);
    EXPECT_EQ(arm.zero[i], 0);
  }
  EXPECT_TRUE(puma_arm(*sr1_needle()).value().needle);
  EXPECT_EQ(puma_arm(*sr1_needle()).value().pointing, 1.0);
}

/// Why SR-1 is refused with some rows changed.
template <class Change>
std::string refusal(Change change) {
  auto joints = sr1()->joints();
  change(joints);
  const auto made = puma_arm(*arm_of(sr1()->convention(), joints));
  constexpr std::string_view kFirst = "not a PUMA-pattern arm: ";
  if (made || !made.error().text.starts_with(kFirst)) return "no refusal";
  return made.error().text.substr(kFirst.size());
}

TEST_F(PumaStructure, TheFirstMismatchIsNamed) {
  EXPECT_EQ(refusal([](auto& rows) { rows[1].alpha = 0; }),
            "joint 'j2': alpha_deg must be 90 or -90, it is 0");
  EXPECT_EQ(refusal([](auto& rows) { rows[2].alpha = M_PI / 2; }),
            "joint 'j3': alpha_deg must be 0 or 180, it is 90");
  EXPECT_EQ(refusal([](auto& rows) { rows[2].a = 0; }), "joint 'j3': a_m must not be 0");
  EXPECT_EQ(refusal([](auto& rows) { rows[3].a = rows[3].d = 0; }),
            "joint 'j4': d_m must not be 0 when the length before it is 0");
  EXPECT_EQ(refusal([](auto& rows) { rows[4].a = 0.02; }),
            "joint 'j5': a_m must be 0 for axes 4, 5 and 6 to meet, it is 0.02");
  EXPECT_EQ(refusal([](auto& rows) { rows[4].d = 0.1; }),
            "joint 'j5': d_m must be 0 for axes 4, 5 and 6 to meet, it is 0.1");
  EXPECT_EQ(refusal([](auto& rows) { rows[2].type = Joint::Type::prismatic; }),
            "joint 'j3' is not revolute");
  EXPECT_EQ(refusal([](auto& rows) { rows[5].coupling = Joint::Coupling{.to = 4}; }),
            "joint 'j6' is coupled");
  EXPECT_EQ(refusal([](auto& rows) { rows.pop_back(); }), "6 joints needed, 'arm' has 5");
  EXPECT_EQ(refusal([](auto& rows) {
              rows[5].type = Joint::Type::prismatic;
              rows[5].upper = std::numeric_limits<double>::infinity();
            }),
            "joint 'j6', the needle, has no limits");
}

TEST_F(PumaStructure, ALockedJointIsRefused) {
  RobotParts parts = sr1()->parts();
  parts.joints[4].locked = true;
  EXPECT_EQ(puma_arm(RobotModel{parts}).error().text,
            "not a PUMA-pattern arm: joint 'j5' is locked");
}

TEST_F(PumaStructure, AToolThatDoesNotHangOnTheLastJointIsRefused) {
  const RobotModel model{{"arm",
                          sr1()->convention(),
                          sr1()->joints(),
                          {{"tool", 4, {}}},
                          FrameId{},
                          std::nullopt,
                          std::nullopt}};
  EXPECT_EQ(puma_arm(model).error().text,
            "not a PUMA-pattern arm: its tool must hang on joint 'j6'");
  EXPECT_FALSE(PumaAlgebraic::make(model, Params{}));
}

}  // namespace
}  // namespace armature
