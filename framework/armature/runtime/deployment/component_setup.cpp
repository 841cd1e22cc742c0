// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment/component_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "armature/runtime/deployment_file/graph.hpp"

namespace armature {
namespace {

constexpr std::uint32_t kMaxOutputs = 1024;  // of a component

}  // namespace

config::Problem problem_of(const ComponentConfig& component, const SlotError& error) {
  const auto slot = std::ranges::find(component.slots, error.slot(), &SlotConfig::name);
  const bool has_line =
      slot != component.slots.end() && slot->origin.text() != component.origin.text();
  if (!has_line) {
    return {component.origin, fmt::format("component '{}': {}", component.name, error.what())};
  }
  return {slot->origin, fmt::format("slot '{}' of component '{}': {}", slot->name,
                                    component.component(), error.what())};
}

ComponentSetup::ComponentSetup(const ComponentConfig& config, const DeploymentConfig& deployment,
                               PluginRegistry& plugins, ComponentRunner& runner, Delivery& delivery,
                               FindTopic find_topic, std::optional<NetworkOptions> network)
    : config_{config},
      deployment_{deployment},
      plugins_{plugins},
      runner_{runner},
      delivery_{delivery},
      find_topic_{std::move(find_topic)},
      network_{std::move(network)} {}

std::uint64_t ComponentSetup::seed() const { return deployment_.seed_of(config_.name); }

const config::Node& ComponentSetup::document(std::string_view section) {
  const auto bound = config_.documents.find(std::string{section});
  if (bound == config_.documents.end()) {
    throw std::logic_error(
        fmt::format("plugin '{}' reads '{}' but its plugin.yaml does not say so "
                    "under 'uses:'",
                    config_.manifest->id, section));
  }
  return deployment_.documents.at(std::string{section}).at(bound->second);
}

bool ComponentSetup::has_document(std::string_view section) const {
  return config_.documents.contains(std::string{section});
}

void ComponentSetup::activate_every(Duration period) {
  if (period <= Duration{0}) throw SetupError("its period must be positive");
  runner_.set_period(period);
}

const PortBinding& ComponentSetup::declared(const std::vector<PortBinding>& ports,
                                            std::string_view direction, std::string_view name,
                                            const MessageType& type) {
  const PortBinding* port = find_port(ports, name);
  if (!port) {
    throw std::logic_error(
        fmt::format("plugin '{}' claims the {} '{}', which its plugin.yaml does "
                    "not declare",
                    config_.manifest->id, direction, name));
  }
  if (port->spec.type != type.ros_name) {
    throw std::logic_error(
        fmt::format("plugin '{}' claims the {} '{}' as {}, its plugin.yaml says "
                    "{}",
                    config_.manifest->id, direction, name, type.ros_name, port->spec.type));
  }
  claimed_.insert(port);
  return *port;
}

InputPort& ComponentSetup::claim_input(std::string_view port, const MessageType& type) {
  const PortBinding& binding = declared(config_.inputs, "input", port, type);
  InputPort& input = runner_.inbox().add(binding.spec, type);
  set_source(input, binding);
  find_topic_(binding, type)
      .connect(input, binding.spec.outside ? Sources::any : Sources::deployment);
  return input;
}

void ComponentSetup::set_source(InputPort& input, const PortBinding& binding) const {
  bool is_answered = !binding.spec.feedback;
  int source = -1;
  for (const ComponentConfig& writer : deployment_.components) {
    const auto output = std::ranges::find(writer.outputs, binding.topic, &PortBinding::topic);
    if (output == writer.outputs.end()) continue;
    // What another unit of the same component says goes with the flow of the whole.
    is_answered = is_answered || writer.component() == config_.component();
    if (output->spec.measured) source = deployment_.measuring_index(writer.name);
  }
  input.set_source(source, is_answered);
}

OutputPort& ComponentSetup::claim_output(std::string_view port, const MessageType& type) {
  const PortBinding& binding = declared(config_.outputs, "output", port, type);
  const auto index = static_cast<std::uint32_t>(runner_.outputs().size());
  const auto writer = static_cast<std::uint32_t>(runner_.place() + 2) * kMaxOutputs + index;
  return runner_.outputs().emplace_back(binding.spec, find_topic_(binding, type), delivery_,
                                        runner_.inbox(), writer);
}

bool ComponentSetup::is_written(std::string_view input) const {
  const PortBinding* port = find_port(config_.inputs, input);
  return port && writer_of(port->topic, deployment_);
}

const SlotConfig& ComponentSetup::slot_config(std::string_view slot) const {
  const auto found = std::ranges::find(config_.slots, slot, &SlotConfig::name);
  if (found == config_.slots.end()) {
    throw std::logic_error(
        fmt::format("plugin '{}' uses the slot '{}', which its plugin.yaml does "
                    "not declare",
                    config_.manifest->id, slot));
  }
  return *found;
}

bool ComponentSetup::is_filled(std::string_view slot) const {
  return std::ranges::find(config_.slots, slot, &SlotConfig::name) != config_.slots.end();
}

const PluginManifest& ComponentSetup::slot_manifest(std::string_view slot) const {
  return *slot_config(slot).manifest;
}

SlotPlugin ComponentSetup::slot_plugin(std::string_view slot, std::string_view kind) {
  const SlotConfig& config = slot_config(slot);
  return {plugins_.load(*config.manifest, kind), *config.manifest, config.params};
}

void ComponentSetup::keep_thread(std::unique_ptr<DriverThread> thread) {
  if (config_.manifest->pure) {
    throw std::logic_error(
        fmt::format("plugin '{}' has a driver thread, so no two runs of it are alike; its "
                    "plugin.yaml must say 'pure: false'",
                    config_.manifest->id));
  }
  runner_.add_thread(std::move(thread));
}

void ComponentSetup::check_all_claimed() const {
  for (const auto* ports : {&config_.inputs, &config_.outputs}) {
    for (const PortBinding& port : *ports) {
      if (!claimed_.contains(&port)) {
        throw std::logic_error(fmt::format("plugin '{}' declares the port '{}' but never claims it",
                                           config_.manifest->id, port.spec.name));
      }
    }
  }
}

}  // namespace armature
