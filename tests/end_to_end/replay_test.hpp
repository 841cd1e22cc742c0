// SPDX-License-Identifier: Apache-2.0
// For the tests of recordings that a run makes of itself.
#pragma once

#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {

inline constexpr std::chrono::seconds kEnough{120};

class Replay : public testing::Test {
 protected:
  /// Runs the lamp for a while and records it.
  CommandResult record(std::vector<std::string> more, double time_limit_s = 4,
                       const std::string& deployment = "configs/dental_lamp.yaml") const {
    more.insert(more.begin(),
                {armature(), "run", source_file(deployment), "--set", "record.file=" + file(),
                 "--set", "run.time_limit_s=" + std::to_string(time_limit_s), "--domain",
                 std::to_string(unique_dds_domain())});
    return run_command(more, {}, kEnough);
  }
  /// The same for a moment: for what needs no more than some samples of everything.
  CommandResult record_shortly(const std::vector<std::string>& more = {}) const {
    constexpr double kShortly_s = 1.5;
    return record(more, kShortly_s);
  }
  /// Another deployment, on the simulated clock: it has no pictures, and is done at once.
  CommandResult record_needle() const { return record({}, 2, "configs/sr1_biopsy.yaml"); }
  std::string file(const std::string& name = "run.mcap") const { return folder_ / name; }
  static nlohmann::json check(std::vector<std::string> arguments, int exit_code) {
    arguments.insert(arguments.begin(), {armature(), "replay", "--check", "--json"});
    const CommandResult result = run_command(arguments, {}, kEnough);
    EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
    return nlohmann::json::parse(result.out);
  }

  const TemporaryFolder folder_;
};

}  // namespace armature::test
