// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/state_publisher.hpp"

#include <string>
#include <utility>

#include "armature/messages/stamp.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {
namespace {

constexpr const char* kManifest = R"(
armature_plugin: 1
id: runtime/state_publisher
kind: component
doc: Tells how every component of this process is.
out:
  state: {type: armature_msgs/ComponentState, topic: component_state, doc: "One message per component, twice a second."}
  diagnostics: {type: diagnostic_msgs/DiagnosticArray, topic: /diagnostics, shared: true, doc: "The same for ROS tools."}
)";

msg::KeyValue key_value(std::string key, std::uint64_t value) {
  msg::KeyValue pair;
  pair.key_(std::move(key));
  pair.value_(std::to_string(value));
  return pair;
}

}  // namespace

const PluginManifest& StatePublisher::manifest() {
  static const PluginManifest manifest = parse_own_manifest(kManifest);
  return manifest;
}

StatePublisher::StatePublisher(Setup& setup, const std::vector<std::unique_ptr<Unit>>& units)
    : Component{setup},
      units_{units},
      state_{setup.output<msg::ComponentState>("state")},
      diagnostics_{setup.output<msg::DiagnosticArray>("diagnostics")} {
  setup.activate_every(seconds(0.5));
}

void StatePublisher::publish_state(const Unit& unit, Time now) {
  const Voice::Status status = unit.status();
  auto message = state_.loan();
  set_stamp(message->header_().stamp_(), now);
  message->header_().frame_id_().clear();
  message->component_(unit.name());
  message->plugin_(unit.plugin_id());
  message->state_(static_cast<std::uint8_t>(status.state));
  message->reason_(status.reason);
  message->activations_(unit.activations());
  message->overruns_(unit.overruns());
  message->dropped_(unit.inbox().dropped());
  message.publish();
}

void StatePublisher::step(Time now) {
  auto array = diagnostics_.loan();
  set_stamp(array->header_().stamp_(), now);
  array->header_().frame_id_().clear();
  array->status_().clear();
  for (const auto& unit : units_) {
    publish_state(*unit, now);
    const Voice::Status status = unit->status();
    msg::DiagnosticStatus diagnostic;
    diagnostic.level_(static_cast<std::uint8_t>(status.state));  // OK 0, WARN 1, ERROR 2
    diagnostic.name_(unit->name());
    diagnostic.message_(status.reason);
    diagnostic.hardware_id_(unit->plugin_id());
    diagnostic.values_({key_value("activations", unit->activations()),
                        key_value("overruns", unit->overruns()),
                        key_value("dropped", unit->inbox().dropped())});
    array->status_().push_back(std::move(diagnostic));
  }
  array.publish();
}

}  // namespace armature
