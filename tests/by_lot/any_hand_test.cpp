// SPDX-License-Identifier: Apache-2.0
// A hand at the leader that does anything, of which anything may be told, threads that are held up,
// and the follower by where it truly is: 1. it keeps its limits, and its tip its speed, 2. it rests
// while the clutch is open and while it is stopped, until the clutch is closed anew behind a
// rearm, 3. closing the clutch on a hand at rest moves nothing, and it follows a hand again that
// behaves well, 4. no number that is none is told, and no component fails. ARMATURE_HANDS: so many
// of every system, from number ARMATURE_FIRST_HAND on; `tools/test --full` has others every day.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "arm_limits.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"
#include "held_up_threads.hpp"
#include "tests/dds_domain.hpp"
#include "tests/environment_number.hpp"

namespace armature::test {
namespace {

struct HandRun {
  struct Step {
    double time_s = 0;
    JointVector q;
  };
  DeploymentRun run;
  std::vector<Step> steps;
  std::vector<std::pair<double, std::string>> rests;  // from then on; empty: it may move
  std::vector<double> closed_m, followed_m;
  bool tells_none = false;
  double behaves_from_s = INFINITY;  // at the end of the run
  std::string story;
};

HandRun read_hand_run(const std::string& text, const RobotModel& robot) {
  HandRun run;
  bool open = true, stopped = false, closes_anew = false;
  bool at_limit = false;  // where the hand has led it before: from there it need not follow
  std::istringstream lines{text};
  for (std::string one; std::getline(lines, one);) {
    std::istringstream line{one};
    std::string kind;
    double time_s = 0, value = 0;
    line >> kind >> time_s;
    if (kind == "arm") {
      std::vector<double> values;
      while (line >> value) values.push_back(value);
      const auto q = robot.to_independent(std::span<const double>{values});
      if (q) run.steps.push_back({time_s, *q});
      run.tells_none = run.tells_none || !q;
      continue;
    }
    run.story += one + "\n";
    line >> value;
    if (kind == "wild" || kind == "calm") run.behaves_from_s = kind == "calm" ? time_s : INFINITY;
    if (kind == "none") run.tells_none = true;
    if (kind == "closed") run.closed_m.push_back(value);
    if (kind == "task" && one.find("cannot follow: ik: ") != one.npos) at_limit = true;
    if (kind == "followed") run.followed_m.push_back(at_limit ? 0 : value);
    if (kind == "stop") stopped = closes_anew = true;
    if (kind == "rearmed") stopped = false;
    if (kind == "clutch") open = value == 0;
    if (kind == "clutch") at_limit = false;
    if (kind == "clutch" && !open && !stopped) closes_anew = false;
    const std::string why = stopped       ? "stopped"
                            : open        ? "the clutch is open"
                            : closes_anew ? "rearmed"
                                          : "";
    if (run.rests.empty() || run.rests.back().second.empty() != why.empty()) {
      run.rests.emplace_back(time_s, why);
    }
  }
  return run;
}

struct HandSystem {
  std::string name;
  std::vector<std::string> settings;
};

std::ostream& operator<<(std::ostream& out, const HandSystem& system) { return out << system.name; }

class AnyHand : public testing::TestWithParam<HandSystem> {
 protected:
  HandRun run_with(int seed) const {
    static const int kDomain = unique_dds_domain();  // one run at a time
    const TemporaryFolder folder;
    const std::string file = folder / "chronicle", params = "components.hand.params.";
    const char* scales[] = {"0.5", "0.01", "10", "1"};
    const std::string scale = std::string{"params.scale="} + scales[seed % 4];
    DeploymentStart start{.files = {source_file("configs/master_manipulator.yaml"),
                                    source_file("tests/by_lot/any_hand.yaml")},
                          .settings = GetParam().settings,
                          .domain = kDomain};
    start.settings.insert(start.settings.end(),
                          {params + "file=" + file, params + "seed=" + std::to_string(seed),
                           "components.task." + scale, "components.hand." + scale});
    const double pause_s = seed % 2 == 0 ? 0.005 * (seed % 7) : 0;
    const auto settings = held_up_threads(seed, pause_s, pause_s);
    start.settings.insert(start.settings.end(), settings.begin(), settings.end());
    start.options.environment["ARMATURE_PLUGIN_PATH"] = TEST_PLUGINS;
    const DeploymentRun run = run_deployment(start);
    if (!std::filesystem::exists(file)) throw std::runtime_error{run.text()};
    HandRun hand = read_hand_run(content_of(file), robot_);
    hand.run = run;
    return hand;
  }

  void expect_limits(const HandRun& run) const;
  static void expect_rest(const HandRun& run);

  const RobotModel robot_ = load_robot_model(source_file("configs/robots/med7_scope.yaml"));
};

// 1.

void AnyHand::expect_limits(const HandRun& run) const {
  constexpr double kTipSpeed_m_s = 0.05;
  expect_arm_limits(robot_, run.steps);
  const auto tip = [&](const HandRun::Step& step) {
    return forward_kinematics(robot_, step.q).translation();
  };
  for (std::size_t i = 1; i < run.steps.size(); ++i) {
    const auto &step = run.steps[i], &before = run.steps[i - 1];
    if (step.q == before.q) continue;
    ASSERT_LE((tip(step) - tip(before)).norm() / (step.time_s - before.time_s), kTipSpeed_m_s)
        << step.time_s << " s";
  }
}

// 2.

void AnyHand::expect_rest(const HandRun& run) {
  constexpr double kStopsWithin_s = 0.4;
  auto rest = run.rests.begin();
  const HandRun::Step* rested = nullptr;
  for (const auto& step : run.steps) {
    for (; rest != run.rests.end() && rest->first < step.time_s; ++rest) rested = nullptr;
    if (rest == run.rests.begin()) continue;
    const auto& [from_s, why] = *std::prev(rest);
    if (why.empty() || step.time_s < from_s + kStopsWithin_s) continue;
    if (!rested) rested = &step;
    ASSERT_LE((step.q - rested->q).cwiseAbs().maxCoeff(), 1e-6)
        << step.time_s << " s: " << why << " since " << from_s << " s";
  }
}

TEST_P(AnyHand, LetsNoFollowerMoveOtherwiseThanItMay) {
  const int first = environment_number("ARMATURE_FIRST_HAND", 1),
            count = environment_number("ARMATURE_HANDS", 2);
  for (int seed = first; seed < first + count; ++seed) {
    const HandRun run = run_with(seed);
    SCOPED_TRACE(fmt::format("again: ARMATURE_FIRST_HAND={} ARMATURE_HANDS=1\n{}{}", seed,
                             run.story, run.run.text()));
    expect_limits(run);
    expect_rest(run);
    EXPECT_GE(run.followed_m.size(), 2U);
    for (const double moved_m : run.closed_m) EXPECT_LE(moved_m, 1e-6);
    for (const double missed_m : run.followed_m) EXPECT_LE(missed_m, 2e-4);
    EXPECT_FALSE(run.tells_none);
    const bool behaves = run.steps.back().time_s > run.behaves_from_s + 1;
    EXPECT_TRUE(run.run.status() == "ok" || (!behaves && run.run.status() == "degraded"))
        << run.run.report;
    if (GetParam().name == "Pivoting") {
      EXPECT_LT(run.run.figure("incision_deviation_mm"), 0.2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, AnyHand,
    testing::Values(HandSystem{.name = "Pivoting", .settings = {}},
                    HandSystem{.name = "Free",
                               .settings = {"components.motion.params.remote_centre=false",
                                            "components.surgeon.params.incision_mm=[]"}}),
    [](const auto& system) { return system.param.name; });

}  // namespace
}  // namespace armature::test
