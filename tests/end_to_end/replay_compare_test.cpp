// SPDX-License-Identifier: Apache-2.0
// `armature replay --set` compares every component that the change reaches, and only those.
#include "replay_test.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Compare : public Replay {
 protected:
  CommandResult compare(const std::string& assignment, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {armature(), "replay", file(), "--set", assignment});
    return run_command(more, {}, kEnough);
  }
  /// Of the main process.
  json compared_with(const std::string& assignment, int exit_code) const {
    const CommandResult result = compare(assignment, {"--json"});
    EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
    const json all = json::parse(result.out, nullptr, false);
    return all.is_array() && !all.empty() ? all[0] : json::object();
  }
  static json component_of(const json& compared, const std::string& name) {
    for (const json& component : compared.value("components", json::array())) {
      if (component["component"] == name) return component;
    }
    return json::object();
  }
};

TEST_F(Compare, AComponentThatTakesAChangedParameterFromAnotherOneIsCompared) {
  constexpr double kUntilTheClutchIsClosed_s = 7;
  record({}, kUntilTheClutchIsClosed_s, "configs/master_manipulator.yaml");
  const json compared = compared_with("components.motion.params.min_depth_mm=95", 0);
  EXPECT_TRUE(component_of(compared, "motion").contains("topics"));
  const json task = component_of(compared, "task");
  ASSERT_TRUE(task.contains("topics")) << "it keeps the instrument as deep as 'motion' does";
  EXPECT_GT(task["topics"]["/master_manipulator/motion/goal"]["differing"], 0) << task;
  EXPECT_FALSE(component_of(compared, "leader_motion").contains("component"));
}

TEST_F(Compare, TheTimeThatAnEndMayTakeReachesEveryComponent) {
  record_needle();
  const json compared = compared_with("run.stop_within_s=5", 0);
  EXPECT_TRUE(component_of(compared, "motion").contains("topics")) << "which asks for it";
  const CommandResult refused = compare("run.stop_within_s=0.1");
  EXPECT_EQ(refused.exit_code, 3) << refused.out;
  EXPECT_THAT(refused.err, HasSubstr("stop_within_s"));
}

TEST_F(Compare, AValueThatIsOnlyWrittenOtherwiseChangesNothing) {
  record_needle();
  const CommandResult same = compare("components.head.params.marker_error_mm=5.0e-1");
  EXPECT_EQ(same.exit_code, 3);
  EXPECT_THAT(same.err, HasSubstr("change no component of the recording"));
}

}  // namespace
}  // namespace armature::test
