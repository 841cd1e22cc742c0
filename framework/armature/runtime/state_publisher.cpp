// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/state_publisher.hpp"

#include <fmt/format.h>

#include <cstddef>
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

Voice::Status StatePublisher::status_of(const Unit& unit, Counted& counted) {
  constexpr int kLate = 2;  // times: once may be while everything starts
  const auto kept = unit.activations() - std::exchange(counted.activations, unit.activations());
  const auto missed = unit.overruns() - std::exchange(counted.overruns, unit.overruns());
  counted.late = missed > kept ? counted.late + 1 : 0;
  Voice::Status status = unit.status();
  if (counted.late < kLate) return status;
  if (counted.late == kLate) {
    say(fmt::format("'{}' misses more periods than it keeps: {} of {}", unit.name(), missed,
                    kept + missed));
  }
  if (status.state == Voice::State::ok) {
    status = {Voice::State::degraded, fmt::format("keeps {} of {} periods", kept, kept + missed)};
  }
  return status;
}

void StatePublisher::publish_state(const Unit& unit, const Voice::Status& status, Time now) {
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
  counted_.resize(units_.size());
  for (std::size_t i = 0; i < units_.size(); ++i) {
    const auto& unit = units_[i];
    const Voice::Status status = status_of(*unit, counted_[i]);
    publish_state(*unit, status, now);
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
