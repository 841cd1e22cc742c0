// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "command.hpp"

namespace armature::test {

/// How a deployment is started; the lamp unless said otherwise.
struct DeploymentStart {
  std::vector<std::string> files{source_file("configs/dental_lamp.yaml")};
  std::vector<std::string> settings;  // "components.motion.ik.plugin=ik/numeric"
  int domain = 0;                     // 0: one that no other test uses
  std::string report_folder = {};     // --report; empty: none
  Command::Options options;
};

/// What came of a run to its end.
struct DeploymentRun {
  CommandResult command;
  std::string report;  // the object that it printed, as it stands; empty when it printed none

  double figure(const std::string& name) const;     // NaN when it is missing
  std::string word(const std::string& name) const;  // "none" when it is missing
  std::string status() const { return word("status"); }
  bool tells(const std::string& name) const;
  std::string text() const;  // for messages
};

/// The limits of the lamp's four goals.
struct LampGoals {
  double mouth_mm = 2.5, normal_deg = 2.5, distance_mm = 1.5, direction_deg = 2.5;
};

/// On the simulated clock: the same on every machine.
inline const std::string kSimulated = "clock=simulated";
/// The face's two stages in a process of their own.
inline const std::vector<std::string> kVisionApart{"components.landmarks.process=vision",
                                                   "components.face.process=vision"};

std::vector<std::string> deployment_command(const DeploymentStart& start);
DeploymentRun run_deployment(const DeploymentStart& start);

/// Of the lamp: found, aligned, all four goals met, and not slower than 20 s of the deployment's
/// own time.
void expect_aligned(const DeploymentRun& run, const LampGoals& goals = {});

}  // namespace armature::test
