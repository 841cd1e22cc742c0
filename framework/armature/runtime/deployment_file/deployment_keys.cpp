// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/deployment_keys.hpp"

#include <fmt/format.h>
#include <sched.h>

#include "armature/config/key_rows.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {
namespace {

using config::KeySpec;
using namespace config::rows;

const KeySpec kPlugin = text("plugin", "The id of a plugin, family/name.");

}  // namespace

const std::vector<KeySpec>& deployment_keys() {
  static const std::vector<KeySpec> kKeys = [] {
    std::vector<KeySpec> keys{
        config::format_key("armature"),
        text("name", "The namespace of the topics: letters, digits and _."),
        choice("clock", "system: in real time; simulated: in lockstep, the same every time.")
            .choices({"system", "simulated"})
            .fallback("system"),
        integer("domain", "The DDS domain.").fallback("0").range(0, 232),
        section("dds", "Where topics go.").optional(),
        integer("seed", "Of all that is random.").fallback("1").range(0, 0x1p64),
        section("run", "How a run ends.").optional(),
        section("record", "What a run keeps of itself, to be replayed.").optional(),
        section("executors", "Threads, by name; components name theirs.").optional(),
        texts("open", "Inputs that other programs may write: [task.target].").optional(),
        section("components", "What runs, by name: each names its plugin."),
        section("goals", "What figures of the report must not exceed.").optional(),
        section("sweep_goals", "What they must keep over many runs: armature sweep.").optional()};
    for (const auto& [name, word] : kDocumentSections) {
      keys.push_back(
          section(name, fmt::format("Files by name; components say which with '{}'.", word))
              .optional());
    }
    return keys;
  }();
  return kKeys;
}

const std::vector<KeySpec>& dds_keys() {
  static const std::vector<KeySpec> kKeys{
      texts("interfaces", "Network interfaces beside loopback, by name or IPv4 address.")
          .optional(),
      texts("peers", "Hosts whose processes are found without multicast, by name or IPv4 address.")
          .optional(),
      text("discovery_server",
           "Where the discovery server is that all find each other through: host or host:port.")
          .optional(),
      choice("shared_memory", "off: processes of one machine send over UDP, as between containers.")
          .choices({"on", "off"})
          .fallback("on")};
  return kKeys;
}

const std::vector<KeySpec>& run_keys() {
  static const std::vector<KeySpec> kKeys{
      number("time_limit_s", "The run ends after this time; 0: none.")
          .fallback("0")
          .min(0)
          .because("0 is no limit"),
      // Processes tell each other within it that they are at rest. With less no run would end well.
      number("stop_within_s", "How long the end waits for what moves to come to rest.")
          .fallback("3")
          .range(0.1, kLongestWait_s)
          .because("what moves comes to rest before anything ends")};
  return kKeys;
}

const std::vector<KeySpec>& record_keys() {
  static const std::vector<KeySpec> kKeys{
      text("file", "An MCAP file that is not there yet; may say the time: run-%Y%m%d-%H%M%S.mcap."),
      texts("topics", "Only these: names, or beginnings of names and '*'.").optional(),
      flag("compress", "With zstd.").fallback("true"),
      flag("thin", "Only as much as a page of the run shows: fewer messages, no activations.")
          .fallback("false"),
      number("around_faults_s",
             "Only so long before and after something went wrong, a file for each time.")
          .range(0.1, kLongestWait_s)
          .optional()};
  return kKeys;
}

const std::vector<KeySpec>& executor_keys() {
  static const std::vector<KeySpec> kKeys{
      number("period_s", "Of its cycle; without: when there is something to do.")
          .range(1e-4, kLongestWait_s)
          .optional(),
      integer("priority", "Of SCHED_FIFO; 0: normal.")
          .fallback("0")
          .range(0, 99)
          .because("0 is normal"),
      integer("cpu", "The one that it runs on.").range(0, CPU_SETSIZE - 1).optional(),
      flag("lock_memory", "Keep the process in memory.").fallback("false"),
      number("sim_pause_s",
             "On the simulated clock, how long its thread is held up at most, again and again.")
          .fallback("0")
          .range(0, kLongestWait_s)
          .because("0 is never")};
  return kKeys;
}

const std::vector<KeySpec>& sweep_goal_keys() {
  static const std::vector<KeySpec> kKeys{
      section("median", "At most this, or [least, most].").optional(),
      section("p95", "What 95 of 100 runs stay below: at most this, or [least, most].").optional(),
      section("max", "Of the worst run: at most this, or [least, most].").optional(),
      section("rms", "Over all runs: at most this, or [least, most].").optional(),
      section("share", "Part of the runs at or below 'at_most': at least this, or [least, most].")
          .optional(),
      number("at_most", "What 'share' counts; without: the limit under 'goals'.").optional()};
  return kKeys;
}

const std::vector<KeySpec>& robot_entry_keys() {
  static const std::vector<KeySpec> kKeys{
      text("file", "The robot file, relative to this one."),
      numbers("home_deg", "Where all joints begin here, instead of at the home of the file.")
          .also("home")
          .optional()};
  return kKeys;
}

std::vector<KeySpec> component_keys(const PluginManifest& runner, bool is_host) {
  KeySpec plugin = kPlugin;
  plugin.optional = true;  // the framework's own are named by their key: `motion:`
  std::vector<KeySpec> keys{
      plugin,
      text("executor", "An entry of 'executors', or main.").fallback(std::string{kMainExecutor}),
      text("process",
           "The process that it runs in; without: main, on another host one that is called as "
           "the host is.")
          .optional(),
      text("host", "The machine that it runs on, by the name that armature run --host gives it.")
          .fallback(std::string{kMainHost}),
      number("sim_latency_s", "How much later its outputs come, on the simulated clock.")
          .fallback("0")
          .range(0, kLongestWait_s),
      choice("on_fault",
             "What its fault does: stop: it ends the run; isolate: only this component rests.")
          .choices({"stop", "isolate"})
          .optional(),
      section("params", "The plugin's parameters.").optional(),
      text("topics", "Stands before the names of its topics: left.").optional(),
      section("in", "Topics of inputs, by port.").optional(),
      section("out", "Topics of outputs, by port.").optional()};
  for (const auto& [name, word] : kDocumentSections) {
    keys.push_back(section(word, fmt::format("An entry of '{}', or none.", name)).optional());
  }
  for (const SlotSpec& slot : runner.slots) {
    if (is_host && &slot == &runner.slots.front()) continue;
    keys.push_back(section(slot.name, slot.doc).optional());
  }
  return keys;
}

const std::vector<KeySpec>& slot_keys() {
  static const std::vector<KeySpec> kKeys{kPlugin,
                                          section("params", "The plugin's parameters.").optional()};
  return kKeys;
}

}  // namespace armature
