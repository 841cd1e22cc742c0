// SPDX-License-Identifier: Apache-2.0
// Every fault at twenty moments, in one process and split: none of the four deployments ends
// moving.
#include <gmock/gmock.h>

#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

/// A deployment, and how long its scenario is at least [s]: the moments lie in it.
struct Drilled {
  const char* name;
  const char* within_s;

  friend void PrintTo(const Drilled& drilled, std::ostream* out) { *out << drilled.name; }
};

class FullDrill : public testing::TestWithParam<Drilled> {
 protected:
  static CommandResult drill(std::vector<std::string> options, std::chrono::seconds timeout) {
    std::vector<std::string> words{armature(), "drill",
                                   source_file(std::string{"configs/"} + GetParam().name + ".yaml"),
                                   "--domain", std::to_string(unique_dds_domain())};
    words.insert(words.end(), options.begin(), options.end());
    return run_command(words, {}, timeout);
  }
};

TEST_P(FullDrill, PassesAtTwentyMomentsOfEveryFault) {
  const CommandResult result =
      drill({"--moments", "20", "--within", GetParam().within_s}, std::chrono::hours{3});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, testing::HasSubstr(" passed, 0 failed\n"));
}

TEST_P(FullDrill, PassesInItsShortForm) {
  const CommandResult result = drill({"--short"}, std::chrono::minutes{3});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

INSTANTIATE_TEST_SUITE_P(AllDeployments, FullDrill,
                         testing::Values(Drilled{"dental_lamp", "4"}, Drilled{"sr1_biopsy", "6"},
                                         Drilled{"dental_implant", "20"},
                                         Drilled{"master_manipulator", "12"}),
                         [](const auto& deployment) { return deployment.param.name; });

}  // namespace
}  // namespace armature::test
