// SPDX-License-Identifier: Apache-2.0
// Joints that are called within limits are within them, for a range on the far side of half a turn.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "armature/config/yaml_parser.hpp"
#include "armature/kinds/ik/lines/answering.hpp"
#include "armature/kinds/ik/lines/asking.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;

/// Shoulder: 47 to 313 degrees. Wrist: two turns.
const RobotModel& far_side_arm() {
  static const RobotModel model = read_robot_model(config::parse_document(
      "armature_robot: 1\n"
      "name: far_side\n"
      "convention: standard\n"
      "joints:\n"
      "  - {name: shoulder, a_m: 0.3, limits_deg: [47, 313], velocity_rad_s: 1, "
      "acceleration_rad_s2: 4}\n"
      "  - {name: wrist, a_m: 0.2, limits_deg: [-360, 360], velocity_rad_s: 1, "
      "acceleration_rad_s2: 4}\n"
      "frames: {tool: {parent: wrist}}\n",
      "arm.yaml"));
  return model;
}

/// Answers the posture that it was made with.
class OnePosture final : public IkSolver {
 public:
  explicit OnePosture(JointVector q) : q_{std::move(q)} {}
  IkStatus solve(const IkGoal& goal, const JointVector&, IkBranches& out, IkState&) const override {
    out.clear();
    out.add() = branch_at(far_side_arm(), goal, q_, "only");
    return {};
  }

 private:
  JointVector q_;
};

JointVector posture(double shoulder, double wrist) { return Eigen::Vector2d{shoulder, wrist}; }

IkQuestion question_for(const JointVector& q, const JointVector& seed) {
  const Eigen::Isometry3d pose = forward_kinematics(far_side_arm(), q);
  IkQuestion question;
  question.goal.pose = {pose.translation(), Eigen::Quaterniond{pose.linear()}};
  question.seed = seed;
  return question;
}

nlohmann::json solution_for(const JointVector& q, const JointVector& seed) {
  return nlohmann::json::parse(
      answer_ik(far_side_arm(), OnePosture{q}, seed,
                question_line(far_side_arm(), question_for(q, seed))))["solutions"][0];
}

TEST(IkLinesWholeTurns, JointsThatAreCalledWithinLimitsAreWithinThem) {
  for (const double shoulder : {0.9, 3.0, 3.3, 4.0, 5.4}) {
    const auto solution = solution_for(posture(shoulder, 0.5), posture(3, 0));
    EXPECT_TRUE(solution["within_limits"].get<bool>());
    EXPECT_NEAR(solution["joints"][0].get<double>(), shoulder, 1e-14);
    EXPECT_LT(solution["residual_m"].get<double>(), 1e-14);
    EXPECT_LT(solution["residual_rad"].get<double>(), 1e-14);
  }
}

TEST(IkLinesWholeTurns, JointsStandAtTheTurnThatIsNearestToTheSeed) {
  const auto wrist_from = [](double seed) {
    return solution_for(posture(4, 0.5), posture(3, seed))["joints"][1].get<double>();
  };
  EXPECT_NEAR(wrist_from(0), 0.5, 1e-14);
  EXPECT_NEAR(wrist_from(-6), 0.5 - kFullTurn, 1e-14);
  EXPECT_NEAR(wrist_from(6), 0.5, 1e-14) << "a turn on is beyond the limit";
}

TEST(IkLinesWholeTurns, JointsOutsideOfTheLimitsStayAsTheSolverSaysThem) {
  const auto solution = solution_for(posture(0.2, 0.5), posture(3, -6));
  EXPECT_FALSE(solution["within_limits"].get<bool>());
  EXPECT_EQ(solution["joints"], (nlohmann::json{0.2, 0.5}));
}

TEST(IkLinesWholeTurns, WhoReadsTheAnswerFindsThePostureAgain) {
  const JointVector seed = posture(3, -6), q = posture(4, 0.5);
  const IkQuestion question = question_for(q, seed);
  const auto answer = read_answer(
      far_side_arm(), question,
      answer_ik(far_side_arm(), OnePosture{q}, seed, question_line(far_side_arm(), question)));
  ASSERT_TRUE(answer) << answer.error().text;
  ASSERT_EQ(answer->solutions.size(), 1U);
  const IkBranch again = branch_at(far_side_arm(), question.goal, answer->solutions[0].q, "again");
  EXPECT_TRUE(again.within_limits);
  EXPECT_NEAR(again.q[0], 4 - kFullTurn, 1e-14);
  EXPECT_NEAR(again.q[1], 0.5, 1e-14);
  EXPECT_LT(again.residual.position_m, 1e-14);
}

TEST(IkLinesWholeTurns, AreFreeBehindALockedSlide) {
  RobotParts parts = far_side_arm().parts();
  Joint lift;
  lift.name = "lift";
  lift.type = Joint::Type::prismatic;
  lift.locked = true;
  parts.joints.insert(parts.joints.begin(), lift);
  for (NamedFrame& frame : parts.frames) ++frame.parent_joint;
  parts.home = Eigen::Vector3d{0.2, 3, 0};
  const RobotModel lifted{parts};
  ASSERT_EQ(lifted.dof(), 2);
  EXPECT_TRUE(turns_freely(lifted, 0));
  JointVector q = posture(-1.2, 0);
  EXPECT_TRUE(unwind(lifted, posture(5, 0), q));
  EXPECT_NEAR(q[0], kFullTurn - 1.2, 1e-12);
}

}  // namespace
}  // namespace armature
