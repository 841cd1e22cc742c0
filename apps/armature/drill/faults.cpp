// SPDX-License-Identifier: Apache-2.0
// The faults of a drill: adding one is adding a function and its line in the table at the end.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <thread>

#include "drill/fault.hpp"
#include "drill/stranger.hpp"

namespace armature::drill {
namespace {

using std::chrono::milliseconds;

/// The fault for this deployment and form; nothing where it makes no sense.
using MakeFault = std::optional<Fault> (*)(const DrilledDeployment&, Form);

std::string send(Scene& scene, const std::string& process, int signal) {
  if (scene.run.signal(process, signal)) return {};
  return fmt::format("there was no process '{}'", process);
}

Fault signalled(int signal, std::string shown) {
  return {.name = {}, .shown = std::move(shown), .fire = [signal](Scene& scene) {
            return send(scene, "main", signal);
          }};
}

// Signals and the terminal, by an operator.

std::optional<Fault> interrupt(const DrilledDeployment&, Form) {
  return signalled(SIGINT, "stopping: interrupted");
}
std::optional<Fault> terminate(const DrilledDeployment&, Form) {
  return signalled(SIGTERM, "stopping: terminated");
}
std::optional<Fault> hang_up(const DrilledDeployment&, Form) {
  return signalled(SIGHUP, "stopping: the terminal was closed");
}

std::optional<Fault> two_signals(const DrilledDeployment&, Form) {
  return Fault{.name = {}, .shown = "stopping", .fire = [](Scene& scene) {
                 scene.run.signal(SIGINT);
                 std::this_thread::sleep_for(milliseconds{50});
                 scene.run.signal(SIGINT);
                 return std::string{};
               }};
}

std::optional<Fault> closed_terminal(const DrilledDeployment&, Form) {
  return Fault{.name = {},  // nobody is there to read it
               .fire = [](Scene& scene) {
                 scene.run.close_terminal();
                 return std::string{};
               }};
}

std::optional<Fault> unread_terminal(const DrilledDeployment&, Form) {
  return Fault{.name = {}, .fire = [](Scene& scene) {
                 scene.run.fill_terminal();
                 return send(scene, "main", SIGINT);
               }};
}

// Processes that are killed or halted.

/// What main says of a lost process without which the run goes on.
const std::string kIsolated = ", isolated: the run goes on without it";

std::optional<Fault> killed(const std::string& process, const DrilledDeployment& deployment) {
  if (process.empty() || process == "main") return std::nullopt;
  const bool ends = deployment.ending.contains(process);
  return Fault{.name = {},
               .outcome = ends ? Outcome::stops : Outcome::goes_on,
               .shown = ends ? fmt::format("stopping: process '{}'", process) : kIsolated,
               .fire = [process](Scene& scene) { return send(scene, process, SIGKILL); }};
}

std::optional<Fault> driver_killed(const DrilledDeployment& deployment, Form form) {
  if (form == Form::single) return std::nullopt;
  auto fault = killed(deployment.arms.front().process, deployment);
  if (fault) fault->lost = deployment.arms.front().component;
  return fault;
}
std::optional<Fault> motion_killed(const DrilledDeployment& deployment, Form form) {
  return form == Form::single ? std::nullopt : killed(deployment.commander.process, deployment);
}
std::optional<Fault> perception_killed(const DrilledDeployment& deployment, Form form) {
  return form == Form::single ? std::nullopt : killed(deployment.perception.process, deployment);
}
std::optional<Fault> monitor_killed(const DrilledDeployment& deployment, Form form) {
  return form == Form::single ? std::nullopt : killed(deployment.monitor.process, deployment);
}

std::optional<Fault> driver_halted(const DrilledDeployment& deployment, Form form) {
  if (form == Form::single || deployment.arms.front().process == "main") return std::nullopt;
  return Fault{.name = {},
               .outcome = Outcome::goes_on,
               .may_give_up = true,  // teleoperation holds when its leader was silent for 0.1 s
               .fire = [process = deployment.arms.front().process](Scene& scene) {
                 std::string wrong = send(scene, process, SIGSTOP);
                 // Shorter than a reference takes to go farther ahead than max_deviation.
                 std::this_thread::sleep_for(milliseconds{150});
                 if (wrong.empty()) wrong = send(scene, process, SIGCONT);
                 return wrong;
               }};
}

std::optional<Fault> main_killed(const DrilledDeployment& deployment, Form form) {
  if (form == Form::single || deployment.processes.empty()) return std::nullopt;
  return Fault{.name = {}, .shown = "stopping: the main process is gone", .fire = [](Scene& scene) {
                 return send(scene, "main", SIGKILL);
               }};
}

// Components that throw, hang or crash.

std::optional<Fault> injected(const DrilledComponent& component, Form form, const char* what,
                              Fault fault) {
  if (component.name.empty()) return std::nullopt;
  fault.inject = fmt::format("{}:{}", component.name, what);
  fault.fire = [process = form == Form::single ? "main" : component.process](Scene& scene) {
    return send(scene, process, SIGUSR1);
  };
  return fault;
}

std::optional<Fault> motion_throws(const DrilledDeployment& deployment, Form form) {
  return injected(deployment.commander, form, "throw",
                  {.name = {}, .shown = "step failed: a drill's fault"});
}
std::optional<Fault> motion_hangs(const DrilledDeployment& deployment, Form form) {
  // A driver whose thread does not return from another component's step is halted with it.
  if (form == Form::single && deployment.commander.shares_arm_thread) return std::nullopt;
  return injected(
      deployment.commander, form, "hang",
      {.name = {},
       .shown = fmt::format("the step of '{}' has not returned", deployment.commander.name)});
}
std::optional<Fault> motion_crashes(const DrilledDeployment& deployment, Form form) {
  if (form == Form::single) return std::nullopt;  // a crash takes its process along
  return injected(
      deployment.commander, form, "crash",
      {.name = {}, .shown = fmt::format("component '{}' crashed", deployment.commander.name)});
}
std::optional<Fault> monitor_throws(const DrilledDeployment& deployment, Form form) {
  return injected(
      deployment.monitor, form, "throw",
      {.name = {}, .outcome = Outcome::goes_on, .shown = "step failed: a drill's fault"});
}
std::optional<Fault> monitor_hangs(const DrilledDeployment& deployment, Form form) {
  if (form == Form::single && deployment.monitor.shares_arm_thread) return std::nullopt;
  return injected(
      deployment.monitor, form, "hang",
      {.name = {},
       .outcome = Outcome::goes_on,
       .shown = fmt::format("the step of '{}' has not returned", deployment.monitor.name)});
}
std::optional<Fault> monitor_crashes(const DrilledDeployment& deployment, Form form) {
  if (form == Form::single || deployment.monitor.process == "main") return std::nullopt;
  return injected(deployment.monitor, form, "crash",
                  {.name = {}, .outcome = Outcome::goes_on, .shown = kIsolated});
}

// Other programs on the machine.

std::optional<Fault> stranger(const DrilledDeployment&, Form form) {
  return Fault{.name = {},
               .outcome = Outcome::goes_on,
               // In one process nothing listens to others, so that there is nobody to refuse.
               .shown = form == Form::single ? "nobody here hears it" : "was refused on",
               .fire = [](Scene& scene) {
                 write_as_stranger(scene.plugins, scene.deployment, scene.domain,
                                   scene.listener.records(), seconds(1));
                 return std::string{};
               }};
}

std::optional<Fault> second_start(const DrilledDeployment&, Form) {
  return Fault{.name = {}, .outcome = Outcome::goes_on, .fire = [](Scene& scene) {
                 RunUnderTest second{scene.arguments, scene.stop};
                 if (!second.ends_within(std::chrono::seconds{20})) {
                   return std::string{"a second start was not refused"};
                 }
                 if (second.exit_code() != 0 && second.line_with("already runs")) {
                   return std::string{};
                 }
                 return "a second start ended with: " + second.last_line();
               }};
}

// Stops and rearms, by an operator.

constexpr const char* kStopHeard = "a stop was asked for";

std::string stop_all(Scene& scene) {
  RunUnderTest stop{{"stop", "--domain", std::to_string(scene.domain)}, scene.stop};
  // Until it has found them the arms go on with their task: they may rest, and move again.
  scene.run.wait_for_line(kStopHeard, milliseconds{10000});
  scene.fired_at = std::chrono::steady_clock::now();
  const bool done = stop.ends_within(std::chrono::seconds{10});
  if (done && stop.exit_code() == 0) return {};
  return "armature stop: " + stop.last_line();
}

std::optional<Fault> emergency_stop(const DrilledDeployment& deployment, Form) {
  if (deployment.commander.name.empty()) return std::nullopt;
  return Fault{.name = {}, .outcome = Outcome::holds, .shown = kStopHeard, .fire = stop_all};
}

/// A fault of a run whose operator has a pendant.
std::optional<Fault> with_pendant(const DrilledDeployment& deployment, std::string shown,
                                  std::function<std::string(Scene&)> fire) {
  if (deployment.heed_pendants.empty()) return std::nullopt;
  return Fault{.name = {},
               .outcome = Outcome::holds,
               .shown = std::move(shown),
               .has_pendant = true,
               .fire = std::move(fire)};
}

/// From here on, when all rest, no arm may move.
void come_to_rest(Scene& scene) {
  scene.listener.wait_for_rest();
  scene.held_from = std::chrono::steady_clock::now();
}

/// Counts the lines with `text` of each component that heeds the pendant.
std::vector<std::ptrdiff_t> count_lines(const Scene& scene, const std::string& text) {
  std::vector<std::ptrdiff_t> counts;
  for (const HeedsPendant& component : scene.deployment.heed_pendants) {
    counts.push_back(scene.run.count_lines(component.name, text));
  }
  return counts;
}

/// The operator presses until all are rearmed. A run that has ended by itself cannot be.
std::string press_rearm(Scene& scene) {
  constexpr const char* kRearmed = "ok again";
  constexpr milliseconds kNextPress{500};
  const auto before = count_lines(scene, kRearmed);
  for (int presses = 0; presses < 6; ++presses) {
    if (!scene.run.runs() || scene.run.line_with("stopping:")) return {};
    scene.pendant->rearm();
    std::this_thread::sleep_for(kNextPress);
    if (std::ranges::equal(before, count_lines(scene, kRearmed), std::less{})) return {};
  }
  return "the pendant did not rearm it: " + scene.run.last_line();
}

std::optional<Fault> rearm(const DrilledDeployment& deployment, Form) {
  return with_pendant(deployment, kStopHeard, [](Scene& scene) -> std::string {
    if (std::string wrong = stop_all(scene); !wrong.empty()) return wrong;
    come_to_rest(scene);
    return press_rearm(scene);
  });
}
std::optional<Fault> hold_released(const DrilledDeployment& deployment, Form) {
  return with_pendant(deployment, "hold_to_run was released", [](Scene& scene) -> std::string {
    scene.pendant->hold(false);
    come_to_rest(scene);
    scene.pendant->hold(true);  // is no rearm
    return {};
  });
}
std::optional<Fault> pendant_unplugged(const DrilledDeployment& deployment, Form) {
  return with_pendant(deployment, "hold_to_run was released", [](Scene& scene) -> std::string {
    scene.pendant->unplug();
    return {};
  });
}

// The arms' own power.

std::optional<Fault> power_lost(const DrilledDeployment& deployment, Form) {
  const bool switched = std::ranges::none_of(
      deployment.arms, [](const DrilledArm& arm) { return arm.power_topic.empty(); });
  if (!switched || deployment.commander.name.empty()) return std::nullopt;
  return Fault{.name = {},
               .outcome = Outcome::holds,
               .shown = "the arm says emergency_stop",
               .has_power_switch = true,
               .fire = [](Scene& scene) {
                 constexpr std::chrono::seconds kWithoutPower{2};
                 scene.power->turn(false);
                 std::this_thread::sleep_for(kWithoutPower);
                 come_to_rest(scene);
                 scene.power->turn(true);
                 return std::string{};
               }};
}

struct Row {
  const char* name;
  MakeFault make;
};

constexpr std::array kFaults{
    Row{"interrupt", interrupt},
    Row{"terminate", terminate},
    Row{"hang_up", hang_up},
    Row{"two_signals", two_signals},
    Row{"closed_terminal", closed_terminal},
    Row{"unread_terminal", unread_terminal},
    Row{"driver_killed", driver_killed},
    Row{"motion_killed", motion_killed},
    Row{"perception_killed", perception_killed},
    Row{"monitor_killed", monitor_killed},
    Row{"driver_halted", driver_halted},
    Row{"main_killed", main_killed},
    Row{"motion_throws", motion_throws},
    Row{"motion_hangs", motion_hangs},
    Row{"motion_crashes", motion_crashes},
    Row{"monitor_throws", monitor_throws},
    Row{"monitor_hangs", monitor_hangs},
    Row{"monitor_crashes", monitor_crashes},
    Row{"emergency_stop", emergency_stop},
    Row{"rearm", rearm},
    Row{"hold_released", hold_released},
    Row{"pendant_unplugged", pendant_unplugged},
    Row{"power_lost", power_lost},
    Row{"stranger", stranger},
    Row{"second_start", second_start},
};

}  // namespace

std::vector<Fault> faults_of(const DrilledDeployment& deployment, Form form) {
  std::vector<Fault> faults;
  for (const Row& row : kFaults) {
    auto fault = row.make(deployment, form);
    if (!fault) continue;
    fault->name = row.name;
    faults.push_back(std::move(*fault));
  }
  return faults;
}

std::vector<std::string> fault_names() {
  std::vector<std::string> names;
  for (const Row& row : kFaults) names.emplace_back(row.name);
  return names;
}

}  // namespace armature::drill
