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
  explicit Numbering(bool is_numbered) : is_numbered_{is_numbered} {}
  std::uint64_t next(std::uint64_t of_writer) {
    last_ = is_numbered_ && of_writer > last_ ? of_writer : last_ + 1;
    return last_;
  }

 private:
  bool is_numbered_;
  std::uint64_t last_ = 0;
};

}  // namespace

void RemoteTopics::advertise(const PortBinding& output, Topic& topic) {
  TopicSpec spec = topic.spec();
  spec.qos = output.spec.qos;
  auto writer = transport_->advertise(spec);
  if (!writer) throw PluginError("cannot write " + output.topic + ": " + writer.error().text);
  const auto readers = readers_elsewhere(output.topic);
  if (!readers.empty()) {
    std::set<std::string> processes;
    for (const auto& [process, is_open] : readers) processes.insert(process);
    links_.push_back({text_of(output.topic, processes),
                      [own = writer->get(), count = static_cast<int>(readers.size())] {
                        return own->peers() >= count;
                      }});
  }
  topic.attach(std::move(*writer));
}

void RemoteTopics::subscribe(const PortBinding& input, Topic& topic) {
  const InputFromElsewhere from = deployment_->from_elsewhere(input, process_);
  const auto writers = static_cast<int>(from.outputs.size());
  const bool elsewhere = writers > 0;
  const Sources sources = input.spec.outside ? Sources::any : Sources::deployment;
  if ((!elsewhere && !input.spec.outside) || readers_.contains({input.topic, sources})) return;
  TopicSpec spec = topic.spec();
  // One reader serves all inputs of this process, whatever each of them asks for.
  spec.qos = elsewhere ? from.outputs.front()->spec.qos : input.spec.qos;
  auto reader = transport_->subscribe(
      spec, sources == Sources::deployment,
      [&topic, sources, writer = kRemote + static_cast<std::uint32_t>(readers_.size()),
       numbers = Numbering{from.is_numbered}](SampleRef sample) mutable {
        sample.mutable_info().writer = writer;
        sample.mutable_info().sequence = numbers.next(sample.info().sequence);
        topic.deliver(sample, sources);
      });
  if (!reader) throw PluginError("cannot read " + input.topic + ": " + reader.error().text);
  if (elsewhere) {
    links_.push_back({text_of(input.topic, from.processes),
                      [own = reader->get(), writers] { return own->peers() >= writers; }});
  }
  readers_[{input.topic, sources}] = std::move(*reader);
}

void RemoteTopics::start_together() {
  const std::set<std::string> others = processes_bound_to(*deployment_, process_);
  if (!others.empty()) common_start_.emplace(*transport_, deployment_->name, process_, others);
}

std::optional<std::string> RemoteTopics::waiting(Time now) {
  const bool may_leave = common_start_ && common_start_->all_have_met();
  const auto link =
      std::ranges::find_if_not(links_, [](const Link& candidate) { return candidate.met(); });
  if (link != links_.end() && !may_leave) return link->text;
  return common_start_ ? common_start_->waiting(now) : std::nullopt;
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

std::string RemoteTopics::text_of(const std::string& topic,
                                  const std::set<std::string>& processes) const {
  std::string others;
  for (const std::string& process : processes) {
    others += (others.empty() ? "'" : ", '") + process + "'";
  }
  return "topic '" + topic + "' of process '" + process_ + "' has not met process " + others;
}

std::set<std::pair<std::string, bool>> RemoteTopics::readers_elsewhere(
    const std::string& topic) const {
  std::set<std::pair<std::string, bool>> readers;
  for (const ComponentConfig& component : deployment_->components) {
    if (component.process == process_) continue;
    for (const PortBinding& input : component.inputs) {
      if (input.topic == topic) readers.emplace(component.process, input.spec.outside);
    }
  }
  return readers;
}

}  // namespace armature
