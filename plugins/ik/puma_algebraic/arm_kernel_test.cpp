// SPDX-License-Identifier: Apache-2.0
// All builds of the kernel; the laws of the kind ask the one that this processor runs.
#include "arm_kernel.hpp"

#include <array>
#include <bit>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "armature/kinds/ik/batch.hpp"
#include "puma_algebraic.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

const ArmKernels kKernels = arm_kernels();

class EveryKernel : public PumaTest, public testing::WithParamInterface<int> {
 protected:
  const ArmKernel& kernel() const { return kKernels.kernel[GetParam()]; }

  void add_goal(const JointVector& q, double factor = 1) {
    const IkGoal goal = rotation_goal(q);
    const auto& r = std::get<Eigen::Quaterniond>(goal.pose.orientation);
    const Eigen::Vector3d at = factor * goal.pose.position;
    const std::array numbers{at.x(),    at.y(),    at.z(),   3 * r.w(),
                             3 * r.x(), 3 * r.y(), 3 * r.z()};  // of any length
    for (std::size_t k = 0; k < 7; ++k) numbers_[k].push_back(numbers[k]);
  }
  IkBatch batch() const {
    IkBatch batch;
    batch.count = numbers_[0].size();
    for (std::size_t k = 0; k < 3; ++k) batch.position[k] = numbers_[k].data();
    for (std::size_t k = 0; k < 4; ++k) batch.rotation[k] = numbers_[3 + k].data();
    return batch;
  }
  /// The answer to the `i`th goal of a batch is that of `solve`.
  void expect_answer(const IkBatchAnswers& answers, std::size_t i) {
    solve(batch().goal(i), JointVector::Zero(6));
    ASSERT_EQ(std::popcount(answers.found[i]), found_.count) << "goal " << i;
    const IkBranch* branch = found_.begin();
    for (int slot = 0; slot < 8; ++slot) {
      if ((answers.found[i] >> slot & 1) == 0) continue;
      JointVector q(6);
      for (int k = 0; k < 6; ++k) q[k] = answers.joint(slot, k)[i];
      EXPECT_LT(probe_->distance(q, branch->q), 1e-10) << branch->label << ", goal " << i;
      EXPECT_EQ((answers.within_limits[i] >> slot & 1) != 0, branch->within_limits);
      EXPECT_EQ((answers.singular[i] >> slot & 1) != 0, branch->singular);
      EXPECT_LE(branch->residual.position_m, answers.position_m[i] + 1e-14);
      ++branch;
    }
    EXPECT_LT(answers.position_m[i], 1e-13);
    EXPECT_LT(answers.angle_rad[i], 1e-13);
  }

  std::array<std::vector<double>, 7> numbers_;  // x, y, z and w, x, y, z
};

TEST_P(EveryKernel, SolvesAPoseAsTheFastestDoes) {
  for (int i = 0; i < 10000; ++i) {
    IkGoal goal = rotation_goal(random_joints());
    if (i % 4 == 0) goal.pose.position *= 2;
    const ArmQuestion question = puma_goal(arm_, goal, random_joints()).at_zero;
    FourArms a, b;
    kKernels.kernel[kKernels.count - 1].solve(arm_, question, a);
    kernel().solve(arm_, question, b);
    for (int k = 0; k < 4; ++k) {
      ASSERT_EQ(a.reached[k], b.reached[k]);
      for (int j = 0; j < 12 && a.reached[k]; ++j) {
        const auto of = [&](const FourArms& arms) { return arms.joint[j / 6][j % 6][k]; };
        EXPECT_NEAR(wrap_angle(of(a) - of(b)), 0, 1e-9);
      }
    }
  }
}

TEST_P(EveryKernel, AnswersABatchAsItsGoalsAreOneByOneOrTellsWhatNeedsRulesOfItsOwn) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const ModelPtr& model : {sr1(), industrial_arm()}) {
    use(model);
    for (auto& row : numbers_) row.clear();
    // Some of them out of reach, or of an elbow's.
    for (int i = 0; i < 2000; ++i) add_goal(random_joints(), i % 5 == 0 ? 1.5 : 1);
    JointVector in_line = random_joints();
    in_line[4] = wrap_angle(arm_.joint(4, 0));  // axes 4 and 6
    add_goal(in_line);
    numbers_[1][2] = kNan;
    numbers_[2][3] = std::numeric_limits<double>::infinity();
    numbers_[3][4] = kNan;
    for (std::size_t k = 3; k < 7; ++k) numbers_[k][7] = 0;
    IkBatchAnswers answers;
    answers.resize(batch().count, 6, 8);
    solve_together(kernel(), arm_, batch(), answers);
    const std::set<std::size_t> special{2, 3, 4, 7, 2000};
    for (std::size_t i = 0; i < answers.goals() && !HasFailure(); ++i) {
      EXPECT_EQ(answers.found[i] == PoseAnswers::kSpecial, special.contains(i)) << i;
      if (!special.contains(i)) expect_answer(answers, i);
    }
  }
}

TEST_P(EveryKernel, LeavesWhatIsBehindABatchOfAnyLengthAlone) {
  for (std::size_t count = 1; count <= 17; ++count) {
    add_goal(random_joints());
    IkBatchAnswers answers;
    answers.resize(count + 1, 6, 8);
    answers.found.back() = 12345;
    answers.position_m.back() = answers.joint(7, 5)[count] = 67;
    solve_together(kernel(), arm_, batch(), answers);
    for (std::size_t i = 0; i < count && !HasFailure(); ++i) {
      const bool special = answers.found[i] == PoseAnswers::kSpecial;
      EXPECT_TRUE(!special || count < 8) << i << " of " << count;
      if (!special) expect_answer(answers, i);
    }
    EXPECT_EQ(answers.found.back(), 12345);
    EXPECT_EQ(answers.position_m.back(), 67);
    EXPECT_EQ(answers.joint(7, 5)[count], 67);
  }
}

std::string build_name(const testing::TestParamInfo<int>& build) {
  return std::array{"portable", "avx2", "avx512"}[static_cast<std::size_t>(build.param)];
}
INSTANTIATE_TEST_SUITE_P(Puma, EveryKernel, testing::Range(0, kKernels.count), build_name);

}  // namespace
}  // namespace armature
