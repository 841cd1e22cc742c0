// SPDX-License-Identifier: Apache-2.0
// What the bench believes is what it has checked itself.
#include "bench/ik/measure.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::bench {
namespace {

/// A slide along z and a turn about it, pointing along its x.
RobotModel slide_and_turn() {
  Joint slide, turn;
  slide.name = "slide";
  slide.type = Joint::Type::prismatic;
  slide.lower = 0, slide.upper = 0.4;
  turn.name = "turn";
  turn.lower = -1, turn.upper = 2;
  return {{"slide_and_turn",
           RobotModel::Convention::standard,
           {slide, turn},
           {{"tool", 1, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           Eigen::Vector3d::UnitX(),
           {}}};
}

/// The closed form, off by `off_m`, and saying what it likes of limits.
class Solver : public IkSolver {
 public:
  explicit Solver(double off_m = 0, double off_rad = 0) : off_m_{off_m}, off_rad_{off_rad} {}
  IkStatus solve(const IkGoal& goal, const JointVector&, IkBranches& out, IkState&) const override {
    ++calls;
    out.clear();
    const auto& direction = std::get<Direction>(goal.pose.orientation).unit;
    IkBranch& branch = out.add();
    branch.q.resize(2);
    branch.q << goal.pose.position.z() + off_m_,
        std::atan2(direction.y(), direction.x()) + off_rad_;
    branch.within_limits = true;
    return {};
  }
  mutable std::atomic<int> calls = 0;

 private:
  double off_m_, off_rad_;
};

class Measure : public testing::Test {
 protected:
  std::vector<Series> race(std::shared_ptr<const IkSolver> solver) const {
    return measure(model, {{"ik/it", std::move(solver)}}, list, {.repetitions = 2});
  }
  static double part_reached(const Series& series) {
    double reached = 0;
    for (const Solve& solve : series.solves) reached += solve.reached ? 1 : 0;
    return reached / static_cast<double>(series.solves.size());
  }

  const RobotModel model = slide_and_turn();
  const std::vector<Pose> list = poses(model, 120, 1, 1e-6);
};

TEST_F(Measure, PosesAreWithinLimitsAndNearSeedsWithinFiveDegrees) {
  bool far = false;
  for (const Pose& pose : list) {
    for (const JointVector& q : {pose.q, pose.random, pose.near}) {
      EXPECT_TRUE(model.within_limits(q, 0));
    }
    EXPECT_LE(std::abs(pose.near[1] - pose.q[1]), 5 * M_PI / 180 + 1e-12);
    EXPECT_LE(std::abs(pose.near[0] - pose.q[0]), 0.01 + 1e-12);
    far = far || std::abs(pose.random[1] - pose.q[1]) > 1;
  }
  EXPECT_TRUE(far);
}

TEST_F(Measure, PosesAreTheSameForTheSameSeed) {
  const auto again = poses(model, 120, 1, 1e-6), other = poses(model, 120, 2, 1e-6);
  EXPECT_EQ(list[119].near, again[119].near);
  EXPECT_NE(list[119].near, other[119].near);
  // The same on every machine: the generator and its use are fixed.
  EXPECT_NEAR(list[0].q[0], 0.4 * 0.13387664401253274, 1e-15);
}

TEST_F(Measure, EverySolveIsAskedOnceToCheckAndThenWithTheClock) {
  const auto solver = std::make_shared<const Solver>();
  const auto series = race(solver);
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[0].seeds, Seeds::random);
  EXPECT_EQ(series[1].seeds, Seeds::near);
  EXPECT_EQ(solver->calls, 2 * 120 * 3);
  for (const Series& one : series) {
    EXPECT_EQ(part_reached(one), 1);
    for (const Solve& solve : one.solves) EXPECT_TRUE(std::isfinite(solve.seconds));
  }
}

TEST_F(Measure, ASolverThatMissesIsNotBelieved) {
  const auto series = race(std::make_shared<const Solver>(1e-5));
  EXPECT_EQ(part_reached(series[0]), 0);
  for (const Solve& solve : series[0].solves) {
    if (std::isinf(solve.position_m)) continue;  // pushed out of the limits
    EXPECT_TRUE(solve.wrong);
    EXPECT_NEAR(solve.position_m, 1e-5, 1e-12);
  }
}

TEST_F(Measure, ASolutionBeyondTheLimitsIsNotReachedWhateverTheSolverSays) {
  auto joints = model.joints();
  joints[1].upper = 0;
  const RobotModel narrow{{"narrow",
                           model.convention(),
                           joints,
                           model.frames(),
                           model.tool(),
                           model.pointing_axis(),
                           {}}};
  const auto series =
      measure(narrow, {{"ik/it", std::make_shared<const Solver>()}}, list, {.repetitions = 1});
  const double part = part_reached(series[0]);
  EXPECT_GT(part, 0.1);
  EXPECT_LT(part, 0.6);
  for (const Solve& solve : series[0].solves) EXPECT_NE(solve.reached, solve.wrong);
}

TEST_F(Measure, ASolverThatAnswersNotANumberIsNotReachedAndWrong) {
  const auto series = race(std::make_shared<const Solver>(std::nan("")));
  EXPECT_EQ(part_reached(series[0]), 0);
  EXPECT_TRUE(series[0].solves[0].wrong);
}

}  // namespace
}  // namespace armature::bench
