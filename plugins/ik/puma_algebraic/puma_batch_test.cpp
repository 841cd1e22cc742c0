// SPDX-License-Identifier: Apache-2.0
// Many poses at once against one by one, by all builds of the kernel; the law of the kind asks the
// one that this processor runs.
#include "puma_batch.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <limits>
#include <string>
#include <vector>

#include "puma_goal.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

struct BatchSubject {
  std::string name;
  SolveBatch solve;
  ModelPtr model;
  friend void PrintTo(const BatchSubject& subject, std::ostream* out) { *out << subject.name; }
};

class PumaBatch : public testing::TestWithParam<BatchSubject> {
 protected:
  const RobotModel& model() const { return *GetParam().model; }

  void add_goal(const JointVector& q) {
    const IkGoal goal = rotation_goal(model(), q);
    const auto& rotation = std::get<Eigen::Quaterniond>(goal.pose.orientation);
    // A quaternion of any length is a rotation.
    const std::array wxyz{3 * rotation.w(), 3 * rotation.x(), 3 * rotation.y(), 3 * rotation.z()};
    for (std::size_t k = 0; k < 3; ++k) {
      position_[k].push_back(goal.pose.position[static_cast<Eigen::Index>(k)]);
    }
    for (std::size_t k = 0; k < 4; ++k) rotation_[k].push_back(wxyz[k]);
  }
  IkBatch batch() const {
    IkBatch batch;
    batch.count = position_[0].size();
    for (std::size_t k = 0; k < 3; ++k) batch.position[k] = position_[k].data();
    for (std::size_t k = 0; k < 4; ++k) batch.rotation[k] = rotation_[k].data();
    return batch;
  }
  IkBatchAnswers solved() const {
    IkBatchAnswers answers;
    answers.resize(batch().count, 6, 8);
    solve_together(GetParam().solve, arm_, numbers_, batch(), answers);
    return answers;
  }
  /// The answer of the `i`th goal is that of `solve`.
  void expect_answer(const IkBatchAnswers& answers, std::size_t i) const {
    IkBranches alone;
    IkState state;
    solver_->solve(batch().goal(i), JointVector::Zero(6), alone, state);
    ASSERT_EQ(std::popcount(answers.found[i]), alone.count) << "goal " << i;
    const IkBranch* branch = alone.begin();
    for (int slot = 0; slot < 8; ++slot) {
      if ((answers.found[i] >> slot & 1) == 0) continue;
      JointVector q(6);
      for (int k = 0; k < 6; ++k) q[k] = answers.joint(slot, k)[i];
      EXPECT_LT(joint_distance(model(), q, branch->q), 1e-10) << branch->label << ", goal " << i;
      EXPECT_EQ((answers.within_limits[i] >> slot & 1) != 0, branch->within_limits);
      EXPECT_EQ((answers.singular[i] >> slot & 1) != 0, branch->singular);
      EXPECT_LE(branch->residual.position_m, answers.position_m[i] + 1e-14);
      ++branch;
    }
    EXPECT_LT(answers.position_m[i], 1e-13);
    EXPECT_LT(answers.angle_rad[i], 1e-13);
  }

  PumaArm arm_ = puma_arm(model()).value();
  ArmNumbers numbers_ = numbers_of(arm_, model());
  std::shared_ptr<const IkSolver> solver_ = solver_for(model());
  std::mt19937_64 random_{41};
  std::array<std::vector<double>, 3> position_;
  std::array<std::vector<double>, 4> rotation_;
};

TEST_P(PumaBatch, IsAnsweredAsItsGoalsAreOneByOne) {
  SCOPED_TRACE("seed 41");
  for (int i = 0; i < 2000; ++i) {
    add_goal(random_joints(model(), random_));
    if (i % 5 != 0) continue;
    for (auto& row : position_) row.back() *= 1.5;  // some of them out of reach, or of an elbow's
  }
  const IkBatchAnswers answers = solved();
  for (std::size_t i = 0; i < answers.goals() && !HasFailure(); ++i) expect_answer(answers, i);
}

TEST_P(PumaBatch, OfAnyLengthLeavesWhatIsBehindItAlone) {
  for (std::size_t count = 1; count <= 17; ++count) {
    add_goal(random_joints(model(), random_));
    IkBatchAnswers answers;
    answers.resize(count + 1, 6, 8);
    answers.found.back() = 12345;
    answers.position_m.back() = answers.joint(7, 5)[count] = 67;
    solve_together(GetParam().solve, arm_, numbers_, batch(), answers);
    for (std::size_t i = 0; i < count && !HasFailure(); ++i) expect_answer(answers, i);
    EXPECT_EQ(answers.found.back(), 12345);
    EXPECT_EQ(answers.position_m.back(), 67);
    EXPECT_EQ(answers.joint(7, 5)[count], 67);
  }
}

TEST_P(PumaBatch, TellsWhatNeedsRulesOfItsOwn) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 8; ++i) add_goal(random_joints(model(), random_));
  JointVector in_line = random_joints(model(), random_);
  in_line[4] = arm_.joint(4, 0);  // axes 4 and 6
  add_goal(in_line);
  position_[1][2] = kNan;
  position_[2][3] = std::numeric_limits<double>::infinity();
  rotation_[0][4] = kNan;
  for (auto& row : rotation_) row[5] = 0;
  const IkBatchAnswers answers = solved();
  for (const std::size_t i : {0U, 1U, 6U, 7U}) expect_answer(answers, i);
  for (const std::size_t i : {2U, 3U, 4U, 5U, 8U}) {
    EXPECT_EQ(answers.found[i], PoseAnswers::kSpecial) << i;
  }
}

TEST(PumaBatchOf, NothingOrWithABadSeedIsAnswered) {
  const ModelPtr model = sr1();
  const auto solver = solver_for(*model);
  const std::array<double, 2> half{0.5, 0.5}, zero{0, 0};
  IkBatch batch;
  batch.position = {half.data(), half.data(), half.data()};
  batch.rotation = {half.data(), half.data(), half.data(), half.data()};
  IkBatchAnswers answers;
  solver->solve_batch(batch, JointVector::Zero(6), answers);
  EXPECT_EQ(answers.goals(), 0U);
  const auto expect_refused = [&](const IkBatch& asked, const JointVector& seed) {
    solver->solve_batch(asked, seed, answers);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(answers.code[i], IkStatus::Code::invalid_input);
      EXPECT_EQ(answers.found[i], 0U);
    }
  };
  batch.count = 2;
  expect_refused(batch, JointVector::Zero(5));
  expect_refused(batch, JointVector::Constant(6, std::numeric_limits<double>::quiet_NaN()));
  IkBatch impatient = batch;
  impatient.tolerance.position_m = 0;
  expect_refused(impatient, JointVector::Zero(6));
  IkBatch nowhere = batch;
  nowhere.rotation = {};
  expect_refused(nowhere, JointVector::Zero(6));
  IkBatch both = batch;  // this tool does not point, and a direction goes first
  both.direction = {zero.data(), zero.data(), half.data()};
  expect_refused(both, JointVector::Zero(6));
}

std::vector<BatchSubject> subjects() {
  std::vector<BatchSubject> list;
  const BatchSolvers solvers = batch_solvers();
  for (const auto& [name, model] : {std::pair{std::string{"sr1"}, sr1()},
                                    std::pair{std::string{"industrial_arm"}, industrial_arm()}}) {
    for (int i = 0; i < solvers.count; ++i) {
      const auto build = static_cast<std::size_t>(i);
      list.push_back(
          {name + std::array{"_portable", "_avx2", "_avx512"}[build], solvers.solve[build], model});
    }
  }
  return list;
}
INSTANTIATE_TEST_SUITE_P(Puma, PumaBatch, testing::ValuesIn(subjects()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace armature
