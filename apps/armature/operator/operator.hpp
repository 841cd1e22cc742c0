// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "armature/bus/network.hpp"
#include "run/run.hpp"

namespace armature {

struct OperatorOptions {
  DeploymentSource source;
  std::optional<int> domain;  // instead of the file's
  NetworkOptions network;     // beside what the file says
  std::string component;      // which task, when the deployment has several
  std::string say, step;      // one word, and the step that it confirms; or a dialogue
  double timeout_s = 3;       // for the task to be found, and to answer
  bool json = false;
};

/// `armature operator`: shows the steps of a running deployment's task and says the operator's
/// words to it, one or as they are typed. What is typed confirms the step that was shown last; a
/// single "confirm" needs the name of its step where a task asks about several. Exit code 1 when a
/// word was refused, 5 when no task was found or none answered; of words that are read from a file
/// or a pipe the highest, with 2 for one that is none.
int be_operator(const OperatorOptions& options);

}  // namespace armature
