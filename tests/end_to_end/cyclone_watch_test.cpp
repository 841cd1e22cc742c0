// SPDX-License-Identifier: Apache-2.0
// A program of another vendor watches the arm while the lamp runs.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <numbers>
#include <sstream>

#include "deployment_run.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr std::array<double, 6> kHome{60, -120, 0, 0, 150, 0};       // [deg]
constexpr std::array<double, 6> kLimits{170, 160, 60, 60, 170, 80};  // [deg]
constexpr std::size_t kFewSamples = 500;  // even of an arm on a busy machine

struct WatchedJoints {
  std::int64_t ns = 0;
  std::array<double, 6> q{}, v{};
};

/// "sec nanosec frame j1=position/velocity ... j6=position/velocity"
WatchedJoints parse(const std::string& line) {
  std::istringstream words{line};
  std::int64_t sec = 0, nanosec = 0;
  std::string frame, word;
  words >> sec >> nanosec >> frame;
  EXPECT_EQ(frame, "base");
  WatchedJoints joints{.ns = sec * 1'000'000'000 + nanosec};
  std::size_t count = 0;
  for (; words >> word; ++count) {
    const std::string name = "j" + std::to_string(count + 1) + "=";
    const std::size_t slash = word.find('/');
    if (count == 6 || !word.starts_with(name) || slash == std::string::npos) break;
    joints.q[count] = std::stod(word.substr(name.size(), slash - name.size()));
    joints.v[count] = std::stod(word.substr(slash + 1));
  }
  EXPECT_EQ(count, 6U) << line;
  return joints;
}

void expect_possible(const WatchedJoints& joints) {
  EXPECT_EQ(joints.q[3], -joints.q[2]) << "the parallelogram";
  EXPECT_EQ(joints.v[3], -joints.v[2]);
  for (std::size_t j = 0; j < 6; ++j) {
    EXPECT_LE(std::abs(joints.q[j]), kLimits[j] * kDegree + 1e-9) << "joint " << j + 1;
    EXPECT_LE(std::abs(joints.v[j]), 2.5 + 1e-9) << "joint " << j + 1;
  }
}

TEST(CycloneDds, WatchesTheArmWhileTheDeploymentRuns) {
  const int domain = unique_dds_domain();
  Command listener{{CYCLONE_LISTENER, std::to_string(domain), "rt/dental_lamp/arm/measured_js",
                    "1000000", "120"}};
  // A dark room: it raises the light in many small steps before it moves, so that whoever watches
  // comes in while it is still at home.
  Command lamp{deployment_command(
      {.settings = {"components.scene.params.gain=0.3", "components.task.params.light_step=0.02"},
       .domain = domain})};
  // Before it looks elsewhere it has gone to the first view.
  EXPECT_TRUE(lamp.wait_for_err("searching 2/9", std::chrono::seconds{100})) << lamp.err();
  listener.signal(SIGTERM);
  lamp.signal(SIGINT);
  const CommandResult watched = listener.finish(std::chrono::seconds{20});
  lamp.finish(std::chrono::seconds{20});

  std::vector<WatchedJoints> samples;
  std::istringstream lines{watched.out};
  for (std::string line; std::getline(lines, line) && !testing::Test::HasFailure();) {
    samples.push_back(parse(line));
    expect_possible(samples.back());
    if (samples.size() < 2) continue;
    EXPECT_GT(samples.back().ns, samples[samples.size() - 2].ns);
  }
  ASSERT_GT(samples.size(), kFewSamples) << watched.err;
  double farthest = 0;
  for (std::size_t j = 0; j < 6; ++j) {
    EXPECT_NEAR(samples.front().q[j], kHome[j] * kDegree, 1e-9) << "joint " << j + 1;
    EXPECT_EQ(samples.front().v[j], 0);
    farthest = std::max(farthest, std::abs(samples.back().q[j] - samples.front().q[j]));
  }
  EXPECT_GT(farthest, 0.1) << "the arm was not seen moving";
}

}  // namespace
}  // namespace armature::test
