// SPDX-License-Identifier: Apache-2.0
#include "watch/top_table.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace armature {
namespace {

using ::testing::HasSubstr;

constexpr Time kNow{1'000'000'000'000};

/// Two components of one process, "motion" after "camera" in the graph.
class TopTable : public testing::Test {
 protected:
  TopTable() {
    msg::DeploymentDescription& description = seen_["lamp"].processes["main"];
    description.processes_({"main"});
    description.components_().resize(2);
    description.components_()[0].name_("camera");
    description.components_()[1].name_("motion");
    add("motion", 0.001);
    add("camera", 0.004);
  }
  SeenComponent& add(const std::string& name, double step_s) {
    SeenComponent& component = seen_["lamp"].components[{"main", name}];
    component.state.component_(name);
    component.state.step_().p99_(step_s);
    component.heard = kNow;
    return component;
  }
  std::vector<std::string> names(const TopView& view = {}) const {
    std::vector<std::string> all;
    for (const TopLine& line : top_table(seen_, view, kNow)) {
      if (line.text.starts_with("  "))
        all.push_back(line.text.substr(2, line.text.find(' ', 2) - 2));
    }
    return all;
  }
  /// The line of a component.
  TopLine line_of(const std::string& name, Time now = kNow) const {
    for (const TopLine& line : top_table(seen_, {}, now)) {
      if (line.text.starts_with("  " + name)) return line;
    }
    return {};
  }
  std::map<std::string, SeenDeployment> seen_;
};

TEST_F(TopTable, HasTheOrderOfTheGraphUnlessItIsSorted) {
  EXPECT_THAT(names(), testing::ElementsAre("camera", "motion"));
  EXPECT_THAT(names({.reversed = true}), testing::ElementsAre("motion", "camera"));
  add("motion", 0.010);
  EXPECT_THAT(names({.order = TopOrder::step}), testing::ElementsAre("motion", "camera"));
  EXPECT_THAT(names({.order = TopOrder::name}), testing::ElementsAre("camera", "motion"));
}

TEST_F(TopTable, ShowsOnlyWhatTheFilterLetsThrough) {
  EXPECT_THAT(names({.filter = "mot"}), testing::ElementsAre("motion"));
  EXPECT_THAT(names({.filter = "main"}), testing::ElementsAre("camera", "motion"));
}

TEST_F(TopTable, TellsTheReasonOfTrouble) {
  SeenComponent& motion = add("motion", 0.001);
  motion.state.state_(2);
  motion.state.reason_("no solution");
  EXPECT_THAT(line_of("motion").text, HasSubstr("fault"));
  EXPECT_THAT(line_of("motion").text, HasSubstr("no solution"));
  EXPECT_EQ(line_of("motion").tone, Tone::bad);
  EXPECT_FALSE(line_of("camera").tone);
}

TEST_F(TopTable, SaysOfAComponentThatTellsNothingHowLongItHasBeenSilent) {
  EXPECT_THAT(line_of("camera", kNow + seconds(2)).text, HasSubstr(" ok "));
  EXPECT_THAT(line_of("camera", kNow + seconds(5)).text, HasSubstr("has told nothing for 5 s"));
  EXPECT_EQ(top_json(seen_, kNow + seconds(5))[0]["components"][0]["state"], "silent");
}

TEST_F(TopTable, TellsTheSlowestPathFromAMeasurement) {
  SeenComponent& motion = add("motion", 0.001);
  motion.state.reactions_().resize(2);
  motion.state.reactions_()[0].source_("camera");
  motion.state.reactions_()[0].age_().p50_(0.0042);
  motion.state.reactions_()[0].age_().p99_(0.0111);
  motion.state.reactions_()[1].source_("tracker");
  motion.state.reactions_()[1].age_().p99_(0.003);
  EXPECT_THAT(line_of("motion").text, HasSubstr("camera 4.2 ms 11.1 ms"));
  const auto json = top_json(seen_, kNow);
  EXPECT_EQ(json[0]["components"][1]["reactions"].size(), 2U);
  EXPECT_EQ(json[0]["components"][1]["reactions"][0]["age_s"]["p99"], 0.0111);
}

}  // namespace
}  // namespace armature
