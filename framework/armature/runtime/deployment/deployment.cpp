// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment/deployment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ranges>
#include <utility>

#include "armature/config/problems.hpp"
#include "armature/runtime/deployment/description.hpp"
#include "armature/runtime/deployment/slow_constructor.hpp"
#include "armature/runtime/deployment/tried_together.hpp"
#include "armature/runtime/deployment_file/injected_fault.hpp"
#include "armature/runtime/deployment_file/on_fault.hpp"
#include "armature/runtime/execution/clock_publisher.hpp"
#include "armature/runtime/execution/float_environment.hpp"
#include "armature/runtime/execution/lockstep_scheduler.hpp"
#include "armature/runtime/execution/state_publisher.hpp"
#include "armature/runtime/execution/threaded_scheduler.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/plugins/setup_error.hpp"

namespace armature {
namespace {

/// Samples that a topic keeps ready beside those that its readers may hold: what waits to be sent
/// to other processes, what is in flight there, one to fill, and one that a component keeps.
std::size_t preallocated_samples(QosProfile qos) {
  constexpr std::size_t kInside = 3;
  return kInside + static_cast<std::size_t>(settings(qos).depth);
}

/// Where the samples of one output are: the topic itself, or of a shared one the writer's own part,
/// with a DDS writer of its own.
std::string writer_key(const ComponentConfig& component, const PortBinding& output) {
  if (!output.spec.shared) return output.topic;
  return output.topic + " of " + component.name + "." + output.spec.name;
}

/// An executor's period is for all of its components: one that a component has itself would be
/// ignored, with the parameter that says it (`rate_hz`).
void check_period(const ComponentConfig& component, const ComponentRunner& runner,
                  const std::vector<ExecutorSpec>& executors, config::Problems& problems) {
  constexpr double kSame = 1e-3;  // a rate in Hz is seldom a round period
  const auto executor = std::ranges::find(executors, component.executor, &ExecutorSpec::name);
  if (!runner.period() || executor == executors.end() || !executor->period) return;
  const double own = to_seconds(*runner.period()), given = to_seconds(*executor->period);
  if (std::abs(own - given) <= kSame * given) return;
  problems.add(
      component.origin,
      fmt::format("component '{}' steps every {:g} s by itself, but its executor '{}' steps "
                  "every {:g} s; make both the same, or name an executor without a period",
                  component.name, own, component.executor, given));
}

}  // namespace

Deployment::Deployment(DeploymentConfig config, PluginRegistry& plugins, Options options)
    : config_{std::move(config)},
      options_{std::move(options)},
      lost_peers_{config_.name, config_.processes(), options_.process} {
  listen_for_log();
  if (!options_.on_ending) options_.on_ending = [](const std::string&) {};
  make_scheduler();
  std::vector<const ComponentConfig*> order;
  for (const ComponentConfig& component : config_.components) {
    if (options_.process.empty() || component.process == options_.process) {
      order.push_back(&component);
    }
  }
  std::sort(order.begin(), order.end(),
            [](const auto* a, const auto* b) { return a->place < b->place; });
  try_together(config_, options_.process);
  config::Problems problems;
  for (const ComponentConfig* component : order) make_runner(*component, plugins, problems);
  problems.throw_if_any();
  make_own_units(plugins);
  if (std::ranges::find(config_.executors, kRuntimeExecutor, &ExecutorSpec::name) ==
      config_.executors.end()) {
    config_.executors.push_back({.name = std::string{kRuntimeExecutor}, .period = {}});
  }
  assign_runners();
}

Deployment::~Deployment() {
  watchdog_.reset();
  scheduler_->stop(kStepTimeout);
  constexpr const char* kTransport = "the end of the transport";
  if (remote_) {
    options_.on_ending(kTransport);
    remote_->stop_reading();  // deliveries end before their inboxes go
  }
  for (auto& runner : runners_) {
    tell_ending("destructor", *runner);
    const std::string name = runner->name();
    const RunningComponent running{name, "destructor"};
    runner.reset();
  }
  marked_ = nullptr;
  recorder_.reset();  // holds samples of topics
  options_.on_ending(kTransport);
  topics_.clear();  // outside writers go before the transport
  remote_.reset();
}

void Deployment::listen_for_log() {
  print_note_ = std::move(options_.on_note);
  options_.on_note = [this](const std::string& text) {
    tell(text, StatusReporter::State::degraded);
  };
  sink_ = [this](std::string_view component, std::string_view line, StatusReporter::State state) {
    log_.put(clock_->now(), component, line, state);
    mark_trouble(state);
    if (options_.on_line) options_.on_line(component, line);
  };
}

void Deployment::tell(const std::string& text, StatusReporter::State state) {
  log_.put(clock_->now(), kStateComponent, text, state);
  mark_trouble(state);
  if (print_note_) print_note_(text);
}

void Deployment::make_scheduler() {
  if (config_.simulated) {
    auto clock = std::make_unique<SimulatedClock>();
    scheduler_ = std::make_unique<LockstepScheduler>(*clock);
    clock_ = std::move(clock);
  } else {
    clock_ = options_.clock_offset ? std::make_unique<SystemClock>(*options_.clock_offset)
                                   : std::make_unique<SystemClock>();
    // A busy machine makes steps late, too: no trouble that recordings are kept for.
    scheduler_ = std::make_unique<ThreadedScheduler>(
        *clock_, options_.on_note,
        [this](const std::string& text) { tell(text, StatusReporter::State::ok); });
  }
}

void Deployment::make_runner(const ComponentConfig& component, PluginRegistry& plugins,
                             config::Problems& problems) {
  const RunningComponent running{component.name, "constructor"};
  const SlowConstructor slow{component.name, print_note_};
  const FloatEnvironment floats;
  // Outlives the exceptions that its code throws, and the slots that it makes.
  const auto library = plugins.load(*component.manifest, Component::kKind);
  auto runner = std::make_unique<ComponentRunner>(component.name, component.plugin_id,
                                                  component.place, sink_);
  ComponentSetup setup = setup_of(component, plugins, *runner);
  try {
    const auto make = reinterpret_cast<Component::Factory>(library->factory());
    auto object = make(setup);
    setup.check_all_claimed();
    runner->install(library, std::move(object));
    check_period(component, *runner, config_.executors, problems);
    runners_.push_back(std::move(runner));
  } catch (const config::ConfigError& error) {
    for (const auto& problem : error.problems()) problems.add(problem.origin, problem.message);
  } catch (const PluginError&) {
    throw;  // of a slot's library
  } catch (const SlotError& error) {
    const config::Problem problem = problem_of(component, error);
    problems.add(problem.origin, problem.message);
  } catch (...) {
    problems.add(component.origin,
                 fmt::format("component '{}': {}", component.name, current_exception_text()));
  }
}

ComponentConfig Deployment::own_config(std::string_view name, const PluginManifest& manifest,
                                       int place, const std::string& process) const {
  ComponentConfig component{.name = std::string{name},
                            .plugin_id = manifest.id,
                            .manifest = &manifest,
                            .executor = std::string{kRuntimeExecutor},
                            .process = process,
                            .host = config_.host_of(process),
                            .place = place};
  for (const PortSpec& spec : manifest.outputs) {
    const bool absolute = spec.topic.starts_with('/');
    component.outputs.push_back(
        {.spec = spec, .topic = absolute ? spec.topic : "/" + config_.name + "/" + spec.topic});
  }
  return component;
}

void Deployment::make_own_units(PluginRegistry& plugins) {
  // The time is told before anything happens in it, how all are when all has happened.
  if (config_.simulated) {
    make_own_unit(kClockComponent, ClockPublisher::manifest(), -1, plugins,
                  [](Setup& setup) { return std::make_unique<ClockPublisher>(setup); });
  }
  const int last = static_cast<int>(config_.components.size());
  make_own_unit(kStateComponent, StatePublisher::manifest(), last, plugins, [this](Setup& setup) {
    return std::make_unique<StatePublisher>(setup, options_.process, runners_, config_.measuring(),
                                            description_);
  });
  make_own_unit(kLogComponent, LogPublisher::manifest(), last + 1, plugins, [this](Setup& setup) {
    return std::make_unique<LogPublisher>(setup, config_.name, log_);
  });
  // The other processes tell how their components are, too: a component that reads it hears all.
  for (const std::string& process : config_.processes()) {
    if (process == options_.process || options_.process.empty()) continue;
    config_.components.push_back(
        own_config(kStateComponent, StatePublisher::manifest(), last, process));
  }
  std::sort(runners_.begin(), runners_.end(),
            [](const auto& a, const auto& b) { return a->place() < b->place(); });
  for (const auto& runner : runners_) runner->expect_measurements(config_.measuring().size());
}

void Deployment::make_own_unit(std::string_view name, const PluginManifest& manifest, int place,
                               PluginRegistry& plugins,
                               const std::function<std::unique_ptr<Component>(Setup&)>& make) {
  config_.components.push_back(own_config(name, manifest, place, options_.process));
  const ComponentConfig& config = config_.components.back();
  auto runner = std::make_unique<ComponentRunner>(config.name, manifest.id, place, sink_);
  ComponentSetup setup = setup_of(config, plugins, *runner);
  runner->install(nullptr, make(setup));
  runners_.push_back(std::move(runner));
}

void Deployment::on_event(const TransportEvent& event) {
  if (event.kind != TransportEvent::Kind::peer_lost) return options_.on_note(event.text);
  bool is_told = false;
  {
    const std::scoped_lock lock{silent_mutex_};
    is_told = lost_peers_.is_told_here(event.text);
    // While the run is stopping others may end before this process does.
    if (event.of_peer && !stopping_) silent_.push_back(event.text);
  }
  if (is_told) options_.on_note(event.text);
}

std::vector<std::string> Deployment::silent() const {
  const std::scoped_lock lock{silent_mutex_};
  return silent_;
}

ComponentSetup Deployment::setup_of(const ComponentConfig& component, PluginRegistry& plugins,
                                    ComponentRunner& runner) {
  return {component,
          config_,
          plugins,
          runner,
          *scheduler_,
          [this, &component](const PortBinding& port, const MessageType& type) -> Topic& {
            return topic_for(component, port, type);
          },
          options_.domain ? std::optional{config_.dds.network(*options_.domain)} : std::nullopt};
}

Topic& Deployment::topic_for(const ComponentConfig& component, const PortBinding& port,
                             const MessageType& type) {
  Topic& topic = topic_at(port.topic, port, type);
  if (!port.spec.shared) return topic;
  Topic& own = topic_at(writer_key(component, port), port, type);
  own.pass_on_to(topic);
  return own;
}

Topic& Deployment::topic_at(const std::string& key, const PortBinding& port,
                            const MessageType& type) {
  auto& topic = topics_[key];
  if (!topic) {
    topic = std::make_unique<Topic>(
        TopicSpec{.name = "rt" + port.topic, .type = &type, .qos = port.spec.qos},
        preallocated_samples(port.spec.qos));
  }
  return *topic;
}

const ComponentConfig& Deployment::config_of(const ComponentRunner& runner) const {
  return *std::find_if(config_.components.begin(), config_.components.end(),
                       [&](const ComponentConfig& c) { return c.name == runner.name(); });
}

void Deployment::inject(const InjectedFault& fault) {
  for (const auto& runner : runners_) {
    if (runner->name() == fault.component()) runner->inject(fault);
  }
}

void Deployment::assign_runners() {
  for (const auto& runner : runners_) {
    runner->set_latency(std::max(config_of(*runner).sim_latency, runner->latency()));
    runner->tell_end(one_ended_);
  }
  for (const ExecutorSpec& spec : config_.executors) {
    std::vector<ComponentRunner*> assigned;
    for (const auto& runner : runners_) {
      if (config_of(*runner).executor == spec.name) assigned.push_back(runner.get());
    }
    if (!assigned.empty()) scheduler_->assign(spec, assigned);
  }
}

void Deployment::follow_clock(Duration unix_minus_monotonic) {
  if (auto* clock = dynamic_cast<SystemClock*>(clock_.get())) clock->follow(unix_minus_monotonic);
}

void Deployment::record(const std::filesystem::path& file,
                        const std::function<std::filesystem::path(Time)>& file_at) {
  const auto tell_file = [this](const std::string& name) {
    tell("what happened around the trouble is recorded: " + name, StatusReporter::State::ok);
  };
  RunRecorder::Options options{.file = file,
                               .around_faults = config_.record->around_faults,
                               .file_at = file_at,
                               .topics = config_.record->topics,
                               .compress = config_.record->compress,
                               .thin = config_.record->thin,
                               .description = description_,
                               .on_problem = options_.on_note,
                               .on_file = tell_file};
  recorder_ = std::make_unique<RunRecorder>(std::move(options), config_, runners_, *clock_);
  marked_.store(recorder_.get(), std::memory_order_release);
}

void Deployment::mark_trouble(StatusReporter::State state) {
  if (state == StatusReporter::State::ok) return;
  const Time now = clock_->now();
  trouble_ns_.store(now.ns, std::memory_order_relaxed);
  mark_trouble(now);
}

void Deployment::mark_trouble(Time at) {
  if (RunRecorder* recorder = marked_.load(std::memory_order_acquire)) recorder->mark_trouble(at);
}

std::optional<Time> Deployment::next_trouble() {
  const std::int64_t ns = trouble_ns_.exchange(kNoTrouble, std::memory_order_relaxed);
  const bool is_told = ns != kNoTrouble && config_.record && config_.record->around_faults;
  return is_told ? std::optional{Time{ns}} : std::nullopt;
}

void Deployment::connect(PluginRegistry& plugins, int domain, const std::string& run) {
  description_ = description_of(config_, options_.process, run);
  NetworkOptions network = config_.dds.network(domain);
  // A process that the others go on without must leave nothing behind that they wait for.
  const bool isolated = options_.process != kMainProcess && !stops_run(options_.process, config_);
  network.shared_memory = network.shared_memory && !isolated;
  const TransportOptions options{
      .network = std::move(network),
      .deployment = config_.name,
      .fingerprint = config_.fingerprint,
      .run = run,
      .process = options_.process,
      .on_event = [this](const TransportEvent& event) { on_event(event); },
      .now = [this] { return clock_->now(); },
      .simulated = config_.simulated};
  auto transport = plugins.make<Transport>("transport/fast_dds", options);
  if (!transport) throw PluginError("cannot join DDS: " + transport.error().text);
  remote_.emplace(std::move(*transport), config_, options_.process);
  const auto of_this_process = [&](const ComponentConfig& component) {
    return component.process == options_.process;
  };
  for (const ComponentConfig& component :
       config_.components | std::views::filter(of_this_process)) {
    for (const PortBinding& input : component.inputs) {
      remote_->subscribe(input, *topics_.at(input.topic));
    }
  }
  for (const ComponentConfig& component :
       config_.components | std::views::filter(of_this_process)) {
    for (const PortBinding& output : component.outputs) {
      remote_->advertise(output, *topics_.at(writer_key(component, output)));
    }
  }
  if (run.empty()) remote_->start_together();
}

}  // namespace armature
