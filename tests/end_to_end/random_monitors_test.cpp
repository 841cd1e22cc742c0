// SPDX-License-Identifier: Apache-2.0
// Monitors that come, go and die at random change no byte of what an arm does in lockstep, cost
// the deployment no sample that it reads itself on the system clock, and leave nothing behind in
// it. For so many seconds: ARMATURE_MONITORS_S, 8 without.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::chrono::seconds kAtMost{60};

std::chrono::seconds length() {
  const char* told = std::getenv("ARMATURE_MONITORS_S");
  return std::chrono::seconds{told ? std::atoi(told) : 8};
}

/// At most four at a time, each for as long as chance will have it.
class RandomMonitors {
 public:
  explicit RandomMonitors(int domain) : domain_{domain} { std::printf("seed %u\n", seed_); }

  /// One comes, and another one is stopped or killed.
  void change() {
    if (running_.size() < kMost) running_.push_back(std::make_unique<Command>(next()));
    if (running_.size() == kMost || random_() % 2 == 0) {
      const std::size_t which = random_() % running_.size();
      running_[which]->signal(random_() % 2 == 0 ? SIGINT : SIGKILL);
      running_[which]->finish(kAtMost);
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(which));
    }
    ++changes_;
    std::this_thread::sleep_for(milliseconds{random_() % 400});
  }
  void end() { running_.clear(); }
  int changes() const { return changes_; }

 private:
  std::vector<std::string> next() {
    const std::array<std::vector<std::string>, 5> kinds{
        {{"record", "--force", "-o", folder_ / std::to_string(random_() % kMost)},
         {"topic", "hz", "/dental_lamp/arm/measured_js"},
         {"topic", "echo", "/dental_lamp/left/image_raw"},
         {"monitor", "--port", "0"},
         {"top", "--json"}}};
    std::vector<std::string> words = kinds[random_() % kinds.size()];
    words.insert(words.begin(), armature());
    words.insert(words.end(), {"--domain", std::to_string(domain_)});
    return words;
  }

  static constexpr std::size_t kMost = 4;
  const int domain_;
  const TemporaryFolder folder_;
  const unsigned seed_ = std::random_device{}();
  std::mt19937 random_{seed_};
  std::vector<std::unique_ptr<Command>> running_;
  int changes_ = 0;
};

class RandomMonitorsTest : public testing::Test {
 protected:
  std::vector<std::string> lamp(std::vector<std::string> more) const {
    more.insert(more.begin(), {armature(), "run", source_file("configs/dental_lamp.yaml"),
                               "--domain", std::to_string(domain_)});
    return more;
  }

  const int domain_ = unique_dds_domain();
  RandomMonitors monitors_{domain_};
};

TEST_F(RandomMonitorsTest, ChangeNoByteOfATrajectoryInLockstep) {
  const auto trajectory = [](const std::string& out) -> std::string {
    return json::parse(out)["trajectory_sha256"];
  };
  const std::vector<std::string> words = lamp({"--set", "clock=simulated", "--json"});
  const std::string alone = trajectory(run_command(words, {}, kAtMost).out);
  const auto end = Steady::now() + length();
  do {
    Command run{words};
    while (run.out().empty()) monitors_.change();
    EXPECT_EQ(trajectory(run.finish(kAtMost).out), alone);
  } while (Steady::now() < end);
  EXPECT_GT(monitors_.changes(), 5);
}

/// Open files and sockets.
std::ptrdiff_t descriptors_of(pid_t pid) {
  const fs::directory_iterator all{"/proc/" + std::to_string(pid) + "/fd"};
  return std::distance(begin(all), end(all));
}

TEST_F(RandomMonitorsTest, LoseNothingAndLeaveNothingBehindOnTheSystemClock) {
  Command run{lamp({"--keep-running"})};
  ASSERT_TRUE(run.wait_for_err("the scenario is over", kAtMost));
  const auto before = descriptors_of(run.pid());
  const auto end = Steady::now() + length();
  while (Steady::now() < end) monitors_.change();
  monitors_.end();
  const auto settled = Steady::now() + std::chrono::seconds{30};
  while (descriptors_of(run.pid()) > before && Steady::now() < settled) {
    std::this_thread::sleep_for(milliseconds{200});
  }
  EXPECT_LE(descriptors_of(run.pid()), before);
  const CommandResult top = run_command(
      {armature(), "top", "--json", "-n", "5", "--domain", std::to_string(domain_)}, {}, kAtMost);
  const std::string last = top.out.substr(top.out.rfind('\n', top.out.size() - 2) + 1);
  const json deployments = json::parse(last);
  ASSERT_EQ(deployments.size(), 1U) << top.out << top.err;
  int components = 0;
  for (const json& component : deployments[0]["components"]) {
    // On a busy machine watchers at 1 kHz miss samples, which count as their writer's. What the
    // deployment itself reads is never lost, however many come at once.
    const bool writes_at_1_khz =
        component["component"] == "motion" || component["component"] == "arm";
    if (!writes_at_1_khz) {
      EXPECT_EQ(component["dropped"], 0) << component["component"];
    }
    EXPECT_EQ(component["state"], "ok") << component;
    ++components;
  }
  EXPECT_GT(components, 10);
  run.signal(SIGINT);
  EXPECT_EQ(run.finish(kAtMost).exit_code, 0);
}

}  // namespace
}  // namespace armature::test
