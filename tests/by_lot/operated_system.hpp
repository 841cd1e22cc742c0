// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "deployment_run.hpp"
#include "operator_chronicle.hpp"

namespace armature::test {

/// The body that a tool goes into, and by which rule it moves there.
enum class Body { none, head, jaw, incision };

/// A deployment with an operator who says anything at any time, and what its arm keeps to then.
struct OperatedSystem {
  std::string name, file, robot;
  std::vector<std::string> settings;
  std::vector<std::string> rests_while;  // it is in these states
  double stops_within_s = 1;             // planned first
  Body body = Body::none;
  bool hand_leads = false;   // up to the approach
  bool ends_well = true;     // unless it is aborted
  std::string but_for = {};  // or is refused for this
  int seeds = 8;
  bool leads_out = false;  // an abort: to where the approach began
  int mishaps = 0;
  bool tracker_fails = false;  // now and then, and what it sees is knocked
  bool plan_changes = false;

  friend void PrintTo(const OperatedSystem& system, std::ostream* out) { *out << system.name; }
};

struct OperatedRun {
  DeploymentRun run;
  OperatorChronicle chronicle;
};

/// Runs it with the operator of that number. Throws std::runtime_error where nothing is told.
OperatedRun run_with(const OperatedSystem& system, int seed);

/// Each system with its operator alone, and where something stops the arm now and then, too.
std::vector<OperatedSystem> operated_systems();

}  // namespace armature::test
