// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/batch.hpp"
#include "armature/kinds/ik/contract.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

IkLawCase arm(std::string name, ModelPtr (*model)()) {
  return {std::move(name), [model] {
            const ModelPtr made = model();
            return IkSubject{.model = made,
                             .solver = solver_for(*made),
                             .closed_form = true,
                             .poses = 5000,
                             .edge_poses = 200};
          }};
}

// The arms that ship, with the parameters that it ships with, are asked by tests/contracts.
INSTANTIATE_TEST_SUITE_P(Puma, IkLaws,
                         testing::Values(arm("sr1_pointing", &sr1_pointing),
                                         arm("standard_puma560", &standard_puma560),
                                         arm("industrial_arm", &industrial_arm)),
                         testing::PrintToStringParamName());

TEST_F(PumaTest, ABatchOfNothingOrWithABadSeedIsAnswered) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::array<double, 2> half{0.5, 0.5}, zero{0, 0};
  IkBatch good;
  good.position = {half.data(), half.data(), half.data()};
  good.rotation = {half.data(), half.data(), half.data(), half.data()};
  IkBatchAnswers answers;
  subject_.solver->solve_batch(good, JointVector::Zero(6), answers);
  EXPECT_EQ(answers.goals(), 0U);
  good.count = 2;
  IkBatch impatient = good, nowhere = good, both = good;
  impatient.tolerance.position_m = 0;
  nowhere.rotation = {};
  both.direction = {zero.data(), zero.data(), half.data()};  // this tool does not point
  const JointVector seed = JointVector::Zero(6);
  for (const auto& [batch, from] : {std::pair{good, JointVector{JointVector::Zero(5)}},
                                    {good, JointVector{JointVector::Constant(6, kNan)}},
                                    {impatient, seed},
                                    {nowhere, seed},
                                    {both, seed}}) {
    subject_.solver->solve_batch(batch, from, answers);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(answers.code[i], IkStatus::Code::invalid_input);
      EXPECT_EQ(answers.found[i], 0U);
    }
  }
}

}  // namespace
}  // namespace armature
