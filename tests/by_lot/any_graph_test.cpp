// SPDX-License-Identifier: Apache-2.0
// What is recorded comes back, whatever happens: random graphs, on either clock, on two threads and
// in up to three processes, that throw, are killed, stopped or interrupted at any time. 1. The file
// is whole, 2. nobody did something else, 3. all of a run is compared unless a process was killed,
// 4. another constant is found in whom has it, and nowhere else. ARMATURE_GRAPHS: so many, from
// number ARMATURE_FIRST_GRAPH on.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"
#include "tests/environment_number.hpp"

namespace armature::test {
namespace {

using nlohmann::json;

constexpr std::chrono::seconds kEnds{100};
constexpr std::array kGraphPorts{"state", "aged", "sensor", "command", "latched", "reply", "log"};

enum class Mishap { none, exception, kill, interrupt, stop };

/// A deployment of nodes that read each other, and what happens to it.
class AnyGraph {
 public:
  explicit AnyGraph(int seed) : chance_{static_cast<std::uint64_t>(seed)} {
    const int processes = of(3) + 1;
    const bool simulated = processes == 1 && of(2) == 0;
    nodes_ = of(5) + 2;
    mishap_ = static_cast<Mishap>(of(5));
    std::ofstream file{folder_ / "graph.yaml"};
    file << fmt::format(
        "armature: 1\nname: graph\nseed: {}\nclock: {}\nrun: {{time_limit_s: {}}}\n"
        "record: {{file: run.mcap}}\nexecutors: {{one: {{}}, two: {{}}}}\ncomponents:\n",
        seed, simulated ? "simulated" : "system", simulated ? 60 : 0.5);
    const int failing = mishap_ == Mishap::exception ? of(nodes_) : -1;
    for (int node = 0; node < nodes_; ++node) {
      const std::string process =
          std::array{"main", "left", "right"}[node == 0 ? 0 : of(processes)];
      file << fmt::format(
          "  n{0}: {{plugin: test/any_node, topics: n{0}, process: {1}, executor: {2}, on_fault: "
          "{3}, in: {{{4}}}, params: {{rate_hz: {5}, burst: {6}, fails_after: {7}}}}}\n",
          node, process, of(2) == 0 ? "one" : "two", of(2) == 0 ? "stop" : "isolate",
          fmt::join(inputs_of(node), ", "), simulated ? 10 : std::array{10, 100, 500}[of(3)], of(4),
          node == failing ? of(40) + 1 : 0);
    }
  }

  int of(int count) { return static_cast<int>(chance_() % static_cast<std::uint64_t>(count)); }
  int nodes() const { return nodes_; }
  std::string recording() const { return folder_ / "run.mcap"; }
  bool was_killed() const { return was_killed_; }

  CommandResult run() {
    Command run{{armature(), "run", folder_ / "graph.yaml", "--domain", domain_}, options_};
    const bool is_told = mishap_ != Mishap::none && mishap_ != Mishap::exception;
    const auto until = std::chrono::steady_clock::now() + kEnds;
    while (is_told && !std::filesystem::exists(recording()) && !ends_within(run.pid(), kNow) &&
           std::chrono::steady_clock::now() < until) {
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
    }
    if (is_told) std::this_thread::sleep_for(std::chrono::milliseconds{of(600)});
    const pid_t child = mishap_ == Mishap::kill ? run.child() : 0;
    if (child > 0) was_killed_ = kill(child, SIGKILL) == 0;
    if (mishap_ == Mishap::interrupt) run.signal(SIGINT);
    if (mishap_ == Mishap::stop) run_command({armature(), "stop", "--domain", domain_});
    return run.finish(kEnds);
  }
  json check(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{armature(), "replay", "--check", "--json", recording()};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = run_command(words, options_, kEnds);
    return json::parse(result.out, nullptr, false);
  }

 private:
  static constexpr std::chrono::seconds kNow{0};

  /// Who is woken reads only those before it.
  std::vector<std::string> inputs_of(int node) {
    std::vector<std::string> inputs;
    for (const std::string port : kGraphPorts) {
      const int sources = port == "sensor" || port == "reply" ? node : nodes_;
      if (sources == 0 || of(2) == 0) continue;
      inputs.push_back(fmt::format("{0}: /graph/n{1}/to_{0}", port, of(sources)));
    }
    return inputs;
  }

  std::mt19937_64 chance_;
  const TemporaryFolder folder_;
  const std::string domain_ = std::to_string(unique_dds_domain());
  const Command::Options options_{.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}},
                                  .input = {}};
  int nodes_ = 0;
  Mishap mishap_ = Mishap::none;
  bool was_killed_ = false;
};

void expect_comes_back(AnyGraph& graph, const CommandResult& run) {
  const CommandResult verified = run_command({armature(), "info", "--verify", graph.recording()});
  EXPECT_EQ(verified.exit_code, 0) << verified.out;
  const std::string changed = fmt::format("n{}", graph.of(graph.nodes()));
  const json same = graph.check();
  const json other = graph.check({"--set", "components." + changed + ".params.gain=0.7"});
  ASSERT_TRUE(same.is_object() && other.is_object());
  // A machine that is too busy loses calls and counts them.
  if (!graph.was_killed() && run.err.find("came faster") == run.err.npos) {
    EXPECT_EQ(same["identical"], json(true)) << same.dump(1);
  }
  for (std::size_t i = 0; i < same["components"].size(); ++i) {
    const json& component = same["components"][i];
    EXPECT_FALSE(component.contains("difference")) << component;
    const bool is_found = component["component"] == changed && component["outputs"] > 0;
    EXPECT_EQ(other["components"][i].contains("difference"), is_found) << other["components"][i];
  }
}

TEST(AnyGraphThatRecordsItself, ComesBackWhateverHappensAndAnotherConstantIsFoundWhereItIs) {
  const int first = environment_number("ARMATURE_FIRST_GRAPH", 1),
            count = environment_number("ARMATURE_GRAPHS", 3);
  for (int seed = first; seed < first + count; ++seed) {
    AnyGraph graph{seed};
    const CommandResult run = graph.run();
    SCOPED_TRACE(fmt::format("seed {}\n{}", seed, run.err));
    EXPECT_FALSE(run.timed_out);
    // Interrupted before all had met it has not begun.
    if (std::filesystem::exists(graph.recording())) expect_comes_back(graph, run);
  }
}

}  // namespace
}  // namespace armature::test
