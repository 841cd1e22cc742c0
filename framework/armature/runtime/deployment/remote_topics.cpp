// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment/remote_topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace armature {
namespace {

/// Numbers of writers elsewhere: whose samples one reader gets count as one writer's, in the order
/// in which they come.
constexpr std::uint32_t kRemote = 1U << 31;

/// The numbers of what one reader gets: those that the writer has given, where there is only one,
/// else their count. They always rise, also where a writer begins anew.
class Numbering {
 public:
  explicit Numbering(bool is_of_one_writer) : is_of_one_writer_{is_of_one_writer} {}
  std::uint64_t next(std::uint64_t of_writer) {
    last_ = is_of_one_writer_ && of_writer > last_ ? of_writer : last_ + 1;
    return last_;
  }

 private:
  bool is_of_one_writer_;
  std::uint64_t last_ = 0;
};

}  // namespace

void RemoteTopics::advertise(const PortBinding& output, Topic& topic) {
  TopicSpec spec = topic.spec();
  spec.qos = output.spec.qos;
  auto writer = transport_->advertise(spec);
  if (!writer) throw PluginError("cannot write " + output.topic + ": " + writer.error().text);
  if (const int readers = readers_elsewhere(output.topic)) {
    links_.push_back({text_of(output.topic, processes_with(output.topic, &ComponentConfig::inputs)),
                      [own = writer->get(), readers] { return own->peers() >= readers; }});
  }
  topic.attach(std::move(*writer));
}

void RemoteTopics::subscribe(const PortBinding& input, Topic& topic) {
  const auto outputs = writers_elsewhere(input.topic);
  const auto writers = static_cast<int>(outputs.size());
  const bool elsewhere = writers > 0;
  const Sources sources = input.spec.outside ? Sources::any : Sources::deployment;
  if ((!elsewhere && !input.spec.outside) || readers_.contains({input.topic, sources})) return;
  TopicSpec spec = topic.spec();
  // One reader serves all inputs of this process, whatever each of them asks for.
  spec.qos = elsewhere ? outputs.front()->spec.qos : input.spec.qos;
  auto reader = transport_->subscribe(
      spec, sources == Sources::deployment,
      [&topic, sources, writer = kRemote + static_cast<std::uint32_t>(readers_.size()),
       numbers =
           Numbering{writers == 1 && sources == Sources::deployment}](SampleRef sample) mutable {
        sample.mutable_info().writer = writer;
        sample.mutable_info().sequence = numbers.next(sample.info().sequence);
        topic.deliver(sample, sources);
      });
  if (!reader) throw PluginError("cannot read " + input.topic + ": " + reader.error().text);
  if (elsewhere) {
    links_.push_back({text_of(input.topic, processes_with(input.topic, &ComponentConfig::outputs)),
                      [own = reader->get(), writers] { return own->peers() >= writers; }});
  }
  readers_[{input.topic, sources}] = std::move(*reader);
}

std::optional<std::string> RemoteTopics::waiting() const {
  const auto link =
      std::ranges::find_if_not(links_, [](const Link& candidate) { return candidate.met(); });
  return link == links_.end() ? std::nullopt : std::optional{link->text};
}

std::vector<std::string> RemoteTopics::refusals() const {
  std::vector<std::string> told;
  for (const auto& [key, reader] : readers_) {
    for (const auto& [writer, count] : reader->refused()) {
      told.push_back(
          fmt::format("{} samples of {} on '{}' were refused", count, writer, key.first));
    }
  }
  return told;
}

std::set<std::string> RemoteTopics::processes_with(
    const std::string& topic, std::vector<PortBinding> ComponentConfig::*ports) const {
  std::set<std::string> processes;
  for (const ComponentConfig& component : deployment_->components) {
    if (component.process == process_) continue;
    const auto& bound = component.*ports;
    if (std::ranges::find(bound, topic, &PortBinding::topic) != bound.end()) {
      processes.insert(component.process);
    }
  }
  return processes;
}

std::string RemoteTopics::text_of(const std::string& topic,
                                  const std::set<std::string>& processes) const {
  std::string others;
  for (const std::string& process : processes) {
    others += (others.empty() ? "'" : ", '") + process + "'";
  }
  return "topic '" + topic + "' of process '" + process_ + "' has not met process " + others;
}

int RemoteTopics::readers_elsewhere(const std::string& topic) const {
  std::set<std::pair<std::string, bool>> readers;
  for (const ComponentConfig& component : deployment_->components) {
    if (component.process == process_) continue;
    for (const PortBinding& input : component.inputs) {
      if (input.topic == topic) readers.emplace(component.process, input.spec.outside);
    }
  }
  return static_cast<int>(readers.size());
}

std::vector<const PortBinding*> RemoteTopics::writers_elsewhere(const std::string& topic) const {
  std::vector<const PortBinding*> writers;
  for (const ComponentConfig& component : deployment_->components) {
    if (component.process == process_) continue;
    for (const PortBinding& output : component.outputs) {
      if (output.topic == topic) writers.push_back(&output);
    }
  }
  return writers;
}

}  // namespace armature
