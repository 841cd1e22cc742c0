// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/reference.hpp"

#include <gtest/gtest.h>

#include <random>

#include "armature/motion/gantry_stages_test.hpp"

namespace armature {
namespace {

ShortTrajectory move(const JointState& from, const JointVector& to, Time start, double duration_s) {
  ShortTrajectory made{.goal_id = 1, .dof = static_cast<int>(to.size()), .start = start};
  made.add_piece(duration_s);
  for (int i = 0; i < made.dof; ++i) {
    made.piece(0, i) =
        Quintic::between({from.q[i], from.v[i], from.a[i]}, {to[i], 0, 0}, duration_s);
  }
  return made;
}

const JointVector kThere = Eigen::Vector3d{0.5, -0.5, 1};

TEST(Reference, HoldsWhereItStarted) {
  Reference reference;
  EXPECT_FALSE(reference.started());
  reference.start(kThere, Time{1'000'000'000});
  const JointState later = reference.at(Time{9'000'000'000});
  EXPECT_EQ(later.q, kThere);
  EXPECT_TRUE(at_rest(later));
}

TEST(Reference, FollowsTheOldTrajectoryUntilTheNewOneStarts) {
  Reference reference;
  reference.start(Eigen::Vector3d::Zero(), Time{0});
  const Time splice = Time{} + seconds(0.005);
  reference.splice(move(reference.at(splice), kThere, splice, 1));
  EXPECT_EQ(reference.at(Time{} + seconds(0.004)).q, Eigen::Vector3d::Zero());
  EXPECT_NEAR((reference.at(Time{} + seconds(0.505)).q - 0.5 * kThere).norm(), 0, 1e-12);
  EXPECT_NEAR((reference.at(Time{} + seconds(3)).q - kThere).norm(), 0, 1e-12);
}

TEST(Reference, HasNoJumpInPositionVelocityOrAccelerationAtAnySplice) {
  Reference reference;
  reference.start(Eigen::Vector3d::Zero(), Time{0});
  const Duration step = seconds(0.001);
  std::mt19937 random{20260101};
  SCOPED_TRACE("seed 20260101");
  std::uniform_real_distribution<double> position{-1, 1};
  JointState before = reference.at(Time{0});
  for (int k = 1; k < 3000; ++k) {
    const Time now = Time{} + k * step;
    reference.advance(now);
    if (k % 100 == 3) {
      const Time splice = now + seconds(0.005);
      const Eigen::Vector3d goal{position(random), position(random), position(random)};
      reference.splice(move(reference.at(splice), goal, splice, 1.5));
    }
    const JointState state = reference.at(now);
    ASSERT_TRUE(test::no_jump(before, state, 0.001)) << "at step " << k;
    before = state;
  }
}

TEST(Reference, DropsWhatWouldHaveTakenOverLater) {
  Reference reference;
  reference.start(Eigen::Vector3d::Zero(), Time{0});
  reference.splice(move(reference.at(Time{500}), kThere, Time{500}, 1));
  reference.splice(short_hold_at(Eigen::Vector3d::Zero(), Time{400}, 7));
  EXPECT_EQ(reference.last_start(), Time{400});
  EXPECT_EQ(reference.at(Time{2'000'000'000}).q, Eigen::Vector3d::Zero());
}

TEST(Reference, HoldsTheSampleOfATrajectoryAsLongAsItIsNeeded) {
  static const MessageType kNumber{.create = [] { return static_cast<void*>(new int{}); },
                                   .destroy = [](void* n) { delete static_cast<int*>(n); }};
  SamplePool pool{kNumber, 1};
  Reference reference;
  reference.start(Eigen::Vector3d::Zero(), Time{0});
  const ShortTrajectory elsewhere = move(reference.at(Time{0}), kThere, Time{500}, 1);
  reference.splice(elsewhere.view(), pool.loan());
  reference.advance(Time{600});
  EXPECT_EQ(reference.last_start(), Time{500});
  pool.loan();
  EXPECT_EQ(pool.grown(), 1u) << "the first sample is held";
  reference.start(kThere, Time{700});
  const SampleRef one = pool.loan(), two = pool.loan();
  EXPECT_EQ(pool.grown(), 1u) << "and given back";
}

TEST(Reference, SlowsDownOnTheWayThatItIsOnAndStaysThere) {
  Reference reference;
  reference.start(Eigen::Vector3d::Zero(), Time{0});
  const Time now = Time{} + seconds(0.5), later = now + seconds(0.02);
  reference.splice(move(reference.at(Time{0}), kThere, Time{0}, 1));
  reference.splice(short_hold_at(reference.at(later).q, later, 7));
  const JointState moving = reference.at(now);
  const std::uint64_t serial = reference.serial();
  const MotionLimits limits{JointVector::Constant(3, 2), JointVector::Constant(3, 6)};
  ASSERT_TRUE(reference.slow_down(now, limits));
  EXPECT_NE(reference.serial(), serial) << "a plan from before would jump";
  EXPECT_EQ(reference.at(now).q, moving.q);
  EXPECT_EQ(reference.at(now).v, moving.v);
  const Time end = reference.end();
  EXPECT_LT(end, Time{} + seconds(1.2));
  ASSERT_TRUE(reference.slow_down(now + seconds(0.1), limits));
  EXPECT_EQ(reference.end(), end) << "a second stop changes nothing";
  const JointState rest = reference.at(end);
  EXPECT_TRUE(at_rest(rest));
  EXPECT_NEAR((rest.q.normalized() - kThere.normalized()).norm(), 0, 1e-12) << "on the line";
  reference.advance(end + seconds(1));
  EXPECT_EQ(reference.at(end + seconds(1)).q, rest.q);
  reference.splice(short_hold_at(rest.q, end + seconds(2), 8));
  EXPECT_EQ(reference.end(), end + seconds(2)) << "what takes over is not slowed";
}

TEST(Reference, CountsWhatTakesOverSoThatAPlanCanSayWhatItContinues) {
  Reference reference;
  reference.start(kThere, Time{0});
  const std::uint64_t first = reference.serial();
  reference.start(kThere, Time{500});
  EXPECT_EQ(reference.serial(), first) << "it stays where it was";
  reference.start(-kThere, Time{500});
  EXPECT_GT(reference.serial(), first);
}

TEST(Reference, CountsATrajectoryThatTakesOverLaterAsAnotherOne) {
  Reference reference;
  reference.start(Eigen::Vector3d::Zero(), Time{0});
  reference.splice(move(reference.at(Time{500}), kThere, Time{500}, 1));
  const std::uint64_t before = reference.serial();
  reference.postpone_last(Time{600});
  EXPECT_GT(reference.serial(), before) << "a plan made for the old times would jump";
}

}  // namespace
}  // namespace armature
