// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/deployment_keys.hpp"

#include <fmt/format.h>
#include <sched.h>

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {
namespace {

using config::default_value;
using config::KeySpec;
using Type = KeySpec::Type;

KeySpec section(std::string_view name, std::string doc) {
  return {
      .name = std::string{name}, .type = Type::section, .doc = std::move(doc), .optional = true};
}

const KeySpec kPlugin{
    .name = "plugin", .type = Type::text, .doc = "The id of a plugin, family/name."};

}  // namespace

const std::vector<KeySpec>& deployment_keys() {
  static const std::vector<KeySpec> kKeys = [] {
    std::vector<KeySpec> keys{
        config::format_key("armature"),
        {.name = "name",
         .type = Type::text,
         .doc = "The namespace of the topics: letters, digits and _."},
        {.name = "clock",
         .type = Type::choice,
         .doc = "system: in real time; simulated: in lockstep, the same every time.",
         .fallback = default_value("system"),
         .choices = {"system", "simulated"}},
        {.name = "domain",
         .type = Type::integer,
         .doc = "The DDS domain.",
         .fallback = default_value("0"),
         .min = 0,
         .max = 232},
        section("dds", "Where topics go."),
        {.name = "seed",
         .type = Type::integer,
         .doc = "Of all that is random.",
         .fallback = default_value("1"),
         .min = 0,
         .max = 0x1p64},
        section("run", "How a run ends."),
        section("record", "What a run keeps of itself, to be replayed."),
        section("executors", "Threads, by name; components name theirs."),
        {.name = "open",
         .type = Type::texts,
         .doc = "Inputs that other programs may write: [task.target].",
         .optional = true},
        {.name = "components",
         .type = Type::section,
         .doc = "What runs, by name: each names its plugin."},
        section("goals", "What figures of the report must not exceed."),
        section("sweep_goals", "What they must keep over many runs: armature sweep.")};
    for (const auto& [name, word] : kDocumentSections) {
      keys.push_back(
          section(name, fmt::format("Files by name; components say which with '{}'.", word)));
    }
    return keys;
  }();
  return kKeys;
}

const std::vector<KeySpec>& dds_keys() {
  static const std::vector<KeySpec> kKeys{
      {.name = "interfaces",
       .type = Type::texts,
       .doc = "Network interfaces beside loopback, by name or IPv4 address.",
       .optional = true},
      {.name = "peers",
       .type = Type::texts,
       .doc = "Hosts whose processes are found without multicast, by name or IPv4 address.",
       .optional = true},
      {.name = "discovery_server",
       .type = Type::text,
       .doc = "Where the discovery server is that all find each other through: host or host:port.",
       .optional = true},
      {.name = "shared_memory",
       .type = Type::choice,
       .doc = "off: processes of one machine send over UDP, as between containers.",
       .fallback = default_value("on"),
       .choices = {"on", "off"}}};
  return kKeys;
}

const std::vector<KeySpec>& run_keys() {
  static const std::vector<KeySpec> kKeys{
      {.name = "time_limit_s",
       .doc = "The run ends after this time; 0: none.",
       .fallback = default_value("0"),
       .min = 0,
       .because = "0 is no limit"},
      // Processes tell each other within it that they are at rest. With less no run would end well.
      {.name = "stop_within_s",
       .doc = "How long the end waits for what moves to come to rest.",
       .fallback = default_value("3"),
       .min = 0.1,
       .max = kLongestWait_s,
       .because = "what moves comes to rest before anything ends"}};
  return kKeys;
}

const std::vector<KeySpec>& record_keys() {
  static const std::vector<KeySpec> kKeys{
      {.name = "file",
       .type = Type::text,
       .doc = "An MCAP file that is not there yet; may say the time: run-%Y%m%d-%H%M%S.mcap."},
      {.name = "topics",
       .type = Type::texts,
       .doc = "Only these: names, or beginnings of names and '*'.",
       .optional = true},
      {.name = "compress",
       .type = Type::flag,
       .doc = "With zstd.",
       .fallback = default_value("true")},
      {.name = "thin",
       .type = Type::flag,
       .doc = "Only as much as a page of the run shows: fewer messages, no activations.",
       .fallback = default_value("false")},
      {.name = "around_faults_s",
       .doc = "Only so long before and after something went wrong, a file for each time.",
       .min = 0.1,
       .max = kLongestWait_s,
       .optional = true}};
  return kKeys;
}

const std::vector<KeySpec>& executor_keys() {
  static const std::vector<KeySpec> kKeys{
      {.name = "period_s",
       .doc = "Of its cycle; without: when there is something to do.",
       .min = 1e-4,
       .max = kLongestWait_s,
       .optional = true},
      {.name = "priority",
       .type = Type::integer,
       .doc = "Of SCHED_FIFO; 0: normal.",
       .fallback = default_value("0"),
       .min = 0,
       .max = 99,
       .because = "0 is normal"},
      {.name = "cpu",
       .type = Type::integer,
       .doc = "The one that it runs on.",
       .min = 0,
       .max = CPU_SETSIZE - 1,
       .optional = true},
      {.name = "lock_memory",
       .type = Type::flag,
       .doc = "Keep the process in memory.",
       .fallback = default_value("false")},
      {.name = "sim_pause_s",
       .doc = "On the simulated clock, how long its thread is held up at most, again and again.",
       .fallback = default_value("0"),
       .min = 0,
       .max = kLongestWait_s,
       .because = "0 is never"}};
  return kKeys;
}

const std::vector<KeySpec>& sweep_goal_keys() {
  static const std::vector<KeySpec> kKeys{
      section("median", "At most this, or [least, most]."),
      section("p95", "What 95 of 100 runs stay below: at most this, or [least, most]."),
      section("max", "Of the worst run: at most this, or [least, most]."),
      section("rms", "Over all runs: at most this, or [least, most]."),
      section("share", "Part of the runs at or below 'at_most': at least this, or [least, most]."),
      {.name = "at_most",
       .doc = "What 'share' counts; without: the limit under 'goals'.",
       .optional = true}};
  return kKeys;
}

const std::vector<KeySpec>& robot_entry_keys() {
  static const std::vector<KeySpec> kKeys{
      {.name = "file", .type = Type::text, .doc = "The robot file, relative to this one."},
      {.name = "home_deg",
       .type = Type::numbers,
       .doc = "Where all joints begin here, instead of at the home of the file.",
       .optional = true,
       .also = "home"}};
  return kKeys;
}

std::vector<KeySpec> component_keys(const PluginManifest& runner, bool is_host) {
  KeySpec plugin = kPlugin;
  plugin.optional = true;  // the framework's own are named by their key: `motion:`
  std::vector<KeySpec> keys{
      plugin,
      {.name = "executor",
       .type = Type::text,
       .doc = "An entry of 'executors', or main.",
       .fallback = default_value(std::string{kMainExecutor})},
      {.name = "process",
       .type = Type::text,
       .doc = "The process that it runs in; without: main, on another host one that is called as "
              "the host is.",
       .optional = true},
      {.name = "host",
       .type = Type::text,
       .doc = "The machine that it runs on, by the name that armature run --host gives it.",
       .fallback = default_value(std::string{kMainHost})},
      {.name = "sim_latency_s",
       .doc = "How much later its outputs come, on the simulated clock.",
       .fallback = default_value("0"),
       .min = 0,
       .max = kLongestWait_s},
      {.name = "on_fault",
       .type = Type::choice,
       .doc = "What its fault does: stop: it ends the run; isolate: only this component rests.",
       .choices = {"stop", "isolate"},
       .optional = true},
      section("params", "The plugin's parameters."),
      {.name = "topics",
       .type = Type::text,
       .doc = "Stands before the names of its topics: left.",
       .optional = true},
      section("in", "Topics of inputs, by port."),
      section("out", "Topics of outputs, by port.")};
  for (const auto& [name, word] : kDocumentSections) {
    keys.push_back(section(word, fmt::format("An entry of '{}', or none.", name)));
  }
  for (const SlotSpec& slot : runner.slots) {
    if (is_host && &slot == &runner.slots.front()) continue;
    keys.push_back(section(slot.name, slot.doc));
  }
  return keys;
}

const std::vector<KeySpec>& slot_keys() {
  static const std::vector<KeySpec> kKeys{kPlugin, section("params", "The plugin's parameters.")};
  return kKeys;
}

}  // namespace armature
