// SPDX-License-Identifier: Apache-2.0
#include "replay/replayed_component.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "armature/bus/topic_name.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/deployment/component_setup.hpp"

namespace armature {

ReplayedComponent::ReplayedComponent(const ComponentConfig& config,
                                     const DeploymentConfig& deployment, PluginRegistry& plugins,
                                     const RecordedPorts& recorded) {
  construct(config, deployment, plugins);
  for (const std::string& name : recorded.inputs) {
    Input& input = inputs_.emplace_back();
    input.name = name;
    const auto& ports = runner_->inbox().ports();
    const auto port = std::ranges::find(
        ports, name, [](const auto& candidate) { return candidate->spec().name; });
    if (port == ports.end()) continue;
    input.port = port->get();
    input.pool = std::make_unique<SamplePool>(input.port->type(), 2);
  }
  for (const OutputPort& output : runner_->outputs()) {
    for (const auto& [writer, name] : recorded.outputs) {
      if (name == output.spec().name) writers_[output.writer()] = writer;
    }
  }
  runner_->inbox().set_tap(this);
}

ReplayedComponent::~ReplayedComponent() { runner_.reset(); }  // it holds samples of pools

void ReplayedComponent::construct(const ComponentConfig& config, const DeploymentConfig& deployment,
                                  PluginRegistry& plugins) {
  // Outlives the slots that its code makes.
  const auto library = plugins.load(*config.manifest, Component::kKind);
  auto runner = std::make_unique<ComponentRunner>(config.name, config.plugin_id, config.place,
                                                  StatusReporter::Sink{});
  ComponentSetup setup{config,
                       deployment,
                       plugins,
                       *runner,
                       *this,
                       [this](const PortBinding& port, const MessageType& type) -> Topic& {
                         return topic_for(port, type);
                       }};
  auto component = reinterpret_cast<Component::Factory>(library->factory())(setup);
  setup.check_all_claimed();
  runner->install(library, std::move(component));
  runner_ = std::move(runner);
}

Topic& ReplayedComponent::topic_for(const PortBinding& port, const MessageType& type) {
  auto& topic = topics_[port.topic];
  if (!topic) {
    topic = std::make_unique<Topic>(
        TopicSpec{.name = "rt" + port.topic, .type = &type, .qos = port.spec.qos}, 1);
  }
  return *topic;
}

std::optional<std::string> ReplayedComponent::repeat(const msg::Activation& call,
                                                     const RecordedRun& run) {
  for (const msg::SampleRead& read : call.read_()) {
    if (read.input_() >= inputs_.size()) {
      return fmt::format("it is shown an input {}, of {}", read.input_(), inputs_.size());
    }
    const Input& input = inputs_[read.input_()];
    if (!input.port) return fmt::format("it has no input '{}' any more", input.name);
    const auto cdr = run.sample(read.writer_(), read.sequence_());
    if (!cdr && run.was_let_go(read.writer_(), read.sequence_())) {
      return fmt::format(
          "it read a sample of its input '{}' in a call that took so long that the sample is not "
          "held any more",
          input.name);
    }
    if (!cdr) return fmt::format("a sample of its input '{}' is not in the recording", input.name);
    SampleRef sample = input.pool->loan();
    if (!input.port->type().decode(*cdr, sample.mutable_message())) {
      return fmt::format("its input '{}' has another layout now", input.name);
    }
    sample.mutable_info() = {.published = stamp_of(read.published_()),
                             .writer = read.writer_(),
                             .sequence = read.sequence_()};
    runner_->inbox().put(*input.port, sample);
  }
  answers_ = call.had_subscribers_();
  next_answer_ = 0;
  published_.clear();
  const Time now = stamp_of(call.now_());
  clock_.set(now);
  switch (static_cast<ComponentCall>(call.call_())) {
    default: return fmt::format("there is no call {}", call.call_());
    case ComponentCall::step: runner_->step(now); break;
    case ComponentCall::begin_stop:
      runner_->request_stop();
      runner_->answer_stop_request(now);
      break;
    case ComponentCall::stop: runner_->stop(now); break;
  }
  return std::nullopt;
}

bool ReplayedComponent::has_subscribers(bool truly) {
  return next_answer_ < answers_.size() ? answers_[next_answer_++] : truly;
}

void ReplayedComponent::publish(Topic& topic, SampleRef sample) {
  ReplayedMessage& message = published_.emplace_back();
  const auto writer = writers_.find(sample.info().writer);
  message.writer = writer == writers_.end() ? 0 : writer->second;
  message.topic = ros_topic_name(topic.spec().name);
  message.type = topic.spec().type;
  message.type->encode(sample.message(), message.cdr);
}

std::optional<std::string> ReplayedComponent::failure() const {
  if (!runner_->faulted()) return std::nullopt;
  return runner_->status().reason;
}

}  // namespace armature
