// SPDX-License-Identifier: Apache-2.0
#include "watch/topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "armature/bus/topic_name.hpp"
#include "armature/messages/cdr_to_json.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/values/json_text.hpp"
#include "armature/values/monotonic_now.hpp"
#include "exit_code.hpp"
#include "readable_json.hpp"
#include "terminal_text.hpp"
#include "watch/sample_count.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

std::string ros_type(const std::string& dds_name) {
  const TypeDescription* type = describe_type(dds_name);
  return type ? type->ros_name : dds_name;
}

std::string ros_types(const ObservedTopic& topic) {
  std::string types;
  for (const auto& type : topic.types) types += (types.empty() ? "" : ", ") + ros_type(type);
  return types;
}

std::string counted(int count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// The topic as discovery shows it once it is there; nothing: the time is over.
std::optional<ObservedTopic> find_topic(Outsider& outsider, const TopicOptions& options) {
  const auto found = [&]() -> std::optional<ObservedTopic> {
    const auto topics = outsider.dds().topics();
    for (const std::string& name : {options.topic, dds_topic_name(options.topic)}) {
      const auto topic = std::ranges::find(topics, name, &ObservedTopic::name);
      if (topic != topics.end()) return *topic;
    }
    return std::nullopt;
  };
  const Time start = monotonic_now();
  for (bool told = false; !found(); wait_for(seconds(0.02))) {
    const Duration waited = monotonic_now() - start;
    const bool is_over = options.timeout_s > 0 && waited > seconds(options.timeout_s);
    if (left() || is_over) return std::nullopt;
    if (told || options.timeout_s > 0 || waited < kDiscovery) continue;
    told = true;
    fmt::print(stderr, "armature: nobody writes or reads '{}' yet, waiting for it{}\n",
               options.topic, outsider.topics_there(options.topic));
  }
  // Whoever else uses it is found at about the same time.
  wait_for(kDiscovery);
  return found();
}

Json json_of(const ObservedTopic& topic) {
  return {{"topic", ros_topic_name(topic.name)},
          {"type", ros_types(topic)},
          {"writers", topic.writers},
          {"readers", topic.readers},
          {"deployments", topic.deployments}};
}

}  // namespace

int list_topics(const TopicOptions& options) {
  leave_in_order();
  Outsider outsider{options};
  if (!wait_for(options.timeout_s > 0 ? seconds(options.timeout_s) : kDiscovery)) return kOk;
  if (const int code = outsider.too_short(); code != kOk) return code;
  const auto topics = outsider.dds().topics();
  if (topics.empty()) fmt::print(stderr, "armature: {}\n", outsider.no_topics());
  std::size_t width = 40;
  for (const auto& topic : topics) width = std::max(width, ros_topic_name(topic.name).size());
  Json json = Json::array();
  for (const auto& topic : topics) {
    if (options.json) {
      json.push_back(json_of(topic));
    } else {
      tell(fmt::format("{:<{}} {:<32} {}, {} in other processes{}",
                       terminal_text(ros_topic_name(topic.name)), width, ros_types(topic),
                       counted(topic.writers, "writer"), counted(topic.readers, "reader"),
                       topic.types.size() > 1 ? "   CONFLICT: two types on one topic" : ""));
    }
  }
  if (options.json) tell(json_text(json));
  return kOk;
}

int describe_topic(const TopicOptions& options) {
  leave_in_order();
  Outsider outsider{options};
  const auto topic = find_topic(outsider, options);
  if (!topic && left()) return kOk;
  if (!topic) {
    fmt::print(stderr, "armature: nobody writes or reads '{}' within {:g} s{}\n", options.topic,
               options.timeout_s, outsider.topics_there(options.topic));
    return kTimedOut;
  }
  Json json = json_of(*topic);
  json["endpoints"] = Json::array();
  std::string text =
      fmt::format("{}  {}\n", terminal_text(ros_topic_name(topic->name)), ros_types(*topic));
  for (const ObservedEndpoint& endpoint : topic->endpoints) {
    const char* does = endpoint.writes ? "writes" : "reads";
    const char* reliability = endpoint.reliable ? "reliable" : "best effort";
    const char* durability = endpoint.transient_local ? "transient local" : "volatile";
    text +=
        fmt::format("  {:<7} {:<11}  {:<15}  {}{}\n", does, reliability, durability, endpoint.owner,
                    topic->types.size() > 1 ? ", as " + ros_type(endpoint.type) : "");
    json["endpoints"].push_back({{"does", does},
                                 {"type", ros_type(endpoint.type)},
                                 {"reliability", reliability},
                                 {"durability", durability},
                                 {"owner", endpoint.owner}});
  }
  text.pop_back();
  tell(options.json ? json_text(json) : text);
  return kOk;
}

int echo_topic(const TopicOptions& options) {
  leave_in_order();
  SampleCount count{options, 1};
  Outsider outsider{options, !options.best_effort};  // goes before what its callback uses
  const int watching = outsider.watch(options.topic, [&](const ObservedSample& sample) {
    if (count.full()) return;
    const TypeDescription* type = describe_type(sample.type);
    if (!type) {
      constexpr const char* kNote =
          "the folder of the library that has the type belongs into ARMATURE_PLUGIN_PATH";
      const Json unread{{"type", sample.type}, {"bytes", sample.cdr.size()}, {"note", kNote}};
      tell(options.json ? json_text(unread)
                        : fmt::format("{} bytes of {}; {}", sample.cdr.size(), sample.type, kNote));
    } else {
      const auto json = cdr_to_json(*type, sample.cdr,
                                    options.full ? OctetArrays::whole : OctetArrays::shortened);
      if (!json) {
        fmt::print(stderr, "armature: not a {}: {}\n", type->ros_name, json.error().text);
        return;
      }
      tell(options.json ? json_text(*json) : terminal_lines(readable(*json), 0) + "\n---");
    }
    count.add();
  });
  return watching == kOk ? count.wait() : watching;
}

}  // namespace armature
