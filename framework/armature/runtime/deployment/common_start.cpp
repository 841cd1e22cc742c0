// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment/common_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature {
namespace {

constexpr std::size_t kSamples = 2;  // one to fill, and one that waits to be sent

TopicSpec spec(const std::string& deployment, const std::string& process) {
  return {.name = fmt::format("rt/{}/processes/{}", deployment, process),
          .type = &message_type<msg::String>(),
          .qos = QosProfile::latched};
}

bool is_exchanged(const ComponentConfig& writer, const ComponentConfig& reader) {
  for (const PortBinding& output : writer.outputs) {
    for (const PortBinding& input : reader.inputs) {
      if (output.topic == input.topic) return true;
    }
  }
  return false;
}

}  // namespace

std::set<std::string> processes_bound_to(const DeploymentConfig& deployment,
                                         const std::string& process) {
  std::set<std::string> bound{process};
  for (std::size_t before = 0; before < bound.size();) {
    before = bound.size();
    for (const ComponentConfig& writer : deployment.components) {
      for (const ComponentConfig& reader : deployment.components) {
        if (bound.contains(writer.process) == bound.contains(reader.process)) continue;
        if (is_exchanged(writer, reader)) bound.insert({writer.process, reader.process});
      }
    }
  }
  bound.erase(process);
  return bound;
}

CommonStart::CommonStart(Transport& transport, const std::string& deployment, std::string process,
                         const std::set<std::string>& others)
    : process_{std::move(process)}, topic_{spec(deployment, process_), kSamples} {
  for (const std::string& name : others) {
    Other& other = others_.emplace_back(name);
    auto reader = transport.subscribe(spec(deployment, name), true,
                                      [&other](const SampleRef&) { other.has_met = true; });
    if (!reader) throw PluginError("cannot hear process '" + name + "': " + reader.error().text);
    other.reader = std::move(*reader);
  }
  auto writer = transport.advertise(topic_.spec());
  if (!writer) throw PluginError("cannot tell other processes: " + writer.error().text);
  writer_ = writer->get();
  topic_.attach(std::move(*writer));
}

bool CommonStart::all_have_met() {
  const auto has_met = [](const Other& other) { return other.has_met.load(); };
  if (is_told_ && std::ranges::all_of(others_, has_met)) all_have_met_ = true;
  if (all_have_met_) return true;
  for (Other& other : others_) {
    const bool is_there = other.reader->peers() > 0;
    if (std::exchange(other.was_there, is_there) && !is_there) other.has_met = false;
  }
  return false;
}

std::optional<std::string> CommonStart::waiting(Time now) {
  if (!std::exchange(is_told_, true)) topic_.publish(topic_.loan(), now);
  const bool have_all_met = all_have_met();
  max_informed_ = std::max(have_all_met ? max_informed_ : 0, writer_->peers());
  if (!have_all_met) {
    const auto other =
        std::ranges::find(others_, false, [](const Other& o) { return o.has_met.load(); });
    return fmt::format("process '{}' has not met all that it exchanges topics with",
                       other == others_.end() ? others_.front().process : other->process);
  }
  const int count = static_cast<int>(others_.size());
  if (max_informed_ >= count && writer_->acknowledged(Duration{0})) return std::nullopt;
  return fmt::format("not every process has heard that '{}' has met all", process_);
}

}  // namespace armature
