// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "drill/drilled_deployment.hpp"
#include "drill/fault.hpp"

namespace armature::drill {

/// What came of one fault at one moment.
struct TrialResult {
  std::string fault;
  Form form;
  double moment_s = 0;           // after the arm was first seen to move
  std::string arm;               // what it did: "ramped to rest", "went on"
  std::optional<double> rest_s;  // from the fault, or from the interruption after it, until rest
  std::optional<double> step_s;  // p99.9 of the processor time of a step of what commands an arm
  std::string shown;             // the line of the run that names it
  std::string wrong;             // what must not be; empty: nothing
  std::string untried;           // why it could not be tried to its end; empty: it was

  bool failed() const { return !wrong.empty(); }
  bool passed() const { return wrong.empty() && untried.empty(); }
};

/// What every trial of a drill has in common.
struct TrialOptions {
  const DeploymentSource& source;
  const DrilledDeployment& deployment;
  PluginRegistry& plugins;
  int domain;
  std::stop_token stop;  // when it is requested, runs are interrupted
};

/// Starts the deployment in this form, fires the fault `moment_s` after an arm was first seen to
/// move, in motion if it moves again within a second, and judges by the arms' own samples. Returns
/// when the run and its processes have ended, or were killed because they took too long. The
/// result of a trial that was interrupted means nothing.
TrialResult try_fault(const TrialOptions& options, const Fault& fault, Form form, double moment_s);

}  // namespace armature::drill
