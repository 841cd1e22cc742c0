// SPDX-License-Identifier: Apache-2.0
#include "run/stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <string>
#include <thread>

#include "armature/bus/sample.hpp"
#include "armature/bus/transport.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "armature/runtime/processes/running_processes.hpp"
#include "armature/values/time.hpp"
#include "exit_code.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kRepeat{10};
constexpr milliseconds kInsists{500};  // deployments that are still being discovered hear it, too

/// Writes the stop until who reads it has been found, and says who has taken it.
class Stopping {
 public:
  Stopping(const StopOptions& options, RemoteWriter& writer, SamplePool& pool,
           const SystemClock& clock)
      : options_{options}, writer_{writer}, pool_{pool}, clock_{clock} {}

  /// False when no deployment was found within the options' time.
  bool reach_all() {
    auto until = give_up_;
    while (Steady::now() < until) {
      for (const Watcher& found : writer_.who_watches()) {
        const bool is_new = heard_by_.emplace(found.owner, found.of_deployment).second;
        if (is_new && found.of_deployment) until = Steady::now() + kInsists;
      }
      SampleRef sample = pool_.loan();
      static_cast<msg::Bool*>(sample.mutable_message())->data_(true);
      sample.mutable_info().published = clock_.now();
      writer_.offer(sample);
      std::this_thread::sleep_for(kRepeat);
    }
    return std::ranges::any_of(heard_by_, [](const auto& heard) { return heard.second; });
  }

  bool acknowledged() {
    const auto left = std::max(give_up_ - Steady::now(), Steady::duration{kInsists});
    return writer_.acknowledged(std::chrono::duration_cast<Duration>(left));
  }

  /// Name of a process, and whether it is one of a deployment.
  const std::map<std::string, bool>& heard_by() const { return heard_by_; }

 private:
  const StopOptions& options_;
  RemoteWriter& writer_;
  SamplePool& pool_;
  const SystemClock& clock_;
  Steady::time_point give_up_ = Steady::now() + seconds(options_.timeout_s);
  std::map<std::string, bool> heard_by_;
};

void tell_halted(const RunningProcess& one, int domain) {
  fmt::print(stderr,
             "armature: {} runs on this machine in domain {} and does not answer: it is halted. "
             "'kill -CONT {}' lets it go on; until then use the arm's own emergency stop\n",
             one.text(), domain, one.pid);
}

/// Says of the processes of this machine which are halted, or may be. False: none is.
bool halted_told(int domain) {
  bool any = false;
  for (const RunningProcess& one : running_processes(domain)) {
    if (one.halted) tell_halted(one, domain);
    if (one.pid == 0) {
      fmt::print(stderr,
                 "armature: {} runs on this machine in domain {}: it may be halted, and then it "
                 "has not stopped. Use the arm's own emergency stop\n",
                 one.text(), domain);
    }
    any = any || one.halted || one.pid == 0;
  }
  return any;
}

/// When nobody was found: deployments of this machine are known by their locks.
void tell_silent(const StopOptions& options) {
  const auto running = running_processes(options.network.domain);
  for (const RunningProcess& one : running) {
    if (one.halted) {
      tell_halted(one, options.network.domain);
    } else {
      fmt::print(stderr,
                 "armature: {} runs on this machine in domain {} and does not hear /stop: it is "
                 "about to start or to end, moves no arm, or cannot be reached from here\n",
                 one.text(), options.network.domain);
    }
  }
  if (!running.empty()) return;
  fmt::print(stderr,
             "armature: no deployment in domain {} heard the stop within {:g} s; a deployment "
             "says its domain with `domain:` or --domain, and with `dds:` what to join by "
             "--interface, --peer or --discovery-server\n",
             options.network.domain, options.timeout_s);
}

}  // namespace

int stop_arms(const StopOptions& options) {
  PluginRegistry plugins;
  const SystemClock clock;
  SamplePool pool{message_type<msg::Bool>(),
                  64};  // outlives the writer, which may still be sending
  std::atomic<bool> one_fell_silent = false;
  const TransportOptions transport_options{.network = options.network,
                                           .deployment = "armature stop",
                                           .fingerprint = {},
                                           .on_event =
                                               [&](const TransportEvent& event) {
                                                 if (event.kind == TransportEvent::Kind::peer_lost)
                                                   one_fell_silent = true;
                                                 fmt::print(stderr, "armature: {}\n", event.text);
                                               },
                                           .now = [&] { return clock.now(); }};
  auto transport = plugins.make<Transport>("transport/fast_dds", transport_options);
  if (!transport) throw PluginError("cannot join DDS: " + transport.error().text);
  auto writer =
      (*transport)
          ->advertise(
              {.name = "rt/stop", .type = &message_type<msg::Bool>(), .qos = QosProfile::command});
  if (!writer) throw PluginError("cannot write /stop: " + writer.error().text);

  Stopping stopping{options, **writer, pool, clock};
  const bool found = stopping.reach_all();
  for (const auto& [who, of_deployment] : stopping.heard_by()) {
    if (!of_deployment) fmt::print(stderr, "armature: {} reads /stop, and is no deployment\n", who);
  }
  if (!found) {
    tell_silent(options);
    return kTimedOut;
  }
  const bool taken = stopping.acknowledged() && !one_fell_silent;
  for (const auto& [who, of_deployment] : stopping.heard_by()) {
    if (of_deployment) print_out("{} {}\n", taken ? "stopped:" : "sent to", who);
  }
  const bool halted = halted_told(options.network.domain);
  if (!taken && !halted) {
    fmt::print(stderr,
               "armature: not every process has taken the stop within {:g} s: one may be halted. "
               "Use the arm's own emergency stop\n",
               options.timeout_s);
  }
  if (!taken || halted) return kTimedOut;
  print_out("They stay stopped until they are rearmed\n");
  return kOk;
}

}  // namespace armature
