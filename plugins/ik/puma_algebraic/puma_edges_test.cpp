// SPDX-License-Identifier: Apache-2.0
// 1000 poses at and near every singular set, at the joint limits and anywhere.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "armature/robot/kinematics/kinematics.hpp"
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

}  // namespace
}  // namespace armature
