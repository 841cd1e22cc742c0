// SPDX-License-Identifier: Apache-2.0
#include "stop.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/clock.hpp"
#include "armature/runtime/plugin_registry.hpp"
#include "exit_code.hpp"

namespace armature {
namespace {

using Steady = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kPause{10};
constexpr milliseconds kInsists{300};  // readers that are still being discovered hear it, too

}  // namespace

int stop_arms(const StopOptions& options) {
  PluginRegistry plugins;
  const SystemClock clock;
  SamplePool pool{message_type<msg::Bool>(),
                  64};  // outlives the writer, which may still be sending
  const TransportOptions transport_options{
      .domain = options.domain,
      .interfaces = options.interfaces,
      .deployment = "armature stop",
      .fingerprint = {},
      .on_event =
          [](const TransportEvent& event) { fmt::print(stderr, "armature: {}\n", event.text); },
      .now = [&] { return clock.now(); }};
  auto transport = plugins.make<Transport>("transport/fast_dds", transport_options);
  if (!transport) throw PluginError("cannot join DDS: " + transport.error().text);
  auto writer =
      (*transport)
          ->advertise(
              {.name = "rt/stop", .type = &message_type<msg::Bool>(), .qos = QosProfile::command});
  if (!writer) throw PluginError("cannot write /stop: " + writer.error().text);

  int heard_by = 0;
  const auto give_up = Steady::now() + std::chrono::duration<double>{options.timeout_s};
  auto until = Steady::time_point::max();
  while (Steady::now() < until) {
    if ((*writer)->watchers() > heard_by) {
      heard_by = (*writer)->watchers();
      until = Steady::now() + kInsists;
    }
    if (heard_by == 0 && Steady::now() > give_up) {
      fmt::print(
          stderr,
          "armature: nobody in domain {} heard the stop within {:g} s; a deployment says its "
          "domain with `domain:` or --domain, and with `dds:` the interfaces to join by "
          "--interface\n",
          options.domain, options.timeout_s);
      return kTimedOut;
    }
    SampleRef sample = pool.loan();
    static_cast<msg::Bool*>(sample.mutable_message())->data_(true);
    sample.mutable_info().published = clock.now();
    (*writer)->offer(sample);
    std::this_thread::sleep_for(kPause);
  }
  // Who listens there may be a recorder: whether an arm stopped is told by its own deployment.
  fmt::print(
      "sent: {} {} of domain {} {} /stop; arms among them stay stopped until they are rearmed\n",
      heard_by, heard_by == 1 ? "process" : "processes", options.domain,
      heard_by == 1 ? "reads" : "read");
  return kOk;
}

}  // namespace armature
