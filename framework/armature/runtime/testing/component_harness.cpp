// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/testing/component_harness.hpp"

#include <algorithm>

#include "armature/runtime/deployment_file/component_units.hpp"

namespace armature {

ComponentHarness::ComponentHarness(PluginRegistry& plugins, const Options& options) {
  read(plugins, options);
  // Outlives the slots that its code makes.
  const auto library = plugins.load(*config_.manifest, Component::kKind);
  auto runner = std::make_unique<ComponentRunner>(
      config_.name, config_.plugin_id, 0,
      [this](std::string_view, std::string_view line, StatusReporter::State) {
        lines_.emplace_back(line);
      });
  runner->on_triggered([this] { triggered_ = true; });
  ComponentSetup setup{config_,
                       deployment_,
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
  for (const PortBinding& output : config_.outputs) {
    topics_.at(output.topic)->connect(taps_[output.spec.name]);
  }
}

ComponentHarness::~ComponentHarness() = default;

void ComponentHarness::read(const PluginRegistry& plugins, const Options& options) {
  deployment_.name = "bench";
  deployment_.seed = 1;
  deployment_.executors.push_back(
      {.name = std::string{kMainExecutor}, .period = {}, .priority = 0});
  for (const auto& [section, word] : kDocumentSections) {
    auto& documents = deployment_.documents[std::string{section}];
    const auto& document = word == "robot" ? options.robot : options.rig;
    if (document) documents.emplace(word, *document);
  }
  const config::Node file = config::parse_text("bench: " + options.component, "bench");
  config::Problems problems;
  auto read = ComponentReader{deployment_, plugins, problems}.read(file.entries().front());
  problems.throw_if_any();
  std::vector<ComponentConfig> units = units_of(*read);
  const auto unit = std::ranges::find(units, options.unit, &ComponentConfig::unit);
  if (unit == units.end()) throw std::invalid_argument("there is no unit '" + options.unit + "'");
  config_ = std::move(*unit);
  ComponentConfig others;
  for (const PortBinding& input : config_.inputs) {
    const auto& written = options.written;
    if (std::ranges::find(written, input.spec.name) != written.end())
      others.outputs.push_back(input);
  }
  deployment_.components.push_back(std::move(others));
}

void ComponentHarness::step(double now_s) {
  now_.set(Time{} + seconds(now_s));
  triggered_ = false;
  runner_->start_threads(now_);
  runner_->step(now_.now());
  if (runner_->faulted()) throw std::runtime_error(runner_->status().reason);
}

void ComponentHarness::begin_stop(double now_s) {
  now_.set(Time{} + seconds(now_s));
  runner_->request_stop();
  runner_->answer_stop_request(now_.now());
  if (runner_->faulted()) throw std::runtime_error(runner_->status().reason);
}

Topic& ComponentHarness::topic_for(const PortBinding& port, const MessageType& type) {
  auto& topic = topics_[port.topic];
  if (!topic) {
    topic = std::make_unique<Topic>(
        TopicSpec{.name = "rt" + port.topic, .type = &type, .qos = port.spec.qos}, 1);
  }
  return *topic;
}

Topic& ComponentHarness::topic_of(const std::vector<PortBinding>& ports, std::string_view name,
                                  const MessageType& type) {
  for (const PortBinding& port : ports) {
    if (port.spec.name != name) continue;
    if (port.spec.type != type.ros_name) {
      throw std::invalid_argument("port '" + port.spec.name + "' is a " + port.spec.type +
                                  ", not a " + std::string{type.ros_name});
    }
    return *topics_.at(port.topic);
  }
  throw std::invalid_argument("there is no port '" + std::string{name} + "'");
}

SlotPlace& ComponentHarness::slot(std::string_view name) {
  for (const auto& place : runner_->slots()) {
    if (place->name() == name) return *place;
  }
  throw std::invalid_argument("there is no slot '" + std::string{name} + "'");
}

bool ComponentHarness::send_encoded(std::string_view input, std::span<const std::byte> cdr) {
  const auto port =
      std::ranges::find(config_.inputs, input, [](const PortBinding& p) { return p.spec.name; });
  if (port == config_.inputs.end()) {
    throw std::invalid_argument("there is no port '" + std::string{input} + "'");
  }
  Topic& topic = *topics_.at(port->topic);
  SampleRef sample = topic.loan();
  if (!topic.spec().type->decode(cdr, sample.mutable_message())) return false;
  topic.publish(std::move(sample), now_.now());
  return true;
}

std::string refusal_of(PluginRegistry& plugins, const ComponentHarness::Options& options) {
  try {
    const ComponentHarness made{plugins, options};
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace armature
