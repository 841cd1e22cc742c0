// SPDX-License-Identifier: Apache-2.0
// Somebody sets the system clock while a deployment of two processes moves an arm: its ages, leases
// and commands go by the monotonic clock, so that nothing but a note comes of it.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

class SteppedClock : public testing::Test {
 protected:
  SteppedClock() { set(0); }

  /// How far the system clock is ahead from now on.
  void set(int ahead_s) const {
    std::ofstream{file_ + ".new"} << ahead_s;
    std::filesystem::rename(file_ + ".new", file_);
  }

  Command::Options options() const {
    return {.environment = {{"LD_PRELOAD", STEPPED_CLOCK}, {"STEPPED_CLOCK", file_}}, .input = {}};
  }
  std::vector<std::string> lamp(const std::string& domain) const {
    return {armature(),
            "run",
            source_file("configs/dental_lamp.yaml"),
            "--json",
            "--domain",
            domain,
            "--set",
            "components.arm.process=aside",
            "--set",
            "run.time_limit_s=150"};
  }

  const int domain_ = unique_dds_domain();
  const TemporaryFolder folder_;
  const std::string file_ = folder_ / "ahead_s";
};

std::string note(const std::string& step) {
  return "the system clock stepped by " + step +
         " s; the deployment's clock goes on as before, and " + "so do ages and leases\n";
}

/// By a second, then by an hour, in the same direction; and it stays there to the end of the run,
/// whose transport has to be left then, too.
class SteppedClockRun : public SteppedClock, public testing::WithParamInterface<int> {};

TEST_P(SteppedClockRun, ChangesNothingInARunOfTwoProcessesButANote) {
  Command run{lamp(std::to_string(domain_)), options()};
  ASSERT_TRUE(run.wait_for_err("searching 1/9", seconds{60})) << run.err();
  int ahead_s = 0;
  for (const int step_s : {GetParam(), 3600 * GetParam()}) {
    set(ahead_s += step_s);
    const std::string text = (step_s > 0 ? "+" : "") + std::to_string(step_s);
    ASSERT_TRUE(run.wait_for_err(note(text), seconds{20})) << run.err();
    std::this_thread::sleep_for(milliseconds{1500});  // longer than a lease and a command's life
  }
  const CommandResult result = run.finish(seconds{150});
  EXPECT_THAT(result.out, HasSubstr(R"({"status":"ok")")) << result.err;
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, Not(HasSubstr("fell silent")));
  EXPECT_THAT(result.err, Not(HasSubstr(" motion    "))) << "nothing is wrong with the arm";
}

INSTANTIATE_TEST_SUITE_P(ForwardsAndBackwards, SteppedClockRun, testing::Values(1, -1),
                         [](const auto& step) { return step.param > 0 ? "Ahead" : "Back"; });

}  // namespace
}  // namespace armature::test
