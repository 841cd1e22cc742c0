// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "armature/runtime/execution/component_runner.hpp"
#include "armature/values/real_time_mutex.hpp"
#include "armature/values/wake_up.hpp"

namespace armature ARMATURE_EXPORT {

struct ComponentConfig;
struct DeploymentConfig;

/// A thread that sees steps that do not return. It reads when the running step of each component
/// began and counts for how long it has seen it; time in which it did not run itself (a machine
/// that stood still) is not counted. What hangs is marked in its component (`stalled`), and told
/// once.
class Watchdog {
 public:
  struct Watched {
    ComponentRunner* runner;
    Duration max_step;  // a step that takes longer hangs
    bool stops_run;     // it is on the way to a driver: the run cannot go on
  };
  /// `note` is called on the watchdog's thread. `priority` is above that of what is watched (0: of
  /// the normal scheduler, also when the system allows no other).
  Watchdog(std::vector<Watched> watched, int priority,
           std::function<void(const std::string&)> note);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Why the run cannot go on: the first step that hung where that matters, also when it has
  /// returned since; empty: none. Any thread.
  std::string verdict() const;

 private:
  /// The running step of a component, as the watchdog saw it last.
  struct Seen {
    std::int64_t since_ns = 0;  // when it began; 0: none runs
    Duration observed{0};
  };
  void loop();
  void look(const Watched& watched, Seen& seen, Duration elapsed);
  void tell_hung(const Watched& watched, Duration observed);

  std::vector<Watched> watched_;
  std::vector<Seen> seen_;  // of watched_
  Duration tick_;
  int priority_;
  std::function<void(const std::string&)> note_;
  mutable RealTimeMutex mutex_;
  std::string verdict_;
  WakeUp end_;
  std::thread thread_;
};

/// After how long a step hangs: as its plugin.yaml says (`max_step_s`), else three periods, but at
/// least half a second, which an ordinary thread may have to wait for a processor on a busy machine
/// (a driver that hears nothing has long stopped its arm by then), or without a period 2 s.
Duration max_step_of(const std::optional<Duration>& given, const std::optional<Duration>& period);

/// The same of a component, as far as its plugin.yaml, its executor and the clock tell it: in
/// lockstep how fast time goes is the machine's affair, and it is ten times as long, whatever the
/// period. Nothing: the period that it asks for when it is constructed does.
std::optional<Duration> declared_max_step(const ComponentConfig& component,
                                          const DeploymentConfig& deployment);

}  // namespace armature
