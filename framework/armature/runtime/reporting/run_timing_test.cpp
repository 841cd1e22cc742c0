// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/run_timing.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace armature {
namespace {

using testing::SizeIs;

RunTiming timing_with(double seconds) {
  const TimingFigures figures{.count = 7,
                              .last_s = seconds,
                              .mean_s = 2 * seconds,
                              .p99_s = 3 * seconds,
                              .p999_s = 4 * seconds,
                              .max_s = 5 * seconds};
  return {
      .executors = {{.name = "control", .lateness = figures, .cycle = figures}},
      .components = {{.name = "arm", .lateness = figures, .step = figures, .processor = figures}}};
}

TEST(RunTiming, OfAnotherProcessIsTheSameAfterItHasBeenTold) {
  RunTiming heard;
  for (const std::string& line : to_lines(timing_with(1.5e-7))) add_line(heard, "aside", line);
  EXPECT_EQ(to_json(heard), to_json(timing_with(1.5e-7)));
}

TEST(RunTiming, OfTwoProcessesKeepsWhatHasTheSameNameApart) {
  RunTiming timing = timing_with(1);
  for (const std::string& line : to_lines(timing_with(2))) add_line(timing, "aside", line);
  ASSERT_THAT(timing.executors, SizeIs(2));
  EXPECT_EQ(timing.executors[1].name, "control@aside");
  EXPECT_EQ(timing.executors[1].cycle.last_s, 2);
  ASSERT_THAT(timing.components, SizeIs(2));
  EXPECT_EQ(timing.components[1].name, "arm@aside");
}

TEST(RunTiming, IsNotReadFromALineThatTellsNone) {
  RunTiming timing;
  EXPECT_THROW(add_line(timing, "aside", "{\"component\":"), nlohmann::json::exception);
  EXPECT_THROW(add_line(timing, "aside", "{}"), nlohmann::json::exception);
}

}  // namespace
}  // namespace armature
