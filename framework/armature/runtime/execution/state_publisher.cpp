// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/state_publisher.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <utility>

#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/setup.hpp"

namespace armature {
namespace {

constexpr const char* kManifest = R"(
armature_plugin: 1
id: runtime/state_publisher
kind: component
doc: Tells how every component of this process is.
out:
  states: {type: armature_msgs/ComponentStates, topic: component_states, doc: "All components of this process, twice a second"}
  description: {type: armature_msgs/DeploymentDescription, topic: description, qos: latched, doc: "Once: what this process consists of"}
  diagnostics: {type: diagnostic_msgs/DiagnosticArray, topic: /diagnostics, shared: true, doc: "The same for ROS tools."}
)";

msg::KeyValue key_value(std::string key, std::string value) {
  msg::KeyValue pair;
  pair.key_(std::move(key));
  pair.value_(std::move(value));
  return pair;
}

msg::KeyValue key_value(std::string key, std::uint64_t value) {
  return key_value(std::move(key), std::to_string(value));
}

/// Plain numbers under names that end in their unit, so that tools plot them as they are.
void add_times(const std::string& what, const TimingFigures& figures,
               std::vector<msg::KeyValue>& values) {
  const auto add = [&](const char* which, double value_s) {
    values.push_back(
        key_value(fmt::format("{}_{}_us", what, which), fmt::format("{:.3f}", 1e6 * value_s)));
  };
  add("last", figures.last_s);
  add("mean", figures.mean_s);
  add("p50", figures.p50_s);
  add("p99", figures.p99_s);
  add("max", figures.max_s);
}

void set_times(msg::StepTiming& message, const TimingFigures& figures) {
  message.last_(figures.last_s);
  message.mean_(figures.mean_s);
  message.p50_(figures.p50_s);
  message.p99_(figures.p99_s);
  message.max_(figures.max_s);
}

}  // namespace

const PluginManifest& StatePublisher::manifest() {
  static const PluginManifest manifest = parse_own_manifest(kManifest);
  return manifest;
}

StatePublisher::StatePublisher(Setup& setup, std::string process,
                               const std::vector<std::unique_ptr<ComponentRunner>>& runners,
                               std::vector<std::string> measuring,
                               const msg::DeploymentDescription& description)
    : Component{setup},
      process_{std::move(process)},
      runners_{runners},
      measuring_{std::move(measuring)},
      to_describe_{&description},
      states_{setup.output<msg::ComponentStates>("states")},
      description_{setup.output<msg::DeploymentDescription>("description")},
      diagnostics_{setup.output<msg::DiagnosticArray>("diagnostics")} {
  setup.activate_every(seconds(0.5));
}

void StatePublisher::Window::move_on(const TimingHistogram& histogram) {
  const TimingHistogram::Counts counts = histogram.counts();
  figures = counts.figures_since(before);
  before = counts;
}

void StatePublisher::move_on() {
  counted_.resize(runners_.size());
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const ComponentRunner& runner = *runners_[i];
    counted_[i].lateness.move_on(runner.times().lateness);
    counted_[i].duration.move_on(runner.times().duration);
    counted_[i].processor.move_on(runner.times().processor);
    counted_[i].reactions.resize(runner.reactions().size());
    for (std::size_t k = 0; k < runner.reactions().size(); ++k) {
      counted_[i].reactions[k].move_on(runner.reactions()[k]);
    }
    if (runner.executor_times()) executors_[runner.executor_times()].name = runner.executor_name();
  }
  for (auto& [times, executor] : executors_) {
    executor.lateness.move_on(times->lateness);
    executor.duration.move_on(times->duration);
  }
}

StatusReporter::Status StatePublisher::status_with_stamps(const ComponentRunner& runner,
                                                          Counted& counted) {
  StatusReporter::Status status = runner.status();
  const Inbox::Ahead ahead = runner.inbox().ahead();
  const bool first = counted.ahead == 0;
  if (std::exchange(counted.ahead, ahead.samples) == ahead.samples) return status;
  const std::string reason =
      fmt::format("input '{}' is stamped {:.3g} s ahead of now, so it is not shown",
                  ahead.port->spec().name, to_seconds(ahead.by));
  if (first) log(fmt::format("'{}': {}", runner.name(), reason));
  if (status.state == StatusReporter::State::ok) status = {StatusReporter::State::degraded, reason};
  return status;
}

StatusReporter::Status StatePublisher::status_of(const ComponentRunner& runner, Counted& counted) {
  constexpr int kLate = 2;  // times: once may be while everything starts
  const auto kept = runner.activations() - std::exchange(counted.activations, runner.activations());
  const auto missed = runner.overruns() - std::exchange(counted.overruns, runner.overruns());
  // One that has told its scenario is not activated any more.
  counted.late = missed > kept && !runner.finished() ? counted.late + 1 : 0;
  if (const Duration stalled = runner.stalled(); stalled > Duration{0}) {
    return {StatusReporter::State::stalled,
            fmt::format("its step has not returned for {:.1f} s", to_seconds(stalled))};
  }
  StatusReporter::Status status = status_with_stamps(runner, counted);
  if (counted.late < kLate) return status;
  if (counted.late == kLate) {
    log(fmt::format("'{}' misses more periods than it keeps: {} of {}", runner.name(), missed,
                    kept + missed));
  }
  if (status.state == StatusReporter::State::ok) {
    status = {StatusReporter::State::degraded,
              fmt::format("keeps {} of {} periods", kept, kept + missed)};
  }
  return status;
}

void StatePublisher::write_state(const ComponentRunner& runner, const Counted& counted,
                                 const StatusReporter::Status& status,
                                 msg::ComponentState& state) const {
  state.component_(runner.name());
  state.plugin_(runner.plugin_id());
  state.state_(static_cast<std::uint8_t>(status.state));
  state.reason_(status.reason);
  state.activations_(runner.activations());
  state.overruns_(runner.overruns());
  state.dropped_(runner.dropped());
  set_times(state.lateness_(), counted.lateness.figures);
  set_times(state.step_(), counted.duration.figures);
  set_times(state.processor_(), counted.processor.figures);
  const auto executor = executors_.find(runner.executor_times());
  const bool threaded = executor != executors_.end();
  state.executor_(threaded ? *executor->second.name : "");
  set_times(state.executor_lateness_(),
            threaded ? executor->second.lateness.figures : TimingFigures{});
  set_times(state.executor_cycle_(),
            threaded ? executor->second.duration.figures : TimingFigures{});
  set_reactions(counted, state.reactions_());
}

void StatePublisher::set_reactions(const Counted& counted,
                                   std::vector<msg::ReactionTiming>& reactions) const {
  reactions.clear();
  for (std::size_t i = 0; i < counted.reactions.size(); ++i) {
    const TimingFigures& figures = counted.reactions[i].figures;
    if (figures.count == 0) continue;
    reactions.emplace_back();
    reactions.back().source_(measuring_[i]);
    reactions.back().count_(figures.count);
    set_times(reactions.back().age_(), figures);
  }
}

msg::DiagnosticStatus StatePublisher::diagnostic_of(const ComponentRunner& runner,
                                                    const Counted& counted,
                                                    const StatusReporter::Status& status) {
  msg::DiagnosticStatus diagnostic;
  diagnostic.level_(static_cast<std::uint8_t>(status.state));  // OK 0, WARN 1, ERROR 2, STALE 3
  diagnostic.name_(runner.name());
  diagnostic.message_(status.reason);
  diagnostic.hardware_id_(runner.plugin_id());
  std::vector<msg::KeyValue> values{key_value("activations", runner.activations()),
                                    key_value("overruns", runner.overruns()),
                                    key_value("dropped", runner.dropped())};
  add_times("lateness", counted.lateness.figures, values);
  add_times("step", counted.duration.figures, values);
  add_times("processor", counted.processor.figures, values);
  diagnostic.values_(std::move(values));
  return diagnostic;
}

msg::DiagnosticStatus StatePublisher::diagnostic_of(const CountedExecutor& executor) {
  msg::DiagnosticStatus diagnostic;
  diagnostic.level_(0);
  diagnostic.name_("executor " + *executor.name);
  std::vector<msg::KeyValue> values;
  add_times("lateness", executor.lateness.figures, values);
  add_times("cycle", executor.duration.figures, values);
  diagnostic.values_(std::move(values));
  return diagnostic;
}

void StatePublisher::publish_description(Time now) {
  auto description = *std::exchange(to_describe_, nullptr);
  set_stamp(description.header_().stamp_(), now);
  description_.publish(description);
}

void StatePublisher::step(Time now) {
  if (to_describe_) publish_description(now);
  auto array = diagnostics_.loan();
  set_stamp(array->header_().stamp_(), now);
  array->header_().frame_id_().clear();
  array->status_().clear();
  auto states = states_.loan();
  set_stamp(states->header_().stamp_(), now);
  states->header_().frame_id_().clear();
  states->process_(process_);
  states->components_().resize(runners_.size());
  move_on();
  for (std::size_t i = 0; i < runners_.size(); ++i) {
    const ComponentRunner& runner = *runners_[i];
    const StatusReporter::Status status = status_of(runner, counted_[i]);
    write_state(runner, counted_[i], status, states->components_()[i]);
    array->status_().push_back(diagnostic_of(runner, counted_[i], status));
  }
  for (const auto& [times, executor] : executors_) {
    array->status_().push_back(diagnostic_of(executor));
  }
  states.publish();
  array.publish();
}

}  // namespace armature
