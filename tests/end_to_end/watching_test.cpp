// SPDX-License-Identifier: Apache-2.0
// What a deployment tells of itself while it runs: its graph, its parts, how they are, its log.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "command.hpp"
#include "tests/dds_domain.hpp"
#include "tests/terminal.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr std::chrono::seconds kLongEnough{60};

std::vector<std::string> sorted_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  std::ranges::sort(lines);
  return lines;
}

class Watching : public testing::Test {
 protected:
  Command start(const std::string& file, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{armature(), "run", source_file(file), "--domain",
                                       std::to_string(domain_)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Command{arguments};
  }
  std::vector<std::string> line(std::vector<std::string> words) const {
    words.insert(words.begin(), armature());
    words.insert(words.end(), {"--domain", std::to_string(domain_)});
    return words;
  }
  std::string out_of(const std::vector<std::string>& words) const {
    const CommandResult result = run_command(line(words), {}, kLongEnough);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }
  /// One sample of a topic.
  json sample_of(const std::string& topic) const {
    return json::parse(
        out_of({"topic", "echo", topic, "-n", "1", "--full", "--json", "--timeout", "40"}));
  }
  int domain_ = unique_dds_domain();
};

TEST_F(Watching, TheLiveGraphIsThatOfTheFile) {
  const std::string file = "tests/end_to_end/arm_watched.yaml";
  const Command run = start(file, {"--set", "clock=system"});
  const auto of_file = run_command({armature(), "graph", source_file(file)});
  EXPECT_EQ(out_of({"graph", "--live", "--timeout", "40"}), of_file.out) << run.err();
  EXPECT_THAT(of_file.out, HasSubstr("/watched/arm/measured_js"));
  EXPECT_THAT(out_of({"graph", "--live", "watched", "--mermaid", "--timeout", "40"}),
              HasSubstr("c_arm -->|\"/watched/arm/measured_js\"| c_monitor"));
}

TEST_F(Watching, TheLiveGraphOfSeveralProcessesIsWhole) {
  const std::string file = "tests/end_to_end/arm_watched.yaml";
  const std::vector<std::string> apart{"--set", "clock=system", "--set",
                                       "components.monitor.process=apart"};
  const Command run = start(file, apart);
  std::vector<std::string> graph{armature(), "graph", source_file(file)};
  graph.insert(graph.end(), apart.begin(), apart.end());
  EXPECT_EQ(sorted_lines(out_of({"graph", "--live", "--timeout", "40"})),
            sorted_lines(run_command(graph).out))
      << run.err();
  EXPECT_THAT(out_of({"graph", "--live", "--dot", "--timeout", "40"}),
              HasSubstr("subgraph \"cluster_apart\""));
}

TEST_F(Watching, AProcessThatDiedIsNamedAndTheRestIsShown) {
  const Command run = start("tests/end_to_end/arm_watched.yaml",
                            {"--set", "clock=system", "--set", "components.monitor.process=apart"});
  out_of({"graph", "--live", "--timeout", "40"});  // all is there
  kill(run.child(), SIGKILL);
  Command log{line({"log", "-f"})};
  EXPECT_TRUE(log.wait_for_out("process 'apart' (pid ", kLongEnough)) << run.err();
  const CommandResult graph =
      run_command(line({"graph", "--live", "--timeout", "5"}), {}, kLongEnough);
  const CommandResult top =
      run_command(line({"top", "-n", "1", "--timeout", "10"}), {}, kLongEnough);
  EXPECT_EQ(graph.exit_code, 0) << graph.err;
  EXPECT_THAT(graph.err, HasSubstr("nothing was heard of process 'apart'"));
  EXPECT_THAT(graph.out, HasSubstr("/watched/arm/measured_js"));
  EXPECT_EQ(top.exit_code, 0) << top.err;
  EXPECT_THAT(top.out, HasSubstr("nothing is heard of process 'apart'"));
}

TEST_F(Watching, WhoIsNotThereIsNamedWhenTheTimeIsOver) {
  const auto graph = run_command(line({"graph", "--live", "nobody", "--timeout", "2"}));
  EXPECT_EQ(graph.exit_code, 5);
  EXPECT_THAT(graph.err, HasSubstr("no deployment 'nobody' tells of itself in domain "));
  const auto top = run_command(line({"top", "-n", "1", "--timeout", "2"}));
  EXPECT_EQ(top.exit_code, 5);
  EXPECT_THAT(top.err, HasSubstr("no deployment tells how it is in domain "));
}

TEST_F(Watching, TopEndsWhenTheTimeIsOver) {
  const Command run = start("tests/end_to_end/arm_watched.yaml", {"--set", "clock=system"});
  CommandResult result =
      run_command(line({"top", "--interval", "0.2", "--timeout", "8"}), {}, kLongEnough);
  EXPECT_EQ(result.exit_code, 0) << result.err << run.err();
  EXPECT_THAT(result.out, HasSubstr("watched: "));
  result = run_command(line({"top", "--interval", "0.2", "--timeout", "4", "-n", "1000"}), {},
                       kLongEnough);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.err, HasSubstr(" of 1000 tables within 4 s"));
}

/// The lamp with its cameras: what moves on a picture's stamp is measured by it.
TEST_F(Watching, ALampTellsWhatItConsistsOfAndHowItIs) {
  const std::string file = "configs/dental_lamp.yaml";
  Command run = start(file, {"--keep-running", "--set", "components.scene.params.noise=1"});
  Command follow{line({"log", "-f"})};
  EXPECT_TRUE(follow.wait_for_out("dental_lamp.task: holding", kLongEnough)) << run.err();
  const json told = sample_of("/dental_lamp/description");
  EXPECT_EQ(told["processes"], json::parse(R"(["main"])"));
  EXPECT_EQ(told["simulated"], false);
  const json shown = json::parse(run_command({armature(), "show", source_file(file), "--set",
                                              "components.scene.params.noise=1", "--json"})
                                     .out);
  for (const json& component : told["components"]) {
    const std::string name = component["name"];
    if (!shown["components"].contains(name)) continue;  // a unit, or the runtime's own
    const json& entry = shown["components"][name];
    // `motion:` is the plugin of that name.
    EXPECT_EQ(component["plugin"],
              entry.contains("plugin") ? entry["plugin"]["value"] : json(name));
    for (const json& plugin : component["plugins"]) {
      const std::string slot = plugin["slot"];
      // A solver that is named directly stands in a slot of its host.
      const bool stands_below = !slot.empty() && entry.contains(slot);
      const json params = (stands_below ? entry[slot] : entry).value("params", json::object());
      EXPECT_EQ(plugin["sha256"].get<std::string>().size(), 64U) << plugin;
      for (const json& parameter : plugin["parameters"]) {
        const std::string called = parameter["name"];
        EXPECT_TRUE(params.contains(called)) << name << " " << slot << " " << called;
      }
    }
  }
  const json& scene = told["components"][0]["plugins"][0]["parameters"];
  const auto noise = std::ranges::find(scene, "noise", [](const json& one) { return one["name"]; });
  ASSERT_NE(noise, scene.end());
  EXPECT_EQ((*noise)["value"], "1");
  EXPECT_EQ((*noise)["origin"], "--set components.scene.params.noise=1");

  const json urdf = sample_of("/robot_description");
  const json joints = sample_of("/joint_states");
  for (const json& joint : joints["name"]) {
    EXPECT_THAT(urdf["data"].get<std::string>(),
                HasSubstr("<joint name=\"" + joint.get<std::string>() + "\""));
  }
  const json picture = sample_of("/dental_lamp/left/image_raw/compressed");
  EXPECT_EQ(picture["format"], "jpeg");
  EXPECT_EQ(picture["data"][0], 0xFF);
  EXPECT_EQ(picture["data"][1], 0xD8);

  const json tops = json::parse(out_of({"top", "-n", "1", "--json", "--timeout", "40"}));
  std::set<std::string> reacting;
  for (const json& component : tops[0]["components"]) {
    const bool is_held_up = component["reason"].get<std::string>().starts_with("keeps ");
    EXPECT_TRUE(component["state"] == "ok" || is_held_up) << component;
    for (const json& reaction : component["reactions"]) {
      EXPECT_GT(reaction["age_s"]["p50"], 0) << component;
      EXPECT_LE(reaction["age_s"]["p50"], reaction["age_s"]["p99"]) << component;
      reacting.insert(component["component"].get<std::string>() + " to " +
                      reaction["to"].get<std::string>());
    }
  }
  EXPECT_TRUE(reacting.contains("landmarks to scene")) << tops;
  EXPECT_TRUE(reacting.contains("target to scene")) << tops;

  const json delay = json::parse(out_of(
      {"topic", "delay", "/dental_lamp/arm/measured_js", "-n", "20", "--json", "--timeout", "40"}));
  EXPECT_GT(delay["longest_s"], 0);
  const json width = json::parse(sorted_lines(out_of(
      {"topic", "bw", "/dental_lamp/left/image_raw", "-n", "3", "--json", "--timeout", "40"}))[0]);
  EXPECT_GT(width["smallest"], 640 * 480);
  const json info = json::parse(out_of({"topic", "info", "/dental_lamp/description", "--json"}));
  EXPECT_EQ(info["type"], "armature_msgs/DeploymentDescription");
  EXPECT_EQ(info["endpoints"][0]["durability"], "transient local");
  EXPECT_THAT(info["endpoints"][0]["owner"].get<std::string>(),
              HasSubstr("deployment 'dental_lamp', process 'main' (pid "));

  // One who comes late reads what was said before.
  EXPECT_THAT(out_of({"log", "--component", "task", "--json", "--timeout", "40"}),
              HasSubstr(R"("level":"info","name":"dental_lamp.task","text":"checking light")"));
  run.signal(SIGINT);
  EXPECT_EQ(run.finish(kLongEnough).exit_code, 0);
  follow.signal(SIGINT);
  EXPECT_EQ(follow.finish(kLongEnough).exit_code, 0);
}

TEST_F(Watching, StampsOfASimulatedClockHaveNoDelay) {
  const Command run = start("tests/end_to_end/arm_watched.yaml");
  const auto result =
      run_command(line({"topic", "delay", "/watched/arm/measured_js", "--timeout", "40"}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("days from this machine's clock: by a simulated one"))
      << run.err();
}

TEST_F(Watching, TheTableOnATerminalObeysItsKeys) {
  const Command run = start("tests/end_to_end/arm_watched.yaml", {"--set", "clock=system"});
  Terminal top{line({"top"})};
  EXPECT_TRUE(top.shows("COMPONENT")) << run.err();
  EXPECT_TRUE(top.shows("components ok")) << run.err();
  EXPECT_TRUE(top.shows("arm"));
  top.type("/");
  EXPECT_TRUE(top.shows("filter: "));
  top.type("mon\rh");
  EXPECT_TRUE(top.shows("share of one processor"));
  top.type("q");
  EXPECT_EQ(top.exit_code(), 0);
}

}  // namespace
}  // namespace armature::test
