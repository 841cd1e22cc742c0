// SPDX-License-Identifier: Apache-2.0
#include "operator/task_link.hpp"

#include <fmt/core.h>

#include <utility>

#include "armature/messages/header.hpp"

namespace armature {

TaskLink::TaskLink(PluginRegistry& plugins, const TaskTopics& topics,
                   const NetworkOptions& network) {
  const TransportOptions options{
      .network = network,
      .deployment = "armature operator",
      .fingerprint = {},
      .on_event =
          [](const TransportEvent& event) { fmt::print(stderr, "armature: {}\n", event.text); },
      .now = [this] { return clock_.now(); }};
  auto transport = plugins.make<Transport>("transport/fast_dds", options);
  if (!transport) throw PluginError("cannot join DDS: " + transport.error().text);
  transport_ = std::move(*transport);
  const auto deliver = [this](SampleRef sample) {
    const std::scoped_lock lock{mutex_};
    state_ = *static_cast<const msg::TaskState*>(sample.message());
  };
  auto reader = transport_->subscribe({.name = "rt" + topics.state,
                                       .type = &message_type<msg::TaskState>(),
                                       .qos = QosProfile::state},
                                      false, deliver);
  if (!reader) throw PluginError("cannot read " + topics.state + ": " + reader.error().text);
  reader_ = std::move(*reader);
  const TopicSpec command{.name = "rt" + topics.command,
                          .type = &message_type<msg::OperatorCommand>(),
                          .qos = QosProfile::command};
  auto writer = transport_->advertise(command);
  if (!writer) throw PluginError("cannot write " + topics.command + ": " + writer.error().text);
  constexpr std::size_t kSamples = 16;
  command_ = std::make_unique<Topic>(command, kSamples);
  command_->attach(std::move(*writer));
}

std::optional<msg::TaskState> TaskLink::state() const {
  const std::scoped_lock lock{mutex_};
  return state_;
}

void TaskLink::say(std::uint64_t id, const std::string& word, const std::string& step) {
  SampleRef sample = command_->loan();
  auto& message = *static_cast<msg::OperatorCommand*>(sample.mutable_message());
  write_header(message.header_(), clock_.now());
  message.command_id_(id);
  message.command_() = word;
  message.step_() = step;
  command_->publish(std::move(sample), clock_.now());
}

}  // namespace armature
