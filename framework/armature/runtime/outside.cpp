// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/outside.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace armature {

void Outside::advertise(const PortBinding& output, Topic& topic) {
  TopicSpec spec = topic.spec();
  spec.qos = output.spec.qos;
  auto writer = transport_->advertise(spec);
  if (!writer) throw PluginError("cannot write " + output.topic + ": " + writer.error().text);
  if (const int readers = readers_elsewhere(output.topic)) {
    links_.push_back(
        {output.topic, [own = writer->get(), readers] { return own->peers() >= readers; }});
  }
  topic.attach(std::move(*writer));
}

void Outside::subscribe(const PortBinding& input, Topic& topic) {
  const int writers = writers_elsewhere(input.topic);
  const bool elsewhere = writers > 0;
  if ((!elsewhere && !input.spec.outside) || readers_.contains(input.topic)) return;
  TopicSpec spec = topic.spec();
  spec.qos = input.spec.qos;
  const bool same_deployment_only = elsewhere && input.spec.qos == QosProfile::command;
  auto reader = transport_->subscribe(spec, same_deployment_only,
                                      [&topic](SampleRef sample) { topic.deliver(sample); });
  if (!reader) throw PluginError("cannot read " + input.topic + ": " + reader.error().text);
  if (elsewhere) {
    links_.push_back(
        {input.topic, [own = reader->get(), writers] { return own->peers() >= writers; }});
  }
  readers_[input.topic] = std::move(*reader);
}

std::optional<std::string> Outside::waiting() const {
  const auto link =
      std::ranges::find_if_not(links_, [](const Link& candidate) { return candidate.met(); });
  return link == links_.end() ? std::nullopt : std::optional{link->topic};
}

int Outside::readers_elsewhere(const std::string& topic) const {
  std::set<std::string> processes;
  for (const ComponentConfig& component : deployment_->components) {
    if (component.process == process_) continue;
    if (std::ranges::find(component.inputs, topic, &PortBinding::topic) != component.inputs.end())
      processes.insert(component.process);
  }
  return static_cast<int>(processes.size());
}

int Outside::writers_elsewhere(const std::string& topic) const {
  std::ptrdiff_t writers = 0;
  for (const ComponentConfig& component : deployment_->components) {
    if (component.process == process_) continue;
    writers += std::ranges::count(component.outputs, topic, &PortBinding::topic);
  }
  return static_cast<int>(writers);
}

}  // namespace armature
