// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "drill/arm_listener.hpp"
#include "drill/drilled_deployment.hpp"
#include "drill/pendant.hpp"
#include "drill/power_switch.hpp"
#include "drill/run_under_test.hpp"

namespace armature::drill {

/// The run and its surroundings, for a fault that is fired.
struct Scene {
  RunUnderTest& run;
  const ArmListener& listener;
  const DrilledDeployment& deployment;
  PluginRegistry& plugins;
  int domain;
  Pendant* pendant;                    // of a fault that has one
  PowerSwitch* power;                  // of a fault that has one
  Arrival& fired_at;                   // where it takes effect later than it is begun
  std::optional<Arrival>& held_from;   // since when no arm may move, where that is known
  std::vector<std::string> arguments;  // that the run was started with, behind `armature`
  std::stop_token stop;                // requested when the drill is interrupted
};

/// The outcome with which a fault is passed.
enum class Outcome {
  stops,    // the run comes to rest and ends
  goes_on,  // the run goes on and its arms do, and they come to rest when it is interrupted later
  holds,    // its arms come to rest and do not move again; the run, without its reports, goes on
};

/// One row of the table, for one deployment and form.
struct Fault {
  std::string name;  // "motion_killed"
  Outcome outcome = Outcome::stops;
  std::string shown;         // part of the line by which the run names it; empty: it need not
  std::string inject{};      // --inject of the run; empty: none
  bool has_pendant = false;  // the run is given one; the operator holds it and has rearmed
  bool has_power_switch = false;
  bool may_give_up = false;  // goes_on: a task may need more than the fault leaves, and says so
  std::string lost{};  // the arm whose own driver the fault takes away; no software can stop it
  /// Fires it. Returns what was wrong with it, or nothing.
  std::function<std::string(Scene&)> fire;
};

/// All faults that this deployment can meet in this form, in the order of the table.
std::vector<Fault> faults_of(const DrilledDeployment& deployment, Form form);

/// The names that `--faults` takes: the faults of any deployment.
std::vector<std::string> fault_names();

}  // namespace armature::drill
