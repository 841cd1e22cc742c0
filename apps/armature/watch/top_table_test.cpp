// SPDX-License-Identifier: Apache-2.0
#include "watch/top_table.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace armature {
namespace {

using ::testing::HasSubstr;

constexpr Time kNow{1'000'000'000'000};

/// Two components of one process, "motion" after "camera" in the graph.
class TopTableTest : public testing::Test {
 protected:
  TopTableTest() {
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
    for (const TopLine& line : top_table(seen_, view, kNow).lines) {
      if (line.text.starts_with("  ") && line.text[2] != ' ')
        all.push_back(line.text.substr(2, line.text.find(' ', 2) - 2));
    }
    return all;
  }
  /// The line of a component.
  TopLine line_of(const std::string& name, Time now = kNow) const {
    for (const TopLine& line : top_table(seen_, {}, now).lines) {
      if (line.text.starts_with("  " + name)) return line;
    }
    return {};
  }
  /// The one below it.
  std::string below(const std::string& name, Time now = kNow) const {
    const std::vector<TopLine> lines = top_table(seen_, {}, now).lines;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
      if (lines[i].text.starts_with("  " + name)) return lines[i + 1].text;
    }
    return {};
  }
  std::map<std::string, SeenDeployment> seen_;
};

TEST_F(TopTableTest, HasTheOrderOfTheGraphUnlessItIsSorted) {
  EXPECT_THAT(names(), testing::ElementsAre("camera", "motion"));
  EXPECT_THAT(names({.reversed = true}), testing::ElementsAre("motion", "camera"));
  add("motion", 0.010);
  EXPECT_THAT(names({.order = TopOrder::step}), testing::ElementsAre("motion", "camera"));
  EXPECT_THAT(names({.order = TopOrder::name}), testing::ElementsAre("camera", "motion"));
}

TEST_F(TopTableTest, ShowsOnlyWhatTheFilterLetsThrough) {
  EXPECT_THAT(names({.filter = "mot"}), testing::ElementsAre("motion"));
  EXPECT_THAT(names({.filter = "main"}), testing::ElementsAre("camera", "motion"));
}

TEST_F(TopTableTest, TellsTheReasonOfTrouble) {
  SeenComponent& motion = add("motion", 0.001);
  motion.state.state_(2);
  motion.state.reason_("no solution");
  EXPECT_THAT(line_of("motion").text, HasSubstr("fault"));
  EXPECT_EQ(below("motion"), "      no solution") << "where a narrow terminal shows it, too";
  EXPECT_EQ(line_of("motion").tone, Tone::bad);
  EXPECT_FALSE(line_of("camera").tone);
}

TEST_F(TopTableTest, SaysOfAComponentThatTellsNothingHowLongItHasBeenSilent) {
  EXPECT_THAT(line_of("camera", kNow + seconds(2)).text, HasSubstr(" ok "));
  EXPECT_EQ(below("camera", kNow + seconds(5)), "      has told nothing for 5 s");
  EXPECT_EQ(top_json(seen_, kNow + seconds(5))[0]["components"][0]["state"], "silent");
}

TEST_F(TopTableTest, NamesTheProcessOfWhichNothingIsHeard) {
  EXPECT_FALSE(top_table(seen_, {}, kNow).lines[0].tone);
  seen_["lamp"].processes["main"].processes_({"main", "vision"});
  const TopLine summary = top_table(seen_, {}, kNow).lines[0];
  EXPECT_THAT(summary.text, HasSubstr("nothing is heard of process 'vision'"));
  EXPECT_EQ(summary.tone, Tone::bad);
}

TEST_F(TopTableTest, CountsComponentsThatAreDescribedAndHaveToldNothing) {
  seen_["lamp"].processes["main"].components_().resize(5);
  const TopLine summary = top_table(seen_, {}, kNow).lines[0];
  EXPECT_THAT(summary.text, HasSubstr("2 of 5 components ok"));
  EXPECT_THAT(summary.text, HasSubstr("3 have told nothing yet"));
  EXPECT_EQ(summary.tone, Tone::doubtful);
}

TEST_F(TopTableTest, NamesAProcessThatDiesWhileItIsWatched) {
  seen_["lamp"].processes["main"].processes_({"main", "vision"});
  seen_["lamp"].processes["vision"] = seen_["lamp"].processes["main"];
  seen_["lamp"].processes["vision"].components_().resize(1);
  SeenComponent& component = seen_["lamp"].components[{"vision", "face"}];
  component.heard = kNow;
  EXPECT_FALSE(top_table(seen_, {}, kNow).lines[0].tone);
  component.heard = kNow - seconds(4);
  const TopLine summary = top_table(seen_, {}, kNow).lines[0];
  EXPECT_THAT(summary.text, HasSubstr("2 of 3 components ok"));
  EXPECT_THAT(summary.text, HasSubstr("nothing is heard of process 'vision'"));
  EXPECT_EQ(summary.tone, Tone::bad);
}

TEST_F(TopTableTest, KeepsItsColumnsBesideALongName) {
  add("a_component_with_quite_a_long_name", 0.001);
  const TopTable table = top_table(seen_, {}, kNow);
  for (const TopLine& line : table.lines) {
    if (!line.text.starts_with("  ")) continue;
    EXPECT_EQ(line.text.find(" ok "), table.title.find(" STATE"));
  }
}

TEST_F(TopTableTest, TellsTheSlowestPathFromAMeasurement) {
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
