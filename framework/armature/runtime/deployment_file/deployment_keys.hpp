// SPDX-License-Identifier: Apache-2.0
// The keys of a deployment file, all but those that its plugins bring: reading asks for them by
// these names and within these limits, and the JSON Schema is made from the same tables.
#pragma once

#include <array>

#include "armature/config/key.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {
namespace keys ARMATURE_EXPORT {

using config::Key;
using Type = ParamSpec::Type;

inline constexpr Key kArmature{.name = "armature",
                               .type = Type::integer,
                               .doc = "The version of the file format.",
                               .min = 1,
                               .max = 1};
inline constexpr Key kName{.name = "name",
                           .type = Type::text,
                           .doc = "The namespace of the topics: letters, digits and _."};
inline constexpr Key kClock{.name = "clock",
                            .type = Type::choice,
                            .doc =
                                "system: in real time; simulated: in lockstep, the same every "
                                "time.",
                            .choices = {"system", "simulated"}};
inline constexpr Key kDomain{
    .name = "domain", .type = Type::integer, .doc = "The DDS domain.", .min = 0, .max = 232};
inline constexpr Key kDds{.name = "dds", .type = {}, .doc = "Where topics go."};
inline constexpr Key kSeed{.name = "seed",
                           .type = Type::integer,
                           .doc = "Of all that is random.",
                           .min = 0,
                           .max = 0x1p64};
inline constexpr Key kRun{.name = "run", .type = {}, .doc = "How a run ends."};
inline constexpr Key kExecutors{
    .name = "executors", .type = {}, .doc = "Threads, by name; components name theirs."};
inline constexpr Key kGoals{
    .name = "goals", .type = {}, .doc = "What figures of the report must not exceed."};
inline constexpr Key kOpen{.name = "open",
                           .type = Type::texts,
                           .doc = "Inputs that other programs may write: [task.target]."};
inline constexpr Key kComponents{
    .name = "components", .type = {}, .doc = "What runs, by name: each names its plugin."};
/// `robots:` and `rigs:` are kDocumentSections.
inline constexpr std::array kDeployment{kArmature, kName,      kClock, kDomain,     kDds,  kSeed,
                                        kRun,      kExecutors, kOpen,  kComponents, kGoals};

inline constexpr Key kInterfaces{
    .name = "interfaces",
    .type = Type::texts,
    .doc = "Network interfaces beside loopback, by name or IPv4 address."};
inline constexpr std::array kDdsKeys{kInterfaces};

inline constexpr Key kTimeLimit{.name = "time_limit_s",
                                .type = Type::number,
                                .doc = "The run ends after this time; 0: none.",
                                .min = 0};
/// Processes tell each other in `stop_within_s` that they are at rest. With less no run would end
/// well.
inline constexpr Key kStopWithin{.name = "stop_within_s",
                                 .type = Type::number,
                                 .doc = "How long the end waits for what moves to come to rest.",
                                 .min = 0.1,
                                 .max = kLongestWait_s};
inline constexpr std::array kRunKeys{kTimeLimit, kStopWithin};

inline constexpr Key kPeriod{.name = "period_s",
                             .type = Type::number,
                             .doc = "Of its cycle; without: when there is something to do.",
                             .min = 1e-4,
                             .max = kLongestWait_s};
inline constexpr Key kPriority{.name = "priority",
                               .type = Type::integer,
                               .doc = "Of SCHED_FIFO; 0: normal.",
                               .min = 0,
                               .max = 99};
inline constexpr Key kCpu{
    .name = "cpu", .type = Type::integer, .doc = "The one that it runs on.", .min = 0};
inline constexpr Key kLockMemory{
    .name = "lock_memory", .type = Type::flag, .doc = "Keep the process in memory."};
inline constexpr std::array kExecutor{kPeriod, kPriority, kCpu, kLockMemory};

inline constexpr Key kPlugin{
    .name = "plugin", .type = Type::text, .doc = "The id of a plugin, family/name."};
inline constexpr Key kParams{.name = "params", .type = {}, .doc = "The plugin's parameters."};
inline constexpr std::array kSlot{kPlugin, kParams};

inline constexpr Key kOfExecutor{
    .name = "executor", .type = Type::text, .doc = "An entry of 'executors', or main."};
inline constexpr Key kProcess{
    .name = "process", .type = Type::text, .doc = "The process that it runs in; without: main."};
inline constexpr Key kSimLatency{.name = "sim_latency_s",
                                 .type = Type::number,
                                 .doc = "How much later its outputs come, on the simulated clock.",
                                 .min = 0,
                                 .max = kLongestWait_s};
inline constexpr Key kOnFault{.name = "on_fault",
                              .type = Type::choice,
                              .doc =
                                  "What its fault does: stop: it ends the run; isolate: only "
                                  "this component rests.",
                              .choices = {"stop", "isolate"}};
inline constexpr Key kTopics{
    .name = "topics", .type = Type::text, .doc = "Stands before the names of its topics: left."};
inline constexpr Key kIn{.name = "in", .type = {}, .doc = "Topics of inputs, by port."};
inline constexpr Key kOut{.name = "out", .type = {}, .doc = "Topics of outputs, by port."};
/// Of every component; `robot:` and `rig:` are kDocumentSections, slots are the plugin's.
inline constexpr std::array kComponent{kPlugin, kOfExecutor, kProcess, kSimLatency, kOnFault,
                                       kParams, kTopics,     kIn,      kOut};

}  // namespace keys
}  // namespace armature
