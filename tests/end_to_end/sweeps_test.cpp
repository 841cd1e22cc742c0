// SPDX-License-Identifier: Apache-2.0
// What the files promise of many runs, and the tables of the papers that take long.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "tests/command.hpp"

namespace armature::test {
namespace {

CommandResult sweep(const std::string& deployment, const std::string& seeds) {
  return run_command(
      {armature(), "sweep", source_file("configs/" + deployment + ".yaml"), "--seeds", seeds}, {},
      std::chrono::minutes{20});
}

TEST(Sweeps, OfABiopsyHoldTheBoundOf95PercentAndThePredictedError) {
  const auto result = sweep("sr1_biopsy", "1..1000");
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

TEST(Sweeps, OfAnImplantComeWithinFourTenthsOfAMillimetreAndEverySourceErrsAsExpected) {
  const auto result = sweep("dental_implant", "1..400");
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

TEST(Sweeps, OfFiftyHandsFollowThemAndTakeTheirTremorOut) {
  const auto result = sweep("master_manipulator", "1..50");
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

TEST(Sweeps, OfTheLampComeToTheMouth) {
  const auto result = sweep("dental_lamp", "1..10");
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

class LongTables : public testing::TestWithParam<const char*> {};

TEST_P(LongTables, HoldToo) {
  const auto result =
      run_command({armature(), "reproduce", GetParam()}, {}, std::chrono::minutes{5});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

INSTANTIATE_TEST_SUITE_P(Papers, LongTables, testing::Values("lamp", "sr1", "implant", "master"),
                         [](const auto& of) { return std::string{of.param}; });

}  // namespace
}  // namespace armature::test
