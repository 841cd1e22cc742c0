// SPDX-License-Identifier: Apache-2.0
#include "puma_algebraic.hpp"

#include <gtest/gtest.h>

#include "armature/kinds/ik/contract.hpp"
#include "test_arms.hpp"

namespace armature {
namespace {

IkSubject subject(std::string name, ModelPtr model, int edge_poses) {
  return {.name = std::move(name),
          .model = model,
          .solver = solver_for(*model),
          .closed_form = true,
          .edge_poses = edge_poses};
}

// The two robot files are also tested with 1000 poses of every edge by tests/contracts.
INSTANTIATE_TEST_SUITE_P(Puma, IkLaws,
                         testing::Values(subject("sr1", sr1(), 50),
                                         subject("sr1_pointing", sr1_pointing(), 50),
                                         subject("sr1_needle", sr1_needle(), 50),
                                         subject("standard_puma560", standard_puma560(), 50),
                                         subject("industrial_arm", industrial_arm(), 50)),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace armature
