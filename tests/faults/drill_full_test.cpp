// SPDX-License-Identifier: Apache-2.0
// Every fault at twenty moments, in one process and split: none of the four deployments ends
// moving.
#include <gmock/gmock.h>

#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

class FullDrill : public testing::TestWithParam<const char*> {};

TEST_P(FullDrill, PassesAtTwentyMomentsOfEveryFault) {
  const CommandResult result =
      run_command({armature(), "drill", source_file(std::string{"configs/"} + GetParam()),
                   "--moments", "20", "--domain", std::to_string(unique_dds_domain())},
                  {}, std::chrono::hours{3});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr(" passed, 0 failed\n"));
}

TEST_P(FullDrill, PassesInItsShortForm) {
  const CommandResult result =
      run_command({armature(), "drill", source_file(std::string{"configs/"} + GetParam()),
                   "--short", "--domain", std::to_string(unique_dds_domain())},
                  {}, std::chrono::minutes{3});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

INSTANTIATE_TEST_SUITE_P(AllDeployments, FullDrill,
                         testing::Values("dental_lamp.yaml", "sr1_biopsy.yaml",
                                         "dental_implant.yaml", "master_manipulator.yaml"),
                         [](const auto& deployment) {
                           const std::string file = deployment.param;
                           return file.substr(0, file.find('.'));
                         });

}  // namespace
}  // namespace armature::test
